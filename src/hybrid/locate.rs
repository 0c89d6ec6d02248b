//! The state at a crossing, at the full order of the method and on its far side.
//!
//! A crossing is isolated on the dense output, or a place near it found. The step is then taken again from its start with
//! exactly the length to the crossing, so that the state there is an end point of the method; what
//! the guard is off by at this end point is removed by Newton's method on the length, and last by
//! the motion's own Taylor polynomial.

use super::equations::{Equations, free_of};
use super::failure::Stoppable;
use super::guards::{self, Conditions, Linear};
use super::plan::Watched;
use super::roots::{Crossing, Kind};
use crate::integrate::Size;
use crate::integrate::{ORDERS, Retake, State, System};
use crate::model::{Guard, GuardShape};

/// Result of [`land`].
pub(super) enum Landing {
    /// The state just beyond the crossing was written: the end of the step, moved on by `beyond`.
    On {
        /// Duration from the end of the step, s; may be negative.
        beyond: f64,
    },
    /// The step was shortened, and has no crossing at its end: search it again.
    Short,
    /// The step ends where the dense output has the crossing, or later where that is within the rounding of the
    /// start; the states up to there, more accurate, are not across.
    Hidden,
}

/// A Taylor polynomial of second order over this fraction of a step is exact to rounding: what it
/// leaves out is of the order of its cube, 2⁻⁵⁴ (cube root of the unit roundoff, rounded down).
pub(super) const TAYLOR: f64 = 3.8e-6;

/// The same of rates, of which it is of first order: what it leaves out is of the order of its square, 2⁻⁵² (square root of the
/// machine epsilon).
const TAYLOR_OF_RATES: f64 = 1.0 / (1u64 << 26) as f64;

/// Retakes the last step so that it ends at `crossing` of `guard`, and writes the state there.
///
/// A guard that is no more negative there than rounding makes it, and rises, has turned: it does not fall. Of a force its own rounding
/// counts.
pub(super) fn land<'a, F: Size>(
    method: &mut dyn Retake<F, Equations<'a, F>>,
    equations: &mut Equations<'a, F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    (crossing, is_of_forces): (Crossing, bool),
    landed: &mut State<F>,
) -> Stoppable<Landing> {
    let landing = land_on(method, equations, conditions, guard, crossing, landed)?;
    let rises = matches!(landing, Landing::On { .. })
        && guard.1.condition.is_none()
        && rate_at(equations, guard.0, landed) >= 0.0;
    let is_none = rises && {
        is_of_forces && is_own_rounding(equations, guard.0, landed)
            || is_rounding(equations, conditions, guard, (method.start(), landed))
    };
    Ok(match is_none {
        true => Landing::Hidden,
        false => landing,
    })
}

/// Whether the value of a guard is no more than its own rounding.
fn is_own_rounding<F: Size>(equations: &Equations<F>, guard: &Guard, state: &State<F>) -> bool {
    let (kernel, context, at) = (equations.kernel, &*equations.context, free_of(state));
    let value = kernel.guard(context, &guard.kernel, at);
    value.abs() <= kernel.guard_rounding(context, &guard.kernel, at)
}

/// Whether the value of a guard is no more than what rounding in a step's polynomials makes of it at its end.
#[cold]
pub(super) fn is_rounding<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    (start, end): (&State<F>, &State<F>),
) -> bool {
    let value = value_at(equations, conditions, guard, end);
    value.abs() <= rounding_of_step(equations, conditions, guard, (start, end))
}

/// What rounding in a step's polynomials makes of a guard at its end.
#[cold]
pub(super) fn rounding_of_step<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    (start, end): (&State<F>, &State<F>),
) -> f64 {
    // Horner's rule (Higham 2002, §5.1).
    let rounding = |from: f64, to: f64| ORDERS as f64 * f64::EPSILON * from.abs().max(to.abs());
    let value = value_at(equations, conditions, guard, end);
    let mut change = |moved: &mut State<F>| {
        accelerate(equations, moved);
        (value_at(equations, conditions, guard, moved) - value).abs()
    };
    let mut sum = change(&mut end.clone());
    for i in 0..end.size().get() {
        let (mut moved, mut faster) = (end.clone(), end.clone());
        moved.q[i] += rounding(start.q[i], end.q[i]);
        faster.v[i] += rounding(start.v[i], end.v[i]);
        sum += change(&mut moved) + change(&mut faster);
    }
    sum
}

