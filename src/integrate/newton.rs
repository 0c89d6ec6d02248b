//! The stage equations, solved by simplified Newton iteration in the eigenbasis of A.
//!
//! With M, C, K at one point, the Newton matrix I⊗M + hA⊗C + h²A²⊗K falls apart into one real and
//! (S − 1)/2 complex systems M + hλC + h²λ²K of size F, λ the eigenvalues of A (Hairer & Wanner 1996,
//! IV.8, with q̇ = v eliminated).

use super::report::Counters;
use super::state::State;
use super::system::System;
use super::tableau::{Coefficients, MAX_PAIRS, RadauIia, Tableau};
use super::tolerances::Weights;
use crate::numerics::{Lu, Matrix, Singular, Size, Vector, persist};
use nalgebra::Complex;

/// A contraction above this is no convergence (RADAU5).
const DIVERGENCE: f64 = 0.99;

/// Roundings in units of |M||a| + |C||v| + |K||q| below which a residual is zero: its few hundred
/// operations err by a handful of units in the last place of the largest term.
const RESIDUAL_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Stage values of one step.
#[derive(Debug, Clone)]
pub(super) struct Stages<const S: usize, F: Size> {
    pub a: [F::Vector; S],
    pub v: [F::Vector; S],
    pub q: [F::Vector; S],
    /// End of the step relative to its start: v₁ − v₀ and q₁ − q₀.
    pub v_change: F::Vector,
    pub q_change: F::Vector,
}

persist!([const S: usize, F: Size] Stages<S, F> { a, v, q, v_change, q_change });

/// How an attempt to solve the stage equations ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Outcome {
    Converged { iterations: u32 },
    Slow { rate: f64 },
    NonFinite,
}

/// M, C, K at the linearization point.
#[derive(Debug, Clone)]
pub(super) struct Linearization<F: Size> {
    pub m: F::Matrix,
    pub c: F::Matrix,
    pub k: F::Matrix,
}

persist!([F: Size] Linearization<F> { m, c, k });

impl<F: Size> Linearization<F> {
    /// True if no entry is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        [&self.m, &self.c, &self.k]
            .into_iter()
            .flat_map(|matrix| matrix.as_slice())
            .all(|x| x.is_finite())
    }
}

/// Newton's iteration with what it keeps from step to step.
#[derive(Debug, Clone)]
pub(super) struct Newton<const S: usize, F: Size> {
    pub matrices: Linearization<F>,
    pub real: Lu<f64, F>,
    complex: [Lu<Complex<f64>, F>; MAX_PAIRS],
    /// Step length of the factorization; NaN if there is none.
    h: f64,
    /// Contraction θ of the last step that showed one.
    pub rate: f64,
    /// θ/(1 − θ), the error after an iteration in units of its correction, with a growing caution
    /// while no step shows a contraction.
    remaining: f64,
}

persist!([const S: usize, F: Size] Newton<S, F> { matrices, real, complex, h, rate, remaining });

