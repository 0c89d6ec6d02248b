//! Independence of units, sides and useless coordinates, to the last bit.

use crate::problems::{DoublePendulum, Oscillator, SpringPendulum};
use crate::{start, tolerances};
use dalembert::integrate::Tolerances;
use nalgebra::{SVector, vector};

#[test]
fn units_scaled_by_powers_of_two_change_no_bit() {
    // Lengths in units of 2⁻¹⁰ m: q, rest length and g grow by 2¹⁰, and so do the tolerances.
    let unit = 1024.0;
    let mut metres = SpringPendulum {
        k: 1e4,
        length: 1.0,
        g: 1.0,
    };
    let mut small = SpringPendulum {
        k: 1e4,
        length: unit,
        g: unit,
    };
    let (q, v) = (vector![1.0, 0.0], vector![0.0, 0.1]);
    let mut a = start::<3, 2>(&mut metres, q, v, &tolerances(1e-8, 1.0, 1.0));
    let mut b = start::<3, 2>(
        &mut small,
        q * unit,
        v * unit,
        &tolerances(1e-8, unit, unit),
    );
    for _ in 0..300 {
        a.step(&mut metres, 100.0, f64::INFINITY).unwrap();
        b.step(&mut small, 100.0, f64::INFINITY).unwrap();
        assert_eq!(a.state().t, b.state().t);
        assert_eq!(a.state().q * unit, b.state().q);
        assert_eq!(a.state().v * unit, b.state().v);
    }
    assert_eq!(a.counters(), b.counters());
}

#[test]
fn time_scaled_by_powers_of_two_changes_no_bit() {
    let (mut slow, mut fast) = (
        Oscillator {
            omega: 1.0,
            zeta: 0.1,
            linear: false,
        },
        Oscillator {
            omega: 16.0,
            zeta: 0.1,
            linear: false,
        },
    );
    let (one, zero) = (vector![1.0], vector![0.0]);
    let mut a = start::<5, 1>(&mut slow, one, zero, &tolerances(1e-8, 1.0, 1.0));
    let mut b = start::<5, 1>(&mut fast, one, zero, &tolerances(1e-8, 1.0, 16.0));
    while a.state().t < 100.0 {
        a.step(&mut slow, 100.0, f64::INFINITY).unwrap();
        b.step(&mut fast, 6.25, f64::INFINITY).unwrap();
        assert_eq!(a.state().t, b.state().t * 16.0);
        assert_eq!(
            (a.state().q, a.state().v * 16.0),
            (b.state().q, b.state().v)
        );
    }
}

#[test]
fn a_mirrored_start_gives_the_mirrored_motion() {
    let mut pendulum = DoublePendulum { g: 9.81 };
    let (q, v) = (vector![1.0, 2.0], vector![0.5, 0.0]);
    let mut right = start::<3, 2>(&mut pendulum, q, v, &tolerances(1e-8, 1.0, 1.0));
    let mut left = start::<3, 2>(&mut pendulum, -q, -v, &tolerances(1e-8, 1.0, 1.0));
    for _ in 0..300 {
        right.step(&mut pendulum, 100.0, f64::INFINITY).unwrap();
        left.step(&mut pendulum, 100.0, f64::INFINITY).unwrap();
        assert_eq!(
            (right.state().q, right.state().v),
            (-left.state().q, -left.state().v)
        );
    }
}

#[test]
fn a_coordinate_at_rest_changes_no_step() {
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.0,
        linear: false,
    };
    let mut one = start::<3, 1>(
        &mut oscillator,
        vector![1.0],
        vector![0.0],
        &tolerances(1e-6, 1.0, 1.0),
    );
    let mut three = start::<3, 3>(
        &mut oscillator,
        vector![0.0, 1.0, 0.0],
        SVector::zeros(),
        &tolerances(1e-6, 1.0, 1.0),
    );
    for _ in 0..100 {
        one.step(&mut oscillator, 100.0, f64::INFINITY).unwrap();
        three.step(&mut oscillator, 100.0, f64::INFINITY).unwrap();
        assert_eq!(one.state().t, three.state().t);
        assert_eq!(one.state().q[0], three.state().q[1]);
    }
}

#[test]
fn motions_of_very_different_size_keep_their_relative_accuracy() {
    // 1e-12 of the size of the other, with tolerances to match.
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.0,
        linear: false,
    };
    let sizes = Tolerances::new(1e-9, vector![1e-9, 1e-21], vector![1e-9, 1e-21]).unwrap();
    let mut radau = start::<5, 2>(
        &mut oscillator,
        vector![1.0, 0.0],
        vector![0.0, 1e-12],
        &sizes,
    );
    while radau.state().t < 20.0 {
        radau.step(&mut oscillator, 20.0, f64::INFINITY).unwrap();
    }
    let q = radau.state().q;
    assert!((q[0] - 20f64.cos()).abs() < 1e-8, "{q}");
    assert!((q[1] / 1e-12 - 20f64.sin()).abs() < 1e-8, "{q}");
}
