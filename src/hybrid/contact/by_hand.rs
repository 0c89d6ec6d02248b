//! Transitions by hand beside contacts: which one is taken, and what the contacts do after its reset.

use crate::hybrid::failure::{Reason, Stoppable};
use crate::hybrid::simulation::Simulation;
use crate::kernel::Free;
use crate::model::{Contacts, Transition};
use crate::numerics::{Buffer, Size};

use super::ContactState;
use super::event::GUARDS;
use super::geometry::{Geometry, Line};
use super::hold::{ContactValues, hold};

impl<'p> Simulation<'p> {
    /// Takes the first transition of a guard whose condition holds.
    pub(super) fn take_by_hand(&mut self, contacts: &'p Contacts, guard: usize) -> Stoppable<()> {
        self.set_context();
        if let Some(k) = self.closed_already(contacts) {
            return self.contact_event(GUARDS * k);
        }
        self.hold_here(contacts)?;
        if self.mode().guards[guard].is_chart() {
            return self.take_chart_by(contacts, guard);
        }
        let t = self.chosen(&contacts.kernel, (guard, None))?;
        let transition = &self.mode().guards[guard].transitions[t];
        self.settle_after_reset(transition)?;
        self.commit(transition.name, transition.impact, transition.target)?;
        self.remember(guard, t)
    }

    /// Goes over to other coordinates, in which the contacts do what they did.
    fn take_chart_by(&mut self, contacts: &'p Contacts, guard: usize) -> Stoppable<()> {
        let [chart] = &*self.mode().guards[guard].transitions else {
            unreachable!("a chart is one transition");
        };
        let (n, free, size) = (self.here.q.len(), &self.mode().free, contacts.kernel.size());
        let [q, v, a] = self.here.free(size, free);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let before = ContactValues::new(&self.context, contacts, [&q, &v]);
        (contacts.kernel).reset(&self.context, &chart.kernel, at, &mut self.next);
        let [mut q, mut v] = [0, n].map(|from| size.vector(|i| self.next[from + free[i]]));
        let discrete = self.context.discrete().to_vec();
        (self.context.discrete_mut()).copy_from_slice(&self.next[2 * n..]);
        self.check_chart(contacts, chart.name, (&before, [&q, &v]))?;
        hold(&self.context, contacts, [&mut q, &mut v]);
        self.context.discrete_mut().copy_from_slice(&discrete);
        for (i, &of) in free.iter().enumerate() {
            (self.next[of], self.next[n + of]) = (q[i], v[i]);
        }
        self.take_chart(chart.name)
    }

    /// Refuses a chart by which a gap, a slip rate, a constraint or a rate of these changes by more than the tolerances tell from
    /// nothing. The context has the discrete states of the new coordinates.
    fn check_chart(
        &mut self,
        contacts: &Contacts,
        name: &'static str,
        (before, [q, v]): (&ContactValues, [&Buffer<f64>; 2]),
    ) -> Stoppable<()> {
        let after = ContactValues::new(&self.context, contacts, [q, v]);
        let geometry = Geometry::new(&self.context, contacts, [q, v]);
        let accuracy = self.accuracy;
        for line in geometry.all() {
            let (of, [place, rate]) = match line {
                Line::Normal(k) => (
                    contacts.contacts[k].name,
                    ["the gap", "the rate of the gap"],
                ),
                Line::Tangent(k) => (contacts.contacts[k].name, ["", "the slip rate"]),
                Line::Constraint(c) => (contacts.constraints[c].name, ["the value", "the rate"]),
            };
            let within = |absolute: &[f64], at: &Buffer<f64>| -> f64 {
                let along = geometry.along(line).iter().zip(&geometry.own);
                let within = |i: usize| absolute[i] + accuracy.relative * at[i].abs();
                along.map(|(along, &i)| along.abs() * within(i)).sum()
            };
            for (what, [before, after], within) in [
                (
                    place,
                    [before.position(line), after.position(line)],
                    within(&accuracy.q_absolute, q),
                ),
                (
                    rate,
                    [before.rate(line), after.rate(line)],
                    within(&accuracy.v_absolute, v),
                ),
            ] {
                let is_same = (after.0 - before.0).abs() <= before.1 + after.1 + within;
                if !is_same {
                    return Err(Box::new(Reason::Chart {
                        name,
                        what,
                        of,
                        before: before.0,
                        after: after.0,
                    }));
                }
            }
        }
        Ok(())
    }

    /// A contact that is open and whose gap is not positive any more: what closes at the instant of a transition comes before it.
    fn closed_already(&self, contacts: &Contacts) -> Option<usize> {
        let [q, v, _] = self.here.free(contacts.kernel.size(), &self.mode().free);
        let at = ContactValues::new(&self.context, contacts, [&q, &v]);
        let states = ContactState::all(contacts, self.context.discrete());
        (0..states.len()).find(|&k| {
            let line = Line::Normal(k);
            let opens_now = self.at_zero.iter().any(|zero| zero.guard == GUARDS * k);
            let is_open =
                states[k] == ContactState::Open && contacts.contacts[k].has_gap() && !opens_now;
            let (rate, rounding) = at.rate(line);
            is_open && at.position(line).0 <= 0.0 && rate < -rounding
        })
    }

    /// Finds what contacts do in the state that a reset has left in `next`. What closes with a rate strikes at the instant, as the
    /// event that follows.
    fn settle_after_reset(&mut self, transition: &'p Transition) -> Stoppable<()> {
        let n = self.here.q.len();
        let stays = self.next[..n] == *self.here.q && self.next[n..2 * n] == *self.here.v;
        let (mode, discrete) = (self.here.mode, self.context.discrete().to_vec());
        self.here.mode = transition.target;
        self.context
            .discrete_mut()
            .copy_from_slice(&self.next[2 * n..]);
        let target = self.mode();
        let contacts = target.contacts.as_ref().expect("a mode of all sets");
        let settled = self.settle_after_reset_by(contacts, (transition.name, stays));
        self.here.mode = mode;
        self.context.discrete_mut().copy_from_slice(&discrete);
        settled
    }

    fn settle_after_reset_by(
        &mut self,
        contacts: &'p Contacts,
        (name, stays): (&'static str, bool),
    ) -> Stoppable<()> {
        let mut standing = match stays {
            // What rests goes on resting by bookkeeping.
            true => {
                let states = ContactState::all(contacts, self.context.discrete());
                self.standing(contacts, (None, &states))
            }
            false => {
                let (n, free, size) =
                    (self.here.q.len(), &self.mode().free, contacts.kernel.size());
                let state = [0, n].map(|from| size.vector(|i| self.next[from + free[i]]));
                // What was held, or lands at this instant, is on its gap to a rounding of what is typical of it.
                let geometry = Geometry::new(&self.context, contacts, state.each_ref());
                let sizes = size.vector(|i| self.sizes[free[i]]);
                let rounding = |line| [geometry.rounding(line, &sizes), 0.0];
                self.standing_of(contacts, state, &rounding)
                    .map_err(|why| Box::new(Reason::Reset { name, why }))?
            }
        };
        match self.settle_contacts(contacts, &mut standing) {
            Err(reason) if matches!(*reason, Reason::NoMotion { .. }) => {
                self.jam(contacts, &mut standing, reason)?;
                self.settle_contacts(contacts, &mut standing)?;
            }
            settled => drop(settled?),
        }
        Ok(())
    }
}
