//! Members that differ in their inputs: each is the single run of its scene, whatever the study.

use std::fs;

use serde_json::{Value, json};

use super::super::project;
use super::{run, single_run, write};

/// A folder with a block and two records of motions.
fn folder(input: &Value) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let records = project().join("tests/data/records");
    for record in ["0111a.smc", "0165a_u.smc"] {
        fs::copy(records.join(record), folder.path().join(record)).unwrap();
    }
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "R": 1.5, "alpha": 0.25 },
        "inputs": { "ground_acceleration": input },
        "end": 9.0
    });
    write(folder.path(), "scene.json", &scene);
    folder
}

/// Every row of the study is the single run with its values, to the bit.
fn rows_are_single_runs(input: &Value, path: &str, values: &Value) {
    let folder = folder(input);
    let path = format!("inputs.ground_acceleration.{path}");
    let study = json!({
        "scene": "scene.json",
        "vary": { &path: values },
        "measure": ["peak.theta", "end.rotation", "count"]
    });
    write(folder.path(), "study.json", &study);
    let rows = run(folder.path());
    assert_eq!(rows.len(), 2, "{path}");
    assert_ne!(rows[0]["peak.theta"], rows[1]["peak.theta"], "{path}");
    for row in &rows {
        let summary = single_run(folder.path(), "scene.json", row, &[&path]);
        assert_eq!(row["status"], "ok", "{path}");
        let measured = |name: &str| row[name].parse::<f64>().ok();
        let rotation = &summary["end"]["outputs"]["rotation"];
        assert_eq!(
            measured("peak.theta"),
            summary["peaks"]["theta"]["max"].as_f64(),
            "{path}"
        );
        assert_eq!(measured("end.rotation"), rotation.as_f64(), "{path}");
        assert!(measured("peak.theta") > Some(1e-3), "{path}: nothing moves");
    }
}

#[test]
fn members_differ_in_amplitude_frequency_and_phase() {
    let sine = json!({ "sine": { "amplitude": 3, "frequency": 1.3, "cycles": 3 } });
    rows_are_single_runs(&sine, "sine.amplitude", &json!([2.8, "0.3 g_n"]));
    rows_are_single_runs(
        &sine,
        "sine.frequency",
        &json!({ "from": 1.1, "to": 1.5, "count": 2 }),
    );
    rows_are_single_runs(&sine, "sine.cycles", &json!([1, 2]));
}

#[test]
fn members_differ_in_record_scale_peak_and_spectral_ordinate() {
    let record = |more: Value| {
        let mut input = json!({ "record": "0111a.smc", "from": "8 s", "to": "15 s" });
        input
            .as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        input
    };
    rows_are_single_runs(&record(json!({})), "scale", &json!([5.5, 6.0]));
    rows_are_single_runs(&record(json!({})), "pga", &json!(["0.35 g_n", 3.7]));
    rows_are_single_runs(
        &record(json!({ "scale": 6 })),
        "delay",
        &json!([0.0, "0.3 s"]),
    );
    let ordinate = record(json!({ "Sa": { "T": "0.5 s", "damping": 0.05, "value": 9.0 } }));
    rows_are_single_runs(&ordinate, "Sa.value", &json!([9.0, "1 g_n"]));
    rows_are_single_runs(&ordinate, "Sa.T", &json!([0.4, 0.5]));
    let pga = json!({ "record": "0111a.smc", "to": "9 s", "pga": "0.4 g_n" });
    rows_are_single_runs(&pga, "record", &json!(["0111a.smc", "0165a_u.smc"]));
}

#[test]
fn a_peak_is_reached_by_the_scale_that_it_means() {
    let input = json!({ "record": "0111a.smc", "from": "8 s", "to": "15 s" });
    let folder = folder(&input);
    // Stripes of scales and of peaks that are the same motions: the ratio is the peak of the record.
    let stripes = |path: &str, levels: Value| {
        let study = json!({
            "scene": "scene.json",
            "stripes": { "intensity": format!("inputs.ground_acceleration.{path}"), "levels": levels },
            "failure": { "measure": "peak.theta", "above": 0.05 },
            "measure": ["peak.theta"]
        });
        write(folder.path(), "study.json", &study);
        let rows = run(folder.path());
        fs::remove_dir_all(folder.path().join("out")).unwrap();
        rows.iter()
            .map(|row| row["peak.theta"].parse().unwrap())
            .collect::<Vec<f64>>()
    };
    let by_peak = stripes("pga", json!([3.5, 3.8]));
    let motion = super::super::ends_with(0, folder.path(), &["motion", "0111a.smc", "--json"]);
    let motion: Value = serde_json::from_slice(&motion.stdout).unwrap();
    let peak = motion["channels"][0]["pga"]["value"].as_f64().unwrap();
    let by_scale = stripes("scale", json!([3.5 / peak.abs(), 3.8 / peak.abs()]));
    for (one, other) in by_peak.iter().zip(&by_scale) {
        assert!((one / other - 1.0).abs() < 1e-10, "{one} {other}");
    }
}
