//! The error of one run, estimated by a better one.

use super::{Difference, TIGHTEST, method_name, scales, variation};
use crate::hybrid::{Method, Problem, Reason, simulate};
use crate::record::{ErrorEstimate, Progress, Run};

/// How much tighter the tolerance of the better run is: its own error is then about a percent of what is
/// estimated.
pub const ESTIMATE_FACTOR: f64 = 100.0;

/// Estimates the error of a run that has come to its end: the difference to a run by another method at
/// a tighter tolerance. (A run that Radau has made alone is compared with `auto`, any other with
/// Radau.) `None` where the better run stops early.
///
/// # Errors
/// As [`simulate`].
pub fn estimate(
    problem: &Problem,
    run: &Run,
    progress: &mut dyn Progress,
) -> Result<Option<ErrorEstimate>, Reason> {
    let method = match problem.method {
        Method::Radau => Method::Auto,
        Method::Auto | Method::Taylor => Method::Radau,
    };
    let tolerance = (problem.accuracy.relative / ESTIMATE_FACTOR).max(TIGHTEST);
    let better = simulate(&variation(problem, method, tolerance), progress)?;
    if better.failure.is_some() {
        return Ok(None);
    }
    let Difference { q, v, events, .. } = Difference::new(run, &better, &scales(problem));
    Ok(Some(ErrorEstimate {
        method: method_name(method).into(),
        tolerance,
        q,
        v,
        event_time: events.time,
        missed: events.missed,
        extra: events.extra,
    }))
}
