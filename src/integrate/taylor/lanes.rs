//! The Taylor method for trajectories side by side: the formulas of [`super::Taylor`], lane by lane.

use super::super::lanes::Lanes;
use super::super::logarithm::{binary_logarithm, binary_power};
use super::super::state::{add, fit};
use super::super::tolerances::Tolerances;
use super::length;
use super::series::ORDERS;
use crate::kernel::LaneSeries;

/// The last step of `W` trajectories of a mode with `F` free coordinates.
#[derive(Debug, Clone)]
pub struct LaneTaylor<const F: usize, const W: usize> {
    /// Coefficients about the start of the step.
    pub series: LaneSeries<F, W>,
    order: usize,
    tolerances: Tolerances<F>,
}

impl<const F: usize, const W: usize> LaneTaylor<F, W> {
    /// A method of the order that [`super::Taylor::new`] chooses.
    pub fn new(tolerances: &Tolerances<F>, convolutions: usize) -> Self {
        let rows = [[Lanes::of(0.0); F]; ORDERS];
        LaneTaylor {
            series: LaneSeries {
                q: rows,
                v: rows,
                a: rows,
            },
            order: length::order(tolerances.relative(), convolutions, F),
            tolerances: *tolerances,
        }
    }

    /// Order of the method.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Whether the coefficients of a lane are finite.
    #[inline(always)]
    pub fn is_finite(&self, lane: usize) -> bool {
        let last = &self.series.a[self.order - 1];
        last.iter().all(|a| a.0[lane].is_finite())
    }

    /// The length at which the last terms equal the tolerance, but not more than `remaining` and
    /// `horizon`: as a step of [`super::Taylor`].
    #[inline(always)]
    pub fn length(&self, remaining: &Lanes<W>, horizon: &Lanes<W>) -> Lanes<W> {
        let LaneSeries { q, v, .. } = &self.series;
        let p = self.order;
        let mut sizes = [Lanes::of(0.0); 3];
        for i in 0..F {
            let relative = self.tolerances.relative();
            let [of_q, of_v] = [
                (&q[0][i], self.tolerances.q_absolute()[i]),
                (&v[0][i], self.tolerances.v_absolute()[i]),
            ]
            .map(|(x, absolute)| x.map(|x| 1.0 / (absolute + relative * x.abs())));
            sizes[0] = (v[p - 1][i].abs() * of_v).max(sizes[0]);
            sizes[1] = (v[p][i].abs() * of_v).max(sizes[1]);
            sizes[1] = (q[p][i].abs() * of_q).max(sizes[1]);
            sizes[2] = (q[p + 1][i].abs() * of_q).max(sizes[2]);
        }
        let inverses = [p - 1, p, p + 1].map(|power| -1.0 / power as f64);
        Lanes::from_fn(|lane| {
            let mut logarithm = f64::INFINITY;
            for k in 0..3 {
                let size = sizes[k].0[lane];
                if size >= f64::MIN_POSITIVE {
                    logarithm = logarithm.min(binary_logarithm(size) * inverses[k]);
                }
            }
            let length = match logarithm < f64::INFINITY {
                true => binary_power(logarithm),
                false => f64::INFINITY,
            };
            fit(length, remaining.0[lane], horizon.0[lane])
        })
    }

    /// Coordinates and velocities at τ, with what rounding lost before the step and loses in it.
    #[inline(always)]
    pub fn state(
        &self,
        tau: Lanes<W>,
        lost: &[[Lanes<W>; F]; 2],
    ) -> ([[Lanes<W>; F]; 2], [[Lanes<W>; F]; 2]) {
        let LaneSeries { q, v, .. } = &self.series;
        let p = self.order;
        let mut state = [q[0], v[0]];
        let mut lost_now = *lost;
        for i in 0..F {
            let dq = sum(&q[1..p + 2], i, tau) * tau;
            let dv = sum(&v[1..p + 1], i, tau) * tau;
            for (x, change) in [dq, dv].into_iter().enumerate() {
                for lane in 0..W {
                    (state[x][i].0[lane], lost_now[x][i].0[lane]) =
                        add(state[x][i].0[lane], change.0[lane], lost[x][i].0[lane]);
                }
            }
        }
        (state, lost_now)
    }

    /// Accelerations at τ.
    #[inline(always)]
    pub fn acceleration(&self, tau: Lanes<W>) -> [Lanes<W>; F] {
        std::array::from_fn(|i| sum(&self.series.a[..self.order], i, tau))
    }

    /// Writes the coefficients of coordinate `index`, or of its rate, in powers of τ/h; gives their
    /// number.
    #[inline(always)]
    pub fn scaled(
        &self,
        index: usize,
        rate: bool,
        h: Lanes<W>,
        out: &mut [Lanes<W>; ORDERS],
    ) -> usize {
        let (rows, count) = match rate {
            false => (&self.series.q, self.order + 2),
            true => (&self.series.v, self.order + 1),
        };
        let mut power = Lanes::of(1.0);
        for k in 0..count {
            out[k] = rows[k][index] * power;
            power = power * h;
        }
        count
    }
}

/// Σ c_k τᵏ, in powers of τ⁴ for every fourth coefficient (Estrin 1960).
#[inline(always)]
fn sum<const F: usize, const W: usize>(
    coefficients: &[[Lanes<W>; F]],
    i: usize,
    tau: Lanes<W>,
) -> Lanes<W> {
    let (fours, rest) = coefficients.as_chunks::<4>();
    let mut sums = [Lanes::of(0.0); 4];
    for (sum, rest) in sums.iter_mut().zip(rest) {
        *sum = rest[i];
    }
    let tau2 = tau * tau;
    let tau4 = tau2 * tau2;
    for four in fours.iter().rev() {
        for (sum, coefficient) in sums.iter_mut().zip(four) {
            *sum = *sum * tau4 + coefficient[i];
        }
    }
    (sums[0] + sums[1] * tau) + (sums[2] + sums[3] * tau) * tau2
}
