//! What a pivoting method is asked about accelerations, and what it says.

use super::geometry::{Geometry, Line, write_states};
use super::hold::Places;
use super::judge::{BACKWARDS, FORWARDS, GAP, SLIP, point};
use super::many::{Answer, Answers, Asked, Friction, answers};
use super::{ContactState, Tangent};
use crate::hybrid::simulation::Simulation;
use crate::model::Contacts;
use crate::numerics::Unsolved;

impl<'p> Simulation<'p> {
    /// What a pivoting method says that contacts do, on their accelerations: where what has come to the limit of static friction
    /// sticks, and where it slips.
    pub(super) fn answers(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &Places,
        touching: &[Option<Tangent>],
    ) -> Result<Vec<Answers<ContactState>>, Unsolved> {
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
        self.expansion.begin(mode, at, None);
        self.expansion.expand(mode, tape, 0);
        let value = |k: usize, what: usize| {
            self.expansion.result(tape, k * Contacts::DECISIONS + what)[0].value
        };
        // Friction without a gap acts there already, as what slides forwards; it is taken out again.
        let bare = |k: usize| contacts.contacts[k].normal.is_none();
        let frictions: Vec<(Line, f64)> = (0..touching.len())
            .filter(|&k| bare(k) && touching[k] == Some(Tangent::Still))
            .map(|k| {
                let force = 0.5 * (value(k, BACKWARDS) - value(k, FORWARDS));
                (Line::Tangent(k), force)
            })
            .collect();
        let constraints: Vec<Line> = (0..contacts.constraints.len())
            .map(Line::Constraint)
            .collect();
        let lines: Vec<Line> = geometry.all().collect();
        let compliance = geometry.compliance(&lines, &constraints);
        let taken_out = |of: Line| -> f64 {
            let place = |line: Line| lines.iter().position(|known| *known == line);
            let at = |of: Line, line: Line| Some(place(of)? * lines.len() + place(line)?);
            let parts = frictions.iter();
            parts
                .filter_map(|&(line, force)| Some(compliance[at(of, line)?] * force))
                .sum()
        };
        let mut all: Vec<Answers<ContactState>> = Vec::new();
        // Static friction, until one is seen to slip.
        let mut slips = vec![false; touching.len()];
        loop {
            let mut asked = Vec::new();
            for (k, contact) in contacts.contacts.iter().enumerate() {
                let Some(tangent) = touching[k] else { continue };
                let coefficient = match slips[k] {
                    true => places.kinetic(k),
                    false => places.static_friction(k),
                };
                let friction = match tangent {
                    Tangent::None => Friction::None,
                    Tangent::Slips(direction) => Friction::Slips {
                        direction,
                        coefficient: places.kinetic(k),
                    },
                    Tangent::Still => {
                        let limit = 0.5 * (value(k, FORWARDS) + value(k, BACKWARDS));
                        let part = match coefficient == places.static_friction(k) {
                            true => 1.0,
                            false => coefficient / places.static_friction(k),
                        };
                        Friction::Still {
                            slip: value(k, SLIP) - taken_out(Line::Tangent(k)),
                            coefficient,
                            bound: if bare(k) { limit * part } else { 0.0 },
                        }
                    }
                };
                if bare(k) && tangent != Tangent::Still {
                    continue;
                }
                let normal = value(k, GAP) - taken_out(Line::Normal(k));
                asked.push(Asked {
                    contact: k,
                    normal: contact.normal.map(|_| [normal, 0.0]),
                    friction,
                });
            }
            let answers = answers(contacts, geometry, &asked)?;
            let mut goes_on = false;
            let mut found: Answers<ContactState> = vec![(None, false); touching.len()];
            let mut sticks = found.clone();
            for (asked, (answer, open)) in asked.iter().zip(answers) {
                let k = asked.contact;
                let state = match (answer, touching[k]) {
                    (Answer::Opens, _) => ContactState::Open,
                    (_, Some(Tangent::Slips(direction))) => ContactState::Slides(direction),
                    (_, Some(Tangent::None)) => ContactState::Closed,
                    (Answer::Slips(way) | Answer::Yields(way), _) => ContactState::Slides(way),
                    (Answer::Holds, _) => ContactState::Sticks,
                };
                let starts = matches!(answer, Answer::Slips(_) | Answer::Yields(_));
                goes_on |= starts && !slips[k] && places.kinetic(k) != places.static_friction(k);
                slips[k] |= starts;
                found[k] = (Some(state), open);
                let held = match (answer, touching[k]) {
                    (Answer::Yields(_), Some(Tangent::Still)) => ContactState::Sticks,
                    _ => state,
                };
                sticks[k] = (Some(held), open);
            }
            if all.is_empty() {
                all.push(sticks);
            }
            if !goes_on {
                all.push(found);
                return Ok(all);
            }
        }
    }
}
