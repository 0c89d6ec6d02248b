//! `motion`: what is in record files.

use std::fs;

use serde_json::Value;

use super::{ends_with, names, project, stderr, stdout};

const SMC: &str = "tests/data/records/0111a.smc";

fn shown(arguments: &[&str]) -> Value {
    let arguments = [&["motion", "--json"], arguments].concat();
    let output = ends_with(0, &project(), &arguments);
    serde_json::from_str(stdout(&output)).expect("JSON")
}

#[track_caller]
fn near(value: &Value, expected: f64) {
    let value = value.as_f64().expect("a number");
    assert!(
        (value / expected - 1.0).abs() < 1e-10,
        "{value} is not {expected}"
    );
}

#[test]
fn json_has_measures_and_spectrum() {
    let file = shown(&[SMC, "--periods", "0.1111,0.4978,1.173"]);
    assert_eq!(file["format"], "SMC");
    let channel = &file["channels"][0];
    assert_eq!(
        (&channel["name"], &channel["points"]),
        (&"360".into(), &6001.into())
    );
    near(&channel["dt"], 0.005);
    near(&channel["pga"]["value"], 1.0441);
    near(&channel["pga"]["t"], 10.17);
    near(&channel["pgv"], 0.08086537992);
    near(&channel["arias"], 0.0954276129017227);
    near(&channel["mean"], -3.593868538576904e-05);
    let spectrum = &file["spectrum"];
    assert_eq!(spectrum["damping"], 0.05);
    assert_eq!(
        spectrum["periods"],
        serde_json::json!([0.1111, 0.4978, 1.173])
    );
    let reference: Value =
        serde_json::from_str(include_str!("../data/22_response_spectra.json")).unwrap();
    for (i, period) in [0.1111, 0.4978, 1.173].iter().enumerate() {
        let rows = reference["0111a"]["periods"].as_array().unwrap();
        let row = rows
            .iter()
            .find(|row| row["T"] == *period)
            .expect("a period of the reference");
        let number = |key: &str| row[key].as_str().unwrap().parse::<f64>().unwrap();
        near(&spectrum["psa_samples"][i], number("psa_samples"));
        near(&spectrum["psa"][i], number("psa_true_with_free_vibration"));
    }
}

#[test]
fn the_mean_is_removed_on_request() {
    let file = shown(&[
        "tests/data/records/0111a.EW",
        "--remove-mean",
        "--periods",
        "1",
    ]);
    assert_eq!(file["format"], "K-NET");
    near(&file["channels"][0]["pga"]["value"], 0.6286908653916915);
    assert!(file["channels"][0]["mean"].as_f64().unwrap().abs() < 1e-15);
    assert_eq!(file["notes"][0]["doubt"], false);
}

#[test]
fn channels_are_chosen_by_name_or_number() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("two.csv"),
        "t_s,ns_g,ew_g\n0.0,1,2\n0.5,3,4\n",
    )
    .unwrap();
    for (wanted, name) in [("ew", "ew"), ("1", "ns")] {
        let arguments = ["motion", "two.csv", "--json", "--channel", wanted];
        let output = ends_with(0, folder.path(), &arguments);
        let file: Value = serde_json::from_str(stdout(&output)).unwrap();
        assert_eq!(file["channels"].as_array().unwrap().len(), 1);
        assert_eq!(file["channels"][0]["name"], name);
        assert_eq!(file["spectrum"]["channel"], name);
        assert_eq!(file["spectrum"]["periods"].as_array().unwrap().len(), 91);
    }
    let output = ends_with(2, folder.path(), &["motion", "two.csv", "--channel", "ud"]);
    assert!(stderr(&output).contains("no channel `ud`; it has `ns`, `ew`"));
}

