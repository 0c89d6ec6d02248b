//! What contacts would do without forces, and which of their states cannot follow from that.
//!
//! Accelerations are linear in the forces along the lines: a = a₀ + W M⁻¹ Wᵀ λ, with those of constraints taken out. What a set of
//! states holds gives its forces, these its accelerations, all of them plain numbers: a set is ruled out where one of them has
//! the wrong sign by more than all numbers that it is made of were off by half of their digits. Any other is left to the
//! judge, who knows each rounding and looks at the derivatives.

use super::geometry::{Geometry, Line, write_states};
use super::hold::ContactValues;
use super::judge::{BACKWARDS, FORWARDS, GAP, SLIP, point};
use super::many::MAY_BE_ZERO;
use super::{ContactState, Tangent};
use crate::hybrid::simulation::Simulation;
use crate::model::Contacts;
use crate::numerics::{Dynamic, Lu, Size};

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
        let row = self.index(of) * self.lines.len();
        let parts = forces.iter();
        parts
            .map(|&(line, force)| self.compliance[row + self.index(line)] * force)
            .sum()
    }

    fn index(&self, line: Line) -> usize {
        let found = self.lines.iter().position(|known| *known == line);
        found.expect("every line is there")
    }

    /// The acceleration of what a line is about.
    pub fn acceleration(&self, of: Line) -> f64 {
        self.accelerations[self.index(of)].0
    }

    /// The most friction that one without a gap can hold.
    pub fn bound(&self, k: usize) -> f64 {
        self.bounds[k][0].0
    }

    /// Whether a set of contact states cannot follow, whose forces along some lines are unknown, all of them determined: those
    /// that stick beside the first of their line, `joined`, are none of these.
    pub fn rules_out(
        &self,
        places: &ContactValues,
        states: &[ContactState],
        touching: &[Option<Tangent>],
        (unknown, joined): (&[Line], &[(usize, usize)]),
    ) -> bool {
        let Some(forced) = Forced::new(self, places, (states, touching), unknown) else {
            return false;
        };
        let is_wrong = |(value, off): Rough| value < -off;
        (0..states.len()).any(|k| {
            let Some(tangent) = touching[k] else {
                return false;
            };
            let pulls = forced.force(Line::Normal(k)).is_some_and(is_wrong);
            pulls
                || match states[k] {
                    ContactState::Open => is_wrong(forced.acceleration(Line::Normal(k), 1.0)),
                    ContactState::Slides(direction) if tangent == Tangent::Still => {
                        is_wrong(forced.acceleration(Line::Tangent(k), direction))
                    }
                    ContactState::Sticks => {
                        let left = |(held, off): Rough| {
                            let beside = joined.iter().filter(|(_, first)| *first == k);
                            let all = beside.map(|(of, _)| *of).chain([k]);
                            all.fold((-held.abs(), off), |(left, off), k| {
                                let (most, rough) = forced.most_friction(k, places);
                                (left + most, off + rough)
                            })
                        };
                        let friction = forced.force(Line::Tangent(k));
                        friction.map(left).is_some_and(is_wrong)
                    }
                    _ => false,
                }
        })
    }
}

/// What contacts do under the forces of a set of their states.
struct Forced<'a> {
    unforced: &'a Unforced,
    /// The lines along which forces are unknown but for those of constraints, and the forces that come with a unit of each.
    unknown: Vec<Line>,
    pushed: Vec<Vec<(Line, f64)>>,
    /// Friction without a gap that slides, whose force is known.
    known: Vec<(Line, Rough)>,
    /// Those that were unknown.
    forces: Vec<Rough>,
}

