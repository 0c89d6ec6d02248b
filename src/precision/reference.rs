//! What runs are compared with: two runs by different methods, and what they leave undetermined.

use super::attempt::{Attempt, attempt};
use super::{Difference, GIVEN_UP, TIGHTEST, rounding, scales, used_taylor, variation};
use crate::hybrid::{Method, Problem, Reason};
use crate::record::{Progress, Run};
use std::time::{Duration, Instant};

/// Time that the Taylor method gets at least: a second method is worth a wait.
const PATIENCE: Duration = Duration::from_secs(2);

/// What runs are compared with.
#[derive(Debug, Clone)]
pub struct Reference {
    /// The problem, up to where the reference determines it.
    pub problem: Problem,
    pair: Pair,
    /// What the reference may be wrong by.
    pub bound: Bound,
    /// Where the scene ends for the comparison, if that is before its end.
    pub horizon: Option<Horizon>,
}

/// The two runs of a reference.
#[derive(Debug, Clone)]
struct Pair {
    /// By Radau at the tightest tolerance.
    implicit: Run,
    /// By the Taylor method at the tightest tolerance; by Radau at the next where that is not to be had.
    other: Run,
    /// Why both are by Radau, if they are.
    alone: Option<String>,
}

/// Bound of the error of a reference: what its two runs differ by, and the rounding of their steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// At the end, as [`Difference::end`].
    pub end: f64,
    /// Of the time of an event, s.
    pub event_time: f64,
}

/// The reference is not determined up to the end of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Horizon {
    /// Where the comparison ends, s: halfway from the last event that is determined to `until`.
    pub at: f64,
    /// Where the reference is not determined any more, s.
    pub until: f64,
    /// Why.
    pub why: String,
}

impl Reference {
    /// Finds the reference of a problem; `None` if it was interrupted.
    ///
    /// # Errors
    /// As [`crate::hybrid::simulate`].
    pub fn new(problem: &Problem, progress: &mut dyn Progress) -> Result<Option<Self>, Reason> {
        let mut problem = problem.clone();
        let mut horizon = None;
        loop {
            let Some(pair) = Pair::new(&problem, progress)? else {
                return Ok(None);
            };
            let difference = Difference::new(&pair.other, &pair.implicit, &scales(&problem));
            if let Some(found) = pair.undetermined(&difference) {
                let at = found.at;
                horizon = Some(found);
                // Before the end and after the start: there is something left to compare.
                if 0.0 < at && at < problem.end.time {
                    problem.end.time = at;
                    problem.end.after = None;
                    continue;
                }
            }
            let rounding = rounding(&pair.implicit).max(rounding(&pair.other));
            let last = pair.implicit.events.last().map_or(0.0, |event| event.t);
            return Ok(Some(Reference {
                bound: Bound {
                    end: difference.end + rounding,
                    event_time: difference.events.time + rounding * last,
                },
                problem,
                pair,
                horizon,
            }));
        }
    }

    /// The difference of a run to the reference by another method, or by Radau if there is none.
    pub fn error(&self, run: &Run) -> Difference {
        let better = match self.pair.alone {
            None if !used_taylor(run) => &self.pair.other,
            _ => &self.pair.implicit,
        };
        Difference::new(run, better, &scales(&self.problem))
    }

    /// Why the reference is by Radau alone, if it is.
    pub fn alone(&self) -> Option<&str> {
        self.pair.alone.as_deref()
    }

    /// Number of events of the reference.
    pub fn events(&self) -> usize {
        self.pair.implicit.events.len()
    }
}

impl Pair {
    /// Makes both runs; `None` if they were interrupted.
    fn new(problem: &Problem, progress: &mut dyn Progress) -> Result<Option<Self>, Reason> {
        let start = Instant::now();
        let implicit = variation(problem, Method::Radau, TIGHTEST);
        let Attempt::Done(implicit) = attempt(&implicit, None, progress)? else {
            return Ok(None);
        };
        let limit = (start.elapsed() * GIVEN_UP).max(PATIENCE);
        let taylor = variation(problem, Method::Taylor, TIGHTEST);
        let taylor = attempt(&taylor, Some(limit), progress)?;
        let alone = match &taylor {
            Attempt::Interrupted => return Ok(None),
            Attempt::GivenUp(_) => Some(format!(
                "taylor did not come to its end in {} s",
                limit.as_secs()
            )),
            Attempt::Done(run) => match &run.failure {
                Some(failure) if implicit.failure.is_none() => {
                    let (t, reason) = (failure.at.t, &failure.reason);
                    Some(format!("taylor stopped early at t = {t} s: {reason}"))
                }
                _ => None,
            },
        };
        let looser = variation(problem, Method::Radau, 10.0 * TIGHTEST);
        let other = match (taylor, &alone) {
            (taylor, None) => taylor,
            _ => attempt(&looser, None, progress)?,
        };
        Ok(match other {
            Attempt::Done(other) => Some(Pair {
                implicit,
                other,
                alone,
            }),
            _ => None,
        })
    }

    /// Up to where the two determine the scene, unless they do so up to its end.
    fn undetermined(&self, difference: &Difference) -> Option<Horizon> {
        let runs = [&self.implicit, &self.other].into_iter();
        let failures = runs.filter_map(|run| run.failure.as_ref());
        let failure = failures.min_by(|a, b| a.at.t.total_cmp(&b.at.t));
        let events = &difference.events;
        let stop = failure.map_or(f64::INFINITY, |failure| failure.at.t);
        let until = events.until.min(stop);
        let why = match failure {
            _ if until.is_infinite() => return None,
            Some(failure) if stop <= events.until => {
                format!("the reference stops early there: {}", failure.reason)
            }
            _ => "from there on its two runs have different events, or at other times".to_owned(),
        };
        let at = (events.common.min(until) + until) / 2.0;
        Some(Horizon { at, until, why })
    }
}
