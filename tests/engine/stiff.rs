//! Stiff springs: vibrations that must be followed without numerical damping, and ones that die out
//! (tests/data/11_stiff_block.json and closed forms).

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use std::f64::consts::PI;

const METHODS: [Method; 3] = [Method::Auto, Method::Radau, Method::Taylor];

/// The block of the reference, with tolerances in proportion to the vibration of its spring: the load
/// μ g m/k, and the velocity of a vibration of that size.
fn block(m: f64, k: f64, c: f64) -> Problem {
    let mut problem = problem("stiff_block", &[("m", m), ("k", k), ("c", c)]);
    problem.set_initial("x.rate", 2.0).unwrap();
    problem.record.ledger = false;
    problem.set_tolerance(1e-12);
    let r = problem.model.coordinate("r").unwrap();
    let load = 0.3 * 9.81 * m / k;
    problem.accuracy.q_absolute[r] = 1e-12 * load;
    problem.accuracy.v_absolute[r] = 1e-12 * load * (k / m).sqrt();
    problem
}

/// The block stops where and when the reference says, at every stiffness, undamped and damped.
fn block_stops_as_in_the_reference(method: Method) {
    let reference = reference("11_stiff_block");
    let rows = reference["reference"]["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 8);
    for row in rows {
        let (k, c) = (number(&row["k"]), number(&row["c"]));
        let mut problem = block(0.1, k, c);
        problem.method = method;
        problem.end.time = 1.0;
        let run = run(&problem);
        let at = format!("k = {k:e}, c = {c:e}, {method:?}");
        assert_eq!(transitions(&run), ["stick"], "{at}");
        // A million cycles are the explicit method's, strong damping is not.
        let implicit = method == Method::Radau || c > 1.0;
        let name = &run.solver.method;
        assert_eq!(name.contains("Radau"), implicit, "{at}: {name}");
        let stop = &run.events[0];
        // As accurate as the reference demands: 1e-11, 1e-12; here to rounding, 5e-15 and 2e-16.
        let time = stop.t - number(&row["t_stop"]);
        assert!(time.abs() < 1e-14, "{at}: t off by {time:e}");
        let place = stop.after.q[0] - number(&row["x_block_stop"]);
        assert!(place.abs() < 1e-15, "{at}: x off by {place:e}");
        // The reference demands 1e-6 of it at k = 1e6, and 1e-15, a quarter of a percent, at 1e12.
        let load = 0.3 * 9.81 * 0.1 / k;
        let ends = [
            (stop.after.q[1], "r_at_stop"),
            (at_end(&run, "r"), "r_at_t=1(block stuck)"),
        ];
        for (found, key) in ends {
            let error = (found - number(&row[key])).abs() / load;
            assert!(error < 2e-7, "{at}: {key} off by {error:e} of the load");
        }
    }
}

// Two tests, side by side: most of their time goes into the 160,000 cycles of the stiffest spring.
#[test]
fn a_block_with_a_stiff_oscillator_stops_undamped_and_damped() {
    block_stops_as_in_the_reference(Method::Auto);
}

#[test]
fn a_block_with_a_stiff_oscillator_stops_by_radau_alone() {
    block_stops_as_in_the_reference(Method::Radau);
}

/// Energy of the spring and the mass on it ÷ that of an elongation by the load.
fn vibration(k: f64, r: f64, rate: f64) -> f64 {
    let load = 0.3 * 9.81 * 0.1 / k;
    (k * r * r + 0.1 * rate * rate) / (k * load * load)
}

#[test]
fn a_vibration_without_damping_keeps_its_energy() {
    // From the stop to t = 1 an undamped spring makes 160 cycles at k = 1e6 and 16,000 at k = 1e10. The
    // 160,000 at k = 1e12, found as well, are in the test above: its elongation at t = 1.
    for k in [1e6, 1e8, 1e10] {
        for method in [Method::Auto, Method::Radau] {
            let mut problem = block(0.1, k, 0.0);
            problem.method = method;
            problem.end.time = 1.0;
            let run = run(&problem);
            let [stop, end] = [&run.events[0].after, &run.end.state]
                .map(|state| vibration(k, state.q[1], state.v[1]));
            let lost = (end / stop - 1.0).abs();
            let cycles = (1.0 - run.events[0].t) * (k / 0.1).sqrt() / (2.0 * PI);
            // Found: a fifth of the tolerance in a cycle, whatever the stiffness.
            assert!(lost < 5e-13 * cycles, "k = {k:e}, {method:?}: {lost:e}");
        }
    }
}

#[test]
fn a_mass_that_vanishes_follows_the_block() {
    // In the limit m → 0 the spring only carries m: the block stops as without it.
    let exact = 2.0 / (0.3 * 9.81);
    for m in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
        for method in [Method::Auto, Method::Radau] {
            let k = 1e6;
            let mut problem = block(m, k, (k * m).sqrt());
            problem.method = method;
            let run = run(&problem);
            let at = format!("m = {m:e}, {method:?}");
            assert_eq!(transitions(&run), ["stick"], "{at}");
            let error = run.events[0].t - exact;
            assert!(run.solver.steps < 100, "{at}: {} steps", run.solver.steps);
            assert!(error.abs() < 1e-14, "{at}: {error:e}");
            let elongation = run.events[0].after.q[1] / (0.3 * 9.81 * m / k) - 1.0;
            assert!(elongation.abs() < 1e-10, "{at}: {elongation:e}");
        }
    }
}

