//! Slips and constraints that solve for a coordinate (codegen/lines.py): the reduced form, in which that coordinate depends on
//! others, against multipliers, and against what rolling is.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, Simulator};
use dalembert::model::models;
use dalembert::record::Run;
use dalembert::scene::{Disk, Scene, SceneErrors};
use std::path::Path;

/// A wheel that is thrown, driven back and forth, and turns another: it rolls and slips in turn.
const WHEEL: &str = r#"{
    "model": "rolling_wheel", "form": "FORM",
    "initial": { "x": 0.2, "phi.rate": 6, "psi.rate": 15 },
    "inputs": { "moment": { "sine": { "amplitude": 9, "angular_frequency": 2 } } },
    "end": 20, "accuracy": { "relative": 1e-12 }, "record": { "every": 0.05 }
}"#;

fn read(text: &str, form: &str) -> Result<Problem, SceneErrors> {
    let text = text.replace("FORM", form);
    let scene = Scene::parse(
        text.as_bytes(),
        Path::new("lines.json"),
        &[],
        models(),
        &Disk,
    );
    Ok(scene?.problem)
}

/// The wheel in the reduced form, by both methods.
fn reduced() -> impl Iterator<Item = (String, Problem)> {
    by_both_methods("wheel", WHEEL.replace("FORM", "reduced"))
}

/// Wheels on a rail and thrown on the ground, in the reduced form, by both methods.
pub fn wheels() -> impl Iterator<Item = (String, Problem)> {
    let impacts = r#"{ "law": "newton", "order": "together" }"#;
    reduced().chain(by_both_methods("thrown wheel", thrown("reduced", impacts)))
}

fn by_both_methods(name: &'static str, scene: String) -> impl Iterator<Item = (String, Problem)> {
    [Method::Auto, Method::Radau]
        .into_iter()
        .map(move |method| {
            let mut problem = read(&scene, "").unwrap();
            problem.method = method;
            (format!("{name} by {method:?}"), problem)
        })
}

/// A wheel that is thrown on the ground, spinning, with a part that slides along its hub.
fn thrown(form: &str, impacts: &str) -> String {
    format!(
        r#"{{ "model": "thrown_wheel", "form": "{form}", "impacts": {impacts},
            "initial": {{ "x": 0.2, "y": 0.8, "phi.rate": 25, "z.rate": 0.5 }},
            "inputs": {{ "moment": {{ "sine": {{ "amplitude": 3, "angular_frequency": 2 }} }} }},
            "end": 6, "accuracy": {{ "relative": 1e-12 }}, "record": {{ "every": 0.05 }} }}"#
    )
}

fn rows<'r>(run: &'r Run, name: &str) -> impl Iterator<Item = f64> + use<'r> {
    let column = run.trajectory.column(name).expect("a column");
    (0..run.trajectory.len()).map(move |i| run.trajectory.row(i)[column])
}

/// The least and the largest value of a column.
fn extremes(run: &Run, name: &str) -> [f64; 2] {
    let column = run.trajectory.column(name).expect("a column");
    let found = run.peaks.iter().find(|(i, _)| *i == column);
    let peak = found.expect("it has a peak").1;
    [peak.min, peak.max]
}

fn names(run: &Run) -> Vec<&str> {
    run.events.iter().map(|e| e.transition).collect()
}

#[test]
fn both_forms_move_alike_and_no_row_is_beyond_the_extremes() {
    // The errors of Radau add up over 20 s; the series of the other method have roundings alone.
    for (method, error) in [(Method::Auto, 1e-11), (Method::Radau, 1e-9)] {
        let [one, other] = ["reduced", "multipliers"].map(|form| {
            let mut problem = read(WHEEL, form).unwrap();
            problem.method = method;
            problem.record.columns.energies = true;
            run(&problem)
        });
        assert!(one.events.len() >= 6, "{:?}", names(&one));
        assert_eq!(names(&one), names(&other));
        for name in ["x", "phi", "psi", "x.rate", "phi.rate", "psi.rate"] {
            for (a, b) in rows(&one, name).zip(rows(&other, name)) {
                assert!(
                    (a - b).abs() < error * (1.0 + a.abs()),
                    "{name}: {a} and {b}"
                );
            }
            let [own, by_multipliers] = [&one, &other].map(|run| extremes(run, name));
            for (a, b) in own.iter().zip(by_multipliers) {
                assert!(
                    (a - b).abs() < error * (1.0 + a.abs()),
                    "{name}: {a} and {b}"
                );
            }
            let beyond = rows(&one, name).find(|x| !(own[0] <= *x && *x <= own[1]));
            assert_eq!(beyond, None, "{name}: {own:?}");
        }
        for run in [&one, &other] {
            let energy = run.energy.as_ref().unwrap();
            assert!(energy.imbalance().abs() < 1e-10, "{energy:?}");
        }
    }
}

