//! Transitions: which one is taken, what it does to state and energy, and what is remembered.

use super::accumulation::Signature;
use super::advance::MadeBy;
use super::failure::{Reason, Stoppable, Taken};
use super::problem::Method;
use super::simulation::{AtZero, Simulation};
use crate::kernel::with_kernel;
use crate::kernel::{Free, ModeKernel};
use crate::model::{Impulse, Transition};
use crate::numerics::Size;
use crate::run::{EnergyJump, Jump, Sides};

/// Relative rounding error of an energy: a generated energy is a sum of up to some sixteen products.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl<'p> Simulation<'p> {
    /// Takes the first transition of a guard whose condition holds.
    pub fn fire(&mut self, guard: usize) -> Stoppable<()> {
        let mode = self.mode();
        if mode.contacts.is_some() {
            return self.contact_event(guard);
        }
        with_kernel!(&mode.kernels, k => self.fire_by(k, guard))
    }

    fn fire_by<F: Size>(&mut self, kernel: &'p ModeKernel<F>, guard: usize) -> Stoppable<()> {
        let changes = self.changes_of_frictions(guard)?;
        if changes.is_empty() {
            return self.take(kernel, (guard, None));
        }
        for change in changes {
            let (guard, transition) = self.transition_of(change);
            let mode = self.mode();
            with_kernel!(&mode.kernels, k => self.take(k, (guard, Some(transition))))?;
            if self.is_over() {
                break;
            }
        }
        Ok(())
    }

    /// Takes a transition of a guard: the one that is decided, or the first whose condition holds.
    fn take<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        (guard, decided): (usize, Option<usize>),
    ) -> Stoppable<()> {
        let t = self.chosen(kernel, (guard, decided))?;
        let (mode, fired) = (self.here.mode, &self.mode().guards[guard]);
        let transition = &fired.transitions[t];
        let said = self
            .asks_impulses()
            .then(|| self.impulses(kernel, transition));
        let said = said.flatten();
        let taken = (transition.name, transition.impact);
        self.commit_with(taken, transition.target, said)?;
        self.note_closed(mode, (guard, taken.1));
        self.remember(guard, t)
    }

    /// Notes which gaps a transition of a guard of a mode, an impact or not, has left closed: their coordinates alone would tell the next
    /// hop by their rounding.
    fn note_closed(&mut self, mode: usize, (guard, impact): (usize, bool)) {
        let guards = &self.modes[mode].guards;
        let mut closed = std::mem::take(&mut self.at_zero);
        let is_new = impact && !guards[guard].is_exact();
        if mode != self.here.mode || closed.is_empty() && !is_new {
            closed.clear();
        } else {
            closed.retain(|zero| zero.guard != guard);
            closed.extend(is_new.then_some(AtZero {
                guard,
                vanishing: 1,
            }));
            // A reset may have moved a stop.
            self.set_context();
            closed.retain(|zero| self.closed_gap(&guards[zero.guard]).is_some());
        }
        self.at_zero = closed;
    }

    /// The impulses of a transition, if it says them.
    fn impulses<F: Size>(
        &self,
        kernel: &ModeKernel<F>,
        transition: &Transition,
    ) -> Option<Vec<f64>> {
        let [q, v, a] = self.here.free(kernel.size(), &self.mode().free);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        kernel.impulses(&self.context, &transition.kernel, at)
    }

    /// Index of the transition of a guard that happens, the one that is decided already if one is, and is noted; makes `next` the
    /// state after its reset.
    #[inline(always)]
    pub fn chosen<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        (guard, decided): (usize, Option<usize>),
    ) -> Stoppable<usize> {
        self.set_context();
        let [q, v, a] = self.here.free(kernel.size(), &self.mode().free);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let chosen = decided.or_else(|| self.choose(kernel, guard, at));
        let fired = &self.mode().guards[guard];
        let Some(t) = chosen else {
            // Every condition fails at the very state where the guard is crossed.
            return Err(Box::new(Reason::NoTransition { guard: fired.name }));
        };
        self.doubts.happened(fired);
        self.count(fired.transitions[t].name);
        self.accumulation.compare([&self.here.q, &self.here.v]);
        let reset = &fired.transitions[t].kernel;
        kernel.reset(&self.context, reset, at, &mut self.next);
        Ok(t)
    }

    /// Counts an event, if it is of those that end the run.
    #[inline(always)]
    pub fn count(&mut self, name: &str) {
        let after = self.problem.end.after;
        self.counted += u64::from(after.is_some_and(|(counted, _)| counted == name));
    }

    /// Takes a transition of a guard. Gives whether it has led to the same mode again, which goes on: with
    /// accelerations where they are needed.
    pub fn fire_and_stay<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        guard: usize,
        needs_accelerations: bool,
    ) -> Stoppable<bool> {
        let mode = self.here.mode;
        self.visited.clear();
        self.fire_by(kernel, guard)?;
        // The other method tells lower hops.
        let changes = self.problem.method == Method::Radau
            && self.is_explicit() != (self.made_by == MadeBy::Taylor);
        match self.here.mode == mode && !self.is_over() && !changes {
            true => {
                self.set_context();
                // From what the reset has written: the copy of it waits for its way to memory.
                let (n, free) = (self.here.q.len(), &self.mode().free);
                let size = kernel.size();
                let gather = |from: usize| size.vector(|i| self.next[from + free[i]]);
                let (q, v) = (gather(0), gather(n));
                self.enter_again(kernel, q, v, needs_accelerations)
            }
            false => Ok(false),
        }
    }

    /// Index of the transition that is taken in the present state `at`, for which the context is set. Overwrites `next`.
    #[inline(always)]
    pub fn choose<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        guard: usize,
        at: Free<F>,
    ) -> Option<usize> {
        let mode = self.mode();
        let index = self.here.mode;
        let (mut chosen, mut open) = (None, false);
        for (t, transition) in mode.guards[guard].transitions.iter().enumerate() {
            if !self.plan.allowed[transition.target] {
                continue;
            }
            let least = self.least_condition(kernel, transition, at);
            open |= transition.conditional
                && (self.doubts).may_leave_open((index, mode), (guard, t), least);
            if self.may_take(kernel, transition, (at, least)) {
                chosen = Some(t);
                break;
            }
        }
        if open {
            self.doubt_choice(kernel, guard, chosen);
        }
        chosen
    }

    /// Makes `next` the present state, in mode `target`, and records the event, with the impulses that multipliers tell.
    pub fn commit(&mut self, name: &'static str, impact: bool, target: usize) -> Stoppable<()> {
        self.commit_with((name, impact), target, None)
    }

    /// The same of a transition by its name and whether it is an impact, with the impulses that it says, if it does.
    pub fn commit_with(
        &mut self,
        (name, impact): (&'static str, bool),
        target: usize,
        said: Option<Vec<f64>>,
    ) -> Stoppable<()> {
        let from = self.here.shown;
        let states = self.problem.record.event_states;
        let before = states.then(|| self.snapshot());
        let so_far = self.asks_impulses().then(|| self.impulses_so_far());
        let energies_before = (self.observers.ledger.is_some() || states)
            .then(|| (self.stored_energy(), self.ground_momenta()));
        self.leave_for_next();
        self.here.mode = target;
        self.here.shown = self.shown();
        self.here.j += 1;
        if states || self.observers.ledger.is_some() {
            self.set_context();
        }
        if states {
            let mode = self.mode();
            with_kernel!(&mode.kernels, k => self.set_accelerations(k))?;
        }

        let impulses: Option<Vec<f64>> = so_far.map(|so_far| {
            let added = || {
                let now = self.impulses_so_far().into_iter();
                // Where nothing strikes they differ by what brings rates back to what is held.
                let change = |(now, before)| if impact { now - before } else { 0.0 };
                now.zip(so_far).map(change).collect()
            };
            said.unwrap_or_else(added)
        });
        let energy = energies_before.map(|before| {
            let of_impact = impulses.as_deref().filter(|_| impact);
            self.energy_jump(before, of_impact.unwrap_or_default())
        });
        if let (Some(ledger), Some(jump)) = (&mut self.observers.ledger, energy) {
            ledger.add_jump(jump);
        }
        let jump = Jump {
            t: self.here.now.seconds(),
            j: self.here.j,
            transition: name,
            from,
            to: self.here.shown,
            energy: energy.filter(|_| impact),
        };
        if let Some(before) = before {
            let after = self.snapshot();
            let impulses = impulses.unwrap_or_default();
            if self.observers.watch_extremes() {
                let stored = self.stored_energy();
                self.observers
                    .jump(&self.here, [&after.reactions, &after.outputs], Some(stored));
            }
            let sides = Sides {
                before,
                after,
                impulses,
            };
            self.observers.recording.event(&jump, Some(&sides));
        } else {
            self.observers.recording.event(&jump, None);
        }
        self.arrive(name, from)
    }

    /// Whether somebody asks for the impulses of a transition: who records states, or the ledger where what they act along moves by itself.
    fn asks_impulses(&self) -> bool {
        let counts = || {
            let mode = self.mode();
            with_kernel!(&mode.kernels, k => k.is_carried())
        };
        self.problem.record.event_states || self.observers.ledger.is_some() && counts()
    }

    /// The impulses since the start, as far as multipliers tell them; 0 where they do not.
    fn impulses_so_far(&self) -> Vec<f64> {
        let rate = |impulse: &Impulse| impulse.multiplier.map_or(0.0, |i| self.here.v[i]);
        self.problem.variant().impulses.iter().map(rate).collect()
    }

    /// Makes `next` the present state, in the same mode: nothing that anybody sees happens.
    pub fn take_silently(&mut self, name: &'static str) -> Stoppable<()> {
        self.leave_for_next();
        self.arrive(name, self.here.shown)
    }

    /// Makes `next`, the present state in other coordinates, the present state. Should the energies of a model tell the
    /// coordinates apart, that is in the ledger, as what an impact loses.
    pub fn take_chart(&mut self, name: &'static str) -> Stoppable<()> {
        let before = (self.observers.ledger.is_some())
            .then(|| (self.stored_energy(), self.ground_momenta()));
        self.leave_for_next();
        if let Some(before) = before {
            self.set_context();
            let jump = self.energy_jump(before, &[]);
            if let Some(ledger) = &mut self.observers.ledger {
                ledger.add_jump(jump);
            }
        }
        self.arrive(name, self.here.shown)
    }

    /// Leaves the present state for `next`.
    #[inline(always)]
    fn leave_for_next(&mut self) {
        let n = self.here.q.len();
        let left = [&*self.here.q, &self.here.v, self.context.discrete()];
        self.visited.leave(left);
        self.here.q.copy_from_slice(&self.next[..n]);
        self.here.v.copy_from_slice(&self.next[n..2 * n]);
        self.context
            .discrete_mut()
            .copy_from_slice(&self.next[2 * n..]);
    }

    /// A state that comes back without time to pass is a cycle.
    #[inline(always)]
    fn arrive(&mut self, name: &'static str, from: usize) -> Stoppable<()> {
        let state = [&*self.here.q, &self.here.v, self.context.discrete()];
        let step = (name, from, self.here.shown);
        match self.visited.arrive(step, state) {
            Some(cycle) => {
                let taken = cycle.into_iter().map(|(name, from, to)| Taken {
                    name,
                    from: self.name_of(from).to_string(),
                    to: self.name_of(to).to_string(),
                });
                Err(Box::new(Reason::Cycle {
                    cycle: taken.collect(),
                }))
            }
            None => Ok(()),
        }
    }

    /// The jump of the energy from what it was before, with the impulses of an impact as far as they are known. The impulse of the ground
    /// on the system works on the velocity of the ground; and what an impulse acts along may move by itself (a wall, a belt): that
    /// works against it.
    pub(in crate::hybrid) fn energy_jump(
        &self,
        (before, momenta_before): (f64, Vec<(f64, f64)>),
        impulses: &[f64],
    ) -> EnergyJump {
        let of_ground = self.ground_momenta().into_iter().zip(momenta_before);
        let of_ground = of_ground.map(|((after, rate), (before, _))| (after - before) * rate);
        let of_carried = impulses
            .iter()
            .zip(self.carried())
            .map(|(impulse, rate)| -impulse * rate);
        let ground_work: f64 = of_ground.chain(of_carried).sum();
        let after = self.stored_energy();
        let lost = before - after + ground_work;
        // A difference of three numbers is told from zero only above their rounding.
        let rounding = ROUNDING * (before.abs() + after.abs() + ground_work.abs());
        EnergyJump {
            lost: if lost.abs() <= rounding { 0.0 } else { lost },
            ground_work,
        }
    }

    /// Sets the accelerations to those of the equations.
    pub fn set_accelerations<F: Size>(&mut self, kernel: &'p ModeKernel<F>) -> Stoppable<()> {
        let mode = self.mode();
        let [q, v, _] = self.here.free(kernel.size(), &mode.free);
        let system = kernel.system(&self.context, &q, &v);
        let a = system
            .accelerations(&self.scale(kernel.size()))
            .map_err(|s| Reason::singular(mode, &self.problem.model, s))?;
        self.set_here(kernel, [&q, &v, &a]);
        Ok(())
    }

    /// Rates of what impulses act along where no coordinate moves; none where nothing is carried.
    fn carried(&self) -> Vec<f64> {
        let mode = self.mode();
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            k.carried(&self.context, Free { q: &q, v: &v, a: &a })
        })
    }

    /// Momentum along each motion of the ground, with the velocity of that motion.
    pub(in crate::hybrid) fn ground_momenta(&self) -> Vec<(f64, f64)> {
        let model = &self.problem.model;
        let n = model.coordinates.len();
        let mut momenta = vec![0.0; n + model.motions.len()];
        let mode = self.mode();
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            k.momenta(&self.context, Free { q: &q, v: &v, a: &a }, &mut momenta);
        });
        let rates = model.inputs.iter().filter(|i| i.kind.signals() == 3);
        let rates = rates.map(|i| self.context.signals()[i.signal + 1]);
        momenta[n..].iter().copied().zip(rates).collect()
    }

    /// Remembers the event, and goes to the limit of an accumulation if there is one.
    #[inline(always)]
    pub fn remember(&mut self, guard: usize, transition: usize) -> Stoppable<()> {
        let signature = Signature {
            guard,
            transition,
            mode: self.here.shown,
        };
        // What the reset has written is the state now.
        let key = signature.key();
        self.accumulation.push(key, self.here.now, &self.next);
        self.find_accumulation()
    }
}
