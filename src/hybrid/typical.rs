//! Typical sizes of coordinates and rates, which default tolerances are in proportion to.
//!
//! What a model states may be far from the truth for other parameters: the elongation of a spring is of
//! the size of load ÷ stiffness. A guard on a force then depends on that elongation so strongly that an
//! error which is small beside the stated size moves its events, or makes new ones. So the size of a
//! coordinate is not more than what changes a guard by the guard's own size.

use super::plan::Plan;
use super::problem::Problem;
use crate::input::Side;
use crate::kernel::with_kernel;
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::{Guard, GuardShape, Mode};
use crate::numerics::Size;

impl Problem {
    /// Typical sizes of the coordinates and of their rates, in their units: those that the model states,
    /// or less where a change by so much would change a guard by more than the sum of its terms'
    /// magnitudes. Guards are taken at the initial state, in each mode that may be visited. Where a
    /// guard has no size there, or a mode no accelerations, it has no say.
    pub fn typical_sizes(&self) -> [Vec<f64>; 2] {
        let coordinates = &self.model.coordinates;
        let stated = [
            coordinates.iter().map(|c| c.scale).collect::<Vec<_>>(),
            coordinates.iter().map(|c| c.rate_scale).collect(),
        ];
        let mut sizes = stated.clone();
        let Ok(plan) = Plan::new(self) else {
            return sizes;
        };
        let mut context = Context::new(&self.model, &self.parameters);
        context.set_signals(&self.signals, 0.0, Side::Right);
        context
            .discrete_mut()
            .copy_from_slice(&self.initial.discrete);
        for (m, mode) in self.automaton().modes.iter().enumerate() {
            if !plan.allowed[m] {
                continue;
            }
            context.hold(&self.initial.q);
            let mut held = vec![0.0; self.initial.q.len()];
            with_kernel!(&mode.kernels, k => {
                let free = |all: &[f64]| k.size().vector(|i| all[mode.free[i]]);
                let [q, v] = [&self.initial.q, &self.initial.v].map(|all| free(all));
                k.coordinates(&context, Free { q: &q, v: &v, a: &v }, &mut held);
            });
            context.hold(&held);
            let watched = plan.watched[m].iter().filter(|w| w.condition.is_none());
            let general = watched.map(|w| &mode.guards[w.guard]);
            for guard in general.filter(|g| matches!(g.shape, GuardShape::General { .. })) {
                with_kernel!(&mode.kernels, k => limit(&mut sizes, &stated, self, mode, guard, k, &context));
            }
        }
        sizes
    }
}

/// Limits the `sizes` of the free coordinates of a mode to what changes a guard by its own size; the
/// change by the `stated` sizes tells how strongly it depends on them.
fn limit<F: Size>(
    [of_q, of_v]: &mut [Vec<f64>; 2],
    [stated_q, stated_v]: &[Vec<f64>; 2],
    problem: &Problem,
    mode: &Mode,
    guard: &Guard,
    kernel: &ModeKernel<F>,
    context: &Context,
) {
    let free = |all: &[f64]| kernel.size().vector(|i| all[mode.free[i]]);
    let (q, v) = (free(&problem.initial.q), free(&problem.initial.v));
    let scale = free(stated_q);
    let accelerations =
        |q: &F::Vector, v: &F::Vector| kernel.system(context, q, v).accelerations(&scale).ok();
    let value = |q: &F::Vector, v: &F::Vector| {
        let a = accelerations(q, v)?;
        let at = Free { q, v, a: &a };
        Some(kernel.guard(context, &guard.kernel, at))
    };
    let (Some(a), Some(here)) = (accelerations(&q, &v), value(&q, &v)) else {
        return;
    };
    let at = Free {
        q: &q,
        v: &v,
        a: &a,
    };
    let magnitude = kernel.guard_magnitude(context, &guard.kernel, at);
    let limited = |size: f64, stated: f64, there: Option<f64>| {
        let change = there.map_or(0.0, |there| (there - here).abs());
        match magnitude > 0.0 && change > magnitude && change.is_finite() {
            true => size.min(stated * (magnitude / change)),
            false => size,
        }
    };
    for (i, &full) in mode.free.iter().enumerate() {
        let (mut moved, mut faster) = (q.clone(), v.clone());
        moved[i] += stated_q[full];
        faster[i] += stated_v[full];
        of_q[full] = limited(of_q[full], stated_q[full], value(&moved, &v));
        of_v[full] = limited(of_v[full], stated_v[full], value(&q, &faster));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::models;

    /// Typical sizes of the spring's elongation and of its rate.
    fn spring(k: f64, c: f64) -> [f64; 2] {
        let model = models().find("sliding_oscillator");
        let mut problem = Problem::new(&model.unwrap());
        problem.set_parameter("k", k).unwrap();
        problem.set_parameter("c", c).unwrap();
        let d = problem.model.coordinate("d").unwrap();
        problem.typical_sizes().map(|sizes| sizes[d])
    }

    #[test]
    fn the_elongation_of_a_stiff_spring_is_of_the_size_of_what_friction_holds() {
        let friction = 0.2 * (5.0 + 39.33) * 9.81;
        let [size, rate] = spring(1.05e10, 6.42e6);
        assert!((size / (friction / 1.05e10) - 1.0).abs() < 1e-12, "{size}");
        assert!((rate / (friction / 6.42e6) - 1.0).abs() < 1e-12, "{rate}");
    }

    #[test]
    fn a_soft_spring_leaves_the_sizes_that_the_model_states() {
        assert_eq!(spring(1e4, 100.0), [1e-3, 0.1]);
    }
}
