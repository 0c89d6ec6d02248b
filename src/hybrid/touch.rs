//! Guards that come to zero within rounding: whether they turn there, and where one that was not seen to rise falls.

use super::crossing::Signs;
use super::departure::CLEAR;
use super::equations::{Equations, free_of};
use super::failure::Stoppable;
use super::guards::{self, Conditions};
use super::locate::{TAYLOR, is_rounding, rate_at, rounding_of_step, value_at};
use super::plan::Watched;
use super::roots::{Crossing, Kind, Search, Watch};
use crate::integrate::{LastStep, Retake, State};
use crate::model::{Guard, Mode};
use crate::numerics::Size;

/// Parts of a step at whose ends a guard is looked at: a step is a period at most.
const PARTS: usize = 8;

/// Whether a force that falls turns no deeper below zero than rounding: its own, and that of the step's polynomials. What friction
/// can hold is not exceeded by a load whose peak is just that. How deep it turns is known up to the rounding of its polynomial, and
/// then by its values. (Gaps and slip rates that are as small are told from zero by the motion that makes them so.)
#[inline(always)]
pub(super) fn turns_within_rounding<F: Size>(
    method: &dyn LastStep<F>,
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    (found, crossing): (&Search, Crossing),
) -> bool {
    let turn = match crossing.kind {
        Kind::Crossing | Kind::Touch => found.turn,
        // A smooth force jumps by rounding alone: it turns near where it is then.
        Kind::Jump => {
            let t = crossing.outside;
            let [q, v, a] = guards::motion(equations, method.motion(), t, true);
            value_at(equations, conditions, guard, &State { t, q, v, a })
        }
        Kind::LeavesNegative | Kind::Pole => f64::NEG_INFINITY,
    };
    turn > f64::NEG_INFINITY && is_shallow(method, equations, conditions, guard, (turn, crossing))
}

/// The same where it turns behind its crossing.
#[inline(never)]
fn is_shallow<F: Size>(
    method: &dyn LastStep<F>,
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    (turn, crossing): (f64, Crossing),
) -> bool {
    let start = method.start();
    let of_terms = |equations: &Equations<F>, state: &State<F>| {
        let (kernel, context) = (equations.kernel, &*equations.context);
        kernel.guard_rounding(context, &guard.0.kernel, free_of(state))
    };
    // Its terms are about as large at the start of the step.
    if -turn > CLEAR / f64::EPSILON * of_terms(equations, start) {
        return false;
    }
    let state = |t: f64, equations: &mut Equations<F>| {
        let [q, v, a] = guards::motion(equations, method.motion(), t, true);
        State { t, q, v, a }
    };
    let at = state(crossing.outside, equations);
    // It turns after twice the time in which its slope leads so deep.
    let turns = -2.0 * turn / rate_at(equations, guard.0, &at).abs();
    let last = (method.motion().start() + method.motion().length() - at.t).min(2.0 * turns);
    (0..=PARTS).all(|k| {
        let at = state(at.t + k as f64 / PARTS as f64 * last, equations);
        let depth = -value_at(equations, conditions, guard, &at);
        let own = of_terms(equations, &at);
        depth <= own || depth <= own + rounding_of_step(equations, conditions, guard, (start, &at))
    })
}

/// Those of the guards that came to zero within rounding which are not positive at the end of the step.
#[cold]
pub(super) fn below<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    (mode, watched): (&Mode, &[Watched]),
    signs: &Signs,
    end: &State<F>,
) -> Vec<usize> {
    let is_below = |&i: &usize| {
        let guard = (&mode.guards[watched[i].guard], watched[i]);
        signs.found[i].turn <= 0.0
            && signs.found[i].crossing.is_none()
            && value_at(equations, conditions, guard, end) <= 0.0
    };
    (0..watched.len()).filter(is_below).collect()
}

/// The event of a guard that was zero at the start of the segment, or came to zero within rounding, and rose from it by
/// less than the dense output shows, so that it never was seen to be positive: at the end of the step, or where the event of another
/// guard cuts it (`end`), it is negative and falls, or it has been negative in between by more than rounding. It has fallen where
/// it first is negative and falls after it was known to be positive, to a factor of two; and it is in doubt, having turned at zero.
/// The guard, and the state there.
#[cold]
pub(super) fn fallen<'a, F: Size>(
    method: &mut dyn Retake<F, Equations<'a, F>>,
    equations: &mut Equations<'a, F>,
    conditions: &mut Conditions,
    (mode, watched): (&Mode, &[Watched]),
    signs: &mut Signs,
    end: f64,
) -> Stoppable<Option<(usize, State<F>)>> {
    let start = method.start().t;
    if end <= start {
        // The event of the other guard leaves nothing of the step.
        return Ok(None);
    }
    // The first of all: what falls later is looked for up to there.
    let (mut end, mut first) = (end, None);
    for (i, &watched) in watched.iter().enumerate() {
        let found = &signs.found[i];
        let is_negative = found.watch == Watch::Violated && found.crossing.is_none();
        // Not seen to be positive where it was known to be, and positive since.
        let rises = signs.watches[i] == Watch::Violated && signs.away[i] > start;
        if !(signs.away[i] > 0.0 && (is_negative || rises)) {
            continue;
        }
        let at_end = match end < method.end() {
            true => {
                let [q, v, a] = guards::motion(equations, method.motion(), end, true);
                State { t: end, q, v, a }
            }
            false => method.state().clone(),
        };
        let guard = (&mode.guards[watched.guard], watched);
        let falls_at_end = falls_below(equations, conditions, guard, &at_end);
        if !(falls_at_end || has_sunk(method, equations, conditions, guard, end)) {
            continue;
        }
        let away = signs.away[i] - start;
        let mut length = if away > 0.0 {
            away
        } else {
            TAYLOR * (end - start)
        };
        loop {
            let tau = (start + length).min(end);
            // A length that rounding does not tell from nothing grows.
            if tau > start {
                if method.end() != tau {
                    method.step_exactly(equations, tau - start)?;
                }
                let falls = falls_below(equations, conditions, guard, method.state());
                if falls || tau >= end && falls_at_end {
                    (end, first) = (tau, Some(i));
                }
                if falls || tau >= end {
                    break;
                }
            }
            length *= 2.0;
        }
    }
    let Some(i) = first else {
        return Ok(None);
    };
    if method.end() != end {
        method.step_exactly(equations, end - start)?;
    }
    // What happens later is the next segment's.
    signs
        .found
        .iter_mut()
        .for_each(|found| found.crossing = None);
    signs.found[i].crossing = Some(Crossing {
        inside: method.end(),
        outside: method.end(),
        kind: Kind::Crossing,
    });
    signs.found[i].turn = 0.0;
    signs.unseen = true;
    Ok(Some((watched[i].guard, method.state().clone())))
}

/// Whether a guard is negative at a state, and falls.
fn falls_below<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    state: &State<F>,
) -> bool {
    value_at(equations, conditions, guard, state) < 0.0 && rate_at(equations, guard.0, state) < 0.0
}

/// Whether the motion shows a guard to be negative by more than rounding somewhere in the last step up to local time `end`.
fn has_sunk<F: Size>(
    method: &dyn LastStep<F>,
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    end: f64,
) -> bool {
    let start = method.start();
    (1..=PARTS).any(|k| {
        let t = start.t + k as f64 / PARTS as f64 * (end - start.t);
        let [q, v, a] = guards::motion(equations, method.motion(), t, true);
        let state = State { t, q, v, a };
        value_at(equations, conditions, guard, &state) < 0.0
            && !is_rounding(equations, conditions, guard, (start, &state))
    })
}
