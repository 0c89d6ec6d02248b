//! Estimate of the local error: an embedded formula of order S, filtered so that stiff components
//! do not count (Hairer & Wanner 1996, IV.8, eqs. 8.17–8.20), with q̇ = v eliminated.

use super::logarithm::root;
use super::newton::{Linearization, Newton, Stages};
use super::state::State;
use super::tableau::{Coefficients, RadauIia};
use super::tolerances::{Weights, power};
use crate::numerics::{Size, Vector};

/// Difference of the embedded formula and the step, in q and v.
#[derive(Debug, Clone)]
pub(super) struct Estimate<F: Size> {
    q: F::Vector,
    v: F::Vector,
}

impl<F: Size> Estimate<F> {
    /// d_v = h (γ a₀ + Σ e_i A_i), d_q = h (γ v₀ + Σ e_i V_i), both written without the parts that
    /// cancel exactly.
    #[inline]
    pub fn raw<const S: usize>(h: f64, start: &State<F>, stages: &Stages<S, F>) -> Self
    where
        RadauIia<S>: Coefficients<S>,
    {
        let tableau = RadauIia::<S>::TABLEAU;
        let size = start.size();
        let mut raw = Estimate::<F> {
            q: size.zeros(),
            v: size.zeros(),
        };
        for l in 0..size.get() {
            let (mut first, mut second) = (0.0, 0.0);
            for i in 0..S {
                first += tableau.e[i] * (stages.a[i][l] - start.a[l]);
                second += tableau.ea[i] * stages.a[i][l];
            }
            raw.v[l] = h * first;
            raw.q[l] = h * h * second;
        }
        raw
    }

    /// (I − hγJ)⁻¹ applied to the estimate, J the Jacobian of the first-order system:
    /// (M + hγC + h²γ²K) v = M d_v − hγ K d_q, q = d_q + hγ v.
    #[inline]
    pub fn filtered<const S: usize>(&self, h: f64, newton: &Newton<S, F>) -> Self
    where
        RadauIia<S>: Coefficients<S>,
    {
        let z = h * RadauIia::<S>::TABLEAU.gamma;
        let Linearization { m, k, .. } = &newton.matrices;
        let size = self.q.size();
        let v = newton.real.solve(|i| {
            let mut sum = 0.0;
            for j in 0..size.get() {
                sum += m[(i, j)] * self.v[j] - z * k[(i, j)] * self.q[j];
            }
            sum
        });
        Estimate {
            q: size.vector(|i| self.q[i] + v[i] * z),
            v: size.vector(|i| v[i]),
        }
    }

    /// Size of the filtered estimate `self` in units of its tolerance or, if that is larger, of the
    /// method's own error in units of the tolerance that was asked for; `raw`: unfiltered estimate.
    ///
    /// The tolerance of the estimate rests on the method's error being smaller than the estimate by
    /// `error_quotient` |γhλ|^(S−1). That holds for what the step resolves. Of a stiff oscillation or
    /// decay it does not resolve (|hλ| > 1) the method gets nothing right, and the error is the
    /// filtered estimate itself: undamped oscillations would be swallowed up to the size of the
    /// loosened tolerance. With F = (I − hγJ)⁻¹, (F − I)^(S−1) has the effect of (γhλ)^(S−1) on the
    /// first kind and leaves the second as it is.
    #[inline]
    pub fn method_error<const S: usize>(
        &self,
        raw: &Self,
        h: f64,
        newton: &Newton<S, F>,
        weights: &Weights<F>,
        loosening: f64,
    ) -> f64
    where
        RadauIia<S>: Coefficients<S>,
    {
        let factor = loosening * RadauIia::<S>::TABLEAU.error_quotient;
        // filtered − raw = hγJ filtered tells the size of γhλ without further work.
        let norm = self.norm(weights);
        let mut difference = self.less(raw);
        let stiffness = difference.norm(weights) / norm;
        if norm == 0.0 || factor * power(stiffness, S - 1) < 1.0 {
            return norm; // no error, or that of the method is smaller
        }
        difference = self.clone();
        for _ in 1..S {
            let filtered = difference.filtered(h, newton);
            difference = filtered.less(&difference);
        }
        let error = factor * difference.norm(weights);
        // For the controller, which takes the (S + 1)-th root: this one grows with h^2S where it is
        // small.
        norm.max(if error < 1.0 {
            power(root(error, 2 * S), S + 1).recip()
        } else {
            error
        })
    }

    /// The difference from another.
    #[inline(always)]
    fn less(&self, other: &Self) -> Self {
        let size = self.q.size();
        Estimate {
            q: size.vector(|i| self.q[i] - other.q[i]),
            v: size.vector(|i| self.v[i] - other.v[i]),
        }
    }

    /// Size of component `i` in units of the tolerance.
    #[inline]
    pub fn size(&self, i: usize, weights: &Weights<F>) -> f64 {
        f64::max(
            self.q[i].abs() * weights.q[i],
            self.v[i].abs() * weights.v[i],
        )
    }

    /// Largest component in units of the tolerance; NaN if one is not finite.
    #[inline]
    pub fn norm(&self, weights: &Weights<F>) -> f64 {
        let (mut norm, mut sum) = (0.0_f64, 0.0);
        for i in 0..self.q.size().get() {
            let size = self.size(i, weights);
            norm = norm.max(size);
            sum += self.v[i];
        }
        if sum.is_finite() { norm } else { f64::NAN }
    }
}