#[test]
fn what_is_held_holds_to_roundings_in_every_row() {
    for (name, problem) in reduced() {
        let run = run(&problem);
        for (phi, psi) in rows(&run, "phi").zip(rows(&run, "psi")) {
            assert!(
                (psi - 2.5 * phi).abs() <= 4.0 * f64::EPSILON * psi.abs(),
                "{phi} {psi}"
            );
        }
        // Where it rolls, it goes r for a turn of 1 rad, from where it began to.
        let mut rolls = 0;
        for (event, next) in run.events.iter().zip(&run.events[1..]) {
            if event.transition != "rail sticks" {
                continue;
            }
            rolls += 1;
            let line = |x: f64, phi: f64| x - 0.3 * phi;
            let [began, ended] = [&event.after, &next.before].map(|s| line(s.q[0], s.q[1]));
            assert!((ended - began).abs() < 1e-14, "{name}: {began} {ended}");
            assert!((next.before.v[0] - 0.3 * next.before.v[1]).abs() < 1e-14);
        }
        assert!(rolls >= 2, "{name}: {:?}", names(&run));
    }
}

#[test]
fn a_wheel_that_rolls_has_the_period_of_its_whole_inertia() {
    // m ẍ (1 + J/mr² + j ratio²/mr²) = −k x.
    for method in [Method::Auto, Method::Radau] {
        let text = r#"{ "model": "rolling_wheel", "initial": { "x": 0.1, "phi": 7 },
            "end": 3, "accuracy": { "relative": 1e-12 }, "record": { "every": 0.1 } }"#;
        let mut problem = read(text, "").unwrap();
        problem.method = method;
        let run = run(&problem);
        let inertia = 2.0 + (0.09 + 0.02 * 2.5 * 2.5) / 0.09;
        let frequency = (8.0_f64 / inertia).sqrt();
        assert!(run.events.is_empty());
        let [x, psi] = ["x", "psi"].map(|name| rows(&run, name).collect::<Vec<_>>());
        let t = &run.trajectory.t;
        for i in 0..t.len() {
            let exact = 0.1 * (frequency * t[i]).cos();
            assert!((x[i] - exact).abs() < 1e-11, "{} and {exact}", x[i]);
            let turned = 2.5 * (7.0 + (exact - 0.1) / 0.3);
            assert!((psi[i] - turned).abs() < 1e-9, "{} and {turned}", psi[i]);
        }
    }
}

#[test]
fn a_wheel_moves_as_by_modes_that_are_written_by_hand() {
    let mut by_hand = problem("hand_wheel", &[]);
    let by_contacts = read(WHEEL, "reduced").unwrap();
    by_hand.set_initial("slipped", 0.2).unwrap();
    by_hand.set_initial("slipped.rate", -1.8).unwrap();
    by_hand.set_initial("phi.rate", 6.0).unwrap();
    by_hand.signals = by_contacts.signals.clone();
    by_hand.set_tolerance(1e-12);
    by_hand.end.time = 20.0;
    by_hand.record.every = Some(0.05);
    let [one, other] = [&by_contacts, &by_hand].map(run);
    assert_eq!(one.events.len(), other.events.len());
    let of_hub = rows(&other, "slipped").zip(rows(&other, "phi"));
    let there = rows(&one, "x").zip(rows(&one, "phi"));
    for ((x, phi), (slipped, other)) in there.zip(of_hub) {
        assert!((x - (slipped + 0.3 * other)).abs() < 1e-10, "{x}");
        assert!((phi - other).abs() < 1e-10, "{phi} and {other}");
    }
}

