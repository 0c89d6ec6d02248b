//! The contacts as they stand at an instant: what touches, and what of it has no rate.

use super::event::GUARDS;
use super::geometry::{DEPENDENT, Geometry, Line, multiplier};
use super::hold::{ContactValues, held_lines, held_with, hold_lines, is_at_zero};
use super::impact::Impacted;
use super::{ContactState, Tangent};
use crate::hybrid::simulation::Simulation;
use crate::kernel::Context;
use crate::model::{Contact, Contacts};
use crate::numerics::{Buffer, Vector};

/// What is known of the contacts at an instant.
pub(super) struct Standing {
    pub q: Buffer<f64>,
    pub v: Buffer<f64>,
    pub geometry: Geometry,
    /// Of each contact that touches without a rate, what its tangent does.
    pub touching: Vec<Option<Tangent>>,
    /// Of each contact, whether it leaves its gap with a rate.
    pub leaves: Vec<bool>,
    /// Lines that vanish, and with them their rates: nothing brings these to zero.
    pub vanishing: Vec<Line>,
}

impl Standing {
    /// The lines along which impulses may have come: first those along which what touches pushes, then those along which it rubs, then those
    /// of contacts that are near. Each accounts only for what those before do not: where a gap closes against friction its impact stops the slip.
    pub fn lines_with(&self, near: &[bool]) -> Vec<Line> {
        let touches = |line: &Line| match *line {
            Line::Normal(k) | Line::Tangent(k) => self.touching[k].is_some(),
            Line::Constraint(_) => true,
        };
        let is_near = |line: &Line| match *line {
            Line::Normal(k) | Line::Tangent(k) => near[k],
            Line::Constraint(_) => false,
        };
        let (touching, others): (Vec<_>, Vec<_>) = self.geometry.all().partition(touches);
        let rubs = |line: &Line| matches!(line, Line::Tangent(_));
        let (rubs, pushes): (Vec<_>, Vec<_>) = touching.into_iter().partition(rubs);
        let near = others.into_iter().filter(is_near);
        pushes.into_iter().chain(rubs).chain(near).collect()
    }

    /// The lines whose place is held, and those whose rate is, by what touches.
    pub fn held(&self, contacts: &Contacts) -> [Vec<Line>; 2] {
        let constraints = (0..contacts.constraints.len()).map(Line::Constraint);
        let touching = || (self.touching.iter().enumerate()).filter_map(|(k, t)| Some((k, (*t)?)));
        let normals = touching()
            .filter(|(k, _)| contacts.contacts[*k].normal.is_some())
            .map(|(k, _)| Line::Normal(k));
        let places: Vec<Line> = constraints.chain(normals).collect();
        let still = touching().filter(|(_, t)| *t == Tangent::Still);
        let rates = (places.iter().copied()).chain(still.map(|(k, _)| Line::Tangent(k)));
        let rates = rates
            .filter(|line| !self.vanishing.contains(line))
            .collect();
        [places, rates]
    }

    /// What slides, and would slide the other way once all that touches is held, is still: friction stops a slip and does not turn it.
    pub fn stop_what_turns(&mut self, context: &Context, contacts: &Contacts) {
        loop {
            let [places, rates] = self.held(contacts);
            let (mut q, mut v) = (self.q.clone(), self.v.clone());
            hold_lines(context, contacts, [&places, &rates], [&mut q, &mut v]);
            let at = ContactValues::new(context, contacts, [&q, &v]);
            let turns = |k: usize, tangent: Option<Tangent>| match tangent {
                Some(Tangent::Slips(direction)) => at.rate(Line::Tangent(k)).0 * direction <= 0.0,
                _ => false,
            };
            let turned: Vec<usize> = (0..self.touching.len())
                .filter(|&k| turns(k, self.touching[k]))
                .collect();
            if turned.is_empty() {
                break;
            }
            for k in turned {
                self.touching[k] = Some(Tangent::Still);
            }
        }
    }

