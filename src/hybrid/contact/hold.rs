//! Positions and rates where contacts and constraints hold them, to rounding.

use super::ContactState;
use super::event::GUARDS;
use super::geometry::{DEPENDENT, Geometry, Line, multiplier};
use crate::kernel::Context;
use crate::model::Contacts;
use crate::numerics::{Buffer, Dynamic, Size};

/// Unit roundoff of a double.
pub(super) const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Gaps, rates and coefficients at a state, each with its rounding.
#[derive(Debug)]
pub(super) struct ContactValues {
    values: Vec<f64>,
    contacts: usize,
}

impl ContactValues {
    /// At a state.
    pub fn new(context: &Context, contacts: &Contacts, [q, v]: [&Buffer<f64>; 2]) -> Self {
        ContactValues {
            values: contacts.kernel.contact_values(context, q, v),
            contacts: contacts.contacts.len(),
        }
    }

    fn of(&self, k: usize, index: usize) -> f64 {
        self.values[k * Contacts::VALUES + index]
    }

    fn held(&self, c: usize, index: usize) -> f64 {
        self.values[self.contacts * Contacts::VALUES + c * Contacts::HELD + index]
    }

    /// What a line is about: a gap or a constraint, and its rounding.
    pub fn position(&self, line: Line) -> (f64, f64) {
        match line {
            Line::Normal(k) => (self.of(k, 0), self.of(k, 7) * ROUNDOFF),
            Line::Constraint(c) => (self.held(c, 0), self.held(c, 2) * ROUNDOFF),
            Line::Tangent(_) => (0.0, 0.0),
        }
    }

    /// Its rate, and the rounding.
    pub fn rate(&self, line: Line) -> (f64, f64) {
        match line {
            Line::Normal(k) => (self.of(k, 1), self.of(k, 8) * ROUNDOFF),
            Line::Tangent(k) => (self.of(k, 2), self.of(k, 9) * ROUNDOFF),
            Line::Constraint(c) => (self.held(c, 1), self.held(c, 3) * ROUNDOFF),
        }
    }

    /// The rates after an impact of a contact that the model states, by their coordinates; `sticks`: whether all friction of what
    /// touched before does.
    pub fn stated<'c>(
        &'c self,
        contacts: &'c Contacts,
        k: usize,
        sticks: bool,
    ) -> impl Iterator<Item = (usize, f64)> + 'c {
        let before = contacts.contacts[..k].iter();
        let own = &contacts.contacts[k];
        let (law, skipped) = match sticks {
            true => (&own.held_law, own.law.len()),
            false => (&own.law, 0),
        };
        let begin = self.contacts * Contacts::VALUES
            + contacts.constraints.len() * Contacts::HELD
            + before
                .map(|c| c.law.len() + c.held_law.len())
                .sum::<usize>()
            + skipped;
        let law = law.iter().copied();
        law.zip(self.values[begin..].iter().copied())
    }

    /// Static friction of a contact.
    pub fn static_friction(&self, k: usize) -> f64 {
        self.of(k, 3)
    }

    /// Kinetic friction of a contact.
    pub fn kinetic(&self, k: usize) -> f64 {
        self.of(k, 4)
    }

    /// Restitution of a contact.
    pub fn restitution(&self, k: usize) -> f64 {
        self.of(k, 5)
    }

    /// Restitution of its slip.
    pub fn tangential_restitution(&self, k: usize) -> f64 {
        self.of(k, 6)
    }
}

/// The lines whose place is held, and those whose rate is, while contacts do this.
pub(super) fn held_lines(contacts: &Contacts, states: &[ContactState]) -> [Vec<Line>; 2] {
    let constraints = (0..contacts.constraints.len()).map(Line::Constraint);
    let closed = (0..states.len())
        .filter(|&k| states[k].is_closed() && contacts.contacts[k].normal.is_some())
        .map(Line::Normal);
    let places: Vec<Line> = constraints.chain(closed).collect();
    let sticks = (0..states.len()).filter(|&k| states[k] == ContactState::Sticks);
    let rates = (places.iter().copied()).chain(sticks.map(Line::Tangent));
    [places.clone(), rates.collect()]
}

/// Brings coordinates and rates back to where the contacts and constraints of a mode hold them, in the states that the
/// context says, for whose time it is set.
pub(in crate::hybrid) fn hold(context: &Context, contacts: &Contacts, [q, v]: [&mut [f64]; 2]) {
    let states = ContactState::all(contacts, context.discrete());
    let [places, rates] = held_lines(contacts, &states);
    if rates.is_empty() {
        return;
    }
    let mut state = buffers([&*q, &*v]);
    let lines = [&*places, &*rates];
    hold_lines(context, contacts, lines, state.each_mut());
    q.copy_from_slice(&state[0]);
    v.copy_from_slice(&state[1]);
}

/// Coordinates and rates as the functions of a mode of all sets take them.
pub(super) fn buffers(state: [&[f64]; 2]) -> [Buffer<f64>; 2] {
    state.map(|of| Dynamic(of.len()).vector(|i| of[i]))
}

