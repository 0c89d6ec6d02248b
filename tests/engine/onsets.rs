//! What is zero at an instant, up to rounding: contacts that close together, forces that set in, a touch.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use dalembert::model::models;
use dalembert::record::{Event, Run};
use dalembert::scene::{Disk, Scene};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

const METHODS: [Method; 3] = [Method::Auto, Method::Taylor, Method::Radau];

/// Three balls, of which the outer ones come from both sides at the same speed: left, right, left; then all contacts
/// open, and one of them is at a gap that rounding has made negative.
#[test]
fn a_contact_that_opens_does_not_collide() {
    for method in METHODS {
        for e in [0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
            for places in [[-1.0, 0.0, 1.0], [-0.7, 0.1, 0.9], [2.0, 3.3, 4.6]] {
                let mut balls = problem("meeting_balls", &[("e", e)]);
                balls.method = method;
                for (name, value) in ["p", "q", "r"].iter().zip(places) {
                    balls.set_initial(name, value).unwrap();
                }
                balls.set_initial("p.rate", 1.0).unwrap();
                balls.set_initial("r.rate", -1.0).unwrap();
                balls.end.time = 3.0;
                let run = run(&balls);
                let closes = |event: &Event| match event.transition {
                    "left" => event.before.v[1] - event.before.v[0],
                    _ => event.before.v[2] - event.before.v[1],
                };
                for event in &run.events {
                    assert!(closes(event) < 0.0, "{method:?} {e} {}", event.transition);
                }
                // Impacts at one instant, of which there are more the less they give back.
                let all = transitions(&run);
                assert!(all.len() >= 3, "{method:?} {e} {all:?}");
                assert!(all.windows(2).all(|pair| pair[0] != pair[1]), "{all:?}");
                if e == 0.5 {
                    assert_eq!(all.len(), 3, "{method:?} {all:?}");
                }
            }
        }
    }
}

/// Runs a scene with a method.
fn run_scene(text: &str, method: Method) -> (Problem, Run) {
    let path = Path::new("onsets.json");
    let mut problem = Scene::parse(text.as_bytes(), path, &[], models(), &Disk)
        .unwrap()
        .problem;
    problem.method = method;
    let run = run(&problem);
    (problem, run)
}

/// The same transitions at the same times, each to within `error` (s).
fn assert_same_events(a: &Run, b: &Run, error: f64) {
    assert_eq!(transitions(a), transitions(b));
    for (a, b) in a.events.iter().zip(&b.events) {
        let difference = (a.t - b.t).abs();
        assert!(
            difference < error,
            "{} at {} and {}",
            a.transition,
            a.t,
            b.t
        );
    }
}

/// The hopper takes off with the jerk, as height, rate and acceleration are zero; a condition that always holds changes
/// nothing, nor does what its coordinates are.
#[test]
fn a_hopper_takes_off_and_lands_whatever_the_method_and_the_wording() {
    let scene = |place: &str, landing: &str| {
        format!(
            r#"{{"model": "hopper", "place": "{place}", "landing": "{landing}",
            "parameters": {{"m1": 0.7040792813034902, "m2": 1.1522785010556584, "k": 3899.1546988159535, "c": 0}},
            "initial": {{"h": 0.4079095980614237, "r": {}, "mode": "flies"}},
            "end": 5, "accuracy": {{"relative": 1e-12}}, "record": {{"every": 0.001}}}}"#,
            if place == "height" {
                0.4079095980614237
            } else {
                0.0
            }
        )
    };
    let (_, first) = run_scene(&scene("height", "free"), Method::Radau);
    assert!(first.events.len() > 10, "{:?}", transitions(&first));
    for (place, landing) in [
        ("height", "free"),
        ("height", "conditional"),
        ("elongation", "free"),
        ("elongation", "conditional"),
    ] {
        for method in METHODS {
            let (_, run) = run_scene(&scene(place, landing), method);
            assert_same_events(&first, &run, 1e-9);
            let column = run.trajectory.column("h").unwrap();
            for row in 0..run.trajectory.len() {
                let h = run.trajectory.row(row)[column];
                assert!(
                    h >= 0.0,
                    "{place}, {landing}, {method:?}: {h:e} at {}",
                    run.trajectory.t[row]
                );
            }
        }
    }
}

/// A full plate that begins to slip where static and kinetic friction are the same: rate and acceleration of the slip
/// are zero, and what is computed of them is noise.
#[test]
fn a_slip_that_sets_in_smoothly_begins() {
    let scene = r#"{"model": "walking_tank", "parameters": {"set": "full_plate", "mu_s": 0.5, "mu_k": 0.5, "damping": 0.3},
        "inputs": {"ground_acceleration": {"sine": {"amplitude": 7.88, "frequency": 1.1}}}, "end": 1.2}"#;
    let (_, first) = run_scene(scene, Method::Radau);
    assert_eq!(
        transitions(&first),
        ["slip", "stick", "slip", "stick", "slip"]
    );
    for method in METHODS {
        assert_same_events(&first, &run_scene(scene, method).1, 1e-6);
    }
}

