//! The least pulse that overturns a block (tests/data/02_overturning_spectrum.json): at the boundary the
//! motion lingers at the unstable equilibrium, and the last digit of the pulse decides.

use crate::common::{number, problem, reference};
use dalembert::hybrid::{Method, Problem, Reason, Simulator};
use dalembert::input::{Function, Sine};
use dalembert::record::Silent;

/// A block at rest under one sine that lifts it at t = 0; p = 1 1/s, amplitude A α g.
fn shaken(alpha: f64, frequency: f64, amplitude: f64) -> Problem {
    let mut block = problem(
        "rocking_block",
        &[("alpha", alpha), ("g", 1.0), ("R", 0.75)],
    );
    let pulse = amplitude * alpha;
    let phase = (alpha.tan() / pulse).asin();
    let end = (2.0 * std::f64::consts::PI - phase) / frequency;
    let sine = Sine::new(pulse, frequency, phase).between(0.0, end);
    block
        .set_input("ground_acceleration", Function::from(sine))
        .unwrap();
    block.set_tolerance(1e-13);
    // A part of 1e-16 of the motion grows to its size in 37 time constants, 1/p on the linear part and
    // somewhat more at the greatest tilts.
    block.end.time = end + 100.0;
    block.end.after = Some(("base strikes", 1));
    block.record.ledger = false;
    block.record.event_states = false;
    block
}

/// Whether it does not come back.
fn overturns(alpha: f64, frequency: f64, amplitude: f64, method: Method) -> bool {
    let mut block = shaken(alpha, frequency, amplitude);
    block.method = method;
    let mut simulator = Simulator::new(&block).unwrap();
    // The model has no ground to fall on: what falls over turns about its edge, and leaves it in the end.
    if let Err(reason) = simulator.run(&mut Silent) {
        assert!(matches!(reason, Reason::Requirement { .. }), "{reason}");
        assert!(simulator.q()[0] > alpha, "{reason}");
    }
    let happened = |name: &str| simulator.events().iter().any(|e| e.transition == name);
    assert!(happened("base opens"));
    !happened("base strikes")
}

#[test]
fn the_least_overturning_pulse_is_found_to_nine_digits() {
    let reference = reference("02_overturning_spectrum");
    let rows = &reference["reference"]["one_sine_no_impact_nonlinear"];
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), 4);
    for row in rows {
        let [alpha, frequency, exact] =
            ["alpha", "omega_p_over_p", "ap_over_g_alpha"].map(|key| number(&row[key]));
        for method in [Method::Auto, Method::Radau] {
            let (mut stays, mut falls) = (exact * (1.0 - 1e-3), exact * (1.0 + 1e-3));
            assert!(!overturns(alpha, frequency, stays, method));
            assert!(overturns(alpha, frequency, falls, method));
            while falls - stays > 1e-11 * exact {
                let middle = 0.5 * (stays + falls);
                match overturns(alpha, frequency, middle, method) {
                    true => falls = middle,
                    false => stays = middle,
                }
            }
            let error = (falls / exact - 1.0).abs();
            assert!(
                error < 1e-9,
                "α = {alpha}, ω = {frequency}, {method:?}: {error:e}"
            );
            println!("α = {alpha}, ω = {frequency}, {method:?}: {error:.1e}");
        }
    }
}
