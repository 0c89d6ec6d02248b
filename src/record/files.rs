//! All the files of a run.

use super::plot::{overview, phase_portraits};
use super::summary::SUMMARY;
use super::table::{EVENTS, METADATA, TRAJECTORY, write_events, write_metadata, write_trajectory};
use super::{FolderError, OutputFolder, Run, Summary};

/// File name of the picture of everything over time.
pub const OVERVIEW: &str = "overview.svg";
/// File name of the phase portraits.
pub const PHASE: &str = "phase.svg";

impl Run {
    /// Writes the run: the tables, the summary and the pictures. A run that stopped early is
    /// written in the same way, as far as it came, with the reason in the summary.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), FolderError> {
        folder.replace(|files| {
            files.file(TRAJECTORY, |out| write_trajectory(self, out))?;
            files.file(EVENTS, |out| write_events(self, out))?;
            files.file(METADATA, |out| write_metadata(self, out))?;
            files.file(SUMMARY, |out| Summary::new(self).write(out))?;
            files.file(OVERVIEW, |out| out.write_all(overview(self).as_bytes()))?;
            match phase_portraits(self) {
                Some(portraits) => files.file(PHASE, |out| out.write_all(portraits.as_bytes())),
                None => Ok(()),
            }
        })
    }
}
