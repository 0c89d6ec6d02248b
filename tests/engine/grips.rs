//! What friction holds does not move, by any number of bits; what contacts decide does not depend on how they are held.

use super::multipliers::{block, scenes};
use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use dalembert::record::{Event, Run};

#[test]
fn a_pinched_capsule_moves_exactly_not_at_all() {
    for method in [Method::Taylor, Method::Radau] {
        for press in [12.0, 20.0, 36.0, 60.0] {
            let mut capsule = problem("pinched_capsule", &[("press", press)]);
            capsule.method = method;
            for (name, value) in [("x", 0.015), ("tip", 0.03)] {
                capsule.set_initial(name, value).unwrap();
            }
            // Its weight is 0.44 N; it is shaken by much more, within what the grip holds.
            let shaken = Function::from(Sine::new(0.6 * press, 3.0, 0.0));
            capsule.set_input("lift", shaken).unwrap();
            capsule.end.time = 10.0;
            capsule.record.every = Some(0.1);
            let run = run(&capsule);
            assert!(run.events.is_empty());
            assert_eq!(
                run.layout.modes.name(run.end.mode),
                "jaw sticks, finger_tip sticks"
            );
            let first = run.trajectory.row(0)[..4].to_vec();
            for row in 0..run.trajectory.t.len() {
                assert_eq!(run.trajectory.row(row)[..4], first, "{method:?} {press}");
            }
        }
    }
}

/// Events and their states, of the model's own coordinates, of both forms: by coordinates and by multipliers.
fn assert_same([model, held]: [&str; 2], own: usize, error: f64, prepare: impl Fn(&mut Problem)) {
    let [reduced, held] = [model, held].map(|name| {
        let mut problem = problem(name, &[]);
        prepare(&mut problem);
        run(&problem)
    });
    assert!(reduced.events.len() > 5, "{}", reduced.events.len());
    // What comes to rest where it lands is an event of the reduced form.
    let events = |run: &Run| -> Vec<_> {
        let all = run.events.iter().filter(|event| event.transition != "rest");
        all.cloned().collect()
    };
    let [reduced, held] = [&reduced, &held].map(events);
    let names = |events: &[Event]| events.iter().map(|e| e.transition).collect::<Vec<_>>();
    assert_eq!(names(&reduced), names(&held));
    for (a, b) in reduced.iter().zip(&held) {
        let size = b.t.max(1.0);
        let (name, t) = (a.transition, a.t);
        assert!((t - b.t).abs() <= error * size, "{model}: {t} {}", b.t);
        for i in 0..own {
            for (x, y) in [(&a.before.q, &b.before.q), (&a.after.v, &b.after.v)] {
                let off = (x[i] - y[i]).abs();
                assert!(off <= error * size, "{model} {name} at {t}: {off:e}");
            }
        }
    }
}

#[test]
fn a_model_moves_the_same_by_coordinates_and_by_multipliers() {
    for method in [Method::Taylor, Method::Radau] {
        assert_same(["belt_oscillator", "held_belt"], 1, 1e-11, |mass| {
            for (name, value) in [("mu_s", 0.04), ("mu_k", 0.025)] {
                mass.set_parameter(name, value).unwrap();
            }
            (mass.set_input("force", Sine::new(0.7, 1.3, 0.2).into())).unwrap();
            mass.set_initial("belt_direction", -1.0).unwrap();
            mass.set_tolerance(TIGHTEST);
            mass.method = method;
            mass.end.time = 20.0;
        });
        assert_same(["contact_hopper", "held_hopper"], 2, 1e-11, |block| {
            for (input, sine) in [
                ("horizontal", Sine::new(7.0, 5.0, 0.3)),
                ("vertical", Sine::new(14.0, 9.0, 0.0)),
            ] {
                block.set_input(input, sine.into()).unwrap();
            }
            // With restitution, how many impacts are told from rest is a matter of the form.
            block.set_parameter("e", 0.0).unwrap();
            block.set_initial("y", 0.05).unwrap();
            block.set_initial("x.rate", 0.5).unwrap();
            block.set_tolerance(TIGHTEST);
            block.method = method;
            block.end.time = 3.0;
        });
    }
}

/// No number of the contact law smears an event: its time is as good as the motion.
#[test]
fn events_converge_when_the_accuracy_is_doubled() {
    for (_, scene) in scenes("13c_block_forced") {
        let exact: Vec<f64> = (scene["events"].as_array().unwrap().iter())
            .filter(|event| event["event"] != "start")
            .map(|event| number(&event["t"]))
            .collect();
        let mut before = f64::INFINITY;
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            let mut block = block(&scene);
            block.method = Method::Radau;
            block.set_tolerance(tolerance);
            let run = run(&block);
            // Later ones may be too near to each other for the coarsest.
            let first = run.events.iter().zip(&exact).take(8);
            let off = first.map(|(event, t)| (event.t - t).abs());
            let worst = off.fold(0.0, f64::max);
            println!("{tolerance:e}: {worst:e}");
            assert!(
                worst <= 1e3 * tolerance && worst <= before,
                "{worst:e} {before:e}"
            );
            before = worst;
        }
    }
}

/// The law of a model in place of the general one: each landing leaves the part of the rate that it says.
#[test]
fn a_models_own_law_says_what_a_landing_does() {
    let (b, h, r) = (0.2_f64, 0.6_f64, 0.8);
    let tilt = 0.1_f64;
    let mut block = problem("own_landing", &[("r", r)]);
    // On its left corner.
    let (sin, cos) = tilt.sin_cos();
    block.set_initial("x", b * cos - h * sin).unwrap();
    block.set_initial("y", b * sin + h * cos).unwrap();
    block.set_initial("theta", tilt).unwrap();
    block.set_tolerance(1e-13);
    block.end.time = 2.0;
    let run = run(&block);
    let landings: Vec<_> = (run.events.iter())
        .filter(|event| event.transition.ends_with(" strikes"))
        .collect();
    assert!(landings.len() > 5, "{:?}", transitions(&run));
    for (k, landing) in landings.iter().take(6).enumerate() {
        let name = ["right strikes", "left strikes"][k % 2];
        assert_eq!(landing.transition, name);
        let off = landing.after.v[2] - r * landing.before.v[2];
        assert!(off.abs() <= 1e-15, "{off:e}");
        let lost = 0.5 * (1.0 - r * r) * landing.before.v[2].powi(2) * 4.0 / 3.0 * (b * b + h * h);
        assert!((landing.energy.expect("an impact").lost - lost).abs() <= 1e-13);
    }
}
