//! On either side of overturning: a block that just comes back and one that just does not
//! (tests/data/02_overturning_spectrum.json and a closed form).

mod common;
use common::*;
use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::input::Sine;
use dalembert::record::Silent;
use std::f64::consts::TAU;

/// Whether the block lands again: one that overturns does not, and leaves the ground in the end.
fn comes_back(problem: &Problem) -> bool {
    let run = simulate(problem, &mut Silent).expect("the problem can be started");
    let landed = run.events.iter().any(|e| e.transition == "landing");
    if let Some(failure) = &run.failure {
        assert!(failure.reason.contains("leave the ground"), "{failure:?}");
        assert!(!landed);
    }
    landed
}

/// A homogeneous block with p = √(3 g/(4 R)).
fn block(alpha: f64, p: f64) -> Problem {
    problem(
        "rocking_block",
        &[("alpha", alpha), ("R", 3.0 * 9.81 / (4.0 * p * p))],
    )
}

#[test]
fn one_sine_overturns_a_block_from_the_reference_amplitude_on() {
    let reference = reference("02_overturning_spectrum");
    let rows = &reference["reference"]["one_sine_no_impact_nonlinear"];
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), 4);
    for row in rows {
        let [alpha, omega, amplitude] =
            ["alpha", "omega_p_over_p", "ap_over_g_alpha"].map(|key| number(&row[key]));
        for method in [Method::Auto, Method::Radau, Method::Taylor] {
            // The reference demands the amplitude to 1e-9.
            for (excess, overturns) in [(-1e-9, false), (1e-9, true)] {
                let mut problem = block(alpha, 1.0);
                let amplitude = amplitude * (1.0 + excess) * 9.81 * alpha;
                // The block lifts off as the pulse begins.
                let phase = (alpha.tan() * 9.81 / amplitude).asin();
                let pulse = Sine::new(amplitude, omega, phase);
                let pulse = pulse.between(0.0, (TAU - phase) / omega);
                problem
                    .set_input("ground_acceleration", pulse.into())
                    .unwrap();
                tighten(&mut problem, 1.0);
                problem.method = method;
                problem.end.time = 100.0;
                problem.end.after = Some(("landing", 1));
                assert_eq!(
                    comes_back(&problem),
                    !overturns,
                    "{row}: {method:?}, {excess:e}"
                );
            }
        }
    }
}

#[test]
fn a_block_released_just_below_its_equilibrium_falls_back_in_time() {
    // t₁ = (K(k) − F(φ, k))/p, k = cos((α − θ₀)/2), sin φ = cos(α/2)/k, for these θ₀ as doubles
    // (the form of tests/data/01_rocking_free.json, in 40 digits).
    let alpha = 0.25;
    for (theta, exact) in [
        (0.249, 3.107_953_873_982_982),
        (0.249999, 6.561_833_324_416_633),
        (0.249999999, 10.015_710_964_172_975),
        (0.249999999999, 13.469_585_786_481_053),
    ] {
        for method in [Method::Auto, Method::Radau, Method::Taylor] {
            let mut problem = block(alpha, 2.0);
            problem.set_initial("theta", theta).unwrap();
            tighten(&mut problem, alpha - theta);
            problem.method = method;
            problem.end.time = 20.0;
            problem.end.after = Some(("landing", 1));
            let run = run(&problem);
            let error = (times(&run, "landing")[0] - exact).abs();
            // A rounding of θ is amplified to this. Found: 1.1 times it.
            let amplified = 0.5 * f64::EPSILON * alpha / (2.0 * (alpha - theta));
            assert!(
                error < 3.0 * amplified + 1e-15,
                "{theta}, {method:?}: {error:e}"
            );

            let mut beyond = problem.clone();
            beyond.set_initial("theta", 2.0 * alpha - theta).unwrap();
            assert!(!comes_back(&beyond), "{theta}, {method:?}");
        }
    }
}
