//! Values of guards, and their search on a step's dense output.

use super::equations::Equations;
use super::plan::{Plan, Watched};
use super::roots::{self, Polynomial, Search, Watch, sum_of};
use crate::integrate::{Motion, ORDERS, System, solve, stretch};
use crate::kernel::with_kernel;
use crate::kernel::{Context, Free, MOST_CONDITIONS, ModeKernel};
use crate::model::{Guard, GuardShape, Transition, Variant};
use nalgebra::SVector;

/// What the conditions of transitions are evaluated with.
pub(super) struct Conditions<'a> {
    pub variant: &'static Variant,
    pub plan: &'a Plan,
    /// Room for a reset: q, v, discrete states.
    pub next: &'a mut [f64],
}

impl Conditions<'_> {
    /// Whether all transitions that the guard may trigger are conditional, so that guard and
    /// conditions are watched together.
    pub fn are_part_of(&self, guard: &Guard) -> bool {
        self.admissible(guard).all(|t| t.conditional)
    }

    /// The transitions of a guard whose targets the scene may visit.
    pub fn admissible<'g>(&self, guard: &'g Guard) -> impl Iterator<Item = &'g Transition> {
        guard
            .transitions
            .iter()
            .filter(|t| self.plan.allowed[t.target])
    }

    /// The conditions of a transition out of the present mode, evaluated in its target after the
    /// reset, reduced by `reduce`. `next` holds the reset afterwards.
    fn reduced<const F: usize>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &mut Context,
        transition: &Transition,
        at: Free<F>,
        reduce: impl Fn(&[f64]) -> f64,
    ) -> f64 {
        kernel.reset(context, &transition.kernel, at, self.next);
        if !transition.conditional {
            return reduce(&[]);
        }
        let n = context.held().len();
        let target = &self.variant.modes[transition.target];
        context.held_mut().swap_with_slice(&mut self.next[..n]);
        context
            .discrete_mut()
            .swap_with_slice(&mut self.next[2 * n..]);
        let condition = with_kernel!(&target.kernels, k => {
            conditions_in(k, context, transition, target.free, &self.next[n..2 * n], reduce)
        });
        context.held_mut().swap_with_slice(&mut self.next[..n]);
        context
            .discrete_mut()
            .swap_with_slice(&mut self.next[2 * n..]);
        condition
    }

    /// The smallest condition of a transition; +∞ if it has none.
    pub fn least<const F: usize>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &mut Context,
        transition: &Transition,
        at: Free<F>,
    ) -> f64 {
        let least = |all: &[f64]| all.iter().copied().fold(f64::INFINITY, f64::min);
        self.reduced(kernel, context, transition, at, least)
    }
}

/// The conditions in their target mode, whose coordinates and discrete states the context holds. NaN
/// where the accelerations are not determined.
fn conditions_in<const F: usize>(
    kernel: &ModeKernel<F>,
    context: &Context,
    transition: &Transition,
    free: &[usize],
    rates: &[f64],
    reduce: impl Fn(&[f64]) -> f64,
) -> f64 {
    let q = SVector::<f64, F>::from_fn(|i, _| context.held()[free[i]]);
    let v = SVector::<f64, F>::from_fn(|i, _| rates[free[i]]);
    let system = kernel.system(context, &q, &v);
    let Ok(a) = solve(&system.mass, &-system.load, &SVector::repeat(1.0)) else {
        return f64::NAN;
    };
    let at = Free {
        q: &q,
        v: &v,
        a: &a,
    };
    let mut room = [0.0; MOST_CONDITIONS];
    reduce(kernel.conditions(context, &transition.kernel, at, &mut room))
}

/// Value of what is watched, in the present mode.
#[inline]
pub(super) fn watched_value<const F: usize>(
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
            -conditions.reduced(kernel, context, transition, at, |all| all[component])
        }
    }
}