/// The message of a scene that cannot start, or the place where it does.
fn start(initial: &str) -> Result<(Vec<f64>, Vec<f64>), String> {
    let text = format!(r#"{{ "model": "rolling_wheel", "initial": {initial}, "end": 0.1 }}"#);
    let problem = read(&text, "").map_err(|e| e.to_string())?;
    let simulator = Simulator::new(&problem).map_err(|e| e.to_string())?;
    Ok((simulator.q()[..3].to_vec(), simulator.v()[..3].to_vec()))
}

#[test]
fn what_depends_on_others_follows_at_the_start_and_is_refused_elsewhere() {
    // The belt holds in every mode: where the scene says nothing of psi, it follows.
    let (q, v) = start(r#"{ "phi": 2, "phi.rate": 1, "x.rate": 0.3 }"#).unwrap();
    assert_eq!(
        (&q[..], &v[..]),
        (&[0.0, 2.0, 5.0][..], &[0.3, 1.0, 2.5][..])
    );
    // A rate that rolls but for its rounding rolls.
    let (_, v) = start(r#"{ "phi.rate": 0.7, "x.rate": 0.21 }"#).unwrap();
    assert_eq!(v[0], 0.3 * 0.7);
    let (_, v) = start(r#"{ "mode": "rail sticks", "phi.rate": 0.7 }"#).unwrap();
    assert_eq!(v, [0.3 * 0.7, 0.7, 2.5 * 0.7]);
    let refused = start(r#"{ "phi": 2, "psi": 4.9 }"#).unwrap_err();
    assert!(refused.contains("holds `psi` at 5 rad"), "{refused}");
    let refused = start(r#"{ "phi.rate": 2, "psi.rate": 4 }"#).unwrap_err();
    assert!(refused.contains("`psi.rate` at 5 rad/s"), "{refused}");
    // It rolls from the start: it does not come to that by an event.
    let text = r#"{ "model": "rolling_wheel", "initial": { "phi": 2, "psi": 4.9, "project": true }, "end": 0.1 }"#;
    let run = run(&read(text, "").unwrap());
    assert!(run.events.is_empty(), "{:?}", run.events);
    assert!((run.subject.projected[0].1 - 0.1).abs() < 1e-15);
    assert_eq!(&*run.subject.projected[0].0, "psi");
    assert_eq!(run.trajectory.row(0)[..3], [0.0, 2.0, 5.0]);
}

#[test]
fn what_depends_on_others_is_not_frozen() {
    let text = r#"{ "model": "rolling_wheel", "freeze": ["x"], "end": 0.1 }"#;
    let refused = read(text, "").unwrap_err().to_string();
    assert!(refused.contains("`x`"), "{refused}");
}

#[test]
fn a_scene_may_name_a_law_of_impacts_where_all_are_the_same() {
    let scene = |impacts: &str| {
        let text = format!(
            r#"{{ "model": "bouncing_ball", "initial": {{ "h": 1 }}, "end": 2{impacts} }}"#
        );
        run(&read(&text, "").unwrap())
    };
    let [one, other] = ["", r#", "impacts": { "law": "poisson" }"#].map(scene);
    assert_eq!(one.events, other.events);
}

/// A gap with friction along a line whose inertia another coordinate shares. At impacts the forms, and whatever law decides them, agree; nothing
/// acts on the part that slides along the hub, so that its momentum stays.
#[test]
fn impacts_with_friction_agree_in_both_forms_by_all_laws() {
    let laws = ["newton", "poisson"].map(|law| ["together", "sequence"].map(|order| (law, order)));
    let moved = |form: &str, (law, order): (&str, &str)| {
        let impacts = format!(r#"{{ "law": "{law}", "order": "{order}" }}"#);
        run(&read(&thrown(form, &impacts), "").unwrap())
    };
    for way in laws.into_iter().flatten() {
        let [one, other] = ["reduced", "multipliers"].map(|form| moved(form, way));
        assert!(names(&one).contains(&"ground sticks"), "{:?}", names(&one));
        let ends = [&one, &other].map(|run| &run.end);
        for i in 0..4 {
            for [a, b] in [ends.map(|s| s.state.q[i]), ends.map(|s| s.state.v[i])] {
                assert!((a - b).abs() < 1e-9, "{way:?}, {i}: {a} and {b}");
            }
        }
        assert_eq!(one.layout.impulses, other.layout.impulses);
        for event in one.events.iter().chain(&other.events) {
            let [before, after] = [&event.before.v, &event.after.v].map(|v| v[0] + v[3]);
            assert!((before - after).abs() < 1e-14, "{way:?}: {event:?}");
            // The impulses are what changes the momenta: 2 kg along y and x, 0.09 kg m² about the hub.
            let change = |i: usize| event.after.v[i] - event.before.v[i];
            let [normal, friction] = event.impulses[..] else {
                panic!("{event:?}");
            };
            let momenta = [
                (normal, 2.0 * change(1)),
                (friction, 2.0 * change(0)),
                (-0.3 * friction, 0.09 * change(2)),
            ];
            for (impulse, momentum) in momenta {
                assert!((impulse - momentum).abs() < 1e-13, "{way:?}: {event:?}");
            }
        }
        let momentum: Vec<f64> = rows(&one, "x.rate")
            .zip(rows(&one, "z.rate"))
            .map(|(x, z)| x + z)
            .collect();
        assert!(momentum.iter().all(|p| (p - 0.5).abs() < 1e-12), "{way:?}");
        assert!(
            one.energy.as_ref().unwrap().imbalance().abs() < 1e-11,
            "{way:?}"
        );
    }
}
