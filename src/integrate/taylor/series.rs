//! What a system must offer to expand its motion as a power series in time.

use crate::integrate::System;
use crate::numerics::{Series, Size};

/// A [`System`] whose motion can be expanded in powers of time.
///
/// With M and b of r = M a + b as series along the motion, M_0 a_k = −(b_k + Σ_{j=1}^{k} M_j a_{k−j}).
pub trait Analytic<F: Size>: System<F> {
    /// Begins an expansion about time `t` to order `order`, with the coefficients of order 0 of q
    /// and v; gives M_0 and b_0.
    fn start(&mut self, t: f64, order: usize, series: &Series<F>) -> (F::Matrix, F::Vector);

    /// Appends a_k, v_{k+1} and q_{k+2} for 1 ≤ k < `n`, given the inverse of M_0 and everything of
    /// lower order.
    fn run(&mut self, n: usize, inverse: &F::Matrix, series: &mut Series<F>);

    /// Time until which the equations are the analytic functions of time that they are just after
    /// `t`; infinite if there is no limit.
    fn horizon(&mut self, _t: f64) -> f64 {
        f64::INFINITY
    }
}
