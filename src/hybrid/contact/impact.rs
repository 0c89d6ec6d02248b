//! Impacts of the contacts that touch, under the law that the scene asks for:
//!
//! - Newton's, as J. J. Moreau (1988) and C. Glocker and F. Pfeiffer (1995) state it: each contact that pushes leaves with
//!   −e times its rate before.
//! - Poisson's (F. Pfeiffer and C. Glocker 1996, §8): compression up to where no contact closes any more; then expansion, in
//!   which each delivers at least e times its impulse of compression.
//!
//! Both with Coulomb's law for the impulses, and with tangential restitution: what sticks goes back by −e_T times its slip rate
//! before. Contacts that touch take part together; or in sequence: those that close first, then those that these make close, and
//! so on.

use super::Tangent;
use super::geometry::{Geometry, Line};
use super::hold::ContactValues;
use super::phase::{About, Member, OfLines, Outcome, Phase};
use crate::hybrid::failure::Reason;
use crate::hybrid::problem::{Collisions, ImpactLaw, ImpactOrder};
use crate::model::Contacts;

/// Most impacts that follow each other at one instant. Their rates shrink in proportion or not at all: by a ratio of 0.93, one
/// that the last digits of a double outlast 500 times, they would have come to rest.
const MOST_IN_SEQUENCE: usize = 500;

/// What the contacts do just after an impact, and all rates then.
#[derive(Debug, Clone)]
pub(super) struct Impacted {
    /// Of each contact: touches it without a rate, and what does its tangent do.
    pub touching: Vec<Option<Tangent>>,
    /// Impulses.
    pub impulses: Vec<(Line, f64)>,
    /// Change of the rates of the coordinates that are no multipliers.
    pub change: Vec<f64>,
}

/// An impact of the contacts that touch.
pub(super) struct Impact<'a> {
    pub contacts: &'a Contacts,
    pub geometry: &'a Geometry,
    pub places: &'a ContactValues,
    /// Rates of the coordinates that are no multipliers, before it.
    pub came: &'a [f64],
    pub collisions: Collisions,
    /// Of each contact, whether it touches.
    pub touches: &'a [bool],
    /// Of those, whether it has no rate by bookkeeping.
    pub rests: &'a [bool],
    /// What its tangent does, as far as that is known.
    pub tangents: &'a [Option<Tangent>],
}

