//! Guards by hand that are coordinates which contacts hold at zero, or have held until now.

use super::ContactState;
use super::event::GUARDS;
use super::geometry::{Geometry, Line};
use super::hold::{buffers, held_lines};
use crate::hybrid::guards::Linear;
use crate::hybrid::problem::Accuracy;
use crate::kernel::Context;
use crate::model::Mode;

/// What is known of such a guard from the contacts, whatever rounding makes of its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::hybrid) enum Guarded {
    /// It is zero as long as they are closed.
    Held,
    /// It rises from zero, as the gap of a contact does that opens now, by its guard.
    Rises(usize),
    /// It falls below zero as one opens.
    LeavesBelow,
}

/// The guards by hand of which contacts tell what they do, by their indices. `opening`: the guards of the contacts that leave
/// their gaps now. Where the ground moves gaps, nothing is held.
pub(in crate::hybrid) fn guarded_by_contacts(
    context: &Context,
    (mode, accuracy, opening): (&Mode, &Accuracy, &[usize]),
    state: [&[f64]; 2],
) -> Vec<(usize, Guarded)> {
    let contacts = mode.contacts.as_ref().expect("a mode of all sets");
    let by_hand = GUARDS * contacts.contacts.len()..mode.guards.len();
    // A coordinate that the tolerances do not tell from zero, and the sign of its factor.
    let coordinate = |guard: usize| match Linear::of(mode.guards[guard].shape, context)? {
        Linear {
            index,
            rate: false,
            offset: false,
            factor,
        } => {
            let is_zero = state[0][index].abs() <= accuracy.q_absolute[mode.free[index]];
            is_zero.then_some((guard, index, factor))
        }
        _ => None,
    };
    let found: Vec<(usize, usize, f64)> = by_hand.filter_map(coordinate).collect();
    if contacts.moved || found.is_empty() {
        return Vec::new();
    }
    let states = ContactState::all(contacts, context.discrete());
    let [places, _] = held_lines(contacts, &states);
    let geometry = Geometry::new(context, contacts, buffers(state).each_ref());
    let of = |(guard, index, factor): (usize, usize, f64)| {
        if geometry.moves(index, &places, None) == Some(0.0) {
            return Some((guard, Guarded::Held));
        }
        opening.iter().find_map(|&opens| {
            let line = Line::Normal(opens / GUARDS);
            let moves = factor * geometry.moves(index, &places, Some(line))?;
            let told = match moves > 0.0 {
                true => Guarded::Rises(opens),
                false => Guarded::LeavesBelow,
            };
            Some((guard, told))
        })
    };
    found.into_iter().filter_map(of).collect()
}
