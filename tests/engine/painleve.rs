//! A rod that slides on rough ground (tests/data/06_painleve_rod.json): contact, detachment, and
//! the windows in which friction leaves the motion undetermined.

use crate::common::*;
use dalembert::hybrid::{Problem, simulate};
use dalembert::record::Silent;

/// A rod at `theta` whose lower end slips in the direction `slip`.
fn rod(mu: f64, theta: f64, rate: f64, slip: f64) -> Problem {
    let mut problem = problem("painleve_rod", &[("mu", mu)]);
    let initial = [
        ("theta", theta),
        ("theta.rate", rate),
        ("x.rate", slip),
        ("slip", slip.signum()),
    ];
    for (name, value) in initial {
        problem.set_initial(name, value).unwrap();
    }
    problem.set_tolerance(1e-13);
    problem.end.time = 1e-6;
    problem
}

/// Why the run cannot start or stops, if it does.
fn refusal(problem: &Problem) -> Option<String> {
    match simulate(problem, &mut Silent) {
        Ok(run) => run.failure.map(|f| f.reason.to_string()),
        Err(reason) => Some(reason.to_string()),
    }
}

#[test]
fn the_rod_slides_or_leaves_the_ground_as_it_must() {
    with_each_method(|| {
        let reference = reference("06_painleve_rod");
        let cases = reference["reference"]["classification"].as_array().unwrap();
        assert_eq!(cases.len(), 90);
        for case in cases {
            let theta = number(&case["theta_deg"]).to_radians();
            let slip = case["slip_sign"].as_f64().unwrap();
            let refusal = refusal(&rod(
                number(&case["mu"]),
                theta,
                number(&case["thetadot"]),
                slip,
            ));
            match case["class"].as_str().unwrap() {
                "unique contact (slide)" => assert_eq!(refusal, None, "{case}"),
                _ => assert!(
                    refusal.unwrap().contains("the rod leaves the ground"),
                    "{case}"
                ),
            }
        }
    });
}

#[test]
fn an_undetermined_motion_is_refused() {
    with_each_method(|| {
        let reference = reference("06_painleve_rod");
        let windows = &reference["reference"]["singular_windows(tan^2 th - 3 mu tan th + 4 = 0)"];
        for window in windows.as_array().unwrap() {
            let mu = number(&window["mu"]);
            let (low, high) = (
                number(&window["theta_low_deg"]),
                number(&window["theta_high_deg"]),
            );
            for (degrees, determined) in [
                (low - 1e-6, true),
                (low + 1e-6, false),
                (0.5 * (low + high), false),
                (high - 1e-6, false),
                (high + 1e-6, true),
            ] {
                let mut problem = rod(mu, f64::to_radians(degrees), 0.0, -1.0);
                // Near the window the friction is nearly infinite and stops the rod at once.
                problem.end.time = 1e-10;
                let refusal = refusal(&problem);
                assert_eq!(
                    refusal.is_none(),
                    determined,
                    "μ = {mu}, {degrees}°: {refusal:?}"
                );
                if let Some(reason) = refusal {
                    assert!(reason.contains("Painlevé"), "{reason}");
                }
            }
        }
    });
}

#[test]
fn slip_ends_when_the_reference_says() {
    with_each_method(|| {
        let reference = reference("06_painleve_rod");
        for case in reference["reference"]["slide_until_contact_velocity_zero"]
            .as_array()
            .unwrap()
        {
            let mu = number(&case["mu"]);
            let mut problem = rod(
                mu,
                std::f64::consts::FRAC_PI_3,
                0.0,
                number(&case["v_contact0"]),
            );
            problem.end.time = 0.03;
            let run = run(&problem);
            let stick = &run.events[0];
            assert_eq!(stick.transition, "stick");
            let exact = number(&case["t_slip_end"]);
            let error = (stick.t / exact - 1.0).abs();
            assert!(
                error < 1e-11,
                "μ = {mu}: slip ends at {:.17}, not {exact:.17}",
                stick.t
            );
            let theta = number(&case["theta_at_slip_end"]);
            assert!((stick.before.q[2] - theta).abs() < 1e-11);
        }
    });
}
