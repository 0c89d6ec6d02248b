//! What a mode requires holds wherever a run says that it went: within steps too.

use crate::common::{lifted_slider, problem};
use dalembert::hybrid::{Method, simulate};
use dalembert::input::Sine;
use dalembert::record::Silent;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::TAU;

proptest! {
    // The cases are the same in every run: a suite must not fail by chance.
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2),
        ..ProptestConfig::with_cases(300)
    })]

    /// A block that is thrown or shaken until it falls over: its normal force vanishes, and is back soon after.
    #[test]
    fn the_normal_force_is_positive_at_every_sample(
        radius in 0.3..2.0,
        alpha in 0.1..0.5,
        throw in 0.0..3.5,
        amplitude in 0.0..6.0,
        frequency in 0.3..3.0,
        relative in prop::sample::select(vec![1e-3, 1e-6, 1e-9]),
        method in prop::sample::select(vec![Method::Taylor, Method::Radau]),
    ) {
        let mut problem = problem("rocking_block", &[("R", radius), ("alpha", alpha)]);
        problem.set_initial("theta", 0.3 * alpha).unwrap();
        problem.set_initial("theta.rate", throw).unwrap();
        let shaking = Sine::new(amplitude, TAU * frequency, 0.7);
        problem.set_input("ground_acceleration", shaking.into()).unwrap();
        problem.set_tolerance(relative);
        problem.method = method;
        problem.end.time = 2.0;
        problem.record.every = Some(1e-3);
        problem.record.columns.reactions = true;
        let run = simulate(&problem, &mut Silent).unwrap();
        let column = run.trajectory.column("reaction.y").unwrap();
        let fails = run.failure.as_ref().map_or(f64::INFINITY, |failure| failure.at.t);
        for i in (0..run.trajectory.len()).take_while(|&i| run.trajectory.t[i] < fails) {
            let (t, force) = (run.trajectory.t[i], run.trajectory.row(i)[column]);
            // A sample within the tolerance of the weight of zero may be on either side.
            prop_assert!(force > -relative * 9.81, "{force:e} at {t}, fails at {fails}");
        }
        if let Some(failure) = &run.failure {
            prop_assert!(failure.reason.to_string().contains("leave the ground"), "{failure:?}");
            let lift = failure.at.t;
            prop_assert!(run.trajectory.t.iter().all(|t| *t <= lift), "samples after {lift}");
        }
    }
}

/// A slider x = a cos 2t that is pulled upwards by p sin 3t: each of its requirements fails where m g = p sin 3t, or
/// strength = tension/(1 + x/length), and holds again 30 to 210 ms later.
#[test]
fn requirements_that_fail_for_a_moment_stop_the_run_there() {
    for (a, p, exact, reason) in [
        (
            0.5,
            10.5,
            (10.0_f64 / 10.5).asin() / 3.0,
            "leave the ground",
        ),
        (
            0.5,
            10.01,
            (10.0_f64 / 10.01).asin() / 3.0,
            "leave the ground",
        ),
        (
            0.91,
            5.0,
            (-0.9_f64 / 0.91).acos() / 2.0,
            "rope would break",
        ),
        (0.5, 9.99, f64::INFINITY, ""),
        (0.89, 5.0, f64::INFINITY, ""),
    ] {
        for method in [Method::Taylor, Method::Radau] {
            for relative in [1e-3, 1e-6, 1e-9, 1e-12] {
                let mut slider = lifted_slider(a, p, relative);
                slider.method = method;
                let run = simulate(&slider, &mut Silent).unwrap();
                let what = format!("{a}, {p}, {method:?}, {relative:e}");
                let Some(failure) = run.failure else {
                    assert_eq!(exact, f64::INFINITY, "{what}");
                    continue;
                };
                assert!(
                    failure.reason.to_string().contains(reason),
                    "{what}: {failure:?}"
                );
                // The rope's end comes at 0.27 m/s, and may be off by a tolerance of x and some.
                let error = (failure.at.t - exact).abs();
                assert!(error < 5.0 * relative, "{what}: {error:e}");
            }
        }
    }
}

/// A model with twelve conditions of one transition and twelve requirements of one mode, at 1 m/s from x = 0.
fn many(door: f64, method: Method) -> dalembert::record::Run {
    let mut many = problem("many", &[("l", 0.3), ("door", door)]);
    many.set_initial("x.rate", 1.0).unwrap();
    many.method = method;
    many.end.time = 10.0;
    simulate(&many, &mut Silent).unwrap()
}

#[test]
fn conditions_and_requirements_count_to_the_last() {
    for method in [Method::Taylor, Method::Radau] {
        let stopped = many(1.0, method);
        assert!(stopped.failure.is_none());
        let [event] = &stopped.events[..] else {
            panic!("{:?}", stopped.events)
        };
        assert!((event.t - 0.3).abs() < 1e-9, "{}", event.t);
        // Held at a parameter: exactly there.
        assert_eq!(event.after.q, [0.3]);
        // The last condition holds it off, and the last requirement fails first.
        let failure = many(-1.0, method)
            .failure
            .expect("nothing stops it but a requirement");
        assert!(
            failure.reason.to_string().contains("beyond the place 12"),
            "{failure:?}"
        );
        assert!((failure.at.t - 8.0 * 0.3).abs() < 1e-9, "{failure:?}");
    }
}
