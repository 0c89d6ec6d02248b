//! What the integrator tells about its work and its failures.

use crate::numerics::persist;

/// Work done since construction.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Accepted steps, steps taken again to an exact length not counted.
    pub steps: u64,
    /// Steps taken again to an exact length ([`super::Radau::step_exactly`]).
    pub retaken: u64,
    /// Attempts discarded because the error estimate exceeded the tolerance.
    pub rejected: u64,
    /// Attempts discarded because Newton's iteration did not converge or met a singular matrix or a
    /// number that is not finite.
    pub newton_failures: u64,
    /// Evaluations of [`super::System::residual`]: S per Newton iteration, one per first step.
    pub residual_evaluations: u64,
    /// Evaluations of [`super::System::jacobian`]: M, C and K together count once.
    pub jacobian_evaluations: u64,
    /// Factorizations of the iteration matrices: one real and (S − 1)/2 complex ones count once.
    pub factorizations: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
}

persist!(Counters {
    steps,
    retaken,
    rejected,
    newton_failures,
    residual_evaluations,
    jacobian_evaluations,
    factorizations,
    newton_iterations
});

/// An accepted step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Time at the start, s.
    pub t_start: f64,
    /// Time at the end, s.
    pub t_end: f64,
    /// Length, s.
    pub h: f64,
    /// Estimated local error in units of the tolerance of the estimate, below 1; NaN for a step of
    /// exact length, whose error is not estimated again, and of the Taylor method.
    pub error: f64,
    /// Newton iterations of the accepted attempt.
    pub iterations: u32,
    /// Attempts discarded on the way.
    pub discarded: u32,
    /// Whether the step might have been another one with a later end of the integration.
    pub is_near_end: bool,
}

/// Why no step could be taken. The state is that of the last accepted step.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// M + γh C + γ²h² K stays singular however short the step.
    #[error(
        "the matrix of coordinate {coordinate} is singular at t = {t:e} s (step {h:e} s): its effective mass vanishes"
    )]
    Singular {
        /// Time at the start of the step, s.
        t: f64,
        /// Length of the last attempt, s.
        h: f64,
        /// Index of the free coordinate for which no pivot was left.
        coordinate: usize,
    },
    /// Newton's iteration does not converge however short the step.
    #[error(
        "Newton's iteration does not converge at t = {t:e} s (step {h:e} s, contraction {rate:.3}): is the Jacobian right, and the model smooth in this mode?"
    )]
    Newton {
        /// Time at the start of the step, s.
        t: f64,
        /// Length of the last attempt, s.
        h: f64,
        /// Estimated contraction per iteration; converges only below 1.
        rate: f64,
    },
    /// The local error exceeds the tolerance however short the step.
    #[error(
        "the error estimate is {error:.3e} times the tolerance at t = {t:e} s with the shortest step {h:e} s: is the model smooth in this mode?"
    )]
    Tolerance {
        /// Time at the start of the step, s.
        t: f64,
        /// Length of the last attempt, s.
        h: f64,
        /// Estimate in units of the tolerance.
        error: f64,
    },
    /// The equations give NaN or an infinite number however short the step.
    #[error("{what} is not finite at t = {t:e} s (step {h:e} s)")]
    NonFinite {
        /// Time at the start of the step, s.
        t: f64,
        /// Length of the last attempt, s; 0 at the start itself.
        h: f64,
        /// What is not finite.
        what: &'static str,
    },
}
