//! An accumulation comes to rest where its limit is, and nowhere else.

use super::multipliers::sine;
use crate::common::*;
use dalembert::hybrid::{Problem, simulate};
use dalembert::model::models;
use dalembert::record::{Run, Silent};
use dalembert::scene::Scene;
use std::path::Path;

const G: f64 = 9.81;

/// A scene of the tests.
fn scene(name: &str) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/scenes");
    let scene = Scene::load(&folder.join(format!("{name}.json")), &[], models());
    scene.unwrap_or_else(|errors| panic!("{errors}")).problem
}

/// Two balls with restitution 1/2, dropped from heights.
fn balls(a: f64, b: f64) -> Problem {
    let mut problem = problem("two_balls", &[("g", G)]);
    problem.set_initial("a", a).unwrap();
    problem.set_initial("b", b).unwrap();
    problem.end.time = 5.0;
    problem
}

/// When a ball with restitution 1/2 that is dropped comes to rest.
fn limit(height: f64) -> f64 {
    3.0 * (2.0 * height / G).sqrt()
}

/// Times and modes of the rests.
fn rests(run: &Run, problem: &Problem) -> Vec<(f64, &'static str)> {
    let rests = run.events.iter().filter(|e| e.transition == "rest");
    let name = |mode: usize| problem.variant().modes[mode].name;
    rests.map(|e| (e.t, name(e.to))).collect()
}

/// No coordinate and no rate differs by more than a tolerance where a run comes to rest.
fn nothing_jumps_at_rests(run: &Run, problem: &Problem) {
    let accuracy = &problem.accuracy;
    for event in run.events.iter().filter(|e| e.transition == "rest") {
        let [before, after] = [&event.before, &event.after];
        for (part, absolute) in [
            ([&before.q, &after.q], &accuracy.q_absolute),
            ([&before.v, &after.v], &accuracy.v_absolute),
        ] {
            for i in 0..part[0].len() {
                let jump = (part[0][i] - part[1][i]).abs();
                assert!(jump <= absolute[i], "t = {}: {event:?}", event.t);
            }
        }
    }
}

#[test]
fn each_ball_rests_at_its_own_limit_while_the_other_flies() {
    with_each_method(|| {
        for (a, b, first, second) in [
            (4.0, 1.0, "b_rests", "both_rest"),
            (1.0, 4.0, "a_rests", "both_rest"),
        ] {
            let problem = balls(a, b);
            let run = run(&problem);
            nothing_jumps_at_rests(&run, &problem);
            let rests = rests(&run, &problem);
            let names: Vec<_> = rests.iter().map(|r| r.1).collect();
            assert_eq!(names, [first, second]);
            for ((t, _), height) in rests.into_iter().zip([1.0, 4.0]) {
                assert!((t - limit(height)).abs() < 1e-12, "{t}");
            }
            assert_eq!(run.end.state.q, [0.0, 0.0]);
            let energy = run.energy.unwrap();
            assert!((energy.lost_at_impacts - 5.0 * G).abs() < 1e-12);
            assert!(energy.imbalance().abs() < 1e-12, "{}", energy.imbalance());
        }
    });
}

#[test]
fn balls_that_bounce_together_rest_together() {
    with_each_method(|| {
        let problem = balls(1.0, 1.0);
        let run = run(&problem);
        nothing_jumps_at_rests(&run, &problem);
        let rests = rests(&run, &problem);
        let names: Vec<_> = rests.iter().map(|r| r.1).collect();
        assert_eq!(names, ["a_rests", "both_rest"]);
        assert!(rests.iter().all(|(t, _)| (t - limit(1.0)).abs() < 1e-12));
    });
}

/// The shared case: of the second ball no rest is declared, and one mode holds what its impacts come to.
#[test]
fn a_ball_rests_where_one_mode_holds_it_at_its_stop_though_no_rest_is_declared() {
    with_each_method(|| {
        let [declared, follows] = ["each", "first_only"].map(|rests| {
            let mut problem = balls(4.0, 1.0);
            problem.choose(&[("rests", rests)]).unwrap();
            let run = run(&problem);
            nothing_jumps_at_rests(&run, &problem);
            (super::rest::rests(&run, &problem), run.end.state.q)
        });
        assert_eq!(declared, follows);
        assert_eq!(follows.0.len(), 2);
    });
}

#[test]
fn where_no_rest_fits_the_limit_the_run_stops_and_says_what_does_not_fit() {
    with_each_method(|| {
        let mut problem = balls(4.0, 1.0);
        problem.choose(&[("rests", "no_second")]).unwrap();
        let run = simulate(&problem, &mut Silent).unwrap();
        let failure = run.failure.clone().expect("no rest is there");
        assert!((failure.at.t - limit(1.0)).abs() < 1e-9);
        for part in [
            "chattering",
            "impact_b",
            "no rest that is declared for mode `both_fly` fits the limit",
            "rest in `a_rests` holds `a` at 0 m, which is",
            "no mode of the model fits the limit",
        ] {
            assert!(
                failure.reason.to_string().contains(part),
                "{}",
                failure.reason
            );
        }
        // The first ball is where it flies.
        let fall = limit(1.0) - limit(4.0) / 3.0;
        let v = (2.0 * G * 4.0).sqrt() / 2.0;
        let height = v * fall - G * fall * fall / 2.0;
        assert!((failure.at.state.q[0] - height).abs() < 1e-7);
    });
}

