//! First falls of polynomials of several trajectories side by side: the common case, fast.
//!
//! As in `first_fall`: no root where no Bernstein coefficient is negative, and one where they change
//! their sign once. A lane in which it is neither is left to [`super::Polynomial`].

use crate::integrate::{Lanes, ORDERS};

/// What is known of a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::hybrid) enum Fall {
    /// No fall on the window.
    None,
    /// The only fall, at a place that is a root to rounding.
    At(f64),
    /// The Bernstein coefficients do not tell.
    Unclear,
}

/// Steps to a root: the third order needs three from half a window away, and this is for
/// near-tangent falls.
const MOST_ITERATIONS: usize = 8;

/// A relative step after which the iteration has ended, since it leaves the cube of its last step: the
/// cube root of the unit roundoff.
const LAST_STEP: f64 = 4.8e-6;

/// 1/(n over k), by row n.
const INVERSE_BINOMIALS: [[f64; ORDERS]; ORDERS] = {
    let mut table = [[0.0; ORDERS]; ORDERS];
    let mut n = 0;
    while n < ORDERS {
        let mut k = 0;
        let mut binomial = 1.0;
        while k <= n {
            table[n][k] = 1.0 / binomial;
            binomial = binomial * (n - k) as f64 / (k + 1) as f64;
            k += 1;
        }
        n += 1;
    }
    table
};

/// The first fall of each polynomial Σ c_k sᵏ on 0 < s ≤ 1; c_0 ≥ 0. Of those that start at zero the
/// factor s is divided out, and they must rise.
#[inline(always)]
pub(in crate::hybrid) fn first_falls<const W: usize>(
    coefficients: &[Lanes<W>],
    starts_at_zero: &[bool; W],
) -> [Fall; W] {
    let n = coefficients.len();
    let zero = Lanes::of(0.0);
    let mut c = [zero; ORDERS];
    for k in 0..n {
        let next = if k + 1 < n { coefficients[k + 1] } else { zero };
        c[k] = Lanes::from_fn(|i| match starts_at_zero[i] {
            true => next.0[i],
            false => coefficients[k].0[i],
        });
    }
    let c = &c[..n];
    // A lane whose negative terms cannot outweigh the first has no fall.
    let (mut size, mut least) = (c[0].abs(), c[0]);
    for term in &c[1..] {
        size = size + term.abs();
        least = least + term.map(|x| if x < 0.0 { x } else { 0.0 });
    }
    // Each Bernstein coefficient is a sum of n terms, none larger than its power's.
    let margin = size * (n as f64 * f64::EPSILON);
    let clear = (0..W).all(|i| least.0[i] > margin.0[i]);
    if clear {
        return [Fall::None; W];
    }
    let degree = n - 1;
    let mut b = [zero; ORDERS];
    for k in 0..n {
        b[k] = c[k] * INVERSE_BINOMIALS[degree][k];
    }
    for first in 1..n {
        for k in (first..n).rev() {
            b[k] = b[k] + b[k - 1];
        }
    }
    let b = &b[..n];
    // Where the coefficients are certainly positive from the first on, and negative to the last.
    let (mut positive, mut negative) = (zero, zero);
    let (mut leading, mut place) = (Lanes::of(1.0), zero);
    for k in 0..n {
        leading = Lanes::from_fn(|i| {
            let still = leading.0[i] != 0.0 && b[k].0[i] > margin.0[i];
            if still { 1.0 } else { 0.0 }
        });
        positive = positive + leading;
        negative = negative + Lanes::from_fn(|i| if b[k].0[i] < -margin.0[i] { 1.0 } else { 0.0 });
        if k > 0 {
            // Where the polygon of the coefficients falls through zero.
            place = Lanes::from_fn(|i| {
                let (before, after) = (b[k - 1].0[i], b[k].0[i]);
                match before > 0.0 && after <= 0.0 {
                    true => ((k - 1) as f64 + before / (before - after)) / degree as f64,
                    false => place.0[i],
                }
            });
        }
    }
    let all = n as f64;
    let falls: [bool; W] = std::array::from_fn(|i| {
        positive.0[i] > 0.0 && positive.0[i] + negative.0[i] == all && negative.0[i] > 0.0
    });
    let mut found: [Fall; W] = std::array::from_fn(|i| match positive.0[i] == all {
        true => Fall::None,
        false => Fall::Unclear,
    });
    if !falls.contains(&true) {
        return found;
    }
    let mut s = place;
    let mut moving: Lanes<W> = Lanes::from_fn(|i| if falls[i] { 1.0 } else { 0.0 });
    for _ in 0..MOST_ITERATIONS {
        let (mut value, mut slope, mut half_curvature) = (zero, zero, zero);
        for term in c.iter().rev() {
            half_curvature = half_curvature * s + slope;
            slope = slope * s + value;
            value = value * s + *term;
        }
        s = Lanes::from_fn(|i| {
            let (value, slope) = (value.0[i], slope.0[i]);
            let discriminant = slope * slope - 4.0 * half_curvature.0[i] * value;
            // The root of the parabola at s that a falling piece leads to, or Newton's.
            let step = match discriminant > 0.0 && slope < 0.0 {
                true => 2.0 * value / (discriminant.sqrt() - slope),
                false => -value / slope,
            };
            let next = s.0[i] + step;
            if moving.0[i] != 0.0 {
                moving.0[i] = if step.abs() > LAST_STEP * next {
                    1.0
                } else {
                    0.0
                };
                next
            } else {
                s.0[i]
            }
        });
        if moving.0.iter().all(|&m| m == 0.0) {
            break;
        }
    }
    for i in 0..W {
        // A step that left the window, or has not ended, is no root.
        if falls[i] && moving.0[i] == 0.0 && s.0[i] > 0.0 && s.0[i] <= 1.0 {
            found[i] = Fall::At(s.0[i]);
        }
    }
    found
}
