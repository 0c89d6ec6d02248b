//! Limit states, validity and impacts that gain energy: in scenes, on the terminal, in the summary.

use super::*;
use serde_json::Value;

/// Runs a scene with `--out out`, which must end with status 0: what it wrote, and its summary.
fn summary(scene: &str) -> (Output, Value) {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("scene.json"), scene).unwrap();
    let output = ends_with(0, home.path(), &["run", "scene.json", "--out", "out"]);
    (output, json(&home.path().join("out/summary.json")))
}

/// What a scene is refused with.
fn refused(scene: &str) -> String {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("scene.json"), scene).unwrap();
    let output = ends_with(2, home.path(), &["run", "scene.json", "--out", "out"]);
    assert_eq!(names(home.path()), ["scene.json"], "nothing is written");
    stderr(&output).to_owned()
}

/// A block that falls over.
fn falling(limits: &str) -> String {
    format!(
        r#"{{ "model": "rocking_block", "initial": {{ "theta": 0.3 }}, "end": 1.9,
  "limits": {limits} }}"#
    )
}

#[test]
fn a_run_ends_at_a_limit_state_and_the_summary_names_it() {
    let (output, summary) = summary(&falling("{}"));
    assert!(summary["failure"].is_null());
    let states = summary["limit_states"].as_array().unwrap();
    assert_eq!(states.len(), 2);
    assert_eq!(states[0]["name"], "past_balance");
    assert_eq!(states[1]["name"], "overturned");
    assert_eq!(
        states[1]["message"],
        "the side of the block reaches the ground"
    );
    assert_eq!(states[1]["t"], summary["end"]["t"]);
    let text = stdout(&output);
    assert!(text.contains("limit       overturned at t = "), "{text}");
    assert!(text.contains("the run ends there"), "{text}");
}

#[test]
fn a_scene_says_what_is_done_at_limits_and_adds_its_own() {
    let limits = r#"{ "overturned": "continue",
    "leans": { "theta": { "above": "30 deg" }, "theta.rate": { "above": 100 }, "then": "continue", "message": "it leans" },
    "pressed": { "reaction.y": { "above": "1 kN" } } }"#;
    let scene = falling(limits).replace("1.9", "0.9");
    let (_, summary) = summary(&scene);
    let states = summary["limit_states"].as_array().unwrap();
    let named: Vec<_> = states.iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(named, ["past_balance", "leans"]);
    assert_eq!(states[1]["message"], "it leans");
    assert_eq!(summary["end"]["t"], 0.9);
    // By a limit of its own it ends.
    let (_, summary) = self::summary(&scene.replace("\"then\": \"continue\", ", ""));
    assert_eq!(summary["end"]["t"], summary["limit_states"][1]["t"]);
}

#[test]
fn wrong_limits_point_at_their_place() {
    for (limits, words) in [
        (
            r#"{ "overturned": "stop" }"#,
            [
                "unknown course `stop`",
                "scene.json:2:29",
                "`end`, `continue` or `ignore`",
            ],
        ),
        (
            r#"{ "overturnd": "continue" }"#,
            [
                "unknown limit: `overturnd`",
                "scene.json:2:28",
                "did you mean `overturned`?",
            ],
        ),
        (
            r#"{ "drift": { "w": { "above": 1 } } }"#,
            ["unknown quantity `w`", "scene.json:2:26", "`theta.rate`"],
        ),
        (
            r#"{ "drift": { "theta": { "above": "1 m" } } }"#,
            [
                "unit `m` does not fit, expected `rad`",
                "scene.json:2:46",
                "",
            ],
        ),
        (
            r#"{ "drift": { "theta": {} } }"#,
            ["missing", "scene.json:2:24", "such as"],
        ),
        (
            r#"{ "drift": { "then": "end" } }"#,
            ["missing", "scene.json:2:24", "such as"],
        ),
    ] {
        let message = refused(&falling(limits));
        for word in words {
            assert!(message.contains(word), "no `{word}` in\n{message}");
        }
    }
}

#[test]
fn a_run_says_before_and_after_what_the_model_is_not_meant_for() {
    let scene = r#"{ "model": "walking_tank", "parameters": { "B_plate": 1.0, "mu_s": 2, "mu_k": 2 },
  "initial": { "theta": 0.1, "theta.rate": 2.5 }, "end": 0.2 }"#;
    let (output, summary) = summary(scene);
    let lines: Vec<_> = stderr(&output)
        .lines()
        .filter(|l| l.starts_with("warning:"))
        .collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(lines[0].contains("the bottom plate is rigid"), "{lines:?}");
    assert!(lines[1].contains("the uplift is moderate"), "{lines:?}");
    let validity = summary["validity"].as_array().unwrap();
    assert_eq!(validity.len(), 2);
    assert!(validity[0]["t"].is_null());
    assert!(validity[1]["t"].as_f64().unwrap() > 0.0);
    assert!(stdout(&output).contains("validity    not "));
}

#[test]
fn impacts_that_gain_energy_are_flagged() {
    // Bulging towards the edge that lifts: after the landing it moves with the uplift.
    let scene = |side: i32, landing: &str| {
        format!(
            r#"{{ "model": "walking_tank", "landing": "{landing}", "parameters": {{ "mu_s": 1, "mu_k": 1 }},
  "initial": {{ "theta": 1e-4, "theta.rate": -0.1, "x_I.rate": 0.1, "side": {side} }}, "end": 0.01 }}"#
        )
    };
    let runs = [1, -1].map(|side| summary(&scene(side, "velocities")));
    let gains = |summary: &Value| summary["impacts"]["gains"].as_array().unwrap().clone();
    let (output, flagged) = runs
        .iter()
        .find(|(_, s)| !gains(s).is_empty())
        .expect("one gains");
    let gain = &gains(flagged)[0];
    assert_eq!(gain["transition"], "landing");
    assert!(gain["energy"].as_f64().unwrap() > 1e-3);
    assert!(gain["t"].as_f64().unwrap() > 0.0 && gain["j"].as_u64().unwrap() >= 1);
    let counted = flagged["impacts"]["landing"]["gaining"].as_u64().unwrap();
    assert_eq!(counted, gains(flagged).len() as u64);
    assert!(
        stderr(output).contains("warning: impacts gained energy"),
        "{}",
        stderr(output)
    );
    for side in [1, -1] {
        let (output, summary) = summary(&scene(side, "momenta"));
        assert!(gains(&summary).is_empty());
        assert_eq!(stderr(&output), "");
    }
}

#[test]
fn limits_and_validity_are_described() {
    let output = ends_with(0, &project(), &["describe", "walking_tank"]);
    let text = stdout(&output);
    for words in [
        "overturned",
        "the run ends",
        "past_balance",
        "it goes on",
        "the bottom plate is rigid",
        "the uplift is moderate",
    ] {
        assert!(text.contains(words), "no `{words}` in\n{text}");
    }
    let output = ends_with(0, &project(), &["describe", "coulomb_oscillator"]);
    assert!(stdout(&output).contains("<= stop"), "{}", stdout(&output));
}
