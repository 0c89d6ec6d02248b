//! What a run has reached or left: limit states, and conditions under which the model is meant.

use serde::{Deserialize, Serialize};

/// Limit states that were reached, and where the model's validity was left.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Reached {
    /// The limit states, in the order of their times.
    #[serde(default)]
    pub limit_states: Vec<LimitState>,
    /// The conditions that do not hold, or did not throughout.
    #[serde(default)]
    pub validity: Vec<Left>,
}

/// A limit state that was reached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitState {
    /// Name.
    pub name: String,
    /// When it was first reached (s).
    pub t: f64,
    /// What it means, in words.
    pub message: String,
    /// Whether the run ended there.
    pub ends: bool,
}

/// A condition under which the model is meant, and that a run has left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// The condition as text.
    pub condition: String,
    /// What the model assumes, in words.
    pub message: String,
    /// When it first did not hold (s); `None`: it is one of the parameters.
    pub t: Option<f64>,
}
