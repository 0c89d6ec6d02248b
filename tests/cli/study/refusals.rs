//! Wrong studies: status 2, the place, what would be right, and nothing written.

use std::fs;

use serde_json::{Value, json};

use super::super::{ends_with, stderr};
use super::{folder, sweep, write};

/// Changes to the sweep, and parts of what is said about each.
fn cases() -> Vec<(&'static str, Value, Vec<&'static str>)> {
    vec![
        (
            "/scene",
            json!("missing.json"),
            vec![
                "cannot read `missing.json`",
                "study.json:",
                "relative to the folder of the study",
            ],
        ),
        (
            "/vary",
            json!({ "parameters.alfa": [0.2] }),
            vec![
                "unknown parameter `alfa`",
                "study.json:",
                "did you mean `alpha`?",
            ],
        ),
        (
            "/vary",
            json!({ "parameter.alpha": [0.2] }),
            vec!["unknown key `parameter`", "did you mean `parameters`?"],
        ),
        (
            "/vary",
            json!({ "parameters.alpha": [0.2, -0.1] }),
            vec!["-0.1 is not admissible here: it must be", "study.json:"],
        ),
        (
            "/vary",
            json!({ "parameters.alpha": ["0.2 m"] }),
            vec!["unit `m` does not fit, expected `rad`"],
        ),
        (
            "/vary",
            json!({ "parameters.alpha": [] }),
            vec!["`parameters.alpha` has no values"],
        ),
        (
            "/vary",
            json!({ "parameters.alpha": { "from": 0.2, "to": 0.3 } }),
            vec!["count or step missing"],
        ),
        (
            "/vary",
            json!({ "parameters.alpha": { "from": 0.2, "to": 0.3, "step": 0.03 } }),
            vec!["such that whole steps lead from 0.2 to 0.3"],
        ),
        (
            "/vary",
            json!({ "initial.theta": { "from": 0, "to": 0.3, "count": 3, "spacing": "log" } }),
            vec!["> 0 with `\"spacing\": \"log\"`"],
        ),
        (
            "/vary",
            json!({ "model": ["walking_tank"] }),
            vec!["a study is about one model"],
        ),
        ("/vary", json!({}), vec!["a study says what varies"]),
        (
            "/measure",
            json!(["peak.phi"]),
            vec!["unknown quantity `phi`", "study.json:"],
        ),
        (
            "/measure",
            json!(["mean.theta"]),
            vec!["unknown kind of measure `mean`", "`peak`"],
        ),
        (
            "/measure",
            json!(["count.base strike"]),
            vec![
                "unknown transition `base strike`",
                "did you mean `base strikes`?",
            ],
        ),
        (
            "/failure",
            json!({ "limit": "overturn" }),
            vec![
                "unknown limit state `overturn`",
                "did you mean `overturned`?",
            ],
        ),
        (
            "/failure",
            json!({ "measure": "peak.theta", "above": "1 m" }),
            vec!["unit `m` does not fit, expected `rad`"],
        ),
        (
            "/failure",
            json!({ "measure": "peak.theta" }),
            vec!["above or below missing"],
        ),
        (
            "/random",
            json!({ "variables": { "parameters.R": { "normal": { "mean": 1, "sd": 0.5 } } }, "count": 200 }),
            vec!["is not admissible here: it must be > 0 m"],
        ),
        (
            "/random",
            json!({ "variables": { "parameters.R": { "normal": { "mean": 1, "sd": 0 } } }, "count": 2 }),
            vec!["0 is not admissible here: it must be > 0 m"],
        ),
        (
            "/random",
            json!({ "variables": { "parameters.R": { "gauss": {} } }, "count": 2 }),
            vec!["unknown kind of distribution `gauss`", "`normal`"],
        ),
        (
            "/random",
            json!({ "variables": { "parameters.R": { "uniform": { "from": 2, "to": 1 } } }, "count": 2 }),
            vec!["> 2, the smallest value"],
        ),
        (
            "/random",
            json!({ "variables": { "parameters.e": { "discrete": { "values": [0.5], "weights": [0] } } }, "count": 2 }),
            vec!["1 values need as many weights"],
        ),
        (
            "/random",
            json!({ "variables": { "parameters.e": { "uniform": { "from": 0.5, "to": 0.6 } } }, "count": 4 }),
            vec!["`parameters.e` varies twice"],
        ),
        (
            "/random",
            json!({ "variables": { "parameters.R": { "uniform": { "from": 0.5, "to": 0.6 } } }, "count": 4000000000_u64 }),
            vec!["8.0000e10 cases would take at least", "are free"],
        ),
        (
            "/random",
            json!({ "variables": {
                "parameters.R": { "uniform": { "from": 0.5, "to": 0.6 } },
                "parameters.m": { "uniform": { "from": 0.5, "to": 0.6 } } },
            "correlations": [["parameters.R", "parameters.m", 1.0]], "count": 4 }),
            vec!["not positive definite"],
        ),
        (
            "/ida",
            json!({ "intensity": "parameters.g", "first": 1, "step": 1 }),
            vec!["failure missing"],
        ),
        (
            "/ida",
            json!({ "intensity": "initial.mode", "first": 1, "step": 1 }),
            vec!["`initial.mode` is not a number in a scene"],
        ),
        (
            "/cloud",
            json!({ "intensity": "parameters.g" }),
            vec!["unknown path that varies `parameters.g`"],
        ),
        (
            "/stripes",
            json!({ "intensity": "parameters.e", "levels": [0.5] }),
            vec!["`parameters.e` varies twice"],
        ),
        (
            "/group",
            json!("parameters.g"),
            vec!["unknown path that varies `parameters.g`"],
        ),
        (
            "/cases",
            json!([{ "parameters.g": 9 }, { "parameters.R": 2 }]),
            vec!["this case has no `parameters.g`"],
        ),
        (
            "/cases",
            json!("missing.csv"),
            vec!["cannot read `missing.csv`"],
        ),
        (
            "/vary",
            json!({ "parameters.alpha": { "from": 0.2, "to": 2, "count": 3 } }),
            vec!["2 is not admissible here: it must be > 0 rad and <= 1.57"],
        ),
        (
            "/vary",
            json!({ "inputs.ground_acceleration": [{ "record": "missing.AT2" }] }),
            vec!["cannot read `missing.AT2`", "study.json:"],
        ),
        (
            "/vary",
            json!({ "inputs.ground_acceleration.scale": [1, 2] }),
            vec!["unknown kind of input `scale`", "`record`"],
        ),
        (
            "/critical",
            json!({ "value": "parameters.g", "from": 1, "to": -1 }),
            vec!["-1 is not admissible here: it must be >= 0 m/s^2"],
        ),
        (
            "/ida",
            json!({ "intensity": "parameters.g", "first": 0, "step": 1 }),
            vec!["0 is not admissible here: it must be > 0"],
        ),
        ("/colour", json!("red"), vec!["unknown key `colour`"]),
        (
            "/second_runs",
            json!("some"),
            vec!["unknown rule `some`", "`near`"],
        ),
    ]
}

