//! Oscillators with dry friction whose damping is far beyond what their motion shows: c/m from 1e6 to 1e16 1/s.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::input::{Function, Sine};
use dalembert::record::{Progress, Run, Silent};
use std::ops::ControlFlow;

/// The shipped oscillator under sin 0.2t, with other friction and damping, for 120 s.
fn oscillator(method: Method, c: f64, friction: f64, relative: f64) -> Problem {
    let friction = [
        ("c", c),
        ("static_friction", friction),
        ("kinetic_friction", friction),
    ];
    let mut problem = problem("hand_coulomb", &friction);
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

/// The names of what happens, and whether the run says that it cannot tell.
fn outcome(run: &Run) -> (Vec<&'static str>, bool) {
    (transitions(run), run.uncertain.total > 0)
}

#[test]
fn a_motion_below_the_tolerance_makes_no_reversals_of_its_own() {
    // The velocity is F/c, and the velocity's tolerance is more than that from c = 1e3 on at 1e-3: the error of an explicit
    // step carries its polynomial through zero, some 120,000 times at c = 1e6 and 1e-6.
    // Beyond c = 1e14 the velocity is of the size of the rounding of its terms.
    for relative in [1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        for power in 3..=14 {
            for friction in [0.6, 0.1, 0.0] {
                let c = 10f64.powi(power);
                let runs = [Method::Auto, Method::Radau]
                    .map(|method| run(&oscillator(method, c, friction, relative)));
                let [auto, radau] = &runs;
                let what = format!("c = {c:e}, friction {friction}, {relative:e}");
                assert!(
                    auto.solver.steps < 100,
                    "{what}: {} steps",
                    auto.solver.steps
                );
                assert_eq!(transitions(auto), transitions(radau), "{what}");
                let ends = match friction {
                    0.0 => times(auto, "reversal"),
                    _ => times(auto, "stick"),
                };
                assert_eq!(ends.len(), 7, "{what}");
            }
        }
    }
}

#[test]
fn the_taylor_method_alone_says_that_reversals_below_its_tolerance_are_uncertain() {
    for (c, relative) in [(1e3, 1e-3), (1e4, 1e-3), (1e4, 1e-4)] {
        for friction in [0.6, 0.0] {
            let [taylor, radau] = [Method::Taylor, Method::Radau]
                .map(|method| outcome(&run(&oscillator(method, c, friction, relative))));
            let what = format!("c = {c:e}, friction {friction}, {relative:e}");
            assert!(taylor.0 == radau.0 || taylor.1, "{what}");
        }
    }
}

#[test]
fn an_oscillation_below_the_tolerance_is_said_to_be_uncertain() {
    // 1000 rad/s at a velocity of 2e-7 m/s, which comes to within 0.3 % of zero once a period and decays as exp(-ct/2).
    for (c, relative) in [(1.0, 1e-3), (1.0, 1e-6), (10.0, 1e-3), (10.0, 1e-6)] {
        for friction in [0.1, 0.0] {
            let mut problem = oscillator(Method::Auto, c, friction, relative);
            problem.set_parameter("k", 1e6).unwrap();
            let run = run(&problem);
            let what = format!("c = {c}, friction {friction}, {relative:e}");
            let count = run.events.len();
            assert!(
                run.uncertain.total > 0,
                "{what}: {count} events are certain"
            );
            assert!(
                run.solver.steps < 1000,
                "{what}: {} steps",
                run.solver.steps
            );
        }
    }
}

#[test]
fn the_taylor_method_alone_says_that_it_cannot_reach_the_end() {
    for power in 6..=16 {
        for friction in [0.6, 0.0] {
            let problem = oscillator(Method::Taylor, 10f64.powi(power), friction, 1e-10);
            let run = simulate(&problem, &mut Silent).expect("the problem can be started");
            let failure = run.failure.expect("it is stiff").reason.to_string();
            let expected = ["mode `slides` is stiff", "range of doubles"][usize::from(power == 16)];
            assert!(failure.contains(expected), "c = 1e{power}: {failure}");
            assert!(failure.contains("`auto`"), "{failure}");
        }
    }
}

/// Ends a run after so many steps.
struct AtMost(u32);

impl Progress for AtMost {
    fn advance(&mut self, _: f64, _: u64) -> ControlFlow<()> {
        self.0 = self.0.saturating_sub(1);
        match self.0 {
            0 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }
}

/// At the start of a slip the velocity grows from zero, below what any step can tell: the dense output of a long step falls
/// below zero where the motion does not, the step is cut there again and again, and the method that makes the long steps was
/// given up for it, for one that takes steps of 1 / c.
#[test]
fn steps_that_are_cut_for_nothing_do_not_speak_against_the_implicit_method() {
    for c in [1e15, 1e16, 1e17] {
        for relative in [1e-3, 2e-4, 5e-5, 1e-5, 5e-6, 1e-7] {
            for friction in [0.6, 0.1, 0.0] {
                let problem = oscillator(Method::Auto, c, friction, relative);
                let run =
                    simulate(&problem, &mut AtMost(1000)).expect("the problem can be started");
                let what = format!("c = {c:e}, friction {friction}, {relative:e}");
                let steps = run.solver.steps;
                assert!(steps < 900, "{what}: {steps} steps, {:?}", run.failure);
                assert!(run.failure.is_none(), "{what}: {:?}", run.failure);
            }
        }
    }
}

/// Without friction the mass turns back where the force is zero, of the size of its rounding there. Two bounds of that
/// rounding, one wider than the other, sent the reversal to the other direction and back within the instant:
/// "no mode is admissible".
#[test]
fn where_the_force_is_its_own_rounding_one_bound_decides_which_way_it_goes() {
    for (c, frequency, relative) in [
        (1e15, 0.2, 1e-7),
        (5672589092333493.0, 0.2, 2.7942930314220024e-12),
        (1.2155189672740734e16, 1.0, 2.0868070215223815e-10),
        (2202451458152303.5, 0.2, 5.294842962303597e-10),
        (4.2552878958012365e17, 1.0, 7.500240546259667e-7),
        (3128448264529638.5, 1.0, 2.381592957142725e-6),
        (
            1.3652745388456298e16,
            2.6822319702080724,
            1.0047171830688518e-6,
        ),
    ] {
        for method in [Method::Auto, Method::Radau] {
            let mut problem = oscillator(method, c, 0.0, relative);
            let sine = Function::from(Sine::new(1.0, frequency, 0.0));
            problem.set_input("force", sine).unwrap();
            let run = simulate(&problem, &mut AtMost(1000)).expect("the problem can be started");
            let what = format!("{method:?}, c = {c:e}, {relative:e}");
            assert!(run.failure.is_none(), "{what}: {:?}", run.failure);
            check_times(&run, &what);
        }
    }
}
