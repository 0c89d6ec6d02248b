//! Files, tables and plots of runs, whose values [`crate::run`] has.
//!
//! A [`Stream`] writes rows and transitions into an [`OutputFolder`] as they come, and at the end what is drawn from a [`Sketch`] of them:
//!
//! | file | what it holds |
//! |---|---|
//! | `trajectory.csv` | `t`, coordinates, velocities (`theta.rate`), reactions (`reaction.theta`, `reaction.z_h`), discrete states, energies, inputs, `mode` |
//! | `events.csv` | `t,j,transition,from,to`, every column of the state with `.before` and `.after`, the impulses of contacts and constraints (`left.normal_impulse`), `lost`, `ground_work` |
//! | `csv-metadata.json` | unit and meaning of every column of both tables |
//! | `summary.json` | a [`Summary`] |
//! | `overview.svg` | everything over time, with the modes and the transitions |
//! | `phase.svg` | phase portraits, where a coordinate moves |
//!
//! Numbers have the fewest digits that read back to the same bits. The same run gives the
//! same bytes, but for `wall_seconds` in the summary, and for the checkpoint of a run that took more than a second, by which it
//! goes on.

mod clock;
mod digest;
pub mod folder;
mod kept;
mod number;
#[cfg(feature = "plots")]
pub mod plot;
#[cfg(feature = "cli")]
mod progress;
mod read;
mod report;
#[cfg(feature = "plots")]
mod sketch;
#[cfg(feature = "plots")]
mod stream;
pub mod summary;
pub mod table;
mod units;

pub use crate::hybrid::{Failure, Run};
pub use crate::run::*;
pub(crate) use clock::SparseClock;
pub use folder::{FolderError, OutputFolder, StagedFile, Staging};
pub use kept::Kept;
#[cfg(feature = "plots")]
pub(crate) use number::{exact, rounded};
#[cfg(feature = "cli")]
pub use progress::ProgressLine;
pub use read::{Earlier, ReadError};
pub use report::Report;
#[cfg(feature = "plots")]
pub use sketch::Sketch;
#[cfg(feature = "plots")]
pub use stream::{OVERVIEW, PHASE, Stream};
pub use summary::Summary;
pub use units::Units;
