//! Error tolerances and the norm they define.

use super::tableau::{Coefficients, RadauIia, Tableau};
use crate::numerics::{Const, Size, Vector};

/// Tolerances of the local error: component i of q may be wrong by
/// `q_absolute[i] + relative · |q_i|` in a step, component i of v likewise.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerances<F: Size> {
    relative: f64,
    q_absolute: F::Vector,
    v_absolute: F::Vector,
}

/// Tolerances that no integration can meet.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ToleranceError {
    /// The relative tolerance is outside its range.
    #[error("relative tolerance {0:e}: must be from {min:e} to below 1", min = Tolerances::<Const<0>>::SMALLEST_RELATIVE)]
    Relative(f64),
    /// An absolute tolerance of q is not positive.
    #[error("absolute tolerance {value:e} of coordinate {coordinate}: must be positive")]
    Coordinate {
        /// Index of the coordinate.
        coordinate: usize,
        /// The tolerance, in the unit of the coordinate.
        value: f64,
    },
    /// An absolute tolerance of v is not positive and finite.
    #[error("absolute tolerance {value:e} of velocity {coordinate}: must be positive and finite")]
    Velocity {
        /// Index of the coordinate.
        coordinate: usize,
        /// The tolerance, in the unit of the velocity.
        value: f64,
    },
}

impl<F: Size> Tolerances<F> {
    /// Smallest relative tolerance: ten roundings, as in RADAU5 (Hairer & Wanner 1996, IV.8).
    pub const SMALLEST_RELATIVE: f64 = 10.0 * f64::EPSILON;

    /// Checks and packs the tolerances. An infinite tolerance of a coordinate switches its error
    /// control off. Absolute tolerance ÷ relative tolerance should be a typical size of the
    /// component: the first step and the choice of pivots rely on that.
    ///
    /// # Errors
    /// [`ToleranceError`] if a tolerance is zero, negative or NaN, `relative` is below
    /// [`Self::SMALLEST_RELATIVE`] or not below 1, or a tolerance of a velocity is infinite.
    pub fn new(
        relative: f64,
        q_absolute: F::Vector,
        v_absolute: F::Vector,
    ) -> Result<Self, ToleranceError> {
        if !(Self::SMALLEST_RELATIVE..1.0).contains(&relative) {
            return Err(ToleranceError::Relative(relative));
        }
        for coordinate in 0..q_absolute.size().get() {
            let (q, v) = (q_absolute[coordinate], v_absolute[coordinate]);
            if q.is_nan() || q <= 0.0 {
                return Err(ToleranceError::Coordinate {
                    coordinate,
                    value: q,
                });
            }
            if !(v > 0.0 && v.is_finite()) {
                return Err(ToleranceError::Velocity {
                    coordinate,
                    value: v,
                });
            }
        }
        Ok(Tolerances {
            relative,
            q_absolute,
            v_absolute,
        })
    }

    /// Number of coordinates.
    pub fn size(&self) -> F {
        self.q_absolute.size()
    }

    /// Relative tolerance, dimensionless.
    pub fn relative(&self) -> f64 {
        self.relative
    }

    /// Absolute tolerances of the coordinates, in their units.
    pub fn q_absolute(&self) -> &F::Vector {
        &self.q_absolute
    }

    /// Absolute tolerances of the velocities, in their units.
    pub fn v_absolute(&self) -> &F::Vector {
        &self.v_absolute
    }
}

/// The tolerances as the method uses them.
///
/// The embedded formula has order S, the method 2S − 1. So that the error of a step follows the
/// tolerance in proportion, the estimate is held against 0.1 · relative^((S+1)/(2S)), and absolute
/// tolerances keep their ratio to the relative one (RADAU: Hairer & Wanner 1999, section 5).
#[derive(Debug, Clone)]
pub(super) struct Control<F: Size> {
    /// Tolerance of the estimate, relative.
    pub relative: f64,
    /// Tolerance of the estimate ÷ tolerance asked for.
    pub loosening: f64,
    /// Absolute tolerance ÷ relative tolerance: the typical sizes.
    q_size: F::Vector,
    v_size: F::Vector,
    /// Newton's iteration stops when its error is below this part of the tolerance of the estimate.
    pub newton: f64,
    /// (relative ÷ error constant)^(1/(S+1)): length of a step that just meets the tolerance, in
    /// units of the time scale of the motion.
    pub step_per_scale: f64,
}

