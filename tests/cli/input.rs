//! Wrong input: status 2, file, line, column and a caret, and nothing is written.

use super::*;

/// A right scene. Each test replaces a part of it.
const RIGHT: &str = r#"{
  "model": "walking_tank",
  "parameters": { "set": "full_plate" },
  "inputs": { "ground_acceleration": null },
  "initial": { "theta": 0.02, "side": 1 },
  "end": 0.01
}
"#;

/// Marks in a text where the error must point. It is taken out before the text is used.
const HERE: char = '¶';

/// Replaces a part of the right scene, and expects the error at the mark, with these words.
fn is_refused(part: &str, instead: &str, words: &[&str]) {
    assert_eq!(
        RIGHT.matches(part).count(),
        1,
        "`{part}` is once in the scene"
    );
    let marked = RIGHT.replace(part, instead);
    check("scene.json", &marked, &[("scene.json", &marked)], words);
}

/// Writes the files without their marks, and runs the scene. The error is at the mark in `wrong`.
fn check(wrong: &str, marked: &str, files: &[(&str, &str)], words: &[&str]) {
    let home = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(home.path().join(name), text.replace(HERE, "")).unwrap();
    }
    let before = names(home.path());
    let output = ends_with(2, home.path(), &["run", "scene.json", "--out", "out"]);
    let message = stderr(&output);
    let (line, column) = place(marked);
    let place = format!("{wrong}:{line}:{column}\n");
    assert!(message.contains(&place), "no `{place}` in\n{message}");
    assert!(message.contains('^'), "no caret in\n{message}");
    for word in words {
        assert!(message.contains(word), "no `{word}` in\n{message}");
    }
    assert_eq!(stdout(&output), "");
    assert_eq!(names(home.path()), before, "nothing is written");
}

/// Line and column of the mark, from 1.
fn place(marked: &str) -> (usize, usize) {
    let (before, _) = marked.split_once(HERE).expect("the text is marked");
    let line = before.rsplit('\n').next().unwrap_or(before);
    (before.matches('\n').count() + 1, line.chars().count() + 1)
}

#[test]
fn the_right_scene_is_right() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("scene.json"), RIGHT).unwrap();
    ends_with(0, home.path(), &["run", "scene.json", "--out", "out"]);
}

