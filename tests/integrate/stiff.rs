//! Stiff springs from k = 1e6 to 1e12, damped and not, order reduction, massless limits.

use crate::problems::{Kaps, ProtheroRobinson, SlidingBlock, SpringPendulum};
use crate::references::{data, number, numbers};
use crate::{run, start, tolerances};
use dalembert::integrate::{Coefficients, FirstOrder, Radau, RadauIia, State, System, Tolerances};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector, vector};

fn first_order<const F: usize>(relative: f64) -> Tolerances<Const<F>> {
    Tolerances::new(
        relative,
        SVector::repeat(f64::INFINITY),
        SVector::repeat(relative),
    )
    .unwrap()
}

#[test]
fn kaps_for_every_stiffness() {
    let expected: SVector<f64, 2> = numbers(&data("stiff_block.json")["kaps_at_1"]);
    for epsilon in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        for relative in [1e-4, 1e-7, 1e-10, 1e-13] {
            let mut kaps = FirstOrder(Kaps { epsilon });
            let (q, v) = (vector![0.0, 0.0], vector![1.0, 1.0]);
            let (end, _) = run::<3, 2>(&mut kaps, q, v, &first_order(relative), 1.0).unwrap();
            let error = (end.v - expected).amax();
            assert!(
                error < 10.0 * relative,
                "{epsilon:e} {relative:e}: {error:e}"
            );
        }
    }
}

#[test]
fn prothero_robinson_for_every_stiffness() {
    let expected = number(&data("stiff_block.json")["prothero_robinson_at_10"]);
    for lambda in [1e6, 1e8, 1e10, 1e12] {
        for relative in [1e-4, 1e-7, 1e-10, 1e-13] {
            let mut problem = FirstOrder(ProtheroRobinson { lambda });
            let (q, v) = (vector![0.0], vector![1.0]);
            let (end, _) = run::<3, 1>(&mut problem, q, v, &first_order(relative), 10.0).unwrap();
            let error = (end.v[0] - expected).abs();
            assert!(
                error < 10.0 * relative,
                "{lambda:e} {relative:e}: {error:e}"
            );
        }
    }
}

#[test]
fn spring_pendulum_from_rest() {
    let data = data("stiff_block.json");
    for row in data["spring_pendulum"].as_array().unwrap() {
        let expected: SVector<f64, 4> = numbers(&row["y"]);
        for (relative, error_allowed) in [(1e-6, 1e-5), (1e-9, 1e-7), (1e-13, 1e-9)] {
            let mut pendulum = SpringPendulum {
                k: 1e6,
                length: 1.0,
                g: 1.0,
            };
            let (q, v) = (vector![1.0, 0.0], vector![0.0, 0.0]);
            let sizes = tolerances(relative, 1.0, 1.0);
            let (end, _) = run::<7, 2>(&mut pendulum, q, v, &sizes, number(&row["t"])).unwrap();
            let error = (vector![end.q[0], end.q[1], end.v[0], end.v[1]] - expected).amax();
            assert!(error < error_allowed, "{relative:e}: {error:e}");
        }
    }
}

