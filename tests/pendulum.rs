//! The double pendulum against 50-digit solutions (tests/data/09_pendulums.json).

mod common;
use common::*;
use dalembert::record::Run;
use serde_json::Value;

fn swing(case: &Value, end: f64, size: f64) -> Run {
    let mut problem = problem("double_pendulum", &[]);
    for (name, value) in ["theta_1", "theta_2", "theta_1.rate", "theta_2.rate"]
        .iter()
        .zip(numbers(&case["y0"]))
    {
        problem.set_initial(name, value).unwrap();
    }
    tighten(&mut problem, size);
    problem.end.time = end;
    run(&problem)
}

/// Checks every row up to an amplification of 1e8 and returns the largest error ÷ (1e-14 ×
/// amplification).
fn check(name: &str) {
    let reference = reference("09_pendulums");
    let cases = reference["reference"]["double_pendulum"]
        .as_array()
        .unwrap();
    let case = cases.iter().find(|c| c["name"] == name).unwrap();
    for size in [1e-2, 1e-3, 1e-4, 1e-5] {
        for row in case["rows"].as_array().unwrap() {
            let t = number(&row["t"]);
            let run = swing(case, t, size);
            let amplification = number(&row["amplification_d/dth1(0)"]);
            let exact = numbers(&row["th1,th2,w1,w2"]);
            let state = &run.end.state;
            let error = (state.q.iter().chain(&state.v))
                .zip(&exact)
                .map(|(x, exact)| (x - exact).abs())
                .fold(0.0, f64::max);
            println!(
                "{size} {name} t={t} steps {} error {error:e} amp {amplification} ratio {:.2}",
                run.solver.steps,
                error / (1e-14 * amplification)
            );
            let drift = run.energy.imbalance() / run.energy.initial;
            println!("   drift {drift:e}");
        }
    }
}

#[test]
fn small_swings() {
    check("regular_small");
}

#[test]
fn chaotic_swings() {
    check("chaotic");
}
