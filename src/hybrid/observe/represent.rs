//! The representation of a step's functions by polynomials, as good as the tolerance asks for.

use super::interpolants::{DEGREES, MOST, point};
use super::{Functions, Observers, Part, Step};
use crate::hybrid::guards;
use crate::kernel::Free;
use crate::numerics::Size;
use crate::numerics::Vector;

impl Observers<'_> {
    /// Fits polynomials to all functions in a part of a step; false: they do not represent them.
    pub(super) fn represent<F: Size>(
        &mut self,
        step: &mut Step<F>,
        part: Part,
        (columns, powers): (usize, bool),
    ) -> bool {
        // Where nothing moves and nothing acts all nodes have the same values.
        let stands = step.equations.kernel.size().get() == 0
            && step.equations.context.autonomous
            && step.equations.clock.drift.is_empty();
        if !self.joined {
            self.evaluate(step, part.from, 0, (columns, powers));
        }
        let mut before = MOST + 1;
        for degree in DEGREES {
            let stride = MOST / degree;
            for node in (stride..=MOST).step_by(stride) {
                // Those of the degree before are known.
                if node % before == 0 {
                    continue;
                }
                match stands {
                    true => self.interpolants.copy_values(0, node),
                    false => self.evaluate(step, part.time(point(node)), node, (columns, powers)),
                }
            }
            before = stride;
            self.interpolants.fit(degree);
            if self.is_resolved(part, (columns, powers)) {
                return true;
            }
        }
        // Extremes are not worth smaller parts: their values are those of the motion in any case.
        !powers || self.work_is_resolved(part, columns)
    }

    pub(super) fn is_resolved(&self, part: Part, (columns, powers): (usize, bool)) -> bool {
        let open = self.extremes.as_ref().is_some_and(|extremes| {
            let mut of = self.functions.columns.iter().enumerate();
            of.any(|(f, &column)| {
                let rate = self.functions.rate_of(f);
                // The stored energy is a sum of two, which may be far larger.
                let scale = match column == extremes.energies.start {
                    true => self.energy,
                    false => 0.0,
                };
                let of = (rate, scale);
                extremes.is_open(&self.interpolants, f, column, self.tolerance, of)
            })
        });
        !open && (!powers || self.work_is_resolved(part, columns))
    }

    /// Whether the powers are represented to the tolerance, or their work to the rounding of the energies.
    pub(super) fn work_is_resolved(&self, part: Part, columns: usize) -> bool {
        let of = &self.interpolants;
        let least = f64::EPSILON * self.energy;
        (columns..columns + 2).all(|f| {
            let error = of.error(f);
            error <= self.tolerance * of.size(f) || error * (part.to - part.from) <= least
        })
    }

    /// Evaluates all functions at local time `tau` of the step, into the values at `node`.
    pub(super) fn evaluate<F: Size>(
        &mut self,
        step: &mut Step<F>,
        tau: f64,
        node: usize,
        (columns, powers): (usize, bool),
    ) {
        let Functions {
            reactions,
            outputs,
            stored,
            room,
            free,
            dependent,
            ..
        } = &mut self.functions;
        let accelerated = powers || columns > 0 && (!reactions.is_empty() || *outputs > 0);
        let [q, v, a] = guards::motion(step.equations, step.motion, tau, accelerated);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let (kernel, context) = (step.equations.kernel, &*step.equations.context);
        let row = self.interpolants.values_mut(node);
        let n = *free;
        if columns > 0 {
            row[..n].copy_from_slice(&q.as_slice()[..n]);
            row[n..2 * n].copy_from_slice(&v.as_slice()[..n]);
            if !reactions.is_empty() {
                let room = &mut room[..self.layout.reactions.len()];
                self.outputs.reactions(kernel, context, at, room);
                for (value, &i) in row[2 * n..].iter_mut().zip(&*reactions) {
                    *value = room[i];
                }
            }
            if *outputs > 0 {
                let row = &mut row[2 * n + reactions.len()..][..*outputs];
                self.outputs.evaluate(kernel, context, at, row);
            }
            if !dependent.is_empty() {
                let all = &mut room[..step.here.q.len()];
                let row = &mut row[2 * n + reactions.len() + *outputs..];
                let (places, rates) = row.split_at_mut(dependent.len());
                kernel.coordinates(context, at, all);
                dependent
                    .iter()
                    .zip(places)
                    .for_each(|(&i, to)| *to = all[i]);
                kernel.rates(context, at, all);
                dependent
                    .iter()
                    .zip(rates)
                    .for_each(|(&i, to)| *to = all[i]);
            }
        }
        let first = node == 0;
        if columns > 0 && *stored || powers && first {
            let [kinetic, potential] = kernel.energies(context, at);
            if columns > 0 && *stored {
                row[columns - 1] = kinetic + potential;
            }
            self.energy = self.energy.max(kinetic.abs() + potential.abs());
        }
        if powers {
            row[columns..].copy_from_slice(&kernel.powers(context, at));
        }
    }
}
