//! Steps: limits, restarts, exact lengths, work.

use crate::problems::{DoublePendulum, Oscillator, Rober};
use crate::{run, start, tolerances};
use dalembert::integrate::{FirstOrder, System, Tolerances};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector, vector};

#[test]
fn steps_end_exactly_at_the_limit_and_never_exceed_the_length_allowed() {
    let mut pendulum = DoublePendulum { g: 9.81 };
    let (q, v) = (vector![1.0, 2.0], vector![0.0, 0.0]);
    let mut radau = start::<3, 2>(&mut pendulum, q, v, &tolerances(1e-6, 1.0, 1.0));
    for limit in [0.1, 0.3, 0.3 + 1e-12, 1.0] {
        while radau.state().t < limit {
            let report = radau.step(&mut pendulum, limit, 0.004).unwrap();
            assert!(report.h <= 0.004 && report.t_end <= limit);
            assert_eq!(report.t_end, radau.state().t);
        }
        assert_eq!(radau.state().t, limit);
    }
}

#[test]
fn a_step_cut_short_does_not_shorten_the_next() {
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.0,
        linear: true,
    };
    let (one, zero) = (vector![1.0], vector![0.0]);
    let mut radau = start::<3, 1>(&mut oscillator, one, zero, &tolerances(1e-6, 1.0, 1.0));
    for _ in 0..10 {
        radau.step(&mut oscillator, 100.0, f64::INFINITY).unwrap();
    }
    let before = radau.proposal().unwrap();
    let t = radau.state().t;
    radau
        .step(&mut oscillator, t + 1e-9, f64::INFINITY)
        .unwrap();
    assert_eq!(radau.proposal().unwrap(), before);
}

#[test]
fn a_step_taken_again_ends_where_asked_with_full_order() {
    let mut pendulum = DoublePendulum { g: 9.81 };
    let (q, v) = (vector![1.0, 2.0], vector![0.0, 0.0]);
    let loose = tolerances(1e-4, 1.0, 1.0);
    let mut radau = start::<3, 2>(&mut pendulum, q, v, &loose);
    for _ in 0..5 {
        radau.step(&mut pendulum, 10.0, f64::INFINITY).unwrap();
    }
    let origin = *radau.start();
    let part = 0.3 * radau.dense().unwrap().length();
    let interpolated = radau.dense().unwrap().at_offset(part).0;

    // The same flow at a tight tolerance, from the same start.
    let mut exact = start::<7, 2>(&mut pendulum, q, v, &tolerances(1e-13, 1.0, 1.0));
    exact.restart(origin.t, &origin.q, &origin.v, &origin.a);
    while exact.state().t < origin.t + part {
        exact
            .step(&mut pendulum, origin.t + part, f64::INFINITY)
            .unwrap();
    }

    for _ in 0..2 {
        let report = radau.step_exactly(&mut pendulum, part).unwrap();
        assert_eq!((report.h, report.t_end), (part, origin.t + part));
        assert_eq!(*radau.start(), origin, "from the same start");
    }
    assert_eq!(radau.counters().retaken, 2);
    let error = (radau.state().q - exact.state().q).amax();
    let dense_error = (interpolated - exact.state().q).amax();
    // Newton's iteration stops at 3 % of the tolerance.
    assert!(error < 3e-6, "{error:e}");
    assert!(dense_error < 1e-3, "{dense_error:e}");
}

#[test]
fn the_first_step_after_a_restart_is_near_what_the_error_allows() {
    // One rejection at most, and growth to the length of the steps that follow within two steps.
    for relative in [1e-3, 1e-6, 1e-9, 1e-12] {
        for phase in [0.0, 0.4, 0.8, 1.2, 1.57, 2.5] {
            let mut oscillator = Oscillator {
                omega: 3.0,
                zeta: 0.0,
                linear: false,
            };
            let (sin, cos) = f64::sin_cos(phase);
            let (q, v) = (vector![0.1 * cos], vector![0.3 * sin]);
            let sizes = tolerances(relative, 0.1, 0.3);
            let mut radau = start::<3, 1>(&mut oscillator, q, v, &sizes);
            let first = radau.step(&mut oscillator, 100.0, f64::INFINITY).unwrap();
            let mut later = 0.0;
            for _ in 0..10 {
                later = radau.step(&mut oscillator, 100.0, f64::INFINITY).unwrap().h;
            }
            assert!(first.discarded <= 1, "{relative:e} {phase}: {first:?}");
            let part = first.h / later;
            assert!((0.12..8.0).contains(&part), "{relative:e} {phase}: {part}");
        }
    }
}

