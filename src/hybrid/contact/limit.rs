//! The set of contact states at the limit of an accumulation: a contact rests where the limit has neither gap nor rate.

use super::geometry::{Geometry, Line, multiplier};
use super::hold::ContactValues;
use super::resolution::Unresolved;
use super::standing::Standing;
use super::{ContactState, Tangent};
use crate::hybrid::accumulation::Limit;
use crate::hybrid::failure::Stoppable;
use crate::hybrid::instant::Instant;
use crate::hybrid::simulation::Simulation;
use crate::input::Side;
use crate::model::{Contacts, Impulse};
use crate::numerics::Size;

impl<'p> Simulation<'p> {
    /// Goes to the limit of an accumulation, if the last events have one at which a contact comes to rest; whether it did.
    pub(in crate::hybrid) fn rest_contacts(&mut self) -> Stoppable<bool> {
        let mode = self.mode();
        let contacts = mode.contacts.as_ref().expect("a mode of all sets");
        let relative = self.problem.accuracy.relative;
        let limit = self.accumulation.limit(relative);
        match limit.or_else(|| self.accumulation.at_one_instant(relative)) {
            Some(limit) => self.rest_contacts_by(contacts, limit, None),
            None => Ok(false),
        }
    }

    /// The same where a hop is lower than the rounding of its gap, so that the motion does not show it: the limit is where the series ends,
    /// if it has no more left than as many such hops as are remembered.
    pub(super) fn rest_unresolved(&mut self, contacts: &'p Contacts) -> Stoppable<bool> {
        let relative = self.problem.accuracy.relative;
        let limit = self.accumulation.extrapolated(relative);
        let limit = limit.or_else(|| self.accumulation.predicted());
        match limit.filter(|limit| self.accumulation.is_near(limit, self.here.now)) {
            Some(limit) => self.rest_contacts_by(contacts, limit, None),
            None => Ok(false),
        }
    }

    /// The same where no series tells its limit: what would bounce no higher than the rounding of its gap rests now. What is left of its
    /// hops changes neither places nor the sum of its impulses by more than that.
    pub(super) fn rest_here(
        &mut self,
        contacts: &'p Contacts,
        (k, standing): (usize, &Standing),
    ) -> Stoppable<bool> {
        let Some(unresolved) = self.unresolved(contacts, (k, standing)) else {
            return Ok(false);
        };
        let limit = Limit {
            at: self.here.now,
            state: [&*self.here.q, &*self.here.v].concat(),
            uncertainty: vec![0.0; 2 * self.here.q.len()],
            modes: Vec::new(),
        };
        self.rest_contacts_by(contacts, limit, Some(&unresolved))
    }

