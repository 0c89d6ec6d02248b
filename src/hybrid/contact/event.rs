//! From the fall of a contact's guard to the set of contact states that follows.

use super::geometry::{Line, write_states};
use super::hold::{ContactValues, hold, hold_lines};
use super::impact::Impact;
use super::resolution::Resolution;
use super::standing::{Standing, tangent_at};
use super::{Conditioning, ContactState, Tangent};
use crate::hybrid::accumulation::Signature;
use crate::hybrid::departure::COLLECTED;
use crate::hybrid::failure::{Reason, Stoppable};
use crate::hybrid::simulation::{AtZero, Simulation};
use crate::hybrid::unrest::Restless;
use crate::model::Contacts;
use crate::model::name::intern;
use crate::numerics::Vector;

/// Guards of a contact.
pub(super) const GUARDS: usize = Contacts::GUARDS;

impl<'p> Simulation<'p> {
    /// Takes what follows the fall of a guard of the mode of all sets.
    pub(in crate::hybrid) fn contact_event(&mut self, guard: usize) -> Stoppable<()> {
        let mode = self.mode();
        let contacts = mode.contacts.as_ref().expect("a mode of all sets");
        let is_by_hand = guard >= GUARDS * contacts.contacts.len();
        match is_by_hand {
            true => self.take_by_hand(contacts, guard),
            false => self.contact_event_by(contacts, guard),
        }
    }

    fn contact_event_by(&mut self, contacts: &'p Contacts, guard: usize) -> Stoppable<()> {
        self.set_context();
        let (k, part) = (guard / GUARDS, guard % GUARDS);
        let before = ContactState::all(contacts, self.context.discrete());
        let of = &contacts.contacts[k];
        let closes = part == 0 && before[k] == ContactState::Open && !of.is_ratchet;
        let mut standing = match closes {
            true => self.closing(contacts, (k, &before)),
            false => {
                let stops = match (part, before[k]) {
                    (1, ContactState::Slides(_)) => Some(Line::Tangent(k)),
                    // A ratchet whose rate has come to zero.
                    (0, ContactState::Open) => Some(Line::Normal(k)),
                    _ => None,
                };
                self.standing(contacts, (stops, &before))
            }
        };
        let hop = match closes {
            true => self.resolution(contacts, k, &standing),
            false => Resolution::Seen,
        };
        // Where a series does not tell a hop the implicit method would tell less.
        let needs_series = match hop {
            Resolution::BySeries => true,
            Resolution::Lost | Resolution::Exact => self.accumulation.needs_series(),
            Resolution::Seen => false,
        };
        self.accumulation.set_needs_series(needs_series);
        let unresolved = hop == Resolution::Lost;
        if unresolved
            && (self.rest_unresolved(contacts)? || self.rest_here(contacts, (k, &standing))?)
        {
            return Ok(());
        }
        if closes && self.accumulation.is_unresolved(unresolved) {
            return Err(Box::new(Reason::Chattering {
                transitions: vec![intern(&format!("{} strikes", contacts.contacts[k].name))],
                missing: Restless::BelowRounding,
            }));
        }
        let mut strikes = match closes {
            true => self.strike(contacts, (k, &before), &mut standing)?,
            false => None,
        };
        let after = match self.settle_contacts(contacts, &mut standing) {
            Err(reason) if matches!(*reason, Reason::NoMotion { .. }) => {
                self.jam(contacts, &mut standing, reason)?;
                strikes = Some(k);
                self.settle_contacts(contacts, &mut standing)?
            }
            settled => settled?,
        };
        let name = verb(contacts, (k, strikes), &before, &after);
        let strikes = strikes.is_some();
        self.hold_before(contacts)?;
        self.doubts.happened(&self.mode().guards[guard]);
        let n = self.here.q.len();
        if before == after && !strikes && self.next[2 * n..] != *self.context.discrete() {
            // Only how friction is shared that is not determined.
            return self.take_silently(name);
        }
        self.count(name);
        self.accumulation.compare([&self.here.q, &self.here.v]);
        self.commit(name, strikes, self.here.mode)?;
        let signature = Signature {
            guard,
            transition: 0,
            mode: self.here.shown,
        };
        self.accumulation
            .push(signature.key(), self.here.now, &self.next);
        self.accumulation.predict();
        self.find_accumulation()
    }

