//! What contacts would do without forces, and which of their states cannot follow from that.
//!
//! Accelerations are linear in the forces along the lines: a = a₀ + W M⁻¹ Wᵀ λ, with those of constraints taken out. What a set of
//! states holds gives its forces, these its accelerations, all of them plain numbers: a set is ruled out where one of them has
//! the wrong sign by more than all numbers that it is made of were off by half of their digits. Any other is left to the
//! judge, who knows each rounding and looks at the derivatives.

use super::geometry::{Geometry, Line, write_states};
use super::hold::Places;
use super::judge::{BACKWARDS, FORWARDS, GAP, SLIP, point};
use super::{ContactState, Tangent};
use crate::hybrid::simulation::Simulation;
use crate::model::Contacts;
use crate::numerics::{Dynamic, Lu, Size};

/// Half of the digits of a double, as a part of a number: √ε, twice what is asked of a `CLEAR` acceleration (`enter.rs`).
const HALF: f64 = 1.0 / (1u64 << 26) as f64;

/// A number, and what it would be off by if it were known to half of its digits.
type Rough = (f64, f64);

/// What contacts do without forces, but for friction without a gap that slips.
pub(super) struct Unforced {
    lines: Vec<Line>,
    /// How what each line is about moves per force along each, row by row, while constraints hold.
    compliance: Vec<f64>,
    /// Accelerations of what the lines are about; not of constraints, which have none.
    accelerations: Vec<Rough>,
    /// Of friction without a gap, the most of it: static, kinetic.
    bounds: Vec<[Rough; 2]>,
}

impl Unforced {
    /// How what a line is about moves with forces.
    fn moves(&self, of: Line, forces: &[(Line, f64)]) -> f64 {
        let row = self.place(of) * self.lines.len();
        let parts = forces.iter();
        parts
            .map(|&(line, force)| self.compliance[row + self.place(line)] * force)
            .sum()
    }

    fn place(&self, line: Line) -> usize {
        let found = self.lines.iter().position(|known| *known == line);
        found.expect("every line is there")
    }

    /// The acceleration of what a line is about.
    pub fn acceleration(&self, of: Line) -> f64 {
        self.accelerations[self.place(of)].0
    }

    /// The most friction that one without a gap can hold.
    pub fn bound(&self, k: usize) -> f64 {
        self.bounds[k][0].0
    }

    /// Whether a set of contact states cannot follow, whose forces along some lines are unknown, all of them determined: those
    /// that stick beside the first of their line, `joined`, are none of these.
    pub fn rules_out(
        &self,
        places: &Places,
        states: &[ContactState],
        touching: &[Option<Tangent>],
        (unknown, joined): (&[Line], &[(usize, usize)]),
    ) -> bool {
        let is_constraint = |line: &&Line| matches!(line, Line::Constraint(_));
        let unknown: Vec<Line> = unknown
            .iter()
            .filter(|l| !is_constraint(l))
            .copied()
            .collect();
        // The forces that come with a unit of each unknown one, and those that are known.
        let pushed = |line: Line| match line {
            Line::Normal(k) => match states[k] {
                ContactState::Slides(direction) => {
                    vec![
                        (line, 1.0),
                        (Line::Tangent(k), -places.kinetic(k) * direction),
                    ]
                }
                _ => vec![(line, 1.0)],
            },
            _ => vec![(line, 1.0)],
        };
        let pushed: Vec<_> = unknown.iter().map(|&line| pushed(line)).collect();
        let known = |k: usize| match (states[k], touching[k]) {
            (ContactState::Slides(direction), Some(Tangent::Still))
                if !self.lines.contains(&Line::Normal(k)) =>
            {
                let [_, (kinetic, off)] = self.bounds[k];
                Some((k, -kinetic * direction, off))
            }
            _ => None,
        };
        let known: Vec<_> = (0..states.len()).filter_map(known).collect();
        let free = |of: Line| -> Rough {
            let own = self.accelerations[self.place(of)];
            known.iter().fold(own, |(sum, off), &(k, force, rough)| {
                let per_force = self.moves(of, &[(Line::Tangent(k), 1.0)]);
                let term = per_force * force;
                (
                    sum + term,
                    off + per_force.abs() * rough + HALF * term.abs(),
                )
            })
        };
        let n = unknown.len();
        let matrix: Vec<f64> = (unknown.iter())
            .flat_map(|&row| pushed.iter().map(move |forces| self.moves(row, forces)))
            .collect();
        let left: Vec<Rough> = unknown.iter().map(|&line| free(line)).collect();
        let entry = |i: usize, j: usize| matrix[i * n + j];
        let Ok(lu) = Lu::<f64, Dynamic>::factorize(entry, &Dynamic(n).repeat(1.0)) else {
            return false;
        };
        let solution = lu.solve(|i| -left[i].0);
        // What the residual of other numbers would be, times the inverse.
        let mut forces: Vec<Rough> = (0..n).map(|i| (solution[i], 0.0)).collect();
        let off: Vec<f64> = (0..n)
            .map(|i| {
                left[i].1
                    + HALF
                        * (0..n)
                            .map(|j| (matrix[i * n + j] * solution[j]).abs())
                            .sum::<f64>()
            })
            .collect();
        lu.inverse(|i, j, inverse| forces[i].1 += inverse.abs() * off[j]);
        let is_wrong = |(value, off): Rough| value < -off;
        let acceleration = |of: Line, sign: f64| -> Rough {
            let (own, rough) = free(of);
            pushed.iter().zip(&forces).fold(
                (sign * own, rough),
                |(sum, off), (per, &(force, rough))| {
                    let per_force = self.moves(of, per);
                    (
                        sum + sign * per_force * force,
                        off + per_force.abs() * (rough + HALF * force.abs()),
                    )
                },
            )
        };
        let force = |line: Line| {
            let found = unknown.iter().position(|known| *known == line);
            found.map(|i| forces[i])
        };
        // The most friction of a contact that sticks.
        let most = |k: usize| match force(Line::Normal(k)) {
            Some((push, off)) => {
                let coefficient = places.static_friction(k);
                (coefficient * push, coefficient * (off + HALF * push.abs()))
            }
            None => self.bounds[k][0],
        };
        (0..states.len()).any(|k| {
            let Some(tangent) = touching[k] else {
                return false;
            };
            let pulls = force(Line::Normal(k)).is_some_and(is_wrong);
            pulls
                || match states[k] {
                    ContactState::Open => is_wrong(acceleration(Line::Normal(k), 1.0)),
                    ContactState::Slides(direction) if tangent == Tangent::Still => {
                        is_wrong(acceleration(Line::Tangent(k), direction))
                    }
                    ContactState::Sticks => force(Line::Tangent(k)).is_some_and(|(held, off)| {
                        let beside = joined.iter().filter(|(_, first)| *first == k);
                        let all = beside.map(|(of, _)| *of).chain([k]);
                        is_wrong(all.fold((-held.abs(), off), |(left, off), k| {
                            let (most, rough) = most(k);
                            (left + most, off + rough)
                        }))
                    }),
                    _ => false,
                }
        })
    }
}