/// A tank that rests after landings while its edge is about to be lifted.
#[test]
fn a_lift_off_that_sets_in_smoothly_begins() {
    let scene = r#"{"model": "walking_tank", "landing": "velocities",
        "parameters": {"set": "doughnut", "mu_s": 0.8889834703715283, "mu_k": 0.8889834703715283,
            "e": 0.37066000290178647, "damping": 0},
        "end": 1.0481981934636022,
        "inputs": {"ground_acceleration": {"sine": {"amplitude": 13.68527913829423, "frequency": 1.8416665982623404,
            "phase": 0, "start": 0.1462627267634814}}},
        "accuracy": {"relative": 1e-11}}"#;
    let (_, first) = run_scene(scene, Method::Radau);
    for method in METHODS {
        assert_same_events(&first, &run_scene(scene, method).1, 1e-6);
    }
}

/// A forced oscillation whose turning point is the stop, as exactly as numbers say it: a touch, whatever rounding makes
/// of it. An impact there, if any, is none of a contact that opens.
#[test]
fn at_an_exact_graze_no_contact_collides_while_it_opens() {
    let reference = reference("07_grazing");
    for case in reference["reference"]["grazing"].as_array().unwrap() {
        let [omega, zeta, grazing, stop, lag] =
            ["omega", "zeta", "F_graz", "sigma", "phase_lag"].map(|key| number(&case[key]));
        for method in METHODS {
            for (place, relative) in [
                (0.0, 1e-8),
                (0.0, 1e-13),
                (1.0, 1e-8),
                (2.5, 1e-10),
                (4.0, 1e-12),
            ] {
                let parameters = [
                    ("c", 2.0 * zeta),
                    ("static_friction", 0.0),
                    ("kinetic_friction", 0.0),
                    ("stop", stop),
                ];
                let mut oscillator = problem("hand_coulomb", &parameters);
                oscillator.method = method;
                // F cos(ωt + φ) gives x = x₀ cos(ωt + φ − lag).
                let phase = lag + FRAC_PI_2 + place;
                let force = Sine::new(grazing, omega, phase + FRAC_PI_2);
                oscillator
                    .set_input("force", Function::from(force))
                    .unwrap();
                let angle = FRAC_PI_2 + place;
                let rate = -omega * stop * angle.sin();
                oscillator.set_initial("x", stop * angle.cos()).unwrap();
                oscillator.set_initial("x.rate", rate).unwrap();
                oscillator.set_initial("slip", 1f64.copysign(rate)).unwrap();
                oscillator.set_tolerance(relative);
                oscillator.end.time = 3.0 * TAU / omega + 0.1 * PI;
                let run = run(&oscillator);
                for event in run.events.iter().filter(|e| e.transition == "impact") {
                    let [x, v] = [event.before.q[0], event.before.v[0]];
                    assert!(
                        x * v >= 0.0,
                        "{method:?} {place} {relative}: x = {x}, v = {v} at {}",
                        event.t
                    );
                }
            }
        }
    }
}

/// A contact that leaves its gap by less than a step of the implicit method shows, and closes in a step at whose end the gap
/// rises again: the mass would swing 2 µm below the floor and back.
#[test]
fn a_gap_that_is_below_zero_in_the_middle_of_a_step_alone_has_closed() {
    for tolerance in [1e-3, 1e-4, 1e-6, 1e-10] {
        with_each_method(|| {
            let mut problem = problem("sunk_mass", &[]);
            problem.set_initial("y", 1.0).unwrap();
            problem.set_initial("y.rate", 1e-14).unwrap();
            problem.set_tolerance(tolerance);
            problem.end.time = 20.0;
            problem.record.every = Some(0.1);
            problem.record.columns.outputs = true;
            let run = run(&problem);
            let column = run.trajectory.column("floor.gap").expect("a column");
            for (i, t) in run.trajectory.t.iter().enumerate() {
                let gap = run.trajectory.row(i)[column];
                assert!(gap > -1e-15, "{tolerance:e}, {t}: sinks by {gap:e}");
            }
            let force = run.trajectory.column("floor.normal").expect("a column");
            let last = run.trajectory.row(run.trajectory.t.len() - 1)[force];
            assert!((last - 1e-6).abs() < 1e-15, "{last:e}");
        });
    }
}
