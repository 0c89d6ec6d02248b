//! Contacts, friction and constraints that hold by multipliers: which set of contact states follows an event.
//!
//! Each mode by hand, or the only one, is of all sets. A mode of all sets is integrated as any other; the discrete states choose
//! its rows (`codegen/multipliers.py`). What touches, and what of it has no rate, is known by bookkeeping: a closed contact stays on its gap, a sticking one has no slip rate, an
//! impact says which rates it leaves. The values of these numbers are roundings, and nothing is decided by them.
//!
//! - `geometry`: masses, and the lines along which contacts and constraints push.
//! - `hold`: positions and rates brought back to where they are held, to rounding.
//! - `singular`: how well the forces are determined that hold them.
//! - `judge`: all sets of states that may follow, each tried on the accelerations and higher derivatives that it leads to.
//! - `forced`: of these, those in which nothing slips that would hold.
//! - `motions`: of those that may go on, the one whose motion follows, or that there is none, or several.
//! - `unforced`: what contacts would do without forces, and which sets that rules out before they are judged.
//! - `share`: how those that stick share forces that are not determined.
//! - `many`: which of them are tried where these are too many; `pivoting`: what the accelerations say of that.
//! - `impact`: what an impact does, under the law of the scene.
//! - `phase`: all outcomes of one phase of it, each tried on its impulses and rates.
//! - `standing`: what touches at an instant, and what of it has no rate.
//! - `resolution`: how the end of a hop is known, and what is lower than that.
//! - `event`: from the fall of a guard to the next set.
//! - `by_hand`: transitions by hand beside contacts; `guarded`: those of their guards that contacts hold, or have held until now.
//! - `start`: the set that a run starts in; `equilibrium`: where it starts at rest.
//! - `limit`: the set at the limit of an accumulation.

mod by_hand;
mod equilibrium;
mod event;
mod forced;
mod geometry;
mod guarded;
mod hold;
mod impact;
mod judge;
mod limit;
mod many;
mod motions;
mod phase;
mod pivoting;
mod resolution;
mod share;
mod singular;
mod standing;
mod start;
mod unforced;

pub(super) use guarded::{Guarded, guarded_by_contacts};
pub(super) use hold::{held_by_others, hold};
pub(super) use singular::Conditioning;

use crate::model::Contacts;

/// What a contact that touches does along its tangent, as far as its slip rate says.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tangent {
    /// It has no friction.
    None,
    /// It has no slip rate.
    Still,
    /// It slips in this direction, +1 or −1.
    Slips(f64),
}

/// What a contact does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ContactState {
    Open,
    /// Closed, without friction.
    Closed,
    Sticks,
    /// With its direction.
    Slides(f64),
}

impl ContactState {
    fn is_closed(self) -> bool {
        self != ContactState::Open
    }

    /// Of the present discrete states.
    fn of(contacts: &Contacts, k: usize, discrete: &[f64]) -> Self {
        let contact = &contacts.contacts[k];
        if contact.closed.is_some_and(|i| discrete[i] == 0.0) {
            return ContactState::Open;
        }
        match contact.direction.map(|i| discrete[i]) {
            None => ContactState::Closed,
            Some(0.0) => ContactState::Sticks,
            Some(direction) => ContactState::Slides(direction),
        }
    }

    /// All of them.
    fn all(contacts: &Contacts, discrete: &[f64]) -> Vec<Self> {
        (0..contacts.contacts.len())
            .map(|k| ContactState::of(contacts, k, discrete))
            .collect()
    }
}
