//! The motion inside an implicit step, brought to the accuracy of its ends.
//!
//! Dense output is an interpolant of accelerations at few points: its order is lower than that of the end, so that inside a step it is
//! off by a hundred tolerances and more at tight ones. What is read off there, rows and extremes, deserves better. So the accelerations at
//! Chebyshev points follow from the equations along the dense output; their polynomial, integrated twice, is a better motion: one
//! sweep of Picard's iteration (1890), which gains at least one order. A second one is not worth its time.
//!
//! It converges where the step is short against all that the equations know, also against what is stiff in them. Where it does not, the
//! dense output stays: a stiff motion inside of a step is as accurate as the stages tell.

use super::dense::Dense;
use super::one_step::Path;
use super::state::State;
use super::system::System;
use super::tolerances::Weights;
use crate::numerics::{Size, Vector};

/// Degree of the polynomials of accelerations for a method of so many stages: what depends on time alone, such as the ground's motion,
/// they follow as well as the end of the step does, by order 2 `stages` − 1.
const fn degree(stages: usize) -> usize {
    match stages {
        7.. => 14,
        _ => 8,
    }
}

/// The highest degree.
const MOST: usize = degree(7);

/// Cosines of multiples of π/8 and of π/14 in a quarter of a turn.
const EIGHTH: [f64; 5] = [
    1.0,
    0.923_879_532_511_286_7,
    std::f64::consts::FRAC_1_SQRT_2,
    0.382_683_432_365_089_8,
    0.0,
];
const FOURTEENTH: [f64; 8] = [
    1.0,
    0.974_927_912_181_823_6,
    0.900_968_867_902_419_1,
    0.781_831_482_468_029_8,
    0.623_489_801_858_733_6,
    0.433_883_739_117_558_2,
    0.222_520_933_956_314_45,
    0.0,
];

/// cos(jπ/n) for one of both degrees n.
fn cosine(n: usize, j: usize) -> f64 {
    let j = j % (2 * n);
    let j = j.min(2 * n - j);
    let quarter = |j: usize| if n == 8 { EIGHTH[j] } else { FOURTEENTH[j] };
    match j <= n / 2 {
        true => quarter(j),
        false => -quarter(n - j),
    }
}

/// A second sweep may change at most this part of what the first has changed: then what the first leaves of the error is no more.
const CONTRACTION: f64 = 0.5;

/// Coefficients of Chebyshev polynomials on the step, x = 2τ/h − 1, of accelerations and of their integrals from the start.
#[derive(Debug, Clone)]
pub(super) struct Refined<F: Size> {
    /// Of the polynomials of accelerations.
    degree: usize,
    /// The step's start and its length, s.
    t0: f64,
    h: f64,
    q0: F::Vector,
    v0: F::Vector,
    a: [F::Vector; MOST + 1],
    /// (v − v₀)/(h/2), and (q − q₀ − τ v₀)/(h/2)².
    v: [F::Vector; MOST + 2],
    q: [F::Vector; MOST + 3],
    /// Accelerations, positions and rates at the points.
    accelerations: [F::Vector; MOST + 1],
    states: [[F::Vector; 2]; MOST + 1],
}

impl<F: Size> Refined<F> {
    /// Room for the motion.
    pub fn nothing(size: F) -> Self {
        let vector = |_| size.zeros();
        Refined {
            degree: 0,
            t0: 0.0,
            h: 0.0,
            q0: size.zeros(),
            v0: size.zeros(),
            a: std::array::from_fn(vector),
            v: std::array::from_fn(vector),
            q: std::array::from_fn(vector),
            accelerations: std::array::from_fn(vector),
            states: std::array::from_fn(|_| [size.zeros(), size.zeros()]),
        }
    }

