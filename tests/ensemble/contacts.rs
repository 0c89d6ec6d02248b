//! What contacts, friction and constraints do in ensembles is what they do alone.

use super::common::problem;
use super::{End, alone, difference, set_size, together, variations};
use dalembert::input::{Function, Sine};
use dalembert::kernel::processor_level;

#[test]
fn what_constraints_hold_is_brought_back_in_ensembles_too() {
    let mut pendulum = problem("constrained_pendulum", &[]);
    pendulum.end.time = 20.0;
    set_size(&mut pendulum, 1e-6, 1.0, 3.0);
    let pendulums = variations(&pendulum, 9, |p, x| {
        p.set_initial("x", 1.0).unwrap();
        p.set_initial("y.rate", x).unwrap();
    });
    let ends = together(&pendulums, processor_level(), 1);
    assert_eq!(difference(&alone(&pendulums), &ends), 0.0);
    for end in &ends {
        let off = end.state[0].hypot(end.state[1]) - 1.0;
        assert!(off.abs() < 4.0 * f64::EPSILON, "{off:e}");
    }
}

#[test]
fn wheels_that_slip_and_roll_are_in_ensembles_what_they_are_alone() {
    // Without the belt a wheel that slips goes in lanes, which it leaves where it rolls.
    for belt in ["on", "off"] {
        let mut wheel = problem("rolling_wheel", &[]);
        wheel.choose(&[("contacts.belt", belt)]).unwrap();
        wheel.end.time = 5.0;
        set_size(&mut wheel, 1e-8, 1.0, 10.0);
        let wheels = variations(&wheel, 9, |p, x| {
            p.set_initial("x", 0.1 * x).unwrap();
            p.set_initial("phi.rate", 4.0 * x).unwrap();
            p.set_initial("psi.rate", 2.5 * (4.0 * x)).unwrap();
        });
        let ends = together(&wheels, processor_level(), 1);
        assert_eq!(difference(&alone(&wheels), &ends), 0.0);
        assert!(ends.iter().any(|end| !end.events.is_empty()), "{belt}");
    }
}

/// Thrown ones fly in lanes; what strikes with friction, along a line that solves for a coordinate, is handed out.
#[test]
fn wheels_that_are_thrown_are_in_ensembles_what_they_are_alone() {
    for restitution in [0.0, 0.5] {
        let mut wheel = problem("thrown_wheel", &[("e", restitution)]);
        wheel.end.time = 3.0;
        set_size(&mut wheel, 1e-8, 1.0, 10.0);
        let wheels = variations(&wheel, 9, |p, x| {
            p.set_initial("y", 0.1 + 0.3 * x.abs()).unwrap();
            p.set_initial("phi.rate", 25.0 * x).unwrap();
            p.set_initial("z.rate", 0.5 * x).unwrap();
        });
        let ends = together(&wheels, processor_level(), 1);
        assert!(difference(&alone(&wheels), &ends) < 1e-8, "{restitution}");
        let sticks = |end: &End| end.events.iter().any(|e| e.0 == "ground sticks");
        assert!(ends.iter().any(sticks), "{restitution}");
    }
}

/// What sticks to a belt moves with it, from where both were as it began to stick.
#[test]
fn masses_on_driven_belts_are_in_ensembles_what_they_are_alone() {
    let mut mass = problem("driven_belt", &[("k", 30.0)]);
    let driven = Sine::new(6.0, 5.0, 0.4);
    mass.set_input("belt_acceleration", Function::from(driven))
        .unwrap();
    mass.end.time = 4.0;
    set_size(&mut mass, 1e-10, 1.0, 1.0);
    let masses = variations(&mass, 9, |p, x| {
        p.set_initial("belt", 3.0 * x).unwrap();
        p.set_initial("x.rate", 0.5 * x).unwrap();
    });
    let ends = together(&masses, processor_level(), 1);
    assert!(difference(&alone(&masses), &ends) < 1e-8);
    for name in ["base sticks", "base slips"] {
        assert!(
            ends.iter()
                .all(|end| end.events.iter().any(|e| e.0 == name)),
            "{name}"
        );
    }
}

/// Three masses of which two slip and stop at the same instants: what frictions decide together is handed out.
#[test]
fn ties_of_frictions_are_in_ensembles_what_they_are_alone() {
    let coupled = [("coupling_ab", -0.3), ("coupling_bc", 0.2), ("k", 4.0)];
    let mut masses = problem("tied_frictions", &coupled);
    let load = Sine::new(6.3, 2.0, 0.0);
    masses.set_input("F", Function::from(load)).unwrap();
    masses.end.time = 6.0;
    set_size(&mut masses, 1e-10, 1.0, 1.0);
    let masses = variations(&masses, 9, |p, x| {
        p.set_parameter("share_c", 2.0 * x - 1.0).unwrap();
        p.set_initial("x_c.rate", 0.5 * x).unwrap();
    });
    let ends = together(&masses, processor_level(), 1);
    assert!(difference(&alone(&masses), &ends) < 1e-8);
    let reverses = |end: &End| end.events.iter().any(|e| e.0.ends_with("reverses"));
    assert!(ends.iter().any(reverses));
}
