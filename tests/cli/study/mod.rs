//! `study`: tables against references and against themselves, however they were computed; refusals.

mod going_on;
mod inputs;
mod measures;
mod page;
mod random;
mod references;
mod refusals;

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::{ends_with, json as read_json, names, stdout};

/// A folder with a scene of the rocking block, released from 0.2 rad.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(
        folder.path(),
        "scene.json",
        &json!({
            "model": "rocking_block",
            "initial": { "theta": 0.2, "side": 1 },
            "end": 3.0
        }),
    );
    folder
}

fn write(folder: &Path, name: &str, value: &Value) {
    fs::write(folder.join(name), format!("{value:#}")).unwrap();
}

/// A sweep of twenty cases.
fn sweep() -> Value {
    json!({
        "scene": "scene.json",
        "vary": {
            "parameters.alpha": { "from": 0.21, "to": 0.3, "count": 5 },
            "parameters.e": [0.8, "85 %", 0.9, 0.95]
        },
        "measure": ["peak.theta", "count.base strikes", "end.theta.rate", "reached.overturned", "time.overturned"]
    })
}

/// Runs `study.json` into `out` and gives the rows of its table.
fn run(folder: &Path) -> Vec<std::collections::BTreeMap<String, String>> {
    let arguments = ["study", "study.json", "--out", "out", "--csv"];
    ends_with(0, folder, &arguments);
    table(&folder.join("out/runs.csv"))
}

/// The summary of the single run of the scene `name` that has these values of a row.
fn single_run(
    folder: &Path,
    name: &str,
    row: &std::collections::BTreeMap<String, String>,
    paths: &[&str],
) -> Value {
    let mut arguments = vec![
        "run".to_owned(),
        name.to_owned(),
        "--out".into(),
        "single".into(),
    ];
    for path in paths {
        arguments.extend(["--set".to_owned(), format!("{path}={}", row[*path])]);
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    ends_with(0, folder, &arguments);
    let summary = read_json(&folder.join("single/summary.json"));
    fs::remove_dir_all(folder.join("single")).unwrap();
    summary
}

/// The rows of a CSV table, each by the names of its columns.
fn table(path: &Path) -> Vec<std::collections::BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows = reader.deserialize();
    rows.map(|row| row.unwrap()).collect()
}

#[test]
fn a_sweep_has_a_row_for_each_case_and_the_values_of_single_runs() {
    let folder = folder();
    write(folder.path(), "study.json", &sweep());
    let arguments = ["study", "study.json", "--out", "out", "--csv"];
    let output = ends_with(0, folder.path(), &arguments);
    assert!(stdout(&output).starts_with("sweep: 20 cases, 20 runs: 20 ok"));
    let out = folder.path().join("out");
    let files = names(&out);
    for file in ["runs.csv", "runs.parquet", "study.json", "summary.json"] {
        assert!(files.iter().any(|name| name == file), "{files:?}");
    }
    let rows = table(&out.join("runs.csv"));
    assert_eq!(rows.len(), 20);
    for (case, row) in rows.iter().enumerate() {
        assert_eq!(row["case"], case.to_string());
        assert_eq!(
            row["parameters.e"],
            ["0.8", "0.85", "0.9", "0.95"][case % 4]
        );
        assert_eq!(row["reached.overturned"], "false");
        assert_eq!(row["time.overturned"], "");
    }
    // The last path varies fastest; the ends of a range are exact.
    let second: f64 = rows[4]["parameters.alpha"].parse().unwrap();
    assert!((second - 0.2325).abs() < 1e-16);
    assert_eq!(rows[0]["parameters.alpha"], "0.21");
    assert_eq!(rows[19]["parameters.alpha"], "0.3");
    for case in [0, 7, 19] {
        let paths = ["parameters.alpha", "parameters.e"];
        let summary = single_run(folder.path(), "scene.json", &rows[case], &paths);
        let landings = &summary["events"]["by_transition"]["base strikes"];
        assert_eq!(rows[case]["count.base strikes"], landings.to_string());
        for (column, value) in [
            ("peak.theta", &summary["peaks"]["theta"]["max"]),
            ("end.theta.rate", &summary["end"]["v"]["theta.rate"]),
        ] {
            // In lanes the steps are the same, with other roundings.
            let found: f64 = rows[case][column].parse().unwrap();
            let off = (found - value.as_f64().unwrap()).abs();
            assert!(off <= 1e-13, "{column} of case {case}: {off:e}");
        }
    }
}

