//! The checkpoint of a run in its folder.

use serde::{Deserialize, Serialize};

use crate::hybrid::Checkpoint;

/// Name of its file, which only a run that took some time has.
pub(super) const CHECKPOINT: &str = ".dalembert-checkpoint";

/// A checkpoint, with what of the run's tables is before it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Kept {
    /// Rows of the trajectory.
    pub rows: u64,
    /// Transitions.
    pub events: u64,
    /// When the run was to end, s: it is a checkpoint of a run with that end or a later one. Steps of one with an earlier end might be
    /// shaped by that.
    pub end: f64,
    /// What it took to come there, s.
    pub wall_seconds: f64,
    /// The checkpoint.
    pub checkpoint: Checkpoint,
}
