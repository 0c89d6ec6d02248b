//! End values of published problems, recomputed to more digits than double precision holds.
//! The numbers and their sources are in `tests/data`.
//!
//! Of the IVP test set, Andrews' mechanism and the car axis are left out: they are differential-algebraic
//! of index 3, with constraints between coordinates, which a [`System`] does not have. Andrews' mechanism as a model:
//! `tests/engine/linkages.rs`.

use crate::problems::{DoublePendulum, Hires, Orego, Pleiades, Rober, VanDerPol};
use crate::{run, tolerances};
use dalembert::integrate::{
    Coefficients, FirstOrder, FirstOrderProblem, RadauIia, System, Tolerances,
};
use nalgebra::Const;
use nalgebra::{SVector, vector};
use serde_json::Value;

pub fn data(file: &str) -> Value {
    let path = format!("{}/tests/data/{file}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

pub fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

pub fn numbers<const N: usize>(value: &Value) -> SVector<f64, N> {
    SVector::from_iterator(value.as_array().unwrap().iter().map(number))
}

/// Correct digits of the worst component, relative.
fn digits<const N: usize>(actual: &SVector<f64, N>, expected: &SVector<f64, N>) -> f64 {
    let errors = (actual - expected).component_div(expected);
    -errors.amax().log10()
}

/// Digits reached at `t` with a relative tolerance, absolute tolerances `size` times it.
fn first_order<const S: usize, const N: usize>(
    problem: impl FirstOrderProblem<Const<N>>,
    start: [f64; N],
    size: f64,
    relative: f64,
    reference: &Value,
) -> f64
where
    RadauIia<S>: Coefficients<S>,
{
    let absolute = SVector::repeat(size * relative);
    let sizes = Tolerances::new(relative, SVector::repeat(f64::INFINITY), absolute).unwrap();
    let mut system = FirstOrder(problem);
    let (q, v) = (SVector::zeros(), SVector::from(start));
    let (end, _) = run::<S, N>(&mut system, q, v, &sizes, number(&reference["t"])).unwrap();
    digits(&end.v, &numbers(&reference["y"]))
}

/// The IVP test set asks for two digits less than the tolerance's; van der Pol and OREGO for three.
fn test_set<const S: usize>()
where
    RadauIia<S>: Coefficients<S>,
{
    let data = data("ivp_testset.json");
    for relative in [1e-4_f64, 1e-7, 1e-10, 1e-13] {
        let asked = -relative.log10();
        let mut hires = [0.0; 8];
        (hires[0], hires[7]) = (1.0, 0.0057);
        let reached = first_order::<S, 8>(Hires, hires, 1e-4, relative, &data["hires"]);
        assert!(
            reached >= asked - 2.0,
            "HIRES, S = {S}, {relative:e}: {reached}"
        );
        let reached = first_order::<S, 3>(Orego, [1.0, 2.0, 3.0], 1e-6, relative, &data["orego"]);
        assert!(
            reached >= asked - 3.0,
            "OREGO, S = {S}, {relative:e}: {reached}"
        );
        let reached = first_order::<S, 3>(Rober, [1.0, 0.0, 0.0], 1e-8, relative, &data["rober"]);
        assert!(
            reached >= asked - 2.0,
            "ROBER, S = {S}, {relative:e}: {reached}"
        );
        let problem = VanDerPol { epsilon: 1e-6 };
        let reached = first_order::<S, 2>(problem, [2.0, 0.0], 1e-3, relative, &data["vdpol"]);
        assert!(
            reached >= asked - 3.0,
            "van der Pol, S = {S}, {relative:e}: {reached}"
        );

        let mut problem = VanDerPol { epsilon: 1e-6 };
        let sizes = tolerances(relative, 1.0, 1.0);
        let (end, _) = run::<S, 1>(&mut problem, vector![2.0], vector![0.0], &sizes, 2.0).unwrap();
        let reached = digits(&vector![end.q[0], end.v[0]], &numbers(&data["vdpol"]["y"]));
        assert!(
            reached >= asked - 3.0,
            "van der Pol as q, S = {S}, {relative:e}: {reached}"
        );
    }
}

#[test]
fn ivp_test_set_three_stages() {
    test_set::<3>();
}

#[test]
fn ivp_test_set_five_stages() {
    test_set::<5>();
}

#[test]
fn ivp_test_set_seven_stages() {
    test_set::<7>();
}

fn pleiades<const S: usize>(relative: f64) -> f64
where
    RadauIia<S>: Coefficients<S>,
{
    let (q, v) = (SVector::from(Pleiades::Q), SVector::from(Pleiades::V));
    let (end, _) = run::<S, 14>(&mut Pleiades, q, v, &tolerances(relative, 0.1, 0.1), 3.0).unwrap();
    let reference: SVector<f64, 28> = numbers(&data("ivp_testset.json")["pleiades"]["y"]);
    let end = SVector::<f64, 28>::from_iterator(end.q.iter().chain(end.v.iter()).copied());
    digits(&end, &reference)
}

#[test]
fn pleiades_close_encounters() {
    for relative in [1e-7_f64, 1e-10] {
        let asked = -relative.log10() - 2.0;
        assert!(
            pleiades::<3>(relative) >= asked,
            "{}",
            pleiades::<3>(relative)
        );
        assert!(
            pleiades::<5>(relative) >= asked,
            "{}",
            pleiades::<5>(relative)
        );
        assert!(
            pleiades::<7>(relative) >= asked,
            "{}",
            pleiades::<7>(relative)
        );
    }
}

#[test]
fn double_pendulum_within_1e_14_times_the_amplification() {
    let data = data("double_pendulum.json");
    for name in ["regular_small", "chaotic"] {
        let case = &data[name];
        let start: SVector<f64, 4> = numbers(&case["start"]);
        for row in case["rows"].as_array().unwrap() {
            let (t, amplification) = (number(&row["t"]), number(&row["amplification"]));
            if amplification > 1e10 {
                continue; // no digits left in double precision
            }
            let (q, v) = (vector![start[0], start[1]], vector![start[2], start[3]]);
            let mut pendulum = DoublePendulum { g: 9.81 };
            let sizes = tolerances(1e-14, 0.1, 0.1);
            let (end, _) = run::<7, 2>(&mut pendulum, q, v, &sizes, t).unwrap();
            let expected: SVector<f64, 4> = numbers(&row["y"]);
            let error = (vector![end.q[0], end.q[1], end.v[0], end.v[1]] - expected).amax();
            assert!(error <= 1e-14 * amplification, "{name} at {t}: {error:e}");
        }
    }
}

#[test]
fn energy_drifts_by_less_than_1e_11_in_50_seconds() {
    let energy = |q: &SVector<f64, 2>, v: &SVector<f64, 2>| {
        v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos()
            - 9.81 * (2.0 * q[0].cos() + q[1].cos())
    };
    let (q, v) = (vector![2.0, 2.5], vector![0.0, 0.0]);
    let mut pendulum = DoublePendulum { g: 9.81 };
    let sizes = tolerances(1e-12, 1.0, 1.0);
    let (end, _) = run::<5, 2>(&mut pendulum, q, v, &sizes, 50.0).unwrap();
    let drift = energy(&end.q, &end.v) / energy(&q, &v) - 1.0;
    assert!(drift.abs() < 1e-11, "{drift:e}");
}

/// The Jacobians of the test problems against central differences, whose error is below 1e-6 of the
/// largest entry here.
fn check_jacobian<const F: usize>(system: &mut impl System<Const<F>>, seed: f64) {
    let point =
        |shift: f64| SVector::<f64, F>::from_fn(|i, _| (seed + shift + i as f64).sin() + 1.5);
    let (q, v, a) = (point(0.0), point(0.3), point(0.7));
    let zero = || nalgebra::SMatrix::<f64, F, F>::zeros();
    let (mut m, mut c, mut k) = (zero(), zero(), zero());
    system.jacobian(0.2, &q, &v, &a, &mut m, &mut c, &mut k);
    for (exact, which) in [(m, 0), (c, 1), (k, 2)] {
        for j in 0..F {
            let mut column = SVector::zeros();
            for sign in [1.0, -1.0] {
                let step = sign * 1e-5;
                let (mut q, mut v, mut a) = (q, v, a);
                [&mut a, &mut v, &mut q][which][j] += step;
                let mut r = SVector::zeros();
                system.residual(0.2, &q, &v, &a, &mut r);
                column += r / (2.0 * step);
            }
            let error = (exact.column(j) - column).amax();
            assert!(
                error <= 1e-6 * (1.0 + exact.amax()),
                "matrix {which}, column {j}: {error:e}"
            );
        }
    }
}

#[test]
fn jacobians_of_the_test_problems_are_right() {
    use crate::problems::{Kaps, ProtheroRobinson, SlidingBlock, SpringPendulum};
    check_jacobian(&mut DoublePendulum { g: 9.81 }, 0.1);
    check_jacobian(
        &mut SpringPendulum {
            k: 3.0,
            length: 1.0,
            g: 1.0,
        },
        0.2,
    );
    check_jacobian(&mut Pleiades, 0.3);
    check_jacobian(&mut VanDerPol { epsilon: 0.1 } as &mut VanDerPol, 0.4);
    check_jacobian(&mut FirstOrder(VanDerPol { epsilon: 0.1 }), 0.4);
    check_jacobian(&mut FirstOrder(Hires), 0.5);
    check_jacobian(&mut FirstOrder(Orego), 0.6);
    check_jacobian(&mut FirstOrder(Rober), 0.7);
    check_jacobian(&mut FirstOrder(Kaps { epsilon: 0.1 }), 0.8);
    check_jacobian(&mut FirstOrder(ProtheroRobinson { lambda: 3.0 }), 0.9);
    check_jacobian(&mut SlidingBlock { k: 3.0, c: 2.0 }, 1.0);
}