    /// Brings the state before an event back to what the contacts held there: the end of a step that an event cuts is not. Its
    /// positions are those after it, since no event moves them.
    fn hold_before(&mut self, contacts: &'p Contacts) -> Stoppable<()> {
        let n = self.here.q.len();
        self.here.q.copy_from_slice(&self.next[..n]);
        self.hold_here(contacts)
    }

    /// Brings the present state to what the contacts hold.
    pub(super) fn hold_here(&mut self, contacts: &'p Contacts) -> Stoppable<()> {
        let free = &self.mode().free;
        let [mut q, mut v, a] = self.here.free(contacts.kernel.size(), free);
        hold(&self.context, contacts, [&mut q, &mut v]);
        let here = Conditioning::new(&self.context, contacts, [&q, &v]);
        if let Some(here) = here {
            here.is_nearly_singular(self.mode(), &mut self.best_determined)?;
        }
        self.here.set_free(free, [&q, &v, &a]);
        self.set_context();
        self.set_accelerations(&contacts.kernel)
    }

    /// What contacts that have just closed do: an impact, if one of them comes with a rate; by which contact it is
    /// named, if there was one: the first that closes, whichever guard rounding lets fall first.
    fn strike(
        &mut self,
        contacts: &Contacts,
        (k, before): (usize, &[ContactState]),
        standing: &mut Standing,
    ) -> Stoppable<Option<usize>> {
        let at = [&standing.q, &standing.v];
        let places = ContactValues::new(&self.context, contacts, at);
        let mut touches: Vec<bool> = standing.touching.iter().map(Option::is_some).collect();
        let mut rests = touches.clone();
        let mut closes = None;
        // Of the initial state it is not known whether what opens has left its gap.
        let is_given = self.here.j == 0;
        for j in 0..touches.len() {
            if before[j] == ContactState::Open && contacts.contacts[j].is_ratchet {
                let (rate, rounding) = places.rate(Line::Normal(j));
                touches[j] = true;
                rests[j] = rate <= rounding;
                standing.touching[j] = rests[j].then_some(Tangent::None);
                continue;
            }
            if !touches[j] || before[j] != ContactState::Open {
                continue;
            }
            let (rate, rounding) = places.rate(Line::Normal(j));
            closes = closes.or((rate < -rounding).then_some(j));
            rests[j] = rate.abs() <= rounding;
            // One that opens, and is not the one whose gap has fallen.
            standing.leaves[j] = j != k && rate > rounding;
            touches[j] = is_given || !standing.leaves[j];
            standing.touching[j] =
                (!standing.leaves[j]).then(|| tangent_at(&contacts.contacts[j], j, &places));
        }
        if closes.is_none() {
            return Ok(None);
        }
        if !contacts.contacts[k].law.is_empty() {
            let slides = before
                .iter()
                .any(|state| matches!(state, ContactState::Slides(_)));
            let sticks = before.contains(&ContactState::Sticks) && !slides;
            for (i, rate) in places.stated(contacts, k, sticks) {
                standing.v[i] = rate;
            }
            self.stand_after_own_law(contacts, (k, before, &touches), (&places, standing))?;
            return Ok(Some(k));
        }
        let impact = Impact {
            contacts,
            geometry: &standing.geometry,
            places: &places,
            came: &standing.own_rates(),
            collisions: self.problem.collisions,
            touches: &touches,
            rests: &rests,
            tangents: &standing.touching,
        };
        let outcome = impact.outcome().map_err(Box::new)?;
        standing.take(contacts, &touches, outcome);
        Ok(closes)
    }

