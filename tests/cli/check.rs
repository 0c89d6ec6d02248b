//! `check`: the judgement on a model folder.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::{ends_with, stderr, stdout};

const MODEL: &str = r#"from codegen.model import *

model = Model("Ball", source="this test")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
h = model.coordinate("h", "m", "height", minimum=0)
model.point_mass(m, position=(0, h))
model.potential(m * h)
flies = model.mode("flies")
model.transition("impact", flies, flies, when=falls(m), impact=True)
"#;

/// Writes a model.
fn model(folder: &Path, text: &str) {
    fs::create_dir_all(folder.join("ball")).unwrap();
    fs::write(folder.join("ball/model.py"), text).unwrap();
}

/// What `check --json` prints.
fn judgement(status: i32, folder: &Path, model: &str) -> Value {
    let output = ends_with(status, folder, &["check", model, "--json"]);
    serde_json::from_str(stdout(&output)).unwrap()
}

#[test]
fn all_errors_are_told_with_line_and_caret() {
    let folder = tempfile::tempdir().unwrap();
    model(folder.path(), MODEL);
    let answer = judgement(2, folder.path(), "ball");
    assert_eq!(
        (&answer["model"], &answer["ok"]),
        (&json!("ball"), &json!(false))
    );
    let errors = answer["errors"].as_array().unwrap();
    let lines: Vec<_> = errors.iter().map(|e| (&e["file"], &e["line"])).collect();
    let file = json!("ball/model.py");
    assert_eq!(lines, [(&file, &json!(7)), (&file, &json!(9))]);
    for error in errors {
        for key in ["column", "message", "help"] {
            assert!(error.get(key).is_some(), "{key}: {error}");
        }
    }
    let output = ends_with(2, folder.path(), &["check", "ball"]);
    let text = stderr(&output);
    for part in [
        "potential energy: the term `(m*h)` has the dimension kg m, expected kg m^2/s^2",
        "--> ball/model.py:7:1",
        "model.potential(m * h)\n  | ^^^^",
        "guard of `impact`: `m` never changes",
    ] {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}

#[test]
fn a_good_model_is_described() {
    let folder = tempfile::tempdir().unwrap();
    let good = MODEL.replace("falls(m)", "falls(h)");
    let good = good.replace(
        "model.potential(m * h)",
        "model.gravity(model.parameter('g', 'm/s^2', 9.81, 'gravity'))",
    );
    model(folder.path(), &good);
    let answer = judgement(0, folder.path(), "./ball");
    assert_eq!(
        (&answer["ok"], &answer["errors"]),
        (&json!(true), &json!([]))
    );
    let mode = &answer["modes"][0];
    assert_eq!(mode["name"], "flies");
    assert_eq!(mode["free"], json!(["h"]));
    assert_eq!(mode["guards"], json!(["impact"]));
    assert!(mode["operations"]["residual"].as_u64().unwrap() > 0);
    // The folder in which one is.
    let answer = judgement(0, &folder.path().join("ball"), ".");
    assert_eq!(answer["model"], "ball");
}

#[test]
fn operations_are_counted_of_the_default_options() {
    let folder = tempfile::tempdir().unwrap();
    let tank = super::project()
        .join("models/walking_tank")
        .display()
        .to_string();
    let output = ends_with(0, folder.path(), &["check", &tank]);
    let text = stdout(&output);
    let counts: Vec<&str> = (text.lines())
        .filter_map(|line| {
            line.rsplit_once("; ")?
                .1
                .strip_suffix(" operations in all its functions")
        })
        .collect();
    assert_eq!(counts.len(), 4, "{text}");
    assert!(
        counts.iter().all(|n| n.parse::<u64>().unwrap() > 0),
        "{text}"
    );
}

#[test]
fn what_is_no_model_folder_is_told() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    fs::create_dir(folder.path().join("empty")).unwrap();
    model(folder.path(), "1 +");
    for (name, says) in [
        ("nowhere", "no model folder: No such file"),
        ("file", "a file, not a model folder"),
        ("empty", "the model folder has no readable model.py"),
        ("ball", "SyntaxError: invalid syntax"),
    ] {
        let output = ends_with(2, folder.path(), &["check", name]);
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
        let answer = judgement(2, folder.path(), name);
        let message = answer["errors"][0]["message"].as_str().unwrap();
        assert!(message.contains(says), "{message}");
    }
}
