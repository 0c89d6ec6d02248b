//! The error of one run, estimated by a better one.

use super::attempt::{Attempt, attempt};
use super::{Difference, GIVEN_UP, TIGHTEST, rounding, scales, used_taylor, variation};
use crate::hybrid::{Method, Problem, Reason};
use crate::record::{ErrorEstimate, Progress, Run};
use std::time::Duration;

/// How much tighter the tolerance of the better run is, so that its own error is a few percent of what is
/// estimated. At high orders that costs little: four decades take less than twice as long.
pub const ESTIMATE_FACTOR: f64 = 1e4;

/// How much tighter it is where Taylor judges Radau: at the same tolerance its errors are up to some hundred
/// times as large (a rocking block at 1e-3: 3e-3 by Taylor, 9e-6 by Radau).
pub const TAYLOR_ESTIMATE_FACTOR: f64 = 1e6;

/// Time that the Taylor method gets at least to be the better run: nobody waits for less.
const GRACE: Duration = Duration::from_secs(1);

/// Why a run has no estimate of its error.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoEstimate {
    /// The run itself did not come to its end.
    #[error("the run stopped early, so there is no end to compare")]
    Early,
    /// The better run did not come to its end.
    #[error("the run it was to be compared with stopped early at t = {t} s: {reason}")]
    Better {
        /// When, s.
        t: f64,
        /// Why.
        reason: Reason,
    },
    /// The better run was interrupted.
    #[error("interrupted")]
    Interrupted,
    /// The better run could not be started.
    #[error(transparent)]
    Refused(#[from] Reason),
}

/// Estimates the error of a run that has come to its end: the difference to a run by another method at
/// a tolerance [`ESTIMATE_FACTOR`] times as tight, but not tighter than [`TIGHTEST`], and the rounding
/// of their steps. What Taylor has a part in is compared with Radau; what Radau has made alone is
/// compared with Taylor ([`TAYLOR_ESTIMATE_FACTOR`]), or with Radau where Taylor would take many times as
/// long.
///
/// # Errors
/// [`NoEstimate`] if one of the two runs did not come to its end.
pub fn estimate(
    problem: &Problem,
    run: &Run,
    progress: &mut dyn Progress,
) -> Result<ErrorEstimate, NoEstimate> {
    if run.failure.is_some() {
        return Err(NoEstimate::Early);
    }
    let (better, tolerance) = better(problem, run, progress)?;
    if let Some(failure) = better.failure {
        let (t, reason) = (failure.at.t, failure.reason);
        return Err(NoEstimate::Better { t, reason });
    }
    let Difference { q, v, end, events } = Difference::new(run, &better, &scales(problem));
    let rounding = rounding(run).max(rounding(&better));
    let with_rounding = |errors: Vec<f64>, values: &[f64]| {
        let with = |(error, value): (f64, &f64)| error + rounding * value.abs();
        errors.into_iter().zip(values).map(with).collect()
    };
    let last = run.events.last().map_or(0.0, |event| event.t);
    Ok(ErrorEstimate {
        tolerance,
        q: with_rounding(q, &run.end.state.q),
        v: with_rounding(v, &run.end.state.v),
        relative: end + rounding,
        event_time: events.time + rounding * last,
        missed: events.missed,
        extra: events.extra,
        in_tails: events.in_tails,
        method: better.solver.method,
    })
}

/// The run to compare with, and its tolerance.
fn better(
    problem: &Problem,
    run: &Run,
    progress: &mut dyn Progress,
) -> Result<(Run, f64), NoEstimate> {
    let tighter = |factor: f64| (problem.accuracy.relative / factor).max(TIGHTEST);
    if !used_taylor(run) {
        let limit = (run.wall * GIVEN_UP).max(GRACE);
        let tolerance = tighter(TAYLOR_ESTIMATE_FACTOR);
        let taylor = variation(problem, Method::Taylor, tolerance);
        match attempt(&taylor, Some(limit), progress)? {
            Attempt::Interrupted => return Err(NoEstimate::Interrupted),
            Attempt::Done(better) if better.failure.is_none() => return Ok((better, tolerance)),
            _ => {}
        }
    }
    let tolerance = tighter(ESTIMATE_FACTOR);
    let radau = variation(problem, Method::Radau, tolerance);
    match attempt(&radau, None, progress)? {
        Attempt::Done(better) => Ok((better, tolerance)),
        _ => Err(NoEstimate::Interrupted),
    }
}
