//! The Taylor method for trajectories side by side: the formulas of [`super::Taylor`], lane by lane.

use super::length::{self, Terms};
use crate::kernel::{
    LANE_ROWS, LaneGuard, LaneLevel, LaneLimits, LanePoint, LaneSeries, LaneSystem, lane_begin,
    lane_cross, lane_end, lane_first_crossing, lane_length, lane_start,
};
use crate::numerics::{LaneMask, Lanes, ORDERS, SeriesKind};

/// The last step of `W` trajectories of a mode with `F` free coordinates.
pub(crate) struct LaneTaylor<const F: usize, const W: usize> {
    /// Coefficients about the start of the step.
    pub series: LaneSeries<F, W>,
    level: LaneLevel<W>,
    limits: LaneLimits,
    /// Whether the method of a single trajectory has a lower order where there are many steps.
    has_lower_order: bool,
}

impl<const F: usize, const W: usize> LaneTaylor<F, W> {
    /// A method of the order that [`super::Taylor::new`] chooses for a relative tolerance, or of a lower one.
    pub fn new(level: LaneLevel<W>, relative: f64, kind: SeriesKind, lower: Option<usize>) -> Self {
        let rows = [[Lanes::of(0.0); F]; LANE_ROWS];
        let own = length::order(relative, kind, F);
        let order = lower.map_or(own, |lower| lower.min(own));
        let terms = Terms::new(relative, order, kind);
        LaneTaylor {
            series: LaneSeries {
                q: rows,
                v: rows,
                a: rows,
            },
            level,
            has_lower_order: length::half_period(relative, kind).is_some(),
            limits: LaneLimits {
                order,
                terms: [
                    terms.powers.map(|n| 1.0 / n as f64),
                    terms.powers.map(|n| 0.5 - 0.5 / n as f64),
                    terms.offsets.map(|offset| offset as f64),
                ],
            },
        }
    }

    /// Order of the method.
    pub fn order(&self) -> usize {
        self.limits.order
    }

    /// Sets coordinates and velocities at the start of the step.
    #[inline]
    pub fn start_at(&mut self, point: &LanePoint<F, W>) {
        lane_start(self.level, point, &mut self.series);
    }

    /// Sets accelerations, and all that follows from the state without the series, and the inverses of the
    /// mass matrices. See [`lane_begin`].
    #[inline]
    pub fn begin(
        &mut self,
        point: &LanePoint<F, W>,
        at_start: LaneMask,
        system: &LaneSystem<F, W>,
        inverse: &mut [[Lanes<W>; F]; F],
    ) -> LaneMask {
        let series = &mut self.series;
        lane_begin(self.level, point, at_start, system, series, inverse)
    }

    /// The length of the step, as a step of [`super::Taylor`], with these tolerances (the relative one, then the absolute ones of
    /// coordinates and velocities): see [`lane_length`].
    #[inline]
    pub fn length(
        &self,
        point: &LanePoint<F, W>,
        (limits, tolerances): ([&Lanes<W>; 2], &[Lanes<W>]),
        to: (&mut Lanes<W>, &mut LaneMask),
    ) -> LaneMask {
        let (h, unclear) = to;
        let to = (&mut *h, &mut *unclear);
        let own = (&self.limits, tolerances);
        let reached = lane_length(self.level, own, &self.series, point, limits, to);
        if self.has_lower_order {
            // Twice as soon: what decides is the single trajectory.
            let [last, horizon] = limits;
            let limit = |i: usize| (last.0[i] - point.t[0].0[i]).min(horizon.0[i]);
            for i in (0..W).filter(|&i| 0.5 * length::MANY * h.0[i] < limit(i)) {
                unclear.set(i, true);
            }
        }
        reached
    }

    /// The point that the step from a point leads to in the durations `tau`, s.
    #[inline]
    pub fn end(&self, point: &LanePoint<F, W>, tau: &Lanes<W>, to: &mut LanePoint<F, W>) {
        lane_end(self.level, self.order(), &self.series, point, tau, to);
    }

    /// Looks for the first fall of a guard that is coordinate `index` or its rate times a factor and an
    /// offset: see [`lane_first_crossing`]. Gives the number of coefficients, too.
    #[inline]
    pub fn first_crossing(
        &self,
        (index, rate): (usize, bool),
        h: &Lanes<W>,
        guard: &LaneGuard<W>,
        coefficients: &mut [Lanes<W>; ORDERS],
        place: &mut Lanes<W>,
    ) -> ([LaneMask; 2], usize) {
        let rows = match rate {
            false => &self.series.q[..self.order() + 2],
            true => &self.series.v[..self.order() + 1],
        };
        let (count, which) = (rows.len(), (F, index));
        let rows = (rows.as_flattened(), count);
        let found = lane_first_crossing(self.level, rows, which, h, guard, coefficients, place);
        (found, count)
    }

    /// Moves the end of the step, from `point`, beyond the zero of such a guard in some lanes: see
    /// [`lane_cross`].
    #[inline]
    pub fn cross(
        &self,
        point: &LanePoint<F, W>,
        (index, rate): (usize, bool),
        guard: &LaneGuard<W>,
        lanes: LaneMask,
        durations: &mut [Lanes<W>; 3],
    ) {
        let (rows, count) = match rate {
            false => (&self.series.q, self.order() + 2),
            true => (&self.series.v, self.order() + 1),
        };
        let lost = &point.lost[usize::from(rate)][index];
        lane_cross(
            self.level,
            (rows, index),
            count,
            lost,
            guard,
            lanes,
            durations,
        );
    }
}
