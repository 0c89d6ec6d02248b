//! What a simulation leaves behind, as values: it is told to an observer, and one that keeps it makes a run of it: the
//! [`Trajectory`], one [`Event`] a transition, the [`Tally`] of these, the energy [`Ledger`], and the [`Solver`]'s counters. Every
//! name and unit comes from one [`Layout`], made once from the model. Files, tables and plots are made of it in
//! [`crate::record`].

mod digest;
mod layout;
mod modes;
mod peaks;
mod progress;
mod reached;
mod recorder;
mod result;
mod tally;
mod uncertain;

pub(crate) use digest::{digest, hexadecimal};
pub use layout::{Layout, Quantity, Recorded};
pub use modes::ModeNames;
pub use peaks::Peak;
pub use progress::{Progress, Silent, Until};
pub use reached::{Left, LimitState, Reached};
pub use recorder::Recorder;
pub use result::{
    Column, ColumnKind, EnergyJump, ErrorEstimate, Event, HybridState, Jump, Ledger, Sides,
    Snapshot, Solver, Subject, Trajectory,
};
pub use tally::{Counted, Gain, Impacts, Tally};
pub use uncertain::{Doubt, Question, Uncertain};
