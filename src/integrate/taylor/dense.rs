//! Dense output: the series itself.

use crate::numerics::Series;
use crate::numerics::persist;
use nalgebra::SVector;

/// The motion within a step as the Taylor series about its start, which is what the method computed:
/// a shortened step is the same polynomial on a shorter window.
///
/// The first power of τ = t − start that is not zero decides the sign of a coordinate just after the
/// start, however small τ is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaylorDense<const F: usize> {
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

persist!([const F: usize] TaylorDense<F> { t0, h, t_end, order, known, series });

impl<const F: usize> TaylorDense<F> {
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
    pub fn at(&self, t: f64) -> (SVector<f64, F>, SVector<f64, F>, SVector<f64, F>) {
        self.at_offset(t - self.t0)
    }

    /// The same at τ = t − start, which resolves times close to the start.
    #[inline]
    pub fn at_offset(&self, tau: f64) -> (SVector<f64, F>, SVector<f64, F>, SVector<f64, F>) {
        let (dq, dv) = self.change(tau);
        let a = self.acceleration(tau);
        (self.series.q[0] + dq, self.series.v[0] + dv, a)
    }

    /// Accelerations at τ.
    #[inline(always)]
    pub(super) fn acceleration(&self, tau: f64) -> SVector<f64, F> {
        sum(&self.series.a[..self.order], tau)
    }

    /// By how much coordinates and velocities change in τ.
    #[inline(always)]
    pub(in crate::integrate) fn change(&self, tau: f64) -> (SVector<f64, F>, SVector<f64, F>) {
        let Series { q, v, .. } = &self.series;
        (
            sum(&q[1..self.order + 2], tau) * tau,
            sum(&v[1..self.order + 1], tau) * tau,
        )
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
        assert!(index < F, "there is no coordinate {index}");
        let rows = match rate {
            false => &self.series.q,
            true => &self.series.v,
        };
        // With the zero behind the last of an odd number: what is written in pairs is read in pairs.
        let count = self.count(rate) - from;
        let rows = &rows[..(from + count + count % 2).min(rows.len())];
        stretch(rows, |row| row[index], (factor, self.h, from), out);
    }
}

/// Σ c_k τᵏ, in powers of τ⁴ for every fourth coefficient: a processor works on the four sums side by
/// side (Estrin 1960).
#[inline(always)]
fn sum<const F: usize>(coefficients: &[SVector<f64, F>], tau: f64) -> SVector<f64, F> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::vector;

    #[test]
    fn the_first_two_coefficients_are_those_of_all() {
        let mut series = Series::<2>::zero();
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