impl<const S: usize, F: Size> Newton<S, F>
where
    RadauIia<S>: Coefficients<S>,
{
    /// Iterations allowed where a shorter step is the alternative (RADAU: 7, and more for more
    /// stages, whose steps are longer).
    pub const LIMIT: u32 = if S > 3 { 7 + 5 * (S as u32 - 3) / 2 } else { 7 };

    /// Iterations allowed where no other length will do: halving the error each time gains every
    /// bit of a number.
    pub const PATIENCE: u32 = f64::MANTISSA_DIGITS;

    pub fn new(size: F) -> Self {
        Newton {
            matrices: Linearization {
                m: size.zero_matrix(),
                c: size.zero_matrix(),
                k: size.zero_matrix(),
            },
            real: Lu::empty(size),
            complex: std::array::from_fn(|_| Lu::empty(size)),
            h: f64::NAN,
            rate: 1.0,
            remaining: 1.0,
        }
    }

    /// Effort of a step with that many iterations: 0 for one, up to about ½.
    pub fn effort(iterations: u32) -> f64 {
        f64::from(iterations - 1) / f64::from(2 * Self::LIMIT + 1)
    }

    /// Forgets what earlier steps showed about the contraction.
    pub fn forget(&mut self) {
        self.rate = 1.0;
        self.remaining = 1.0;
    }

    /// Evaluates M, C and K at `state`.
    #[inline]
    pub fn linearize<Y: System<F>>(
        &mut self,
        system: &mut Y,
        state: &State<F>,
        counters: &mut Counters,
    ) {
        let Linearization { m, c, k } = &mut self.matrices;
        system.jacobian(state.t, &state.q, &state.v, &state.a, m, c, k);
        counters.jacobian_evaluations += 1;
        self.h = f64::NAN;
    }

    /// Factorizes for step length `h`, unless that is done.
    #[inline]
    pub fn factorize(
        &mut self,
        h: f64,
        row_scale: &F::Vector,
        counters: &mut Counters,
    ) -> Result<(), Singular> {
        if self.h == h {
            return Ok(());
        }
        self.h = f64::NAN;
        counters.factorizations += 1;
        let tableau = RadauIia::<S>::TABLEAU;
        let Linearization { m, c, k } = &self.matrices;
        let z = h * tableau.gamma;
        let entry = |i, j| m[(i, j)] + z * (c[(i, j)] + z * k[(i, j)]);
        self.real = Lu::factorize(entry, row_scale)?;
        for pair in 0..Tableau::<S>::PAIRS {
            let [alpha, beta] = tableau.pairs[pair];
            let (re, im) = (h * alpha, h * beta);
            let (re2, im2) = (re * re - im * im, 2.0 * re * im);
            let entry = |i, j| {
                Complex::new(
                    m[(i, j)] + re * c[(i, j)] + re2 * k[(i, j)],
                    im * c[(i, j)] + im2 * k[(i, j)],
                )
            };
            self.complex[pair] = Lu::factorize(entry, row_scale)?;
        }
        self.h = h;
        Ok(())
    }

    /// Solves the stage equations of a step of length `h` from `start` to time `t_end`, for which the
    /// matrices must be factorized; `stages` holds starting values. Stops when the error is below `tolerance`, in
    /// the norm of `weights`, or after `limit` iterations.
    #[inline]
    #[allow(clippy::too_many_arguments)] // a step, and how well to solve it
    pub fn solve<Y: System<F>>(
        &mut self,
        system: &mut Y,
        start: &State<F>,
        (h, t_end): (f64, f64),
        stages: &mut Stages<S, F>,
        weights: &Weights<F>,
        tolerance: f64,
        limit: u32,
        counters: &mut Counters,
    ) -> Outcome {
        // A change of an acceleration changes v by at most h times it, and q by ½h² times it.
        let size = start.size();
        let weight = size.vector(|i| h * f64::max(weights.v[i], 0.5 * h * weights.q[i]));
        // Before two iterations have shown the contraction, the last step's stands in, raised to the
        // power 3/4 out of caution (RADAU5: 0.8; square roots are exact everywhere).
        // One below √ε was told by rounding, or by directions in which the equations happen to be linear: it says nothing of others.
        self.remaining = match system.is_linear() {
            true => f64::EPSILON,
            false => self.remaining.clamp(f64::EPSILON.sqrt(), 1.0),
        };
        self.remaining = (self.remaining * self.remaining.sqrt()).sqrt();

        let times = Stages::<S, F>::times(start.t, h, t_end);
        system.foresee(&times);
        let (mut last_norm, mut last_quotient) = (0.0, 0.0);
        let mut residual = std::array::from_fn(|_| size.zeros());
        for iteration in 1..=limit {
            stages.residual(system, &times, &mut residual);
            counters.residual_evaluations += S as u64;
            counters.newton_iterations += 1;
            let norm = self.correct(&residual, stages, &weight);
            if !norm.is_finite() {
                return Outcome::NonFinite;
            }
            stages.extend(start, h);
            if iteration > 1 {
                let quotient = norm / last_norm;
                self.rate = if iteration == 2 {
                    quotient
                } else {
                    f64::sqrt(quotient * last_quotient)
                };
                last_quotient = quotient;
                let rate = self.rate;
                // Below DIVERGENCE, but so slow that the iterations left will not do?
                let left = limit - iteration;
                let hopeless = || {
                    let reached = (0..left).fold(norm, |reached, _| reached * rate);
                    reached * rate / (1.0 - rate) > tolerance
                };
                if rate >= DIVERGENCE || norm * rate / (1.0 - rate) > tolerance && hopeless() {
                    if self.is_rounding(&residual, stages) {
                        return Outcome::Converged {
                            iterations: iteration,
                        };
                    }
                    return Outcome::Slow { rate };
                }
                self.remaining = rate / (1.0 - rate);
            }
            if self.remaining * norm <= tolerance {
                return Outcome::Converged {
                    iterations: iteration,
                };
            }
            last_norm = norm;
        }
        Outcome::Slow { rate: self.rate }
    }

    /// Subtracts the Newton correction from the stage accelerations and returns its norm.
    #[inline]
    fn correct(
        &self,
        residual: &[F::Vector; S],
        stages: &mut Stages<S, F>,
        weight: &F::Vector,
    ) -> f64 {
        let tableau = RadauIia::<S>::TABLEAU;
        let size = weight.size();
        let n = size.get();
        let mut w: [F::List<f64>; S] = std::array::from_fn(|_| size.list(0.0));
        for i in 0..S {
            for l in 0..n {
                for j in 0..S {
                    w[i][l] += tableau.t_inverse[i][j] * residual[j][l];
                }
            }
        }
        w[0] = self.real.solve(|l| w[0][l]);
        for pair in 0..Tableau::<S>::PAIRS {
            let (i, j) = (2 * pair + 1, 2 * pair + 2);
            let x = self.complex[pair].solve(|l| Complex::new(w[i][l], w[j][l]));
            for l in 0..n {
                w[i][l] = x[l].re;
                w[j][l] = x[l].im;
            }
        }
        let mut norm = 0.0_f64;
        let mut sum = 0.0;
        for i in 0..S {
            for l in 0..n {
                let mut change = 0.0;
                for j in 0..S {
                    change += tableau.t[i][j] * w[j][l];
                }
                stages.a[i][l] -= change;
                // `max` would drop a NaN; the sum keeps it.
                norm = norm.max(change.abs() * weight[l]);
                sum += change;
            }
        }
        if sum.is_finite() { norm } else { f64::NAN }
    }

    /// True if no residual exceeds the rounding of its terms: there is nothing left to correct.
    #[cold]
    fn is_rounding(&self, residual: &[F::Vector; S], stages: &Stages<S, F>) -> bool {
        let Linearization { m, c, k } = &self.matrices;
        let n = m.size().get();
        (0..S).all(|stage| {
            (0..n).all(|i| {
                let terms: f64 = (0..n)
                    .map(|j| {
                        (m[(i, j)] * stages.a[stage][j]).abs()
                            + (c[(i, j)] * stages.v[stage][j]).abs()
                            + (k[(i, j)] * stages.q[stage][j]).abs()
                    })
                    .sum();
                residual[stage][i].abs() <= RESIDUAL_ROUNDING * terms
            })
        })
    }
}

