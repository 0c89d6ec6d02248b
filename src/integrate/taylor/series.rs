//! The motion as a power series in time, and what a system must offer to expand it.

use crate::integrate::System;
use nalgebra::{SMatrix, SVector};

/// Most coefficients of a series, the one of order 0 included. Order 34 serves the smallest relative
/// tolerance (see `length`); accelerations have one order less than velocities, coordinates one more.
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

/// A [`System`] whose motion can be expanded in powers of time.
///
/// With M and b of r = M a + b as series along the motion, M_0 a_k = −(b_k + Σ_{j=1}^{k} M_j a_{k−j}).
pub trait Analytic<const F: usize>: System<F> {
    /// Begins an expansion about time `t` to order `order`, with the coefficients of order 0 of q
    /// and v; gives M_0 and b_0.
    fn start(
        &mut self,
        t: f64,
        order: usize,
        series: &Series<F>,
    ) -> (SMatrix<f64, F, F>, SVector<f64, F>);

    /// Appends a_k, v_{k+1} and q_{k+2} for 1 ≤ k < `n`, given the inverse of M_0 and everything of
    /// lower order.
    fn run(&mut self, n: usize, inverse: &SMatrix<f64, F, F>, series: &mut Series<F>);

    /// Time until which the equations are the analytic functions of time that they are just after
    /// `t`; infinite if there is no limit.
    fn horizon(&self, _t: f64) -> f64 {
        f64::INFINITY
    }
}
