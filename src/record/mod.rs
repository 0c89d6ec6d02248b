//! What a simulation leaves behind, and everything that is made of it.
//!
//! The event engine fills a [`Run`]: the [`Trajectory`] through a [`Recorder`], one [`Event`] a
//! transition, the energy [`Ledger`], the [`Solver`]'s counters, and a [`Failure`] where the run
//! stopped early. Every name and unit comes from one [`Layout`], made once from the model.

mod files;
pub mod folder;
mod layout;
mod number;
mod peaks;
pub mod plot;
mod progress;
mod recorder;
mod report;
mod run;
pub mod summary;
pub mod table;

pub use files::{OVERVIEW, PHASE};
pub use folder::{FolderError, OutputFolder};
pub use layout::{Layout, Quantity, Recorded};
pub use peaks::{Peak, peaks};
pub use progress::{Progress, ProgressLine, Silent};
pub use recorder::Recorder;
pub use report::Report;
pub use run::{
    Column, EnergyJump, Event, Failure, Group, Ledger, Place, Run, Snapshot, Solver, Subject,
    Trajectory,
};
pub use summary::Summary;
