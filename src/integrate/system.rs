//! What the integrator asks of a mechanical system.

use crate::numerics::{Matrix, Series, Size, Vector};
use crate::numerics::{Singular, solve_for};

/// A second-order system r(t, q, v, a) = 0 with q̇ = v, v̇ = a, where r is linear in a:
/// r = M(t, q, v) a + b(t, q, v). M may be unsymmetric (Coulomb friction), and singular as long as
/// M + γh C + γ²h² K is regular (massless parts).
///
/// `F` is the number of free coordinates; `F` = 0 is allowed. A function that meets an inadmissible
/// state writes NaN; the integrator then tries a shorter step.
pub trait System<F: Size> {
    /// Writes the residual r(t, q, v, a), one generalized force a coordinate.
    fn residual(&mut self, t: f64, q: &F::Vector, v: &F::Vector, a: &F::Vector, r: &mut F::Vector);

    /// Writes m = ∂r/∂a, c = ∂r/∂v and k = ∂r/∂q.
    #[allow(clippy::too_many_arguments)] // a point and three matrices
    fn jacobian(
        &mut self,
        t: f64,
        q: &F::Vector,
        v: &F::Vector,
        a: &F::Vector,
        m: &mut F::Matrix,
        c: &mut F::Matrix,
        k: &mut F::Matrix,
    );

    /// Writes the acceleration with r(t, q, v, a) = 0.
    ///
    /// The provided method solves M a = −r(t, q, v, 0) with M from [`System::jacobian`]. Its rows
    /// are compared unscaled for pivoting.
    ///
    /// # Errors
    /// [`Singular`] where M is singular.
    fn acceleration(
        &mut self,
        t: f64,
        q: &F::Vector,
        v: &F::Vector,
        a: &mut F::Vector,
    ) -> Result<(), Singular> {
        let size = q.size();
        let (zero, mut r) = (size.zeros(), size.zeros());
        let [mut m, mut c, mut k] = [(); 3].map(|()| size.zero_matrix());
        self.residual(t, q, v, &zero, &mut r);
        self.jacobian(t, q, v, &zero, &mut m, &mut c, &mut k);
        *a = solve_for(&m, |i| -r[i], &size.repeat(1.0))?;
        Ok(())
    }

    /// Says at which times, up to eight, residuals will be asked for next, so that what depends on time
    /// alone may be computed for all of them side by side.
    fn foresee(&mut self, _times: &[f64]) {}

    /// Longest step from time `t`, s, in which the few points where a step looks at the equations
    /// cannot miss what they do in between; infinite where nothing limits it.
    fn resolution(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// Whether something that is looked at within steps swings with time alone: then [`System::swing_limit`] limits them.
    fn swings(&self) -> bool {
        false
    }

    /// The longest step from time `t`, s, in which a series of so many orders resolves what swings with time, along the series of the
    /// motion; infinite where that does not limit a step of the length `most`.
    fn swing_limit(&mut self, _t: f64, _series: (&Series<F>, usize), _most: f64) -> f64 {
        f64::INFINITY
    }

    /// The first time after `t` at which some derivative of the equations jumps, s; infinite where there
    /// is none. A step across it would have neither the order nor the error estimate of the method.
    fn smooth_until(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// True if M, C and K are constant: Newton's method then converges in one iteration and the
    /// Jacobian is never evaluated again. A true that is wrong gives wrong results.
    fn is_linear(&self) -> bool {
        false
    }
}

/// A first-order problem y′ = f(t, y), to be run through [`FirstOrder`].
pub trait FirstOrderProblem<F: Size> {
    /// Writes f(t, y).
    fn derivative(&mut self, t: f64, y: &F::Vector, f: &mut F::Vector);
    /// Writes ∂f/∂y.
    fn jacobian(&mut self, t: f64, y: &F::Vector, j: &mut F::Matrix);
}

/// Makes a first-order problem a [`System`]: the velocity v plays y, r = a − f(t, v), and q is ∫ y dt,
/// on which nothing depends. Give q an infinite absolute tolerance.
#[derive(Debug, Clone)]
pub struct FirstOrder<P>(pub P);

impl<F: Size, P: FirstOrderProblem<F>> System<F> for FirstOrder<P> {
    #[inline]
    fn residual(
        &mut self,
        t: f64,
        _q: &F::Vector,
        v: &F::Vector,
        a: &F::Vector,
        r: &mut F::Vector,
    ) {
        self.0.derivative(t, v, r);
        for i in 0..r.size().get() {
            r[i] = a[i] - r[i];
        }
    }

    #[inline]
    fn jacobian(
        &mut self,
        t: f64,
        _q: &F::Vector,
        v: &F::Vector,
        _a: &F::Vector,
        m: &mut F::Matrix,
        c: &mut F::Matrix,
        k: &mut F::Matrix,
    ) {
        self.0.jacobian(t, v, c);
        c.as_mut_slice().iter_mut().for_each(|c| *c = -*c);
        m.as_mut_slice().fill(0.0);
        (0..m.size().get()).for_each(|i| m[(i, i)] = 1.0);
        k.as_mut_slice().fill(0.0);
    }
}