impl<const S: usize, F: Size> Stages<S, F>
where
    RadauIia<S>: Coefficients<S>,
{
    pub fn zeros(size: F) -> Self {
        let zeros = || std::array::from_fn(|_| size.zeros());
        Stages {
            a: zeros(),
            v: zeros(),
            q: zeros(),
            v_change: size.zeros(),
            q_change: size.zeros(),
        }
    }

    /// Stage `i` of the step of length `h` from time `t0`.
    pub fn state(&self, i: usize, t0: f64, h: f64) -> State<F> {
        let t = t0 + RadauIia::<S>::TABLEAU.c[i] * h;
        State {
            t,
            q: self.q[i].clone(),
            v: self.v[i].clone(),
            a: self.a[i].clone(),
        }
    }

    /// Stages without acceleration.
    #[inline(always)]
    pub fn coast(&mut self, start: &State<F>, h: f64) {
        let tableau = RadauIia::<S>::TABLEAU;
        for i in 0..S {
            let offset = tableau.c[i] * h;
            for l in 0..start.size().get() {
                self.a[i][l] = 0.0;
                self.v[i][l] = start.v[l];
                self.q[i][l] = start.q[l] + start.v[l] * offset;
            }
        }
    }

    /// Velocities and coordinates that belong to the accelerations.
    #[inline(always)]
    pub fn extend(&mut self, start: &State<F>, h: f64) {
        let tableau = RadauIia::<S>::TABLEAU;
        for i in 0..S {
            for l in 0..start.size().get() {
                let (mut first, mut second) = (0.0, 0.0);
                for j in 0..S {
                    first += tableau.a[i][j] * self.a[j][l];
                    second += tableau.a2[i][j] * self.a[j][l];
                }
                let (v_change, q_change) =
                    (h * first, h * (tableau.c[i] * start.v[l] + h * second));
                self.v[i][l] = start.v[l] + v_change;
                self.q[i][l] = start.q[l] + q_change;
                if i == S - 1 {
                    self.v_change[l] = v_change;
                    self.q_change[l] = q_change;
                }
            }
        }
    }

    /// Times of the stages of a step of length `h` from `t0` to `t_end`.
    fn times(t0: f64, h: f64, t_end: f64) -> [f64; S] {
        let tableau = RadauIia::<S>::TABLEAU;
        let mut times = tableau.c.map(|c| t0 + c * h);
        times[S - 1] = t_end;
        times
    }

    /// Writes the residuals of the stages where they are read: a copy right after them would wait.
    #[inline(always)]
    fn residual<Y: System<F>>(&self, system: &mut Y, times: &[f64; S], r: &mut [F::Vector; S]) {
        for i in 0..S {
            system.residual(times[i], &self.q[i], &self.v[i], &self.a[i], &mut r[i]);
        }
    }
}
