//! What is to be simulated, validated.

use crate::input::Signals;
use crate::model::{Model, Variant};
use crate::record::Recorded;

/// A complete initial-value problem of a model.
#[derive(Debug, Clone)]
pub struct Problem {
    /// The model.
    pub model: &'static Model,
    /// The variant with the chosen options.
    pub variant: &'static Variant,
    /// Title of the scene, if it has one.
    pub title: Option<String>,
    /// Parameters in the order and the units of the model.
    pub parameters: Vec<f64>,
    /// Inputs.
    pub signals: Signals,
    /// Where it starts.
    pub initial: Initial,
    /// Coordinates frozen in addition: modes in which one of them is free are left out.
    pub freeze: Vec<usize>,
    /// Where it ends.
    pub end: End,
    /// Tolerances.
    pub accuracy: Accuracy,
    /// What is recorded.
    pub record: Record,
}

/// Initial state at t = 0.
#[derive(Debug, Clone)]
pub struct Initial {
    /// All coordinates.
    pub q: Vec<f64>,
    /// All velocities.
    pub v: Vec<f64>,
    /// All discrete states.
    pub discrete: Vec<f64>,
    /// Mode; `None`: the mode with the fewest free coordinates that holds the state.
    pub mode: Option<usize>,
}

/// End of a run: whichever comes first.
#[derive(Debug, Clone, Copy)]
pub struct End {
    /// Time, s.
    pub time: f64,
    /// Name of a transition and how often it happens before the run ends right after it.
    pub after: Option<(&'static str, u64)>,
}

/// Tolerances of the local error of a step: absolute + relative × magnitude.
#[derive(Debug, Clone)]
pub struct Accuracy {
    /// Relative tolerance.
    pub relative: f64,
    /// Absolute tolerance of each coordinate, in its unit.
    pub q_absolute: Vec<f64>,
    /// Absolute tolerance of each velocity, in its unit.
    pub v_absolute: Vec<f64>,
}

/// What is recorded.
#[derive(Debug, Clone, Copy)]
pub struct Record {
    /// Interval of the samples, s; `None`: the steps and both sides of every event.
    pub every: Option<f64>,
    /// Which columns besides coordinates, velocities and discrete states.
    pub columns: Recorded,
}