fn land_on<'a, F: Size>(
    method: &mut dyn Retake<F, Equations<'a, F>>,
    equations: &mut Equations<'a, F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    crossing: Crossing,
    landed: &mut State<F>,
) -> Stoppable<Landing> {
    let start = method.start().t;
    let (window, has_exact) = (method.end(), method.has_exact_accelerations());
    // A guard that all but fell at the end of the step before does so within the rounding of the start.
    let mut tau = match crossing.outside > start {
        true => crossing.outside,
        false => start.next_up(),
    };
    let mut correction_before = f64::INFINITY;
    loop {
        if tau != method.end() {
            method.step_exactly(equations, tau - start)?;
        }
        let mut accelerated;
        let mut end = method.state();
        if !has_exact && depends_on_accelerations(guard) {
            accelerated = end.clone();
            accelerate(equations, &mut accelerated);
            end = &accelerated;
        }
        let value = value_at(equations, conditions, guard, end);
        if matches!(crossing.kind, Kind::Touch | Kind::Jump) {
            // There is no slope to follow: the place is as good as the dense output.
            landed.clone_from(end);
            return Ok(match crossing.kind == Kind::Touch || value < 0.0 {
                true => Landing::On { beyond: 0.0 },
                false => Landing::Short,
            });
        }
        if guard.1.conditional {
            // Guard and condition together have no slope of their own.
            landed.clone_from(end);
            return Ok(match value < 0.0 {
                true => Landing::On { beyond: 0.0 },
                false => {
                    let (step, place) = ((start, window), (end, 0.0));
                    beyond_the_crossing(
                        equations,
                        conditions,
                        (guard, has_exact),
                        place,
                        step,
                        landed,
                    )
                }
            });
        }
        let rate = rate_at(equations, guard.0, end);
        let correction = -value / rate;
        if rate.is_nan() || rate >= 0.0 || end.t + correction > window {
            // No fall here: either the shortened step has its crossing earlier, or none at all.
            landed.clone_from(end);
            return Ok(match value < 0.0 && end.t == window {
                true => Landing::On { beyond: 0.0 },
                false => Landing::Short,
            });
        }
        let step = (start, window);
        let is_within = |part: f64| correction.abs() <= part * (window - start);
        // At a root that is nearly double each correction is half of the one before: the polynomial of a rate would have its
        // root elsewhere. Below the rounding of its value a guard comes no nearer to its root.
        let comes_nearer = correction.abs() < correction_before && end.t + correction > start;
        if is_within(TAYLOR_OF_RATES) || !comes_nearer && is_within(TAYLOR) {
            let place = (end, correction);
            return Ok(beyond_the_crossing(
                equations,
                conditions,
                (guard, has_exact),
                place,
                step,
                landed,
            ));
        }
        if !comes_nearer {
            return Ok(Landing::Short);
        }
        correction_before = correction.abs();
        tau = end.t + correction;
    }
}

/// Goes on from a `crossing` that [`land`] did not find in the step, which ended at `window` before.
///
/// Where a guard is zero at the start, and falls, but the motion does not move the state by as much as the guard's
/// own value takes to see it, steps as short as the rounding of the start would go on for as long as that
/// lasts: there the step is retaken in lengths that double until the guard is crossed, or no longer falls.
#[cold]
pub(super) fn land_later<'a, F: Size>(
    method: &mut dyn Retake<F, Equations<'a, F>>,
    equations: &mut Equations<'a, F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    (crossing, window): (Crossing, f64),
    landed: &mut State<F>,
) -> Stoppable<Landing> {
    let start = method.start().t;
    if crossing.outside > start.next_up() || matches!(crossing.kind, Kind::Touch | Kind::Jump) {
        if method.end() > crossing.outside {
            // Newton's method left a guard that turns near zero; others may cross on the way.
            method.step_exactly(equations, crossing.outside - start)?;
        }
        return Ok(match method.end() < window {
            true => Landing::Short,
            false => Landing::Hidden,
        });
    }
    let has_exact = method.has_exact_accelerations();
    // Up to here nothing was seen.
    let mut length = TAYLOR * (window - start);
    loop {
        let tau = (start + length).clamp(start.next_up(), window);
        method.step_exactly(equations, tau - start)?;
        landed.clone_from(method.state());
        if !has_exact && depends_on_accelerations(guard) {
            accelerate(equations, landed);
        }
        let value = value_at(equations, conditions, guard, landed);
        if value < 0.0 || !value.is_finite() {
            return Ok(Landing::On { beyond: 0.0 });
        }
        let rises = !guard.1.conditional && rate_at(equations, guard.0, landed) >= 0.0;
        if value > 0.0 || rises || tau == window {
            return Ok(Landing::Hidden);
        }
        length *= 2.0;
    }
}

