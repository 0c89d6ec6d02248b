//! What the tolerances leave open is said to be uncertain.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use dalembert::precision::{Ended, other, unsettled};
use dalembert::record::{Question, Run, Silent};
use std::f64::consts::PI;

const METHODS: [Method; 3] = [Method::Auto, Method::Taylor, Method::Radau];
const TOLERANCES: [f64; 7] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12];

/// x″ + x = A sin 0.2t from rest: x′ is in proportion to cos 0.2t − cos t = 2 sin 0.6t sin 0.4t.
fn without_friction(method: Method, relative: f64) -> Problem {
    let mut problem = problem(
        "hand_coulomb",
        &[("static_friction", 0.0), ("kinetic_friction", 0.0)],
    );
    let sine = Function::from(Sine::new(0.7, 0.2, 0.0));
    problem.set_input("force", sine).unwrap();
    problem.set_tolerance(relative);
    problem.method = method;
    problem.end.time = 120.0;
    problem
}

#[test]
fn a_guard_that_begins_at_zero_and_touches_it_again_is_in_doubt() {
    // Zeros of x′ at 5π/3 k and 5π/2 k, before 120; where both are, x′ only touches zero: at 5π k.
    let simple = (22 - 7) + (15 - 7);
    for relative in TOLERANCES {
        for method in METHODS {
            let run = run(&without_friction(method, relative));
            let (count, doubts) = (times(&run, "reversal").len(), run.uncertain.total);
            println!("{method:?} {relative:e}: {count} {doubts}");
            assert!(
                count == simple || doubts > 0,
                "{method:?}, {relative:e}: {count} reversals are certain"
            );
        }
    }
}

#[test]
fn where_a_rate_all_but_touches_zero_the_state_is_that_of_its_time() {
    // Rates are landed on by a polynomial of first order: over a long way it has its root elsewhere.
    for relative in [1e-8, 1e-10, 1e-12] {
        for method in METHODS {
            let run = run(&without_friction(method, relative));
            let exact = |t: f64| 0.7 * 0.2 / (1.0 - 0.2 * 0.2) * ((0.2 * t).cos() - t.cos());
            let reversals = run.events.iter().filter(|e| e.transition == "reversal");
            let off = reversals.map(|e| (e.before.v[0] - exact(e.t)).abs());
            let most = off.fold(0.0, f64::max);
            assert!(most <= relative, "{method:?}, {relative:e}: {most:e}");
        }
    }
}

/// Den Hartog's free decay: from x0 = (7 + excess) f the mass turns at 5 f, 3 f, f: friction holds it there, or not quite.
fn decay(method: Method, relative: f64, excess: f64) -> Run {
    let friction = [("static_friction", 0.1), ("kinetic_friction", 0.1)];
    let mut problem = problem("hand_coulomb", &friction);
    problem.set_initial("x", 0.1 * (7.0 + excess)).unwrap();
    problem.set_initial("slip", -1.0).unwrap();
    problem.initial.mode = Some(mode(&problem, "slides"));
    problem.set_tolerance(relative);
    problem.method = method;
    problem.end.time = 15.0;
    run(&problem)
}

#[test]
fn a_condition_that_rounding_decides_is_in_doubt() {
    for relative in TOLERANCES.into_iter().chain([1e-13, 1e-14]) {
        for method in METHODS {
            let run = decay(method, relative, 0.0);
            let doubts = &run.uncertain.first;
            let at_limit = |t: f64| (t - 3.0 * PI).abs() < 0.1 * relative.max(1e-3);
            assert!(
                doubts
                    .iter()
                    .any(|doubt| doubt.what == Question::Choice && at_limit(doubt.t)),
                "{method:?}, {relative:e}: {:?}, {doubts:?}",
                transitions(&run)
            );
        }
    }
}

#[test]
fn a_condition_beyond_its_error_is_in_no_doubt() {
    for relative in [1e-6, 1e-8, 1e-10, 1e-12] {
        for method in METHODS {
            for (excess, sequence) in [
                (-1e-3, &["reversal", "reversal", "stick"][..]),
                (1e-3, &["reversal", "reversal", "reversal", "stick"][..]),
            ] {
                let run = decay(method, relative, excess);
                let what = format!("{method:?}, {relative:e}, {excess}");
                assert_eq!(transitions(&run), sequence, "{what}");
                assert_eq!(run.uncertain.total, 0, "{what}: {:?}", run.uncertain.first);
            }
        }
    }
}

#[test]
fn an_event_of_contacts_that_another_tolerance_changes_is_named_with_their_states() {
    let block = |tilt: f64| {
        let mut block = problem("rigid_block", &[]);
        block.set_initial("theta", tilt).unwrap();
        (block.set_initial("y", 0.6 * tilt.cos() + 0.2 * tilt.sin())).unwrap();
        block.end.time = 2.0;
        block
    };
    let (one, another) = (block(0.1), block(0.05));
    let run = run(&one);
    // In place of one at another tolerance, from whose first event on they differ.
    let other = other(&another, &Ended::default(), &mut Silent).unwrap();
    let doubt = unsettled(&one, &run, &run.events, &other).unwrap();
    assert_eq!(doubt.what, Question::Unsettled);
    assert!(
        doubt.mode == "left sticks, right open" || doubt.mode == "left open, right sticks",
        "{}",
        doubt.mode
    );
}