/// The slip of the tank dies with the landings that end its rocking, so that it rests sticking.
#[test]
fn a_slip_that_dies_with_the_landings_rests_sticking() {
    let problem = scene("tank_rests_sticking");
    let run = run(&problem);
    nothing_jumps_at_rests(&run, &problem);
    let rests = rests(&run, &problem);
    assert!((rests[0].0 - 0.438_865_681_778_778_3).abs() < 1e-12);
    assert_eq!(rests[0].1, "stands_sticks");
}

/// With C = 3/10 successive switches are half as far apart; from x = 1 at rest the limit is √20 s.
#[test]
fn switches_without_an_impact_come_to_rest() {
    with_each_method(|| {
        let mut problem = problem("fuller", &[]);
        problem.set_initial("x", 1.0).unwrap();
        problem.end.time = 10.0;
        problem.set_tolerance(1e-10);
        let run = run(&problem);
        nothing_jumps_at_rests(&run, &problem);
        let rests = rests(&run, &problem);
        assert_eq!(rests.len(), 1);
        assert_eq!(rests[0].1, "held");
        assert!((rests[0].0 - 20.0f64.sqrt()).abs() < 1e-8, "{rests:?}");
    });
}

#[test]
fn switches_without_a_rest_stop_and_say_what_is_missing() {
    with_each_method(|| {
        for (limit, part) in [
            (
                "missing",
                "no rest is declared for modes `left`, `right`; mode `held` fits it: if the motion comes to rest there, \
                 declare `model.rest(left, held)` and `model.rest(right, held)`",
            ),
            ("elsewhere", "rest in `held` holds `x` at 1 m, which is"),
            ("elsewhere", "no mode of the model fits the limit"),
        ] {
            let mut problem = problem("fuller", &[]);
            problem.choose(&[("limit", limit)]).unwrap();
            problem.set_initial("x", 1.0).unwrap();
            let left = problem
                .variant()
                .modes
                .iter()
                .position(|m| m.name == "left");
            problem.initial.mode = left;
            problem.end.time = 10.0;
            let run = simulate(&problem, &mut Silent).unwrap();
            let failure = run.failure.expect("no rest is there");
            assert!((failure.at.t - 20.0f64.sqrt()).abs() < 1e-6);
            assert!(
                failure.reason.to_string().contains(part),
                "{}",
                failure.reason
            );
        }
    });
}

/// A pendulum hops at its post and throws the cart up, which falls without restitution, again and again: the rests of the pendulum follow each other by a
/// factor of 0.06, down to hops of a rounding. They went on for ever, every 8 ns.
#[test]
fn rests_that_accumulate_end_where_their_limit_is() {
    with_each_method(|| {
        let mut cart = problem("loaded_cart", &[("mu", 0.09), ("nu", 0.09), ("e", 0.06)]);
        cart.set_initial("b", -0.72).unwrap();
        cart.set_input("push", sine("57.892 sin(6.404 t+4.83)"))
            .unwrap();
        cart.set_tolerance(1e-12);
        cart.end.time = 1.95;
        let run = run(&cart);
        assert!(run.events.len() < 1000, "{} events", run.events.len());
        // What closes beside the bob, last.
        let mode = |to: usize| run.layout.modes.name(to).to_string();
        let last = (run.events.iter())
            .filter(|event| event.t > 1.94)
            .rfind(|event| !mode(event.to).contains("open, tray open"));
        let last = last.expect("they come to rest");
        let rests = run.events.iter().filter(|event| event.transition == "rest");
        let times: Vec<f64> = rests.map(|event| event.t).filter(|t| *t > 1.93).collect();
        // The limit of a geometric series (Aitken 1926).
        let [a, b, c] = [times[1], times[2], times[3]];
        let limit = c - (c - b).powi(2) / ((c - b) - (b - a));
        assert!((last.t - limit).abs() < 1e-8, "{} and {limit}", last.t);
        assert_eq!(
            mode(last.to),
            "floor slides, tray slides, left open, right open, bob closed"
        );
        let energy = run.energy.as_ref().unwrap();
        let turnover = energy.initial.abs() + energy.input_work.abs();
        assert!(energy.imbalance().abs() < 1e-10 * turnover, "{energy:?}");
    });
}

/// Carts whose contacts hop on each other with rates that are nothing but roundings: at 7.6 ns in turn for ever, or, where a limit of such hops was
/// believed, 26 ms of motion were left out and 1.4 J lost without a word.
#[test]
fn hops_that_nothing_tells_rest_where_they_are() {
    let carts = [
        (0.0, 0.0, 0.03, -0.929, "103.922 sin(5.271 t+1.33)"),
        (0.09, 0.09, 0.06, -0.134, "80.505 sin(4.436 t+0.44)"),
        (0.09, 0.0, 0.0, 0.269, "106.257 sin(2.005 t+3.94)"),
    ];
    with_each_method(|| {
        for (mu, nu, e, b, push) in carts {
            let mut cart = problem("loaded_cart", &[("mu", mu), ("nu", nu), ("e", e)]);
            cart.set_initial("b", b).unwrap();
            cart.set_input("push", sine(push)).unwrap();
            cart.set_tolerance(1e-12);
            cart.end.time = 3.0;
            let run = run(&cart);
            assert!(run.events.len() < 1000, "{push}: {}", run.events.len());
            let energy = run.energy.as_ref().unwrap();
            let turnover =
                energy.initial.abs() + energy.input_work.abs() + energy.lost_at_impacts.abs();
            let imbalance = energy.imbalance().abs();
            assert!(imbalance < 1e-11 * turnover, "{push}: {energy:?}");
        }
    });
}