    /// How contacts stand where the model's own law has said the rates after an impact of one of them.
    fn stand_after_own_law(
        &self,
        contacts: &Contacts,
        (k, before, touches): (usize, &[ContactState], &[bool]),
        (came, standing): (&ContactValues, &mut Standing),
    ) -> Stoppable<()> {
        let at = [&standing.q, &standing.v];
        let places = ContactValues::new(&self.context, contacts, at);
        // What has stuck, as the state that came is held to, and is not set in motion.
        let still: Vec<Line> = (0..touches.len())
            .filter(|&j| before[j] == ContactState::Sticks)
            .map(Line::Tangent)
            .filter(|&line| {
                let ((before, _), (after, rounding)) = (came.rate(line), places.rate(line));
                after == before || after.abs() <= rounding
            })
            .collect();
        let tangent = |j: usize| {
            let at = (&standing.geometry, &places, &standing.v);
            match self.is_still_with(&still, Line::Tangent(j), at) {
                true => Tangent::Still,
                false => tangent_at(&contacts.contacts[j], j, &places),
            }
        };
        let geometry = &standing.geometry;
        for j in (0..touches.len()).filter(|&j| touches[j]) {
            let contact = &contacts.contacts[j];
            let (rate, rounding) = match contact.normal {
                Some(_) => places.rate(Line::Normal(j)),
                None => (0.0, 0.0),
            };
            // What roundings that its place has collected make of its rate.
            let rates = geometry.own.iter().map(|&i| standing.v[i]);
            let collected = |along: &[f64]| {
                let terms = along.iter().zip(rates);
                COLLECTED * terms.map(|(along, v)| (along * v).abs()).sum::<f64>()
            };
            if contact.normal.is_some()
                && rate < -(rounding + collected(geometry.along(Line::Normal(j))))
            {
                let [contact, closes] = [k, j].map(|i| contacts.contacts[i].name);
                return Err(Box::new(Reason::OwnImpact {
                    contact,
                    closes,
                    rate,
                }));
            }
            let is_open = rate > rounding;
            let touching = (!is_open).then(|| match contact.tangent {
                Some(_) => tangent(j),
                None => Tangent::None,
            });
            standing.leaves[j] = is_open && !contact.is_ratchet;
            standing.touching[j] = touching;
        }
        Ok(())
    }

    /// Where no motion goes on: an impact without collision, if the scene asks for it and there is one; else the reason.
    pub(super) fn jam(
        &self,
        contacts: &Contacts,
        standing: &mut Standing,
        reason: Box<Reason>,
    ) -> Stoppable<()> {
        let rests: Vec<bool> = standing.touching.iter().map(Option::is_some).collect();
        // Ratchets take part, whatever their rate is.
        let touches: Vec<bool> = (rests.iter().zip(&contacts.contacts))
            .map(|(rests, of)| *rests || of.is_ratchet)
            .collect();
        let impact = Impact {
            contacts,
            geometry: &standing.geometry,
            places: &ContactValues::new(&self.context, contacts, [&standing.q, &standing.v]),
            came: &standing.own_rates(),
            collisions: self.problem.collisions,
            touches: &touches,
            rests: &rests,
            tangents: &standing.touching,
        };
        let asked = self.problem.collisions.without_collision;
        match asked.then(|| impact.without_collision()).flatten() {
            Some(impacted) => {
                standing.take(contacts, &touches, impacted);
                Ok(())
            }
            None => Err(reason),
        }
    }

