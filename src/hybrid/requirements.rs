//! What a mode requires to be positive.

use super::failure::Reason;
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
