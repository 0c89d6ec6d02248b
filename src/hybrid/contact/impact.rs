//! Impacts: Newton's law of restitution and Coulomb's of friction for all contacts that touch, at one instant
//! (J. J. Moreau 1988; C. Glocker and F. Pfeiffer 1995):
//!
//! ```text
//! 0 ≤ P_N ⟂ u_N⁺ + e u_N⁻ ≥ 0,  P_T ∈ −μ P_N Sign(u_T⁺),  M (u⁺ − u⁻) = W_N P_N + W_T P_T + Gᵀ P_C.
//! ```
//!
//! All outcomes are tried: each contact may have no impulse, stick, or slip either way. Outcomes with the same rates count once.

use super::Tangent;
use super::geometry::{Geometry, Line};
use super::hold::{Places, ROUNDOFF};
use crate::hybrid::failure::Reason;
use crate::model::Contacts;
use crate::numerics::{Dynamic, Lu, Size};

/// What the contacts do just after an impact, and all rates then.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    /// Of each contact: touches it without a rate, and what does its tangent do.
    pub touching: Vec<Option<Tangent>>,
    /// Impulses, by the multiplier of their line.
    pub impulses: Vec<(Line, f64)>,
    /// Change of the rates of the coordinates that are no multipliers.
    pub change: Vec<f64>,
    error: Vec<f64>,
}

/// What an outcome says of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Push {
    /// Nothing.
    Without,
    /// It pushes, and has no friction.
    Smooth,
    /// It pushes and sticks.
    Sticks,
    /// It pushes and slips in this direction.
    Slips(f64),
}

/// The number of roundings of a solution, in units of |A⁻¹| (|A| |x| + |b|) and the roundoff: those of a row, and of
/// elimination (Higham 2002, §9.3).
fn roundings(unknowns: usize) -> f64 {
    3.0 * unknowns as f64 + 3.0
}

/// An impact of the contacts that touch; `closes`: those that do so with a rate, the others have none.
pub(super) struct Impact<'a> {
    pub contacts: &'a Contacts,
    pub geometry: &'a Geometry,
    pub places: &'a Places,
    /// Of each contact, whether it touches.
    pub touches: &'a [bool],
    /// Of those, whether it closes with a rate.
    pub closes: &'a [bool],
}

