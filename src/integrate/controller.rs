//! Step sizes: the predictive controller of Gustafsson (1994) as in RADAU5 (Hairer & Wanner 1996,
//! IV.8), with its constants.

use super::logarithm::root;
use super::report::StepError;
use crate::numerics::persist;

/// Aim below the tolerance by this factor in h, so that few steps are rejected (RADAU5).
const SAFETY: f64 = 0.9;
/// A step is at most this many times longer than the last (RADAU5).
pub(super) const GROWTH: f64 = 8.0;
/// A step is at least this part of the last (RADAU5).
const SHRINKAGE: f64 = 0.2;
/// Errors below this part of the tolerance say little about the trend (RADAU5).
const SMALLEST_ERROR: f64 = 0.01;
/// A step that would grow by less keeps its length, and with it the factorization (RADAU5).
const KEEP: f64 = 1.2;

/// Contraction of Newton's iteration that the step size aims at where the error would allow more: it
/// is proportional to h, and iterations per unit of time are fewest near 1/e, where h ln(1/h) peaks.
const CONTRACTION: f64 = 0.37;

/// What an accepted step showed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    /// Estimated error in units of the tolerance, below 1.
    pub error: f64,
    /// Newton iterations beyond the first, as part of twice the number allowed; a hard-won step
    /// should not be followed by a much longer one (RADAU5).
    pub effort: f64,
    /// Contraction of Newton's iteration; 0 if not known.
    pub rate: f64,
}

/// Memory of the controller.
#[derive(Debug, Clone, Copy)]
pub(super) struct Controller {
    /// Length and error of the last accepted step since the start or a restart.
    last: Option<(f64, f64)>,
}

persist!(Controller { last });

impl Controller {
    pub fn new() -> Self {
        Controller { last: None }
    }

    /// Factor for the length after a failed attempt.
    pub fn after_failure<const S: usize>(&self, failure: &StepError) -> f64 {
        match failure {
            StepError::Tolerance { error, .. } => {
                (SAFETY * root(*error, S + 1)).clamp(SHRINKAGE, SAFETY)
            }
            StepError::Newton { rate, .. } => (CONTRACTION / rate).clamp(SHRINKAGE, 0.5),
            _ => 0.5,
        }
    }

    /// Length after an accepted step of length `h`; `discarded`: attempts failed before it, so the
    /// next step must not be longer.
    #[inline]
    pub fn after_acceptance<const S: usize>(
        &mut self,
        h: f64,
        pace: &Pace,
        discarded: bool,
    ) -> f64 {
        let Pace {
            error,
            effort,
            rate,
        } = *pace;
        // The estimate is of order h^(S + 1).
        let mut factor = SAFETY / (1.0 + effort) * root(error, S + 1);
        if let Some((last_h, last_error)) = self.last {
            // The error behaves as it did from the last step to this one. A longer step than the order
            // allows is taken only where errors fall although steps grow: a transient decays.
            let floor = last_error.max(SMALLEST_ERROR);
            let trend = SAFETY * (h / last_h) * root(error * error / floor, S + 1);
            let decays = error < last_error && h > last_h;
            if trend < factor || decays {
                factor = trend;
            }
        }
        self.last = Some((h, error));
        let mut factor = factor.min(CONTRACTION / rate).clamp(SHRINKAGE, GROWTH);
        if discarded {
            factor = factor.min(1.0);
        }
        if (1.0..KEEP).contains(&factor) {
            h
        } else {
            h * factor
        }
    }
}
