//! The motion as a power series in time.

use super::persist::persist;
use super::size::{Rows, Size};
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
#[derive(Debug, Clone, PartialEq)]
pub struct Series<F: Size> {
    /// Of the coordinates.
    pub q: F::Rows,
    /// Of the velocities.
    pub v: F::Rows,
    /// Of the accelerations.
    pub a: F::Rows,
}

persist!([F: Size] Series<F> { q, v, a });

impl<F: Size> Series<F> {
    /// All coefficients zero.
    pub fn zero(size: F) -> Self {
        Series {
            q: size.rows(),
            v: size.rows(),
            a: size.rows(),
        }
    }

    /// Number of coordinates.
    #[inline(always)]
    pub fn size(&self) -> F {
        self.q.size()
    }
}

/// Σ c_k τᵏ, in powers of τ⁴ for every fourth coefficient: a processor works on the four sums side by
/// side (Estrin 1960).
#[inline(always)]
pub(super) fn sum<const F: usize>(coefficients: &[SVector<f64, F>], tau: f64) -> SVector<f64, F> {
    let (fours, rest) = coefficients.as_chunks::<4>();
    let mut sums = [SVector::<f64, F>::zeros(); 4];
    // One by one: a copy of unknown length is a call of the C library.
    for (k, sum) in sums[..3].iter_mut().enumerate() {
        if let Some(coefficient) = rest.get(k) {
            *sum = *coefficient;
        }
    }
    let tau2 = tau * tau;
    let tau4 = tau2 * tau2;
    for four in fours.iter().rev() {
        for (sum, coefficient) in sums.iter_mut().zip(four) {
            *sum = *sum * tau4 + coefficient;
        }
    }
    (sums[0] + sums[1] * tau) + (sums[2] + sums[3] * tau) * tau2
}

/// The same of numbers.
#[inline]
pub(super) fn sum_of(count: usize, coefficient: impl Fn(usize) -> f64, tau: f64) -> f64 {
    let fours = count / 4;
    let mut sums: [f64; 4] = std::array::from_fn(|k| match 4 * fours + k < count {
        true => coefficient(4 * fours + k),
        false => 0.0,
    });
    let tau2 = tau * tau;
    let tau4 = tau2 * tau2;
    for four in (0..fours).rev() {
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum = *sum * tau4 + coefficient(4 * four + k);
        }
    }
    (sums[0] + sums[1] * tau) + (sums[2] + sums[3] * tau) * tau2
}

/// Of the coefficients in powers of s writes those of `factor` times the polynomial in powers of s/`scale`,
/// from the power `first` on, as many as there is room for: two powers side by side, since a product waits for the
/// one before.
#[inline(always)]
pub(crate) fn stretch<T>(
    from: &[T],
    coefficient: impl Fn(&T) -> f64,
    (factor, scale, first): (f64, f64, usize),
    out: &mut [f64],
) {
    let squared = scale * scale;
    let mut powers = [factor, factor * scale];
    for _ in 0..first {
        powers = [powers[1], powers[0] * squared];
    }
    let from = &from[first..];
    let count = from.len().min(out.len());
    let (pairs, last) = from[..count].as_chunks::<2>();
    let (out_pairs, out_last) = out[..count].as_chunks_mut::<2>();
    for (out, pair) in out_pairs.iter_mut().zip(pairs) {
        for k in 0..2 {
            out[k] = coefficient(&pair[k]) * powers[k];
            powers[k] *= squared;
        }
    }
    if let ([out], [last]) = (out_last, last) {
        *out = coefficient(last) * powers[0];
    }
}
