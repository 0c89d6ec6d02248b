//! Response spectra, exact for accelerations that are linear between samples and zero outside.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::Samples;
use super::oscillator::Oscillator;

/// An ordinate of the spectrum of pseudo-acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ordinate {
    /// ω² times the largest displacement at a sample, m/s².
    pub samples: f64,
    /// ω² times the largest displacement at any time, also after the record, m/s².
    pub peak: f64,
}

/// The ordinate for a period (s) > 0 and a damping ratio of at least 0 and below 1.
///
/// # Panics
/// For another damping or period.
pub fn ordinate(samples: &Samples, period: f64, damping: f64) -> Ordinate {
    assert!(
        period > 0.0 && (0.0..1.0).contains(&damping),
        "an oscillator that oscillates"
    );
    let omega = TAU / period;
    let oscillator = Oscillator {
        omega,
        zeta: damping,
    };
    let a = &samples.values;
    let mut state = [0.0; 2];
    let (mut at_samples, mut largest) = (0.0_f64, 0.0_f64);
    let mut known = (f64::NAN, oscillator.responses(0.0));
    for i in 0..a.len() - 1 {
        let h = samples.step(i);
        if known.0 != h {
            known = (h, oscillator.responses(h));
        }
        let (force, slope) = (-a[i], -(a[i + 1] - a[i]) / h);
        let next = known.1.after(state, force, slope);
        at_samples = at_samples.max(next[0].abs());
        largest = largest.max(next[0].abs());
        between(&oscillator, state, force, slope, h, &mut largest);
        state = next;
    }
    // Left alone, each swing is smaller than the one before: two quarters of a turn hold the largest.
    between(&oscillator, state, 0.0, 0.0, period, &mut largest);
    let square = omega * omega;
    Ordinate {
        samples: square * at_samples,
        peak: square * largest,
    }
}

/// Raises `largest` to the largest displacement within a time h under a linear force.
fn between(
    oscillator: &Oscillator,
    state: [f64; 2],
    force: f64,
    slope: f64,
    h: f64,
    largest: &mut f64,
) {
    let Oscillator { omega, zeta } = *oscillator;
    // The acceleration w obeys w″ + 2ζω w′ + ω² w = 0: it is a decaying cosine.
    let w = oscillator.acceleration(state, force);
    let w_rate = slope - 2.0 * zeta * omega * w - omega * omega * state[1];
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let sine = (w_rate + zeta * omega * w) / damped;
    // No displacement within the step is beyond this.
    let bound = state[0].abs() + h * (state[1].abs() + 0.5 * h * w.hypot(sine));
    if bound <= *largest {
        return;
    }
    let velocity = |t: f64| oscillator.responses(t).after(state, force, slope)[1];
    // Between zeros of the acceleration the velocity has one zero at most.
    let mut zero = (sine.atan2(w) + FRAC_PI_2).rem_euclid(PI);
    let (mut from, mut v_from) = (0.0, state[1]);
    while from < h {
        let to = h.min(zero / damped);
        let v_to = velocity(to);
        if v_from * v_to < 0.0 {
            let t = root(velocity, (from, v_from), (to, v_to));
            let [u, _] = oscillator.responses(t).after(state, force, slope);
            *largest = largest.max(u.abs());
        }
        (from, v_from) = (to, v_to);
        zero += PI;
    }
}

/// Where a monotone function is zero between two points of different sign: the displacement is flat
/// there, so that half of the digits are enough; all that bisection finds are taken.
fn root(f: impl Fn(f64) -> f64, (mut a, fa): (f64, f64), (mut b, _): (f64, f64)) -> f64 {
    loop {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            return middle;
        }
        let value = f(middle);
        if value == 0.0 {
            return middle;
        }
        if (value > 0.0) == (fa > 0.0) {
            a = middle;
        } else {
            b = middle;
        }
    }
}
