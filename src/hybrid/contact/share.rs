//! How the friction of contacts that stick is shared, where their lines depend on each other: only what the forces come to together
//! is determined then.
//!
//! Of contacts whose slips are one line the first has the friction of all. Beside these, a set of contacts may stick as long as *some*
//! share of forces keeps each of them within what it can hold: Coulomb's law asks no more of what sticks. (That nothing else may happen
//! does not follow from it, D. C. Drucker 1954: other sets are judged by themselves.) The shares that do are a polytope without a line
//! in it, so that it has a corner if it is not empty: there as many contacts as forces are left undetermined push with the most friction
//! that they can hold. Such a corner is what a mode can say, and the contacts stick until no corner is left.

use super::geometry::{DEPENDENT, Geometry, Line};
use super::hold::{ContactValues, held_lines};
use super::many::MAY_BE_ZERO;
use super::{ContactState, Tangent};
use crate::model::Contacts;
use crate::numerics::{Dynamic, Lu, Size};

/// The forces of a contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Forces {
    pub normal: f64,
    pub friction: f64,
    /// The most friction that it can hold, with those whose friction it has.
    pub limit: f64,
}

/// Contacts that stick whose slip others hold, each with the direction of its friction where this is the most that it can hold,
/// else 0: then it has none.
pub(super) type Dropped = Vec<(usize, f64)>;

/// What is determined of the forces of a set of contact states.
pub(super) struct Sharing {
    /// The gaps and constraints that are held.
    places: Vec<Line>,
    /// Contacts that stick, the first of each line of slip.
    first: Vec<usize>,
    /// Those that stick beside them, each with the first.
    joined: Vec<(usize, usize)>,
    /// Forces that may change without a change of the motion: of each such change the parts of `unknown`.
    changes: Vec<Vec<f64>>,
    /// The forces that are unknown: of gaps, constraints and of the slips of `first`.
    unknown: Vec<Line>,
    /// Of each of these, whether it is not determined.
    is_open: Vec<bool>,
    /// Number of lines that the others hold.
    missing: usize,
}

impl Sharing {
    /// Of a set of contact states; `None` if gaps and constraints that it holds depend on each other, or it holds a slip by a force
    /// that has no effect.
    pub fn new(
        contacts: &Contacts,
        geometry: &Geometry,
        at: &ContactValues,
        states: &[ContactState],
    ) -> Option<Self> {
        let [places, _] = held_lines(contacts, states);
        if geometry.independent(&places).len() < places.len() {
            return None;
        }
        let (mut first, mut joined): (Vec<usize>, Vec<(usize, usize)>) = Default::default();
        for k in (0..states.len()).filter(|&k| states[k] == ContactState::Sticks) {
            let holds = |&&of: &&usize| geometry.are_parallel(Line::Tangent(k), Line::Tangent(of));
            match first.iter().find(holds) {
                Some(&of) => joined.push((k, of)),
                None => first.push(k),
            }
        }
        // A force along a line that vanishes holds nothing; beside others, these hold the slip or do not.
        let holds_nothing = |&k: &usize| {
            let is_alone = contacts.contacts[k].dropped.is_none();
            is_alone && geometry.independent(&[Line::Tangent(k)]).is_empty()
        };
        if first.iter().any(holds_nothing) {
            return None;
        }
        let mut unknown = places.clone();
        unknown.extend(first.iter().copied().map(Line::Tangent));
        let missing = unknown.len() - geometry.independent(&unknown).len();
        let changes = match missing {
            0 => Vec::new(),
            _ => {
                let pushed = |&line: &Line| match line {
                    Line::Normal(k) => match states[k] {
                        ContactState::Slides(direction) => {
                            vec![(line, 1.0), (Line::Tangent(k), -at.kinetic(k) * direction)]
                        }
                        _ => vec![(line, 1.0)],
                    },
                    _ => vec![(line, 1.0)],
                };
                geometry.without_effect(&unknown.iter().map(pushed).collect::<Vec<_>>())
            }
        };
        let strengths: Vec<f64> = unknown.iter().map(|&of| geometry.strength(of)).collect();
        let is_open = (0..unknown.len())
            .map(|i| {
                changes.iter().any(|change| {
                    let effects = change.iter().zip(&strengths).map(|(c, s)| (c * s).abs());
                    let largest = effects.fold(0.0, f64::max);
                    (change[i] * strengths[i]).abs() > DEPENDENT * largest
                })
            })
            .collect();
        Some(Sharing {
            places,
            first,
            joined,
            changes,
            unknown,
            is_open,
            missing,
        })
    }

