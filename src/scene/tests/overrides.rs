//! `--set path=value`.

use super::*;
use crate::hybrid::Problem;
use crate::scene::SceneErrorKind;

const SMALL: &str = r#"{ "model": "walking_tank", "end": 1, "inputs": { "ground_acceleration": null },
    "freeze": ["x", "y"] }"#;

fn set(overrides: &[&str]) -> Problem {
    parse_with(SMALL.as_bytes(), overrides, &[])
        .unwrap()
        .problem
}

#[test]
fn values_replace_and_add() {
    let scene = set(&[
        "end=2.5",
        "rules=paper",
        "parameters.mu_s=0.3",
        "parameters.R_0=270 mm",
        "inputs.ground_acceleration.sine.amplitude=10",
        r#"inputs.ground_acceleration.sine.frequency="7 Hz""#,
        "initial.theta=0.01",
        "initial.theta.rate=-0.5",
        "freeze.1=x_I",
        "freeze=[]",
        "accuracy.absolute.theta.rate=1e-9",
    ]);
    assert_eq!(scene.end.time, 2.5);
    let rules = scene.model.choices.iter().position(|c| c.name == "rules");
    assert_eq!(scene.variant().options[rules.unwrap()], "paper");
    assert_eq!(
        scene.parameters[scene.model.parameter("R_0").unwrap()],
        0.27
    );
    let theta = scene.model.coordinate("theta").unwrap();
    assert_eq!(
        (scene.initial.q[theta], scene.initial.v[theta]),
        (0.01, -0.5)
    );
    assert_eq!(scene.accuracy.v_absolute[theta], 1e-9);
    assert!(scene.freeze.is_empty());
    let mut u = [0.0; 6];
    scene.signals.evaluate(1.0 / 28.0, &mut u);
    assert!((u[0] - 10.0).abs() < 1e-13);
}

#[test]
fn the_last_one_wins() {
    assert_eq!(set(&["end=2", "end=3"]).end.time, 3.0);
}

#[test]
fn errors_point_into_the_argument() {
    let error = only_error(parse_with(SMALL.as_bytes(), &["parameters.mu_s=-0.3"], &[]));
    let position = error.position().unwrap();
    assert_eq!(
        (position.file.as_str(), position.line, position.column),
        ("--set", 1, 17)
    );
    assert_eq!(
        error.to_string(),
        "error: -0.3 is not admissible here: it must be >= 0
 --> --set:1:17
  |
1 | parameters.mu_s=-0.3
  |                 ^^^^"
    );
}

#[test]
fn wrong_arguments_are_explained() {
    for (argument, message, column) in [
        ("end", "there is no `=`", 1),
        ("=3", "a name is missing in the path", 1),
        ("parameters..mu_s=3", "a name is missing in the path", 12),
        ("end.after=3", "`after` cannot be set inside a number", 5),
        ("freeze.2=\"x\"", "`2` selects nothing from a list of 2", 8),
        (
            "freeze.first=\"x\"",
            "`first` selects nothing from a list of 2",
            8,
        ),
        ("parameters.mu=3", "unknown parameter `mu`", 12),
        (
            "end=2,5",
            "`2,5` is not a number with a unit: unknown unit `,`",
            5,
        ),
        ("parameters.R_0=1e999", "`1e999` is not a finite number", 16),
    ] {
        let error = only_error(parse_with(SMALL.as_bytes(), &[argument], &[]));
        assert_eq!(error.kind().to_string(), message);
        let position = error.position().unwrap();
        assert_eq!(
            (position.file.as_str(), position.column),
            ("--set", column),
            "{argument}"
        );
    }
}

#[test]
fn engine_can_point_at_what_only_it_can_judge() {
    let scene = parse_with(
        FULL.as_bytes(),
        &["initial.x_I=0.1"],
        &[("record.csv", RECORD.as_bytes())],
    );
    let source = scene.unwrap().source;
    let position = |path| {
        let error = source.error_at(path, "the edge would sink", Some("start elsewhere"));
        assert_eq!(error.suggestion(), Some("start elsewhere"));
        assert!(matches!(error.kind(), SceneErrorKind::State { .. }));
        let position = error.position().unwrap();
        (position.file, position.line, position.column)
    };
    let file = || "scenes/test.json".to_owned();
    assert_eq!(position("initial.theta.rate"), (file(), 18, 69));
    assert_eq!(
        position("initial.x"),
        (file(), 18, 3),
        "no entry: the key of the object"
    );
    assert_eq!(position("initial.x_I"), ("--set".to_owned(), 1, 13));
    assert_eq!(position("nowhere"), (file(), 1, 1));
}