/// Nine oscillators in lanes, and one beyond its stop, which cannot begin: it is refused with the reason of a single run, as is that
/// of a study too small for lanes.
#[test]
fn a_run_that_cannot_begin_is_refused_in_lanes_as_alone() {
    let folder = folder();
    let free = json!({ "static_friction": 0, "kinetic_friction": 0, "stop": 1 });
    let scene = json!({
        "model": "coulomb_oscillator", "parameters": free, "initial": { "x": 0.5 }, "end": 1
    });
    write(folder.path(), "scene.json", &scene);
    let places: Vec<f64> = (0..9).map(|i| 0.1 * f64::from(i)).chain([2.0]).collect();
    let study = |places: &[f64]| {
        let study = json!({
            "scene": "scene.json", "vary": { "initial.x": places }, "measure": ["end.x", "peak.x"]
        });
        write(folder.path(), "study.json", &study);
        let rows = run(folder.path());
        fs::remove_dir_all(folder.path().join("out")).unwrap();
        rows
    };
    let (many, few) = (study(&places), study(&places[8..]));
    assert_eq!((&*many[0]["uncertain"], &*few[0]["uncertain"]), ("", "0"));
    for column in ["status", "reason", "end.x", "peak.x", "t"] {
        assert_eq!(many[9][column], few[1][column], "{column}");
    }
    assert_eq!((&*many[9]["status"], &*many[9]["end.x"]), ("refused", ""));
}

#[test]
fn the_studies_that_ship_run() {
    let folder = tempfile::tempdir().unwrap();
    let studies = super::project().join("studies");
    let mut count = 0;
    for name in names(&studies)
        .iter()
        .filter(|name| name.ends_with(".json"))
    {
        let path = studies.join(name);
        let study = read_json(&path);
        // The scenes of studies stand beside them.
        if study["scene"].is_null() {
            continue;
        }
        let path = path.display().to_string();
        let mut arguments = vec!["study", &path, "--out", name];
        if study["random"].is_object() {
            arguments.extend(["--set", "random.count=2"]);
        }
        let output = ends_with(0, folder.path(), &arguments);
        let shown = stdout(&output);
        assert!(shown.contains(" 0 refused"), "{name}: {shown}");
        let page = fs::read_to_string(folder.path().join(name).join("study.html")).unwrap();
        assert!(page.contains(study["title"].as_str().unwrap()), "{name}");
        count += 1;
    }
    assert!(count >= 4);
}

#[test]
fn parquet_has_what_csv_has() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    let folder = folder();
    write(folder.path(), "study.json", &sweep());
    ends_with(
        0,
        folder.path(),
        &["study", "study.json", "--out", "out", "--csv"],
    );
    let out = folder.path().join("out");
    let rows = table(&out.join("runs.csv"));
    let file = fs::File::open(out.join("runs.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let mut count = 0;
    for (row, expected) in reader.get_row_iter(None).unwrap().zip(&rows) {
        let row = row.unwrap();
        assert_eq!(row.len(), expected.len());
        for (name, field) in row.get_column_iter() {
            let text = &expected[name];
            match field {
                Field::Null => assert_eq!(text, ""),
                Field::Double(x) => assert_eq!(Ok(*x), text.parse(), "{name}"),
                other => assert_eq!(other.to_string().trim_matches('"'), text, "{name}"),
            }
        }
        count += 1;
    }
    assert_eq!(count, rows.len());
    let metadata = reader
        .metadata()
        .file_metadata()
        .key_value_metadata()
        .unwrap();
    let unit = metadata
        .iter()
        .find(|pair| pair.key == "end.theta.rate.unit");
    assert_eq!(unit.and_then(|pair| pair.value.as_deref()), Some("rad/s"));
}

#[test]
fn what_cannot_run_is_a_row_with_a_reason() {
    let folder = folder();
    // A block that falls fast leaves the ground.
    let study = json!({
        "scene": "scene.json",
        "cases": [
            { "initial.theta": 0.2, "initial.theta.rate": 0, "initial.mode": "base open" },
            { "initial.theta": 0.3, "initial.theta.rate": 3, "initial.mode": "base open" },
            { "initial.theta": 0.0, "initial.theta.rate": 0, "initial.mode": "base closed" },
            { "initial.theta": 0.3, "initial.theta.rate": 4, "initial.mode": "base open" }
        ],
        "failure": { "measure": "peak.theta", "above": "30 deg" }
    });
    write(folder.path(), "study.json", &study);
    ends_with(
        0,
        folder.path(),
        &["study", "study.json", "--out", "out", "--csv"],
    );
    let rows = table(&folder.path().join("out/runs.csv"));
    let of = |name: &str| {
        rows.iter()
            .map(|row| row[name].as_str())
            .collect::<Vec<_>>()
    };
    assert_eq!(of("failed")[..2], ["false", "true"]);
    assert_eq!(of("status")[1], "stopped");
    assert!(of("reason")[1].contains("the block would leave the ground"));
    let summary = read_json(&folder.path().join("out/summary.json"));
    // The last one leaves the ground at once: whether it would have failed nobody knows.
    assert_eq!(of("failed")[3], "");
    assert_eq!(summary["failures"]["failed"], 1);
    assert_eq!(summary["failures"]["untold"], 1);
    assert_eq!(summary["runs"]["stopped"], 2);
}