impl<'p> Simulation<'p> {
    /// What contacts that touch do without forces; `None` if that is not known.
    pub(super) fn unforced(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &Places,
        touching: &[Option<Tangent>],
    ) -> Option<Unforced> {
        let without_forces: Vec<ContactState> = (contacts.contacts.iter().zip(touching))
            .map(|(contact, tangent)| match (contact.normal, tangent) {
                (Some(_), _) => ContactState::Open,
                (None, Some(Tangent::Slips(direction))) => ContactState::Slides(*direction),
                (None, _) => ContactState::Slides(1.0),
            })
            .collect();
        let mut discrete = self.context.discrete().to_vec();
        write_states(contacts, &without_forces, &mut discrete);
        let mode = self.mode();
        let at = point(&self.next, self.here.q.len(), &discrete);
        let tape = &contacts.decisions;
        let sizes = [&*self.sizes, &*self.rate_sizes];
        self.expansion.begin(mode, at, Some(sizes));
        self.expansion.expand(mode, tape, 0);
        // An error is no less than a rounding of all terms.
        let result = |k: usize, what: usize| -> Rough {
            let known = self.expansion.result(tape, k * Contacts::DECISIONS + what)[0];
            (known.value, known.error * (HALF / (0.5 * f64::EPSILON)))
        };
        let constraints: Vec<Line> = (0..contacts.constraints.len())
            .map(Line::Constraint)
            .collect();
        let lines: Vec<Line> = geometry.all().collect();
        let compliance = geometry.compliance(&lines, &constraints);
        let half = |(a, off_a): Rough, (b, off_b): Rough| (0.5 * (a + b), 0.5 * (off_a + off_b));
        let bounds = (0..touching.len())
            .map(|k| {
                let most = half(result(k, FORWARDS), result(k, BACKWARDS));
                let part = match places.kinetic(k) == places.static_friction(k) {
                    true => 1.0,
                    false => places.kinetic(k) / places.static_friction(k),
                };
                [most, (part * most.0, part * most.1)]
            })
            .collect();
        let mut unforced = Unforced {
            accelerations: vec![(0.0, 0.0); lines.len()],
            lines,
            compliance,
            bounds,
        };
        // Friction without a gap acts there already, as what slides forwards; it is taken out again.
        let frictions: Vec<(Line, Rough)> = (0..touching.len())
            .filter(|&k| {
                contacts.contacts[k].normal.is_none() && touching[k] == Some(Tangent::Still)
            })
            .map(|k| {
                let (value, off) = result(k, FORWARDS);
                let against = half(result(k, BACKWARDS), (-value, off));
                (Line::Tangent(k), against)
            })
            .collect();
        for (i, line) in unforced.lines.iter().enumerate() {
            let own = match *line {
                Line::Normal(k) => result(k, GAP),
                Line::Tangent(k) => result(k, SLIP),
                Line::Constraint(_) => continue,
            };
            let accelerates = frictions
                .iter()
                .fold(own, |(sum, off), &(line, (force, rough))| {
                    let per_force = unforced.moves(unforced.lines[i], &[(line, 1.0)]);
                    (
                        sum - per_force * force,
                        off + per_force.abs() * (rough + HALF * force.abs()),
                    )
                });
            unforced.accelerations[i] = accelerates;
        }
        let is_known = |(value, off): &Rough| value.is_finite() && off.is_finite();
        (unforced.accelerations.iter())
            .all(is_known)
            .then_some(unforced)
    }
}
