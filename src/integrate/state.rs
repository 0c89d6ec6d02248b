//! Points of the motion, and what every one-step method does with them.

use crate::numerics::persist;
use nalgebra::SVector;

/// A point of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<const F: usize> {
    /// Coordinates.
    pub q: SVector<f64, F>,
    /// Velocities.
    pub v: SVector<f64, F>,
    /// Accelerations.
    pub a: SVector<f64, F>,
    /// Time, s.
    pub t: f64,
}

persist!([const F: usize] State<F> { q, v, a, t });

impl<const F: usize> State<F> {
    /// At rest at zero.
    pub(crate) fn origin() -> Self {
        let zero = SVector::zeros();
        State {
            q: zero,
            v: zero,
            a: zero,
            t: 0.0,
        }
    }

    /// Name of the part that is not finite, if any.
    #[inline]
    pub(crate) fn not_finite(&self) -> Option<&'static str> {
        let finite = |x: &SVector<f64, F>| x.iter().all(|x| x.is_finite());
        match self {
            state if !state.t.is_finite() => Some("time"),
            state if !finite(&state.q) => Some("a coordinate"),
            state if !finite(&state.v) => Some("a velocity"),
            state if !finite(&state.a) => Some("an acceleration"),
            _ => None,
        }
    }
}

/// A point at which an integral over the last step is sampled: Σ weight · f(state) is ∫ f dt over the
/// step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node<const F: usize> {
    /// Weight, s.
    pub weight: f64,
    /// Motion there.
    pub state: State<F>,
}

/// Sums that are carried on to the next step because they were lost in rounding t, q and v.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lost<const F: usize> {
    pub t: f64,
    pub q: SVector<f64, F>,
    pub v: SVector<f64, F>,
}

persist!([const F: usize] Lost<F> { t, q, v });

impl<const F: usize> Lost<F> {
    pub fn nothing() -> Self {
        Lost {
            t: 0.0,
            q: SVector::zeros(),
            v: SVector::zeros(),
        }
    }
}

/// The sum x + (change + lost), rounded, and what rounding lost (Knuth's two-sum).
#[inline(always)]
pub(super) fn add(x: f64, change: f64, lost: f64) -> (f64, f64) {
    let change = change + lost;
    let sum = x + change;
    let virtual_change = sum - x;
    (
        sum,
        (x - (sum - virtual_change)) + (change - virtual_change),
    )
}

/// The length closest to `h` that neither exceeds `h_max` nor leaves a rest of `remaining` shorter
/// than itself.
#[inline]
pub(super) fn fit(h: f64, remaining: f64, h_max: f64) -> f64 {
    let h = h.min(h_max);
    if h >= remaining {
        remaining
    } else if 2.0 * h > remaining {
        0.5 * remaining
    } else {
        h
    }
}
