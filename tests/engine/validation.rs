//! Nothing inadmissible runs: a program's problem is held against the same bounds as a scene.

use crate::common::*;
use dalembert::hybrid::{Ensemble, Invalid, Member, Problem, Reason, Simulator, simulate};
use dalembert::record::Silent;

/// The reason for which a problem is refused, by every way to run it.
fn refused(problem: &Problem) -> Reason {
    let reason = simulate(problem, &mut Silent).expect_err("it is refused");
    let of = |result: Result<(), Reason>| result.expect_err("it is refused").to_string();
    assert_eq!(of(Simulator::new(problem).map(|_| ())), reason.to_string());
    assert_eq!(of(Ensemble::new(problem).map(|_| ())), reason.to_string());
    reason
}

#[test]
fn parameters_outside_their_bounds_are_refused() {
    let mut ball = problem("hand_ball", &[]);
    for (name, value) in [
        ("e", 2.0),
        ("e", f64::NAN),
        ("m", -1.0),
        ("m", 0.0),
        ("g", f64::INFINITY),
    ] {
        let before = ball.parameters.clone();
        let error = ball.set_parameter(name, value).expect_err(name);
        assert!(matches!(error, Invalid::OutOfRange { .. }), "{error}");
        assert!(error.to_string().contains(&format!("`{name}`")), "{error}");
        assert_eq!(ball.parameters, before, "a refused value is not set");
        // Nor does a value run that was written past the setter.
        let mut written = ball.clone();
        written.parameters[ball.model.parameter(name).unwrap()] = value;
        assert!(
            matches!(refused(&written), Reason::Invalid(found) if found.to_string() == error.to_string())
        );
    }
    let unknown = ball.set_parameter("mass", 1.0).unwrap_err();
    assert!(matches!(unknown, Invalid::Unknown(_)), "{unknown}");
}

#[test]
fn a_parameter_that_another_limits_is_refused() {
    let problem = problem("hand_coulomb", &[("kinetic_friction", 0.2)]);
    let reason = refused(&problem);
    assert_eq!(
        reason.to_string(),
        "kinetic_friction = 0.2 exceeds static_friction = 0.1"
    );
}

#[test]
fn a_tank_with_more_bulging_liquid_than_contents_is_refused() {
    // The liquid that does not bulge would have a negative mass.
    let more = 50.3_f64.next_up();
    assert_eq!(
        refused(&problem("walking_tank", &[("M_I", more)])).to_string(),
        format!("M_I = {more} exceeds M_0 = 50.3")
    );
    let mut tank = problem("walking_tank", &[("M_I", 50.3)]);
    tank.end.time = 1e-3;
    run(&tank);
}

#[test]
fn initial_states_outside_their_bounds_are_refused() {
    let mut block = problem("rocking_block", &[]);
    for (name, value) in [
        ("theta", -0.1),
        ("theta", f64::NAN),
        ("theta.rate", f64::INFINITY),
        ("side", 0.5),
    ] {
        let error = block.set_initial(name, value).expect_err(name);
        assert!(matches!(error, Invalid::OutOfRange { .. }), "{error}");
    }
    block.initial.q[0] = -0.1;
    let reason = refused(&block);
    let words = "initial `theta` is -0.1: it must be >= 0 rad";
    assert_eq!(reason.to_string(), words);
}

#[test]
fn ends_tolerances_and_samples_that_are_no_lengths_are_refused() {
    let ball = problem("hand_ball", &[]);
    type Change = fn(&mut Problem);
    let changes: [(&str, Change); 5] = [
        ("the end", |p| p.end.time = f64::NAN),
        ("the end", |p| p.end.time = -1.0),
        ("the relative tolerance", |p| p.accuracy.relative = 0.0),
        ("tolerance of `h`", |p| p.accuracy.v_absolute[0] = 0.0),
        ("interval of the samples", |p| p.record.every = Some(0.0)),
    ];
    for (what, change) in changes {
        let mut changed = ball.clone();
        change(&mut changed);
        let reason = refused(&changed);
        assert!(reason.to_string().contains(what), "{reason}");
    }
}

/// The oscillator without friction, 1 m beyond its stop.
fn beyond_the_stop() -> Problem {
    let parameters = [
        ("kinetic_friction", 0.0),
        ("static_friction", 0.0),
        ("stop", 1.0),
    ];
    let mut oscillator = problem("hand_coulomb", &parameters);
    oscillator.set_initial("x", 2.0).unwrap();
    oscillator
}

#[test]
fn an_initial_state_beyond_a_stop_is_refused() {
    let oscillator = beyond_the_stop();
    let reason = refused(&oscillator);
    assert!(matches!(reason, Reason::Beyond { .. }), "{reason}");
    let words = "the initial state is beyond a stop";
    assert!(reason.to_string().starts_with(words), "{reason}");
    // At the stop it may start, and within a rounding of it.
    for x in [1.0, 1.0f64.next_up()] {
        let mut at = oscillator.clone();
        at.set_initial("x", x).unwrap();
        run(&at);
    }
}

#[test]
fn a_member_of_an_ensemble_is_refused_as_a_single_run_is() {
    let wrong = beyond_the_stop();
    let mut right = wrong.clone();
    right.set_initial("x", 0.5).unwrap();
    let mut without_mass = right.clone();
    without_mass.parameters[right.model.parameter("m").unwrap()] = -1.0;
    let ensemble = Ensemble::new(&right).unwrap();
    let members = [&right, &wrong, &without_mass, &right].map(Member::from);
    let failures = ensemble.run(&members, |_, finished| finished.failure.clone());
    assert_eq!(failures[0], None);
    assert_eq!(failures[1], Some(refused(&wrong)));
    assert_eq!(failures[2], Some(refused(&without_mass)));
    assert_eq!(failures[3], None);
}

/// A block on its base under an acceleration that lifts it at once settles into another mode: that moves nothing.
#[test]
fn a_mode_that_cannot_hold_the_initial_state_gives_way() {
    let mut block = problem("rocking_block", &[]);
    let push = dalembert::input::Function::constant(5.0);
    block.set_input("ground_acceleration", push).unwrap();
    block.end.time = 0.1;
    assert_eq!(transitions(&run(&block)), ["base opens"]);
}

/// x' < 0 while the friction acts against a slip to the right.
#[test]
fn a_slip_against_its_direction_is_refused_and_not_stopped() {
    let mut oscillator = problem("hand_coulomb", &[]);
    oscillator.set_initial("x.rate", -0.5).unwrap();
    oscillator.initial.mode = Some(mode(&oscillator, "slides"));
    let reason = refused(&oscillator);
    assert!(
        matches!(&reason, Reason::Beyond { of, .. } if of == "x.rate"),
        "{reason}"
    );
    oscillator.set_initial("slip", -1.0).unwrap();
    run(&oscillator);
}
