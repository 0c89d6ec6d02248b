//! Test problems, each with its source. Reference values are beside the tests that use them.

use dalembert::integrate::{FirstOrderProblem, System};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector, matrix, vector};

/// q″ + 2ζω q′ + ω² q = 0, and copies of it; with `linear` it says that it is linear.
pub struct Oscillator {
    pub omega: f64,
    pub zeta: f64,
    pub linear: bool,
}

impl<const F: usize> System<Const<F>> for Oscillator {
    fn residual(
        &mut self,
        _t: f64,
        q: &SVector<f64, F>,
        v: &SVector<f64, F>,
        a: &SVector<f64, F>,
        r: &mut SVector<f64, F>,
    ) {
        *r = a + v * (2.0 * self.zeta * self.omega) + q * (self.omega * self.omega);
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _q: &SVector<f64, F>,
        _v: &SVector<f64, F>,
        _a: &SVector<f64, F>,
        m: &mut SMatrix<f64, F, F>,
        c: &mut SMatrix<f64, F, F>,
        k: &mut SMatrix<f64, F, F>,
    ) {
        *m = SMatrix::identity();
        *c = SMatrix::identity() * (2.0 * self.zeta * self.omega);
        *k = SMatrix::identity() * (self.omega * self.omega);
    }
    fn is_linear(&self) -> bool {
        self.linear
    }
}

/// Double pendulum, m = l = 1, absolute angles from down.
pub struct DoublePendulum {
    pub g: f64,
}

impl System<Const<2>> for DoublePendulum {
    fn residual(
        &mut self,
        _t: f64,
        q: &SVector<f64, 2>,
        v: &SVector<f64, 2>,
        a: &SVector<f64, 2>,
        r: &mut SVector<f64, 2>,
    ) {
        let (s, c) = (q[0] - q[1]).sin_cos();
        r[0] = 2.0 * a[0] + c * a[1] + s * v[1] * v[1] + 2.0 * self.g * q[0].sin();
        r[1] = c * a[0] + a[1] - s * v[0] * v[0] + self.g * q[1].sin();
    }
    fn jacobian(
        &mut self,
        _t: f64,
        q: &SVector<f64, 2>,
        v: &SVector<f64, 2>,
        a: &SVector<f64, 2>,
        m: &mut SMatrix<f64, 2, 2>,
        c: &mut SMatrix<f64, 2, 2>,
        k: &mut SMatrix<f64, 2, 2>,
    ) {
        let (sin, cos) = (q[0] - q[1]).sin_cos();
        *m = matrix![2.0, cos; cos, 1.0];
        *c = matrix![0.0, 2.0 * sin * v[1]; -2.0 * sin * v[0], 0.0];
        let first = cos * v[1] * v[1] - sin * a[1];
        let second = -cos * v[0] * v[0] - sin * a[0];
        *k = matrix![first + 2.0 * self.g * q[0].cos(), -first; second, self.g * q[1].cos() - second];
    }
}

/// A mass of 1 hung on a spring. Coordinates: x, y from the pivot, y upward.
pub struct SpringPendulum {
    pub k: f64,
    pub length: f64,
    pub g: f64,
}

impl System<Const<2>> for SpringPendulum {
    fn residual(
        &mut self,
        _t: f64,
        q: &SVector<f64, 2>,
        _v: &SVector<f64, 2>,
        a: &SVector<f64, 2>,
        r: &mut SVector<f64, 2>,
    ) {
        let length = (q[0] * q[0] + q[1] * q[1]).sqrt();
        *r = a + q * (self.k * (length - self.length) / length) + vector![0.0, self.g];
    }
    fn jacobian(
        &mut self,
        _t: f64,
        q: &SVector<f64, 2>,
        _v: &SVector<f64, 2>,
        _a: &SVector<f64, 2>,
        m: &mut SMatrix<f64, 2, 2>,
        c: &mut SMatrix<f64, 2, 2>,
        k: &mut SMatrix<f64, 2, 2>,
    ) {
        let length = (q[0] * q[0] + q[1] * q[1]).sqrt();
        let stretch = self.length / length;
        *m = SMatrix::identity();
        *c = SMatrix::zeros();
        let along = q * q.transpose() / (length * length);
        *k = (SMatrix::identity() * (1.0 - stretch) + along * stretch) * self.k;
    }
}

/// Seven bodies in the plane, masses 1 … 7, G = 1 (Hairer, Nørsett & Wanner 1993, II.10).
/// Coordinates: x₁ … x₇, y₁ … y₇.
pub struct Pleiades;

impl Pleiades {
    pub const Q: [f64; 14] = [
        3.0, 3.0, -1.0, -3.0, 2.0, -2.0, 2.0, 3.0, -3.0, 2.0, 0.0, 0.0, -4.0, 4.0,
    ];
    pub const V: [f64; 14] = [
        0.0, 0.0, 0.0, 0.0, 0.0, 1.75, -1.5, 0.0, 0.0, 0.0, -1.25, 1.0, 0.0, 0.0,
    ];
}

