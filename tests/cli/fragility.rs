//! `fragility`: a curve fitted to a table.

use std::fs;

use serde_json::Value;

use super::{ends_with, stderr, stdout};

fn folder_with(table: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("table.csv"), table).unwrap();
    folder
}

fn shown(table: &str) -> Value {
    let folder = folder_with(table);
    let output = ends_with(0, folder.path(), &["fragility", "table.csv", "--json"]);
    serde_json::from_str(stdout(&output)).expect("JSON")
}

#[test]
fn counts_and_capacities_are_fitted() {
    let fit = shown("im,n,k\n0.5,10,2\n1.0,10,7\n");
    let near = |value: &Value, exact: f64| (value.as_f64().unwrap() / exact - 1.0).abs() < 1e-10;
    assert!(near(&fit["theta"], 0.766_369_023_203_009_4));
    assert!(near(&fit["beta_interval"][1], 3.503_842_816_215_785));
    assert_eq!(fit["problem"], Value::Null);
    let fit = shown("capacity;censored\n0.5;0\n0.7;0\n1;1\n");
    assert!(fit["theta"].as_f64().unwrap() > 0.7);
    assert_eq!(fit["counted"], Value::Null);
    let fit = shown("capacity\n0.5\n0.7\n");
    assert!(near(&fit["counted"][1], 0.6));
}

#[test]
fn the_bootstrap_is_made_on_request() {
    let folder = folder_with("im,n,k\n0.5,40,4\n1.0,40,19\n1.5,40,33\n");
    let asked = ["fragility", "table.csv", "--json", "--bootstrap"];
    let fit: Value = serde_json::from_slice(&ends_with(0, folder.path(), &asked).stdout).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let error = |key: &str| (number(&fit[key][1]) / number(&fit[key][0])).ln();
    assert!(number(&fit["theta_bootstrap"][0]) < number(&fit["theta"]));
    assert!(number(&fit["theta"]) < number(&fit["theta_bootstrap"][1]));
    // Both are of 95 % confidence: for 120 runs as wide as each other to a quarter.
    let ratio = error("theta_bootstrap") / error("theta_interval");
    assert!((ratio - 1.0).abs() < 0.25, "{ratio}");
    assert_eq!(fit["bootstrap_samples"], 1000);
    let plain = ends_with(0, folder.path(), &["fragility", "table.csv", "--json"]);
    assert!(!stdout(&plain).contains("bootstrap"));
    let shown = ends_with(0, folder.path(), &asked[..2]);
    assert!(!stdout(&shown).contains("bootstrap"));
    let shown = ends_with(0, folder.path(), &["fragility", "table.csv", "--bootstrap"]);
    assert!(stdout(&shown).contains("bootstrap        theta "));
}

#[test]
fn what_is_not_determined_is_a_sentence_and_no_number() {
    let fit = shown("im,n,k\n0.2,10,0\n0.4,10,0\n0.6,10,10\n");
    let problem = fit["problem"].as_str().unwrap();
    assert!(problem.starts_with("perfect separation"), "{problem}");
    assert_eq!(
        (&fit["theta"], &fit["beta_interval"]),
        (&Value::Null, &Value::Null)
    );
    let folder = folder_with("capacity\n0.8\n");
    let output = ends_with(0, folder.path(), &["fragility", "table.csv"]);
    assert!(stdout(&output).contains("no fragility is fitted: one capacity, 0.8, is the median"));
}

#[test]
fn a_wrong_table_is_refused_at_its_place() {
    let folder = folder_with("im,n,k\n0.2,10,12\n");
    let output = ends_with(2, folder.path(), &["fragility", "table.csv"]);
    let told = stderr(&output);
    assert!(
        told.contains("12 failures among 10 runs") && told.contains("table.csv:2:8"),
        "{told}"
    );
    ends_with(2, folder.path(), &["fragility", "no.csv"]);
}
