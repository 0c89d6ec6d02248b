//! Runs that start at rest: static equilibria against closed forms, which last; and what has none is refused.

use crate::common::*;
use dalembert::hybrid::{Problem, simulate};
use dalembert::input::Function;
use dalembert::record::Silent;

const G: f64 = 9.81;

/// A problem that starts at rest near a configuration, for half a second.
fn at_rest(model: &str, parameters: &[(&str, f64)], near: &[(&str, f64)]) -> Problem {
    let mut problem = problem(model, parameters);
    for (name, value) in near {
        problem.set_initial(name, *value).unwrap();
    }
    problem.at_rest = true;
    problem.end.time = 0.5;
    problem
}

/// Where it rests: coordinates at the start, which are those at the end, within rounding that grows with the square of time.
fn stays(problem: &Problem) -> Vec<f64> {
    let run = run(problem);
    let begun = simulate(
        &{
            let mut start = problem.clone();
            start.end.time = 1e-9;
            start
        },
        &mut Silent,
    );
    let begun = begun.unwrap().end.state.q;
    for (i, (start, end)) in begun.iter().zip(&run.end.state.q).enumerate() {
        assert!(
            (end - start).abs() < 1e-12,
            "coordinate {i}: {start} then {end}"
        );
    }
    assert_eq!(run.events.len(), 0, "{:?}", run.events);
    begun
}

/// Why there is no equilibrium.
fn refused(problem: &Problem) -> String {
    let refused = simulate(problem, &mut Silent).expect_err("it has no equilibrium");
    refused.to_string()
}

fn is(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 4.0 * f64::EPSILON * expected.abs().max(1.0),
        "{found} is not {expected}"
    );
}

#[test]
fn a_bead_rests_where_the_hoop_throws_it_up() {
    with_each_method(|| {
        for side in [1.0, -1.0] {
            let bead = at_rest("bead_on_hoop", &[], &[("x", side * 0.3), ("y", -0.4)]);
            let cosine = G / (36.0 * 0.5);
            let q = stays(&bead);
            is(q[0], side * 0.5 * f64::sqrt(1.0 - cosine * cosine));
            is(q[1], -0.5 * cosine);
        }
    });
}

#[test]
fn a_tank_rests_with_its_liquid_leaning_on_ground_that_is_accelerated() {
    with_each_method(|| {
        let mut tank = at_rest("walking_tank", &[], &[]);
        tank.set_input("ground_acceleration", Function::constant(0.8))
            .unwrap();
        let omega = 2.0 * std::f64::consts::PI * 26.0;
        let bulge = tank.model.coordinate("x_I").unwrap();
        is(1e4 * stays(&tank)[bulge], 1e4 * -0.8 / (omega * omega));
        // Friction does not hold, and sliding is no rest.
        tank.set_input("ground_acceleration", Function::constant(4.0))
            .unwrap();
        let why = refused(&tank);
        assert!(
            why.contains("`stands_sticks`: `slip` happens at once"),
            "{why}"
        );
    });
}

#[test]
fn pendulums_hang_and_do_not_stand() {
    with_each_method(|| {
        let hangs = at_rest("double_pendulum", &[], &[]);
        let [first, second] = [0, 1].map(|i| hangs.model.coordinates[i].name);
        let hangs = at_rest("double_pendulum", &[], &[(first, 0.7), (second, -0.4)]);
        for q in stays(&hangs) {
            assert!(q.abs() < 1e-15, "{q}");
        }
    });
}

#[test]
fn a_mass_rests_on_a_belt_that_slides_under_it() {
    with_each_method(|| {
        for model in ["belt_oscillator", "held_belt"] {
            for belt in [0.1, -0.1] {
                let mass = at_rest(model, &[("belt", belt)], &[]);
                let [place, ..] = stays(&mass)[..] else {
                    unreachable!("a mass has a place")
                };
                // The spring holds against what the belt drags with.
                is(place, 0.25 * G * belt.signum());
            }
        }
    });
}