impl System<Const<14>> for Pleiades {
    fn residual(
        &mut self,
        _t: f64,
        q: &SVector<f64, 14>,
        _v: &SVector<f64, 14>,
        a: &SVector<f64, 14>,
        r: &mut SVector<f64, 14>,
    ) {
        *r = *a;
        for i in 0..7 {
            for j in (0..7).filter(|j| *j != i) {
                let (dx, dy) = (q[j] - q[i], q[7 + j] - q[7 + i]);
                let distance = dx.hypot(dy);
                let pull = (j + 1) as f64 / (distance * distance * distance);
                r[i] -= pull * dx;
                r[7 + i] -= pull * dy;
            }
        }
    }
    fn jacobian(
        &mut self,
        _t: f64,
        q: &SVector<f64, 14>,
        _v: &SVector<f64, 14>,
        _a: &SVector<f64, 14>,
        m: &mut SMatrix<f64, 14, 14>,
        c: &mut SMatrix<f64, 14, 14>,
        k: &mut SMatrix<f64, 14, 14>,
    ) {
        *m = SMatrix::identity();
        *c = SMatrix::zeros();
        *k = SMatrix::zeros();
        for i in 0..7 {
            for j in (0..7).filter(|j| *j != i) {
                let d = [q[j] - q[i], q[7 + j] - q[7 + i]];
                let distance = d[0].hypot(d[1]);
                let pull = (j + 1) as f64 / (distance * distance * distance);
                for (row, along) in d.iter().enumerate() {
                    for (column, across) in d.iter().enumerate() {
                        let one = if row == column { 1.0 } else { 0.0 };
                        let slope = pull * (one - 3.0 * along * across / (distance * distance));
                        k[(7 * row + i, 7 * column + j)] -= slope;
                        k[(7 * row + i, 7 * column + i)] += slope;
                    }
                }
            }
        }
    }
}

/// IVP test set (Bari/CWI): high irradiance responses, 8 reactions.
pub struct Hires;

impl FirstOrderProblem<Const<8>> for Hires {
    fn derivative(&mut self, _t: f64, y: &SVector<f64, 8>, f: &mut SVector<f64, 8>) {
        *f = vector![
            -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007,
            1.71 * y[0] - 8.75 * y[1],
            -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4],
            8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3],
            -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6],
            -280.0 * y[5] * y[7] + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6],
            280.0 * y[5] * y[7] - 1.81 * y[6],
            -280.0 * y[5] * y[7] + 1.81 * y[6]
        ];
    }
    fn jacobian(&mut self, _t: f64, y: &SVector<f64, 8>, j: &mut SMatrix<f64, 8, 8>) {
        let (a, b) = (280.0 * y[7], 280.0 * y[5]);
        *j = matrix![
            -1.71, 0.43, 8.32, 0.0, 0.0, 0.0, 0.0, 0.0;
            1.71, -8.75, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0;
            0.0, 0.0, -10.03, 0.43, 0.035, 0.0, 0.0, 0.0;
            0.0, 8.32, 1.71, -1.12, 0.0, 0.0, 0.0, 0.0;
            0.0, 0.0, 0.0, 0.0, -1.745, 0.43, 0.43, 0.0;
            0.0, 0.0, 0.0, 0.69, 1.71, -0.43 - a, 0.69, -b;
            0.0, 0.0, 0.0, 0.0, 0.0, a, -1.81, b;
            0.0, 0.0, 0.0, 0.0, 0.0, -a, 1.81, -b
        ];
    }
}

/// IVP test set: the Oregonator, s = 77.27, w = 0.161, q = 8.375e-6.
pub struct Orego;

impl FirstOrderProblem<Const<3>> for Orego {
    fn derivative(&mut self, _t: f64, y: &SVector<f64, 3>, f: &mut SVector<f64, 3>) {
        *f = vector![
            77.27 * (y[1] + y[0] * (1.0 - 8.375e-6 * y[0] - y[1])),
            (y[2] - (1.0 + y[0]) * y[1]) / 77.27,
            0.161 * (y[0] - y[2])
        ];
    }
    fn jacobian(&mut self, _t: f64, y: &SVector<f64, 3>, j: &mut SMatrix<f64, 3, 3>) {
        *j = matrix![
            77.27 * (1.0 - 2.0 * 8.375e-6 * y[0] - y[1]), 77.27 * (1.0 - y[0]), 0.0;
            -y[1] / 77.27, -(1.0 + y[0]) / 77.27, 1.0 / 77.27;
            0.161, 0.0, -0.161
        ];
    }
}

/// IVP test set: Robertson's reactions.
pub struct Rober;

impl FirstOrderProblem<Const<3>> for Rober {
    fn derivative(&mut self, _t: f64, y: &SVector<f64, 3>, f: &mut SVector<f64, 3>) {
        let slow = 0.04 * y[0];
        let back = 1e4 * y[1] * y[2];
        let fast = 3e7 * y[1] * y[1];
        *f = vector![back - slow, slow - back - fast, fast];
    }
    fn jacobian(&mut self, _t: f64, y: &SVector<f64, 3>, j: &mut SMatrix<f64, 3, 3>) {
        *j = matrix![
            -0.04, 1e4 * y[2], 1e4 * y[1];
            0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1];
            0.0, 6e7 * y[1], 0.0
        ];
    }
}

