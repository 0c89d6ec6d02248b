//! `study`: tables against references and against themselves, however they were computed; refusals.

mod going_on;
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
        "measure": ["peak.theta", "count.landing", "end.theta.rate", "reached.overturned", "time.overturned"]
    })
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
        let set = |path: &str| format!("{path}={}", rows[case][path]);
        let (alpha, e) = (set("parameters.alpha"), set("parameters.e"));
        let single = [
            "run",
            "scene.json",
            "--out",
            "single",
            "--set",
            &alpha,
            "--set",
            &e,
        ];
        ends_with(0, folder.path(), &single);
        let summary = read_json(&folder.path().join("single/summary.json"));
        let landings = &summary["events"]["by_transition"]["landing"];
        assert_eq!(rows[case]["count.landing"], landings.to_string());
        for (column, value) in [
            ("peak.theta", &summary["peaks"]["theta"]["max"]),
            ("end.theta.rate", &summary["end"]["v"]["theta.rate"]),
        ] {
            let found: f64 = rows[case][column].parse().unwrap();
            assert_eq!(Some(found), value.as_f64(), "{column} of case {case}");
        }
    }
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
fn random_variables_have_their_distribution_and_correlation() {
    let folder = folder();
    let study = json!({
        "scene": "scene.json",
        "random": {
            "variables": {
                "parameters.alpha": { "normal": { "mean": 0.3, "sd": 0.02 }, "above": 0.25 },
                "parameters.R": { "lognormal": { "median": 1.0, "beta": 0.1 } },
                "parameters.e": { "discrete": { "values": [0.8, 0.9], "weights": [1, 3] } },
                "initial.theta": { "triangular": { "from": 0.1, "mode": 0.1, "to": 0.2 } }
            },
            "correlations": [["parameters.alpha", "parameters.R", 0.6]],
            "count": 512,
            "design": "latin_hypercube"
        },
        "measure": ["count"]
    });
    write(folder.path(), "study.json", &study);
    let shorter = ["study", "study.json", "--out", "out", "--csv"];
    fs::write(
        folder.path().join("scene.json"),
        r#"{ "model": "rocking_block", "initial": { "side": 1 }, "end": 0.01 }"#,
    )
    .unwrap();
    ends_with(0, folder.path(), &shorter);
    let rows = table(&folder.path().join("out/runs.csv"));
    let column =
        |name: &str| -> Vec<f64> { rows.iter().map(|r| r[name].parse().unwrap()).collect() };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (alpha, radius) = (column("parameters.alpha"), column("parameters.R"));
    // The mean of a normal variable that is cut at -2.5: 0.3 + 0.02 φ(2.5)/Φ(2.5).
    assert!(
        (mean(&alpha) - 0.300_352_7).abs() < 2e-5,
        "{}",
        mean(&alpha)
    );
    assert!(alpha.iter().all(|a| *a > 0.25));
    let logarithms: Vec<f64> = radius.iter().map(|r| r.ln()).collect();
    assert!(mean(&logarithms).abs() < 5e-3);
    let deviations = |values: &[f64]| {
        let mean = mean(values);
        values.iter().map(|x| x - mean).collect::<Vec<_>>()
    };
    let (a, r) = (deviations(&alpha), deviations(&logarithms));
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let correlation = product(&a, &r) / (product(&a, &a) * product(&r, &r)).sqrt();
    // The copula is of the normal variables; cutting one at −2.5 changes next to nothing. 512 samples know it to 0.03.
    assert!((correlation - 0.6).abs() < 0.06, "{correlation}");
    // A hypercube hits each stratum once: three quarters to one sample.
    let many = column("parameters.e").iter().filter(|e| **e == 0.9).count();
    assert_eq!(many, 384);
    assert!((mean(&column("initial.theta")) - 0.4 / 3.0).abs() < 1e-4);
}

#[test]
fn what_cannot_run_is_a_row_with_a_reason() {
    let folder = folder();
    // A block that falls fast leaves the ground.
    let study = json!({
        "scene": "scene.json",
        "cases": [
            { "initial.theta": 0.2, "initial.theta.rate": 0, "initial.mode": "rocks" },
            { "initial.theta": 0.3, "initial.theta.rate": 3, "initial.mode": "rocks" },
            { "initial.theta": 0.0, "initial.theta.rate": 0, "initial.mode": "stands" },
            { "initial.theta": 0.3, "initial.theta.rate": 4, "initial.mode": "rocks" }
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
