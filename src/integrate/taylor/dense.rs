//! Dense output: the series itself.

use crate::numerics::{ORDERS, Rows, Series, Size, persist};

/// The motion within a step as the Taylor series about its start, which is what the method computed:
/// a shortened step is the same polynomial on a shorter window.
///
/// The first power of τ = t − start that is not zero decides the sign of a coordinate just after the
/// start, however small τ is.
#[derive(Debug, Clone, PartialEq)]
pub struct TaylorDense<F: Size> {
    pub(super) t0: f64,
    pub(super) h: f64,
    pub(super) t_end: f64,
    /// Order p: highest coefficients are q_{p+1}, v_p, a_{p−1}; less than the order of the method
    /// where the coefficients beyond vanish.
    pub(super) order: usize,
    /// Order of the step, that of the method or the lower one: up to it the coefficients are known, zero or not.
    pub(super) known: usize,
    pub(super) series: Series<F>,
}

persist!([F: Size] TaylorDense<F> { t0, h, t_end, order, known, series });

impl<F: Size> TaylorDense<F> {
    /// Time at τ = 0, s.
    pub fn start(&self) -> f64 {
        self.t0
    }

    /// Length of the step the series was cut off for, s.
    pub fn length(&self) -> f64 {
        self.h
    }

    /// End of the window in which the polynomial is valid, s.
    pub fn end(&self) -> f64 {
        self.t_end
    }

    /// Number of orders in which coordinates, velocities and accelerations are known.
    pub fn orders(&self) -> usize {
        self.known
    }

    /// The coefficients.
    pub fn series(&self) -> &Series<F> {
        &self.series
    }

    /// Coordinates, velocities and accelerations at time `t` of the window.
    #[inline]
    pub fn at(&self, t: f64) -> (F::Vector, F::Vector, F::Vector) {
        self.at_offset(t - self.t0)
    }

    /// The same at τ = t − start, which resolves times close to the start.
    #[inline]
    pub fn at_offset(&self, tau: f64) -> (F::Vector, F::Vector, F::Vector) {
        let a = self.acceleration(tau);
        let (q, v) = self.change_from_start(tau);
        (q, v, a)
    }

    /// Coordinates and velocities at τ.
    #[inline(always)]
    pub(in crate::integrate) fn change_from_start(&self, tau: f64) -> (F::Vector, F::Vector) {
        let (mut q, mut v) = self.change(tau);
        let Series { q: q0, v: v0, .. } = &self.series;
        for i in 0..self.series.size().get() {
            q[i] += q0[0][i];
            v[i] += v0[0][i];
        }
        (q, v)
    }

    /// Accelerations at τ.
    #[inline(always)]
    pub(super) fn acceleration(&self, tau: f64) -> F::Vector {
        self.series.a.sum(0..self.order, tau)
    }

    /// By how much coordinates and velocities change in τ.
    #[inline(always)]
    pub(in crate::integrate) fn change(&self, tau: f64) -> (F::Vector, F::Vector) {
        let Series { q, v, .. } = &self.series;
        let mut dq = q.sum(1..self.order + 2, tau);
        let mut dv = v.sum(1..self.order + 1, tau);
        for i in 0..self.series.size().get() {
            dq[i] *= tau;
            dv[i] *= tau;
        }
        (dq, dv)
    }

    /// Number of coefficients of a coordinate, or of its rate.
    #[inline]
    pub fn count(&self, rate: bool) -> usize {
        if rate { self.order + 1 } else { self.order + 2 }
    }

    /// The first two coefficients of [`Self::scaled`].
    #[inline]
    pub fn first_two(&self, (index, rate): (usize, bool), factor: f64) -> [f64; 2] {
        let rows = match rate {
            false => &self.series.q,
            true => &self.series.v,
        };
        [rows[0][index] * factor, rows[1][index] * (factor * self.h)]
    }

    /// Writes the coefficients in powers of s = τ/length of `factor` times coordinate `index`, or its
    /// rate, from a power on, as many as there is room for.
    #[inline]
    pub fn scaled(&self, (index, rate): (usize, bool), factor: f64, from: usize, out: &mut [f64]) {
        // Once, so that two at a time need no other check.
        assert!(
            index < self.series.size().get(),
            "there is no coordinate {index}"
        );
        let rows = match rate {
            false => &self.series.q,
            true => &self.series.v,
        };
        // With the zero behind the last of an odd number: what is written in pairs is read in pairs.
        let count = self.count(rate) - from;
        let known = (from + count + count % 2).min(ORDERS);
        rows.stretch((known, index), (factor, self.h, from), out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Const, vector};

    #[test]
    fn the_first_two_coefficients_are_those_of_all() {
        let mut series = Series::zero(Const::<2>);
        series.q[..3].copy_from_slice(&[vector![1.1, 2.3], vector![0.7, -0.3], vector![0.2, 0.1]]);
        series.v[..2].copy_from_slice(&[vector![0.7, -0.3], vector![0.4, 0.2]]);
        let dense = TaylorDense {
            t0: 0.0,
            h: 0.37,
            t_end: 0.37,
            order: 1,
            known: 6,
            series,
        };
        for of in [(0, false), (1, false), (0, true), (1, true)] {
            let mut all = [0.0; 4];
            dense.scaled(of, -1.7, 0, &mut all);
            assert_eq!(dense.first_two(of, -1.7), all[..2]);
        }
    }
}