#[test]
fn a_wrong_study_is_refused_at_its_place() {
    let folder = folder();
    let mut wrong = Vec::new();
    for (pointer, value, said) in cases() {
        let mut study = sweep();
        study[&pointer[1..]] = value;
        write(folder.path(), "study.json", &study);
        let output = ends_with(2, folder.path(), &["study", "study.json", "--out", "out"]);
        let told = stderr(&output);
        if !said.iter().all(|part| told.contains(part)) {
            wrong.push(format!("{pointer}: {said:?}\n{told}"));
        }
        assert!(!folder.path().join("out").exists(), "{pointer}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn a_limit_that_the_scene_ignores_is_not_measured() {
    let folder = folder();
    let scene = fs::read_to_string(folder.path().join("scene.json")).unwrap();
    let mut scene: Value = serde_json::from_str(&scene).unwrap();
    scene["limits"] = json!({ "overturned": "ignore" });
    write(folder.path(), "scene.json", &scene);
    let mut study = sweep();
    for (key, value) in [
        ("measure", json!(["peak.theta", "reached.overturned"])),
        ("failure", json!({ "limit": "overturned" })),
    ] {
        study["measure"] = json!(["peak.theta"]);
        study[key] = value;
        write(folder.path(), "study.json", &study);
        let output = ends_with(2, folder.path(), &["study", "study.json", "--out", "out"]);
        let told = stderr(&output);
        let said = "the scene ignores the limit state `overturned`";
        assert!(told.contains(said), "{told}");
        assert!(told.contains("study.json:"), "{told}");
        assert!(!folder.path().join("out").exists());
    }
    // Where nothing is named, what is ignored is left out.
    let study = json!({ "scene": "scene.json", "vary": { "parameters.e": [0.8, 0.9] } });
    write(folder.path(), "study.json", &study);
    let rows = super::run(folder.path());
    let columns: Vec<&String> = rows[0].keys().collect();
    assert!(rows[0].contains_key("reached.past_balance"), "{columns:?}");
    assert!(!rows[0].contains_key("reached.overturned"), "{columns:?}");
}

#[test]
fn tables_of_cases_are_refused_at_their_line() {
    let folder = folder();
    let study = json!({ "scene": "scene.json", "cases": "cases.csv" });
    write(folder.path(), "study.json", &study);
    for (table, said) in [
        ("", "the table is empty"),
        ("parameters.R\n", "the table has no rows"),
        ("parameters.R,parameters.g\n1,9\n1\n", "cases.csv:3:1"),
        ("parameters.R\n1\n-1\n", "cases.csv:3:1"),
        ("parameters.Q\n1\n", "cases.csv:1:12"),
    ] {
        fs::write(folder.path().join("cases.csv"), table).unwrap();
        let output = ends_with(2, folder.path(), &["study", "study.json", "--out", "out"]);
        assert!(
            stderr(&output).contains(said),
            "{table:?}: {}",
            stderr(&output)
        );
    }
    fs::write(
        folder.path().join("cases.csv"),
        "# two\nparameters.R, parameters.g\n1, 9\n2, 9.81\n",
    )
    .unwrap();
    ends_with(0, folder.path(), &["study", "study.json", "--out", "out"]);
}

#[test]
fn folders_of_others_are_left_alone() {
    let folder = folder();
    write(folder.path(), "study.json", &sweep());
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::write(folder.path().join("out/notes.txt"), "mine").unwrap();
    let output = ends_with(2, folder.path(), &["study", "study.json", "--out", "out"]);
    assert!(stderr(&output).contains("it holds `notes.txt`"));
    let output = ends_with(
        2,
        folder.path(),
        &["study", "study.json", "--out", "study.json"],
    );
    assert!(stderr(&output).contains("exists and is not a folder"));
    let output = ends_with(
        2,
        folder.path(),
        &["study", "study.json", "--out", "new", "--resume"],
    );
    assert!(stderr(&output).contains("there is no study here to go on with"));
    assert!(!folder.path().join("new").exists());
}
