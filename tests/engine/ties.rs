//! Frictions whose slips inertia couples, of which several reach their limits at one instant: the modes of the reduced form decide what
//! multipliers do.

use crate::common::random::Random;
use dalembert::hybrid::{Problem, Reason, simulate};
use dalembert::model::models;
use dalembert::record::{Run, Silent};
use dalembert::scene::{Disk, Scene};
use serde_json::json;
use std::path::Path;

/// Random scenes in the suite; `DALEMBERT_RANDOM_SCENES=2000` runs as many.
const SHARE: u64 = 60;

fn problem(form: &str, scene: &serde_json::Value) -> Problem {
    let mut scene = scene.clone();
    scene["model"] = json!("tied_frictions");
    scene["form"] = json!(form);
    let text = scene.to_string();
    let path = Path::new("ties.json");
    let scene = Scene::parse(text.as_bytes(), path, &[], models(), &Disk);
    scene.unwrap_or_else(|errors| panic!("{errors}")).problem
}

fn both(scene: &serde_json::Value) -> [Run; 2] {
    let run = |form| simulate(&problem(form, scene), &mut Silent);
    ["reduced", "multipliers"].map(|form| run(form).unwrap_or_else(|why| panic!("{scene}: {why}")))
}

/// Why a run stopped, in short.
fn stop(run: &Run) -> String {
    match run.failure.as_ref().map(|failure| &failure.reason) {
        None => String::new(),
        Some(Reason::SeveralMotions { motions, .. }) => {
            let mut motions = motions.clone();
            motions.sort();
            motions.join(" or ")
        }
        Some(other) => other.to_string(),
    }
}

/// Two masses, the third far from its limit.
fn two(coupling: f64, more: serde_json::Value) -> serde_json::Value {
    let mut parameters = json!({ "coupling_ab": coupling, "share_c": 0 });
    for (name, value) in more.as_object().unwrap() {
        parameters[name] = value.clone();
    }
    json!({
        "parameters": parameters, "end": 3, "accuracy": { "relative": 1e-11 },
        "inputs": { "F": { "sine": { "amplitude": 4, "angular_frequency": 1 } } },
    })
}

#[test]
fn of_two_that_relieve_each_other_either_may_slip() {
    let either = "a slides, b sticks, c sticks or a sticks, b slides, c sticks";
    for (coupling, more) in [
        (0.3, json!({})),
        (-0.3, json!({ "share_b": -1 })),
        // Another load, and the same instant.
        (0.3, json!({ "share_b": 2, "static_b": 6 })),
    ] {
        for run in both(&two(coupling, more)) {
            assert_eq!(stop(&run), either);
            // 4 sin t reaches 3.
            assert!((run.end.t - 0.75f64.asin()).abs() < 1e-15, "{}", run.end.t);
        }
    }
}

#[test]
fn two_that_load_each_other_slip_together() {
    for (coupling, more) in [
        (-0.3, json!({})),
        (0.3, json!({ "share_b": -1 })),
        // Nothing drops.
        (0.3, json!({ "kinetic_a": 3, "kinetic_b": 3 })),
    ] {
        for run in both(&two(coupling, more)) {
            assert_eq!(stop(&run), "");
            assert_eq!(
                run.layout.modes.name(run.end.mode),
                "a slides, b slides, c sticks"
            );
            let [one, other] = [0, 1].map(|i| run.end.state.q[i].abs());
            assert!((one - other).abs() < 1e-14 * one, "{one} and {other}");
        }
    }
}

#[test]
fn what_holds_below_its_limit_does_not_slip_in_place_of_another() {
    // Where b slid, a would hold.
    for run in both(&two(0.3, json!({ "static_b": 3.2 }))) {
        assert_eq!(stop(&run), "");
        assert_eq!(run.events[0].transition, "a slips");
    }
    // One drops at its limit, the other does not: that which drops leaves the other where it is.
    for (name, first) in [("kinetic_b", "a slips"), ("kinetic_a", "b slips")] {
        for run in both(&two(0.3, json!({ name: 3 }))) {
            assert_eq!(stop(&run), "");
            assert_eq!(run.events[0].transition, first);
        }
    }
    // Both are beyond their limits from the start; if that slips which is further, the other holds.
    for (shares, slides) in [([4.0, 3.1], "a"), ([3.1, 4.0], "b")] {
        let shares = json!({ "share_a": shares[0], "share_b": shares[1] });
        let mut scene = two(0.3, shares);
        scene["inputs"]["F"] = json!({ "constant": 1 });
        for run in both(&scene) {
            assert_eq!(stop(&run), "");
            let mode = run.layout.modes.name(run.end.mode);
            let sliding: Vec<&str> = (mode.split(", "))
                .filter_map(|state| state.strip_suffix(" slides"))
                .collect();
            assert_eq!(sliding, [slides]);
        }
    }
}

