//! What the event engine relies on in the dense output.

use crate::problems::{DoublePendulum, Oscillator, SlidingBlock};
use crate::{start, tolerances};
use dalembert::integrate::{Motion, ORDERS, System};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector, vector};

/// A block that lifts off: the tilting moment t passes zero at t = 0, a = t + 5 sin θ.
struct LiftOff;

impl System<Const<1>> for LiftOff {
    fn residual(
        &mut self,
        t: f64,
        q: &SVector<f64, 1>,
        _v: &SVector<f64, 1>,
        a: &SVector<f64, 1>,
        r: &mut SVector<f64, 1>,
    ) {
        r[0] = a[0] - t - 5.0 * q[0].sin();
    }
    fn jacobian(
        &mut self,
        _t: f64,
        q: &SVector<f64, 1>,
        _v: &SVector<f64, 1>,
        _a: &SVector<f64, 1>,
        m: &mut SMatrix<f64, 1, 1>,
        c: &mut SMatrix<f64, 1, 1>,
        k: &mut SMatrix<f64, 1, 1>,
    ) {
        m[0] = 1.0;
        c[0] = 0.0;
        k[0] = -5.0 * q[0].cos();
    }
}

#[test]
fn a_triple_zero_at_the_start_grows_with_the_right_sign() {
    let zero = vector![0.0];
    let mut radau = start::<3, 1>(&mut LiftOff, zero, zero, &tolerances(1e-6, 0.01, 0.1));
    let h = radau.step(&mut LiftOff, 1.0, f64::INFINITY).unwrap().h;
    let dense = radau.dense().unwrap();
    for power in 0..3 {
        assert_eq!(dense.coefficient(0, power), 0.0, "power {power}");
    }
    for part in [1e-100, 1e-30, 1e-9, 1e-3, 0.1] {
        let tau = part * h;
        let (q, v, a) = dense.at_offset(tau);
        // The leading coefficient carries the error of the interpolant, of order h^6.
        assert!(
            (q[0] / (tau * tau * tau / 6.0) - 1.0).abs() < 1e-3,
            "{part} {q}"
        );
        assert!(v[0] > 0.0 && a[0] > 0.0, "{part}");
    }
}

#[test]
fn dense_output_joins_the_states_at_both_ends() {
    let mut pendulum = DoublePendulum { g: 9.81 };
    let (q, v) = (vector![1.0, 2.0], vector![0.5, -0.5]);
    let mut radau = start::<3, 2>(&mut pendulum, q, v, &tolerances(1e-8, 1.0, 1.0));
    for _ in 0..20 {
        radau.step(&mut pendulum, 10.0, f64::INFINITY).unwrap();
        let (dense, first, last) = (radau.dense().unwrap(), radau.start(), radau.state());
        assert_eq!(
            dense.at(first.t),
            (first.q, first.v, first.a),
            "exactly at the start"
        );
        let (q, v, a) = dense.at(last.t);
        // Rounding of t resolves 1e-13 of a step.
        assert!((q - last.q).amax() < 1e-14 && (v - last.v).amax() < 1e-13);
        assert!((a - last.a).amax() < 1e-11);
    }
}

#[test]
fn coefficients_are_those_of_the_polynomial() {
    let mut pendulum = DoublePendulum { g: 9.81 };
    let (q, v) = (vector![1.0, 2.0], vector![0.5, -0.5]);
    let mut radau = start::<5, 2>(&mut pendulum, q, v, &tolerances(1e-8, 1.0, 1.0));
    radau.step(&mut pendulum, 10.0, f64::INFINITY).unwrap();
    let dense = radau.dense().unwrap();
    let s: f64 = 0.7;
    let mut sum = SVector::<f64, 2>::zeros();
    for power in 0..=7 {
        let coefficients = SVector::from_fn(|i, _| dense.coefficient(i, power));
        sum += coefficients * s.powi(power as i32);
    }
    assert!((sum - dense.at_offset(s * dense.length()).0).amax() < 1e-15);
}