/// Steps until the first velocity falls to zero; then takes the last step again up to that instant.
fn stop<const S: usize>(
    system: &mut impl System<Const<2>>,
    radau: &mut Radau<S, Const<2>>,
) -> State<Const<2>>
where
    RadauIia<S>: Coefficients<S>,
{
    while radau.state().v[0] > 0.0 {
        radau.step(system, 10.0, f64::INFINITY).unwrap();
    }
    let dense = radau.dense().unwrap().clone();
    let (mut low, mut high) = (0.0, dense.length());
    while 0.5 * (low + high) > low && 0.5 * (low + high) < high {
        let middle = 0.5 * (low + high);
        if dense.at_offset(middle).1[0] > 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    let mut tau = high;
    for _ in 0..5 {
        radau.step_exactly(system, tau).unwrap();
        tau -= radau.state().v[0] / radau.state().a[0];
    }
    *radau.state()
}

/// The small mass on its spring after the block has stuck.
struct Spring {
    k: f64,
    c: f64,
}

impl System<Const<1>> for Spring {
    fn residual(
        &mut self,
        _t: f64,
        q: &SVector<f64, 1>,
        v: &SVector<f64, 1>,
        a: &SVector<f64, 1>,
        r: &mut SVector<f64, 1>,
    ) {
        r[0] = 0.1 * a[0] + self.c * v[0] + self.k * q[0];
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _q: &SVector<f64, 1>,
        _v: &SVector<f64, 1>,
        _a: &SVector<f64, 1>,
        m: &mut SMatrix<f64, 1, 1>,
        c: &mut SMatrix<f64, 1, 1>,
        k: &mut SMatrix<f64, 1, 1>,
    ) {
        (m[0], c[0], k[0]) = (0.1, self.c, self.k);
    }
    fn is_linear(&self) -> bool {
        true
    }
}

#[test]
fn a_block_with_a_stiff_spring_stops_at_the_right_time_for_every_stiffness() {
    for row in data("stiff_block.json")["block"].as_array().unwrap() {
        let (k, c) = (number(&row["k"]), number(&row["c"]));
        let mut block = SlidingBlock { k, c };
        // The load of the spring and the velocity of its vibration are the sizes that matter.
        let (load, relative) = (0.3 * 9.81 * 0.1 / k, 1e-13);
        let velocity = load * (k / 0.1_f64).sqrt();
        let sizes = Tolerances::new(
            relative,
            vector![relative, relative * load],
            vector![relative, relative * velocity],
        );
        let (q, v) = (vector![0.0, 0.0], vector![2.0, 0.0]);
        let mut radau = start::<7, 2>(&mut block, q, v, &sizes.unwrap());
        let state = stop(&mut block, &mut radau);
        let name = format!("k = {k:e}, c = {c:e}");
        let error = (state.t - number(&row["t_stop"])).abs();
        assert!(error < 1e-11, "{name}: t {error:e}");
        let error = (state.q[0] - number(&row["x_stop"])).abs();
        assert!(error < 1e-12, "{name}: x {error:e}");
        let allowed = |reference: f64| {
            if k < 1e7 {
                1e-6 * reference.abs()
            } else {
                1e-15
            }
        };
        let expected = number(&row["r_stop"]);
        let error = (state.q[1] - expected).abs();
        assert!(error < allowed(expected), "{name}: r {error:e}");

        let mut spring = Spring { k, c };
        let sizes = Tolerances::new(
            relative,
            vector![relative * load],
            vector![relative * velocity],
        );
        let (q, v) = (vector![state.q[1]], vector![state.v[1]]);
        let mut radau = start::<7, 1>(&mut spring, q, v, &sizes.unwrap());
        let remaining = 1.0 - state.t;
        while radau.state().t < remaining {
            radau.step(&mut spring, remaining, f64::INFINITY).unwrap();
        }
        let expected = number(&row["r_at_1"]);
        let error = (radau.state().q[0] - expected).abs();
        assert!(
            error < allowed(expected).max(1e-6 * load),
            "{name}: r(1) {error:e}"
        );
    }
}

/// A block of mass 1 and, at the end of a spring, no mass at all: a force sin t pulls there.
/// Coordinates: block, spring extension r, which is algebraic.
struct Massless {
    k: f64,
    cubic: f64,
}

impl System<Const<2>> for Massless {
    fn residual(
        &mut self,
        t: f64,
        q: &SVector<f64, 2>,
        _v: &SVector<f64, 2>,
        a: &SVector<f64, 2>,
        r: &mut SVector<f64, 2>,
    ) {
        let spring = self.k * q[1] + self.cubic * q[1].powi(3);
        r[0] = a[0] - spring;
        r[1] = spring - t.sin();
    }
    fn jacobian(
        &mut self,
        _t: f64,
        q: &SVector<f64, 2>,
        _v: &SVector<f64, 2>,
        _a: &SVector<f64, 2>,
        m: &mut SMatrix<f64, 2, 2>,
        c: &mut SMatrix<f64, 2, 2>,
        k: &mut SMatrix<f64, 2, 2>,
    ) {
        let slope = self.k + 3.0 * self.cubic * q[1] * q[1];
        *m = SMatrix::from_row_slice(&[1.0, 0.0, 0.0, 0.0]);
        *c = SMatrix::zeros();
        *k = SMatrix::from_row_slice(&[0.0, -slope, 0.0, slope]);
    }
}

#[test]
fn a_massless_part_follows_its_algebraic_equation() {
    let data = data("stiff_block.json");
    let massless = &data["massless"];
    let run = |system: &mut Massless, t_end: f64| {
        let size = 1.0 / system.k;
        // The velocity of an algebraic coordinate is as accurate as a difference quotient of it.
        let q_absolute = vector![1e-12, 1e-12 * size];
        let sizes = Tolerances::new(1e-12, q_absolute, vector![1e-12, size]);
        let mut radau = Radau::<5, Const<2>>::new(&sizes.unwrap());
        radau.restart(
            0.0,
            &vector![0.0, 0.0],
            &vector![0.0, size],
            &vector![0.0, 0.0],
        );
        while radau.state().t < t_end {
            radau.step(system, t_end, f64::INFINITY).unwrap();
        }
        radau.state().q
    };
    let q = run(&mut Massless { k: 1e6, cubic: 0.0 }, 10.0);
    assert!((q[0] - number(&massless["x1_at_10"])).abs() < 1e-10, "{q}");
    assert!(
        (q[1] / number(&massless["r_at_10_k_1e6"]) - 1.0).abs() < 1e-12,
        "{q}"
    );
    let q = run(
        &mut Massless {
            k: 10.0,
            cubic: 1000.0,
        },
        1.0,
    );
    assert!(
        (q[1] / number(&massless["nonlinear_r_at_1"]) - 1.0).abs() < 1e-12,
        "{q}"
    );
}
