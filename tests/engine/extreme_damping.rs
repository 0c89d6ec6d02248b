//! Oscillators with dry friction whose damping is far beyond what their motion shows: c/m from 1e6 to 1e16 1/s.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::input::{Function, Sine};
use dalembert::record::{Run, Silent};

/// The shipped oscillator under sin 0.2t, with other friction and damping, for 120 s.
fn oscillator(method: Method, c: f64, friction: f64, relative: f64) -> Problem {
    let friction = [
        ("c", c),
        ("static_friction", friction),
        ("kinetic_friction", friction),
    ];
    let mut problem = problem("coulomb_oscillator", &friction);
    let sine = Function::from(Sine::new(1.0, 0.2, 0.0));
    problem.set_input("force", sine).unwrap();
    problem.set_tolerance(relative);
    problem.end.time = 120.0;
    problem.method = method;
    problem
}

fn check_times(run: &Run, what: &str) {
    for pair in run.events.windows(2) {
        let (one, next) = (&pair[0], &pair[1]);
        assert!(
            one.t <= next.t,
            "{what}: {} at {} after {}",
            next.transition,
            next.t,
            one.t
        );
    }
}

#[test]
fn time_never_goes_back() {
    // At these a guard that was zero at the end of a step had its root before the start of the next by up to 2e-10 s.
    let rows = [
        (1e-10, 10f64.powf(14.75), 0.1),
        (1e-11, 1e15, 0.1),
        (1e-10, 1e14, 0.0),
    ];
    for (relative, c, friction) in rows {
        for method in [Method::Auto, Method::Radau] {
            let what = format!("{method:?}, c = {c:e}, {relative:e}");
            check_times(&run(&oscillator(method, c, friction, relative)), &what);
        }
    }
}

#[test]
fn the_load_decides_when_it_slips_however_strong_the_damping() {
    for power in 6..=14 {
        let c = 10f64.powi(power);
        for (friction, count, ends) in
            [(0.6, 15, "stick"), (0.1, 15, "stick"), (0.0, 8, "reversal")]
        {
            for method in [Method::Auto, Method::Radau] {
                let run = run(&oscillator(method, c, friction, 1e-10));
                let what = format!("{method:?}, c = {c:e}, friction {friction}");
                check_times(&run, &what);
                assert_eq!(run.events.len(), count, "{what}: {:?}", transitions(&run));
                assert_eq!(times(&run, ends).len(), 7, "{what}");
                // The force passes the friction upwards: x is 1e-5 m at most.
                let slips = (friction.asin() / 0.2, run.events[0].t);
                assert!((slips.0 - slips.1).abs() < 1e-9, "{what}: {slips:?}");
            }
        }
    }
}

#[test]
fn the_taylor_method_alone_says_that_it_cannot_reach_the_end() {
    for power in 6..=16 {
        for friction in [0.6, 0.0] {
            let problem = oscillator(Method::Taylor, 10f64.powi(power), friction, 1e-10);
            let run = simulate(&problem, &mut Silent).expect("the problem can be started");
            let failure = run.failure.expect("it is stiff").reason;
            let expected = ["mode `slides` is stiff", "range of doubles"][usize::from(power == 16)];
            assert!(failure.contains(expected), "c = 1e{power}: {failure}");
            assert!(failure.contains("`auto`"), "{failure}");
        }
    }
}
