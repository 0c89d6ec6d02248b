//! A gap that solves for a coordinate (codegen/lines.py): the reduced form, in which the height of a ball on the ground depends on its
//! place, against multipliers; where hops end; and states that gaps do not admit.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, Simulator};
use dalembert::model::models;
use dalembert::record::Run;
use dalembert::scene::{Disk, Scene, SceneErrors};
use std::path::Path;

/// A ball that is thrown over hills; it hops, rolls through valleys and leaves tops.
const BALL: &str = r#"{
    "model": "hilly_ball", "form": "FORM", "parameters": { "level": LEVEL, "e": RESTITUTION },
    "initial": { "x": 0.3, "x.rate": 3, "y": "HEIGHT m" },
    "end": 12, "accuracy": { "relative": 1e-12 }, "record": { "every": 0.05 }
}"#;

fn read(text: &str) -> Result<Problem, SceneErrors> {
    let path = Path::new("hills.json");
    let scene = Scene::parse(text.as_bytes(), path, &[], models(), &Disk);
    Ok(scene?.problem)
}

fn ball(form: &str, level: f64, restitution: f64) -> Problem {
    let text = (BALL.replace("FORM", form))
        .replace("LEVEL", &level.to_string())
        .replace("RESTITUTION", &restitution.to_string())
        .replace("HEIGHT", &(level + 1.0).to_string());
    read(&text).unwrap()
}

/// Gaps of all rows, with the magnitude of what they are the difference of, and of what the rounding of x makes of it.
fn gaps(run: &Run, level: f64) -> impl Iterator<Item = (f64, f64)> {
    (0..run.trajectory.len()).map(move |i| {
        let [x, y] = [0, 1].map(|k| run.trajectory.row(i)[k]);
        let ground = level + 0.2 * x.cos();
        (y - ground, y.abs() + level.abs() + 0.2 * (1.0 + x.abs()))
    })
}

#[test]
fn both_forms_move_alike_and_hops_end() {
    // Hops end below the rounding of the gap before they end below the tolerances.
    let error = 1e-10;
    for (level, restitution) in [(0.0, 0.6), (0.0, 0.0), (100.0, 0.6), (-3.0, 0.85)] {
        for method in [Method::Auto, Method::Radau] {
            let [one, other] = ["reduced", "multipliers"].map(|form| {
                let mut problem = ball(form, level, restitution);
                problem.method = method;
                problem.record.columns.energies = true;
                run(&problem)
            });
            let of = format!("{level} m, e = {restitution}, {method:?}");
            assert!(one.events.len() < 250, "{of}: {} events", one.events.len());
            let ends = [&one, &other].map(|run| {
                let last = run.trajectory.len() - 1;
                run.trajectory.row(last)[..4].to_vec()
            });
            for (a, b) in ends[0].iter().zip(&ends[1]) {
                assert!((a - b).abs() < error, "{of}: {ends:?}");
            }
            for run in [&one, &other] {
                for (gap, magnitude) in gaps(run, level) {
                    assert!(gap >= -2.0 * f64::EPSILON * magnitude, "{of}: {gap:e}");
                }
                let energy = run.energy.as_ref().unwrap();
                assert!(energy.imbalance().abs() < error, "{of}: {energy:?}");
            }
            // It has come to rest on the ground, and stays on it.
            let names: Vec<_> = one.events.iter().map(|e| e.transition).collect();
            assert!(restitution == 0.0 || names.contains(&"rest"), "{of}");
            let at_last = gaps(&one, level).last().unwrap();
            assert!(at_last.0.abs() <= 2.0 * f64::EPSILON * at_last.1, "{of}");
        }
    }
}

/// Coordinates and rates at the start of a scene, or why it has none.
fn start(initial: &str, form: &str) -> Result<[Vec<f64>; 2], String> {
    let text = format!(
        r#"{{ "model": "hilly_ball", "form": "{form}", "initial": {initial}, "end": 0.1 }}"#
    );
    let problem = read(&text).map_err(|e| e.to_string())?;
    let simulator = Simulator::new(&problem).map_err(|e| e.to_string())?;
    Ok([simulator.q(), simulator.v()].map(|all| all[..2].to_vec()))
}

#[test]
fn a_state_that_the_ground_does_not_admit_is_refused_or_projected() {
    let refused = start(r#"{ "x": 0.3, "y": -0.5 }"#, "reduced").unwrap_err();
    assert!(refused.contains("-6.91067"), "{refused}");
    // Of what the gap is solved for; by multipliers to the nearest place.
    let projected = r#"{ "x": 0.3, "y": -0.5, "y.rate": 1, "project": true }"#;
    let [q, v] = start(projected, "reduced").unwrap();
    assert_eq!((q[0], &v[..]), (0.3, &[0.0, 1.0][..]));
    assert_eq!(q[1], 0.2 * 0.3_f64.cos());
    let [q, _] = start(projected, "multipliers").unwrap();
    assert!((q[1] - 0.2 * q[0].cos()).abs() < 1e-16 && q[0] > 0.3);
    // What is admitted stays where it is.
    let admitted = r#"{ "x": 0.3, "y": 0.5, "project": true }"#;
    let [q, _] = start(admitted, "reduced").unwrap();
    assert_eq!(q, [0.3, 0.5]);
}

#[test]
fn a_gap_that_is_a_coordinate_is_projected_too() {
    let scene = |text: &str| {
        read(&format!(
            r#"{{ "model": "bouncing_ball", "end": 0.5, {text} }}"#
        ))
    };
    let refused = scene(r#""initial": { "h": -0.1 }"#).unwrap_err();
    let refused = refused.to_string();
    assert!(refused.contains(">= 0 m"), "{refused}");
    let problem = scene(r#""initial": { "h": -0.1, "h.rate": 1, "project": true }"#).unwrap();
    let run = run(&problem);
    assert_eq!(run.subject.projected, [("h".into(), 0.1)]);
    assert!(run.trajectory.row(0)[0] == 0.0 && run.trajectory.row(0)[1] == 1.0);
}
