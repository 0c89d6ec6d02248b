//! Outputs in scenes: columns, peaks, limits over them, and what is said of those that are none.

use super::*;
use serde_json::Value;

/// A block that falls over, with these outputs and limits.
fn falling(outputs: &str, limits: &str) -> String {
    format!(
        r#"{{ "model": "rocking_block", "initial": {{ "theta": 0.3 }}, "end": 1.9,
  "outputs": {outputs},
  "limits": {limits}, "record": {{ "every": 0.1 }} }}"#
    )
}

/// Runs a scene with `--out out` and these arguments in a folder, which must end with this status.
fn ran(status: i32, home: &std::path::Path, scene: &str, more: &[&str]) -> Output {
    fs::write(home.join("scene.json"), scene).unwrap();
    let arguments = [&["run", "scene.json", "--out", "out"], more].concat();
    ends_with(status, home, &arguments)
}

#[test]
fn outputs_of_a_scene_are_recorded_and_may_be_limits() {
    let home = tempfile::tempdir().unwrap();
    let scene = falling(
        r#"{ "lean": { "expression": "side * theta", "unit": "deg", "meaning": "to the left" },
             "twice": { "expression": "2 * lean", "unit": "deg" } }"#,
        r#"{ "half way": { "lean": { "above": "45 deg" } } }"#,
    );
    let output = ran(0, home.path(), &scene, &[]);
    assert!(stdout(&output).contains("lean"), "{}", stdout(&output));
    let summary = json(&home.path().join("out/summary.json"));
    let states = summary["limit_states"].as_array().unwrap();
    assert_eq!(states.last().unwrap()["name"], "half way");
    let end = &summary["end"]["outputs"];
    let lean = end["lean"].as_f64().unwrap();
    assert!((lean - 45.0).abs() < 1e-12 && lean >= 45.0, "{lean}");
    assert_eq!(summary["peaks"]["lean"]["unit"], "deg");
    assert_eq!(summary["peaks"]["lean"]["max"].as_f64().unwrap(), lean);
    let theta = summary["end"]["q"]["theta"].as_f64().unwrap();
    assert!((end["rotation"].as_f64().unwrap() - theta).abs() < 1e-15);
    let table = fs::read_to_string(home.path().join("out/trajectory.csv")).unwrap();
    let header = table.lines().next().unwrap();
    assert!(
        header.contains(",edge.2.force,lean,twice,energy.stored"),
        "{header}"
    );
    let metadata = fs::read_to_string(home.path().join("out/csv-metadata.json")).unwrap();
    assert!(metadata.contains("to the left") && metadata.contains("2 * lean"));

    // A run goes on with the same outputs alone.
    let other = scene.replace("2 * lean", "3 * lean");
    let output = ran(2, home.path(), &other, &["--resume", "out"]);
    assert!(
        stderr(&output).contains("`outputs` is not what it was"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn what_is_no_output_is_told_with_its_place() {
    for (outputs, limits, place, message) in [
        (
            r#"{ "lean": { "expression": "side * thta", "unit": "1" } }"#,
            "{}",
            "thta",
            "unknown name `thta`",
        ),
        (
            r#"{ "lean": { "expression": "R + theta", "unit": "m" } }"#,
            "{}",
            "theta\"",
            "a term of dimension 1",
        ),
        (
            r#"{ "lean": { "expression": "R +", "unit": "m" } }"#,
            "{}",
            "\", \"unit\"",
            "the expression ends here",
        ),
        (
            r#"{ "lean": { "expression": "R", "unit": "mmm" } }"#,
            "{}",
            "\"mmm",
            "unknown unit `mmm`",
        ),
        (
            r#"{ "lean": { "expression": "R", "unit": "s" } }"#,
            "{}",
            "R\", ",
            "has the dimension m",
        ),
        (
            r#"{ "theta": { "expression": "R", "unit": "m" } }"#,
            "{}",
            "{ \"expression",
            "`theta` is there already",
        ),
        (
            r#"{ "lean": { "unit": "m" } }"#,
            "{}",
            "{ \"unit",
            "expression missing",
        ),
        (r#"{ "lean": 3 }"#, "{}", "3", "expected an object"),
        (
            r#"{ "lean": { "expression": "theta", "unit": "deg" } }"#,
            r#"{ "far": { "leen": { "above": 3 } } }"#,
            "\"leen",
            "unknown quantity `leen`",
        ),
        (
            r#"{ "lean": { "expression": "theta", "unit": "deg" } }"#,
            r#"{ "far": { "lean": { "above": "3 m" } } }"#,
            "\"3 m",
            "unit `m` does not fit, expected `deg`",
        ),
    ] {
        let home = tempfile::tempdir().unwrap();
        let output = ran(2, home.path(), &falling(outputs, limits), &[]);
        let text = stderr(&output);
        assert!(text.contains(message), "{outputs}: {text}");
        let scene = falling(outputs, limits);
        // The first line holds names of the model.
        let mut lines = scene.lines().zip(1..).skip(1);
        let at = lines.find_map(|(line, i)| Some((i, line.find(place)? + 1)));
        let (line, column) = at.unwrap();
        assert!(
            text.contains(&format!("scene.json:{line}:{column}\n")),
            "{outputs} {place}: {text}"
        );
        assert_eq!(names(home.path()), ["scene.json"], "nothing is written");
    }
}

#[test]
fn outputs_are_described() {
    let output = ends_with(0, &project(), &["describe", "rocking_block", "--json"]);
    let description: Value = serde_json::from_str(stdout(&output)).unwrap();
    let outputs = description["outputs"].as_array().unwrap();
    let names: Vec<_> = outputs
        .iter()
        .map(|o| o["name"].as_str().unwrap())
        .collect();
    assert_eq!(names[..2], ["rotation", "centre_x"]);
    assert_eq!(outputs[0]["unit"], "rad");
    let output = ends_with(0, &project(), &["describe", "rocking_block"]);
    assert!(stdout(&output).contains("rotation of the block, counter-clockwise"));
}

#[test]
fn a_scene_may_leave_them_out() {
    let home = tempfile::tempdir().unwrap();
    let set = "record.outputs=false";
    ran(0, home.path(), &falling("{}", "{}"), &["--set", set]);
    let summary = json(&home.path().join("out/summary.json"));
    assert_eq!(summary["end"]["outputs"], serde_json::json!({}));
    assert!(summary["peaks"]["rotation"].is_null());
}
