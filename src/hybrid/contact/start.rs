//! The set of contact states that a run starts in.

use super::equilibrium::no_rest;
use super::geometry::{Geometry, Line, write_states};
use super::hold::{ContactValues, hold_lines};
use super::standing::Standing;
use super::{ContactState, Tangent};
use crate::hybrid::failure::{Misfitting, Reason, Stoppable};
use crate::hybrid::limits::check_bounds;
use crate::hybrid::simulation::Simulation;
use crate::model::Contacts;
use crate::numerics::Buffer;

impl<'p> Simulation<'p> {
    /// Finds the set of contact states of the initial state: a contact touches where its gap is zero within its rounding, and
    /// rests there where its rate is. One that closes with a rate strikes at once.
    pub(in crate::hybrid) fn start_contacts(&mut self, parameters: &[f64]) -> Result<(), Reason> {
        if let Some(mode) = self.initial.mode {
            self.here.mode = mode;
        }
        let mode = self.mode();
        let contacts = mode.contacts.as_ref().expect("a mode of all sets");
        if !self.plan.allowed[self.here.mode] {
            return Err(Reason::Initial {
                mode: mode.name,
                why: Misfitting::FrozenBesideContacts,
            });
        }
        let (model, variant) = (&*self.problem.model, self.problem.variant());
        check_bounds(model, variant, parameters, &self.initial.q)?;
        self.set_context();
        self.start_contacts_by(contacts).map_err(|why| *why)?;
        self.begun = Some(
            [&*self.here.q, &self.here.v, self.context.discrete()]
                .concat()
                .into(),
        );
        Ok(())
    }

    fn start_contacts_by(&mut self, contacts: &'p Contacts) -> Stoppable<()> {
        let [mut q, mut v, _] = self.here.free(contacts.kernel.size(), &self.mode().free);
        let open = vec![ContactState::Open; contacts.contacts.len()];
        write_states(contacts, &open, self.context.discrete_mut());
        let mut stated = None;
        if self.problem.project || self.problem.at_rest {
            let geometry = Geometry::new(&self.context, contacts, [&q, &v]);
            stated = Some((geometry, [q.clone(), v.clone()]));
            self.project(contacts, [&mut q, &mut v]);
        }
        if self.problem.at_rest {
            self.find_rest(contacts, &mut q).map_err(no_rest)?;
            write_states(contacts, &open, self.context.discrete_mut());
        }
        let standing = self.standing_of(contacts, [q, v], &|line| {
            stated.as_ref().map_or([0.0; 2], |(geometry, state)| {
                state.each_ref().map(|x| geometry.rounding(line, x))
            })
        });
        let mut standing = standing.map_err(|why| {
            let mode = self.mode().name;
            Box::new(Reason::Initial { mode, why })
        })?;
        match self.settle_contacts(contacts, &mut standing) {
            // The first event is the impact: with all that touches open, a gap falls at once.
            Err(reason)
                if self.problem.collisions.without_collision
                    && matches!(*reason, Reason::NoMotion { .. }) =>
            {
                self.leave_open(contacts, &standing);
            }
            settled => drop(settled?),
        }
        self.take_next(contacts);
        match self.problem.at_rest {
            true => self.check_rest(contacts),
            false => Ok(()),
        }
    }

