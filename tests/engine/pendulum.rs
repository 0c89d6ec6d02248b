//! The double pendulum against 50-digit solutions (tests/data/09_pendulums.json).

use crate::common::*;
use dalembert::record::Run;
use serde_json::Value;

fn swing(case: &Value, end: f64) -> Run {
    let mut problem = problem("double_pendulum", &[]);
    let names = ["theta_1", "theta_2", "theta_1.rate", "theta_2.rate"];
    for (name, value) in names.iter().zip(numbers(&case["y0"])) {
        problem.set_initial(name, value).unwrap();
    }
    tighten(&mut problem, 1e-3);
    problem.end.time = end;
    run(&problem)
}

/// Checks states and energy at all times of a case up to `last`.
///
/// An error of 1e-14 is allowed at the start and amplified as the reference says. It may as well be
/// made on the way, so what counts is the largest amplification so far.
fn check(name: &str, last: f64, allowed_drift: f64) {
    let reference = reference("09_pendulums");
    let cases = reference["reference"]["double_pendulum"]
        .as_array()
        .unwrap();
    let case = cases.iter().find(|c| c["name"] == name).unwrap();
    let mut amplification = 1.0f64;
    for row in case["rows"].as_array().unwrap() {
        let t = number(&row["t"]);
        if t > last {
            break;
        }
        let run = swing(case, t);
        amplification = amplification.max(number(&row["amplification_d/dth1(0)"]));
        let exact = numbers(&row["th1,th2,w1,w2"]);
        let state = &run.end.state;
        let errors = (state.q.iter().chain(&state.v)).zip(&exact);
        let error = errors.fold(0.0, |worst: f64, (x, exact)| worst.max((x - exact).abs()));
        let allowed = 1e-14 * amplification;
        assert!(
            error < allowed,
            "{name}, t = {t}: {error:e}, allowed {allowed:e}"
        );
        let ledger = run.energy.as_ref().unwrap();
        let drift = ledger.imbalance() / ledger.initial;
        assert!(
            drift.abs() < allowed_drift,
            "{name}, t = {t}: energy off by {drift:e}"
        );
        assert!((ledger.initial / number(&case["energy"]) - 1.0).abs() < 1e-15);
    }
}

#[test]
fn small_swings() {
    with_each_method(|| {
        check("regular_small", 50.0, 1e-14);
    });
}

/// At t = 20 the amplification is 1e15: a double cannot tell where the pendulum is.
#[test]
fn chaotic_swings() {
    with_each_method(|| {
        check("chaotic", 10.0, 1e-12);
    });
}
