//! What trajectories of a scene may differ in.

use super::problem::{Accuracy, Initial, Problem};
use crate::input::Signals;

/// One trajectory of an ensemble: what is its own.
#[derive(Debug, Clone, Copy)]
pub struct Member<'a> {
    /// Parameters in the order and the units of the model.
    pub parameters: &'a [f64],
    /// The inputs of the model: scaled, of other frequencies, other records. One that is zero in the scene is zero in all members.
    pub signals: &'a Signals,
    /// Where it starts.
    pub initial: &'a Initial,
    /// Its tolerances, which may follow from its parameters ([`Problem::set_tolerance`]); the relative one is that of the scene.
    pub accuracy: &'a Accuracy,
}

impl<'a> From<&'a Problem> for Member<'a> {
    /// Parameters, inputs, initial state and tolerances of a problem.
    fn from(problem: &'a Problem) -> Self {
        Member {
            parameters: &problem.parameters,
            signals: &problem.signals,
            initial: &problem.initial,
            accuracy: &problem.accuracy,
        }
    }
}
