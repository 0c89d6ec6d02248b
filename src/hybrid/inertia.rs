//! Pivots of an inertia: what is left of each coordinate's mass once those before it may follow.

use super::failure::Reason;
use super::problem::Problem;
use crate::kernel::{Context, ModeKernel};
use crate::model::Mode;
use crate::numerics::{Matrix, Size};

/// Unit roundoff of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Part of itself to which a pivot has fallen where it is the reason why no step can be made. Masses that vary stay far
/// above it; a series with a radius of convergence ρ of one that vanishes ends where ρ⁻³⁴ leaves the range of doubles,
/// and a mass may still be ρ^½ there, in units of a time constant.
const VANISHED: f64 = 1e-4;

/// A pivot that is not positive, by the index of its free coordinate.
#[derive(Debug, Clone, Copy)]
pub(super) struct NotPositive {
    pub coordinate: usize,
    pub pivot: f64,
}

/// The pivots D of the factors L D Lᵀ of the symmetric part of an inertia, all of which must be positive.
pub(super) fn pivots<M: Matrix>(inertia: &M) -> Result<<M::Size as Size>::Vector, NotPositive> {
    let size = inertia.size();
    // L D below the diagonal, D on it.
    let mut lower = size.zero_matrix();
    for i in 0..size.get() {
        for j in 0..=i {
            let symmetric = 0.5 * (inertia[(i, j)] + inertia[(j, i)]);
            let product = |k| lower[(i, k)] * (lower[(j, k)] / lower[(k, k)]);
            let rest = symmetric - (0..j).map(product).sum::<f64>();
            if i == j {
                // A pivot within the rounding of its own sum is not told from zero.
                let rounding = (size.get() + 1) as f64 * ROUNDOFF * symmetric.abs();
                if rest.is_nan() || rest <= rounding {
                    return Err(NotPositive {
                        coordinate: i,
                        pivot: rest,
                    });
                }
            }
            lower[(i, j)] = rest;
        }
    }
    Ok(size.vector(|i| lower[(i, i)]))
}

/// Whether an effective mass has vanished on the way from one state, coordinates and velocities, to another, or is
/// beyond: which.
#[cold]
pub(super) fn vanished<F: Size>(
    kernel: &ModeKernel<F>,
    context: &Context,
    (problem, mode): (&Problem, &Mode),
    [from, to]: [[&F::Vector; 2]; 2],
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
        Err(NotPositive { coordinate, pivot }) => (coordinate, pivot / before[coordinate]),
    };
    (left <= VANISHED).then(|| Reason::VanishingMass {
        mode: mode.name,
        coordinate: problem.model.coordinates[mode.free[i]].name,
        left,
    })
}