#[test]
fn a_restart_forgets_the_step_before() {
    let mut pendulum = DoublePendulum { g: 9.81 };
    let (q, v) = (vector![1.0, 2.0], vector![0.0, 0.0]);
    let sizes = tolerances(1e-8, 1.0, 1.0);
    let mut fresh = start::<3, 2>(&mut pendulum, q, v, &sizes);
    let mut used = start::<3, 2>(&mut pendulum, vector![0.3, 0.2], v, &sizes);
    for _ in 0..7 {
        used.step(&mut pendulum, 10.0, f64::INFINITY).unwrap();
    }
    let mut a = SVector::zeros();
    pendulum.acceleration(0.0, &q, &v, &mut a).unwrap();
    used.restart(0.0, &q, &v, &a);
    for _ in 0..7 {
        fresh.step(&mut pendulum, 10.0, f64::INFINITY).unwrap();
        used.step(&mut pendulum, 10.0, f64::INFINITY).unwrap();
        assert_eq!(fresh.state(), used.state(), "to the last bit");
    }
}

#[test]
fn a_linear_system_needs_one_iteration_a_step_and_one_jacobian() {
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.05,
        linear: true,
    };
    let sizes = tolerances(1e-9, 1.0, 1.0);
    let (_, work) = run::<3, 1>(&mut oscillator, vector![1.0], vector![0.0], &sizes, 50.0).unwrap();
    assert_eq!(work.jacobian_evaluations, 1);
    let attempts = work.steps + work.rejected;
    assert!(work.newton_iterations <= attempts + 2, "{work:?}");
}

#[test]
fn the_work_on_a_stiff_problem_is_as_it_was() {
    // A snapshot: Robertson's problem is pure arithmetic, so the counts are the same everywhere.
    let infinite = SVector::repeat(f64::INFINITY);
    let sizes = Tolerances::new(1e-6, infinite, SVector::repeat(1e-12)).unwrap();
    let (q, v) = (vector![0.0, 0.0, 0.0], vector![1.0, 0.0, 0.0]);
    let (_, work) = run::<3, 3>(&mut FirstOrder(Rober), q, v, &sizes, 1e11).unwrap();
    let counts = [
        work.steps,
        work.rejected,
        work.newton_failures,
        work.residual_evaluations,
        work.jacobian_evaluations,
        work.factorizations,
        work.newton_iterations,
    ];
    assert_eq!(counts, [304, 4, 0, 1909, 230, 258, 636], "{work:?}");
    assert_eq!(work.residual_evaluations, 3 * work.newton_iterations + 1);
}

/// No coordinates are free: only time passes.
struct Nothing;

impl System<Const<0>> for Nothing {
    fn residual(
        &mut self,
        _t: f64,
        _q: &SVector<f64, 0>,
        _v: &SVector<f64, 0>,
        _a: &SVector<f64, 0>,
        _r: &mut SVector<f64, 0>,
    ) {
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _q: &SVector<f64, 0>,
        _v: &SVector<f64, 0>,
        _a: &SVector<f64, 0>,
        _m: &mut SMatrix<f64, 0, 0>,
        _c: &mut SMatrix<f64, 0, 0>,
        _k: &mut SMatrix<f64, 0, 0>,
    ) {
    }
}

#[test]
fn without_free_coordinates_a_step_reaches_the_limit() {
    let zero = SVector::<f64, 0>::zeros();
    let mut radau = start::<3, 0>(&mut Nothing, zero, zero, &tolerances(1e-6, 1.0, 1.0));
    let report = radau.step(&mut Nothing, 1e6, f64::INFINITY).unwrap();
    assert_eq!((report.t_end, radau.state().t), (1e6, 1e6));
    let report = radau.step(&mut Nothing, 2e6, f64::INFINITY).unwrap();
    assert_eq!(report.t_end, 2e6);
    radau.step_exactly(&mut Nothing, 0.5).unwrap();
    assert_eq!(radau.state().t, 1e6 + 0.5);
}