    /// The contacts as they stand in a state, by their gaps and rates alone; or why it is not admitted. What was projected is
    /// known to the roundings of what was stated, by line those of place and rate: where nothing is free to move, no more is left of it.
    pub(super) fn standing_of(
        &mut self,
        contacts: &Contacts,
        [mut q, mut v]: [Buffer<f64>; 2],
        roundings: &dyn Fn(Line) -> [f64; 2],
    ) -> Result<Standing, Misfitting> {
        let at = ContactValues::new(&self.context, contacts, [&q, &v]);
        let at_least = |(value, rounding): (f64, f64), least| (value, rounding.max(least));
        let position = |line| at_least(at.position(line), roundings(line)[0]);
        let rate = |line| at_least(at.rate(line), roundings(line)[1]);
        let mut places = Vec::new();
        for (c, constraint) in contacts.constraints.iter().enumerate() {
            let line = Line::Constraint(c);
            for ((value, rounding), is_rate) in [(position(line), false), (rate(line), true)] {
                // What is not a number is not zero.
                let is_zero = value.abs() <= rounding;
                if !is_zero {
                    return Err(Misfitting::Constraint {
                        constraint: constraint.name,
                        is_rate,
                        value,
                    });
                }
            }
            places.push(line);
        }
        let mut touching = vec![None; contacts.contacts.len()];
        let mut leaves = vec![false; touching.len()];
        for (k, contact) in contacts.contacts.iter().enumerate() {
            if contact.normal.is_some() {
                let (opening, rounding) = match contact.is_ratchet {
                    false => position(Line::Normal(k)),
                    true => rate(Line::Normal(k)),
                };
                // What is not a number is not positive.
                let is_admitted = opening >= -rounding;
                if !is_admitted {
                    return Err(match contact.is_ratchet {
                        false => Misfitting::Gap {
                            contact: contact.name,
                            gap: opening,
                        },
                        true => Misfitting::Ratchet {
                            ratchet: contact.name,
                            rate: opening,
                        },
                    });
                }
                if opening > rounding {
                    continue;
                }
                places.push(Line::Normal(k));
                let (rate, rounding) = rate(Line::Normal(k));
                if rate.abs() > rounding {
                    leaves[k] = true;
                    continue;
                }
            }
            touching[k] = Some(match contact.tangent.map(|_| rate(Line::Tangent(k))) {
                None => Tangent::None,
                Some((slip, rounding)) if slip.abs() <= rounding => Tangent::Still,
                Some((slip, _)) => Tangent::Slips(slip.signum()),
            });
        }
        let context = &self.context;
        hold_lines(context, contacts, [&places, &[]], [&mut q, &mut v]);
        let geometry = Geometry::new(context, contacts, [&q, &v]);
        let at = ContactValues::new(context, contacts, [&q, &v]);
        let is_still = |k: &usize| touching[*k] == Some(Tangent::Still);
        let still = (0..touching.len()).filter(is_still).map(Line::Tangent);
        let vanishing = still.filter(|&line| self.vanishes(line, (&geometry, &at, &v)));
        let vanishing = vanishing.collect();
        Ok(Standing {
            q,
            v,
            geometry,
            touching,
            leaves,
            vanishing,
        })
    }

    /// Moves a state to the nearest that constraints admit and no contact penetrates, in the metric of the masses, as far as
    /// Newton's method comes closer. Contacts that penetrate are brought to a gap of zero, their rates stay; negative rates of
    /// ratchets are brought to zero.
    fn project(&mut self, contacts: &Contacts, [q, v]: [&mut Buffer<f64>; 2]) {
        let constraints = (0..contacts.constraints.len()).map(Line::Constraint);
        let mut rates: Vec<Line> = constraints.collect();
        let mut places = rates.clone();
        loop {
            let state = [&mut *q, &mut *v];
            hold_lines(&self.context, contacts, [&places, &rates], state);
            self.close_gaps(contacts, &places, [q, v]);
            let at = ContactValues::new(&self.context, contacts, [q, v]);
            let is_ratchet = |k: usize| contacts.contacts[k].is_ratchet;
            let is_violated = |k: usize| {
                let line = Line::Normal(k);
                let (held, (value, rounding)) = match is_ratchet(k) {
                    false => (&places, at.position(line)),
                    true => (&rates, at.rate(line)),
                };
                contacts.contacts[k].normal.is_some() && !held.contains(&line) && value < -rounding
            };
            let Some(k) = (0..contacts.contacts.len()).find(|&k| is_violated(k)) else {
                return;
            };
            let held = if is_ratchet(k) {
                &mut rates
            } else {
                &mut places
            };
            held.push(Line::Normal(k));
        }
    }

    /// Brings each of some gaps alone to zero, as long as it comes closer: a gap that is a coordinate is known to any number of
    /// digits, of which bringing several back at once leaves some.
    fn close_gaps(&self, contacts: &Contacts, places: &[Line], [q, v]: [&mut Buffer<f64>; 2]) {
        for &line in places {
            let mut before = f64::INFINITY;
            loop {
                let at = ContactValues::new(&self.context, contacts, [q, v]);
                let (value, rounding) = at.position(line);
                if !(value.abs() > rounding && value.abs() < before) {
                    break;
                }
                hold_lines(&self.context, contacts, [&[line], &[]], [q, v]);
                before = value.abs();
            }
        }
    }

    /// What was decided is the state here. What has brought rates to where they are held is no impulse: the run has not begun.
    fn take_next(&mut self, contacts: &Contacts) {
        let n = self.here.q.len();
        self.here.q.copy_from_slice(&self.next[..n]);
        for i in (0..n).filter(|&i| !contacts.is_multiplier(i)) {
            self.here.v[i] = self.next[n + i];
        }
        (self.context.discrete_mut()).copy_from_slice(&self.next[2 * n..]);
        self.here.shown = self.shown();
        self.set_context();
    }
}
