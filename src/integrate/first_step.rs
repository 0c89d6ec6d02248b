//! Length of the first step after a start or an event.

use super::newton::{Linearization, Newton};
use super::report::Counters;
use super::state::State;
use super::system::System;
use super::tableau::{Coefficients, RadauIia};
use super::tolerances::{Control, Weights};
use crate::numerics::{Lu, Size};

/// Proposes a length that does not exceed `h_max`, and says whether that has made it what it is.
///
/// The motion is taken to change on the time scale T in which q or v changes by a typical size of
/// its own (absolute ÷ relative tolerance, plus its present size): at the present velocity, at the
/// present acceleration, or at the present jerk. Then the S-th derivative of a is about size/T^(S+1),
/// and the estimate of the error meets the tolerance at h = T (tolerance / error constant)^(1/(S+1)).
/// T has the unit of time, so nothing depends on the units chosen (Hairer's rule, Hairer, Nørsett &
/// Wanner 1993, II.4, compares h with 1).
///
/// The jerk comes from one residual a short time ahead on the parabola through the start. It passes
/// the filter of an implicit Euler step: transients of stiff components that matter show in the
/// acceleration; those that do not matter must not shorten the step.
pub(super) fn estimate<const S: usize, F: Size, Y: System<F>>(
    system: &mut Y,
    start: &State<F>,
    h_max: f64,
    control: &Control<F>,
    weights: &Weights<F>,
    newton: &Newton<S, F>,
    counters: &mut Counters,
) -> (f64, bool)
where
    RadauIia<S>: Coefficients<S>,
{
    let size = start.size();
    let per_size = |rate: &F::Vector, weight: &F::Vector| -> f64 {
        (0..size.get()).fold(0.0, |most, i| {
            most.max(rate[i].abs() * weight[i] * control.relative)
        })
    };
    let factor = control.step_per_scale;
    let fastest = per_size(&start.v, &weights.q).max(per_size(&start.a, &weights.v));
    let ahead = (factor / fastest).min(h_max);
    if !ahead.is_finite() {
        return (ahead, false);
    }
    let mut r = size.zeros();
    let q = size.vector(|i| start.q[i] + (start.v[i] + start.a[i] * (0.5 * ahead)) * ahead);
    let v = size.vector(|i| start.v[i] + start.a[i] * ahead);
    system.residual(start.t + ahead, &q, &v, &start.a, &mut r);
    counters.residual_evaluations += 1;
    let Linearization { m, c, k } = &newton.matrices;
    let entry = |i, j| m[(i, j)] + (c[(i, j)] + k[(i, j)] * ahead) * ahead;
    let Ok(change) = Lu::<f64, F>::factorize(entry, control.row_scale()) else {
        return (ahead, ahead == h_max); // the step itself finds out what is singular
    };
    let change = change.solve(|i| r[i]);
    let change = size.vector(|i| change[i]);
    let jerk = per_size(&change, &weights.v) / ahead;
    let scale = f64::min(1.0 / fastest, (2.0 / jerk).sqrt());
    let h = (factor * scale).min(h_max);
    (h, ahead == h_max || h == h_max)
}
