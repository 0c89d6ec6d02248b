//! What a run says beside its result: that it is outside of what its model is meant for, or that energy came from
//! nowhere.

use super::print;
use crate::hybrid::Problem;
use crate::record::{Left, Summary, rounded};

/// Before the run: the conditions on parameters that a scene leaves.
pub fn before(problem: &Problem) {
    for left in problem.invalid_parameters() {
        let Left {
            condition, message, ..
        } = left;
        let model = problem.model.name;
        print::error(format!(
            "warning: outside of what `{model}` is meant for: {message} (needs {condition})"
        ));
    }
}

/// After the run: the conditions on the motion that it has left, and impacts that gained energy.
pub fn after(summary: &Summary) {
    for left in &summary.reached.validity {
        let Left {
            condition,
            message,
            t,
        } = left;
        let Some(t) = t else { continue };
        let (model, t) = (&summary.model, rounded(*t, 6));
        print::error(format!(
            "warning: from t = {t} s on outside of what `{model}` is meant for: {message} (needs {condition})"
        ));
    }
    if let Some(first) = summary.impacts.gains.first() {
        let impacts = summary.impacts.by_transition.0.iter();
        let count: usize = impacts.map(|(_, impacts)| impacts.gaining).sum();
        print::error(format!(
            "warning: impacts gained energy, {count} of them; the first at t = {} s, {} J at `{}`: no mechanism explains that",
            rounded(first.t, 6),
            rounded(first.energy, 3),
            first.transition,
        ));
    }
}