impl Impact<'_> {
    /// The outcome.
    pub fn outcome(&self) -> Result<Outcome, Reason> {
        let mut found: Vec<Outcome> = Vec::new();
        for pushes in self.combinations() {
            let Some(outcome) = self.attempt(&pushes) else {
                continue;
            };
            if !found.iter().any(|known| known.is_same(&outcome)) {
                found.push(outcome);
            }
        }
        let names = || {
            let of = (self.touches.iter().zip(&self.contacts.contacts)).filter(|(t, _)| **t);
            of.map(|(_, c)| c.name).collect::<Vec<_>>().join(", ")
        };
        match found.len() {
            0 => Err(Reason::NoImpact { contacts: names() }),
            1 => Ok(found.remove(0)),
            count => Err(Reason::SeveralImpacts {
                contacts: names(),
                count,
            }),
        }
    }

    fn combinations(&self) -> Vec<Vec<Push>> {
        let mut all = vec![Vec::new()];
        for (k, contact) in self.contacts.contacts.iter().enumerate() {
            let choices: &[Push] = match (self.touches[k], contact.normal, contact.tangent) {
                (false, ..) | (_, None, _) => &[Push::Without],
                (true, Some(_), None) => &[Push::Smooth, Push::Without],
                (true, Some(_), Some(_)) => &[
                    Push::Sticks,
                    Push::Slips(1.0),
                    Push::Slips(-1.0),
                    Push::Without,
                ],
            };
            all = (all.iter())
                .flat_map(|pushes: &Vec<Push>| {
                    choices.iter().map(|&choice| {
                        let mut pushes = pushes.clone();
                        pushes.push(choice);
                        pushes
                    })
                })
                .collect();
        }
        all
    }

    /// Rate of what a line is about before the impact; of what has none by bookkeeping, zero.
    fn before(&self, line: Line) -> f64 {
        match line {
            Line::Normal(k) if !self.closes[k] => 0.0,
            Line::Constraint(_) => 0.0,
            _ => self.places.rate(line).0,
        }
    }

    /// Its rounding.
    fn rounding(&self, line: Line) -> f64 {
        match self.before(line) == 0.0 {
            true => 0.0,
            false => self.places.rate(line).1,
        }
    }

    /// The outcome with these impulses, if it agrees with itself.
    fn attempt(&self, pushes: &[Push]) -> Option<Outcome> {
        let geometry = self.geometry;
        let n = geometry.own.len();
        // The lines that have a row of their own, with what changes there, and its rounding.
        let mut rows: Vec<(Line, f64, f64)> = (0..self.contacts.constraints.len())
            .map(|c| (Line::Constraint(c), 0.0, 0.0))
            .collect();
        for k in (0..pushes.len()).filter(|&k| pushes[k] != Push::Without) {
            let line = Line::Normal(k);
            let e = self.places.restitution(k);
            let rounding = (1.0 + e) * self.rounding(line);
            rows.push((line, -(1.0 + e) * self.before(line), rounding));
        }
        let mut lines: Vec<Line> = rows.iter().map(|(line, ..)| *line).collect();
        if geometry.independent(&lines).len() < lines.len() {
            return None;
        }
        let mut joined: Vec<(usize, usize)> = Vec::new();
        for k in (0..pushes.len()).filter(|&k| pushes[k] == Push::Sticks) {
            let line = Line::Tangent(k);
            if !geometry.depends(line, &lines) {
                lines.push(line);
                rows.push((line, -self.before(line), self.rounding(line)));
                continue;
            }
            let parallel = |&other: &usize| {
                lines.contains(&Line::Tangent(other))
                    && geometry.are_parallel(line, Line::Tangent(other))
            };
            joined.push((k, (0..k).find(parallel)?));
        }
        let slips: Vec<(usize, f64)> = (pushes.iter().enumerate())
            .filter_map(|(k, push)| match push {
                Push::Slips(direction) => Some((k, *direction)),
                _ => None,
            })
            .collect();
        // Unknown: changes of rates, then impulses along the lines. Friction of what slips goes with its normal.
        let count = n + rows.len();
        let mut matrix = vec![0.0; count * count];
        let mut right = vec![0.0; count];
        let mut uncertain = vec![0.0; count];
        for i in 0..n {
            matrix[i * count..i * count + n].copy_from_slice(&geometry.mass[i * n..(i + 1) * n]);
        }
        for (r, &(line, amount, rounding)) in rows.iter().enumerate() {
            let along = geometry.along(line);
            for i in 0..n {
                matrix[(n + r) * count + i] = along[i];
                matrix[i * count + n + r] = -along[i];
            }
            (right[n + r], uncertain[n + r]) = (amount, rounding);
            if let Line::Normal(k) = line
                && let Some((_, direction)) = slips.iter().find(|(slips, _)| *slips == k)
            {
                let friction = self.places.kinetic(k) * direction;
                let tangent = geometry.along(Line::Tangent(k));
                for i in 0..n {
                    matrix[i * count + n + r] += friction * tangent[i];
                }
            }
        }
        let (solution, error) = solve(&matrix, &right, &uncertain)?;
        let impulse = |line: Line| {
            let place = rows.iter().position(|(known, ..)| *known == line);
            place.map(|r| (solution[n + r], error[n + r]))
        };
        let rate = |line: Line| {
            let along = geometry.along(line);
            let value: f64 = (0..n).map(|i| along[i] * solution[i]).sum();
            let bound: f64 = (0..n)
                .map(|i| along[i].abs() * (error[i] + n as f64 * ROUNDOFF * solution[i].abs()))
                .sum();
            let before = self.before(line);
            let of_before = self.rounding(line) + ROUNDOFF * before.abs();
            (before + value, bound + of_before)
        };
        let mut touching = vec![None; pushes.len()];
        let mut impulses = Vec::new();
        for (k, &push) in pushes.iter().enumerate() {
            if !self.touches[k] {
                continue;
            }
            let normal = Line::Normal(k);
            let rests = match push {
                Push::Without if self.contacts.contacts[k].normal.is_none() => true,
                Push::Without => {
                    let (after, bound) = rate(normal);
                    let least = after + self.places.restitution(k) * self.before(normal);
                    if least < -bound {
                        return None;
                    }
                    after <= bound
                }
                _ => {
                    let (value, bound) = impulse(normal).expect("it pushes");
                    if value < -bound {
                        return None;
                    }
                    impulses.push((normal, value));
                    self.before(normal) * self.places.restitution(k) == 0.0
                }
            };
            let mut tangent = Tangent::None;
            if self.contacts.contacts[k].tangent.is_some() {
                let line = Line::Tangent(k);
                let (after, bound) = rate(line);
                tangent = match after.abs() <= bound {
                    true => Tangent::Still,
                    false => Tangent::Slips(after.signum()),
                };
                match push {
                    Push::Sticks => tangent = Tangent::Still,
                    Push::Slips(direction) => {
                        if direction * after < -bound {
                            return None;
                        }
                        let (push, _) = impulse(normal).expect("it pushes");
                        impulses.push((line, -self.places.kinetic(k) * direction * push));
                    }
                    Push::Smooth | Push::Without => {}
                }
                if let Some((value, bound)) = impulse(line) {
                    let held = joined.iter().filter(|(_, holder)| *holder == k);
                    let all = held.map(|(of, _)| *of).chain([k]);
                    let mut limit = 0.0;
                    let mut rounding = bound;
                    for of in all {
                        let (push, bound) = impulse(Line::Normal(of)).expect("it pushes");
                        limit += self.places.kinetic(of) * push;
                        rounding += self.places.kinetic(of) * bound;
                    }
                    if value.abs() > limit + rounding {
                        return None;
                    }
                    impulses.push((line, value));
                }
            }
            touching[k] = rests.then_some(tangent);
        }
        for c in 0..self.contacts.constraints.len() {
            let line = Line::Constraint(c);
            impulses.extend(impulse(line).map(|(value, _)| (line, value)));
        }
        Some(Outcome {
            touching,
            impulses,
            change: solution[..n].to_vec(),
            error: error[..n].to_vec(),
        })
    }
}