/// The guards of open contacts whose gap others hold at zero: feet beside those on which a body stands. Such a gap is zero but
/// for roundings as long as the others are closed.
pub(in crate::hybrid) fn held_by_others(
    context: &Context,
    contacts: &Contacts,
    state: [&[f64]; 2],
) -> Vec<usize> {
    let states = ContactState::all(contacts, context.discrete());
    let state = buffers(state);
    let state = state.each_ref();
    let at = ContactValues::new(context, contacts, state);
    let held = held_with(contacts, &states, &at, || {
        Geometry::new(context, contacts, state)
    });
    held.into_iter().map(|k| GUARDS * k).collect()
}

/// The same contacts, where the geometry may be known already.
pub(super) fn held_with<G: std::borrow::Borrow<Geometry>>(
    contacts: &Contacts,
    states: &[ContactState],
    at: &ContactValues,
    geometry: impl FnOnce() -> G,
) -> Vec<usize> {
    let is_open = |&k: &usize| contacts.contacts[k].has_gap() && states[k] == ContactState::Open;
    let [held, _] = held_lines(contacts, states);
    let mut found: Vec<usize> = (0..states.len())
        .filter(|k| is_open(k) && may_be_at_zero(*k, at))
        .collect();
    if !found.is_empty() {
        let geometry = geometry();
        found.retain(|&k| is_at_zero(k, &held, at, geometry.borrow()));
    }
    found
}

/// Whether a gap could be zero if others held it there.
fn may_be_at_zero(k: usize, at: &ContactValues) -> bool {
    let (gap, rounding) = at.position(Line::Normal(k));
    // Of lines with greater parts it is not told that they depend.
    gap.abs() <= rounding / DEPENDENT
}

/// Whether a gap that others determine is zero within its rounding and what theirs make of it: a foot far from two that are
/// close together moves by several of their roundings.
pub(super) fn is_at_zero(k: usize, held: &[Line], at: &ContactValues, geometry: &Geometry) -> bool {
    let line = Line::Normal(k);
    if !may_be_at_zero(k, at) {
        return false;
    }
    let Some(parts) = geometry.parts(line, held) else {
        return false;
    };
    let of_others = |(line, part): &(Line, f64)| {
        let (off, rounding) = at.position(*line);
        part.abs() * rounding.max(off.abs())
    };
    let (gap, rounding) = at.position(line);
    gap.abs() <= rounding + parts.iter().map(of_others).sum::<f64>()
}

/// Newton's method converges quadratically, at a singular position by a half: where a step gains less than a tenth, rounding is what is
/// left. Without a least gain a residual that falls by one unit in its last place each time goes on for millions of steps.
const LEAST_GAIN: f64 = 0.9;

/// Brings given lines back: those whose place, and those whose rate is held. Newton's method, each time by the least
/// change in the metric of the masses, as long as it comes closer.
pub(super) fn hold_lines(
    context: &Context,
    contacts: &Contacts,
    [places, rates]: [&[Line]; 2],
    [q, v]: [&mut Buffer<f64>; 2],
) {
    if places.is_empty() && rates.is_empty() {
        return;
    }
    let mut geometry = Geometry::new(context, contacts, [q, v]);
    let (mut first, mut before) = (Vec::new(), f64::INFINITY);
    loop {
        let now = ContactValues::new(context, contacts, [q, v]);
        let lines = geometry.spanning(places);
        let (amounts, off) = missing(&lines, |line| {
            let (value, rounding) = now.position(line);
            let known = first.iter().find(|(known, _)| *known == line);
            let at_first = known.map_or(value, |(_, value)| *value);
            if known.is_none() {
                first.push((line, value));
            }
            // A gap that is a coordinate alone is known to any number of digits: it is zero beside what it was.
            (value, rounding.max(ROUNDOFF * at_first.abs()))
        });
        // Not a number where nothing is known: then nothing is moved.
        if !(off > 1.0 && off < LEAST_GAIN * before) {
            break;
        }
        let Some(change) = geometry.least_change(&lines, &amounts) else {
            break;
        };
        (geometry.own.iter().zip(change)).for_each(|(&i, change)| q[i] += change);
        geometry = Geometry::new(context, contacts, [q, v]);
        before = off;
    }
    let lines = geometry.spanning(rates);
    let mut before = f64::INFINITY;
    loop {
        let now = ContactValues::new(context, contacts, [q, v]);
        let (amounts, off) = missing(&lines, |line| now.rate(line));
        if !(off > 0.0 && off < LEAST_GAIN * before) {
            break;
        }
        let Some((change, pushes)) = geometry.least_push(&lines, &amounts) else {
            break;
        };
        (geometry.own.iter().zip(change)).for_each(|(&i, change)| v[i] += change);
        // What brings rates back is an impulse like any other: momentum stays balanced. That of constraints is left out, since near
        // a singular position it grows without bound.
        let of_contacts = |(line, _): &(&Line, f64)| !matches!(line, Line::Constraint(_));
        for (&line, push) in lines.iter().zip(pushes).filter(of_contacts) {
            v[multiplier(contacts, line)] += push;
        }
        before = off;
    }
}

/// What is missing to zero along some lines, and the most of it in units of its rounding.
fn missing(lines: &[Line], mut value: impl FnMut(Line) -> (f64, f64)) -> (Vec<f64>, f64) {
    let mut most = 0.0_f64;
    let amounts = (lines.iter())
        .map(|&line| {
            let (value, rounding) = value(line);
            most = match value == 0.0 {
                true => most,
                false => most.max(value.abs() / rounding),
            };
            -value
        })
        .collect();
    (amounts, most)
}
