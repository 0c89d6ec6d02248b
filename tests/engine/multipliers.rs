//! Contacts and constraints by multipliers, against references: every event, its state, and the motion between them.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use dalembert::record::Run;
use serde_json::Value;

/// A problem of the rigid block in a scene of a reference.
pub fn block(scene: &Value) -> Problem {
    let given = &scene["parameters"];
    let of = |name: &str| number(&given[name]);
    let mut block = problem(
        "rigid_block",
        &[
            ("b", of("b")),
            ("h", of("h")),
            ("mu_s", of("mu")),
            ("mu_k", of("mu")),
            ("e", of("e_N")),
        ],
    );
    for (input, key) in [("a_h", "a_h"), ("a_v", "a_v")] {
        if let Some(text) = given[key][0].as_str() {
            block.set_input(input, sine(text)).unwrap();
        }
    }
    let [q, u] = ["q", "u"].map(|key| numbers(&scene["initial"][key]));
    for (i, name) in ["x", "y", "theta"].iter().enumerate() {
        block.set_initial(name, q[i]).unwrap();
        block.set_initial(&format!("{name}.rate"), u[i]).unwrap();
    }
    block.set_tolerance(TIGHTEST);
    block.end.time = number(&scene["t_end"]);
    block.record.every = Some(0.1);
    block
}

/// `7 sin(12.5 t+0.7)` as a function of time.
pub fn sine(text: &str) -> Function {
    let (amplitude, rest) = text.split_once(" sin(").unwrap();
    let (frequency, phase) = rest.trim_end_matches(')').split_once(" t+").unwrap();
    let [amplitude, frequency, phase] = [amplitude, frequency, phase].map(|x| x.parse().unwrap());
    Sine::new(amplitude, frequency, phase).into()
}

/// The words of a reference for what contacts do, of names of modes and their directions.
fn words(run: &Run, mode: usize, discrete: &[f64]) -> String {
    let name = &run.layout.modes.name(mode);
    let parts =
        name.split(", ")
            .enumerate()
            .map(|(k, part)| match part.rsplit_once(' ').unwrap().1 {
                "sticks" => "stick".to_owned(),
                "slides" if discrete[k] > 0.0 => "slip+".to_owned(),
                "slides" => "slip-".to_owned(),
                word => word.to_owned(),
            });
    parts.collect::<Vec<_>>().join("/")
}