    /// Rates of the coordinates that are no multipliers.
    pub fn own_rates(&self) -> Vec<f64> {
        self.geometry.own.iter().map(|&i| self.v[i]).collect()
    }

    /// Takes over what an impact of the contacts that touch does.
    pub fn take(&mut self, contacts: &Contacts, touches: &[bool], impact: Impacted) {
        for (&i, change) in self.geometry.own.iter().zip(&impact.change) {
            self.v[i] += change;
        }
        for &(line, impulse) in &impact.impulses {
            self.v[multiplier(contacts, line)] += impulse;
        }
        self.leaves = (touches.iter().zip(&impact.touching))
            .zip(&contacts.contacts)
            .map(|((touches, after), of)| *touches && after.is_none() && !of.is_ratchet)
            .collect();
        self.touching = impact.touching;
    }
}

impl Simulation<'_> {
    /// The contacts as they stand where none closes; `stops`: the slip rate, or the rate of a ratchet, that has come to zero, and with
    /// it all that depend on it.
    pub(super) fn standing(
        &mut self,
        contacts: &Contacts,
        (stops, before): (Option<Line>, &[ContactState]),
    ) -> Standing {
        let mut stops: Vec<Line> = stops.into_iter().collect();
        if let [Line::Tangent(k)] = *stops {
            stops.extend(self.stop_with(k, before));
        }
        let [mut q, mut v, _] = self.here.free(contacts.kernel.size(), &self.mode().free);
        let [places, mut still] = held_lines(contacts, before);
        let context = &self.context;
        let at = ContactValues::new(context, contacts, [&q, &v]);
        let geometry = Geometry::new(context, contacts, [&q, &v]);
        let (vanishing, others) = (stops.iter().copied())
            .partition::<Vec<_>, _>(|&line| self.vanishes(line, (&geometry, &at, &v)));
        still.extend(others);
        hold_lines(context, contacts, [&places, &still], [&mut q, &mut v]);
        let geometry = Geometry::new(context, contacts, [&q, &v]);
        let at = ContactValues::new(context, contacts, [&q, &v]);
        let stops = |line: Line| {
            stops.contains(&line) || self.is_still_with(&still, line, (&geometry, &at, &v))
        };
        // Feet beside those on which a body stands touch too: one of them may carry what comes next.
        let beside = held_with(contacts, before, &at, || &geometry);
        let touching = (before.iter().zip(&contacts.contacts).enumerate())
            .map(|(k, (&state, contact))| match state {
                ContactState::Open if beside.contains(&k) => Some(match stops(Line::Tangent(k)) {
                    true if contact.tangent.is_some() => Tangent::Still,
                    _ => tangent_at(contact, k, &at),
                }),
                ContactState::Open if contact.is_ratchet && stops(Line::Normal(k)) => {
                    Some(Tangent::None)
                }
                _ => tangent_of(state, || stops(Line::Tangent(k))),
            })
            .collect();
        Standing {
            q,
            v,
            geometry,
            touching,
            leaves: vec![false; before.len()],
            vanishing,
        }
    }

    /// The slips of other contacts that stop at the instant in which that of one does.
    fn stop_with(&mut self, k: usize, before: &[ContactState]) -> Vec<Line> {
        let others = (0..before.len()).filter(|&j| j != k);
        let slides = others.filter(|&j| matches!(before[j], ContactState::Slides(_)));
        let stops = |&j: &usize| self.is_reached(GUARDS * j + 1);
        slides.filter(stops).map(Line::Tangent).collect()
    }

    /// Whether the rate of a line has come to zero since the line itself vanishes there, as the slip of a crank does at its dead
    /// centre. To bring to zero what rounding leaves of it would then change rates of coordinates by more than the tolerances tell from
    /// nothing, and by more than √ε of what is typical of them.
    pub(super) fn vanishes(
        &self,
        line: Line,
        (geometry, at, v): (&Geometry, &ContactValues, &Buffer<f64>),
    ) -> bool {
        let accuracy = &self.accuracy;
        let (rate, _) = at.rate(line);
        let change = geometry.least_change(&[line], &[-rate]).unwrap_or_default();
        (change.iter().zip(&geometry.own)).any(|(change, &i)| {
            // An event is landed on to a rounding of the time since the last one.
            let landing = DEPENDENT * self.rate_sizes[i];
            change.abs() > landing.max(accuracy.v_absolute[i] + accuracy.relative * v[i].abs())
        })
    }

    /// Whether a line is still with some others, which are. Of two belts with speeds of their own one alone stops, although their
    /// lines are the same: what depends on a line that is still has stopped too if the tolerances do not tell its rate from zero.
    pub(super) fn is_still_with<V: Vector>(
        &self,
        others: &[Line],
        line: Line,
        (geometry, at, v): (&Geometry, &ContactValues, &V),
    ) -> bool {
        let accuracy = &self.accuracy;
        let (rate, rounding) = at.rate(line);
        let within: f64 = (geometry.along(line).iter().zip(&geometry.own))
            .map(|(along, &i)| {
                along.abs() * (accuracy.v_absolute[i] + accuracy.relative * v[i].abs())
            })
            .sum();
        geometry.depends(line, others) && rate.abs() <= rounding + within
    }

    /// The contacts as they stand where one closes, and with it all whose gap is zero within its rounding: these are on
    /// their gaps, with the rates that they come with.
    pub(super) fn closing(
        &mut self,
        contacts: &Contacts,
        (k, before): (usize, &[ContactState]),
    ) -> Standing {
        let [mut q, mut v, _] = self.here.free(contacts.kernel.size(), &self.mode().free);
        let context = &self.context;
        let at = ContactValues::new(context, contacts, [&q, &v]);
        let closes = |j: usize| {
            let (gap, rounding) = at.position(Line::Normal(j));
            let is_open = before[j] == ContactState::Open && !contacts.contacts[j].is_ratchet;
            is_open && (j == k || gap <= rounding)
        };
        let [mut places, rates] = held_lines(contacts, before);
        places.extend((0..before.len()).filter(|&j| closes(j)).map(Line::Normal));
        hold_lines(context, contacts, [&places, &rates], [&mut q, &mut v]);
        let geometry = Geometry::new(context, contacts, [&q, &v]);
        let at = ContactValues::new(context, contacts, [&q, &v]);
        // A body that lands flat: its other feet land too, whatever rounding says of their gaps.
        let lands = |j: usize| {
            let is_open = before[j] == ContactState::Open && contacts.contacts[j].has_gap();
            is_open && is_at_zero(j, &places, &at, &geometry)
        };
        let touching = (before.iter().enumerate())
            .map(|(j, &state)| match closes(j) || lands(j) {
                true => Some(Tangent::None),
                false => tangent_of(state, || false),
            })
            .collect();
        Standing {
            q,
            v,
            geometry,
            touching,
            leaves: vec![false; before.len()],
            vanishing: Vec::new(),
        }
    }
}

/// What the tangent of a contact that touches does, by its slip rate.
pub(super) fn tangent_at(contact: &Contact, k: usize, places: &ContactValues) -> Tangent {
    let (slip, rounding) = places.rate(Line::Tangent(k));
    match contact.tangent {
        None => Tangent::None,
        Some(_) if slip.abs() <= rounding => Tangent::Still,
        Some(_) => Tangent::Slips(slip.signum()),
    }
}

/// What the tangent of a contact in a state does; `stops`: whether the slip rate of one that slides has come to zero.
fn tangent_of(state: ContactState, stops: impl FnOnce() -> bool) -> Option<Tangent> {
    match state {
        ContactState::Open => None,
        ContactState::Closed => Some(Tangent::None),
        ContactState::Sticks => Some(Tangent::Still),
        ContactState::Slides(_) if stops() => Some(Tangent::Still),
        ContactState::Slides(direction) => Some(Tangent::Slips(direction)),
    }
}
