//! The choice of the method: explicit where that is faster, implicit where a mode is stiff.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use std::f64::consts::PI;

/// The names of the methods that `auto` used, after a check of its result against each fixed method.
fn chosen(problem: &Problem, allowed: f64) -> String {
    let mut problem = problem.clone();
    problem.method = Method::Auto;
    let auto = run(&problem);
    for method in [Method::Radau, Method::Taylor] {
        problem.method = method;
        let other = run(&problem);
        assert_eq!(transitions(&auto), transitions(&other), "{method:?}");
        let accuracy = &problem.accuracy;
        let ends = [&auto.end.state, &other.end.state];
        for i in 0..accuracy.q_absolute.len() {
            let q = (ends[0].q[i] - ends[1].q[i]).abs() / accuracy.q_absolute[i];
            let v = (ends[0].v[i] - ends[1].v[i]).abs() / accuracy.v_absolute[i];
            assert!(
                q.max(v) < allowed,
                "{method:?}, {i}: {q:.1} and {v:.1} tolerances"
            );
        }
    }
    auto.solver.method
}

/// An oscillator that slips on shaken ground; `factor` stiffens spring and damper.
fn sliding_oscillator(factor: f64, relative: f64) -> Problem {
    let parameters = [("k", 1.05e6 * factor), ("c", 642.0 * factor)];
    let mut problem = problem("hand_slider", &parameters);
    let sine = Sine::new(20.0, 2.0 * PI * 7.0, 0.0);
    problem
        .set_input("ground_acceleration", Function::from(sine))
        .unwrap();
    problem.set_tolerance(relative);
    let d = problem.model.coordinate("d").unwrap();
    problem.accuracy.q_absolute[d] /= factor;
    problem.accuracy.v_absolute[d] /= factor;
    problem.end.time = 0.3;
    problem
}

/// Largest difference of the methods, in tolerances, where slips and sticks end the errors before them:
/// 0.09 was found.
const FORGETTING: f64 = 0.2;

/// A mass with dry friction, in N, whose damper, in N s/m, lets it creep.
fn creeping(friction: f64, c: f64) -> Problem {
    let friction = [
        ("static_friction", friction),
        ("kinetic_friction", friction),
    ];
    let mut problem = problem("hand_coulomb", &[&friction[..], &[("c", c)]].concat());
    problem.set_tolerance(1e-10);
    problem
}

/// A damper so strong that no series of the motion is finite: there the implicit method goes on.
#[test]
fn where_no_series_is_finite_the_implicit_method_goes_on() {
    let mut problem = creeping(0.0, 1e15);
    problem.set_initial("x", 0.1).unwrap();
    problem.set_initial("x.rate", 1.0).unwrap();
    let auto = run(&problem);
    assert!(
        auto.solver.method.contains("Radau"),
        "{}",
        auto.solver.method
    );
    problem.method = Method::Radau;
    let radau = run(&problem);
    assert_eq!(transitions(&auto), transitions(&radau));
    assert!((auto.end.state.q[0] - radau.end.state.q[0]).abs() < 1e-10);
}

#[test]
fn an_oscillation_that_is_resolved_is_left_to_the_explicit_method() {
    for relative in [1e-3, 1e-6, 1e-10] {
        let method = chosen(&sliding_oscillator(1.0, relative), FORGETTING);
        assert!(!method.contains("Radau"), "{relative:e}: {method}");
    }
}

#[test]
fn a_fast_decay_that_is_over_calls_for_the_implicit_method() {
    for relative in [1e-3, 1e-6, 1e-10] {
        let method = chosen(&sliding_oscillator(1e4, relative), FORGETTING);
        assert!(method.contains("Radau"), "{relative:e}: {method}");
    }
}

/// A row at the start and one a step, whichever of its modes it is made in.
#[test]
fn all_steps_are_counted() {
    for method in [Method::Auto, Method::Taylor, Method::Radau] {
        let parameters = [("belt", 0.1), ("mu_s", 0.1), ("mu_k", 0.06), ("g", 10.0)];
        let mut problem = problem("hand_belt", &parameters);
        problem.end.time = 60.0;
        problem.method = method;
        problem.record.every = None;
        let run = run(&problem);
        assert_eq!(run.events.len(), 10);
        assert_eq!(
            run.solver.steps,
            run.trajectory.len() as u64 - 1,
            "{method:?}"
        );
    }
}

#[test]
fn a_rocking_block_is_not_stiff() {
    let mut problem = problem("rocking_block", &[("alpha", 0.25), ("R", 1.5)]);
    problem.set_initial("theta", 0.15).unwrap();
    problem.end.time = 3.0;
    // Every landing amplifies the errors before it: 4.1 tolerances after some twenty of them.
    let method = chosen(&problem, 5.0);
    assert!(!method.contains("Radau"), "{method}");
}

#[test]
fn a_damped_stiff_spring_calls_for_the_implicit_method() {
    for k in [1e8_f64, 1e10, 1e12] {
        let c = 3.0 * (0.1 * k).sqrt();
        let mut problem = problem("stiff_block", &[("k", k), ("c", c)]);
        problem.set_initial("x.rate", 2.0).unwrap();
        let r = problem.model.coordinate("r").unwrap();
        problem.accuracy.q_absolute[r] = 1e-8 * 3.0 / k;
        problem.end.time = 0.7;
        problem.method = Method::Auto;
        let run = run(&problem);
        assert_eq!(transitions(&run), ["stick"]);
        assert!(
            run.solver.method.contains("Radau"),
            "{k:e}: {}",
            run.solver.method
        );
        // Without stiffness it takes a few steps; the explicit method would take thousands.
        assert!(run.solver.steps < 200, "{k:e}: {} steps", run.solver.steps);
    }
}

/// A tank that lifts off smoothly, 972 landings of microradians: θ̈ is zero but for rounding where an
/// edge lifts off, and the sign of the jerk must not be lost in the first step.
#[test]
fn smooth_lift_offs_with_each_method() {
    for method in [Method::Taylor, Method::Radau] {
        for relative in [1e-5, 1e-8, 1e-11] {
            let mut tank = problem("walking_tank", &[]);
            let model = tank.model.clone();
            let sets = &model.parameter_sets;
            let doughnut = sets.iter().find(|s| s.name == "doughnut").unwrap();
            for (name, value) in &doughnut.values {
                tank.set_parameter(name, *value).unwrap();
            }
            tank.set_parameter("mu_s", 0.6).unwrap();
            tank.set_parameter("mu_k", 0.57).unwrap();
            let shaking = Sine::new(20.0, 14.0 * std::f64::consts::PI, 0.0);
            tank.set_input("ground_acceleration", shaking.into())
                .unwrap();
            tank.set_tolerance(relative);
            tank.method = method;
            tank.end.time = 0.35;
            let run = run(&tank);
            let lift_offs = run.events.iter().filter(|e| e.transition == "lift_off");
            assert_eq!(lift_offs.count(), 4, "{method:?} {relative:e}");
        }
    }
}
