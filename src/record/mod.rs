//! What a simulation leaves behind, and everything that is made of it.
//!
//! The event engine tells rows and transitions to an [`crate::hybrid::Observer`]; one that keeps them makes a [`Run`]
//! of them: the [`Trajectory`], one [`Event`] a transition, the [`Tally`] of these, the energy [`Ledger`], the
//! [`Solver`]'s counters, and a [`Failure`] where the run stopped early. Every name and unit comes from one [`Layout`],
//! made once from the model.
//!
//! A [`Stream`] writes them into an [`OutputFolder`] as they come, and at the end what is drawn from a [`Sketch`] of them:
//!
//! | file | what it holds |
//! |---|---|
//! | `trajectory.csv` | `t`, coordinates, velocities (`theta.rate`), reactions (`reaction.theta`, `reaction.z_h`), discrete states, energies, inputs, `mode` |
//! | `events.csv` | `t,j,transition,from,to`, every column of the state with `.before` and `.after`, `lost`, `ground_work` |
//! | `csv-metadata.json` | unit and meaning of every column of both tables |
//! | `summary.json` | a [`Summary`] |
//! | `overview.svg` | everything over time, with the modes and the transitions |
//! | `phase.svg` | phase portraits, where a coordinate moves |
//!
//! Numbers have 17 significant digits, so they are read back bit for bit. The same run gives the
//! same bytes, but for `wall_seconds` in the summary.

pub(crate) mod digest;
pub mod folder;
mod layout;
mod looks;
mod number;
mod peaks;
pub mod plot;
mod progress;
mod reached;
mod read;
mod recorder;
mod report;
mod run;
mod sketch;
mod stream;
pub mod summary;
pub mod table;
mod tally;
mod uncertain;

pub use folder::{FolderError, OutputFolder, StagedFile, Staging};
pub use layout::{Layout, Quantity, Recorded};
pub(crate) use looks::Looks;
pub(crate) use number::{exact, rounded};
pub use peaks::Peak;
pub use progress::{Progress, ProgressLine, Silent};
pub use reached::{Left, LimitState, Reached};
pub use read::{Earlier, ReadError};
pub use recorder::Recorder;
pub use report::Report;
pub use run::{
    Column, EnergyJump, ErrorEstimate, Event, Failure, Group, Jump, Ledger, Place, Run, Snapshot,
    Solver, Subject, Trajectory,
};
pub use sketch::Sketch;
pub use stream::{OVERVIEW, PHASE, Stream};
pub use summary::Summary;
pub use tally::{Counted, Gain, Impacts, Tally};
pub use uncertain::{Doubt, Question, Uncertain};
