//! Dense output: the motion within a step as one polynomial a coordinate.

use super::state::State;
use super::tableau::{Coefficients, RadauIia};
use crate::numerics::{Size, Vector, persist};

/// The motion within a step, from its start at time t₀ over a length h. With τ = t − t₀, s = τ/h,
///
/// ```text
/// q = q₀ + τ (v₀ + τ P(s)),    P(s) = p₀ + p₁ s + … + p_S s^S,    v = dq/dt,    a = dv/dt.
/// ```
///
/// q₀ and v₀ come out exactly at the start, and the first power of τ that is not zero decides the
/// sign of q − q₀ after the start, however small τ is.
///
/// A component that the step resolves uses the interpolant of its acceleration through the start and
/// all stages; q, v and a join those at both ends (S = 3: the quintic Hermite polynomial). A stiff
/// component that the step does not resolve uses the collocation polynomial (see
/// [`super::Radau::step`]).
///
/// Order of the error at any time of a run (S ≥ 3): q min(2S − 1, S + 3), v min(2S − 1, S + 2), a
/// S + 1; on the collocation polynomial one less, where that is below 2S − 1. For S = 3 that is 5, 5
/// and 4.
#[derive(Debug, Clone, PartialEq)]
pub struct Dense<const S: usize, F: Size> {
    pub(super) t0: f64,
    pub(super) h: f64,
    pub(super) t_end: f64,
    pub(super) q0: F::Vector,
    pub(super) v0: F::Vector,
    /// p₀ in the module's formula.
    pub(super) p0: F::Vector,
    /// p₁ … p_S.
    pub(super) p: [F::Vector; S],
}

persist!([const S: usize, F: Size] Dense<S, F> { t0, h, t_end, q0, v0, p0, p });

impl<const S: usize, F: Size> Dense<S, F> {
    /// Degree in s of the polynomials of q.
    pub const DEGREE: usize = S + 2;

    /// Time at s = 0, s.
    pub fn start(&self) -> f64 {
        self.t0
    }

    /// Length of the step the polynomial was made for, s: s = (t − start)/length. Clipping does not
    /// change it.
    pub fn length(&self) -> f64 {
        self.h
    }

    /// End of the window in which the polynomial is valid, s.
    pub fn end(&self) -> f64 {
        self.t_end
    }

    /// Shortens the window to end at time `t`. The polynomial stays as it is.
    ///
    /// # Panics
    /// If `t` is not within the window.
    pub fn clip(&mut self, t: f64) {
        assert!(
            self.t0 <= t && t <= self.t_end,
            "the window can only shrink: {t} is not in [{}, {}]",
            self.t0,
            self.t_end
        );
        self.t_end = t;
    }

    /// Coordinates, velocities and accelerations at time `t` of the window.
    #[inline]
    pub fn at(&self, t: f64) -> (F::Vector, F::Vector, F::Vector) {
        self.at_offset(t - self.t0)
    }

    /// The same at τ = t − start, which resolves times close to the start.
    #[inline]
    pub fn at_offset(&self, tau: f64) -> (F::Vector, F::Vector, F::Vector) {
        let s = tau / self.h;
        let size = self.q0.size();
        let (mut q, mut v, mut a) = (self.q0.clone(), self.v0.clone(), size.zeros());
        for i in 0..size.get() {
            // Horner's scheme for P and, with the powers' factors from differentiating τ²P once and
            // twice, for 2P + sP′ and 2P + 4sP′ + s²P″.
            let (mut value, mut first, mut second) = (0.0, 0.0, 0.0);
            for k in (0..S).rev() {
                let power = (k + 3) as f64;
                value = value * s + self.p[k][i];
                first = first * s + power * self.p[k][i];
                second = second * s + power * (power - 1.0) * self.p[k][i];
            }
            value = value * s + self.p0[i];
            first = first * s + 2.0 * self.p0[i];
            second = second * s + 2.0 * self.p0[i];
            q[i] += tau * (self.v0[i] + tau * value);
            v[i] += tau * first;
            a[i] = second;
        }
        (q, v, a)
    }

    /// The coefficient of s^`power` in coordinate `index`, 0 ≤ `power` ≤ [`Self::DEGREE`], in its units.
    #[inline]
    pub fn coefficient(&self, index: usize, power: usize) -> f64 {
        match power {
            0 => self.q0[index],
            1 => self.h * self.v0[index],
            2 => self.h * self.h * self.p0[index],
            _ => self.h * self.h * self.p[power - 3][index],
        }
    }

    /// The coefficient of s^`power` in the velocity `index`, 0 ≤ `power` < [`Self::DEGREE`].
    #[inline]
    pub(super) fn rate_coefficient(&self, index: usize, power: usize) -> f64 {
        match power {
            0 => self.v0[index],
            1 => 2.0 * self.h * self.p0[index],
            _ => (power + 1) as f64 * self.h * self.p[power - 2][index],
        }
    }

    pub(super) fn zero(size: F) -> Self {
        Dense {
            t0: 0.0,
            h: 0.0,
            t_end: 0.0,
            q0: size.zeros(),
            v0: size.zeros(),
            p0: size.zeros(),
            p: std::array::from_fn(|_| size.zeros()),
        }
    }

    /// Makes this the motion in the step from `origin` with these accelerations at its `stages`; `times`: its
    /// start, length and end. Written where it is read: a copy right after it would wait for what is on
    /// its way to memory.
    #[inline]
    pub(super) fn interpolate(
        &mut self,
        times: (f64, f64, f64),
        origin: &State<F>,
        stages: &[F::Vector; S],
        unresolved: &F::List<bool>,
    ) where
        RadauIia<S>: Coefficients<S>,
    {
        let tableau = RadauIia::<S>::TABLEAU;
        (self.t0, self.h, self.t_end) = times;
        self.q0.clone_from(&origin.q);
        self.v0.clone_from(&origin.v);
        let a0 = &origin.a;
        for i in 0..origin.size().get() {
            // One stage does not make an interpolant that reaches the end point.
            if S > 1 && !unresolved[i] {
                self.p0[i] = 0.5 * a0[i];
                for k in 0..S {
                    let mut sum = 0.0;
                    for j in 0..S {
                        sum += tableau.smooth[k][j] * (stages[j][i] - a0[i]);
                    }
                    self.p[k][i] = sum;
                }
            } else {
                let mut square = 0.0;
                for j in 0..S {
                    square += tableau.collocation_square[j] * stages[j][i];
                }
                self.p0[i] = square;
                for k in 0..S {
                    let mut sum = 0.0;
                    for j in 0..S {
                        sum += tableau.collocation[k][j] * stages[j][i];
                    }
                    self.p[k][i] = sum;
                }
            }
        }
    }

    /// Accelerations at time t₀ + `tau`, inside or beyond the window, as starting values.
    #[inline]
    pub(super) fn acceleration(&self, tau: f64) -> F::Vector {
        let s = tau / self.h;
        self.p0.size().vector(|i| {
            let mut second = 0.0;
            for k in (0..S).rev() {
                second = second * s + ((k + 3) * (k + 2)) as f64 * self.p[k][i];
            }
            second * s + 2.0 * self.p0[i]
        })
    }
}
