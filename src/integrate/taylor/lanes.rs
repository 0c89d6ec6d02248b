//! The Taylor method for trajectories side by side: the formulas of [`super::Taylor`], lane by lane.

use super::super::lanes::{LaneMask, Lanes};
use super::super::state::add;
use super::super::tolerances::Tolerances;
use super::length;
use super::series::ORDERS;
use crate::kernel::{LaneSeries, lane_first_fall, lane_length, lane_sum};

/// The last step of `W` trajectories of a mode with `F` free coordinates.
#[derive(Debug, Clone)]
pub struct LaneTaylor<const F: usize, const W: usize> {
    /// Coefficients about the start of the step.
    pub series: LaneSeries<F, W>,
    /// Level of the processor, as in [`crate::kernel::LANES_OF_LEVELS`].
    level: usize,
    order: usize,
    /// The relative tolerance, and the absolute ones of coordinates and velocities.
    tolerances: Box<[f64]>,
    /// Factors of the earlier terms.
    factors: [f64; 2],
}

impl<const F: usize, const W: usize> LaneTaylor<F, W> {
    /// A method of the order that [`super::Taylor::new`] chooses.
    pub fn new(level: usize, tolerances: &Tolerances<F>, convolutions: usize) -> Self {
        let rows = [[Lanes::of(0.0); F]; ORDERS];
        let relative = tolerances.relative();
        let absolute = [tolerances.q_absolute(), tolerances.v_absolute()];
        let absolute = absolute.into_iter().flat_map(|all| all.iter().copied());
        let order = length::order(relative, convolutions, F);
        LaneTaylor {
            factors: length::earlier_terms(relative, order, convolutions)
                .map(|term| term.factor.value()),
            series: LaneSeries {
                q: rows,
                v: rows,
                a: rows,
            },
            level,
            order,
            tolerances: std::iter::once(relative).chain(absolute).collect(),
        }
    }

    /// Order of the method.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Whether the coefficients of a lane are finite.
    #[inline]
    pub fn is_finite(&self, lane: usize) -> bool {
        let last = &self.series.a[self.order - 1];
        last.iter().all(|a| a.0[lane].is_finite())
    }

    /// The length at which the last terms equal the tolerance, but not more than `remaining` and
    /// `horizon`: as a step of [`super::Taylor`].
    #[inline]
    pub fn length(&self, remaining: &Lanes<W>, horizon: &Lanes<W>) -> Lanes<W> {
        let limits = [remaining, horizon];
        lane_length(
            self.level,
            self.order,
            &self.series,
            (&self.tolerances, &self.factors),
            limits,
        )
    }

    /// Coordinates and velocities at τ, with what rounding lost before the step and loses in it.
    #[inline]
    pub fn state(
        &self,
        tau: &Lanes<W>,
        lost: &[[Lanes<W>; F]; 2],
    ) -> ([[Lanes<W>; F]; 2], [[Lanes<W>; F]; 2]) {
        let LaneSeries { q, v, .. } = &self.series;
        let p = self.order;
        let mut state = [q[0], v[0]];
        let mut lost_now = *lost;
        for i in 0..F {
            let changes = [&q[1..p + 2], &v[1..p + 1]];
            for (x, rows) in changes.into_iter().enumerate() {
                let change = lane_sum(self.level, rows, i, tau) * *tau;
                for lane in 0..W {
                    (state[x][i].0[lane], lost_now[x][i].0[lane]) =
                        add(state[x][i].0[lane], change.0[lane], lost[x][i].0[lane]);
                }
            }
        }
        (state, lost_now)
    }

    /// Accelerations at τ.
    #[inline]
    pub fn acceleration(&self, tau: &Lanes<W>) -> [Lanes<W>; F] {
        let rows = &self.series.a[..self.order];
        std::array::from_fn(|i| lane_sum(self.level, rows, i, tau))
    }

    /// The first fall of factor · x + offset on 0 < τ ≤ h, with x coordinate `index` or its rate: see
    /// [`lane_first_fall`]. Gives the number of coefficients, too.
    #[inline]
    pub fn first_fall(
        &self,
        (index, rate): (usize, bool),
        [h, factor, offset]: [&Lanes<W>; 3],
        starts_at_zero: &LaneMask<W>,
        coefficients: &mut [Lanes<W>; ORDERS],
    ) -> (Lanes<W>, usize) {
        let rows = match rate {
            false => &self.series.q[..self.order + 2],
            true => &self.series.v[..self.order + 1],
        };
        let numbers = [h, factor, offset];
        let rows_of = (rows, index);
        let fall = lane_first_fall(self.level, rows_of, numbers, starts_at_zero, coefficients);
        (fall, rows.len())
    }
}
