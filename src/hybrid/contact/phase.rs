//! One phase of an impact: for all contacts that take part, at one instant,
//!
//! ```text
//! 0 ≤ P_N − P_least ⟂ u_N⁺ + e u_N⁻ ≥ 0,  P_T ∈ −μ P_N Sign(u_T⁺ + e_T u_T⁻),  M (u⁺ − u⁻) = W_N P_N + W_T P_T + Gᵀ P_C.
//! ```
//!
//! All outcomes are tried (of many contacts those that a pivoting method finds): each contact pushes more than the least or does
//! not, and sticks, or slips either way. Outcomes with the same rates count once.

use super::geometry::{Geometry, Line, dot};
use super::hold::{ContactValues, ROUNDOFF};
use super::many::{self, Answer, Answers, Asked, all_of_many, answers, to_try};
use crate::model::Contacts;
use crate::numerics::{Dynamic, Lu, Size, Unsolved};

/// The number of roundings of a solution, in units of |A⁻¹| (|A| |x| + |b|) and the roundoff: those of a row, and of
/// elimination (Higham 2002, §9.3).
fn roundings(unknowns: usize) -> f64 {
    3.0 * unknowns as f64 + 3.0
}

/// A number and what it may be off by.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct About {
    pub value: f64,
    pub error: f64,
}

impl About {
    /// Whether it is not told from zero.
    pub fn is_zero(self) -> bool {
        self.value.abs() <= self.error
    }
}

/// Rates, or impulses, of what lines are about.
#[derive(Debug, Clone, Default)]
pub(super) struct OfLines(Vec<(Line, About)>);

impl OfLines {
    /// Of a line; zero of one that is not known.
    pub fn of(&self, line: Line) -> About {
        let known = self.0.iter().find(|(known, _)| *known == line);
        known.map_or(About::default(), |(_, about)| *about)
    }

    /// Sets what is known of a line.
    pub fn set(&mut self, line: Line, about: About) {
        match self.0.iter_mut().find(|(known, _)| *known == line) {
            Some((_, known)) => *known = about,
            None => self.0.push((line, about)),
        }
    }

    /// Adds to what is known of a line.
    pub fn add(&mut self, line: Line, more: About) {
        let known = self.of(line);
        let value = known.value + more.value;
        let error = known.error + more.error + ROUNDOFF * value.abs();
        self.set(line, About { value, error });
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = (Line, About)> + '_ {
        self.0.iter().copied()
    }
}

/// A contact that takes part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    pub contact: usize,
    /// The least impulse of its normal.
    pub least: About,
    /// Restitution of its rate: e, or 0 where this phase ends without one.
    pub restitution: f64,
    /// Of its slip rate, e_T, with the slip rate before that it goes back to.
    pub returns: f64,
    pub slip_before: About,
}

/// What an outcome says of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Push {
    /// Whether it pushes with more than the least impulse, and so leaves with the rate that restitution says.
    more: bool,
    tangent: Friction,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Friction {
    /// None.
    Absent,
    Sticks,
    Slips(f64),
}

/// A phase of an impact.
pub(super) struct Phase<'a> {
    pub contacts: &'a Contacts,
    pub geometry: &'a Geometry,
    pub places: &'a ContactValues,
    /// Rates of the coordinates that are no multipliers, before the impact.
    pub came: &'a [f64],
    /// Rates before the phase, of all lines.
    pub rates: &'a OfLines,
    pub members: &'a [Member],
}

/// What a phase leaves.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    /// Rates after it, of all lines; exactly zero, without an error, where they are held there.
    pub rates: OfLines,
    /// Impulses.
    pub impulses: OfLines,
    /// Change of the rates of the coordinates that are no multipliers.
    pub change: Vec<About>,
}