    /// Refines the dense output of a step between two states; `weights` are reciprocal tolerances. False where that does not converge.
    pub fn refine<const S: usize, Y: System<F>>(
        &mut self,
        system: &mut Y,
        [start, end]: [&State<F>; 2],
        dense: &Dense<S, F>,
        weights: &Weights<F>,
    ) -> bool {
        let n = degree(S);
        (self.degree, self.t0, self.h) = (n, dense.t0, dense.h);
        self.q0.clone_from(&start.q);
        self.v0.clone_from(&start.v);
        self.accelerations[0].clone_from(&start.a);
        self.accelerations[n].clone_from(&end.a);
        let mut times = [0.0; MOST + 1];
        for j in 1..n {
            times[j] = self.t0 + self.offset(j);
            let (q, v, _) = dense.at_offset(self.offset(j));
            self.states[j] = [q, v];
        }
        for j in 1..n {
            let [q, v] = &self.states[j];
            if j % 8 == 1 {
                system.foresee(&times[j..n.min(j + 8)]);
            }
            let a = &mut self.accelerations[j];
            if system.acceleration(times[j], q, v, a).is_err() {
                return false;
            }
        }
        self.integrate();
        // What a second sweep would change is told where the first has changed the most.
        let (mut corrected, mut worst) = (0.0, 1);
        for j in 1..n {
            let [q, v] = &self.states[j];
            let change = weights.distance(self.state(self.offset(j)), (q, v));
            if change > corrected {
                (corrected, worst) = (change, j);
            }
        }
        let (q, v) = self.state(self.offset(worst));
        let mut again = q.size().zeros();
        if system
            .acceleration(times[worst], &q, &v, &mut again)
            .is_err()
        {
            return false;
        }
        // Between the start and the stages the correction changes its sign, and so does what it causes.
        let (first, lobe) = (&self.accelerations[worst], self.h / (S + 1) as f64);
        let left = (0..q.size().get()).map(|i| lobe * (again[i] - first[i]).abs() * weights.v[i]);
        // No number where one is not.
        let converges = left.sum::<f64>() <= CONTRACTION * corrected;
        self.meet(end);
        converges
    }

    /// Adds to the accelerations c₁ s + c₂ s², s = τ/h, so that the motion meets the end of the step: what it missed has grown along the step.
    fn meet(&mut self, end: &State<F>) {
        let (n, h) = (self.degree, self.h);
        let (q, v) = self.state(h);
        for i in 0..q.size().get() {
            let [place, rate] = [(end.q[i] - q[i]) / (h * h), (end.v[i] - v[i]) / h];
            // Their integrals over the step are c₁/2 + c₂/3 and, taken twice, c₁/6 + c₂/12.
            let (c1, c2) = (24.0 * place - 6.0 * rate, 12.0 * rate - 36.0 * place);
            self.a[0][i] += 0.5 * c1 + 0.375 * c2;
            self.a[1][i] += 0.5 * (c1 + c2);
            self.a[2][i] += 0.125 * c2;
            integral(&self.a[..=n], &mut self.v[..=n + 1], i);
            integral(&self.v[..=n + 1], &mut self.q[..=n + 2], i);
        }
    }

    /// Time of a point after the start, s.
    fn offset(&self, j: usize) -> f64 {
        self.h * 0.5 * (1.0 - cosine(self.degree, j))
    }

    /// Finds the polynomials through the accelerations, and their integrals.
    fn integrate(&mut self) {
        let n = self.degree;
        for i in 0..self.q0.size().get() {
            for k in 0..=n {
                // The points ascend, Chebyshev's own descend: Tₖ(−x) = (−1)ᵏ Tₖ(x). The ends count half.
                let mut sum = 0.0;
                for j in 0..=n {
                    let weight = if j == 0 || j == n { 0.5 } else { 1.0 };
                    sum += weight * cosine(n, k * (n - j)) * self.accelerations[j][i];
                }
                self.a[k][i] = sum * if k == 0 || k == n { 1.0 } else { 2.0 } / n as f64;
            }
            integral(&self.a[..=n], &mut self.v[..=n + 1], i);
            integral(&self.v[..=n + 1], &mut self.q[..=n + 2], i);
        }
    }

    /// Position and rates at a time after the start, s.
    fn state(&self, tau: f64) -> (F::Vector, F::Vector) {
        let (x, half) = (2.0 * tau / self.h - 1.0, 0.5 * self.h);
        let size = self.q0.size();
        let q = size.vector(|i| {
            self.q0[i] + (tau * self.v0[i] + half * half * sum(&self.q[..=self.degree + 2], i, x))
        });
        let v = size.vector(|i| self.v0[i] + half * sum(&self.v[..=self.degree + 1], i, x));
        (q, v)
    }
}

