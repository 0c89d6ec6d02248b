//! Expansions in time with bounds of their rounding: what the signs of derivatives really are.
//!
//! Generated C computes in doubles and does not know what it is off by. Where a sign that rounding decides is asked
//! for, as with which sign a guard that is zero leaves zero, the same expressions are expanded here: a [`Tape`] holds
//! them as the generator derived them, in the parameters themselves, and `Expansion` gives the Taylor coefficients
//! along the exact motion, each with a [`Bounded`] error. That does not depend on the method of integration, and needs
//! no recurrence in C. It is interpreted, so it is for the few states where nothing else tells.

mod expansion;

pub(crate) use crate::model::JET_ORDERS as ORDERS;
pub use crate::model::Tape;
pub use crate::numerics::Bounded;
pub(crate) use expansion::{Expansion, Point};
