//! Seven bodies with close encounters, by the Taylor method: the recurrences of
//! r⁻³ and of its products, written by hand.

use crate::problems::Pleiades;
use crate::references::{data, numbers};
use crate::tolerances;
use dalembert::integrate::{Analytic, ORDERS, Series, SeriesKind, State, System, Taylor};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector};

/// Coefficients of (dx, dy) and r⁻³ of each pair of bodies i < j.
#[derive(Clone, Copy)]
struct Pair {
    bodies: [usize; 2],
    distance: [[f64; ORDERS]; 2],
    squared: [f64; ORDERS],
    inverse_cubed: [f64; ORDERS],
}

/// The bodies with the series of all pairs.
struct Expanded {
    bodies: Pleiades,
    pairs: Vec<Pair>,
}

impl Expanded {
    fn new() -> Self {
        let pairs = (0..7).flat_map(|i| (i + 1..7).map(move |j| [i, j]));
        let zero = [0.0; ORDERS];
        let pair = |bodies| Pair {
            bodies,
            distance: [zero; 2],
            squared: zero,
            inverse_cubed: zero,
        };
        Expanded {
            bodies: Pleiades,
            pairs: pairs.map(pair).collect(),
        }
    }

    /// Accelerations of order `k` from coordinates up to order `k`.
    fn pull(&mut self, k: usize, q: &[SVector<f64, 14>; ORDERS]) -> SVector<f64, 14> {
        let mut a = SVector::zeros();
        for pair in &mut self.pairs {
            let [i, j] = pair.bodies;
            let product = |a: &[f64; ORDERS], b: &[f64; ORDERS]| -> f64 {
                (0..=k).map(|l| a[l] * b[k - l]).sum()
            };
            for axis in 0..2 {
                pair.distance[axis][k] = q[k][7 * axis + j] - q[k][7 * axis + i];
            }
            let [dx, dy] = &pair.distance;
            pair.squared[k] = product(dx, dx) + product(dy, dy);
            // s = d^(−3/2): d s′ = −(3/2) s d′ (Jorba and Zou 2005, proposition 2.1).
            let (d, s) = (&pair.squared, &mut pair.inverse_cubed);
            s[k] = match k {
                0 => 1.0 / (d[0] * d[0].sqrt()),
                _ => {
                    let term = |l: usize| (-1.5 * (k - l) as f64 - l as f64) * d[k - l] * s[l];
                    (0..k).map(term).sum::<f64>() / (k as f64 * d[0])
                }
            };
            for axis in 0..2 {
                let pull = product(&pair.distance[axis], &pair.inverse_cubed);
                a[7 * axis + i] += (j + 1) as f64 * pull;
                a[7 * axis + j] -= (i + 1) as f64 * pull;
            }
        }
        a
    }
}

impl System<Const<14>> for Expanded {
    fn residual(
        &mut self,
        t: f64,
        q: &SVector<f64, 14>,
        v: &SVector<f64, 14>,
        a: &SVector<f64, 14>,
        r: &mut SVector<f64, 14>,
    ) {
        self.bodies.residual(t, q, v, a, r);
    }
    fn jacobian(
        &mut self,
        t: f64,
        q: &SVector<f64, 14>,
        v: &SVector<f64, 14>,
        a: &SVector<f64, 14>,
        m: &mut SMatrix<f64, 14, 14>,
        c: &mut SMatrix<f64, 14, 14>,
        k: &mut SMatrix<f64, 14, 14>,
    ) {
        self.bodies.jacobian(t, q, v, a, m, c, k);
    }
}

impl Analytic<Const<14>> for Expanded {
    fn start(
        &mut self,
        _t: f64,
        _order: usize,
        series: &Series<Const<14>>,
    ) -> (SMatrix<f64, 14, 14>, SVector<f64, 14>) {
        (SMatrix::identity(), -self.pull(0, &series.q))
    }
    fn run(&mut self, n: usize, _inverse: &SMatrix<f64, 14, 14>, series: &mut Series<Const<14>>) {
        for k in 1..n {
            let a = self.pull(k, &series.q);
            series.a[k] = a;
            series.v[k + 1] = a / (k + 1) as f64;
            series.q[k + 2] = series.v[k + 1] / (k + 2) as f64;
        }
    }
}

/// The state at t = 3 and the number of steps.
fn motion(relative: f64) -> (State<Const<14>>, u64) {
    let mut bodies = Expanded::new();
    let (q, v) = (SVector::from(Pleiades::Q), SVector::from(Pleiades::V));
    let mut a = SVector::zeros();
    bodies.acceleration(0.0, &q, &v, &mut a).unwrap();
    // Products of an order: six a pair.
    let mut taylor = Taylor::<Const<14>>::new(
        &tolerances(relative, 0.1, 0.1),
        SeriesKind::Convolved(6 * 21),
    );
    taylor.restart(0.0, &q, &v, Some(&a));
    while taylor.state().t < 3.0 {
        taylor.step(&mut bodies, 3.0, f64::INFINITY).unwrap();
    }
    (*taylor.state(), taylor.take_counters().steps)
}

#[test]
fn close_encounters_by_the_taylor_method() {
    let reference: SVector<f64, 28> = numbers(&data("ivp_testset.json")["pleiades"]["y"]);
    for relative in [1e-4_f64, 1e-7, 1e-10, 1e-13] {
        let (end, steps) = motion(relative);
        let found = SVector::<f64, 28>::from_iterator(end.q.iter().chain(end.v.iter()).copied());
        let digits = -(found - reference).component_div(&reference).amax().log10();
        // The reference demands two digits less than the tolerance's; found: 1.55 less at 1e-4.
        assert!(digits >= -relative.log10() - 2.0, "{relative:e}: {digits}");
        // By the order, which follows the tolerance: 17 to 26.
        assert!(steps < 300, "{relative:e}: {steps} steps");
    }
}
