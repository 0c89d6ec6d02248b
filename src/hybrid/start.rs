//! The mode that a run starts in, and whether its initial state is one that the model can be in: not beyond a stop.

use super::failure::{Misfitting, Reason};
use super::limits::check_bounds;
use super::simulation::Simulation;
use super::solvers::{SlotsOf, Solvers};
use crate::kernel::{Free, ModeKernel, with_kernel};
use crate::model::{GuardShape, Mode};
use crate::numerics::Size;

/// Relative rounding error of a guard: a generated one is a sum of up to some sixteen products, as an energy is.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl<'p> Simulation<'p> {
    /// Refuses an initial state that settling would move: where a guard is negative, by more than its rounding, and its
    /// transition changes a coordinate or a velocity. That is no event; the state is beyond where the mode ends. A
    /// change of mode and of discrete states alone is what settling is for: friction that cannot hold what
    /// the scene lets rest. An impact from a guard's very zero is an event.
    pub fn check_start(&mut self, parameters: &[f64]) -> Result<(), Reason> {
        let start = self.here.mode;
        let mut refused = None;
        // Longer chains of modes are cycles, which settling names.
        for _ in 0..=self.modes.len() {
            let mode = self.mode();
            match with_kernel!(&mode.kernels, k => self.step_of_settling(k)) {
                Some(Ok(target)) => self.here.mode = target,
                Some(Err(reason)) => {
                    refused = Some(reason);
                    break;
                }
                None => break,
            }
        }
        self.here.mode = start;
        self.here.a.fill(0.0);
        let discrete = match &self.begun {
            Some(begun) => &begun[2 * self.here.q.len()..],
            None => &self.initial.discrete,
        };
        (self.context.discrete_mut()).copy_from_slice(discrete);
        self.margins.clear();
        self.set_context();
        if let Some(reason) = refused {
            return Err(reason);
        }
        let (model, variant) = (&*self.problem.model, self.problem.variant());
        Ok(check_bounds(model, variant, parameters, &self.here.q)?)
    }

    /// Takes the transition of a guard that is violated, if it is one of the mode and of discrete states alone: its
    /// target. `None`: there is nothing to refuse.
    fn step_of_settling<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
    ) -> Option<Result<usize, Reason>>
    where
        Solvers: SlotsOf<F>,
    {
        let mode = self.mode();
        // What else is wrong with the mode is said when it is entered.
        let violation = self.enter(kernel).ok()??;
        let guard = &mode.guards[violation.guard];
        let [q, v, a] = self.here.free(kernel.size(), &mode.free);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let value = kernel.guard(&self.context, &guard.kernel, at);
        let magnitude = kernel.guard_magnitude(&self.context, &guard.kernel, at);
        if value >= -ROUNDING * magnitude {
            return None;
        }
        let transition = &guard.transitions[self.choose(kernel, violation.guard, at)?];
        kernel.reset(&self.context, &transition.kernel, at, &mut self.next);
        let n = self.here.q.len();
        let moved = self.here.q[..] != self.next[..n] || self.here.v[..] != self.next[n..2 * n];
        if moved {
            return Some(Err(Reason::Beyond {
                mode: mode.name,
                transition: transition.name,
                what: match transition.impact {
                    true => "a stop",
                    false => "where this mode ends",
                },
                text: guard.text,
                value,
                unit: guard.unit,
                of: match guard.shape {
                    GuardShape::Linear { index, rate, .. } => {
                        let name = self.problem.model.coordinates[mode.free[index]].name;
                        format!("{name}{}", if rate { ".rate" } else { "" })
                    }
                    GuardShape::General { .. } => String::new(),
                },
            }));
        }
        (self.context.discrete_mut()).copy_from_slice(&self.next[2 * n..]);
        Some(Ok(transition.target))
    }
}

impl<'p> Simulation<'p> {
    /// Lets the direction in which a contact slides be that of its slip rate, where the scene does not state it.
    pub fn follow_slip_rates<F: Size>(&mut self, kernel: &'p ModeKernel<F>) {
        let mode = self.mode();
        let [q, v, a] = self.here.free(kernel.size(), &mode.free);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        for guard in &mode.guards {
            let is_stated = |d: usize| {
                let default = self.problem.model.discretes[d].values[0];
                self.problem.stated[d] || self.initial.discrete[d] != default
            };
            let Some(direction) = guard.direction.filter(|&d| !is_stated(d)) else {
                continue;
            };
            self.context.discrete_mut()[direction] = 1.0;
            let rate = kernel.guard(&self.context, &guard.kernel, at);
            self.context.discrete_mut()[direction] = match rate == 0.0 {
                true => self.initial.discrete[direction],
                false => rate.signum(),
            };
        }
    }
}

