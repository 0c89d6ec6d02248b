//! The limit that the last events have told best while patterns repeat: as hops become shorter their series is nearer to a geometric one,
//! but their durations are told less well.

use super::{Accumulation, LONGEST_PATTERN, Limit};
use crate::hybrid::instant::Instant;
use crate::numerics::{Memory, Persist};

/// A limit that was told.
#[derive(Debug)]
pub(super) struct Prediction {
    /// What the last three predictions differed by at most, s; infinite where none is known.
    uncertainty: f64,
    /// What the last two predictions differed by, s.
    last: [f64; 2],
    /// Number of events since.
    since: usize,
    at: Instant,
    /// Coordinates and velocities, then what they may be off by.
    state: Box<[f64]>,
    state_uncertainty: Box<[f64]>,
}

impl Persist for Prediction {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.uncertainty.persist(memory)?;
        self.last.persist(memory)?;
        self.since.persist(memory)?;
        self.at.persist(memory)?;
        memory.slice(&mut self.state)?;
        memory.slice(&mut self.state_uncertainty)
    }
}

impl Prediction {
    /// None yet, of so many coordinates and velocities.
    pub fn none(numbers: usize) -> Self {
        Prediction {
            uncertainty: f64::INFINITY,
            last: [f64::INFINITY; 2],
            since: 0,
            at: Instant::default(),
            state: vec![0.0; numbers].into(),
            state_uncertainty: vec![0.0; numbers].into(),
        }
    }

    /// Forgets it.
    pub fn clear(&mut self) {
        self.uncertainty = f64::INFINITY;
        self.last = [f64::INFINITY; 2];
    }

    /// Whether it is known.
    fn is_known(&self) -> bool {
        self.uncertainty < f64::INFINITY
    }
}

impl Accumulation {
    /// Looks where the last events would have their limit, if they have one, and keeps what is told best.
    pub fn predict(&mut self) {
        self.prediction.since += 1;
        if self.prediction.since > Self::MEMORY {
            self.prediction.uncertainty = f64::INFINITY;
        }
        let known = LONGEST_PATTERN.min(self.count.saturating_sub(1) / 3);
        let found = (1..=known).filter_map(|p| self.candidate(p));
        let Some((series, differs)) = found.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            self.prediction.last = [f64::INFINITY; 2];
            return;
        };
        // One prediction may agree with that before by chance.
        let [one, other] = self.prediction.last;
        let uncertainty = differs.max(one).max(other);
        self.prediction.last = [differs, one];
        if uncertainty <= self.prediction.uncertainty {
            let limit = self.end_of(&series);
            let told = &mut self.prediction;
            told.uncertainty = uncertainty;
            (told.since, told.at) = (0, limit.at);
            told.state.copy_from_slice(&limit.state);
            told.state_uncertainty.copy_from_slice(&limit.uncertainty);
        }
    }

    /// Whether no more is left of a limit at the instant `now` than as many durations as are remembered of what happened last: the time
    /// since the last event at another instant.
    pub fn is_near(&self, limit: &Limit, now: Instant) -> bool {
        let since = |back: usize| now.since(self.at(back));
        let known = self.count.min(Self::MEMORY);
        let last = (0..known).map(since).find(|time| *time > 0.0);
        last.is_some_and(|last| limit.at.since(now) <= Self::MEMORY as f64 * last)
    }

    /// The limit that was told best, if it is still ahead.
    pub fn predicted(&self) -> Option<Limit> {
        let told = &self.prediction;
        let is_ahead = self.count > 0 && told.at.since(self.at(0)) >= 0.0;
        (told.is_known() && is_ahead).then(|| Limit {
            at: told.at,
            state: told.state.to_vec(),
            uncertainty: told.state_uncertainty.to_vec(),
            modes: vec![self.mode(0)],
        })
    }
}
