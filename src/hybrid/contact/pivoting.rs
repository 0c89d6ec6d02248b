//! What a pivoting method is asked about accelerations, and what it says.

use super::geometry::{Geometry, Line};
use super::hold::ContactValues;
use super::many::{Answer, Answers, Asked, Friction, answers};
use super::unforced::Unforced;
use super::{ContactState, Tangent};
use crate::hybrid::simulation::Simulation;
use crate::model::Contacts;
use crate::numerics::Unsolved;

impl<'p> Simulation<'p> {
    /// What a pivoting method says that contacts do, on their accelerations: where what has come to the limit of static friction
    /// sticks, and where it slips.
    pub(super) fn answers(
        &self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &ContactValues,
        (touching, unforced): (&[Option<Tangent>], &Unforced),
    ) -> Result<Vec<Answers<ContactState>>, Unsolved> {
        let bare = |k: usize| contacts.contacts[k].normal.is_none();
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
                        let part = match coefficient == places.static_friction(k) {
                            true => 1.0,
                            false => coefficient / places.static_friction(k),
                        };
                        Friction::Still {
                            slip: unforced.acceleration(Line::Tangent(k)),
                            coefficient,
                            bound: if bare(k) {
                                unforced.bound(k) * part
                            } else {
                                0.0
                            },
                        }
                    }
                };
                if bare(k) && tangent != Tangent::Still {
                    continue;
                }
                let normal = |_| [unforced.acceleration(Line::Normal(k)), 0.0];
                asked.push(Asked {
                    contact: k,
                    normal: contact.normal.map(normal),
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
