//! Transitions: which one is taken, what it does to state and energy, and what is remembered.

use super::failure::Reason;
use super::guards::Conditions;
use super::plan::is_impact;
use super::simulation::{Here, Simulation};
use crate::kernel::with_kernel;
use crate::kernel::{Free, ModeKernel};
use crate::record::{EnergyJump, Event};
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

/// Relative rounding error of an energy: a generated energy is a sum of up to some sixteen products.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Simulation<'_> {
    /// Takes the first transition of a guard whose condition holds.
    pub fn fire(&mut self, guard: usize) -> Result<(), Reason> {
        let mode = self.mode();
        let before = self.here.clone();
        let chosen = with_kernel!(&mode.kernels, k => self.choose(k, guard));
        let Some(t) = chosen else {
            // Every condition fails at the very state where the guard is crossed.
            let cycle = format!("{} (no condition holds)", mode.guards[guard].name);
            return Err(Reason::Cycle { cycle });
        };
        let transition = &mode.guards[guard].transitions[t];
        if self
            .problem
            .end
            .after
            .is_some_and(|(name, _)| name == transition.name)
        {
            self.counted += 1;
        }
        self.commit(
            transition.name,
            transition.impact,
            transition.target,
            before,
        )?;
        self.remember(guard, t, is_impact(&mode.guards[guard]))
    }

    /// Index of the transition that is taken; its reset is left in `next`.
    fn choose<const F: usize>(
        &mut self,
        kernel: &'static ModeKernel<F>,
        guard: usize,
    ) -> Option<usize> {
        self.set_context();
        let mode = self.mode();
        let [q, v, a] = self.here.free::<F>(mode.free);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let mut conditions = Conditions {
            variant: self.problem.variant,
            plan: &self.plan,
            next: &mut self.next,
        };
        let transitions = mode.guards[guard].transitions;
        (0..transitions.len())
            .filter(|&t| self.plan.allowed[transitions[t].target])
            .find(|&t| conditions.least(kernel, &mut self.context, &transitions[t], at) >= 0.0)
    }

    /// Makes `next` the present state, in mode `target`, and records the event.
    pub fn commit(
        &mut self,
        name: &'static str,
        impact: bool,
        target: usize,
        before: Here,
    ) -> Result<(), Reason> {
        let n = self.here.q.len();
        let state_before = self.snapshot();
        let (energy_before, momenta_before) = (self.stored_energy(), self.ground_momenta());

        self.here.q.copy_from_slice(&self.next[..n]);
        self.here.v.copy_from_slice(&self.next[n..2 * n]);
        self.context.discrete.copy_from_slice(&self.next[2 * n..]);
        self.here.mode = target;
        self.here.j += 1;
        self.set_context();
        let mode = self.mode();
        with_kernel!(&mode.kernels, k => self.set_accelerations(k))?;

        // The impulse of the ground on the system works on the velocity of the ground.
        let impulses = self.ground_momenta().into_iter().zip(momenta_before);
        let ground_work: f64 = impulses
            .map(|((after, rate), (before, _))| (after - before) * rate)
            .sum();
        let energy_after = self.stored_energy();
        let lost = energy_before - energy_after + ground_work;
        // A difference of three numbers is told from zero only above their rounding.
        let rounding = ROUNDING * (energy_before.abs() + energy_after.abs() + ground_work.abs());
        let energy = EnergyJump {
            lost: if lost.abs() <= rounding { 0.0 } else { lost },
            ground_work,
        };
        self.ledger.add_jump(energy);
        let event = Event {
            t: self.here.now.seconds(),
            j: self.here.j,
            transition: name,
            from: before.mode,
            to: target,
            before: state_before,
            after: self.snapshot(),
            energy: impact.then_some(energy),
        };
        self.events.push(event);
        self.check_cycle(name, before.mode)
    }

    fn set_accelerations<const F: usize>(
        &mut self,
        kernel: &'static ModeKernel<F>,
    ) -> Result<(), Reason> {
        let mode = self.mode();
        let [q, v, _] = self.here.free::<F>(mode.free);
        let system = kernel.system(&self.context, &q, &v);
        let a = crate::integrate::solve(&system.mass, &-system.load, &self.scale())
            .map_err(|s| Reason::singular(mode, self.problem.model, s))?;
        self.here.a.fill(0.0);
        self.here.set_free(mode.free, [&q, &v, &a]);
        Ok(())
    }

    /// Momentum along each motion of the ground, with the velocity of that motion.
    fn ground_momenta(&self) -> Vec<(f64, f64)> {
        let model = self.problem.model;
        let n = model.coordinates.len();
        let mut momenta = vec![0.0; n + model.motions.len()];
        let mode = self.mode();
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(mode.free);
            k.momenta(&self.context, Free { q: &q, v: &v, a: &a }, &mut momenta);
        });
        let rates = model.inputs.iter().filter(|i| i.kind.signals() == 3);
        let rates = rates.map(|i| self.context.signals[i.signal + 1]);
        momenta[n..].iter().copied().zip(rates).collect()
    }

    /// Remembers the event, and goes to the limit of an accumulation if there is one.
    fn remember(&mut self, guard: usize, transition: usize, impact: bool) -> Result<(), Reason> {
        let mut hasher = DefaultHasher::new();
        (guard, transition, self.here.mode).hash(&mut hasher);
        self.context
            .discrete
            .iter()
            .for_each(|d| d.to_bits().hash(&mut hasher));
        let event = self.events.last().expect("the event was recorded");
        let before = event.before.q.iter().chain(&event.before.v).copied();
        let after = event.after.q.iter().chain(&event.after.v).copied();
        self.accumulation
            .push(hasher.finish(), impact, self.here.now, before, after);
        self.look_for_accumulation()
    }

    /// Settling that comes back to a mode and state it has left at this instant never ends.
    fn check_cycle(&mut self, name: &'static str, from: usize) -> Result<(), Reason> {
        let modes = self.problem.variant.modes;
        let mut hasher = DefaultHasher::new();
        self.here.mode.hash(&mut hasher);
        let state = self
            .here
            .q
            .iter()
            .chain(&self.here.v)
            .chain(&self.context.discrete);
        state.for_each(|x| x.to_bits().hash(&mut hasher));
        let key = hasher.finish();
        let step = (name, from, self.here.mode);
        if let Some(first) = self.visited.iter().position(|(seen, _)| *seen == key) {
            let steps = self.visited[first + 1..].iter().map(|(_, step)| *step);
            let text = steps.chain([step]).map(|(name, from, to)| {
                format!("{name} ({} → {})", modes[from].name, modes[to].name)
            });
            let cycle = text.collect::<Vec<_>>().join(", ");
            return Err(Reason::Cycle { cycle });
        }
        self.visited.push((key, step));
        Ok(())
    }
}
