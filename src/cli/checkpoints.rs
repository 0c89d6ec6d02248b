//! When checkpoints of a run are taken.

use std::time::{Duration, Instant};

use crate::hybrid::Checkpoint;
use crate::record::Kept;

/// So much work is done again by a run that is gone on with, at most: nobody waits long for it.
const APART: Duration = Duration::from_secs(1);

/// A checkpoint takes a hundredth of a run, at most.
const SHARE: u32 = 100;

/// The last checkpoint of a run, and what has come since its start.
pub struct Checkpoints {
    /// When the run is to end, s.
    end: f64,
    begun: Instant,
    /// What it took to come to where it was begun, in an earlier run.
    before: Duration,
    last: Instant,
    asked: Instant,
    apart: Duration,
    /// Rows and transitions so far.
    pub rows: u64,
    pub events: u64,
    pub kept: Option<Kept>,
}

impl Checkpoints {
    /// None yet, of a run to this end (s) that begins now.
    pub fn new(end: f64) -> Self {
        let now = Instant::now();
        Checkpoints {
            end,
            begun: now,
            before: Duration::ZERO,
            last: now,
            asked: now,
            apart: APART,
            rows: 0,
            events: 0,
            kept: None,
        }
    }

    /// A run that goes on now from a checkpoint, whose rows and transitions were counted as they were told again.
    pub fn go_on(&mut self, kept: Kept) {
        let now = Instant::now();
        (self.begun, self.last) = (now, now);
        self.before = Duration::try_from_secs_f64(kept.wall_seconds).unwrap_or_default();
        self.kept = Some(kept);
    }

    /// What it took to come to the checkpoint from which the run has gone on.
    pub fn before(&self) -> Duration {
        self.before
    }

    /// Whether the next one is due.
    pub fn is_due(&mut self) -> bool {
        self.asked = Instant::now();
        self.asked - self.last >= self.apart
    }

    /// Takes one. `spent`: what files took, which is not the run's.
    pub fn take(&mut self, checkpoint: Checkpoint, spent: Duration) {
        let wall = self.before + self.begun.elapsed().saturating_sub(spent);
        self.kept = Some(Kept {
            rows: self.rows,
            events: self.events,
            end: self.end,
            wall_seconds: wall.as_secs_f64(),
            checkpoint,
        });
        self.apart = APART.max(self.asked.elapsed() * SHARE);
        self.last = Instant::now();
    }
}