/// Friction holds no place of its own, and nothing says where the part on the hub is: it stays where the scene has it.
#[test]
fn a_wheel_rolls_to_where_spring_and_moment_hold_it() {
    with_each_method(|| {
        for form in ["reduced", "multipliers"] {
            let mut wheel = at_rest("thrown_wheel", &[], &[("z", 0.7)]);
            wheel.choose(&[("form", form)]).unwrap();
            wheel.set_input("moment", Function::constant(0.5)).unwrap();
            let q = stays(&wheel);
            // k x = moment / r.
            is(q[0], 0.5 / 0.3 / 5.0);
            is(q[2], q[0] / 0.3);
            assert_eq!(q[1], 0.0);
            is(q[3], 0.7);
        }
    });
}

#[test]
fn a_block_stands_on_its_corners_while_friction_and_width_hold_it() {
    with_each_method(|| {
        let block = |push: f64| {
            let mut block = at_rest("rigid_block", &[], &[]);
            block.set_input("a_h", Function::constant(push)).unwrap();
            block
        };
        // Tips from b/h g = 3.27 m/s² on, slips from 0.5 g on.
        for push in [0.0, 1.0, -3.2] {
            let q = stays(&block(push));
            is(q[1], 0.6);
            is(q[0], 0.0);
            is(q[2], 0.0);
        }
        assert!(
            refused(&block(4.0)).contains("no static equilibrium"),
            "{}",
            refused(&block(4.0))
        );
        assert!(
            refused(&block(5.0)).contains("no static equilibrium"),
            "{}",
            refused(&block(5.0))
        );
    });
}

#[test]
fn a_linkage_hangs_where_its_potential_energy_is_least() {
    with_each_method(|| {
        let linkage = at_rest(
            "four_bar",
            &[],
            &[("x_A", 0.1), ("y_A", -0.38), ("x_B", 0.9), ("y_B", -0.85)],
        );
        let q = stays(&linkage);
        // Bars of 0.4, 1.0 and 0.9 m, whose pins are moved by a small turn of the crank.
        let turned = |angle: f64| {
            let crank = q[1].atan2(q[0]) + angle;
            let a = [0.4 * crank.cos(), 0.4 * crank.sin()];
            let (dx, dy) = (1.1 - a[0], -a[1]);
            let (far, along) = (dx.hypot(dy), dy.atan2(dx));
            let at_a = ((1.0 + far * far - 0.81) / (2.0 * far)).acos();
            let side = f64::signum((q[3] - a[1]) * dx - (q[2] - a[0]) * dy);
            let b = a[1] + (along + side * at_a).sin();
            0.4 * a[1] / 2.0 + (a[1] + b) / 2.0 + 0.9 * b / 2.0
        };
        let [less, here, more] = [-1e-4, 0.0, 1e-4].map(turned);
        // Even in the angle to the third order, and a minimum.
        assert!(
            (more - less).abs() < 1e-11 && more > here && less > here,
            "{less} {here} {more}"
        );
    });
}

#[test]
fn what_falls_is_refused_and_what_lies_rests() {
    with_each_method(|| {
        let why = refused(&at_rest("bouncing_ball", &[], &[("h", 1.0)]));
        assert!(why.contains("the force along `h` vanishes"), "{why}");
        assert_eq!(stays(&at_rest("bouncing_ball", &[], &[])), [0.0]);
        // Where friction cannot hold the spring it slides, and is not taken to where it would hold.
        for model in ["belt_oscillator", "held_belt"] {
            let why = refused(&at_rest(model, &[("belt", 0.0)], &[("x", 5.0)]));
            assert!(why.contains("no static equilibrium"), "{why}");
        }
        // Nothing closes from afar that would hold, on a hill or on the plain.
        for form in ["reduced", "multipliers"] {
            let mut ball = at_rest("hilly_ball", &[], &[("y", 9.0)]);
            ball.choose(&[("form", form)]).unwrap();
            let why = refused(&ball);
            assert!(why.contains("no static equilibrium"), "{why}");
        }
        let why = refused(&at_rest("rigid_block", &[], &[("y", 2.0)]));
        assert!(why.contains("the force along `y` vanishes"), "{why}");
    });
}