    /// Goes to a limit at which the contacts rest that have neither gap nor rate there, or of which as much is not told.
    fn rest_contacts_by(
        &mut self,
        contacts: &'p Contacts,
        limit: Limit,
        unresolved: Option<&Unresolved>,
    ) -> Stoppable<bool> {
        let accuracy = self.accuracy;
        if limit.at.seconds() >= self.problem.end.time {
            return Ok(false);
        }
        let n = self.here.q.len();
        let size = contacts.kernel.size();
        let q = size.vector(|i| limit.state[i]);
        let v = size.vector(|i| limit.state[n + i]);
        self.context
            .set_signals(&self.signals, limit.at.seconds(), Side::Right);
        let geometry = Geometry::new(&self.context, contacts, [&q, &v]);
        let at = ContactValues::new(&self.context, contacts, [&q, &v]);
        // What tolerances, or what the limit is uncertain by, make of what a line is about.
        let within = |line: Line, of: &dyn Fn(usize) -> f64| -> f64 {
            let pairs = geometry.along(line).iter().zip(&geometry.own);
            pairs.map(|(along, &i)| along.abs() * of(i)).sum()
        };
        let of = |absolute: f64, i: usize| {
            absolute + accuracy.relative * limit.state[i].abs() + limit.uncertainty[i]
        };
        let of_place = |i: usize| of(accuracy.q_absolute[i], i);
        let of_rate = |i: usize| of(accuracy.v_absolute[i], n + i);
        let unknown = |i: usize| limit.uncertainty[n + i];
        let before = ContactState::all(contacts, self.context.discrete());
        let is_near = |k: usize| {
            let normal = Line::Normal(k);
            at.position(normal).0.abs() <= within(normal, &of_place)
        };
        let near: Vec<bool> = (0..before.len())
            .map(|k| contacts.contacts[k].has_gap() && is_near(k))
            .collect();
        let mut rests = false;
        let touching = (before.iter().enumerate())
            .map(|(k, &state)| {
                if state == ContactState::Open && contacts.contacts[k].is_ratchet {
                    let (rate, rounding) = at.rate(Line::Normal(k));
                    let is_zero = rate <= rounding + within(Line::Normal(k), &unknown);
                    return is_zero.then_some(Tangent::None);
                }
                if state == ContactState::Open {
                    let normal = Line::Normal(k);
                    let is_there = unresolved.is_some_and(|of| of.rests[k])
                        || (is_near(k) && at.rate(normal).0.abs() <= within(normal, &of_rate));
                    if !is_there {
                        return None;
                    }
                    rests = true;
                }
                let tangent = Line::Tangent(k);
                Some(match (contacts.contacts[k].tangent, state) {
                    (None, _) => Tangent::None,
                    (_, ContactState::Sticks) => Tangent::Still,
                    _ => {
                        let (slip, rounding) = at.rate(tangent);
                        let rounding = rounding + unresolved.map_or(0.0, |of| of.rate);
                        match slip.abs() <= rounding + within(tangent, &unknown) {
                            true => Tangent::Still,
                            false => Tangent::Slips(slip.signum()),
                        }
                    }
                })
            })
            .collect();
        if !rests {
            self.set_context();
            return Ok(false);
        }
        let mut standing = Standing {
            q,
            v,
            geometry,
            touching,
            leaves: vec![false; before.len()],
            vanishing: Vec::new(),
        };
        standing.stop_what_turns(&self.context, contacts);
        let now = std::mem::replace(&mut self.here.now, limit.at);
        let at_zero = self.at_zero.clone();
        let settled = self.settle_contacts(contacts, &mut standing);
        // What touches beside those that hold it, in the limit where they rest already; or what cannot go on: the run ends in the state
        // that is known.
        let goes_there = match &settled {
            Ok(after) => *after != before || limit.at.since(now) > 0.0,
            Err(_) => false,
        };
        if !goes_there {
            self.here.now = now;
            self.at_zero = at_zero;
            self.set_context();
            // A hop that cannot rest goes on.
            return match unresolved {
                None => settled.map(|_| false),
                Some(_) => Ok(false),
            };
        }
        let lines = standing.lines_with(&near);
        let impulses = self.go_to((contacts, &standing, &lines), now, &limit)?;
        self.commit_with(("rest", false), self.here.mode, Some(impulses))?;
        Ok(true)
    }

    /// Goes to a limit, from the last event or the one that is not resolved. Up to the limit the motion goes on as it does; all
    /// impacts that are left happen there, at once: their impulses along `lines`, which it gives, and the energy that they lose.
    /// Rates change as these impulses change them: those of the limit, which are told by a series, would not keep momentum.
    fn go_to(
        &mut self,
        (contacts, standing, lines): (&'p Contacts, &Standing, &[Line]),
        before: Instant,
        limit: &Limit,
    ) -> Stoppable<Vec<f64>> {
        let n = self.here.q.len();
        let work = self.go_on_to(&contacts.kernel, before, limit.at)?;
        let geometry = &standing.geometry;
        let change: Vec<f64> = (geometry.own.iter())
            .map(|&i| standing.v[i] - self.here.v[i])
            .collect();
        let (changes, impulses) = geometry.impulses(lines, &change);
        for (&i, change) in geometry.own.iter().zip(changes) {
            self.next[n + i] = self.here.v[i] + change;
        }
        for line in geometry.all() {
            let i = multiplier(contacts, line);
            let of_line = impulses.iter().find(|(known, _)| *known == line);
            self.next[n + i] = self.here.v[i] + of_line.map_or(0.0, |(_, impulse)| *impulse);
        }
        let of_limit = |impulse: &Impulse| {
            let added = |i: usize| self.next[n + i] - self.here.v[i];
            impulse.multiplier.map_or(0.0, added)
        };
        let told: Vec<f64> = self
            .problem
            .variant()
            .impulses
            .iter()
            .map(of_limit)
            .collect();
        let rates = self.here.v.to_vec();
        self.take_limit([&limit.state[..n], &rates], (work, &told));
        Ok(told)
    }
}
