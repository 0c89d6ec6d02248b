//! What a mode requires to be positive.

use super::equations::{Equations, free_of};
use super::failure::Reason;
use super::guards;
use crate::integrate::{ORDERS, OneStep, State};
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

/// Makes the last step end at the first instant, to rounding, at which something the mode requires does not hold,
/// if it does not at `end`. The dense output is looked at in as many places as a step's polynomial has coefficients
/// at most, since it swings no more often; between two of them steps of the method decide.
#[cold]
pub(super) fn end_where_unmet<'a, const F: usize, M: OneStep<F, Equations<'a, F>>>(
    method: &mut M,
    equations: &mut Equations<'a, F>,
    mode: &Mode,
    end: f64,
) -> Result<(), Reason> {
    let holds = |equations: &mut Equations<'a, F>, state: &State<F>| {
        equations.at(state.t);
        let at = free_of(state);
        check_requirements(equations.kernel, equations.context, mode, at).is_ok()
    };
    let start = method.start().t;
    let place = |k: usize| start + (end - start) * (k as f64 / ORDERS as f64);
    let dense = method.dense().expect("a step was made");
    let fails = (1..ORDERS).find(|&k| {
        let t = place(k);
        let [q, v, a] = guards::motion(equations, dense, t, true);
        !holds(equations, &State { t, q, v, a })
    });
    let (mut met, mut unmet) = match fails {
        Some(k) => (place(k - 1), place(k)),
        None => (place(ORDERS - 1), end),
    };
    loop {
        let middle = 0.5 * (met + unmet);
        if !(met < middle && middle < unmet) {
            // A step has a length.
            let last = unmet.max(start.next_up());
            method.step_exactly(equations, last - start)?;
            return Ok(());
        }
        method.step_exactly(equations, middle - start)?;
        match holds(equations, method.state()) {
            true => met = middle,
            false => unmet = middle,
        }
    }
}
