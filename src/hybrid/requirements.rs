//! What a mode requires to be positive.

use super::crossing::{Cut, Signs, cut};
use super::equations::{Equations, free_of};
use super::failure::{Reason, Stoppable};
use super::guards::{Conditions, motion};
use super::plan::Watched;
use super::roots::Watch;
use super::search::search_function;
use crate::integrate::{Motion, OneStep, State};
use crate::kernel::{Context, Free, MOST_REQUIREMENTS, ModeKernel};
use crate::model::Mode;

/// What the mode requires to be positive must be so.
#[inline(always)]
pub(super) fn check_requirements<const F: usize>(
    kernel: &ModeKernel<F>,
    context: &Context,
    mode: &Mode,
    at: Free<F>,
) -> Stoppable<()> {
    if mode.requirements.is_empty() {
        return Ok(());
    }
    let mut values = [0.0; MOST_REQUIREMENTS];
    let values = &mut values[..mode.requirements.len()];
    kernel.requirements(context, at, values);
    match values.iter().position(|value| !is_met(*value)) {
        None => Ok(()),
        Some(index) => Err(unmet(mode, index, values[index])),
    }
}

/// Not where it is not a number.
fn is_met(value: f64) -> bool {
    value > 0.0
}

#[cold]
fn unmet(mode: &Mode, index: usize, value: f64) -> Box<Reason> {
    let requirement = &mode.requirements[index];
    Box::new(Reason::Requirement {
        mode: mode.name,
        failure: requirement.failure,
        text: requirement.text,
        value,
        unit: requirement.unit,
    })
}

/// Whether bounds show that all that the mode requires holds in the last step up to time `to`: far from zero they
/// do. Those of the Taylor method are bounds of its polynomials.
#[inline]
pub(super) fn hold_throughout<'a, const F: usize>(
    method: &impl OneStep<F, Equations<'a, F>>,
    equations: &mut Equations<'a, F>,
    mode: &Mode,
    to: f64,
) -> bool {
    let dense = method.dense().expect("a step was made");
    let Some(series) = dense.series() else {
        return false;
    };
    let mut bounds = [0.0; MOST_REQUIREMENTS];
    let bounds = &mut bounds[..mode.requirements.len()];
    let tau = to - dense.start();
    (equations.kernel).requirement_bounds(equations.context, series, tau, bounds);
    bounds.iter().all(|bound| is_met(*bound))
}

/// Cuts the last step, which was cut at its first event `found`, where something that the mode requires ceases to
/// hold, if it does before: says what. The shortened step is searched again, since it is a better solution than the
/// dense output of the longer one.
#[inline(never)]
pub(super) fn cut_where_unmet<'a, const F: usize>(
    method: &mut impl OneStep<F, Equations<'a, F>>,
    equations: &mut Equations<'a, F>,
    conditions: &mut Conditions,
    (mode, watched): (&'static Mode, &[Watched]),
    (signs, end): (&mut Signs, &mut State<F>),
    mut found: Cut,
) -> Stoppable<(Cut, Option<Box<Reason>>)> {
    let start = method.start().t;
    let mut before = f64::INFINITY;
    loop {
        let dense = method.dense().expect("a step was made");
        let Some(fails) = first_unmet(equations, mode, dense, end) else {
            return Ok((found, None));
        };
        if fails >= end.t.min(before) {
            equations.at(end.t);
            let at = free_of(end);
            return Ok(
                match check_requirements(equations.kernel, equations.context, mode, at) {
                    Err(reason) => (Cut::Nothing, Some(reason)),
                    // The end itself, more accurate than the dense output, is not beyond.
                    Ok(()) => (found, None),
                },
            );
        }
        before = fails;
        // A step has a length.
        method.step_exactly(equations, fails.max(start.next_up()) - start)?;
        found = cut(
            method,
            equations,
            conditions,
            (mode, watched),
            (&mut *signs, &mut *end),
        )?;
    }
}

/// When in the last step, up to the state `end`, something that the mode requires ceases to hold, local time: searched
/// as a guard is.
fn first_unmet<const F: usize>(
    equations: &mut Equations<F>,
    mode: &Mode,
    dense: &impl Motion<F>,
    end: &State<F>,
) -> Option<f64> {
    let (from, mut to) = (dense.start(), end.t);
    let mut first = None;
    for requirement in 0..mode.requirements.len() {
        let mut value = |tau: f64| {
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
        // After an event that leads to the same mode again it may fail at once.
        let fails = match is_met(value(from)) {
            true => search_function(value, (from, to), Watch::Armed)
                .crossing
                .map(|crossing| crossing.outside),
            false => Some(from),
        };
        if let Some(t) = fails {
            to = t;
            first = Some(t);
        }
    }
    first
}
