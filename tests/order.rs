//! The order of the method through the whole engine, events included.

mod common;
use common::*;
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
    problem.end.after = Some(("landing", 10));
    let run = run(&problem);
    let landing = times(&run, "landing")[9];
    ((landing / exact - 1.0).abs(), run.solver.steps as f64)
}

#[test]
fn impact_times_converge_with_order_nine() {
    // Five stages at these tolerances. Slope of the least-squares line of log error over log steps.
    let points: Vec<(f64, f64)> = (2..=7)
        .map(|digits| {
            let (error, steps) = tenth_impact(10f64.powi(-digits));
            (steps.ln(), error.ln())
        })
        .collect();
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    assert!((8.0..10.5).contains(&-slope), "order {}", -slope);
}