    /// Decides which set follows from how the contacts stand, and makes it and the state `next`.
    pub(super) fn settle_contacts(
        &mut self,
        contacts: &'p Contacts,
        standing: &mut Standing,
    ) -> Stoppable<Vec<ContactState>> {
        let [places, rates] = standing.held(contacts);
        let Standing {
            q,
            v,
            geometry,
            touching,
            leaves,
            ..
        } = standing;
        hold_lines(&self.context, contacts, [&places, &rates], [q, v]);
        let n = self.here.q.len();
        self.next[..n].copy_from_slice(q.as_slice());
        self.next[n..2 * n].copy_from_slice(v.as_slice());
        let places = ContactValues::new(&self.context, contacts, [q, v]);
        let decision = self
            .decide((contacts, geometry), &places, touching)
            .map_err(Box::new)?;
        self.next[2 * n..].copy_from_slice(&decision.discrete);
        self.at_zero = (touching.iter().zip(&decision.states).enumerate())
            .filter_map(|(k, (tangent, state))| match (tangent, state) {
                (Some(_), ContactState::Open) => {
                    let of_guard = contacts.contacts[k].derivative_of_acceleration();
                    Some((GUARDS * k, of_guard + decision.vanishing_of_gap(k)))
                }
                (Some(Tangent::Still), ContactState::Slides(_)) => {
                    Some((GUARDS * k + 1, 1 + decision.vanishing_of_slip(k)))
                }
                // It leaves with a rate.
                (None, _) if leaves[k] => Some((GUARDS * k, 1)),
                _ => None,
            })
            .map(|(guard, vanishing)| AtZero { guard, vanishing })
            .collect();
        Ok(decision.states)
    }
}

impl Simulation<'_> {
    /// Makes `next` the state in which contacts stand, all of those with a gap open.
    pub(super) fn leave_open(&mut self, contacts: &Contacts, standing: &Standing) {
        let n = self.here.q.len();
        self.next[..n].copy_from_slice(standing.q.as_slice());
        self.next[n..2 * n].copy_from_slice(standing.v.as_slice());
        let states: Vec<ContactState> = (contacts.contacts.iter().zip(&standing.touching))
            .map(|(contact, touching)| match (contact.normal, touching) {
                (None, Some(Tangent::Slips(direction))) => ContactState::Slides(*direction),
                (None, _) => ContactState::Sticks,
                (Some(_), _) => ContactState::Open,
            })
            .collect();
        let discrete = &mut self.next[2 * n..];
        discrete.copy_from_slice(self.context.discrete());
        write_states(contacts, &states, discrete);
        let touches = (0..states.len())
            .filter(|&k| states[k] == ContactState::Open && standing.touching[k].is_some());
        self.at_zero = touches
            .map(|k| AtZero {
                guard: GUARDS * k,
                vanishing: contacts.contacts[k].derivative_of_acceleration(),
            })
            .collect();
    }
}

/// Name of what has happened: of the contact that `strikes`, of that whose guard fell, or of the first that does something else.
fn verb(
    contacts: &Contacts,
    (k, strikes): (usize, Option<usize>),
    before: &[ContactState],
    after: &[ContactState],
) -> &'static str {
    let named = |k: usize, verb: &str| intern(&format!("{} {verb}", contacts.contacts[k].name));
    if let Some(first) = strikes {
        return named(first, "strikes");
    }
    let others = (0..before.len()).filter(|&j| j != k);
    let changed = std::iter::once(k).chain(others);
    let found = changed.filter(|&j| before[j] != after[j]).find_map(|j| {
        let verb = match (before[j], after[j]) {
            (ContactState::Open, _) if contacts.contacts[j].is_ratchet => "engages",
            (_, ContactState::Open) if contacts.contacts[j].is_ratchet => "releases",
            (ContactState::Open, _) => "closes",
            (_, ContactState::Open) => "opens",
            (_, ContactState::Sticks) => "sticks",
            (ContactState::Slides(_), ContactState::Slides(_)) => "reverses",
            (_, ContactState::Slides(_)) => "slips",
            _ => return None,
        };
        Some(named(j, verb))
    });
    found.unwrap_or_else(|| named(k, "stays"))
}
