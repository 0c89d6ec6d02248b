//! How the friction of contacts that stick is shared, where their lines depend on each other: only what the forces come to together
//! is determined then.
//!
//! Of contacts whose slips are one line the first has the friction of all. Beside these, a set of contacts sticks as long as *some*
//! share of forces keeps each of them within what it can hold (the theorem of limit analysis: D. C. Drucker 1954). The shares that
//! do are a polytope without a line in it, so that it has a corner if it is not empty: there as many contacts as forces are left
//! undetermined push with the most friction that they can hold. Such a corner is what a mode can say, and the contacts stick until no
//! corner is left.

use super::State;
use super::geometry::{DEPENDENT, Geometry, Line};
use super::hold::{Places, held_lines};
use super::many::MAY_BE_ZERO;
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
    /// Of a set of contact states; `None` if gaps and constraints that it holds depend on each other.
    pub fn new(
        contacts: &Contacts,
        geometry: &Geometry,
        at: &Places,
        states: &[State],
    ) -> Option<Self> {
        let [places, _] = held_lines(contacts, states);
        if geometry.independent(&places).len() < places.len() {
            return None;
        }
        let (mut first, mut joined): (Vec<usize>, Vec<(usize, usize)>) = Default::default();
        for k in (0..states.len()).filter(|&k| states[k] == State::Sticks) {
            let holds = |&&of: &&usize| geometry.are_parallel(Line::Tangent(k), Line::Tangent(of));
            match first.iter().find(holds) {
                Some(&of) => joined.push((k, of)),
                None => first.push(k),
            }
        }
        let mut unknown = places.clone();
        unknown.extend(first.iter().copied().map(Line::Tangent));
        let missing = unknown.len() - geometry.independent(&unknown).len();
        let changes = match missing {
            0 => Vec::new(),
            _ => {
                let pushed = |&line: &Line| match line {
                    Line::Normal(k) => match states[k] {
                        State::Slides(direction) => {
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
    pub fn corners(&self, geometry: &Geometry, at: &Places, forces: &[Forces]) -> Vec<Dropped> {
        let count = self.missing;
        if self.changes.len() != count {
            return Vec::new();
        }
        // Each force with its parts: itself, then how it changes with each of the changes.
        let parts = |line: Line| {
            let place = self.unknown.iter().position(|known| *known == line);
            let change = |c: &Vec<f64>| place.map_or(0.0, |p| c[p]);
            self.changes.iter().map(change).collect::<Vec<f64>>()
        };
        let limit = |k: usize| {
            let mut sum = vec![0.0; count];
            let also = self.joined.iter().filter(|(_, of)| *of == k);
            for of in also.map(|(of, _)| *of).chain([k]) {
                let normal = parts(Line::Normal(of));
                let coefficient = at.static_friction(of);
                (sum.iter_mut().zip(normal)).for_each(|(s, n)| *s += coefficient * n);
            }
            sum
        };
        let friction: Vec<(usize, Vec<f64>, Vec<f64>)> = (self.first.iter())
            .map(|&k| (k, parts(Line::Tangent(k)), limit(k)))
            .collect();
        let normals: Vec<(f64, Vec<f64>)> = (0..forces.len())
            .filter(|&k| self.places.contains(&Line::Normal(k)))
            .map(|k| (forces[k].normal, parts(Line::Normal(k))))
            .collect();
        let largest = forces.iter().fold(0.0_f64, |most, of| {
            let all = [of.normal, of.friction, of.limit];
            all.iter().fold(most, |most, force| most.max(force.abs()))
        });
        let keeps = |shares: &[f64]| {
            let moved = |value: f64, parts: &[f64]| {
                let terms = || parts.iter().zip(shares).map(|(p, s)| p * s);
                let size = terms().fold(largest, |most, term| most.max(term.abs()));
                (value + terms().sum::<f64>(), MAY_BE_ZERO * size)
            };
            let pushes = normals.iter().all(|(value, parts)| {
                let (force, rounding) = moved(*value, parts);
                force >= -rounding
            });
            pushes
                && friction.iter().all(|(k, of_friction, of_limit)| {
                    let (held, rounding) = moved(forces[*k].friction, of_friction);
                    let (limit, more) = moved(forces[*k].limit, of_limit);
                    held.abs() <= limit + rounding + more
                })
        };
        let mut found = Vec::new();
        let sets = (0..1_u32 << friction.len()).filter(|set| set.count_ones() as usize == count);
        for set in sets {
            let is_dropped = |i: &usize| set >> i & 1 == 1;
            let dropped: Vec<usize> = (0..friction.len()).filter(is_dropped).collect();
            let mut held = self.places.clone();
            let others = (0..friction.len()).filter(|i| !is_dropped(i));
            held.extend(others.map(|i| Line::Tangent(friction[i].0)));
            if geometry.independent(&held).len() < held.len() {
                continue;
            }
            for signs in 0..1_u32 << count {
                let sign = |i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
                // At its limit: friction − sign · limit = 0.
                let entry = |i: usize, j: usize| {
                    let (_, of_friction, of_limit) = &friction[dropped[i]];
                    of_friction[j] - sign(i) * of_limit[j]
                };
                let amount = |i: usize| {
                    let of = forces[friction[dropped[i]].0];
                    sign(i) * of.limit - of.friction
                };
                let ones = Dynamic(count).repeat(1.0);
                let Ok(lu) = Lu::<f64, Dynamic>::factorize(entry, &ones) else {
                    continue;
                };
                let shares = lu.solve(amount);
                if keeps(&shares[..count]) {
                    let at_limit = |(i, &d): (usize, &usize)| (friction[d].0, sign(i));
                    found.push(dropped.iter().enumerate().map(at_limit).collect());
                }
            }
        }
        found
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

/// The discrete state that says that a force is not determined.
fn shares(contacts: &Contacts, line: Line) -> Option<usize> {
    match line {
        Line::Normal(k) | Line::Tangent(k) => contacts.contacts[k].shares,
        Line::Constraint(c) => contacts.constraints[c].shares,
    }
}
