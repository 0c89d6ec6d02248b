//! Values of guards and conditions.

use super::equations::Equations;
use super::plan::{Plan, Watched};
use crate::integrate::{Motion, Size};
use crate::kernel::with_kernel;
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::{Guard, Mode, Transition};

/// What the conditions of transitions are evaluated with.
pub(super) struct Conditions<'a> {
    pub modes: &'a [Mode],
    pub plan: &'a Plan,
    /// Room for a reset: q, v, discrete states.
    pub next: &'a mut [f64],
}

impl Conditions<'_> {
    /// The conditions of a transition out of the present mode, evaluated in its target after the
    /// reset, reduced by `reduce`. Overwrites `next`.
    fn reduced<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &mut Context,
        transition: &Transition,
        at: Free<F>,
        reduce: &dyn Fn(&[f64]) -> f64,
    ) -> f64 {
        if !transition.conditional {
            return reduce(&[]);
        }
        kernel.reset(context, &transition.kernel, at, self.next);
        self.reduced_after_reset(context, transition, reduce)
    }

    /// The same where `next` holds the reset.
    fn reduced_after_reset(
        &mut self,
        context: &mut Context,
        transition: &Transition,
        reduce: &dyn Fn(&[f64]) -> f64,
    ) -> f64 {
        let target = &self.modes[transition.target];
        self.swap_with(context);
        let n = context.held().len();
        let condition = with_kernel!(&target.kernels, k => {
            conditions_in(k, context, transition, &target.free, &self.next[n..2 * n], reduce)
        });
        self.swap_with(context);
        condition
    }

    /// Exchanges coordinates and discrete states with those of a context.
    #[inline(always)]
    fn swap_with(&mut self, context: &mut Context) {
        let n = context.held().len();
        self.next[..n].swap_with_slice(context.held_mut());
        self.next[2 * n..].swap_with_slice(context.discrete_mut());
    }

    /// The smallest condition of a transition; +∞ if it has none.
    pub fn least<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &mut Context,
        transition: &Transition,
        at: Free<F>,
    ) -> f64 {
        let least = |all: &[f64]| all.iter().copied().fold(f64::INFINITY, f64::min);
        self.reduced(kernel, context, transition, at, &least)
    }

    /// The same of all but one of its conditions.
    pub fn least_but<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &mut Context,
        (transition, component): (&Transition, usize),
        at: Free<F>,
    ) -> f64 {
        let least = |all: &[f64]| {
            let others = all.iter().enumerate().filter(|(i, _)| *i != component);
            others.fold(f64::INFINITY, |least, (_, c)| least.min(*c))
        };
        self.reduced(kernel, context, transition, at, &least)
    }
}

/// The conditions in their target mode, whose coordinates and discrete states the context holds. NaN
/// where the accelerations are not determined.
fn conditions_in<F: Size>(
    kernel: &ModeKernel<F>,
    context: &mut Context,
    transition: &Transition,
    free: &[usize],
    rates: &[f64],
    reduce: &dyn Fn(&[f64]) -> f64,
) -> f64 {
    let size = kernel.size();
    let q = size.vector(|i| context.held()[free[i]]);
    let v = size.vector(|i| rates[free[i]]);
    let system = kernel.system(context, &q, &v);
    let Ok(a) = system.accelerations(&size.repeat(1.0)) else {
        return f64::NAN;
    };
    let at = Free {
        q: &q,
        v: &v,
        a: &a,
    };
    reduce(kernel.conditions(context, &transition.kernel, at))
}

/// Value of what is watched, in the present mode.
#[inline(always)]
pub(super) fn watched_value<F: Size>(
    kernel: &ModeKernel<F>,
    context: &mut Context,
    conditions: &mut Conditions,
    guard: &Guard,
    watched: Watched,
    at: Free<F>,
) -> f64 {
    match watched.condition {
        None => kernel.guard(context, &guard.kernel, at),
        Some((t, component)) => {
            let transition = &guard.transitions[t];
            -conditions.reduced(kernel, context, transition, at, &|all| all[component])
        }
    }
}

/// Value of a guard of the present mode; a conditional one is respected as well where none of its
/// conditions holds.
#[inline(always)]
pub(super) fn value<F: Size>(
    kernel: &ModeKernel<F>,
    context: &mut Context,
    conditions: &mut Conditions,
    (guard, watched): (&Guard, Watched),
    at: Free<F>,
) -> f64 {
    let value = kernel.guard(context, &guard.kernel, at);
    if value >= 0.0 || !watched.conditional {
        return value;
    }
    let mut best = f64::NEG_INFINITY;
    for transition in guard
        .transitions
        .iter()
        .filter(|t| conditions.plan.allowed[t.target])
    {
        best = best.max(conditions.least(kernel, context, transition, at));
    }
    value.max(-best)
}

/// Motion at local time `tau` of a step, with accelerations from the equations where asked for.
#[inline(always)]
pub(super) fn motion<F: Size>(
    equations: &mut Equations<F>,
    dense: &dyn Motion<F>,
    tau: f64,
    accelerations: bool,
) -> [F::Vector; 3] {
    equations.at(tau);
    motion_at_stage(equations, dense, tau, accelerations)
}

/// The same, with the context set as far as the equations of motion need it.
pub(super) fn motion_at_stage<F: Size>(
    equations: &mut Equations<F>,
    dense: &dyn Motion<F>,
    tau: f64,
    accelerations: bool,
) -> [F::Vector; 3] {
    if !accelerations {
        let (q, v, a) = dense.at(tau);
        equations.at_stage(tau);
        return [q, v, a];
    }
    let (q, v) = dense.state_at(tau);
    equations.at_stage(tau);
    let a = equations.acceleration_here(&q, &v);
    let a = a.unwrap_or_else(|_| equations.kernel.size().repeat(f64::NAN));
    [q, v, a]
}

/// What a linear guard multiplies its coordinate or rate with: its factor and its discrete state, if any.
#[inline]
pub(super) fn slope((factor, discrete): (f64, Option<usize>), context: &Context) -> f64 {
    factor * discrete.map_or(1.0, |d| context.discrete()[d])
}