    /// Whether all forces are determined, but for how contacts of one line share theirs.
    pub fn is_determined(&self) -> bool {
        self.missing == 0
    }

    /// The lines along which forces are unknown, and the contacts that stick beside the first of their line, each with that.
    pub fn unknown(&self) -> (&[Line], &[(usize, usize)]) {
        (&self.unknown, &self.joined)
    }

    /// Whether the set holds the slip of a contact that is to begin to slip.
    pub fn holds_a_slip(
        &self,
        geometry: &Geometry,
        states: &[ContactState],
        touching: &[Option<Tangent>],
    ) -> bool {
        (0..states.len()).any(|k| {
            matches!(states[k], ContactState::Slides(_))
                && touching[k] == Some(Tangent::Still)
                && geometry.depends(Line::Tangent(k), &self.unknown)
        })
    }

    /// Those that are dropped where none of what others hold has friction.
    pub fn without_friction(&self, geometry: &Geometry) -> Dropped {
        let mut held = self.places.clone();
        let mut dropped = Vec::new();
        for &k in &self.first {
            match geometry.depends(Line::Tangent(k), &held) {
                true => dropped.push((k, 0.0)),
                false => held.push(Line::Tangent(k)),
            }
        }
        dropped
    }

    /// The corners of all shares that keep each contact within what it can hold, as far as rounding tells. `forces`: any share.
    pub fn corners(
        &self,
        geometry: &Geometry,
        at: &ContactValues,
        forces: &[Forces],
    ) -> Vec<Dropped> {
        let count = self.missing;
        if self.changes.len() != count {
            return Vec::new();
        }
        let normals: Vec<Share> = (0..forces.len())
            .filter(|&k| self.places.contains(&Line::Normal(k)))
            .map(|k| self.share(forces[k].normal, &[(Line::Normal(k), 1.0)]))
            .collect();
        let frictions: Vec<Friction> = (self.first.iter())
            .map(|&k| self.friction(k, at, &forces[k]))
            .collect();
        let all = || {
            forces
                .iter()
                .flat_map(|of| [of.normal, of.friction, of.limit])
        };
        let largest = all().fold(0.0, |most, force| f64::max(most, force.abs()));
        let keeps = |changes: &[f64]| {
            let pushes = |normal: &Share| {
                let (force, rounding) = normal.after(changes, largest);
                force >= -rounding
            };
            let holds = |of: &Friction| {
                let (held, rounding) = of.held.after(changes, largest);
                let (limit, more) = of.limit.after(changes, largest);
                held.abs() <= limit + rounding + more
            };
            normals.iter().all(pushes) && frictions.iter().all(holds)
        };
        let mut found = Vec::new();
        let sets = (0..1_u32 << frictions.len()).filter(|set| set.count_ones() as usize == count);
        for set in sets {
            let (mut held, mut dropped) = (self.places.clone(), Vec::new());
            for (i, friction) in frictions.iter().enumerate() {
                match set >> i & 1 == 1 {
                    true => dropped.push(friction),
                    false => held.push(Line::Tangent(friction.contact)),
                }
            }
            if geometry.independent(&held).len() < held.len() {
                continue;
            }
            for signs in 0..1_u32 << count {
                let sign = |i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
                let corner = at_limits(&dropped, sign).filter(|changes| keeps(changes));
                let at_limit = (0..count).map(|i| (dropped[i].contact, sign(i)));
                found.extend(corner.map(|_| at_limit.collect()));
            }
        }
        found
    }

