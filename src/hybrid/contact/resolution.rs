//! How the end of a hop is known, and which hops are lower than the rounding of their gaps.

use super::ContactState;
use super::event::GUARDS;
use super::geometry::{Geometry, Line};
use super::hold::ContactValues;
use super::standing::Standing;
use crate::hybrid::advance::MadeBy;
use crate::hybrid::problem::Method;
use crate::hybrid::simulation::Simulation;
use crate::model::Contacts;
use crate::numerics::{Bounded, Buffer, ORDERS};

/// How the end of a hop is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Resolution {
    /// By a gap that is a coordinate, which has no rounding near zero: other gaps may be told less well.
    Exact,
    /// By its gap.
    Seen,
    /// By its gap; when those that follow close the implicit method tells less well than the tolerance asks for, or not at all, and
    /// the explicit one does.
    BySeries,
    /// Not by its gap: it was lower than what the motion tells.
    Lost,
}

/// What is not told of contacts at an instant.
#[derive(Debug)]
pub(super) struct Unresolved {
    /// Of each, whether it would hop no higher than the rounding of its gap.
    pub rests: Vec<bool>,
    /// The rate with which the one that closes would do so, in the unit of its gap a second: no slip rate is told below that.
    pub rate: f64,
}

/// Roundings of gaps at a state.
struct Roundings<'a> {
    places: ContactValues,
    geometry: &'a Geometry,
    q: &'a Buffer<f64>,
}

impl Roundings<'_> {
    /// That of what a line is about, and what a step's polynomials make of it.
    fn with_steps(&self, line: Line) -> f64 {
        let pairs = self.geometry.along(line).iter().zip(&self.geometry.own);
        let of = |i: usize| Bounded::of_polynomial(self.q[i], ORDERS, 0.0).error;
        let (_, rounding) = self.places.position(line);
        rounding + pairs.map(|(along, &i)| along.abs() * of(i)).sum::<f64>()
    }
}

impl Simulation<'_> {
    fn roundings<'a>(&self, contacts: &Contacts, standing: &'a Standing) -> Roundings<'a> {
        let at = [&standing.q, &standing.v];
        Roundings {
            places: ContactValues::new(&self.context, contacts, at),
            geometry: &standing.geometry,
            q: &standing.q,
        }
    }

    /// Whether the hop that ends at a contact was high enough for its end to be known by its gap. A hop of the duration T that ends
    /// with the rate u is about |u| T / 4 high. The series of the explicit method shows all that begins with a bounce of the
    /// contact itself; one without restitution begins at an impact of another, where what is held moves its gap by a rounding, and so does
    /// every event of another while it lasts.
    pub(super) fn resolution(
        &mut self,
        contacts: &Contacts,
        k: usize,
        standing: &Standing,
    ) -> Resolution {
        let is_explicit = self.made_by == MadeBy::Taylor;
        let may_expand = self.problem.method == Method::Radau;
        let unseen = self.signs.unseen();
        let last = self.accumulation.last().map(|(last, ..)| last);
        if last.is_none() && !unseen {
            return Resolution::Seen;
        }
        let roundings = self.roundings(contacts, standing);
        let line = Line::Normal(k);
        let told = roundings.with_steps(line);
        let (_, rounding) = roundings.places.position(line);
        let (rate, _) = roundings.places.rate(line);
        let restitution = roundings.places.restitution(k);
        let height = |last| 0.25 * rate.abs() * self.here.now.since(last);
        // What it is told to makes this of the time at which it closes.
        let blurs = told > self.accuracy.relative * self.here.now.seconds() * rate.abs();
        let is_low = unseen || last.is_some_and(|last| height(last) <= told);
        let guard = GUARDS * k;
        let begins_apart = restitution == 0.0 || !self.accumulation.was(guard);
        let lowest = if restitution == 0.0 { told } else { rounding };
        let is_lost = (unseen || last.is_some_and(|last| height(last) <= lowest))
            && begins_apart
            && self.bounce(guard).0 <= lowest;
        match is_explicit {
            _ if is_lost => Resolution::Lost,
            true if unseen => Resolution::Lost,
            _ if may_expand && (is_low || blurs) => Resolution::BySeries,
            false if is_low => Resolution::Lost,
            _ if told == 0.0 => Resolution::Exact,
            _ => Resolution::Seen,
        }
    }

    /// What rests where a contact closes by a hop that is not told: the open contacts that are within the rounding of their gaps, that one
    /// among them, and would bounce no higher. None where the one that closes would bounce higher, or has no rate to bounce with.
    pub(super) fn unresolved(
        &mut self,
        contacts: &Contacts,
        (k, standing): (usize, &Standing),
    ) -> Option<Unresolved> {
        let roundings = self.roundings(contacts, standing);
        let (rate, rounding) = roundings.places.rate(Line::Normal(k));
        if rate >= -rounding {
            return None;
        }
        let (_, acceleration) = self.bounce(GUARDS * k);
        let lowest = roundings.with_steps(Line::Normal(k));
        let rate = (2.0 * acceleration * lowest).sqrt();
        let states = ContactState::all(contacts, self.context.discrete());
        let rests: Vec<bool> = (states.iter().enumerate())
            .map(|(j, state)| {
                let is_open = *state == ContactState::Open && contacts.contacts[j].has_gap();
                is_open && {
                    let told = roundings.with_steps(Line::Normal(j));
                    let is_near = j == k || roundings.places.position(Line::Normal(j)).0 <= told;
                    is_near && self.bounce(GUARDS * j).0 <= told
                }
            })
            .collect();
        rests[k].then_some(Unresolved { rests, rate })
    }
}