/// Value of a guard of the present mode; a conditional one is respected as well where none of its
/// conditions holds.
#[inline]
pub(super) fn value<const F: usize>(
    kernel: &ModeKernel<F>,
    context: &mut Context,
    conditions: &mut Conditions,
    guard: &Guard,
    at: Free<F>,
) -> f64 {
    let value = kernel.guard(context, &guard.kernel, at);
    if value >= 0.0 || !conditions.are_part_of(guard) {
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
pub(super) fn motion<const F: usize>(
    equations: &mut Equations<F>,
    dense: &impl Motion<F>,
    tau: f64,
    accelerations: bool,
) -> [SVector<f64, F>; 3] {
    equations.at(tau);
    motion_at_stage(equations, dense, tau, accelerations)
}

/// The same, with the context set as far as the equations of motion need it.
fn motion_at_stage<const F: usize>(
    equations: &mut Equations<F>,
    dense: &impl Motion<F>,
    tau: f64,
    accelerations: bool,
) -> [SVector<f64, F>; 3] {
    let (q, v, mut a) = dense.at(tau);
    equations.at_stage(tau);
    if accelerations {
        let found = equations.acceleration_here(&q, &v);
        a = found.unwrap_or(SVector::repeat(f64::NAN));
    }
    [q, v, a]
}

/// Searches a guard on the window `from` < τ ≤ `to` of a step; writes what is found.
pub(super) fn search<const F: usize>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    dense: &impl Motion<F>,
    (guard, watched): (&Guard, Watched),
    window: (f64, f64),
    (watch, found): (Watch, &mut Search),
) {
    match guard.shape {
        GuardShape::Linear { .. } if watched.condition.is_none() => {
            search_linear(equations, dense, guard, window, (watch, found));
        }
        _ => {
            // A guard that acts together with conditions is judged by its own values where one of
            // them changes its sign; its series has its roots elsewhere, by the tolerance.
            if !conditions.are_part_of(guard)
                && search_series(
                    equations,
                    dense,
                    (guard, watched),
                    window,
                    (watch, &mut *found),
                )
            {
                return;
            }
            let accelerations = !matches!(
                guard.shape,
                GuardShape::General {
                    accelerations: false,
                    ..
                }
            );
            // Conditions may depend on more of the inputs than the equations of motion do.
            let own = watched.condition.is_none() && !conditions.are_part_of(guard);
            if own {
                equations.foresee(&roots::FIRST_PLACES.map(|s| at_part(s, window)));
            }
            let evaluate = |tau: f64| {
                let [q, v, a] = match own {
                    true => motion_at_stage(equations, dense, tau, accelerations),
                    false => motion(equations, dense, tau, accelerations),
                };
                let at = Free {
                    q: &q,
                    v: &v,
                    a: &a,
                };
                watched_value(
                    equations.kernel,
                    equations.context,
                    conditions,
                    guard,
                    watched,
                    at,
                )
            };
            *found = search_function(evaluate, window, watch);
        }
    }
}

/// Local time at a part of a window.
fn at_part(s: f64, (from, to): (f64, f64)) -> f64 {
    if s < 1.0 { from + s * (to - from) } else { to }
}

/// Searches a function of local time, as one of s = (τ − start)/length of the window: so the search, which
/// counts doubles, does not depend on the unit of time.
fn search_function(
    mut evaluate: impl FnMut(f64) -> f64,
    window: (f64, f64),
    watch: Watch,
) -> Search {
    let local = |s: f64| at_part(s, window);
    let mut search = roots::search(|s| evaluate(local(s)), 0.0, 1.0, watch, 0.0);
    if let Some(crossing) = &mut search.crossing {
        crossing.inside = local(crossing.inside);
        crossing.outside = local(crossing.outside);
    }
    search
}

/// What a linear guard multiplies its coordinate or rate with: its factor and its discrete state, if any.
#[inline]
pub(super) fn slope((factor, discrete): (f64, Option<usize>), context: &Context) -> f64 {
    factor * discrete.map_or(1.0, |d| context.discrete()[d])
}

/// A coordinate or a rate is a polynomial in s = (τ − start)/length of the step.
fn search_linear<const F: usize>(
    equations: &mut Equations<F>,
    dense: &impl Motion<F>,
    guard: &Guard,
    window: (f64, f64),
    (watch, found): (Watch, &mut Search),
) {
    let GuardShape::Linear {
        index,
        rate,
        factor,
        discrete,
        offset,
    } = guard.shape
    else {
        unreachable!("the caller has asked for its shape")
    };
    let factor = slope((factor, discrete), equations.context);
    let constant = dense.constant((index, rate), factor);
    let constant = match offset {
        false => constant,
        // Its own value was zero; the first coefficient of the dense output may be off by a rounding.
        true if watch == Watch::Dormant && window.0 == dense.start() => 0.0,
        true => {
            // What is added is what the guard is at the zero state.
            let zero = SVector::<f64, F>::zeros();
            let at = Free {
                q: &zero,
                v: &zero,
                a: &zero,
            };
            constant + equations.kernel.guard(equations.context, &guard.kernel, at)
        }
    };
    let coefficients = Coefficients {
        count: dense.coefficients(rate),
        constant,
        rises: dense.slope((index, rate), factor) > 0.0,
        write: |first, out: &mut [f64]| {
            dense.polynomial((index, rate), factor, first, out);
            if offset && first == 0 {
                out[0] = constant;
            }
        },
    };
    search_polynomial(coefficients, dense, window, (watch, found));
}

/// A guard on a step of the Taylor method is a polynomial too: its own Taylor series.
///
/// False if it cannot be expanded, or if its series falls off more slowly than that of the motion, so
/// that the last terms are not small: two derivatives of the motion multiply its last term by order².
fn search_series<const F: usize>(
    equations: &mut Equations<F>,
    dense: &impl Motion<F>,
    (guard, watched): (&Guard, Watched),
    window: (f64, f64),
    (watch, found): (Watch, &mut Search),
) -> bool {
    let Some((series, orders)) = dense.series() else {
        return false;
    };
    let tau = dense.start();
    if !equations.expand_guards(tau, orders, series) {
        return false;
    }
    let (kernel, context) = (equations.kernel, &*equations.context);
    let mut powers = [0.0; ORDERS];
    let given = kernel.guard_coefficients(context, watched.guard, orders);
    for (power, given) in powers.iter_mut().zip(given) {
        *power = given;
    }
    // Of a low degree where nothing moves.
    let degree = powers[..orders].iter().rposition(|&c| c != 0.0);
    let count = degree.map_or(1, |degree| degree + 1);
    // The guard's own value decides on which side of zero it starts.
    equations.at(tau);
    let at = Free {
        q: &series.q[0],
        v: &series.v[0],
        a: &series.a[0],
    };
    let constant = kernel.guard(equations.context, &guard.kernel, at);
    powers[0] = constant;
    let mut falls_off = true;
    let coefficients = Coefficients {
        count,
        constant,
        rises: powers[1] * dense.length() > 0.0,
        write: |first, out: &mut [f64]| {
            let scale = (1.0, dense.length(), first);
            stretch(&powers[..count], |own| *own, scale, out);
            if count + 2 > orders {
                let size = |of: &[f64]| sum_of(of, f64::abs);
                let all = (orders * orders) as f64 * size(&out[..count - first]);
                falls_off =
                    size(&out[orders - 2 - first..count - first]) <= equations.tolerance * all;
            }
        },
    };
    search_polynomial(coefficients, dense, window, (watch, found));
    falls_off
}

/// A polynomial in s.
pub(super) struct Coefficients<W: FnMut(usize, &mut [f64])> {
    /// Their number.
    pub count: usize,
    /// That of the power 0.
    pub constant: f64,
    /// Whether that of the power 1 is positive.
    pub rises: bool,
    /// Writes them, from a power on.
    pub write: W,
}

/// Searches a polynomial in s = (τ − start)/length of the step.
#[inline]
fn search_polynomial<const F: usize>(
    coefficients: Coefficients<impl FnMut(usize, &mut [f64])>,
    dense: &impl Motion<F>,
    (from, to): (f64, f64),
    (watch, found): (Watch, &mut Search),
) {
    let local = |tau: f64| ((tau - dense.start()) / dense.length()).clamp(0.0, 1.0);
    search_window(coefficients, (local(from), local(to)), (watch, &mut *found));
    if let Some(crossing) = &mut found.crossing {
        crossing.inside = dense.start() + crossing.inside * dense.length();
        crossing.outside = (dense.start() + crossing.outside * dense.length()).min(to);
    }
}

/// Searches a polynomial in s on a window within 0 ≤ s ≤ 1.
pub(super) fn search_window(
    coefficients: Coefficients<impl FnMut(usize, &mut [f64])>,
    window: (f64, f64),
    of: (Watch, &mut Search),
) {
    // Work grows with the square of the room.
    match coefficients.count {
        0..=4 => search_part::<4>(coefficients, window, of),
        5..=8 => search_part::<8>(coefficients, window, of),
        9..=12 => search_part::<12>(coefficients, window, of),
        13..=16 => search_part::<16>(coefficients, window, of),
        17..=20 => search_part::<20>(coefficients, window, of),
        21..=24 => search_part::<24>(coefficients, window, of),
        25..=28 => search_part::<28>(coefficients, window, of),
        _ => search_part::<ORDERS>(coefficients, window, of),
    }
}

/// Searches a polynomial of at most `N` coefficients. They are written where they are read: a copy right
/// after them would wait for what is on its way to memory.
#[inline(never)]
fn search_part<const N: usize>(
    mut of: Coefficients<impl FnMut(usize, &mut [f64])>,
    (from, to): (f64, f64),
    (watch, found): (Watch, &mut Search),
) {
    let mut polynomial = Polynomial {
        coefficients: [0.0; N],
    };
    let starts = watch == Watch::Dormant && from == 0.0 && to > 0.0 && of.constant == 0.0;
    if starts && of.rises {
        (of.write)(1, &mut polynomial.coefficients);
        return polynomial.search_of_multiple(to, found);
    }
    (of.write)(0, &mut polynomial.coefficients);
    match watch {
        Watch::Armed => polynomial.search_armed(from, to, 0.0, found),
        _ => *found = polynomial.search(from, to, watch, 0.0),
    }
}