impl<F: Size> Control<F> {
    pub fn new<const S: usize>(tolerances: &Tolerances<F>) -> Self
    where
        RadauIia<S>: Coefficients<S>,
    {
        let size = tolerances.size();
        let root = nth_root(tolerances.relative, 2 * Tableau::<S>::STAGES);
        let relative = 0.1 * power(root, Tableau::<S>::STAGES + 1);
        // Newton's error is 3 % of what the user asked for (RADAU: the same, stated as
        // min(0.03, relative^(1/2)) for S = 3), and not below ten roundings.
        let asked = 0.03 * (tolerances.relative / relative).min(1.0);
        Control {
            relative,
            loosening: relative / tolerances.relative,
            q_size: size.vector(|i| tolerances.q_absolute[i] / tolerances.relative),
            v_size: size.vector(|i| tolerances.v_absolute[i] / tolerances.relative),
            newton: asked.max(10.0 * f64::EPSILON / relative),
            step_per_scale: nth_root(relative / RadauIia::<S>::TABLEAU.error_constant, S + 1),
        }
    }

    /// Sizes by which rows are scaled when pivots are chosen; see `linear`.
    pub fn row_scale(&self) -> &F::Vector {
        &self.v_size
    }

    /// Reciprocal tolerances of the estimate at the state (q, v), times how much of the error of each coordinate counts.
    #[inline]
    pub fn weights(&self, q: &F::Vector, v: &F::Vector, counts: &F::Vector) -> Weights<F> {
        let mut weights = Weights::<F> {
            q: q.size().zeros(),
            v: q.size().zeros(),
        };
        for i in 0..q.size().get() {
            weights.q[i] = counts[i] / (self.relative * (self.q_size[i] + q[i].abs()));
            weights.v[i] = counts[i] / (self.relative * (self.v_size[i] + v[i].abs()));
        }
        weights
    }
}

/// Reciprocal tolerances. The norm they define is the largest weighted component: unlike a mean
/// over the components, it does not loosen when a coordinate is added that has no error.
#[derive(Debug, Clone)]
pub(super) struct Weights<F: Size> {
    pub q: F::Vector,
    pub v: F::Vector,
}

impl<F: Size> Weights<F> {
    /// The norm of the difference of two states (q, v).
    pub fn distance(&self, one: (F::Vector, F::Vector), other: (&F::Vector, &F::Vector)) -> f64 {
        let mut most = 0.0_f64;
        for i in 0..one.0.size().get() {
            most = most.max((one.0[i] - other.0[i]).abs() * self.q[i]);
            most = most.max((one.1[i] - other.1[i]).abs() * self.v[i]);
        }
        most
    }
}

/// x^(1/n), n ≥ 2, by Newton's method, to a few roundings; x > 0, cheap unless x is tiny. The mathematical library's `pow` may
/// differ in the last bit between processors; +, −, × and ÷ may not.
pub(super) fn nth_root(x: f64, n: usize) -> f64 {
    // From above, the iteration falls monotonically until rounding stops it.
    let mut root = x.max(1.0);
    loop {
        let next = root - (root - x / power(root, n - 1)) / n as f64;
        if next < root {
            root = next;
        } else {
            return root;
        }
    }
}

/// xⁿ by repeated multiplication.
pub(super) fn power(x: f64, n: usize) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    #[test]
    fn roots_are_accurate() {
        for n in 2..=14 {
            for x in [1e-300, 1e-13, 0.3, 1.0, 2.0, 7e5] {
                let root = nth_root(x, n);
                // n multiplications, and n times the error of the root of one or two roundings.
                let error = (power(root, n) / x - 1.0).abs();
                assert!(error < 3.0 * n as f64 * f64::EPSILON, "{x} {n}: {error:e}");
            }
        }
    }

    #[test]
    fn tolerances_that_cannot_be_met_are_refused() {
        let one = SVector::<f64, 1>::repeat(1.0);
        for relative in [0.0, -1e-6, f64::NAN, 1e-16, 1.0] {
            assert!(matches!(
                Tolerances::<Const<1>>::new(relative, one, one),
                Err(ToleranceError::Relative(_))
            ));
        }
        for q in [0.0, -1.0, f64::NAN] {
            let error = Tolerances::<Const<1>>::new(1e-6, one * q, one).unwrap_err();
            assert!(matches!(
                error,
                ToleranceError::Coordinate { coordinate: 0, .. }
            ));
        }
        for v in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = Tolerances::<Const<1>>::new(1e-6, one, one * v).unwrap_err();
            assert!(matches!(
                error,
                ToleranceError::Velocity { coordinate: 0, .. }
            ));
        }
        assert!(Tolerances::<Const<1>>::new(1e-6, one * f64::INFINITY, one).is_ok());
    }
}