#[test]
fn clipping_keeps_the_polynomial() {
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.0,
        linear: true,
    };
    let (one, zero) = (vector![1.0], vector![0.0]);
    let mut radau = start::<3, 1>(&mut oscillator, one, zero, &tolerances(1e-8, 1.0, 1.0));
    radau.step(&mut oscillator, 10.0, f64::INFINITY).unwrap();
    let mut clipped = radau.dense().unwrap().clone();
    let middle = 0.5 * clipped.end();
    clipped.clip(middle);
    assert_eq!(clipped.end(), middle);
    assert_eq!(clipped.length(), radau.dense().unwrap().length());
    assert_eq!(clipped.at(middle), radau.dense().unwrap().at(middle));
}

#[test]
#[should_panic(expected = "can only shrink")]
fn a_window_cannot_grow() {
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.0,
        linear: true,
    };
    let (one, zero) = (vector![1.0], vector![0.0]);
    let mut radau = start::<3, 1>(&mut oscillator, one, zero, &tolerances(1e-8, 1.0, 1.0));
    radau.step(&mut oscillator, 10.0, f64::INFINITY).unwrap();
    let mut dense = radau.dense().unwrap().clone();
    let end = dense.end();
    dense.clip(2.0 * end);
}

#[test]
fn an_unresolved_transient_does_not_bend_the_dense_output() {
    // k = 1e12, overdamped: the spring takes up its load of 2.943e-13 m within a microsecond. At
    // this tolerance no step resolves that; its start has the acceleration of the free fall.
    let damping = 2.0 * 1.5 * (1e12_f64 * 0.1).sqrt();
    let mut block = SlidingBlock {
        k: 1e12,
        c: damping,
    };
    let (q, v) = (vector![0.0, 0.0], vector![2.0, 0.0]);
    let mut radau = start::<3, 2>(&mut block, q, v, &tolerances(1e-6, 1.0, 1.0));
    radau.suggest(0.01);
    radau.step(&mut block, 0.5, f64::INFINITY).unwrap();
    let dense = radau.dense().unwrap();
    for part in 1..20 {
        let tau = dense.length() * f64::from(part) / 20.0;
        let (_, v, _) = dense.at_offset(tau);
        assert!(
            (v[0] - (2.0 - 2.943 * tau)).abs() < 1e-6,
            "block at {part}: {v}"
        );
        assert!(v[1].abs() < 1e-6, "spring at {part}: {v}");
    }
}

#[test]
fn the_polynomials_of_coordinates_and_rates_are_the_motion() {
    let mut pendulum = DoublePendulum { g: 9.81 };
    let (q, v) = (vector![1.0, 2.0], vector![0.5, -0.5]);
    let mut radau = start::<3, 2>(&mut pendulum, q, v, &tolerances(1e-8, 1.0, 1.0));
    radau.step(&mut pendulum, 10.0, f64::INFINITY).unwrap();
    let dense = radau.dense().unwrap();
    for (index, rate) in [(0, false), (1, false), (0, true), (1, true)] {
        for factor in [1.0, -2.0] {
            let mut coefficients = [0.0; ORDERS];
            dense.polynomial((index, rate), factor, 0, &mut coefficients);
            let count = dense.coefficients(rate);
            assert!(coefficients[count..].iter().all(|&c| c == 0.0));
            let mut higher = [0.0; ORDERS];
            dense.polynomial((index, rate), factor, 2, &mut higher);
            assert_eq!(higher[..ORDERS - 2], coefficients[2..]);
            let first = dense.value_and_slope((index, rate), factor);
            assert_eq!(first, coefficients[..2]);
            for s in [0.0, 0.3, 1.0] {
                let sum = coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c);
                let (q, v, _) = dense.at_offset(s * dense.length());
                let exact = factor * if rate { v[index] } else { q[index] };
                assert!(
                    (sum - exact).abs() < 1e-14 * f64::abs(factor),
                    "{index} {rate} {factor} {s}: {sum} {exact}"
                );
            }
        }
    }
}
