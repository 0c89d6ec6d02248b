//! Extremes of a quantity.

/// Smallest and largest value of a quantity, and when it first took them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Deserialize)]
pub struct Peak {
    /// Largest value.
    pub max: f64,
    /// First time of the largest value (s).
    pub t_max: f64,
    /// Smallest value.
    pub min: f64,
    /// First time of the smallest value (s).
    pub t_min: f64,
}
