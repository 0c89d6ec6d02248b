//! Extremes of coordinates and velocities of trajectories side by side.
//!
//! A bound tells of most steps that they have none inside: where a rate keeps its sign, or no term of the series leads beyond
//! the extremes so far. In the others the polynomial of the step is looked at, a lane for itself.

use super::super::instant::Instant;
use super::super::observe::Observers;
use super::super::roots::Polynomial;
use super::group::Group;
use crate::integrate::{LaneMask, ORDERS};
use crate::kernel::{lane_may_exceed, lane_note};
use crate::run::Peak;

impl<const F: usize, const W: usize> Group<'_, F, W> {
    /// Takes note of a step to `next` in lanes that make it: its end, and what is beyond both ends within.
    pub fn find_extremes(&mut self, made: LaneMask) {
        let Some(extremes) = &mut self.extremes else {
            return;
        };
        let (level, order) = (self.level, self.taylor.order());
        let tau = &self.way.durations[0];
        let inside = lane_may_exceed(level, order, &self.taylor.series, tau, extremes);
        for lane in (inside & made).lanes() {
            self.find_extremes_within(lane);
        }
        if let Some(extremes) = &mut self.extremes {
            lane_note(level, made, &self.next, extremes);
        }
    }

    /// Takes note of the present state, after a transition, in some lanes.
    pub fn note_here(&mut self, lanes: LaneMask) {
        if let Some(extremes) = &mut self.extremes {
            lane_note(self.level, lanes, &self.here, extremes);
        }
    }

    /// Takes note of the extrema of all polynomials of a step of a lane.
    #[cold]
    fn find_extremes_within(&mut self, lane: usize) {
        let Some(extremes) = &mut self.extremes else {
            return;
        };
        let [high, low] = &self.here.t;
        let start = Instant::of_parts([high.0[lane], low.0[lane]]);
        let tau = self.way.durations[0].0[lane];
        let (series, order) = (&self.taylor.series, self.taylor.order());
        for i in 0..2 * F {
            let (rows, count, i_of) = match i < F {
                true => (&series.q, order + 2, i),
                false => (&series.v, order + 1, i - F),
            };
            let mut coefficients = [0.0; ORDERS];
            let mut power = 1.0;
            for (own, row) in coefficients.iter_mut().zip(&rows[..count]) {
                *own = row[i_of].0[lane] * power;
                power *= tau;
            }
            let own = &mut extremes[4 * i..4 * i + 4];
            if !may_exceed(&coefficients, [own[0].0[lane], own[1].0[lane]]) {
                continue;
            }
            let polynomial = Polynomial { coefficients };
            polynomial.each_extremum(|place, value| {
                let t = start.plus(place * tau).seconds();
                if value < own[0].0[lane] {
                    (own[0].0[lane], own[2].0[lane]) = (value, t);
                }
                if value > own[1].0[lane] {
                    (own[1].0[lane], own[3].0[lane]) = (value, t);
                }
            });
        }
    }

    /// Takes over the extremes that a trajectory has had so far.
    pub fn load_extremes(&mut self, lane: usize, from: &Observers) {
        let Some(extremes) = &mut self.extremes else {
            return;
        };
        let columns = columns(&self.mode.free, from.layout.coordinates.len());
        for (own, column) in extremes.chunks_exact_mut(4).zip(columns) {
            let Peak {
                min,
                max,
                t_min,
                t_max,
            } = from.peak(column);
            for (own, value) in own.iter_mut().zip([min, max, t_min, t_max]) {
                own.0[lane] = value;
            }
        }
    }

    /// Gives a trajectory the extremes that it has had in its lane.
    pub fn unload_extremes(&self, lane: usize, into: &mut Observers) {
        let Some(extremes) = &self.extremes else {
            return;
        };
        let columns = columns(&self.mode.free, into.layout.coordinates.len());
        for (own, column) in extremes.chunks_exact(4).zip(columns) {
            let [min, max, t_min, t_max] = [0, 1, 2, 3].map(|k| own[k].0[lane]);
            into.note(column, t_min, min);
            into.note(column, t_max, max);
        }
    }
}

/// Whether Σ cₖ sᵏ, 0 < s < 1, may turn and be beyond what was the least and the greatest value.
fn may_exceed(c: &[f64; ORDERS], [least, greatest]: [f64; 2]) -> bool {
    let above: f64 = c[1..].iter().map(|c| c.max(0.0)).sum();
    let below: f64 = c[1..].iter().map(|c| c.min(0.0)).sum();
    let slopes: f64 = (2..)
        .zip(&c[2..])
        .map(|(k, c)| f64::from(k) * c.abs())
        .sum();
    let bends: f64 = (3..)
        .zip(&c[3..])
        .map(|(k, c)| f64::from(k * (k - 1)) * c.abs())
        .sum();
    let bend = if 2.0 * c[2].abs() > bends { c[2] } else { 0.0 };
    let is_inside =
        (bend < 0.0 || least <= c[0] + below) && (bend > 0.0 || c[0] + above <= greatest);
    !is_inside && c[1].abs() <= slopes
}

/// Columns of free coordinates, then of their rates, among so many coordinates that are recorded.
fn columns(free: &[usize], coordinates: usize) -> impl Iterator<Item = usize> {
    free.iter()
        .copied()
        .chain(free.iter().map(move |i| coordinates + i))
}
