//! What solvers do for the shipped scenes, counted: a change that costs steps, or finds other events, shows in
//! the difference of `tests/data/counters.txt`. Steps have the same bits on every machine, and so have their
//! numbers.

use serde_json::Value;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Renews the snapshot.
const RENEW: &str = "DALEMBERT_RENEW";

/// What is counted of a run, in the order of the columns.
const COUNTED: [&str; 5] = [
    "steps",
    "rejected",
    "residual_evaluations",
    "jacobian_evaluations",
    "factorizations",
];

fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A line: scene, method, its orders, counters, events by transition.
fn line(scene: &Path, method: &str) -> String {
    let name = scene.file_stem().unwrap().to_str().unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("counters-{name}-{method}"));
    let run = Command::new(env!("CARGO_BIN_EXE_dalembert"))
        .arg("run")
        .arg(scene)
        .arg("--out")
        .arg(&folder)
        .args(["--set", &format!("method={method}"), "--set", "record={}"])
        .output()
        .expect("the program can be run");
    let complaint = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{name} by {method}: {complaint}");
    let summary = std::fs::read(folder.join("summary.json")).expect("the run has a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("the summary is JSON");
    let (solver, events) = (&summary["solver"], &summary["events"]["by_transition"]);
    let mut line = format!(
        "{name} by {method} ({})",
        solver["method"].as_str().unwrap()
    );
    for what in COUNTED {
        let count = solver[what].as_u64().expect("a counter");
        let _ = write!(line, ", {what} {count}");
    }
    for (transition, count) in events.as_object().expect("events by transition") {
        let _ = write!(line, ", {count} × {transition}");
    }
    line + "\n"
}

#[test]
fn solvers_do_what_they_did_for_the_shipped_scenes() {
    let mut scenes: Vec<_> = std::fs::read_dir(project("scenes"))
        .expect("there are scenes")
        .map(|entry| entry.expect("the folder can be read").path())
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .collect();
    scenes.sort();
    assert!(!scenes.is_empty());
    // Radau does not pass singular positions at this tolerance.
    let passes = |scene: &Path| scene.ends_with("double_four_bar.json");
    let each = |scene: &PathBuf| match passes(scene) {
        true => line(scene, "auto"),
        false => ["auto", "radau"].map(|method| line(scene, method)).concat(),
    };
    let found: String = scenes.iter().map(each).collect();
    let snapshot = project("tests/data/counters.txt");
    if std::env::var_os(RENEW).is_some() {
        std::fs::write(&snapshot, found).expect("the snapshot can be written");
        return;
    }
    let known = std::fs::read_to_string(&snapshot).unwrap_or_default();
    let without = |lines: &str, others: &str| -> String {
        let lines = lines.lines().filter(|l| !others.lines().any(|o| o == *l));
        lines.map(|line| format!("  {line}\n")).collect()
    };
    assert!(
        found == known,
        "counters have changed\nfrom\n{}to\n{}If that is meant, renew them by\n  {RENEW}=1 cargo test --test counters\n\
         and look at the difference of tests/data/counters.txt",
        without(&known, &found),
        without(&found, &known)
    );
}