    /// A force that is so much in the share that is known, and the sum of parts of those along lines.
    fn share(&self, value: f64, of: &[(Line, f64)]) -> Share {
        let slope = |change: &Vec<f64>| {
            let place = |line: Line| self.unknown.iter().position(|known| *known == line);
            let parts = of
                .iter()
                .map(|&(line, part)| place(line).map_or(0.0, |p| part * change[p]));
            parts.sum()
        };
        let slopes = self.changes.iter().map(slope).collect();
        Share { value, slopes }
    }

    /// The friction of the first contact of a line.
    fn friction(&self, contact: usize, at: &ContactValues, forces: &Forces) -> Friction {
        let joined = self.joined.iter().filter(|(_, first)| *first == contact);
        let all = joined.map(|(of, _)| *of).chain([contact]);
        let limit: Vec<_> = all
            .map(|k| (Line::Normal(k), at.static_friction(k)))
            .collect();
        Friction {
            contact,
            held: self.share(forces.friction, &[(Line::Tangent(contact), 1.0)]),
            limit: self.share(forces.limit, &limit),
        }
    }

    /// Writes which contacts are dropped, and whose forces are not determined.
    pub fn write(&self, contacts: &Contacts, dropped: &Dropped, discrete: &mut [f64]) {
        let all = &contacts.contacts;
        let mut set = |index: Option<usize>, value: f64| {
            discrete[index.expect("what sticks beside others may share")] = value;
        };
        for &(k, of) in &self.joined {
            set(all[k].shares, 1.0);
            set(all[k].dropped, 1.0);
            set(all[of].joined[k], 1.0);
        }
        for &(k, at_limit) in dropped {
            set(all[k].dropped, 1.0);
            set(all[k].at_limit, at_limit);
        }
        for (&line, _) in self.unknown.iter().zip(&self.is_open).filter(|(_, o)| **o) {
            set(shares(contacts, line), 1.0);
        }
    }
}

/// A force in one share of all, and how it changes from there.
struct Share {
    value: f64,
    /// With each of the changes that have no effect.
    slopes: Vec<f64>,
}

impl Share {
    /// The force after these changes, and what it may be off by: a part of the largest term, or of what is `largest` else.
    fn after(&self, changes: &[f64], largest: f64) -> (f64, f64) {
        let terms = || {
            self.slopes
                .iter()
                .zip(changes)
                .map(|(slope, by)| slope * by)
        };
        let size = terms().fold(largest, |most, term| most.max(term.abs()));
        (self.value + terms().sum::<f64>(), MAY_BE_ZERO * size)
    }
}

/// The friction of a contact that sticks, and the most that it can hold.
struct Friction {
    contact: usize,
    held: Share,
    limit: Share,
}

/// The changes after which contacts, as many as there are changes, have as much friction as they can hold, each in a direction;
/// `None` if no changes do that, or many.
fn at_limits(all: &[&Friction], sign: impl Fn(usize) -> f64) -> Option<Vec<f64>> {
    let count = all.len();
    let entry = |i: usize, j: usize| all[i].held.slopes[j] - sign(i) * all[i].limit.slopes[j];
    let lu = Lu::<f64, Dynamic>::factorize(entry, &Dynamic(count).repeat(1.0)).ok()?;
    let changes = lu.solve(|i| sign(i) * all[i].limit.value - all[i].held.value);
    Some((0..count).map(|i| changes[i]).collect())
}

/// The discrete state that says that a force is not determined.
fn shares(contacts: &Contacts, line: Line) -> Option<usize> {
    match line {
        Line::Normal(k) | Line::Tangent(k) => contacts.contacts[k].shares,
        Line::Constraint(c) => contacts.constraints[c].shares,
    }
}
