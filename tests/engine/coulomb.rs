//! The Coulomb oscillator against Den Hartog's closed forms (tests/data/03_den_hartog.json), and as
//! a two-way Newmark block (tests/data/04_newmark.json).

use crate::common::*;
use dalembert::hybrid::Problem;
use dalembert::input::{Function, Interpolation, Outside, Sine, Table};
use dalembert::record::Event;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// m = k = 1, friction `f`, force cos(βt + φ); at `x` with the given direction of slip.
fn oscillator(f: f64, force: Option<(f64, f64)>, x: f64, slip: f64) -> Problem {
    let friction = [("static_friction", f), ("kinetic_friction", f)];
    let mut problem = problem("hand_coulomb", &friction);
    if let Some((beta, phase)) = force {
        let cosine = Sine::new(1.0, beta, phase + FRAC_PI_2);
        problem.set_input("force", Function::from(cosine)).unwrap();
    }
    problem.set_initial("x", x).unwrap();
    problem.set_initial("slip", slip).unwrap();
    tighten(&mut problem, 1e-2);
    problem
}

/// Difference of two phases, in (−π, π].
fn phase_difference(a: f64, b: f64) -> f64 {
    let turns = (a - b) / TAU;
    TAU * (turns - turns.round())
}

#[test]
fn motion_without_stops_stays_on_its_orbit() {
    with_each_method(|| {
        let reference = reference("03_den_hartog");
        let cases = reference["reference"]["continuous"].as_array().unwrap();
        assert_eq!(cases.len(), 7);
        for case in cases {
            let (beta, f) = (number(&case["beta"]), number(&case["f_over_a"]));
            let (x0, phase) = (
                number(&case["x0_over_a"]),
                number(&case["phase_phi_at_max"]),
            );
            let mut problem = oscillator(f, Some((beta, phase)), x0, -1.0);
            problem.initial.mode = Some(mode(&problem, "slides"));
            problem.end.time = 5.25 * TAU / beta;
            let run = run(&problem);
            assert_eq!(run.events.len(), 10, "β = {beta}: {:?}", transitions(&run));
            for (k, event) in run.events.iter().enumerate() {
                let half_cycles = (k + 1) as f64;
                let exact = x0 * (1.0 - 2.0 * (half_cycles % 2.0));
                assert_eq!(event.transition, "reversal");
                let phase = beta * event.t - PI * half_cycles;
                assert!(phase.abs() < 1e-11, "β = {beta}: phase off by {phase:e}");
                let error = event.after.q[0] - exact;
                assert!(
                    error.abs() < 1e-11,
                    "β = {beta}: amplitude off by {error:e}"
                );
            }
        }
    });
}

