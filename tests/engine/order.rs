//! Accuracy and steps of the implicit method through the whole engine, events included.

use crate::common::*;
use dalembert::hybrid::Method;

/// Error of the tenth impact of the damped rocking block, and the number of steps so far.
fn tenth_impact(tolerance: f64) -> (f64, f64) {
    let reference = reference("01_rocking_free");
    let case = &reference["reference"]["subcases"][0];
    let (alpha, p) = (number(&case["alpha"]), number(&case["p"]));
    let parameters = [
        ("alpha", alpha),
        ("e", number(&case["e"])),
        ("R", 3.0 * 9.81 / (4.0 * p * p)),
    ];
    let mut problem = problem("rocking_block", &parameters);
    problem
        .set_initial("theta", number(&case["theta0"]))
        .unwrap();
    problem.method = Method::Radau;
    problem.set_tolerance(tolerance);
    let exact = numbers(&case["reference"]["impact_times"])[9];
    problem.end.time = 20.0;
    problem.end.after = Some(("base strikes", 10));
    let run = run(&problem);
    let landing = times(&run, "base strikes")[9];
    ((landing / exact - 1.0).abs(), run.solver.steps as f64)
}

#[test]
fn impact_times_are_as_accurate_as_asked_for() {
    // Steps are as long as the flights between impacts, so that no order shows; that of the method is
    // in tests/integrate/order.rs. Both numbers of stages are in the range.
    for digits in 2..=12 {
        let tolerance = 10f64.powi(-digits);
        let (error, steps) = tenth_impact(tolerance);
        // Found: at most 0.034 of the tolerance, at 1e-7, the tightest with five stages; 13 to 26 steps.
        assert!(error < 0.05 * tolerance, "{tolerance:e}: {error:e}");
        assert!(steps < 30.0, "{tolerance:e}: {steps} steps");
    }
}
