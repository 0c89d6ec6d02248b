//! How a guard that is exactly zero at the start of a segment leaves zero where that takes no bounds of roundings: a coordinate by
//! its rate, and what is linear by accelerations that are far more than their rounding.

use super::departure::{CLEAR, Departure, outweighs_for};
use super::guards::Linear;
use super::simulation::Simulation;
use super::solvers::{SlotsOf, Solvers};
use crate::integrate::{Series, Size, Vector};
use crate::jets::ORDERS;
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::Guard;
use crate::numerics::Lu;

/// The state at the start of a segment.
pub(super) struct Start<'a, F: Size> {
    pub kernel: &'a ModeKernel<F>,
    /// Its mass matrix.
    pub mass: &'a Lu<f64, F>,
    /// Free coordinates and velocities.
    pub at: [&'a F::Vector; 2],
    /// When that is, s.
    pub t: f64,
}

/// How a guard leaves zero.
pub(super) enum Leaves {
    /// As its rate or its acceleration says, and a rise shows on the dense output of every method.
    At(Departure),
    /// It rises as the acceleration of a free coordinate does, by the derivative of this order: on the dense output of the Taylor
    /// method it shows.
    BySeries { coordinate: usize, order: usize },
}

impl<F: Size> Start<'_, F> {
    /// How a guard that is exactly zero leaves zero; `None`: that takes an expansion with bounds.
    pub fn leaves(&self, context: &Context, guard: &Guard, a: &F::Vector) -> Option<Leaves> {
        let [q, v] = self.at;
        let Linear {
            index,
            rate,
            factor,
            ..
        } = Linear::of(guard.shape, context)?;
        if !rate && v[index] != 0.0 {
            return Some(Leaves::At(match factor * v[index] > 0.0 {
                true => Departure::Up {
                    order: 1,
                    until: 0.0,
                },
                false => Departure::Down { order: 1 },
            }));
        }
        let inverse = self.mass.inverted();
        let size = self.kernel.magnitude(context, Free { q, v, a });
        let terms: f64 = (0..size.size().get())
            .map(|j| inverse[(index, j)].abs() * size[j])
            .sum();
        let is_clear = a[index].abs() > CLEAR * terms && self.are_signals_clear(context);
        if !is_clear || factor == 0.0 {
            return None;
        }
        let order = if rate { 1 } else { 2 };
        Some(match factor * a[index] > 0.0 {
            true => Leaves::BySeries {
                coordinate: index,
                order,
            },
            false => Leaves::At(Departure::Down { order }),
        })
    }

    /// Whether no signal is so close to zero that the rounding of the time makes it: then its value is no evidence of its sign.
    fn are_signals_clear(&self, context: &Context) -> bool {
        let values = context.signals().iter();
        values
            .zip(context.signal_rates())
            .all(|(value, rate)| value.abs() >= CLEAR * (rate * self.t).abs())
    }
}

impl<'p> Simulation<'p> {
    /// For how long the rise of a coordinate from its place, or of its rate where the first derivative tells of it, is known to last, s, by the
    /// series of the mode from a start with the accelerations `a`; `None` where what is held drifts.
    pub fn rises_for<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        (start, a): (&Start<F>, &F::Vector),
        (coordinate, order): (usize, usize),
    ) -> Option<f64>
    where
        Solvers: SlotsOf<F>,
    {
        // What drifts is in no series of the mode.
        if self.plan.moves[self.here.mode] {
            return None;
        }
        let now = self.here.now.seconds();
        let within = self.smooth_from(now);
        let context = &mut self.context;
        context.expand_signals(&self.signals, now, ORDERS);
        let size = kernel.size();
        let room = &mut self.solvers.slots().series;
        let series = match room {
            Some(series) if series.size() == size => series,
            _ => room.insert(Box::new(Series::zero(size))),
        };
        let [q, v] = start.at;
        for i in 0..size.get() {
            (series.q[0][i], series.v[0][i], series.a[0][i]) = (q[i], v[i], a[i]);
            (series.q[1][i], series.v[1][i], series.q[2][i]) = (v[i], a[i], a[i] * 0.5);
        }
        kernel.series_start(context, series);
        kernel.series_run(context, ORDERS - 1, &start.mass.inverted(), series);
        let rows = if order == 1 { &series.v } else { &series.q };
        let others = (order + 1..ORDERS).map(|k| rows[k][coordinate].abs());
        Some(outweighs_for(rows[order][coordinate].abs(), others, within))
    }
}
