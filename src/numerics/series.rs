//! The motion as a power series in time.

use super::persist::persist;
use nalgebra::SVector;

/// Most coefficients of a series, the one of order 0 included. Order 34 serves the smallest relative
/// tolerance (`src/integrate/taylor/length.rs`); accelerations have one order less than velocities, coordinates one more.
pub const ORDERS: usize = 36;

/// What the equations tell about the Taylor series of their motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeriesKind {
    /// It ends: the accelerations are constant, and guards are polynomials of the same degree.
    Ends,
    /// The equations are linear, the motion is a sum of exponentials: it converges everywhere.
    Entire,
    /// An order takes so many convolutions, one or more.
    Convolved(usize),
}

/// Taylor coefficients of the motion about some time: x(t + τ) = Σ x_k τᵏ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Series<const F: usize> {
    /// Of the coordinates.
    pub q: [SVector<f64, F>; ORDERS],
    /// Of the velocities.
    pub v: [SVector<f64, F>; ORDERS],
    /// Of the accelerations.
    pub a: [SVector<f64, F>; ORDERS],
}

persist!([const F: usize] Series<F> { q, v, a });

impl<const F: usize> Series<F> {
    /// All coefficients zero.
    pub fn zero() -> Self {
        let zero = [SVector::zeros(); ORDERS];
        Series {
            q: zero,
            v: zero,
            a: zero,
        }
    }
}
