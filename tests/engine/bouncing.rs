//! Bouncing ball and vibrating table against closed forms (tests/data/05_bouncing_ball.json).

use crate::common::*;
use dalembert::hybrid::Method;
use dalembert::input::{Function, Sine};
use serde_json::Value;

#[test]
fn a_dropped_ball_comes_to_rest_at_the_limit_of_its_bounces() {
    with_each_method(|| {
        let reference = reference("05_bouncing_ball");
        for case in reference["reference"]["zeno_drop"].as_array().unwrap() {
            let e = number(&case["e"]);
            let mut problem = problem("hand_ball", &[("e", e)]);
            problem.set_initial("h", 1.0).unwrap();
            problem.set_tolerance(1e-13);
            problem.end.time = 100.0;
            let run = run(&problem);
            let found = times(&run, "impact");
            for (k, (t, exact)) in found.iter().zip(numbers(&case["impact_times"])).enumerate() {
                assert!(
                    (t / exact - 1.0).abs() < 1e-13,
                    "e = {e}, impact {k}: {t:.17} {exact:.17}"
                );
            }
            let exact = number(&case["accumulation_time"]);
            let rest = times(&run, "rest");
            assert_eq!(rest.len(), 1, "e = {e}");
            assert!(
                (rest[0] / exact - 1.0).abs() < 1e-10,
                "e = {e}: {} {exact}",
                rest[0]
            );
            assert_eq!(run.layout.modes.name(run.end.mode), "rests");
            assert_eq!((at_end(&run, "h"), at_end(&run, "h.rate")), (0.0, 0.0));
        }
    });
}

/// A table with displacement sin t in the units of the reference: 1/g = Γ. The ground's motion of
/// a run starts from rest at 0, which only adds a constant velocity: y = gap, relative to the table.
fn table(gamma: f64, e: f64, start: f64) -> dalembert::hybrid::Problem {
    let mut problem = problem("hand_table_ball", &[("e", e), ("g", 1.0 / gamma)]);
    let acceleration = Sine::new(1.0, 1.0, start + std::f64::consts::PI);
    problem
        .set_input("table_acceleration", Function::from(acceleration))
        .unwrap();
    problem.set_tolerance(1e-13);
    problem
}

#[test]
fn fifty_impacts_on_a_vibrating_table() {
    with_each_method(|| {
        let reference = reference("05_bouncing_ball");
        for case in reference["reference"]["vibrating_table_50_impacts"]
            .as_array()
            .unwrap()
        {
            let (gamma, start) = (number(&case["Gamma"]), number(&case["t0"]));
            let mut problem = table(gamma, number(&case["e"]), start);
            // Absolute velocity v⁺ of the ball after the impact at t0, on a table that moves at cos t0.
            problem
                .set_initial("gap.rate", number(&case["v_plus0"]) - start.cos())
                .unwrap();
            let exact = numbers(&case["impact_times"]);
            problem.end.time = exact[49] - start + 1.0;
            let run = run(&problem);
            let found = times(&run, "impact");
            let amplification = numbers(&case["amplification_dt_n/dv0"]);
            let mut compared = 0;
            for k in 0..50 {
                let allowed = 1e-13 * amplification[k].abs().max(1.0) * exact[k].max(1.0);
                if allowed > 1e-3 {
                    break;
                }
                let error = (found[k] + start - exact[k]).abs();
                assert!(
                    error <= allowed,
                    "Γ = {gamma}, impact {k}: error {error:e} > {allowed:e}"
                );
                compared += 1;
            }
            assert!(compared >= 10, "Γ = {gamma}: {compared} impacts compared");
        }
    });
}

fn chattering(case: &Value) {
    let (gamma, e) = (number(&case["Gamma"]), number(&case["e"]));
    let release = (1.0 / gamma).asin();
    let mut problem = table(gamma, e, release);
    problem.end.time = 8.0;
    let run = run(&problem);
    let exact = numbers(&case["first_impacts"]);
    let found = times(&run, "impact");
    for (k, exact) in exact.iter().enumerate().take(15) {
        let error = (found[k] + release - exact).abs();
        assert!(error < 1e-12, "Γ = {gamma}, impact {k}: {error:e}");
    }
    let rest = times(&run, "rest")[0] + release;
    let exact = number(&case["accumulation_time(stick begins)"]);
    assert!(
        (rest - exact).abs() < 1e-8,
        "Γ = {gamma}: stick begins at {rest}, not {exact}"
    );
    let releases = times(&run, "take_off");
    let next = releases.iter().find(|&&t| t > 1.0).unwrap() + release;
    let exact = number(&case["next_release"]);
    assert!(
        (next / exact - 1.0).abs() < 1e-12,
        "Γ = {gamma}: released at {next}, not {exact}"
    );
}

