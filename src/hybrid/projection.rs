//! What of an initial state follows from the rest, and how it is moved to where contacts and constraints admit it, in modes without
//! multipliers: what modes hold follows, and a negative gap becomes zero as by its impact.

use super::failure::Reason;
use super::plan::is_impact;
use super::simulation::Simulation;
use super::validate::within;
use crate::kernel::{Free, with_kernel};
use crate::model::Mode;
use std::cmp::Reverse;

impl Simulation<'_> {
    /// The mode with the most free coordinates of those in which the run may start. What it does not admit, none does.
    pub fn freest(&self) -> usize {
        let may_start = (0..self.modes.len()).filter(|&m| match self.initial.mode {
            Some(named) => m == named,
            None => self.plan.allowed[m],
        });
        let freest = may_start.min_by_key(|&m| Reverse(self.modes[m].free.len()));
        freest.unwrap_or(0)
    }

    /// Lets follow what every mode in which the run may start says: what depends on others and is not stated; where the
    /// state is to be projected, all that such a mode holds.
    pub fn follow_unstated(&mut self) {
        let (problem, n) = (self.problem, self.here.q.len());
        let modes = match self.initial.mode {
            Some(named) => &self.modes[named..=named],
            None => self.modes,
        };
        let allowed = |m: usize| self.initial.mode.is_some() || self.plan.allowed[m];
        let follows = |entry: usize| {
            let (i, is_rate) = (entry % n, entry >= n);
            let is_held = |mode: &Mode| is_rate || mode.held_at[i].is_some();
            let says = |mode: &Mode| match problem.project {
                true => !mode.free.contains(&i) && is_held(mode),
                false => mode.depends[i] && is_held(mode),
            };
            (problem.unstated[entry] || problem.project)
                && (modes.iter().enumerate()).all(|(m, mode)| !allowed(m) || says(mode))
        };
        let stays: Vec<bool> = (0..2 * n).map(|entry| !follows(entry)).collect();
        if !stays.contains(&false) {
            return;
        }
        let stated = [&*self.here.q, &self.here.v].concat();
        self.here.mode = self.freest();
        self.follow_mode();
        for entry in (0..2 * n).filter(|&entry| stays[entry]) {
            match entry.checked_sub(n) {
                None => self.here.q[entry] = stated[entry],
                Some(i) => self.here.v[i] = stated[entry],
            }
        }
    }

    /// Lets what depends on others in the present mode follow from them to the last digit.
    pub fn follow_others(&mut self) {
        if self.mode().depends.contains(&true) {
            self.follow_mode();
        }
    }

    /// Brings all that the present mode holds to where it holds it.
    fn follow_mode(&mut self) {
        let mode = self.mode();
        self.set_context();
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            let at = Free { q: &q, v: &v, a: &a };
            k.coordinates(&self.context, at, &mut self.here.q);
            k.rates(&self.context, at, &mut self.here.v);
        });
    }

    /// Brings gaps that are negative to zero, in the freest mode: to where the reset of their impact leaves what they solve for. Rates
    /// stay, as by multipliers.
    pub fn project_gaps(&mut self) {
        self.here.mode = self.freest();
        let (mode, n) = (self.mode(), self.here.q.len());
        let impacts = || mode.guards.iter().filter(|guard| is_impact(guard));
        // One gap may bring another below zero. Where each has been brought back once for each of them, they exclude each
        // other, and the state is refused.
        for _ in impacts() {
            for guard in impacts() {
                self.set_context();
                with_kernel!(&mode.kernels, k => {
                    let [q, v, a] = self.here.free(k.size(), &mode.free);
                    let at = Free { q: &q, v: &v, a: &a };
                    if k.guard(&self.context, &guard.kernel, at) < 0.0 {
                        let impact = &guard.transitions[0].kernel;
                        k.reset(&self.context, impact, at, &mut self.next);
                        self.here.q.copy_from_slice(&self.next[..n]);
                    }
                });
            }
        }
    }

    /// Whether a state that was projected is within the bounds of its coordinates, which was not asked before.
    pub fn check_projected(&self) -> Result<(), Reason> {
        for (c, &q) in self.problem.model.coordinates.iter().zip(&*self.here.q) {
            within(c.bounds(), c.unit, q, || format!("projected `{}`", c.name))?;
        }
        Ok(())
    }
}