#[test]
fn malformed_json() {
    is_refused(r#""end": 0.01"#, r#""end": 0.01¶ "model""#, &["error: "]);
    is_refused(r#""end": 0.01"#, r#""end": ¶// soon"#, &["error: "]);
}

#[test]
fn unknown_key() {
    let words = ["unknown key `parametres`", "did you mean `parameters`?"];
    is_refused(r#""parameters""#, r#"¶"parametres""#, &words);
}

/// A scene of the format that is read says so or not; of one of another format nothing else is said.
#[test]
fn format_of_another_version() {
    let home = tempfile::tempdir().unwrap();
    let with = RIGHT.replacen('{', r#"{ "format": 1,"#, 1);
    fs::write(home.path().join("scene.json"), with).unwrap();
    ends_with(0, home.path(), &["run", "scene.json", "--out", "out"]);
    let summary = fs::read_to_string(home.path().join("out/summary.json")).unwrap();
    assert!(summary.starts_with("{\n  \"format\": 1,"), "{summary}");

    let words = [
        "this scene has format 2, and this version of dalembert reads format 1",
        "version of dalembert that it was written for",
    ];
    let end = r#""end": 0.01"#;
    is_refused(end, r#""end": 0.01, "format": ¶2, "of_later": 1"#, &words);
    is_refused(end, r#""end": 0.01, "format": ¶"new""#, &["expected"]);
}

/// Static equilibrium is found near what is given, or the scene is refused at its initial state.
#[test]
fn initial_state_at_rest() {
    let home = tempfile::tempdir().unwrap();
    for initial in [r#""at rest""#, r#"{ "at_rest": true, "x_I": 1e-3 }"#] {
        let scene = RIGHT
            .replace(r#"{ "theta": 0.02, "side": 1 }"#, initial)
            .replace("null", r#"{ "constant": 0.8 }"#);
        fs::write(home.path().join("scene.json"), scene).unwrap();
        ends_with(0, home.path(), &["run", "scene.json", "--out", "out"]);
        let summary = fs::read_to_string(home.path().join("out/summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
        let bulge = summary["end"]["q"]["x_I"].as_f64().unwrap();
        let omega = 2.0 * std::f64::consts::PI * 26.0;
        assert!((bulge + 0.8 / (omega * omega)).abs() < 1e-18, "{bulge}");
        assert!(summary["projected"]["x_I"].is_f64(), "{summary}");
    }
    let state = r#"{ "theta": 0.02, "side": 1 }"#;
    let words = [
        "no static equilibrium is found near",
        "the force along `x` vanishes",
    ];
    let slides = r#"¶"initial": { "mode": "rocks_slides", "theta": 0.02, "at_rest": true }"#;
    is_refused(&format!(r#""initial": {state}"#), slides, &words);
    let moves = r#"{ "at_rest": true, "x.rate": ¶1 }"#;
    is_refused(state, moves, &["what starts at rest has no velocity"]);
    is_refused(state, r#"¶"resting""#, &["at rest"]);
}

#[test]
fn missing_key() {
    let missing = RIGHT
        .replacen('{', "¶{", 1)
        .replace(",\n  \"end\": 0.01", "");
    check(
        "scene.json",
        &missing,
        &[("scene.json", &missing)],
        &["end missing", "add `end`"],
    );
}

#[test]
fn wrong_type() {
    is_refused(
        "0.02",
        r#"¶[0.02]"#,
        &["expected a number in rad, found a list"],
    );
}

#[test]
fn unit_of_another_dimension() {
    is_refused(
        "0.02",
        r#"¶"20 mm""#,
        &["unit `mm` does not fit, expected `rad`"],
    );
}

#[test]
fn number_that_is_not_finite() {
    is_refused("0.02", "¶1e999", &["`1e999` is not a finite number"]);
    is_refused("0.02", "¶NaN", &["error: "]);
}

#[test]
fn negative_mass_friction_and_time() {
    let set = r#""set": "full_plate""#;
    is_refused(
        set,
        r#""M_S": ¶-7.5"#,
        &["-7.5 is not admissible", "> 0 kg"],
    );
    is_refused(set, r#""mu_s": ¶-0.1"#, &["-0.1 is not admissible", ">= 0"]);
    is_refused("0.01", "¶-0.01", &["-0.01 is not admissible", "> 0 s"]);
}

#[test]
fn kinetic_friction_above_static_friction() {
    let words = [
        "mu_k = 0.3 exceeds mu_s = 0.2",
        "lower `mu_k` or raise `mu_s`",
    ];
    is_refused(
        r#""set": "full_plate""#,
        r#""mu_s": 0.2, "mu_k": ¶0.3"#,
        &words,
    );
}

#[test]
fn unknown_model_mode_and_coordinate() {
    let words = [
        "unknown model `walking_tnak`",
        "did you mean `walking_tank`?",
    ];
    is_refused(r#""walking_tank""#, r#"¶"walking_tnak""#, &words);
    let words = ["unknown mode `rocks_stick`", "did you mean `rocks_sticks`?"];
    is_refused(r#""side": 1"#, r#""mode": ¶"rocks_stick""#, &words);
    let words = ["unknown coordinate `thetta`", "did you mean `theta`?"];
    is_refused(r#""theta""#, r#"¶"thetta""#, &words);
}

#[test]
fn initial_state_that_violates_its_mode() {
    let state = r#""theta": 0.02"#;
    let words = ["mode `stands_sticks` holds `theta` at 0 rad"];
    is_refused(state, r#""mode": "stands_sticks", "theta": ¶0.02"#, &words);
    is_refused(
        state,
        r#""theta": ¶-0.02"#,
        &["-0.02 is not admissible", ">= 0"],
    );
}

#[test]
fn initial_state_that_only_the_functions_of_the_model_can_judge() {
    // The rate of the belt is a parameter.
    let marked = r#"{
  "model": "belt_oscillator",
  ¶"initial": { "mode": "belt sticks", "x.rate": 0.5 },
  "end": 1
}"#;
    let words = ["mode `belt sticks`", "`x.rate` at 0.1 m/s"];
    check("scene.json", marked, &[("scene.json", marked)], &words);
}

#[test]
fn table_with_unsorted_times() {
    let scene = RIGHT.replace("null", r#"{ "table": { "file": "record.csv" } }"#);
    let table = "t,a\n0,0\n0.2,1\n¶0.1,2\n";
    let files = [("scene.json", scene.as_str()), ("record.csv", table)];
    check("record.csv", table, &files, &["0.1", "0.2"]);
}

#[test]
fn missing_table() {
    let table = r#"{ "table": { "file": ¶"record.csv" } }"#;
    is_refused(
        "null",
        table,
        &["cannot read", "record.csv", "No such file"],
    );
}

#[test]
fn missing_scene() {
    let home = tempfile::tempdir().unwrap();
    let output = ends_with(2, home.path(), &["run", "scene.json", "--out", "out"]);
    assert!(stderr(&output).contains("cannot read `scene.json`"));
    assert!(names(home.path()).is_empty());
}

#[test]
fn wrong_overrides_point_into_the_command_line() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("scene.json"), RIGHT).unwrap();
    for (setting, place, words) in [
        ("parameters.mu=0.3", "--set:1:12", "unknown parameter `mu`"),
        ("end=-1", "--set:1:5", "-1 is not admissible"),
        ("end", "--set:1:1", "="),
    ] {
        let arguments = ["run", "scene.json", "--out", "out", "--set", setting];
        let output = ends_with(2, home.path(), &arguments);
        let message = stderr(&output);
        assert!(message.contains(place), "no `{place}` in\n{message}");
        assert!(message.contains(words), "no `{words}` in\n{message}");
    }
    assert_eq!(names(home.path()), ["scene.json"]);
}

#[test]
fn all_independent_errors_come_at_once() {
    let home = tempfile::tempdir().unwrap();
    let scene = RIGHT.replace("0.02", "\"2 kg\"").replace("0.01", "0");
    fs::write(home.path().join("scene.json"), scene).unwrap();
    let output = ends_with(2, home.path(), &["run", "scene.json"]);
    assert_eq!(stderr(&output).matches("error: ").count(), 2);
}

#[test]
fn an_initial_state_beyond_a_stop() {
    let scene = r#"{
  "model": "coulomb_oscillator",
  "parameters": { "static_friction": 0, "kinetic_friction": 0, "stop": 1.0 },
  "initial": { "x": ¶2 },
  "end": 1
}
"#;
    let words = [
        "the initial state is beyond a stop",
        "right strikes",
        "admissible side",
    ];
    check("scene.json", scene, &[("scene.json", scene)], &words);
}

/// A constraint that is a coordinate and a gap that is one, which need no multipliers.
const PIN: &str = r#"
from codegen.model import *
model = Model("Pin", source="test model")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness", above=0)
l = model.parameter("l", "m", 1.0, "place", above=0)
x = model.coordinate("x", "m", "place")
y = model.coordinate("y", "m", "height")
model.point_mass(m, position=(x, y))
model.potential(k * (x - y)**2 / 2)
model.constraint("pin", x - l)
model.contact("floor", gap=y)
"#;

#[test]
fn a_state_that_modes_do_not_hold_is_refused_or_projected() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("pin")).unwrap();
    fs::write(folder.path().join("pin/model.py"), PIN).unwrap();
    let scene = |project: &str| {
        let text = format!(
            r#"{{ "model": "./pin", "initial": {{ "x": 0.9, "x.rate": 0.5, "y": -0.2{project} }}, "end": 1 }}"#
        );
        fs::write(folder.path().join("pin.json"), text).unwrap();
        let mut command = dalembert(folder.path());
        command.args(["run", "pin.json", "--out", "out"]).assert()
    };
    let refused = scene("").code(2);
    let refused = stderr(refused.get_output());
    for said in [
        "-0.2 is not admissible",
        "`\"project\": true`",
        "holds `x` at 1 m",
    ] {
        assert!(refused.contains(said), "{refused}");
    }
    scene(r#", "project": true"#).success();
    let summary = json(&folder.path().join("out/summary.json"));
    let moved: Vec<_> = ["x", "y", "x.rate"]
        .map(|name| summary["projected"][name].as_f64().unwrap())
        .into();
    assert_eq!(moved, [1.0 - 0.9, 0.2, -0.5], "{summary}");
}

/// Lines that solve for no coordinate, which hold two coordinates of three, and a switch that holds the third for good.
const LOCKED: &str = r#"
from codegen.model import *

model = Model("Two held", source="test model")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
x, y, z = [model.coordinate(name, "m", "a place") for name in "xyz"]
model.kinetic(m * (x.rate**2 + y.rate**2 + z.rate**2) / 2 + m * x.rate * z.rate / 3)
model.constraint("a", 2 * x - 0.3 * y)
model.constraint("b", 0.7 * x + 3 * y)
model.contact("floor", gap=z, restitution=0.5, switch=True)
"#;

#[test]
fn what_constraints_leave_nothing_of_is_projected() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("locked")).unwrap();
    fs::write(folder.path().join("locked/model.py"), LOCKED).unwrap();
    for floor in ["on", "off", "permanent"] {
        let text = format!(
            r#"{{ "model": "./locked", "contacts": {{ "floor": "{floor}" }}, "end": 1,
                "initial": {{ "x": 0.9, "x.rate": 0.5, "y.rate": -0.37, "z": -0.1, "project": true }} }}"#
        );
        fs::write(folder.path().join("locked.json"), text).unwrap();
        let mut command = dalembert(folder.path());
        let command = command.args(["run", "locked.json", "--out", "out"]);
        command.assert().success();
        let end = &json(&folder.path().join("out/summary.json"))["end"];
        for name in ["x", "y"] {
            let [q, v] = [&end["q"][name], &end["v"][format!("{name}.rate")]];
            let off = q.as_f64().unwrap().abs() + v.as_f64().unwrap().abs();
            assert!(off < 1e-15, "{floor}: {end}");
        }
        // Inertia couples z to x: the projection moves it by 0.9 m / 3, and leaves it 0.5 / 3 m/s.
        let z = end["q"]["z"].as_f64().unwrap();
        let exact = if floor == "permanent" {
            0.0
        } else {
            0.2 + 0.5 / 3.0
        };
        assert!((z - exact).abs() < 1e-14, "{floor}: {end}");
    }
}