impl Simulation<'_> {
    /// The mode named by the scene, or the one with the fewest free coordinates that holds the state.
    pub fn choose_initial_mode(&mut self) -> Result<(), Reason> {
        let modes = self.modes;
        if let Some(chosen) = self.initial.mode {
            self.here.mode = chosen;
            self.apply_drift();
            return match self.misfit(&modes[chosen]) {
                None if self.plan.allowed[chosen] => Ok(()),
                None => Err(Reason::Initial {
                    mode: modes[chosen].name,
                    why: Misfitting::Frozen,
                }),
                Some(why) => Err(Reason::Initial {
                    mode: modes[chosen].name,
                    why,
                }),
            };
        }
        let mut best: Option<usize> = None;
        for m in 0..modes.len() {
            self.here.mode = m;
            let fewer = best.is_none_or(|b| modes[m].free.len() < modes[b].free.len());
            if self.plan.allowed[m] && fewer && self.misfit(&modes[m]).is_none() {
                best = Some(m);
            }
        }
        match best {
            Some(m) => {
                self.here.mode = m;
                Ok(())
            }
            None => {
                let freest = self.freest();
                let misfit = self.misfit(&modes[freest]);
                Err(Reason::Initial {
                    mode: modes[freest].name,
                    why: misfit.unwrap_or(Misfitting::NoMode),
                })
            }
        }
    }

    /// Why the state does not fit a mode, by its index, if it does not.
    pub fn misfit_of(&mut self, mode: usize) -> Option<Misfitting> {
        self.misfit(&self.modes[mode])
    }

    /// The first coordinate whose state does not fit a mode. One that depends on others fits where it follows from them, but for
    /// roundings. Leaves where the mode holds all, and their rates, in `next`.
    fn misfit(&mut self, mode: &Mode) -> Option<Misfitting> {
        let model = &self.problem.model;
        let n = self.here.q.len();
        self.set_context();
        let (held, rest) = self.next.split_at_mut(n);
        let rates = &mut rest[..n];
        let roundings = with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            let at = Free { q: &q, v: &v, a: &a };
            k.coordinates(&self.context, at, held);
            k.rates(&self.context, at, rates);
            k.roundings(&self.context, at)
        });
        let differ = |one: f64, other: f64, entry: usize| {
            let rounding = roundings
                .get(entry)
                .map_or(0.0, |bound| f64::EPSILON * bound);
            let is_near = (one - other).abs() <= rounding;
            one != other && !is_near
        };
        model.coordinates.iter().enumerate().find_map(|(i, c)| {
            let (coordinate, unit) = (c.name, c.unit);
            if let Some(minimum) = c.minimum
                && self.here.q[i] < minimum
            {
                return Some(Misfitting::Below {
                    coordinate,
                    minimum,
                    unit,
                });
            }
            if mode.free.contains(&i) {
                return None;
            }
            match mode.held_at[i] {
                Some(_) if differ(self.here.q[i], held[i], i) => Some(Misfitting::HeldAt {
                    coordinate,
                    held: held[i],
                    unit,
                }),
                _ if differ(self.here.v[i], rates[i], n + i) => Some(Misfitting::HeldRate {
                    coordinate,
                    held: rates[i],
                    unit,
                }),
                _ => None,
            }
        })
    }

    /// A scene that names a mode need not state the rates of what moves although the mode holds it.
    pub fn apply_drift(&mut self) {
        let mode = self.mode();
        self.set_context();
        let mut rates = vec![0.0; self.here.v.len()];
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            let at = Free { q: &q, v: &v, a: &a };
            k.rates(&self.context, at, &mut rates);
        });
        for (i, &rate) in rates.iter().enumerate() {
            if mode.moves(i) && self.here.v[i] == 0.0 {
                self.here.v[i] = rate;
            }
        }
    }
}
