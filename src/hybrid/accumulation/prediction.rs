//! The limit that the last events have told best while patterns repeat, and whether it is believed: as hops become shorter their series is
//! nearer to a geometric one, but their durations are told less well.

use super::{Accumulation, LONGEST_PATTERN, Limit};
use crate::hybrid::instant::Instant;
use crate::numerics::{Memory, Persist};

/// Part of the time that was left by which three predictions in a row of a limit that is believed were off at most. Those of a series
/// that is none are no more off by chance once in 10⁵ (0.02³).
const TOLD: f64 = 0.02;

/// A limit that was told.
#[derive(Debug)]
pub(super) struct Prediction {
    /// What the last three predictions differed by at most, s; infinite where none is known.
    uncertainty: f64,
    /// The same as a part of what was left a pattern before: by so much they were off.
    off: f64,
    /// Both of the last two predictions.
    last: [[f64; 2]; 2],
    /// Number of events since.
    since: usize,
    /// What was left then, s.
    left: f64,
    at: Instant,
    /// Coordinates and velocities, then what they may be off by.
    state: Box<[f64]>,
    state_uncertainty: Box<[f64]>,
}

impl Persist for Prediction {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.uncertainty.persist(memory)?;
        self.off.persist(memory)?;
        self.last.persist(memory)?;
        self.since.persist(memory)?;
        self.left.persist(memory)?;
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
            off: f64::INFINITY,
            last: [[f64::INFINITY; 2]; 2],
            since: 0,
            left: 0.0,
            at: Instant::default(),
            state: vec![0.0; numbers].into(),
            state_uncertainty: vec![0.0; numbers].into(),
        }
    }

    /// Forgets it.
    pub fn clear(&mut self) {
        self.uncertainty = f64::INFINITY;
        self.last = [[f64::INFINITY; 2]; 2];
    }

    /// Whether it is known.
    fn is_known(&self) -> bool {
        self.uncertainty < f64::INFINITY
    }

    /// Whether it is told well where so much time is left, s.
    fn is_told(&self, left: f64) -> bool {
        self.is_known() && (self.off <= TOLD || self.uncertainty <= TOLD * left)
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
            self.prediction.last = [[f64::INFINITY; 2]; 2];
            return;
        };
        let off = differs / series.limit.since(self.at(series.pattern));
        // One prediction may agree with that before by chance.
        let [one, other] = self.prediction.last;
        let [uncertainty, off_at_most] =
            [(0, differs), (1, off)].map(|(i, now): (usize, f64)| now.max(one[i]).max(other[i]));
        self.prediction.last = [[differs, off], one];
        if uncertainty <= self.prediction.uncertainty {
            let limit = self.end_of(&series);
            let told = &mut self.prediction;
            (told.uncertainty, told.off) = (uncertainty, off_at_most);
            (told.since, told.left, told.at) = (0, series.remaining, limit.at);
            told.state.copy_from_slice(&limit.state);
            told.state_uncertainty.copy_from_slice(&limit.uncertainty);
        }
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

    /// The same, if it is believed at the instant `now`: the last three predictions were right to [`TOLD`] of what was left, or agree to that
    /// part of what is left now; and at least half of what was left has passed since.
    pub fn predicted_well(&self, now: Instant) -> Option<Limit> {
        let limit = self.predicted()?;
        let left = limit.at.since(now);
        let has_passed = 2.0 * left <= self.prediction.left;
        (self.prediction.is_told(left) && has_passed).then_some(limit)
    }

    /// The present state in place of a limit that is believed and has passed, while events that were to end there go on.
    pub fn passed(&self, now: Instant, [q, v]: [&[f64]; 2]) -> Option<Limit> {
        let told = &self.prediction;
        let is_over = self.count > 0 && told.at.since(now) <= 0.0;
        if !(is_over && told.is_told(told.left)) {
            return None;
        }
        let state = [q, v].concat();
        let moved = state.iter().zip(self.state(0)).map(|(a, b)| (a - b).abs());
        let uncertainty = told.state_uncertainty.iter().zip(moved);
        Some(Limit {
            at: now,
            uncertainty: uncertainty.map(|(told, moved)| told + moved).collect(),
            state,
            modes: vec![self.mode(0)],
        })
    }
}