/// Moves a state by its Taylor polynomial.
fn moved<F: Size>(state: &State<F>, by: f64) -> State<F> {
    let State { t, q, v, a } = state;
    let size = state.size();
    State {
        t: t + by,
        q: size.vector(|i| q[i] + (v[i] + a[i] * (0.5 * by)) * by),
        v: size.vector(|i| v[i] + a[i] * by),
        a: a.clone(),
    }
}

/// Writes the first state on the far side, from the end of the step on by about `correction`.
///
/// The guard's own values decide. Its rounding may keep them at or above zero at the computed root: the
/// move is lengthened by as much as that takes, doubled each time, or by what Newton's method says where that is
/// more, as with a guard that turns near zero, until it is strictly crossed; after `smooth` the Taylor polynomial
/// ends. What is tried first is the last place of the time in which the
/// guard's coordinate moves by its own size, or of a part of the time since the start of the `step`, or
/// of all of that where the guard is no coordinate.
#[inline(always)]
fn beyond_the_crossing<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    (guard, has_exact): ((&Guard, Watched), bool),
    (end, correction): (&State<F>, f64),
    step: (f64, f64),
    landed: &mut State<F>,
) -> Landing {
    let of_accelerations = depends_on_accelerations(guard);
    let smooth = TAYLOR * (step.1 - step.0);
    let elapsed = end.t - step.0;
    let moves = |own_size: f64| own_size.abs().min(elapsed);
    let passed = match guard.0.shape {
        GuardShape::Linear { index, rate, .. } if rate => moves(end.v[index] / end.a[index]),
        GuardShape::Linear { index, .. } => moves(end.q[index] / end.v[index]),
        GuardShape::General { .. } => elapsed,
    };
    let passed = passed.max(TAYLOR * elapsed);
    let mut place = (f64::EPSILON * passed.max(correction.abs())).max(f64::MIN_POSITIVE);
    // A guard that rounding kept from falling at the end of the step before may have its root there: it falls in this
    // step, at its start at the earliest.
    let correction = correction.max(-elapsed);
    // At the very root the guard is zero as often as not.
    let mut beyond = correction + place;
    loop {
        *landed = moved(end, beyond);
        if of_accelerations {
            accelerate(equations, landed);
        }
        let value = value_at(equations, conditions, guard, landed);
        if value < 0.0 || !value.is_finite() {
            // What the equations gave at the end is not exact here; a polynomial is as good in both places.
            if has_exact && !of_accelerations {
                accelerate(equations, landed);
            }
            return Landing::On { beyond };
        }
        let newton = match value > 0.0 && !guard.1.conditional {
            true => -value / rate_at(equations, guard.0, landed),
            false => 0.0,
        };
        beyond += place.max(newton);
        if beyond > smooth {
            return Landing::Short;
        }
        place *= 2.0;
    }
}

/// Whether the value of a guard, or of a condition that it is watched with, depends on accelerations.
pub(super) fn depends_on_accelerations((guard, watched): (&Guard, Watched)) -> bool {
    watched.conditional
        || matches!(
            guard.shape,
            GuardShape::General {
                accelerations: true,
                ..
            }
        )
}

/// Sets the accelerations of a state by the equations, where they determine them.
fn accelerate<F: Size>(equations: &mut Equations<F>, state: &mut State<F>) {
    let mut a = state.a.clone();
    if equations
        .acceleration(state.t, &state.q, &state.v, &mut a)
        .is_ok()
    {
        state.a = a;
    }
}

/// Value of a guard at a state, with its conditions.
#[inline(always)]
pub(super) fn value_at<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    guard: (&Guard, Watched),
    state: &State<F>,
) -> f64 {
    // A coordinate or a rate does not ask for the time.
    let is_motion = matches!(guard.0.shape, GuardShape::Linear { offset: false, .. });
    if !is_motion || guard.1.conditional {
        equations.at(state.t);
    }
    let at = free_of(state);
    guards::value(equations.kernel, equations.context, conditions, guard, at)
}

/// Derivative of a guard along the flow.
#[inline(always)]
pub(super) fn rate_at<F: Size>(
    equations: &mut Equations<F>,
    guard: &Guard,
    state: &State<F>,
) -> f64 {
    let at = free_of(state);
    if let Some(linear) = Linear::of(guard.shape, equations.context) {
        let rates = if linear.rate { &state.a } else { &state.v };
        return linear.factor * rates[linear.index];
    }
    equations.at(state.t);
    let jerk = equations.jerk(at);
    let jerk = jerk.unwrap_or_else(|_| equations.kernel.size().repeat(f64::NAN));
    equations
        .kernel
        .guard_rate(equations.context, &guard.kernel, at, &jerk)
}