/// Compares events and samples with those of a reference. The dense output of Radau IIA, which samples between steps are taken
/// from, is of a lower order than its steps.
pub fn check(scene: &Value, run: &Run, count: usize, method: Method) {
    let exact: Vec<&Value> = (scene["events"].as_array().unwrap().iter())
        .filter(|event| event["event"] != "start")
        .collect();
    let least: f64 = if method == Method::Radau { 1e-10 } else { 0.0 };
    let limits: Vec<f64> = (exact.iter())
        .filter(|event| event["event"].as_str().unwrap().starts_with("zeno_limit"))
        .map(|event| number(&event["t"]))
        .collect();
    let mut found = run.events.iter().peekable();
    for (k, exact) in exact.iter().enumerate() {
        let is_limit = exact["event"].as_str().unwrap().starts_with("zeno_limit");
        // What a reference leaves out of an accumulation are impacts.
        let goes_on = |transition: &str| is_limit && transition.ends_with(" strikes");
        // Hops end where they are lower than rounding shows; the references ask for those down to 1e-6 s.
        let t = number(&exact["t"]);
        let next = limits.iter().find(|limit| **limit >= t);
        let limit = next.copied().unwrap_or(f64::INFINITY);
        let is_after = limits.first().is_some_and(|first| t > *first);
        let rests = found.peek().is_some_and(|event| event.transition == "rest");
        if rests && !is_limit && (limit - t).abs() < 1e-6 {
            continue;
        }
        let next = found.by_ref().find(|event| !goes_on(event.transition));
        let event = next.expect("an event");
        // Before a limit a gap of less than 1 m, which is known to a rounding, by polynomials to some 36, is closed with the rate
        // of a fall of half the time that is left.
        let roundings = if method == Method::Radau { 36.0 } else { 1.0 };
        let told = roundings * f64::EPSILON / (0.5 * 9.81 * (limit - t).abs());
        // What comes after a limit begins as that is told.
        let of_limit = match is_limit || is_after {
            // The references ask for 1e-9; what restitution does not end is told to the rounding of its last hops.
            true if scene["final"].is_null() => least.max(1e-12),
            true => least,
            false => 0.0,
        };
        let demand =
            number(&exact["demand_dt"])
                .max(of_limit)
                .max(if t < limit { told } else { 0.0 });
        assert!(
            (event.t - t).abs() <= demand,
            "event {k}: {} instead of {t}: {:.2} times the demand",
            event.t,
            (event.t - t).abs() / demand
        );
        let found = words(run, event.to, &event.after.discrete);
        // Scenes that end at a limit give the set of before.
        let ends = is_limit && scene["final"].is_null();
        if !ends {
            assert_eq!(found, exact["mode_after"], "event {k}");
        }
    }
    assert!(found.next().is_none(), "more events");
    let samples = scene["samples"].as_array().unwrap();
    for sample in samples {
        let t = number(&sample["t"]);
        let demand = number(&sample["demand_state"]).max(least);
        let row = run
            .trajectory
            .t
            .iter()
            .position(|&x| (x - t).abs() < 1e-9)
            .expect("a row");
        let row = run.trajectory.row(row);
        for (i, exact) in numbers(&sample["q"]).iter().enumerate() {
            assert!(
                (row[i] - exact).abs() <= demand,
                "q {i} at {t}: {} {exact}",
                row[i]
            );
        }
        for (i, exact) in numbers(&sample["u"]).iter().enumerate() {
            let value = row[count + i];
            assert!(
                (value - exact).abs() <= 10.0 * demand,
                "u {i} at {t}: {value} {exact}"
            );
        }
    }
}

pub fn scenes(file: &str) -> Vec<(String, Value)> {
    let reference = reference(file);
    let scenes = reference["scenes"].as_object().unwrap();
    scenes
        .iter()
        .map(|(name, scene)| (name.clone(), scene.clone()))
        .collect()
}

fn check_blocks(file: &str) {
    for (_, scene) in scenes(file) {
        for method in [Method::Taylor, Method::Radau] {
            let mut block = block(&scene);
            block.method = method;
            check(&scene, &run(&block), 3, method);
        }
    }
}

#[test]
fn a_block_that_rocks_loses_what_housner_says() {
    check_blocks("13b_housner_limit");
}

#[test]
fn a_block_dropped_on_a_corner_slips_sticks_strikes_and_rests() {
    check_blocks("13a_block_drop");
}

#[test]
fn a_block_on_ground_that_shakes_both_ways_slides_rocks_and_slide_rocks() {
    check_blocks("13c_block_forced");
}

