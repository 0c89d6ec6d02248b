//! Housner's rocking block against closed forms (tests/data/01_rocking_free.json).

use crate::common::*;
use dalembert::hybrid::{Method, simulate};
use dalembert::record::Silent;

fn free_rocking(case: &serde_json::Value, end: f64) -> dalembert::record::Run {
    let (alpha, p) = (number(&case["alpha"]), number(&case["p"]));
    // p² = m g R / (I + m R²) = 3 g / (4 R) for the homogeneous block.
    let mut problem = problem(
        "rocking_block",
        &[
            ("alpha", alpha),
            ("e", number(&case["e"])),
            ("R", 3.0 * 9.81 / (4.0 * p * p)),
        ],
    );
    problem
        .set_initial("theta", number(&case["theta0"]))
        .unwrap();
    problem.set_tolerance(1e-13);
    problem.end.time = end;
    run(&problem)
}

fn check_impacts(case: &serde_json::Value, run: &dalembert::record::Run) {
    let exact = numbers(&case["reference"]["impact_times"]);
    let found = times(run, "base strikes");
    assert!(found.len() >= 40, "{} landings", found.len());
    for (k, (t, exact)) in found.iter().zip(&exact).enumerate() {
        assert!(
            (t / exact - 1.0).abs() < 1e-11,
            "impact {k}: {t:.17} instead of {exact:.17}"
        );
    }
}

#[test]
fn forty_impacts_and_the_accumulation_of_a_damped_block() {
    with_each_method(|| {
        let reference = reference("01_rocking_free");
        let case = &reference["reference"]["subcases"][0];
        assert_eq!(case["name"], "A_housner");
        let run = free_rocking(case, 11.0);
        check_impacts(case, &run);
        let rest = times(&run, "rest");
        let exact = number(&case["reference"]["accumulation_time"]);
        assert_eq!(rest.len(), 1);
        assert!(
            (rest[0] / exact - 1.0).abs() < 1e-9,
            "{} instead of {exact}",
            rest[0]
        );
        assert_eq!(run.layout.modes.name(run.end.mode), "base closed");
        assert_eq!(at_end(&run, "theta"), 0.0);
        let before = run.events[0].before.v[0];
        let speed = number(&case["reference"]["impact_speed_before_first"]);
        assert!((before / -speed - 1.0).abs() < 1e-11);
    });
}

#[test]
fn forty_impacts_of_an_elastic_block() {
    with_each_method(|| {
        let reference = reference("01_rocking_free");
        let subcases = reference["reference"]["subcases"].as_array().unwrap();
        let case = subcases.iter().find(|c| c["name"] == "D_elastic").unwrap();
        let run = free_rocking(case, 1.01 * numbers(&case["reference"]["impact_times"])[40]);
        check_impacts(case, &run);
    });
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
            let r = 3.0 * 9.81 / (4.0 * 2.0 * 2.0);
            let mut problem = problem("rocking_block", &[("alpha", alpha), ("R", r)]);
            problem.set_initial("theta", theta).unwrap();
            tighten(&mut problem, alpha - theta);
            problem.method = method;
            problem.end.time = 20.0;
            problem.end.after = Some(("base strikes", 1));
            let run = run(&problem);
            let error = (times(&run, "base strikes")[0] - exact).abs();
            // A rounding of θ is amplified to this. Found: 1.1 times it.
            let amplified = 0.5 * f64::EPSILON * alpha / (2.0 * (alpha - theta));
            assert!(
                error < 3.0 * amplified + 1e-15,
                "{theta}, {method:?}: {error:e}"
            );

            // As far beyond the equilibrium it falls over, and leaves the ground in the end.
            problem.set_initial("theta", 2.0 * alpha - theta).unwrap();
            let run = simulate(&problem, &mut Silent).unwrap();
            assert_eq!(times(&run, "base strikes").len(), 0, "{theta}, {method:?}");
            if let Some(failure) = run.failure {
                assert!(
                    failure.reason.to_string().contains("leave the ground"),
                    "{failure:?}"
                );
            }
        }
    }
}