/// Name, phase and place of the events of one cycle on an orbit with two stops a cycle.
fn stops(case: &serde_json::Value) -> [(&'static str, f64, f64); 4] {
    let orbit = &case["algebraic"];
    let (x0, release) = (
        number(&orbit["x0_over_a"]),
        number(&orbit["release_phase_from_+x0"]),
    );
    let entry = number(&orbit["stick_entry_phase_at_-x0"]);
    [
        ("slip", release, x0),
        ("stick", entry, -x0),
        ("slip", release + PI, -x0),
        ("stick", entry + PI, x0),
    ]
}

fn check_stops(events: &[Event], beta: f64, start: f64, cycle: &[(&str, f64, f64); 4]) {
    for event in events {
        let phase = beta * event.t + start;
        let error = |c: &(&str, f64, f64)| phase_difference(phase, c.1).abs();
        let nearest = (cycle.iter())
            .filter(|c| c.0 == event.transition)
            .min_by(|a, b| error(a).total_cmp(&error(b)))
            .unwrap_or_else(|| panic!("β = {beta}: an event {}", event.transition));
        assert!(
            error(nearest) < 1e-11,
            "β = {beta}: phase off by {:e}",
            error(nearest)
        );
        let place = event.after.q[0] - nearest.2;
        assert!(place.abs() < 1e-11, "β = {beta}: place off by {place:e}");
    }
}

#[test]
fn motion_with_two_stops_stays_on_its_orbit() {
    with_each_method(|| {
        let reference = reference("03_den_hartog");
        let cases = reference["reference"]["with_stops"].as_array().unwrap();
        assert_eq!(cases.len(), 6);
        for case in cases {
            let (beta, f) = (number(&case["beta"]), number(&case["f_over_a"]));
            let cycle = stops(case);
            // In the middle of the rest at +x0.
            let start = 0.5 * (cycle[3].1 - TAU + cycle[0].1);
            let mut problem = oscillator(f, Some((beta, start)), cycle[0].2, 1.0);
            problem.end.time = 5.0 * TAU / beta;
            let run = run(&problem);
            assert_eq!(run.events.len(), 20, "β = {beta}: {:?}", transitions(&run));
            check_stops(&run.events, beta, start, &cycle);
        }
    });
}

#[test]
fn motion_with_stops_converges_to_its_orbit() {
    with_each_method(|| {
        let reference = reference("03_den_hartog");
        let cases = reference["reference"]["with_stops"].as_array().unwrap();
        // The other two orbits attract so slowly that the reference's own march does not reach them.
        for case in cases.iter().filter(|c| c["events_per_cycle"].is_array()) {
            let (beta, f) = (number(&case["beta"]), number(&case["f_over_a"]));
            let mut problem = oscillator(f, Some((beta, 0.0)), 0.1, 1.0);
            problem.end.time = 100.0 * TAU / beta;
            let run = run(&problem);
            check_stops(&run.events[run.events.len() - 8..], beta, 0.0, &stops(case));
        }
    });
}

#[test]
fn free_decay_stops_where_friction_holds_it() {
    with_each_method(|| {
        let reference = reference("03_den_hartog");
        let cases = reference["reference"]["free_decay"].as_array().unwrap();
        assert_eq!(cases.len(), 3);
        for case in cases {
            let mut problem = oscillator(number(&case["f"]), None, number(&case["x0"]), -1.0);
            problem.initial.mode = Some(mode(&problem, "slides"));
            problem.end.time = 30.0;
            let run = run(&problem);
            let (times, places) = (
                numbers(&case["turn_times"]),
                numbers(&case["turning_points"]),
            );
            assert_eq!(run.events.len(), times.len() - 1);
            for (event, (t, x)) in run.events.iter().zip(times.iter().zip(&places).skip(1)) {
                assert!(
                    (event.t / t - 1.0).abs() < 1e-13,
                    "turn at {:.17}, not {t:.17}",
                    event.t
                );
                let place = event.after.q[0];
                assert!(
                    (place - x).abs() < 1e-13,
                    "turns at {place:.17}, not {x:.17}"
                );
            }
            assert_eq!(run.events.last().unwrap().transition, "stick");
            assert!((at_end(&run, "x") - number(&case["final_position"])).abs() < 1e-13);
        }
    });
}

#[test]
fn a_newmark_block_slips_both_ways() {
    with_each_method(|| {
        let reference = reference("04_newmark");
        for case in reference["reference"]["sine_two_way_steady"]
            .as_array()
            .unwrap()
        {
            let eta = number(&case["eta"]);
            let mut problem = oscillator(eta, Some((1.0, -FRAC_PI_2)), 0.0, 1.0);
            problem.set_parameter("k", 0.0).unwrap();
            // The mean velocity of the start dies out by a third a cycle.
            problem.end.time = 120.0 * TAU;
            let run = run(&problem);
            let last = &run.events[run.events.len() - 8..];
            let slip_slip = case["regime"] == "slip-slip";
            for pair in last.windows(2) {
                if slip_slip {
                    assert_eq!(pair[1].transition, "reversal", "η = {eta}");
                    let up = pair[1].after.discrete[0] > 0.0;
                    let phase = pair[1].t - if up { 0.0 } else { PI };
                    let error = phase_difference(phase, number(&case["reversal_phase"]));
                    assert!(error.abs() < 1e-12, "η = {eta}: reversal off by {error:e}");
                } else {
                    let starts = pair[1].transition == "slip";
                    let exact = number(&case[if starts { "t_start" } else { "t_stop" }]);
                    let half_cycles = ((pair[1].t - exact) / PI).round();
                    let error = pair[1].t - exact - half_cycles * PI;
                    assert!(
                        error.abs() < 1e-12,
                        "η = {eta}: {} off by {error:e}",
                        pair[1].transition
                    );
                }
                let slip = (pair[1].after.q[0] - pair[0].after.q[0]).abs();
                if slip_slip || pair[1].transition == "stick" {
                    let error = slip - number(&case["peak_to_peak_slip"]);
                    assert!(error.abs() < 1e-12, "η = {eta}: slip off by {error:e}");
                }
            }
        }
    });
}

/// A mass that a force presses against its stop, on the right or on the left; the force falls by 0.4 N a second from
/// t = 5 s on. It starts at rest in the middle.
fn pressed(direction: f64, e: f64) -> Problem {
    let parameters = [
        ("k", 0.1),
        ("static_friction", 0.1),
        ("kinetic_friction", 0.1),
        ("stop", 0.5),
        ("e", e),
    ];
    let mut problem = problem("hand_coulomb", &parameters);
    let (times, forces) = (
        [0.0, 5.0, 10.0],
        [1.0, 1.0, -1.0].map(|f: f64| direction * f),
    );
    let table = Table::new(&times, &forces, Interpolation::Linear, Outside::Hold).unwrap();
    problem.set_input("force", Function::from(table)).unwrap();
    problem.record.columns.reactions = true;
    problem
}

#[test]
fn a_mass_that_is_pressed_rests_against_its_stop() {
    with_each_method(|| {
        for (direction, name) in [(1.0, "rests_right"), (-1.0, "rests_left")] {
            for e in [0.0, 0.5] {
                let mut problem = pressed(direction, e);
                problem.end.time = 5.0;
                let run = run(&problem);
                let last = run.trajectory.row(run.trajectory.len() - 1);
                let value = |column: &str| last[run.trajectory.column(column).unwrap()];
                let mode = run.trajectory.mode[run.trajectory.len() - 1];
                assert_eq!(run.layout.modes.name(mode), name, "e = {e}");
                assert_eq!(
                    [value("x"), value("x.rate")],
                    [direction * 0.5, 0.0],
                    "e = {e}"
                );
                let reaction = direction * (0.1 * 0.5 - 1.0);
                assert!((value("reaction.x") - reaction).abs() < 1e-15, "e = {e}");
                // The impacts end before long: the mass is thrown back by the stop, and pressed on by at least 0.85 N.
                let rest = run
                    .events
                    .iter()
                    .find(|event| event.transition == "rest")
                    .unwrap();
                assert!(rest.t < 4.5, "e = {e}: {}", rest.t);
            }
        }
    });
}

#[test]
fn it_leaves_when_friction_can_no_longer_hold_it_back() {
    with_each_method(|| {
        for direction in [1.0, -1.0] {
            let mut problem = pressed(direction, 0.5);
            problem.end.time = 9.0;
            let run = run(&problem);
            // The spring pulls with 0.05 N, friction holds 0.1 N: the force must have come down to −0.05 N.
            let leaves = run
                .events
                .iter()
                .find(|event| event.transition == "leave")
                .unwrap();
            let exact = 5.0 + 1.05 / 0.4;
            assert!((leaves.t - exact).abs() < 1e-12, "{}", leaves.t);
            let last = run.trajectory.row(run.trajectory.len() - 1);
            let x = last[run.trajectory.column("x").unwrap()];
            assert!(direction * x < 0.5, "{x}");
        }
    });
}
