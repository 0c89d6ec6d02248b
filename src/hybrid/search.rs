//! The search of a guard on a step's dense output.

use super::equations::Equations;
use super::guards::{Conditions, Linear, motion, motion_at_stage, watched_value};
use super::plan::Watched;
use super::roots::{self, Isolation, Polynomial, Search, Watch, straight_crossing, sum_of};
use crate::integrate::{Motion, ORDERS, System, stretch};
use crate::kernel::Free;
use crate::model::{Guard, GuardShape};
use crate::numerics::Size;

/// Searches a guard on the window `from` < τ ≤ `to` of a step; writes what is found.
#[inline(always)]
pub(super) fn search<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    dense: &impl Motion<F>,
    (guard, watched): (&Guard, Watched),
    window: (f64, f64),
    (watch, isolation, found): (Watch, Isolation, &mut Search),
) {
    // Guard and condition are looked at together on the far side of the fall.
    let isolation = match watched.conditional {
        true => Isolation::Bracket,
        false => isolation,
    };
    match guard.shape {
        GuardShape::Linear { .. } if watched.condition.is_none() => {
            search_linear(equations, dense, guard, (window, isolation), (watch, found));
        }
        _ => {
            // A guard that acts together with conditions is judged by its own values where one of
            // them changes its sign; its series has its roots elsewhere, by the tolerance.
            let by_series = match watched.conditional {
                true => BySeries::Nothing,
                false => search_series(
                    equations,
                    dense,
                    (guard, watched),
                    (window, isolation),
                    (watch, &mut *found),
                ),
            };
            let (window, watch) = match by_series {
                BySeries::All => return,
                BySeries::PositiveUntil(from) => ((from, window.1), Watch::Armed),
                BySeries::Nothing => (window, watch),
            };
            let of = (guard, watched);
            *found = search_values(equations, conditions, dense, of, (window, watch));
        }
    }
}

