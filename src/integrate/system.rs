//! What the integrator asks of a mechanical system.

use crate::numerics::{Singular, solve};
use nalgebra::{SMatrix, SVector};

/// A second-order system r(t, q, v, a) = 0 with q̇ = v, v̇ = a, where r is linear in a:
/// r = M(t, q, v) a + b(t, q, v). M may be unsymmetric (Coulomb friction), and singular as long as
/// M + γh C + γ²h² K is regular (massless parts).
///
/// `F` is the number of free coordinates; `F` = 0 is allowed. A function that meets an inadmissible
/// state writes NaN; the integrator then tries a shorter step.
pub trait System<const F: usize> {
    /// Writes the residual r(t, q, v, a), one generalized force a coordinate.
    fn residual(
        &mut self,
        t: f64,
        q: &SVector<f64, F>,
        v: &SVector<f64, F>,
        a: &SVector<f64, F>,
        r: &mut SVector<f64, F>,
    );

    /// Writes m = ∂r/∂a, c = ∂r/∂v and k = ∂r/∂q.
    #[allow(clippy::too_many_arguments)] // a point and three matrices
    fn jacobian(
        &mut self,
        t: f64,
        q: &SVector<f64, F>,
        v: &SVector<f64, F>,
        a: &SVector<f64, F>,
        m: &mut SMatrix<f64, F, F>,
        c: &mut SMatrix<f64, F, F>,
        k: &mut SMatrix<f64, F, F>,
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
        q: &SVector<f64, F>,
        v: &SVector<f64, F>,
        a: &mut SVector<f64, F>,
    ) -> Result<(), Singular> {
        let zero = SVector::zeros();
        let mut r = SVector::zeros();
        let (mut m, mut c, mut k) = (SMatrix::zeros(), SMatrix::zeros(), SMatrix::zeros());
        self.residual(t, q, v, &zero, &mut r);
        self.jacobian(t, q, v, &zero, &mut m, &mut c, &mut k);
        *a = solve(&m, &-r, &SVector::repeat(1.0))?;
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
pub trait FirstOrderProblem<const F: usize> {
    /// Writes f(t, y).
    fn derivative(&mut self, t: f64, y: &SVector<f64, F>, f: &mut SVector<f64, F>);
    /// Writes ∂f/∂y.
    fn jacobian(&mut self, t: f64, y: &SVector<f64, F>, j: &mut SMatrix<f64, F, F>);
}

/// Makes a first-order problem a [`System`]: the velocity v plays y, r = a − f(t, v), and q is ∫ y dt,
/// on which nothing depends. Give q an infinite absolute tolerance.
#[derive(Debug, Clone)]
pub struct FirstOrder<P>(pub P);

impl<const F: usize, P: FirstOrderProblem<F>> System<F> for FirstOrder<P> {
    #[inline]
    fn residual(
        &mut self,
        t: f64,
        _q: &SVector<f64, F>,
        v: &SVector<f64, F>,
        a: &SVector<f64, F>,
        r: &mut SVector<f64, F>,
    ) {
        self.0.derivative(t, v, r);
        for i in 0..F {
            r[i] = a[i] - r[i];
        }
    }

    #[inline]
    fn jacobian(
        &mut self,
        t: f64,
        _q: &SVector<f64, F>,
        v: &SVector<f64, F>,
        _a: &SVector<f64, F>,
        m: &mut SMatrix<f64, F, F>,
        c: &mut SMatrix<f64, F, F>,
        k: &mut SMatrix<f64, F, F>,
    ) {
        self.0.jacobian(t, v, c);
        c.neg_mut();
        m.fill_with_identity();
        k.fill(0.0);
    }
}