impl Phase<'_> {
    /// All outcomes whose rates differ.
    pub fn outcomes(&self) -> Vec<Outcome> {
        let choices = self.choices();
        let holds = |i: usize, push: &Push| {
            let normal = Line::Normal(self.members[i].contact);
            push.more.then_some(normal)
        };
        let tried = to_try(&choices, self.geometry, holds, || self.answers());
        let mut found = self.differing(tried.into_iter());
        if found.is_empty() {
            found = self.differing(all_of_many(&choices));
        }
        found
    }

    /// Outcomes with these impulses whose rates differ.
    fn differing(&self, tried: impl Iterator<Item = Vec<Push>>) -> Vec<Outcome> {
        let mut found: Vec<Outcome> = Vec::new();
        for outcome in tried.filter_map(|pushes| self.attempt(&pushes)) {
            if !found.iter().any(|known| self.are_same(known, &outcome)) {
                found.push(outcome);
            }
        }
        found
    }

    /// Whether two outcomes lead to the same rates, as far as rounding tells: by their own bounds, or in the metric of the masses by that of
    /// elimination, since the bounds do not see what it leaves where a heavy body stays; or by that of the rates that come, of which
    /// those of contacts may be nothing but roundings.
    fn are_same(&self, one: &Outcome, other: &Outcome) -> bool {
        let pairs = || one.change.iter().zip(&other.change);
        if pairs().all(|(a, b)| (a.value - b.value).abs() <= a.error + b.error) {
            return true;
        }
        let difference: Vec<f64> = pairs().map(|(a, b)| a.value - b.value).collect();
        let values = |outcome: &Outcome| outcome.change.iter().map(|a| a.value).collect();
        let [one, other]: [Vec<f64>; 2] = [values(one), values(other)];
        let relative = roundings(one.len() + self.members.len()) * ROUNDOFF;
        let sizes = [&one, &other, self.came].map(|rates| self.energy(rates));
        let size = sizes.into_iter().fold(0.0, f64::max);
        self.energy(&difference) <= relative * relative * size
    }

    /// Twice the kinetic energy of rates.
    fn energy(&self, rates: &[f64]) -> f64 {
        let n = rates.len();
        let row = |i: usize| dot(&self.geometry.mass[i * n..(i + 1) * n], rates);
        (0..n).map(|i| rates[i] * row(i)).sum()
    }

    /// What each contact may do.
    fn choices(&self) -> Vec<Vec<Push>> {
        let of = |member: &Member| {
            let has_friction = self.contacts.contacts[member.contact].tangent.is_some();
            let tangents: &[Friction] = match has_friction {
                false => &[Friction::Absent],
                true => &[
                    Friction::Sticks,
                    Friction::Slips(1.0),
                    Friction::Slips(-1.0),
                ],
            };
            let of = |more: bool, tangent: Friction| Push { more, tangent };
            let mut choices: Vec<Push> = tangents.iter().map(|&t| of(true, t)).collect();
            match member.least.is_zero() {
                true => choices.push(of(false, Friction::Absent)),
                false => choices.extend(tangents.iter().map(|&t| of(false, t))),
            }
            choices
        };
        self.members.iter().map(of).collect()
    }

    /// What a pivoting method says that the contacts do.
    fn answers(&self) -> Result<Vec<Answers<Push>>, Unsolved> {
        let asked = |member: &Member| {
            let k = member.contact;
            let [normal, tangent] =
                [Line::Normal(k), Line::Tangent(k)].map(|line| self.rates.of(line).value);
            let least = member.least.value;
            let friction = match self.contacts.contacts[k].tangent {
                None => many::Friction::None,
                Some(_) => many::Friction::Still {
                    slip: tangent + member.returns * member.slip_before.value,
                    coefficient: self.places.kinetic(k),
                    bound: self.places.kinetic(k) * least,
                },
            };
            Asked {
                contact: k,
                normal: Some([(1.0 + member.restitution) * normal, least]),
                friction,
            }
        };
        let asked: Vec<Asked> = self.members.iter().map(asked).collect();
        let answers = answers(self.contacts, self.geometry, &asked)?;
        let push = |(&(answer, may_be_otherwise), asked): (&(Answer, bool), &Asked)| {
            let has_friction = !matches!(asked.friction, many::Friction::None);
            let tangent = match (has_friction, answer) {
                (false, _) => Friction::Absent,
                (_, Answer::Slips(direction) | Answer::Yields(direction)) => {
                    Friction::Slips(direction)
                }
                _ => Friction::Sticks,
            };
            let push = match answer {
                // With a least impulse its friction is not told by this.
                Answer::Opens if has_friction && asked.normal.is_some_and(|[_, l]| l > 0.0) => None,
                Answer::Opens => Some(Push {
                    more: false,
                    tangent: Friction::Absent,
                }),
                _ => Some(Push {
                    more: true,
                    tangent,
                }),
            };
            (push, may_be_otherwise)
        };
        Ok(vec![answers.iter().zip(&asked).map(push).collect()])
    }

    /// The outcome with these impulses, if it agrees with itself.
    fn attempt(&self, pushes: &[Push]) -> Option<Outcome> {
        let geometry = self.geometry;
        let n = geometry.own.len();
        let mut rows = self.rows(pushes)?;
        let joined = self.join_tangents(pushes, &mut rows)?;
        let solution = self.solve(pushes, &rows)?;
        let impulse = |line: Line| {
            let place = rows.iter().position(|row| row.line == line);
            place.map(|r| solution[n + r])
        };
        let change = &solution[..n];
        let mut rates = OfLines::default();
        for line in geometry.all() {
            let along = geometry.along(line);
            let value: f64 = along.iter().zip(change).map(|(a, c)| a * c.value).sum();
            let bound: f64 = (along.iter().zip(change))
                .map(|(a, c)| a.abs() * (c.error + n as f64 * ROUNDOFF * c.value.abs()))
                .sum();
            let before = self.rates.of(line);
            let error = bound + before.error + ROUNDOFF * before.value.abs();
            let value = before.value + value;
            rates.set(line, About { value, error });
        }
        let mut impulses = OfLines::default();
        for (i, (member, push)) in self.members.iter().zip(pushes).enumerate() {
            let k = member.contact;
            let normal = Line::Normal(k);
            let before = self.rates.of(normal);
            if !push.more {
                let after = rates.of(normal);
                if after.value + member.restitution * before.value < -after.error {
                    return None;
                }
            }
            if let Some(pushed) = impulse(normal) {
                let beyond = pushed.value - member.least.value;
                if push.more && beyond < -(pushed.error + member.least.error) {
                    return None;
                }
                impulses.set(normal, pushed);
                if push.more {
                    // As restitution says, and not as the sum of what all change.
                    let (value, error) = (
                        0.0 - member.restitution * before.value,
                        member.restitution * before.error,
                    );
                    rates.set(normal, About { value, error });
                }
            }
            let line = Line::Tangent(k);
            let goes_back = member.returns * member.slip_before.value;
            match push.tangent {
                Friction::Absent => {}
                Friction::Sticks => {
                    if goes_back == 0.0 {
                        rates.set(line, About::default());
                    }
                    if let Some(held) = impulse(line) {
                        let others = joined.iter().filter(|(_, holder)| *holder == i);
                        let all = others.map(|(of, _)| *of).chain([i]);
                        let (mut limit, mut rounding) = (0.0, held.error);
                        for of in all {
                            let k = self.members[of].contact;
                            let pushed = impulse(Line::Normal(k))?;
                            limit += self.places.kinetic(k) * pushed.value;
                            rounding += self.places.kinetic(k) * pushed.error;
                        }
                        if held.value.abs() > limit + rounding {
                            return None;
                        }
                        impulses.set(line, held);
                    }
                }
                Friction::Slips(direction) => {
                    let after = rates.of(line);
                    let rounding = after.error + member.returns * member.slip_before.error;
                    if direction * (after.value + goes_back) < -rounding {
                        return None;
                    }
                    let mu = -self.places.kinetic(k) * direction;
                    let pushed = impulse(normal)?;
                    let (value, error) = (mu * pushed.value, mu.abs() * pushed.error);
                    impulses.set(line, About { value, error });
                }
            }
        }
        for c in 0..self.contacts.constraints.len() {
            let line = Line::Constraint(c);
            rates.set(line, About::default());
            if let Some(force) = impulse(line) {
                impulses.set(line, force);
            }
        }
        Some(Outcome {
            rates,
            impulses,
            change: change.to_vec(),
        })
    }

    /// The lines that have an impulse of their own, with what is said of it; `None` if they depend on each other.
    fn rows(&self, pushes: &[Push]) -> Option<Vec<ImpulseCondition>> {
        let constraints = (0..self.contacts.constraints.len()).map(|c| {
            let line = Line::Constraint(c);
            ImpulseCondition::change(line, About::default())
        });
        let mut rows: Vec<ImpulseCondition> = constraints.collect();
        for (member, push) in self.members.iter().zip(pushes) {
            let line = Line::Normal(member.contact);
            if push.more {
                let before = self.rates.of(line);
                let factor = 1.0 + member.restitution;
                let (value, error) = (-factor * before.value, factor * before.error);
                rows.push(ImpulseCondition::change(line, About { value, error }));
            } else if !member.least.is_zero() {
                rows.push(ImpulseCondition {
                    line,
                    is_impulse: true,
                    amount: member.least,
                });
            }
        }
        let held: Vec<Line> = held_of(&rows);
        (self.geometry.independent(&held).len() == held.len()).then_some(rows)
    }

    /// Adds the tangents that stick to the rows, but for those that others hold already: of each of these the member, and
    /// the member that holds it. `None` if what they hold is not one tangent.
    fn join_tangents(
        &self,
        pushes: &[Push],
        rows: &mut Vec<ImpulseCondition>,
    ) -> Option<Vec<(usize, usize)>> {
        let mut joined = Vec::new();
        for (i, member) in self.members.iter().enumerate() {
            if pushes[i].tangent != Friction::Sticks {
                continue;
            }
            let line = Line::Tangent(member.contact);
            let held = held_of(rows);
            if !self.geometry.depends(line, &held) {
                let before = self.rates.of(line);
                let back = member.returns * member.slip_before.value;
                let value = -before.value - back;
                let error = before.error + member.returns * member.slip_before.error;
                rows.push(ImpulseCondition::change(line, About { value, error }));
                continue;
            }
            let holds = |&other: &usize| {
                let tangent = Line::Tangent(self.members[other].contact);
                held.contains(&tangent) && self.geometry.are_parallel(line, tangent)
            };
            joined.push((i, (0..i).find(holds)?));
        }
        Some(joined)
    }

    /// Changes of the rates, then impulses along the rows' lines. Friction of what slips goes with its normal.
    fn solve(&self, pushes: &[Push], rows: &[ImpulseCondition]) -> Option<Vec<About>> {
        let geometry = self.geometry;
        let n = geometry.own.len();
        let count = n + rows.len();
        let mut matrix = vec![0.0; count * count];
        let mut right = vec![About::default(); count];
        for i in 0..n {
            matrix[i * count..i * count + n].copy_from_slice(&geometry.mass[i * n..(i + 1) * n]);
        }
        for (r, row) in rows.iter().enumerate() {
            let along = geometry.along(row.line);
            for i in 0..n {
                matrix[i * count + n + r] = -along[i];
            }
            match row.is_impulse {
                true => matrix[(n + r) * count + n + r] = 1.0,
                false => matrix[(n + r) * count..][..n].copy_from_slice(along),
            }
            right[n + r] = row.amount;
            let Line::Normal(k) = row.line else { continue };
            let slips = (self.members.iter().zip(pushes)).find_map(|(m, p)| match p.tangent {
                Friction::Slips(direction) if m.contact == k => Some(direction),
                _ => None,
            });
            if let Some(direction) = slips {
                let friction = self.places.kinetic(k) * direction;
                let tangent = geometry.along(Line::Tangent(k));
                for i in 0..n {
                    matrix[i * count + n + r] += friction * tangent[i];
                }
            }
        }
        solve(&matrix, &right)
    }
}

