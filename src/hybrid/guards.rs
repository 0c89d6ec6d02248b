//! Values of guards and conditions.

use super::equations::Equations;
use super::plan::{Plan, Watched};
use crate::integrate::{Path, Size};
use crate::kernel::with_kernel;
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::{Guard, GuardShape, Mode, Transition};

/// What the conditions of transitions are evaluated with.
pub(super) struct Conditions<'a> {
    pub modes: &'a [Mode],
    pub plan: &'a Plan,
    /// Room for a reset: q, v, discrete states.
    pub next: &'a mut [f64],
}

impl Conditions<'_> {
    /// The conditions of a transition out of the present mode, evaluated in its target after the
    /// reset, reduced by `reduce`; NaN where the accelerations are not determined there. Overwrites `next`.
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
        let target = &self.modes[transition.target];
        let after = (&*self.next, &*target.free);
        let conditions =
            with_kernel!(&target.kernels, k => k.conditions(context, &transition.kernel, after));
        conditions.map_or(f64::NAN, reduce)
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
    path: &dyn Path<F>,
    tau: f64,
    accelerations: bool,
) -> [F::Vector; 3] {
    equations.at(tau);
    motion_at_stage(equations, path, tau, accelerations)
}

/// The same, with the context set as far as the equations of motion need it.
pub(super) fn motion_at_stage<F: Size>(
    equations: &mut Equations<F>,
    path: &dyn Path<F>,
    tau: f64,
    accelerations: bool,
) -> [F::Vector; 3] {
    if !accelerations {
        let (q, v, a) = path.at(tau);
        equations.at_stage(tau);
        return [q, v, a];
    }
    let (q, v) = path.state_at(tau);
    equations.at_stage(tau);
    let a = equations.acceleration_here(&q, &v);
    let a = a.unwrap_or_else(|_| equations.kernel.size().repeat(f64::NAN));
    [q, v, a]
}

/// A guard that is linear, in the present discrete state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Linear {
    /// Index of the free coordinate.
    pub index: usize,
    /// Whether its rate is meant.
    pub rate: bool,
    /// What it is multiplied with.
    pub factor: f64,
    /// Whether something is added that does not move.
    pub offset: bool,
}

impl Linear {
    /// A guard by its shape; `None`: it is not linear.
    #[inline(always)]
    pub fn of(shape: GuardShape, context: &Context) -> Option<Self> {
        let GuardShape::Linear {
            index,
            rate,
            factor,
            discrete,
            offset,
        } = shape
        else {
            return None;
        };
        Some(Linear {
            index,
            rate,
            factor: slope((factor, discrete), context),
            offset,
        })
    }
}

/// What a linear guard multiplies its coordinate or rate with: its factor and its discrete state, if any.
#[inline]
pub(super) fn slope((factor, discrete): (f64, Option<usize>), context: &Context) -> f64 {
    factor * discrete.map_or(1.0, |d| context.discrete()[d])
}