/// A mass that rises at 1 m/s from a buffer.
fn buffer(k: f64, c: f64, g: f64, v: f64) -> Problem {
    let mut problem = problem("buffer", &[("k", k), ("c", c), ("g", g)]);
    problem.set_initial("x.rate", v).unwrap();
    problem.set_tolerance(1e-12);
    problem.accuracy.q_absolute[0] = 1e-12 / k.sqrt();
    problem
}

#[test]
fn a_stiff_spring_switched_on_by_an_impact_throws_back_what_it_got() {
    for k in [1e2_f64, 1e4, 1e6, 1e8, 1e10, 1e12] {
        let (omega, g, v) = (k.sqrt(), 10.0, 1.0);
        let flight = 2.0 * v / g;
        let contact = (PI + 2.0 * (g / (omega * v)).atan()) / omega;
        for method in METHODS {
            let mut problem = buffer(k, 0.0, g, v);
            problem.method = method;
            problem.end.time = 100.0 * (flight + contact);
            problem.end.after = Some(("leave", 99));
            let run = run(&problem);
            let at = format!("k = {k:e}, {method:?}");
            let (presses, leaves) = (times(&run, "press"), times(&run, "leave"));
            assert_eq!((presses.len(), leaves.len()), (99, 99), "{at}");
            let mut worst = [0.0f64; 3];
            for (n, (press, leave)) in presses.iter().zip(&leaves).enumerate() {
                let exact = n as f64 * (flight + contact) + flight;
                worst[0] = worst[0].max((press / exact - 1.0).abs());
                worst[1] = worst[1].max((leave / (exact + contact) - 1.0).abs());
                worst[2] = worst[2].max((run.events[2 * n + 1].after.v[0] - v).abs());
            }
            // Found: 2e-12 after 99 contacts, that is 2 % of the tolerance in each.
            assert!(worst.iter().all(|&e| e < 1e-11), "{at}: {worst:?}");
        }
    }
}

#[test]
fn a_damped_spring_switched_on_by_an_impact_has_the_restitution_of_its_damping() {
    for k in [1e4_f64, 1e8, 1e12] {
        for damping in [1e-6_f64, 0.05, 0.5, 0.9] {
            let damped = (1.0 - damping * damping).sqrt();
            let (omega, restitution) = (k.sqrt(), (-damping * PI / damped).exp());
            for method in METHODS {
                let mut problem = buffer(k, 2.0 * damping * omega, 0.0, -1.0);
                problem.method = method;
                problem.set_initial("x", 1.0).unwrap();
                problem.end.time = 1.1;
                let run = run(&problem);
                let at = format!("k = {k:e}, ζ = {damping}, {method:?}");
                assert_eq!(transitions(&run), ["press", "leave"], "{at}");
                let contact = run.events[1].t - run.events[0].t - PI / (damped * omega);
                let error = run.events[1].after.v[0] - restitution;
                // The slower it leaves, the more a deviation of the place moves the instant.
                assert!(contact.abs() * restitution < 1e-14, "{at}: {contact:e}");
                assert!(error.abs() < 1e-12, "{at}: {error:e}");
            }
        }
    }
}