#[test]
fn chattering_ends_in_sticking_and_release() {
    with_each_method(|| {
        let reference = reference("05_bouncing_ball");
        for gamma in ["1.2", "1.5"] {
            let cases = reference["reference"]["chattering_sticking"]
                .as_array()
                .unwrap();
            let matches = |c: &&Value| number(&c["Gamma"]) == gamma.parse::<f64>().unwrap();
            chattering(cases.iter().find(matches).unwrap());
        }
    });
}

#[test]
fn an_accumulation_in_every_period_of_an_orbit_is_found() {
    with_each_method(|| {
        let reference = reference("05_bouncing_ball");
        let cases = reference["reference"]["chattering_sticking"]
            .as_array()
            .unwrap();
        let periodic = cases
            .iter()
            .filter(|c| c["orbit_period_in_table_periods"] == 1);
        let mut count = 0;
        for case in periodic {
            count += 1;
            let gamma = number(&case["Gamma"]);
            let release = (1.0 / gamma).asin();
            let mut problem = table(gamma, number(&case["e"]), release);
            let period = std::f64::consts::TAU;
            problem.end.time = 10.0 * period - 0.1;
            let run = run(&problem);
            let rests = times(&run, "rest");
            let sticks = number(&case["accumulation_time(stick begins)"]) - release;
            // Beside it the ball that stands on the table at t = 0 and is released at once.
            let rests: Vec<f64> = rests.into_iter().filter(|&t| t > 0.0).collect();
            assert_eq!(rests.len(), 10, "Γ = {gamma}: {rests:?}");
            for (n, rest) in rests.iter().enumerate() {
                let error = (rest - sticks - n as f64 * period).abs();
                // The reference demands 1e-8; found: 7e-15, a rounding of t.
                assert!(error < 1e-13, "Γ = {gamma}, period {n}: {error:e}");
            }
            let releases: Vec<f64> = times(&run, "take_off")
                .into_iter()
                .filter(|&t| t > 1.0)
                .collect();
            assert_eq!(releases.len(), 9, "Γ = {gamma}");
            for (n, t) in releases.iter().enumerate() {
                let error = (t - (n + 1) as f64 * period).abs();
                assert!(error < 1e-12, "Γ = {gamma}, release {n}: {error:e}");
            }
        }
        assert_eq!(count, 2);
    });
}

/// A spring presses a mass against a stop at 1 m: hops become as low as the rounding of 1 m before they are as short as tolerances ask
/// for. From rest at 0 it strikes after π/6 s at 2√3 m/s, and hops of u m/s last atan(u/2) s.
#[test]
fn hops_at_a_stop_that_is_not_at_zero_come_to_rest() {
    for e in [0.1, 0.5, 0.9, 0.97] {
        let hop = |n: i32| (3f64.sqrt() * f64::powi(e, n)).atan();
        let exact = std::f64::consts::FRAC_PI_6 + (1..4000).rev().map(hop).sum::<f64>();
        with_each_method(|| {
            for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
                let mut mass = problem("pressed_mass", &[("e", e)]);
                mass.initial.mode = Some(mode(&mass, "stop open"));
                mass.set_tolerance(tolerance);
                mass.end.time = exact + 1.0;
                mass.end.after = Some(("stop strikes", 5000));
                let run = run(&mass);
                let rests = times(&run, "rest");
                assert_eq!(
                    rests.len(),
                    1,
                    "{e} {tolerance:e}: {} events",
                    run.events.len()
                );
                let off = (rests[0] - exact).abs();
                // An error of one hop is in all that follow, and that of the rest of the series is (1 − e)² times less. A series has
                // no rounding of where a hop begins. The implicit method leaves to it what is off by more than the tolerance, and is
                // told at least by hops down to 2¹³ roundings of 1 m, off by a rounding over their speed (a = 4 m/s²).
                let of_steps = match mass.method {
                    Method::Radau => {
                        let speed = (2.0 * 4.0 * 8192.0 * f64::EPSILON).sqrt();
                        (4.0 * f64::EPSILON / speed).min(tolerance * exact)
                    }
                    _ => 4.0 * f64::EPSILON,
                };
                let error = 10.0 * tolerance / (1.0 - e) + of_steps / (1.0 - e).powi(2);
                assert!(off < error, "{e} {tolerance:e}: {off:e}");
                assert_eq!(run.layout.modes.name(run.end.mode), "stop closed");
            }
        });
    }
}