impl<'a> Forced<'a> {
    /// The forces that hold what a set holds; `None` if they are not determined.
    fn new(
        unforced: &'a Unforced,
        places: &ContactValues,
        (states, touching): (&[ContactState], &[Option<Tangent>]),
        unknown: &[Line],
    ) -> Option<Self> {
        let is_constraint = |line: &&Line| matches!(line, Line::Constraint(_));
        let others = unknown.iter().filter(|line| !is_constraint(line));
        let unknown: Vec<Line> = others.copied().collect();
        let pushed = |&line: &Line| {
            let mut pushed = vec![(line, 1.0)];
            if let Line::Normal(k) = line
                && let ContactState::Slides(direction) = states[k]
            {
                pushed.push((Line::Tangent(k), -places.kinetic(k) * direction));
            }
            pushed
        };
        let known = |k: usize| match (states[k], touching[k]) {
            (ContactState::Slides(direction), Some(Tangent::Still))
                if !unforced.lines.contains(&Line::Normal(k)) =>
            {
                let [_, (kinetic, off)] = unforced.bounds[k];
                Some((Line::Tangent(k), (-kinetic * direction, off)))
            }
            _ => None,
        };
        let mut forced = Forced {
            pushed: unknown.iter().map(pushed).collect(),
            known: (0..states.len()).filter_map(known).collect(),
            forces: Vec::new(),
            unknown,
            unforced,
        };
        forced.solve()?;
        Some(forced)
    }

    /// Sets the forces: what they hold has no acceleration.
    fn solve(&mut self) -> Option<()> {
        let n = self.unknown.len();
        let matrix: Vec<f64> = (self.unknown.iter())
            .flat_map(|&row| (self.pushed.iter()).map(move |forces| (row, forces)))
            .map(|(row, forces)| self.unforced.moves(row, forces))
            .collect();
        let free: Vec<Rough> = (self.unknown.iter())
            .map(|&line| self.without_unknown(line))
            .collect();
        let entry = |i: usize, j: usize| matrix[i * n + j];
        let lu = Lu::<f64, Dynamic>::factorize(entry, &Dynamic(n).repeat(1.0)).ok()?;
        let solution = lu.solve(|i| -free[i].0);
        // What rough numbers would leave of the equations, times the inverse.
        let left = |i: usize| {
            let terms = (0..n).map(|j| (entry(i, j) * solution[j]).abs());
            free[i].1 + MAY_BE_ZERO * terms.sum::<f64>()
        };
        self.forces = (0..n).map(|i| (solution[i], 0.0)).collect();
        lu.inverse(|i, j, inverse| self.forces[i].1 += inverse.abs() * left(j));
        Some(())
    }

    /// The acceleration of what a line is about under the forces that are known.
    fn without_unknown(&self, of: Line) -> Rough {
        let own = self.unforced.accelerations[self.unforced.index(of)];
        self.known.iter().fold(own, |sum, &(line, force)| {
            add(sum, self.unforced.moves(of, &[(line, 1.0)]), force)
        })
    }

    /// The acceleration of what a line is about, times a sign.
    fn acceleration(&self, of: Line, sign: f64) -> Rough {
        let (own, off) = self.without_unknown(of);
        let forces = self.pushed.iter().zip(&self.forces);
        forces.fold((sign * own, off), |sum, (pushed, &force)| {
            add(sum, sign * self.unforced.moves(of, pushed), force)
        })
    }

    /// The force along a line, where that was unknown.
    fn force(&self, line: Line) -> Option<Rough> {
        let found = self.unknown.iter().position(|known| *known == line);
        found.map(|i| self.forces[i])
    }

    /// The most friction of a contact that sticks.
    fn most_friction(&self, k: usize, places: &ContactValues) -> Rough {
        match self.force(Line::Normal(k)) {
            Some(push) => add((0.0, 0.0), places.static_friction(k), push),
            None => self.unforced.bounds[k][0],
        }
    }
}

/// A sum and a multiple of another number: all three rough.
fn add((sum, off): Rough, factor: f64, (value, rough): Rough) -> Rough {
    let term = factor * value;
    (
        sum + term,
        off + factor.abs() * rough + MAY_BE_ZERO * term.abs(),
    )
}

impl<'p> Simulation<'p> {
    /// What contacts that touch do without forces; `None` if that is not known.
    pub(super) fn unforced(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &ContactValues,
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
            (
                known.value,
                known.error * (MAY_BE_ZERO / (0.5 * f64::EPSILON)),
            )
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
            let accelerates = frictions.iter().fold(own, |sum, &(friction, force)| {
                add(sum, -unforced.moves(*line, &[(friction, 1.0)]), force)
            });
            unforced.accelerations[i] = accelerates;
        }
        let is_known = |(value, off): &Rough| value.is_finite() && off.is_finite();
        (unforced.accelerations.iter())
            .all(is_known)
            .then_some(unforced)
    }
}
