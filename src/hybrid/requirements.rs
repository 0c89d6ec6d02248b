//! What a mode requires to be positive.

use super::equations::Equations;
use super::failure::Reason;
use super::guards::motion;
use super::roots::Watch;
use super::search::search_function;
use crate::integrate::{Motion, State};
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::Mode;

/// Most requirements that a mode may have.
const MOST_REQUIREMENTS: usize = 8;

/// What the mode requires to be positive must be so.
pub(super) fn check_requirements<const F: usize>(
    kernel: &ModeKernel<F>,
    context: &Context,
    mode: &Mode,
    at: Free<F>,
) -> Result<(), Reason> {
    if mode.requirements.is_empty() {
        return Ok(());
    }
    let mut values = [0.0; MOST_REQUIREMENTS];
    let values = &mut values[..mode.requirements.len()];
    kernel.requirements(context, at, values);
    // One that is not a number is not met.
    let met = |value: &f64| *value > 0.0;
    match values.iter().position(|value| !met(value)) {
        None => Ok(()),
        Some(index) => Err(unmet(mode, index, values[index])),
    }
}

#[cold]
fn unmet(mode: &Mode, index: usize, value: f64) -> Reason {
    let requirement = &mode.requirements[index];
    Reason::Requirement {
        mode: mode.name,
        failure: requirement.failure,
        text: requirement.text,
        value,
        unit: requirement.unit,
    }
}

/// When in the last step, up to the state `end`, something that the mode requires ceases to hold, local time;
/// `None` if all of it holds as far as can be seen.
#[inline]
pub(super) fn first_unmet<const F: usize>(
    equations: &mut Equations<F>,
    mode: &Mode,
    dense: &impl Motion<F>,
    end: &State<F>,
) -> Option<f64> {
    if mode.requirements.is_empty() || hold_throughout(equations, mode, dense, end.t) {
        return None;
    }
    search_unmet(equations, mode, dense, end)
}

/// Whether bounds show that all holds up to time `to`: far from zero they do, at less than the cost of an
/// evaluation of the motion. Those of the Taylor method are bounds of its polynomial.
#[inline]
fn hold_throughout<const F: usize>(
    equations: &mut Equations<F>,
    mode: &Mode,
    dense: &impl Motion<F>,
    to: f64,
) -> bool {
    let Some(series) = dense.series() else {
        return false;
    };
    let mut bounds = [0.0; MOST_REQUIREMENTS];
    let bounds = &mut bounds[..mode.requirements.len()];
    let tau = to - dense.start();
    (equations.kernel).requirement_bounds(equations.context, series, tau, bounds);
    bounds.iter().all(|bound| *bound > 0.0)
}

/// Searches what the mode requires as a guard is searched.
#[inline(never)]
fn search_unmet<const F: usize>(
    equations: &mut Equations<F>,
    mode: &Mode,
    dense: &impl Motion<F>,
    end: &State<F>,
) -> Option<f64> {
    let (from, mut to) = (dense.start(), end.t);
    let mut first = None;
    for requirement in 0..mode.requirements.len() {
        let value = |tau: f64| {
            let [q, v, a] = match tau == end.t {
                true => [end.q, end.v, end.a],
                false => motion(equations, dense, tau, true),
            };
            equations.at(tau);
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            let mut values = [0.0; MOST_REQUIREMENTS];
            let values = &mut values[..mode.requirements.len()];
            equations.kernel.requirements(equations.context, at, values);
            values[requirement]
        };
        let found = search_function(value, (from, to), Watch::Armed);
        if let Some(crossing) = found.crossing {
            to = crossing.outside;
            first = Some(to);
        }
    }
    first
}