/// IVP test set: van der Pol's equation, ε y₂′ = (1 − y₁²) y₂ − y₁, as first order.
pub struct VanDerPol {
    pub epsilon: f64,
}

impl FirstOrderProblem<Const<2>> for VanDerPol {
    fn derivative(&mut self, _t: f64, y: &SVector<f64, 2>, f: &mut SVector<f64, 2>) {
        *f = vector![y[1], ((1.0 - y[0] * y[0]) * y[1] - y[0]) / self.epsilon];
    }
    fn jacobian(&mut self, _t: f64, y: &SVector<f64, 2>, j: &mut SMatrix<f64, 2, 2>) {
        *j = matrix![
            0.0, 1.0;
            (-2.0 * y[0] * y[1] - 1.0) / self.epsilon, (1.0 - y[0] * y[0]) / self.epsilon
        ];
    }
}

/// The same with its second-order structure: ε q″ = (1 − q²) q′ − q.
impl System<Const<1>> for VanDerPol {
    fn residual(
        &mut self,
        _t: f64,
        q: &SVector<f64, 1>,
        v: &SVector<f64, 1>,
        a: &SVector<f64, 1>,
        r: &mut SVector<f64, 1>,
    ) {
        r[0] = self.epsilon * a[0] - (1.0 - q[0] * q[0]) * v[0] + q[0];
    }
    fn jacobian(
        &mut self,
        _t: f64,
        q: &SVector<f64, 1>,
        v: &SVector<f64, 1>,
        _a: &SVector<f64, 1>,
        m: &mut SMatrix<f64, 1, 1>,
        c: &mut SMatrix<f64, 1, 1>,
        k: &mut SMatrix<f64, 1, 1>,
    ) {
        m[0] = self.epsilon;
        c[0] = q[0] * q[0] - 1.0;
        k[0] = 2.0 * q[0] * v[0] + 1.0;
    }
}

/// Prothero & Robinson (1974): y′ = −λ(y − cos t) − sin t.
pub struct ProtheroRobinson {
    pub lambda: f64,
}

impl FirstOrderProblem<Const<1>> for ProtheroRobinson {
    fn derivative(&mut self, t: f64, y: &SVector<f64, 1>, f: &mut SVector<f64, 1>) {
        f[0] = -self.lambda * (y[0] - t.cos()) - t.sin();
    }
    fn jacobian(&mut self, _t: f64, _y: &SVector<f64, 1>, j: &mut SMatrix<f64, 1, 1>) {
        j[0] = -self.lambda;
    }
}

/// Kaps (1981): y₁ = e^(−2t), y₂ = e^(−t) for every ε.
pub struct Kaps {
    pub epsilon: f64,
}

impl FirstOrderProblem<Const<2>> for Kaps {
    fn derivative(&mut self, _t: f64, y: &SVector<f64, 2>, f: &mut SVector<f64, 2>) {
        f[0] = -2.0 * y[0] + (y[1] * y[1] - y[0]) / self.epsilon;
        f[1] = y[0] - y[1] * (1.0 + y[1]);
    }
    fn jacobian(&mut self, _t: f64, y: &SVector<f64, 2>, j: &mut SMatrix<f64, 2, 2>) {
        *j = matrix![
            -2.0 - 1.0 / self.epsilon, 2.0 * y[1] / self.epsilon;
            1.0, -1.0 - 2.0 * y[1]
        ];
    }
}

/// Sliding block of mass 1 with a mass 0.1 on a spring and dashpot, μ = 0.3, g = 9.81, moving
/// forward. Coordinates: block, spring extension r.
pub struct SlidingBlock {
    pub k: f64,
    pub c: f64,
}

impl SlidingBlock {
    const M: f64 = 1.0;
    const SMALL: f64 = 0.1;
    const FRICTION: f64 = 0.3 * 9.81 * (Self::M + Self::SMALL);
}

impl System<Const<2>> for SlidingBlock {
    fn residual(
        &mut self,
        _t: f64,
        q: &SVector<f64, 2>,
        v: &SVector<f64, 2>,
        a: &SVector<f64, 2>,
        r: &mut SVector<f64, 2>,
    ) {
        r[0] = (Self::M + Self::SMALL) * a[0] + Self::SMALL * a[1] + Self::FRICTION;
        r[1] = Self::SMALL * (a[0] + a[1]) + self.c * v[1] + self.k * q[1];
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _q: &SVector<f64, 2>,
        _v: &SVector<f64, 2>,
        _a: &SVector<f64, 2>,
        m: &mut SMatrix<f64, 2, 2>,
        c: &mut SMatrix<f64, 2, 2>,
        k: &mut SMatrix<f64, 2, 2>,
    ) {
        *m = matrix![Self::M + Self::SMALL, Self::SMALL; Self::SMALL, Self::SMALL];
        *c = matrix![0.0, 0.0; 0.0, self.c];
        *k = matrix![0.0, 0.0; 0.0, self.k];
    }
    fn is_linear(&self) -> bool {
        true
    }
}