impl Impact<'_> {
    /// What follows.
    pub fn outcome(&self) -> Result<Impacted, Reason> {
        let rates = self.rates();
        let all = self.touching();
        let total = match self.collisions.order {
            ImpactOrder::Together => self.strike(&all, &rates)?,
            ImpactOrder::InSequence => {
                let mut total = self.strike(&self.closing(&all, &rates), &rates)?;
                let mut count = 1;
                loop {
                    let closing = self.closing(&all, &total.rates);
                    if closing.is_empty() {
                        break total;
                    }
                    if count == MOST_IN_SEQUENCE {
                        return Err(Reason::EndlessImpact {
                            contacts: self.names(),
                        });
                    }
                    count += 1;
                    let next = self.strike(&closing, &total.rates)?;
                    total = joined(total, next);
                }
            }
        };
        Ok(self.after(&total))
    }

    /// The one outcome in which contacts push although none closes, if there is one and only one: an impact without collision.
    pub fn without_collision(&self) -> Option<Impacted> {
        let rates = self.rates();
        let members = self.members(&self.touching());
        let outcomes = self.phase(&members, &rates).outcomes();
        let mut pushing = outcomes.iter().filter(|outcome| outcome.pushes());
        match (pushing.next(), pushing.next()) {
            (Some(only), None) => Some(self.after(only)),
            _ => None,
        }
    }

    /// Contacts that touch and have a gap.
    fn touching(&self) -> Vec<usize> {
        let has_gap = |&k: &usize| self.touches[k] && self.contacts.contacts[k].normal.is_some();
        (0..self.touches.len()).filter(has_gap).collect()
    }

    /// Those of some contacts that close with a rate which is more than its rounding, and than that of the rates before.
    fn closing(&self, of: &[usize], rates: &OfLines) -> Vec<usize> {
        let closes = |&k: &usize| {
            let line = Line::Normal(k);
            let rate = rates.of(line);
            rate.value < -rate.error.max(self.places.rate(line).1)
        };
        of.iter().copied().filter(closes).collect()
    }

    /// Rates before; of what has none by bookkeeping, zero.
    fn rates(&self) -> OfLines {
        let mut rates = OfLines::default();
        for line in self.geometry.all() {
            let is_zero = match line {
                Line::Normal(k) => self.rests[k],
                Line::Constraint(_) => true,
                Line::Tangent(k) => self.tangents[k] == Some(Tangent::Still),
            };
            let (value, error) = match is_zero {
                true => (0.0, 0.0),
                false => self.places.rate(line),
            };
            rates.set(line, About { value, error });
        }
        rates
    }

    /// Contacts as they take part under Newton's law.
    fn members(&self, of: &[usize]) -> Vec<Member> {
        let member = |&k: &usize| Member {
            contact: k,
            least: About::default(),
            restitution: self.places.restitution(k),
            returns: self.places.tangential_restitution(k),
            slip_before: About::default(),
        };
        of.iter().map(member).collect()
    }

    fn phase<'b>(&'b self, members: &'b [Member], rates: &'b OfLines) -> Phase<'b> {
        Phase {
            contacts: self.contacts,
            geometry: self.geometry,
            places: self.places,
            came: self.came,
            rates,
            members,
        }
    }

    /// What some contacts do together, under the law.
    fn strike(&self, of: &[usize], rates: &OfLines) -> Result<Outcome, Reason> {
        let mut members = self.members(of);
        for member in &mut members {
            member.slip_before = rates.of(Line::Tangent(member.contact));
        }
        match self.collisions.law {
            ImpactLaw::Newton => self.only(&members, rates),
            ImpactLaw::Poisson => {
                let compressing = |m: &Member| Member {
                    restitution: 0.0,
                    returns: 0.0,
                    ..*m
                };
                let compressing: Vec<Member> = members.iter().map(compressing).collect();
                let compressed = self.only(&compressing, rates)?;
                for member in &mut members {
                    let of_compression = compressed.impulses.of(Line::Normal(member.contact));
                    let (value, error) = (
                        member.restitution * of_compression.value,
                        member.restitution * of_compression.error,
                    );
                    member.least = About { value, error };
                    member.restitution = 0.0;
                }
                let expanded = self.only(&members, &compressed.rates)?;
                Ok(joined(compressed, expanded))
            }
        }
    }

    /// The outcome of a phase, if there is one and no other.
    fn only(&self, members: &[Member], rates: &OfLines) -> Result<Outcome, Reason> {
        let mut found = self.phase(members, rates).outcomes();
        let (contacts, law) = (self.names(), self.collisions.law);
        match found.len() {
            0 => Err(Reason::NoImpact { contacts, law }),
            1 => Ok(found.remove(0)),
            count => Err(Reason::SeveralImpacts {
                contacts,
                count,
                law,
            }),
        }
    }

    fn names(&self) -> Vec<&'static str> {
        let of = (self.touches.iter().zip(&self.contacts.contacts)).filter(|(t, _)| **t);
        of.map(|(_, c)| c.name).collect()
    }

    /// What the contacts do after an outcome.
    fn after(&self, outcome: &Outcome) -> Impacted {
        let of = |k: usize| {
            let contact = &self.contacts.contacts[k];
            let leaves = contact.normal.is_some() && !outcome.rates.of(Line::Normal(k)).is_zero();
            if !self.touches[k] || leaves {
                return None;
            }
            let slip = outcome.rates.of(Line::Tangent(k));
            Some(match contact.tangent {
                None => Tangent::None,
                Some(_) if slip.is_zero() => Tangent::Still,
                Some(_) => Tangent::Slips(slip.value.signum()),
            })
        };
        Impacted {
            touching: (0..self.touches.len()).map(of).collect(),
            impulses: (outcome.impulses.iter())
                .map(|(line, about)| (line, about.value))
                .collect(),
            change: outcome.change.iter().map(|about| about.value).collect(),
        }
    }
}

/// One outcome, and another from there.
fn joined(mut first: Outcome, then: Outcome) -> Outcome {
    for (line, impulse) in then.impulses.iter() {
        first.impulses.add(line, impulse);
    }
    for (all, more) in first.change.iter_mut().zip(&then.change) {
        all.value += more.value;
        all.error += more.error;
    }
    first.rates = then.rates;
    first
}