#[test]
fn a_standing_block_slips_or_lifts_as_sums_of_forces_say() {
    let reference = reference("13d_standing_block");
    for case in reference["reference"].as_array().unwrap() {
        let of = |name: &str| number(&case["parameters"][name]);
        for method in [Method::Taylor, Method::Radau] {
            let (b, h, mu) = (of("b"), of("h"), of("mu"));
            let given = [("b", b), ("h", h), ("mu_s", mu), ("mu_k", mu)];
            let mut block = problem("rigid_block", &given);
            block.method = method;
            for input in ["a_h", "a_v"] {
                let text = case["parameters"][input].as_str().unwrap();
                let text = text.replace(" t)", " t+0)");
                if !text.starts_with("0 ") {
                    block.set_input(input, sine(&text)).unwrap();
                }
            }
            block.set_initial("y", h).unwrap();
            block.set_tolerance(TIGHTEST);
            block.end.time = 0.08;
            block.record.every = Some(0.01);
            block.record.columns.outputs = true;
            let run = run(&block);
            let exact = &case["engine_A_first_event"];
            let event = &run.events[0];
            let off = event.t - number(&exact["t"]);
            assert!(off.abs() <= 1e-14);
            assert_eq!(words(&run, event.to, &event.after.discrete), exact["mode"]);
            for (k, exact) in case["standing_forces"]
                .as_array()
                .unwrap()
                .iter()
                .enumerate()
            {
                let row = run.trajectory.row(k + 1);
                let of = |name: &str| row[run.trajectory.column(name).unwrap()];
                let total = of("left.friction") + of("right.friction");
                let pushes = [of("left.normal"), of("right.normal")];
                for (force, key) in [(pushes[0], "N_1"), (pushes[1], "N_2"), (total, "T_total")] {
                    let off = force / number(&exact[key]) - 1.0;
                    assert!(off.abs() <= 1e-14, "{key}");
                }
            }
        }
    }
}

/// Of two corners that stick only the sum of the frictions is determined: the record says where.
#[test]
fn what_is_not_determined_is_marked() {
    let mut block = problem("rigid_block", &[("b", 0.2), ("h", 0.6)]);
    // It stands, and rocks from the instant at which the ground's acceleration reaches g b/h.
    let [amplitude, frequency] = [6.0_f64, 4.0];
    let rocks = (9.81 * 0.2 / 0.6 / amplitude).asin() / frequency;
    let ground = Sine::new(amplitude, frequency, 0.0);
    block.set_input("a_h", ground.into()).unwrap();
    block.set_initial("x", 0.2).unwrap();
    block.set_initial("y", 0.6).unwrap();
    block.end.time = 0.25;
    block.record.every = Some(0.01);
    block.record.columns.outputs = true;
    let run = run(&block);
    let column = |name: &str| run.trajectory.column(name).expect("a column");
    let [shares, left, right] = ["right_shares", "left.friction", "right.friction"].map(column);
    for (k, &t) in run.trajectory.t.iter().enumerate() {
        let row = run.trajectory.row(k);
        assert_eq!(row[shares], f64::from(t < rocks), "{t}");
        if t < rocks {
            let sum = amplitude * (frequency * t).sin();
            assert!((row[left] + row[right] - sum).abs() <= 1e-13 && row[right] == 0.0);
        }
    }
    assert!(run.events.len() == 1 && (run.events[0].t - rocks).abs() <= 1e-14);
}

#[test]
fn friction_under_an_apparent_weight_is_that_of_the_weight() {
    for method in [Method::Taylor, Method::Radau] {
        let of = |model: &str, parameters: &[(&str, f64)], input: &str| {
            let mut problem = problem(model, parameters);
            problem.set_input(input, sine("8 sin(1 t+0)")).unwrap();
            problem.set_tolerance(1e-12);
            problem.method = method;
            problem.end.time = 12.0;
            run(&problem)
        };
        let limit = 0.3 * 2.0 * 9.81;
        let fixed = [
            ("m", 2.0),
            ("k", 0.0),
            ("static_friction", limit),
            ("kinetic_friction", limit),
        ];
        let expected = of("coulomb_oscillator", &fixed, "force");
        let found = of("pressed_by_weight", &[], "force");
        for what in ["slips", "sticks"] {
            let expected = times(&expected, &format!("base {what}"));
            let found = times(&found, &format!("rail {what}"));
            assert_eq!(expected.len(), found.len(), "{method:?} {what}");
            assert!(found.len() > 2, "{method:?} {what}: {found:?}");
            for (expected, found) in expected.iter().zip(&found) {
                assert!(
                    (expected - found).abs() < 1e-11,
                    "{method:?}: {expected} {found}"
                );
            }
        }
        let off = at_end(&expected, "x") - at_end(&found, "x");
        assert!(off.abs() < 1e-11, "{method:?}: {off:e}");
    }
}