/// What is said of a line with an impulse.
#[derive(Debug, Clone, Copy)]
struct ImpulseCondition {
    line: Line,
    /// Whether its impulse is given, or the change of its rate.
    is_impulse: bool,
    amount: About,
}

impl ImpulseCondition {
    fn change(line: Line, amount: About) -> Self {
        ImpulseCondition {
            line,
            is_impulse: false,
            amount,
        }
    }
}

/// Lines whose rate is given.
fn held_of(rows: &[ImpulseCondition]) -> Vec<Line> {
    let held = rows.iter().filter(|row| !row.is_impulse);
    held.map(|row| row.line).collect()
}

impl Outcome {
    /// Whether some contact pushes.
    pub fn pushes(&self) -> bool {
        let mut normals = (self.impulses.iter()).filter(|(l, _)| matches!(l, Line::Normal(_)));
        normals.any(|(_, impulse)| !impulse.is_zero())
    }
}

/// The solution of A x = b, and a bound of the error of each component, given that of b; `None` where A is singular.
fn solve(matrix: &[f64], right: &[About]) -> Option<Vec<About>> {
    let n = right.len();
    let ones = Dynamic(n).repeat(1.0);
    let lu = Lu::<f64, Dynamic>::factorize(|i, j| matrix[i * n + j], &ones).ok()?;
    let first = lu.solve(|i| right[i].value);
    let mut x: Vec<f64> = (0..n).map(|i| first[i]).collect();
    // Elimination alone leaves in a row of few entries what others have filled it with; one step of refinement takes that away, so that
    // rows are off by their own terms alone (Skeel 1980; Higham 2002, §12.2).
    let left: Vec<f64> = (0..n)
        .map(|i| right[i].value - dot(&matrix[i * n..(i + 1) * n], &x))
        .collect();
    let more = lu.solve(|i| left[i]);
    (0..n).for_each(|i| x[i] += more[i]);
    let factor = roundings(n) * ROUNDOFF;
    let sizes: Vec<f64> = (0..n)
        .map(|i| {
            let row = &matrix[i * n..(i + 1) * n];
            let products = row.iter().enumerate().map(|(j, a)| (a * x[j]).abs());
            factor * (products.sum::<f64>() + right[i].value.abs()) + right[i].error
        })
        .collect();
    let mut found: Vec<About> = (0..n)
        .map(|i| About {
            value: x[i],
            error: 0.0,
        })
        .collect();
    for j in 0..n {
        let column = lu.solve(|i| if i == j { 1.0 } else { 0.0 });
        for i in 0..n {
            found[i].error += column[i].abs() * sizes[j];
        }
    }
    Some(found)
}