#[test]
fn units_and_steps_are_never_guessed() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.txt"), "0.1\n0.2\n-0.3\n").unwrap();
    let silent = ends_with(2, folder.path(), &["motion", "a.txt"]);
    assert!(
        stderr(&silent).contains("does not state its step"),
        "{}",
        stderr(&silent)
    );
    assert!(stderr(&silent).contains("--dt"));
    let silent = ends_with(2, folder.path(), &["motion", "a.txt", "--dt", "0.01"]);
    assert!(stderr(&silent).contains("--unit"));
    let arguments = ["motion", "a.txt", "--json", "--dt", "0.01", "--unit", "g"];
    let output = ends_with(0, folder.path(), &arguments);
    let file: Value = serde_json::from_str(stdout(&output)).unwrap();
    near(&file["channels"][0]["pga"]["value"], 0.3 * 9.80665);
    near(&file["channels"][0]["pga"]["t"], 0.02);
    let other = ends_with(2, &project(), &["motion", SMC, "--unit", "g"]);
    assert!(stderr(&other).contains("states the unit cm/s^2, not g"));
}

#[test]
fn errors_have_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(project().join("tests/data/records/0111a_part.AT2")).unwrap();
    fs::write(
        folder.path().join("a.AT2"),
        text.replacen(".1025325E+00", "         NaN", 1),
    )
    .unwrap();
    let output = ends_with(2, folder.path(), &["motion", "a.AT2"]);
    assert!(
        stderr(&output).contains("a.AT2:51:43"),
        "{}",
        stderr(&output)
    );
    let output = ends_with(2, folder.path(), &["motion", "b.AT2"]);
    assert!(stderr(&output).contains("cannot read `b.AT2`"));
    // A contradiction within a file is a warning, with its line.
    let text = fs::read_to_string(project().join("tests/data/records/0111a.ASC")).unwrap();
    fs::write(
        folder.path().join("c.ASC"),
        text.replace("PGA_CM/S^2: 62", "PGA_CM/S^2: 99"),
    )
    .unwrap();
    let output = ends_with(0, folder.path(), &["motion", "c.ASC"]);
    assert!(stderr(&output).starts_with("warning: c.ASC:40: the header has the peak 99.32"));
}

#[test]
fn several_files_are_shown_side_by_side_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| {
        project()
            .join("tests/data/records")
            .join(name)
            .display()
            .to_string()
    };
    let (one, other) = (file("0111a.smc"), file("nonuniform_times.csv"));
    let arguments = ["motion", &one, &other, "--out", "out", "--periods", "0.1,1"];
    let output = ends_with(0, folder.path(), &arguments);
    for part in [
        "SMC",
        "CSV",
        "0111a.smc 360",
        "nonuniform_times.csv acc",
        "unequal",
    ] {
        assert!(
            stdout(&output).contains(part),
            "{part} in\n{}",
            stdout(&output)
        );
    }
    let written = names(&folder.path().join("out"));
    let expected = [
        ".dalembert-digests",
        ".dalembert-output",
        "acceleration.svg",
        "displacement.svg",
        "husid.svg",
        "measures.csv",
        "spectra.csv",
        "spectrum_acceleration.svg",
        "spectrum_displacement.svg",
        "spectrum_velocity.svg",
        "velocity.svg",
    ];
    assert_eq!(written, expected);
    let spectra = fs::read_to_string(folder.path().join("out/spectra.csv")).unwrap();
    assert_eq!(spectra.lines().count(), 3);
    let files = shown(&[SMC, "tests/data/records/test.v1", "--periods", "1"]);
    assert_eq!(files[1]["format"], "COSMOS");
}

#[test]
fn a_page_has_all_plots_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let file = project().join(SMC).display().to_string();
    let arguments = ["motion", &file, "--html", "page.html", "--units", "cm,g_n"];
    ends_with(0, folder.path(), &arguments);
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    for part in [
        "Ground motion: 0111a.smc",
        "growth of the Arias intensity",
        "spectrum of pseudo-velocity, damping 0.05",
        "spectrum of displacement",
        "g_n",
        "Made by",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let refused = ["motion", &file, "--html", "none/page.html"];
    let output = ends_with(1, folder.path(), &refused);
    assert!(stderr(&output).contains("none/page.html"));
}
