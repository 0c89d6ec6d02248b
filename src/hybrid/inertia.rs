//! Pivots of an inertia: what is left of each coordinate's mass once those before it may follow.

use super::failure::Reason;
use super::problem::Problem;
use crate::kernel::{Context, ModeKernel};
use crate::model::Mode;
use crate::numerics::{Definite, Matrix, NotPositive, Size};

/// Part of itself to which a pivot has fallen where it is the reason why no step can be made. Masses that vary stay far
/// above it; a series with a radius of convergence ρ of one that vanishes ends where ρ⁻³⁴ leaves the range of doubles,
/// and a mass may still be ρ^½ there, in units of a time constant.
pub(super) const VANISHED: f64 = 1e-4;

/// The same where it falls within a time that is none: a mass that stays falls by no part of itself there.
pub(super) const VANISHES: f64 = 0.5;

/// The pivots of an inertia, all of which must be positive.
pub(super) fn pivots<M: Matrix>(inertia: &M) -> Result<<M::Size as Size>::Vector, NotPositive> {
    Definite::factorize(inertia.size(), |i, j| inertia[(i, j)]).pivots()
}

/// Whether an effective mass has vanished on the way from one state, coordinates and velocities, to another, or is
/// beyond: which. It has where no more than a part of it is left.
#[cold]
pub(super) fn vanished<F: Size>(
    kernel: &ModeKernel<F>,
    context: &Context,
    (problem, mode): (&Problem, &Mode),
    ([from, to], part): ([[&F::Vector; 2]; 2], f64),
) -> Option<Reason> {
    let at = |[q, v]: [&F::Vector; 2]| pivots(&kernel.inertia(context, q, v));
    let before = at(from).ok()?;
    let (i, left) = match at(to) {
        Ok(after) => {
            let size = kernel.size();
            let left = size.vector(|i| after[i] / before[i]);
            let least = (0..size.get()).min_by(|&i, &j| left[i].total_cmp(&left[j]))?;
            (least, left[least])
        }
        Err(NotPositive { row, pivot }) => (row, pivot / before[row]),
    };
    (left <= part).then(|| Reason::VanishingMass {
        mode: mode.name,
        coordinate: problem.model.coordinates[mode.free[i]].name,
        left,
    })
}
