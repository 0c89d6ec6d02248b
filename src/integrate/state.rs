//! Points of the motion, and what every one-step method does with them.

use crate::numerics::{Size, Vector, persist};

/// A point of the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct State<F: Size> {
    /// Coordinates.
    pub q: F::Vector,
    /// Velocities.
    pub v: F::Vector,
    /// Accelerations.
    pub a: F::Vector,
    /// Time, s.
    pub t: f64,
}

persist!([F: Size] State<F> { q, v, a, t });

impl<F: Size> Copy for State<F> where F::Vector: Copy {}

impl<F: Size> State<F> {
    /// At rest at zero.
    pub(crate) fn origin(size: F) -> Self {
        State {
            q: size.zeros(),
            v: size.zeros(),
            a: size.zeros(),
            t: 0.0,
        }
    }

    /// Number of coordinates.
    #[inline(always)]
    pub(crate) fn size(&self) -> F {
        self.q.size()
    }

    /// Name of the part that is not finite, if any.
    #[inline]
    pub(crate) fn not_finite(&self) -> Option<&'static str> {
        let finite = |x: &F::Vector| x.as_slice().iter().all(|x| x.is_finite());
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
#[derive(Debug, Clone, PartialEq)]
pub struct Node<F: Size> {
    /// Weight, s.
    pub weight: f64,
    /// Motion there.
    pub state: State<F>,
}

/// Sums that are carried on to the next step because they were lost in rounding t, q and v.
#[derive(Debug, Clone)]
pub(super) struct Lost<F: Size> {
    pub t: f64,
    pub q: F::Vector,
    pub v: F::Vector,
}

persist!([F: Size] Lost<F> { t, q, v });

impl<F: Size> Lost<F> {
    pub fn nothing(size: F) -> Self {
        Lost {
            t: 0.0,
            q: size.zeros(),
            v: size.zeros(),
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
