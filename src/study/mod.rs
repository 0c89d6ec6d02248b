//! Many runs as one question: designs of what varies, and what their results say.
//!
//! A study file says what varies in a scene (`file`); that makes cases (`design`, `distribution`, `sampling`), of each of which
//! one run or several are made (`procedure`, `member`), side by side (`batch`), on all cores (`work`). What is measured of them (`measure`) are the rows
//! of one table (`rows`, `table`); a folder keeps them while the study goes on (`folder`). In the end they are counted and
//! fitted (`summary`, `fragility`, `cloud`) and drawn (`charts`).

#[cfg(feature = "cli")]
mod batch;
#[cfg(feature = "cli")]
mod capacities;
#[cfg(feature = "cli")]
mod charts;
#[cfg(feature = "cli")]
mod cloud;
#[cfg(feature = "cli")]
mod command;
#[cfg(feature = "cli")]
mod design;
#[cfg(feature = "cli")]
mod distribution;
#[cfg(feature = "cli")]
mod ending;
#[cfg(feature = "cli")]
mod file;
#[cfg(feature = "cli")]
mod finish;
#[cfg(feature = "cli")]
mod folder;
pub mod fragility;
#[cfg(feature = "cli")]
mod measure;
#[cfg(feature = "cli")]
mod member;
pub mod normal;
#[cfg(feature = "cli")]
mod procedure;
#[cfg(feature = "cli")]
mod rows;
pub mod sampling;
#[cfg(feature = "cli")]
mod summary;
#[cfg(feature = "cli")]
mod table;
#[cfg(feature = "cli")]
mod work;

#[cfg(feature = "cli")]
pub(crate) use charts::{default_columns, numbers, pictures};
#[cfg(feature = "cli")]
pub(crate) use command::{command, quoted};
#[cfg(feature = "cli")]
pub(crate) use file::Study;
#[cfg(feature = "cli")]
pub use file::schema;
#[cfg(feature = "cli")]
pub(crate) use finish::{Found, finish};
#[cfg(feature = "cli")]
pub(crate) use folder::{Finished, StudyFolder, StudyFolderError, finished};
#[cfg(feature = "cli")]
pub(crate) use rows::Row;
#[cfg(feature = "cli")]
pub(crate) use summary::Outcome;
#[cfg(feature = "cli")]
pub(crate) use table::Column;
#[cfg(feature = "cli")]
pub(crate) use work::{Ended, Shard, Watch, run};