impl Outcome {
    /// Whether it leads to the same rates as another, as far as rounding tells.
    fn is_same(&self, other: &Outcome) -> bool {
        (0..self.change.len())
            .all(|i| (self.change[i] - other.change[i]).abs() <= self.error[i] + other.error[i])
    }
}

/// The solution of A x = b, and a bound of the error of each component, given that of b; `None` where A is singular.
fn solve(matrix: &[f64], right: &[f64], uncertain: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = right.len();
    let ones = Dynamic(n).repeat(1.0);
    let lu = Lu::<f64, Dynamic>::factorize(|i, j| matrix[i * n + j], &ones).ok()?;
    let x = lu.solve(|i| right[i]);
    let x: Vec<f64> = (0..n).map(|i| x[i]).collect();
    let factor = roundings(n) * ROUNDOFF;
    let sizes: Vec<f64> = (0..n)
        .map(|i| {
            let row = &matrix[i * n..(i + 1) * n];
            let products = row.iter().zip(&x).map(|(a, x)| (a * x).abs());
            factor * (products.sum::<f64>() + right[i].abs()) + uncertain[i]
        })
        .collect();
    let mut error = vec![0.0; n];
    for j in 0..n {
        let column = lu.solve(|i| if i == j { 1.0 } else { 0.0 });
        for i in 0..n {
            error[i] += column[i].abs() * sizes[j];
        }
    }
    Some((x, error))
}