/// A mass on rough ground, whose load rises to what friction holds at the very most, and no further.
#[test]
fn what_friction_can_just_hold_it_holds() {
    let sines =
        [1.0, 1.3, 0.7, 0.31, 2.2].map(|f| json!({ "sine": { "amplitude": 3, "frequency": f } }));
    let knots = [[3.0, 3.0], [3.0, 0.0], [-3.0, 3.0]]
        .map(|[a, b]| json!({ "knots": [[0, 0], [1, a], [2, b], [3, 0]] }));
    for load in sines.iter().chain(&knots) {
        for method in ["taylor", "radau"] {
            let scene = json!({
                "inputs": { "F": load }, "end": 3, "method": method,
                "parameters": { "share_b": 0, "share_c": 0 },
            });
            for run in both(&scene) {
                let of = format!("{load} by {method}: {:?}", run.uncertain);
                assert!(run.events.is_empty(), "{:?}, {of}", run.events);
                assert!(run.failure.is_none() && run.end.state.q == [0.0; 3], "{of}");
                assert!(run.uncertain.total > 0, "{of}");
            }
        }
    }
}

/// Friction whose normal force comes down to zero, and no further, while the masses stand, slide, and slide and stick.
#[test]
fn a_normal_force_that_touches_zero_does_not_pull() {
    for frequency in [1.0, 1.3, 0.7, 0.31, 2.2, 3.1, 5.7] {
        for (rate, load) in [(0.0, 0.0), (40.0, 0.0), (1.0, 0.5)] {
            for method in ["taylor", "radau"] {
                let scene = json!({
                    "inputs": {
                        "P": { "sine": { "amplitude": 1, "frequency": frequency } },
                        "F": { "constant": load },
                    },
                    "initial": { "x_a.rate": rate, "x_b.rate": rate },
                    "end": 3, "method": method,
                });
                let [one, other] = both(&scene);
                let of = format!("{scene}: {} and {}", stop(&one), stop(&other));
                assert!(one.failure.is_none() && other.failure.is_none(), "{of}");
                for i in 0..3 {
                    let [a, b] = [&one, &other].map(|run| run.end.state.v[i]);
                    assert!((a - b).abs() < 1e-6, "{a} and {b}, {of}");
                }
            }
        }
    }
}

/// Loads, limits and couplings of few values, so that much happens at one instant; some loads have their largest values at a limit.
fn random(number: u64) -> serde_json::Value {
    let mut random = Random(number);
    let mut parameters = json!({ "k": random.one_of(&[0.0, 4.0]) });
    for name in ["coupling_ab", "coupling_bc", "coupling_ac"] {
        parameters[name] = json!(random.one_of(&[-0.3, 0.0, 0.3]));
    }
    for name in ["a", "b", "c"] {
        let [sticks, slides] = *random.one_of(&[[3.0, 1.0], [3.0, 2.0], [2.0, 1.0], [2.0, 2.0]]);
        parameters[format!("static_{name}")] = json!(sticks);
        parameters[format!("kinetic_{name}")] = json!(slides);
        parameters[format!("belt_{name}")] = json!(random.one_of(&[0.0, 0.0, 0.0, 0.5]));
        parameters[format!("share_{name}")] = json!(random.one_of(&[-1.0, 0.5, 1.0, 1.0]));
    }
    let loads = [
        json!({ "sine": { "amplitude": 4.1, "angular_frequency": 1 } }),
        json!({ "sine": { "amplitude": 6.3, "angular_frequency": 2 } }),
        json!({ "sine": { "amplitude": 3, "frequency": 0.7 } }),
        json!({ "sine": { "amplitude": 6, "frequency": 1.3 } }),
        json!({ "constant": 3.5 }),
    ];
    let load = random.one_of(&loads);
    json!({
        "parameters": parameters, "inputs": { "F": load }, "end": 6,
        "accuracy": { "relative": 1e-11 },
    })
}

#[test]
fn random_ties_are_decided_alike_in_both_forms() {
    let share = std::env::var("DALEMBERT_RANDOM_SCENES").ok();
    let share = share.and_then(|n| n.parse().ok()).unwrap_or(SHARE);
    let (mut stops, mut events) = (0, 0);
    for number in 0..share {
        let scene = random(number);
        let of = format!("scene {number}: {scene}");
        let run = |form| simulate(&problem(form, &scene), &mut Silent);
        let one = run("reduced").unwrap();
        let other = match run("multipliers") {
            Ok(run) => run,
            // By multipliers what holds is decided before the start.
            Err(Reason::SeveralMotions { .. }) => {
                assert!(stop(&one).contains(" or ") && one.end.t == 0.0, "{of}");
                stops += 1;
                continue;
            }
            Err(why) => panic!("{why}, {of}"),
        };
        // Of more than two motions any two are named.
        let [a, b] = [&one, &other].map(|run| stop(run).is_empty());
        assert_eq!(a, b, "{} and {}, {of}", stop(&one), stop(&other));
        assert!((one.end.t - other.end.t).abs() < 1e-8, "{of}");
        let [a, b] = [&one, &other].map(|run| run.layout.modes.name(run.end.mode));
        assert_eq!(a, b, "{of}");
        for i in 0..3 {
            for [a, b] in [
                [&one, &other].map(|run| run.end.state.q[i]),
                [&one, &other].map(|run| run.end.state.v[i]),
            ] {
                assert!((a - b).abs() < 1e-8, "{a} and {b}, {of}");
            }
        }
        for run in [&one, &other] {
            let imbalance = run.energy.as_ref().unwrap().imbalance();
            assert!(imbalance.abs() < 1e-9, "{imbalance:e} J, {of}");
        }
        stops += u64::from(one.failure.is_some());
        events += one.events.len();
    }
    println!("{events} events, {stops} of {share} scenes stop");
}
