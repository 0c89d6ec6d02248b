//! Singular positions: where constraints depend on each other and their forces are not determined.
//!
//! There the forces have a pole, while the motion goes on smoothly as a rule. How well the force is determined that is
//! determined least ([`Geometry::least_determined`]) is held against where in the run it was determined best.

use super::ContactState;
use super::geometry::{DEPENDENT, Geometry, Line};
use super::hold::{buffers, held_lines};
use crate::hybrid::failure::Reason;
use crate::kernel::Context;
use crate::model::{Contacts, Mode};

/// The least determined force as a part of the best, from which on a singular position is close: a step that has to show the
/// forces becomes as short as the pole is near, and none leads behind it. At 1/10 that costs a digit of the forces, and more is
/// left for the step that passes: it amplifies roundings as the inverse square of the part.
const NEARLY: f64 = 0.1;

/// How well the forces of contacts and constraints are determined at a state.
#[derive(Debug)]
pub(in crate::hybrid) struct Conditioning {
    geometry: Geometry,
    /// What is held in its place.
    places: Vec<Line>,
}

impl Conditioning {
    /// At a state of a mode, in the states of contacts that the context says, for whose time it is set; `None` without
    /// constraints: dependent contacts are told from each other when they close.
    pub fn new(context: &Context, contacts: &Contacts, state: [&[f64]; 2]) -> Option<Self> {
        if contacts.constraints.is_empty() {
            return None;
        }
        let [places, _] = held_lines(contacts, &ContactState::all(contacts, context.discrete()));
        let geometry = Geometry::new(context, contacts, buffers(state).each_ref());
        Some(Conditioning { geometry, places })
    }

    /// Whether a singular position is close; `best` is how well the least determined force was determined at best so far, and
    /// becomes what it is here where that is better.
    ///
    /// # Errors
    /// [`Reason::SingularPosition`] where it is not determined beyond rounding.
    pub fn is_nearly_singular(&self, mode: &Mode, best: &mut f64) -> Result<bool, Box<Reason>> {
        let Some((line, part)) = self.geometry.least_determined(&self.places) else {
            return Ok(false);
        };
        *best = best.max(part);
        if part <= DEPENDENT * *best {
            let contacts = mode.contacts.as_ref().expect("its lines are of these");
            let of = match line {
                Line::Normal(k) | Line::Tangent(k) => contacts.contacts[k].name,
                Line::Constraint(c) => contacts.constraints[c].name,
            };
            return Err(Box::new(Reason::SingularPosition {
                mode: mode.name,
                of,
            }));
        }
        Ok(part <= NEARLY * *best)
    }

    /// Whether a singular position lies between another state of the same mode and this one: what is left of the least determined
    /// line turns round there.
    pub fn is_beyond(&self, context: &Context, contacts: &Contacts, before: [&[f64]; 2]) -> bool {
        let before = Geometry::new(context, contacts, buffers(before).each_ref());
        (self.geometry.least_determined(&self.places))
            .is_some_and(|(line, _)| before.turns_round(line, &self.places, &self.geometry))
    }
}
