//! Slips that something forces: of the sets that may go on, those in which nothing slips that would hold.

use super::geometry::{Geometry, write_states};
use super::hold::ContactValues;
use super::judge::{Admitted, BACKWARDS, Candidate, FORWARDS};
use super::share::Sharing;
use super::{ContactState, Tangent};
use crate::hybrid::frictions::forces_all;
use crate::hybrid::simulation::Simulation;
use crate::model::Contacts;

impl<'p> Simulation<'p> {
    /// Leaves out sets in which something slips that nothing forces to, where others may go on: where all stick that have no slip rate,
    /// some are beyond what they hold; one that slips may bring others there, and so on. Else whatever is above its kinetic friction could
    /// slip in place of what has reached its limit.
    pub(super) fn keep_what_is_forced(
        &mut self,
        of: (&'p Contacts, &Geometry),
        places: &ContactValues,
        touching: &[Option<Tangent>],
        admitted: &mut Vec<Admitted>,
    ) {
        let forced: Vec<bool> = (admitted.iter())
            .map(|Admitted { candidate, .. }| {
                let begins = |k: &usize| {
                    let slides = matches!(candidate.states[*k], ContactState::Slides(_));
                    slides && touching[*k] == Some(Tangent::Still)
                };
                let slips: Vec<usize> = (0..touching.len()).filter(begins).collect();
                forces_all(slips.len(), |slipping, next| {
                    let mut states = candidate.states.clone();
                    let sticks = (0..slips.len()).filter(|i| !slipping[*i]);
                    sticks.for_each(|i| states[slips[i]] = ContactState::Sticks);
                    !self.holds_there(of, places, (states, slips[next]))
                })
            })
            .collect();
        if forced.contains(&true) {
            let mut forced = forced.into_iter();
            admitted.retain(|_| forced.next() == Some(true));
        }
    }

    /// Whether a contact that sticks in a set holds there, whatever others do.
    fn holds_there(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &ContactValues,
        (states, k): (Vec<ContactState>, usize),
    ) -> bool {
        let Some(sharing) = Sharing::new(contacts, geometry, places, &states) else {
            return false;
        };
        let mut discrete = self.context.discrete().to_vec();
        write_states(contacts, &states, &mut discrete);
        sharing.write(contacts, &sharing.without_friction(geometry), &mut discrete);
        // What others hold has no friction that is its own.
        if contacts.contacts[k].is_dropped(&discrete) {
            return false;
        }
        let of = |what: usize| (k * Contacts::DECISIONS + what, 1.0);
        let asked = vec![of(FORWARDS), of(BACKWARDS)];
        let candidate = Candidate { states, discrete };
        self.stay_positive(contacts, (&candidate, false), asked)
            .is_some()
    }
}
