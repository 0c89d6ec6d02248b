//! Hard cases at every tolerance from 1e-3 to 1e-13: no event is missed or doubled.

mod common;
use common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::Sine;
use dalembert::record::Run;
use std::f64::consts::{FRAC_PI_2, TAU};

const METHODS: [Method; 3] = [Method::Auto, Method::Radau, Method::Taylor];

fn tolerances() -> impl Iterator<Item = f64> {
    (3..=13).map(|digits| 10f64.powi(-digits))
}

/// A problem at the start, with absolute tolerances of the relative one times `sizes`: of the
/// coordinates, of their rates.
fn start(
    model: &str,
    parameters: &[(&str, f64)],
    initial: &[(&str, f64)],
    [q, v]: [f64; 2],
    relative: f64,
) -> Problem {
    let mut problem = problem(model, parameters);
    for (name, value) in initial {
        problem.set_initial(name, *value).unwrap();
    }
    problem.accuracy.relative = relative;
    problem.accuracy.q_absolute.fill(relative * q);
    problem.accuracy.v_absolute.fill(relative * v);
    problem
}

/// Runs with each method and tolerance.
fn everywhere(make: impl Fn(f64) -> Problem, check: impl Fn(&str, &Run)) {
    for method in METHODS {
        for tolerance in tolerances() {
            let mut problem = make(tolerance);
            problem.method = method;
            check(&format!("{method:?}, {tolerance:e}"), &run(&problem));
        }
    }
}

#[test]
fn a_thousand_impacts_in_a_slot_of_a_micrometre() {
    // The walls are lossless: an impact every microsecond.
    let none = [
        ("k", 0.0),
        ("static_friction", 0.0),
        ("kinetic_friction", 0.0),
        ("stop", 5e-7),
    ];
    let make = |tolerance| {
        let initial = [("x", -5e-7), ("x.rate", 1.0)];
        let mut slot = start(
            "coulomb_oscillator",
            &none,
            &initial,
            [1e-6, 1.0],
            tolerance,
        );
        slot.end.time = 1000.5e-6;
        slot
    };
    everywhere(make, |at, run| {
        let impacts = times(run, "impact");
        assert_eq!(impacts.len(), 1000, "{at}");
        assert!((impacts[999] / 1e-3 - 1.0).abs() < 1e-12, "{at}");
    });
}

#[test]
fn a_stiff_spring_is_pressed_and_left_fifty_times() {
    for k in [1e4, 1e8, 1e12_f64] {
        let make = |tolerance| {
            let sizes = [1.0 / k.sqrt(), 1.0];
            let mut buffer = start("buffer", &[("k", k)], &[("x.rate", 1.0)], sizes, tolerance);
            // Flights of 0.2 s, and contacts of less than 0.04 s.
            buffer.end.time = 50.0 * 0.25;
            buffer.end.after = Some(("leave", 50));
            buffer
        };
        everywhere(make, |at, run| {
            let expected: Vec<_> = ["press", "leave"].repeat(50);
            assert_eq!(transitions(run), expected, "k = {k:e}, {at}");
        });
    }
}

#[test]
fn stick_and_slip_repeat() {
    let parameters = [("belt", 0.1), ("mu_s", 0.1), ("mu_k", 0.06), ("g", 10.0)];
    let make = |tolerance| {
        let mut belt = start("belt_oscillator", &parameters, &[], [1.0, 0.1], tolerance);
        belt.initial.mode = Some(mode(&belt, "sticks"));
        // From 10 s on a period of 11.6 s.
        belt.end.time = 100.0;
        belt
    };
    everywhere(make, |at, run| {
        let expected: Vec<_> = ["slip", "stick"].repeat(8);
        assert_eq!(transitions(run), expected, "{at}");
    });
}

/// A lower mass that sticks for half a microsecond at a time. The elongation of the spring is a hundred
/// thousandth of the size that the model states, and an error of that size would be a hundred thousand
/// times the friction.
#[test]
fn stick_phases_below_a_microsecond_need_no_tolerances_of_their_own() {
    let make = |tolerance| {
        let parameters = [("k", 1.05e10), ("c", 6.42e6)];
        let mut problem = problem("sliding_oscillator", &parameters);
        let shaking = Sine::new(20.0, 7.0 * TAU, 0.0);
        problem
            .set_input("ground_acceleration", shaking.into())
            .unwrap();
        problem.end.time = 0.4;
        problem.set_tolerance(tolerance);
        problem
    };
    let better = run(&make(1e-14));
    let mut expected = vec!["slip"];
    expected.extend(["stick", "slip"].repeat(5));
    assert_eq!(transitions(&better), expected);
    everywhere(make, |at, run| {
        assert_eq!(transitions(run), expected, "{at}");
        let tolerance: f64 = at.rsplit(' ').next().unwrap().parse().unwrap();
        for (event, exact) in run.events.iter().zip(&better.events) {
            let late = (event.t - exact.t).abs();
            assert!(late <= tolerance * exact.t, "{at}: {late:e} at {}", exact.t);
        }
    });
}

#[test]
fn two_crossings_are_told_from_none() {
    for d in [1e-2, 1e-6, 1e-10] {
        let make = |tolerance| {
            let parameters = [("c", 0.7310585786300049), ("d", d)];
            let mut runner = start(
                "runner",
                &parameters,
                &[("x.rate", 1.0)],
                [1.0; 2],
                tolerance,
            );
            runner.choose(&[("guard", "two_roots")]).unwrap();
            runner.initial.mode = Some(mode(&runner, "outside"));
            runner
        };
        everywhere(make, |at, run| {
            assert_eq!(transitions(run), ["enter", "leave"], "d = {d:e}, {at}");
        });
    }
}

/// A grazing motion is told from one that just does not touch down to the tolerance: what touches by
/// less is not known to touch.
#[test]
fn grazing_is_told_on_both_sides_down_to_the_tolerance() {
    let reference = reference("07_grazing");
    for case in reference["reference"]["grazing"].as_array().unwrap() {
        let [omega, zeta, force, stop, lag] =
            ["omega", "zeta", "F_graz", "sigma", "phase_lag"].map(|key| number(&case[key]));
        for part in [-10.0, 10.0] {
            let make = |tolerance: f64| {
                let excess = 1.0 + part * tolerance;
                let parameters = [
                    ("c", 2.0 * zeta),
                    ("static_friction", 0.0),
                    ("kinetic_friction", 0.0),
                    ("stop", stop),
                ];
                let initial = [("x.rate", -omega * excess), ("slip", -1.0)];
                let sizes = [stop, omega * stop];
                let mut problem = start(
                    "coulomb_oscillator",
                    &parameters,
                    &initial,
                    sizes,
                    tolerance,
                );
                let shaking = Sine::new(force * excess, omega, lag + 2.0 * FRAC_PI_2);
                problem.set_input("force", shaking.into()).unwrap();
                problem.end.time = TAU / omega;
                problem
            };
            everywhere(make, |at, run| {
                let impacts = times(run, "impact").len();
                assert_eq!(
                    impacts > 0,
                    part > 0.0,
                    "ω = {omega}, {at}, {part}: {impacts}"
                );
            });
        }
    }
}
