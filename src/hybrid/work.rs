//! Integrals of powers over a part of a step, for the energy ledger.

use super::equations::Equations;
use super::guards;
use crate::integrate::Motion;
use crate::kernel::Free;
use nalgebra::SVector;

/// Most panels of the composite rule: the error of a smooth power falls by 2⁶ with each doubling,
/// so ten doublings reach rounding from any start.
const MOST_PANELS: u32 = 1 << 10;

/// [dissipated, input] energy, J, between two local times of a step.
///
/// By Gauss's three-point rule on panels that are doubled until the energies change by less than
/// `tolerance` of what flows: a step of high order is long, and a rule of lower order no match for it.
pub(super) fn work<const F: usize, M: Motion<F>>(
    equations: &mut Equations<F>,
    motion: &M,
    (from, to): (f64, f64),
    tolerance: f64,
) -> [f64; 2] {
    let mut panels = 1;
    let (mut work, _) = composite(equations, motion, from, to, panels);
    while panels < MOST_PANELS {
        panels *= 2;
        let (finer, flow) = composite(equations, motion, from, to, panels);
        let change = [0, 1].map(|i| (finer[i] - work[i]).abs());
        work = finer;
        if change[0].max(change[1]) <= tolerance * flow {
            break;
        }
    }
    work
}

/// The composite rule, and the integral of the powers' magnitudes.
fn composite<const F: usize, M: Motion<F>>(
    equations: &mut Equations<F>,
    motion: &M,
    from: f64,
    to: f64,
    panels: u32,
) -> ([f64; 2], f64) {
    let half = 0.5 * (to - from) / f64::from(panels);
    let node = 0.6f64.sqrt();
    let (mut work, mut flow) = ([0.0; 2], 0.0);
    for panel in 0..panels {
        let middle = from + f64::from(2 * panel + 1) * half;
        for (place, weight) in [(-node, 5.0 / 9.0), (0.0, 8.0 / 9.0), (node, 5.0 / 9.0)] {
            let [q, v, a]: [SVector<f64, F>; 3] =
                guards::motion(equations, motion, middle + half * place, true);
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            let powers = equations.kernel.powers(equations.context, at);
            for (sum, power) in work.iter_mut().zip(powers) {
                *sum += weight * half * power;
                flow += weight * half * power.abs();
            }
        }
    }
    (work, flow)
}