/// Searches a guard by its values. Compiled once for all methods: a value takes longer than to ask which method it is.
fn search_values<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    dense: &dyn Motion<F>,
    (guard, watched): (&Guard, Watched),
    (window, watch): ((f64, f64), Watch),
) -> Search {
    let accelerations = !matches!(
        guard.shape,
        GuardShape::General {
            accelerations: false,
            ..
        }
    );
    // Conditions may depend on more of the inputs than the equations of motion do.
    let own = watched.condition.is_none() && !watched.conditional;
    if own {
        equations.foresee(&roots::FIRST_POINTS.map(|s| at_part(s, window)));
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
    search_function(evaluate, window, watch)
}

/// Local time at a part of a window.
fn at_part(s: f64, (from, to): (f64, f64)) -> f64 {
    if s < 1.0 { from + s * (to - from) } else { to }
}

/// Searches a function of local time, as one of s = (τ − start)/length of the window: so the search, which
/// counts doubles, does not depend on the unit of time.
pub(super) fn search_function(
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

/// A coordinate or a rate is a polynomial in s = (τ − start)/length of the step.
#[inline(always)]
fn search_linear<F: Size>(
    equations: &mut Equations<F>,
    dense: &impl Motion<F>,
    guard: &Guard,
    (window, isolation): ((f64, f64), Isolation),
    (watch, found): (Watch, &mut Search),
) {
    let linear = Linear::of(guard.shape, equations.context);
    let Linear {
        index,
        rate,
        factor,
        offset,
    } = linear.expect("the caller has asked for its shape");
    let [constant, slope] = dense.value_and_slope((index, rate), factor);
    let constant = match offset {
        false => constant,
        // Its own value was zero; the first coefficient of the dense output may be off by a rounding.
        true if watch == Watch::Dormant && window.0 == dense.start() => 0.0,
        true => {
            // What is added is what the guard is at the zero state.
            let zero = equations.kernel.size().zeros();
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
        rises: slope > 0.0,
        write: &mut |first, out: &mut [f64]| {
            dense.polynomial((index, rate), factor, first, out);
            if offset && first == 0 {
                out[0] = constant;
            }
        },
    };
    let part = ((dense.start(), dense.length()), window, isolation);
    search_polynomial(coefficients, part, (watch, found));
}

/// How much of a window was searched by the guard's own series.
enum BySeries {
    All,
    /// Of a guard that rises from zero: there is no event up to here, and the rest was not searched.
    PositiveUntil(f64),
    Nothing,
}

/// How many orders of the guards of a mode are asked for on a step whose motion is known to so many.
#[inline(always)]
pub(super) fn orders_of_guards<F: Size>(
    equations: &Equations<F>,
    dense: &(impl Motion<F> + ?Sized),
    orders: usize,
) -> usize {
    match equations.kernel.guards_end(equations.context) {
        true => orders.min(dense.coefficients(false)),
        false => orders,
    }
}

/// Whether the last terms of a guard's series are small enough, of so many coefficients that are not zero and so many `orders`; given are
/// those from the power `first` on, in powers of the part of a step.
#[inline(always)]
pub(super) fn falls_off(
    (powers, first): (&[f64], usize),
    (count, orders): (usize, usize),
    tolerance: f64,
) -> bool {
    let size = |of: &[f64]| sum_of(of, f64::abs);
    count + 2 <= orders || {
        let all = (orders * orders) as f64 * size(&powers[..count - first]);
        size(&powers[orders - 2 - first..count - first]) <= tolerance * all
    }
}

/// A guard on a step of the Taylor method is a polynomial too: its own Taylor series.
///
/// It is not searched if its series falls off more slowly than that of the motion, so
/// that the last terms are not small: two derivatives of the motion multiply its last term by order². A guard that begins at
/// zero, whose values near it are roundings, is searched on as large a part of the step as its series takes.
#[inline(always)]
fn search_series<F: Size>(
    equations: &mut Equations<F>,
    dense: &impl Motion<F>,
    (guard, watched): (&Guard, Watched),
    (window, isolation): ((f64, f64), Isolation),
    (watch, found): (Watch, &mut Search),
) -> BySeries {
    let Some((series, orders)) = dense.series() else {
        return BySeries::Nothing;
    };
    let tau = dense.start();
    let expanded = orders_of_guards(equations, dense, orders);
    equations.expand_guards(tau, expanded, series);
    let kernel = equations.kernel;
    let mut powers = [0.0; ORDERS];
    let powers = &mut powers[..expanded];
    kernel.guard_coefficients(equations.context, watched.guard, powers);
    let constant = &mut powers[0];
    let is_known = watch == Watch::Armed && window.0 == tau && *constant > 0.0;
    // It was zero where the segment began, and rises from there.
    let begins_at_zero = watch == Watch::Dormant && window.0 == tau && tau == 0.0;
    if begins_at_zero {
        *constant = 0.0;
    } else if !is_known {
        // The guard's own value decides on which side of zero it starts: it may be rounded otherwise.
        equations.at(tau);
        let rows = [&series.q, &series.v, &series.a];
        let [q, v, a] = rows.map(|rows| kernel.size().vector(|i| rows[0][i]));
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        *constant = kernel.guard(equations.context, &guard.kernel, at);
    }
    // Of a low degree where nothing moves.
    let degree = (1..expanded).rev().find(|&k| powers[k] != 0.0);
    let count = degree.map_or(1, |degree| degree + 1);
    let powers = &powers[..count];
    let (constant, slope) = (powers[0], powers.get(1).copied().unwrap_or(0.0));
    // Where nothing moves but what drifts.
    let is_plain = watch == Watch::Armed && isolation == Isolation::Root && window.0 == tau;
    if count <= 2
        && is_plain
        && let Some(straight) = straight_crossing(constant, slope, window.1 - tau)
    {
        *found = straight;
        if let Some(crossing) = &mut found.crossing {
            let place = (tau + crossing.outside).min(window.1);
            (crossing.inside, crossing.outside) = (place, place);
        }
        return BySeries::All;
    }
    let tolerance = equations.tolerance;
    let (mut length, mut to) = (dense.length(), window.1);
    // What is far beyond the window says nothing about how well the series does in it.
    while to <= tau + 0.5 * length {
        length *= 0.5;
    }
    loop {
        let mut holds = true;
        let coefficients = Coefficients {
            count,
            constant,
            rises: slope * length > 0.0,
            write: &mut |first, out: &mut [f64]| {
                stretch(powers, |c| *c, (1.0, length, first), out);
                holds = falls_off((out, first), (count, orders), tolerance);
            },
        };
        let part = ((tau, length), (window.0, to), isolation);
        search_polynomial(coefficients, part, (watch, &mut *found));
        if holds {
            return match found.crossing.is_some() || to == window.1 {
                true => BySeries::All,
                false => BySeries::PositiveUntil(to),
            };
        }
        // Also where it is not finite.
        if !begins_at_zero || to <= window.0 {
            return BySeries::Nothing;
        }
        length *= 0.5;
        to = to.min(tau + length);
    }
}

/// A polynomial in s.
pub(super) struct Coefficients<'w> {
    /// Their number.
    pub count: usize,
    /// That of the power 0.
    pub constant: f64,
    /// Whether that of the power 1 is positive.
    pub rises: bool,
    /// Writes them, from a power on: a call, so that one search serves all sizes and methods.
    pub write: &'w mut dyn FnMut(usize, &mut [f64]),
}

/// Searches a polynomial in s = (τ − start)/length.
#[inline]
pub(super) fn search_polynomial(
    coefficients: Coefficients,
    ((start, length), (from, to), isolation): ((f64, f64), (f64, f64), Isolation),
    (watch, found): (Watch, &mut Search),
) {
    let local = |tau: f64| ((tau - start) / length).clamp(0.0, 1.0);
    let window = (local(from), local(to));
    search_window(coefficients, (window, isolation), (watch, &mut *found));
    if let Some(crossing) = &mut found.crossing {
        crossing.inside = start + crossing.inside * length;
        crossing.outside = (start + crossing.outside * length).min(to);
    }
}

/// Searches a polynomial in s on a window within 0 ≤ s ≤ 1.
pub(super) fn search_window(
    coefficients: Coefficients,
    window: ((f64, f64), Isolation),
    of: (Watch, &mut Search),
) {
    // Work grows with the square of the room.
    match coefficients.count {
        0..=3 => search_part::<3>(coefficients, window, of),
        4 => search_part::<4>(coefficients, window, of),
        5..=8 => search_part::<8>(coefficients, window, of),
        9..=12 => search_part::<12>(coefficients, window, of),
        13..=16 => search_part::<16>(coefficients, window, of),
        17..=20 => search_part::<20>(coefficients, window, of),
        21..=24 => search_part::<24>(coefficients, window, of),
        25..=28 => search_part::<28>(coefficients, window, of),
        29..=32 => search_part::<32>(coefficients, window, of),
        _ => search_part::<ORDERS>(coefficients, window, of),
    }
}

/// Searches a polynomial of at most `N` coefficients. They are written where they are read: a copy right
/// after them would wait for what is on its way to memory.
#[inline(never)]
fn search_part<const N: usize>(
    of: Coefficients,
    ((from, to), isolation): ((f64, f64), Isolation),
    (watch, found): (Watch, &mut Search),
) {
    let mut polynomial = Polynomial {
        coefficients: [0.0; N],
    };
    let starts = watch == Watch::Dormant && from == 0.0 && to > 0.0 && of.constant == 0.0;
    if starts && of.rises {
        (of.write)(1, &mut polynomial.coefficients);
        return polynomial.search_of_multiple(1, to, isolation, found);
    }
    (of.write)(0, &mut polynomial.coefficients);
    match watch {
        Watch::Armed => polynomial.search_armed((from, to), 0.0, isolation, found),
        _ => *found = polynomial.search(from, to, watch, 0.0),
    }
}