/// The integral from the start of a series of Chebyshev polynomials: ∫ Tₖ = (Tₖ₊₁/(k+1) − Tₖ₋₁/(k−1))/2.
fn integral<V: std::ops::IndexMut<usize, Output = f64>>(of: &[V], into: &mut [V], i: usize) {
    let get = |k: usize| of.get(k).map_or(0.0, |c| c[i]);
    let mut at_start = 0.0;
    for k in (1..into.len()).rev() {
        let lower = if k == 1 { 2.0 * get(0) } else { get(k - 1) };
        let c = (lower - get(k + 1)) / (2 * k) as f64;
        into[k][i] = c;
        at_start += if k % 2 == 0 { c } else { -c };
    }
    into[0][i] = -at_start;
}

/// The sum of a series of Chebyshev polynomials (Clenshaw 1955).
fn sum<V: std::ops::Index<usize, Output = f64>>(of: &[V], i: usize, x: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for c in of[1..].iter().rev() {
        (one, two) = (2.0 * x * one - two + c[i], one);
    }
    x * one - two + of[0][i]
}

impl<F: Size> Path<F> for Refined<F> {
    fn start(&self) -> f64 {
        self.t0
    }

    fn at(&self, t: f64) -> (F::Vector, F::Vector, F::Vector) {
        let (q, v) = self.state(t - self.t0);
        let x = 2.0 * (t - self.t0) / self.h - 1.0;
        let a = q.size().vector(|i| sum(&self.a[..=self.degree], i, x));
        (q, v, a)
    }

    fn state_at(&self, t: f64) -> (F::Vector, F::Vector) {
        self.state(t - self.t0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::{Const, Radau, Tolerances};
    use nalgebra::{SMatrix, SVector};

    #[test]
    fn cosines_are_cosines() {
        for n in [degree(5), degree(7)] {
            for j in 0..=4 * n {
                let exact = (j as f64 * std::f64::consts::PI / n as f64).cos();
                assert!((cosine(n, j) - exact).abs() < 4e-15, "{j} of {n}");
            }
        }
    }

    /// a = sin ωt − λ v, of one coordinate.
    struct Forced {
        omega: f64,
        lambda: f64,
    }

    type One = SVector<f64, 1>;
    type Square = SMatrix<f64, 1, 1>;

    impl System<Const<1>> for Forced {
        fn residual(&mut self, t: f64, _: &One, v: &One, a: &One, r: &mut One) {
            r[0] = a[0] + self.lambda * v[0] - (self.omega * t).sin();
        }

        fn jacobian(
            &mut self,
            _: f64,
            _: &One,
            _: &One,
            _: &One,
            m: &mut Square,
            c: &mut Square,
            k: &mut Square,
        ) {
            (m[0], c[0], k[0]) = (1.0, self.lambda, 0.0);
        }
    }

    /// A step of length 1 from rest, and whether its path is another than its dense output; largest differences of both from
    /// the rate v = ∫ sin ωt.
    fn step(omega: f64, lambda: f64) -> (bool, [f64; 2]) {
        let mut system = Forced { omega, lambda };
        let one = One::repeat(1.0);
        let tolerances = Tolerances::<Const<1>>::new(1e-13, one * 1e-13, one * 1e-13).unwrap();
        let mut radau = Radau::<7, Const<1>>::new(&tolerances);
        let zero = One::zeros();
        radau.restart(0.0, &zero, &zero, &zero);
        radau.step_exactly(&mut system, 1.0).unwrap();
        let dense = radau.dense().unwrap().clone();
        let path = radau.path(&mut system);
        let (mut differs, mut off) = (false, [0.0; 2]);
        for j in 0..=100 {
            let t = f64::from(j) / 100.0;
            let exact = (1.0 - (omega * t).cos()) / omega;
            let [(q, v, _), (own_q, own_v, _)] = [dense.at(t), path.at(t)];
            differs |= q != own_q || v != own_v;
            for (off, v) in off.iter_mut().zip([v, own_v]) {
                *off = f64::max(*off, (v[0] - exact).abs());
            }
        }
        let (q, v, _) = path.at(1.0);
        let end = radau.state();
        assert!((q[0] - end.q[0]).abs() < 1e-15 && (v[0] - end.v[0]).abs() < 1e-15);
        (differs, off)
    }

    #[test]
    fn a_path_follows_what_its_dense_output_does_not() {
        let (differs, [dense, path]) = step(1.5, 0.0);
        assert!(
            differs && dense > 1e-9 && path < 1e-13,
            "{dense:e} {path:e}"
        );
    }

    #[test]
    fn a_stiff_step_keeps_its_dense_output() {
        let (differs, _) = step(3.0, 1e4);
        assert!(!differs);
    }
}
