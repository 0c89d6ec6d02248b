//! What trajectories of a scene may differ in.

use super::problem::{Initial, Problem};

/// One trajectory of an ensemble: what is its own.
#[derive(Debug, Clone, Copy)]
pub struct Member<'a> {
    /// Parameters in the order and the units of the model.
    pub parameters: &'a [f64],
    /// Where it starts.
    pub initial: &'a Initial,
}

impl<'a> From<&'a Problem> for Member<'a> {
    /// Parameters and initial state of a problem.
    fn from(problem: &'a Problem) -> Self {
        Member {
            parameters: &problem.parameters,
            initial: &problem.initial,
        }
    }
}
