//! What a run cannot tell at its tolerance.

use serde::{Deserialize, Serialize};

/// Where the errors that the tolerances allow decide whether something happens.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Uncertain {
    /// Number of such places.
    pub total: u64,
    /// The first of them, at most [`Uncertain::MOST`].
    pub first: Vec<Doubt>,
}

/// A place where a run cannot tell whether a guard falls through zero, or which of its transitions is taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Doubt {
    /// Time (s).
    pub t: f64,
    /// Name of the mode.
    pub mode: String,
    /// Name of the guard, or `condition of` the name of a transition, or of the transition that is unsettled.
    pub guard: String,
    /// What is in doubt.
    pub what: Question,
    /// Least value of the guard nearby, in `unit`; of a guard that was not resolved, its value at the
    /// end of the step; of a condition, its value at the event; of what is unsettled, by how much the time of the event
    /// before differs at the other tolerance.
    pub value: f64,
    /// Error of that value that the tolerances allow, in `unit`.
    pub error: f64,
    /// Unit of the guard.
    pub unit: String,
}

/// What is in doubt about a guard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Question {
    /// It fell through zero, but by no more than its error before it would have turned back.
    Graze,
    /// It turned back before zero, by no more than its error.
    NearMiss,
    /// It could not be resolved on a step: events between single values may have been missed.
    Unresolved,
    /// A condition that decides which transition is taken is no farther from zero than its error.
    Choice,
    /// At another tolerance another event follows.
    Unsettled,
}

impl Uncertain {
    /// Most places that are listed: one that grazes in every cycle would fill the summary.
    pub const MOST: usize = 20;

    /// Counts a place, and lists it while there is room.
    pub fn add(&mut self, doubt: Doubt) {
        self.total += 1;
        if self.first.len() < Self::MOST {
            self.first.push(doubt);
        }
    }

    /// The same of a place that comes before all that are listed.
    pub fn add_earlier(&mut self, doubt: Doubt) {
        self.total += 1;
        self.first.insert(0, doubt);
        self.first.truncate(Self::MOST);
    }
}
