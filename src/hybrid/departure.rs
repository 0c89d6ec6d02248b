//! With which sign a number that is zero leaves zero: a guard at the start of a segment, a condition where its
//! transition is to be taken.
//!
//! That is a question about the exact motion. The number is zero if rounding may have made it what it is; then the
//! first derivative along the motion decides that is more than its own rounding. A derivative below its rounding is no
//! evidence and is skipped: at a smooth lift-off height, rate and acceleration vanish, and what is computed of them is
//! noise. The derivatives come from [`crate::jets`], whatever the method, so nothing depends on the first coefficients
//! of a dense output, which are noise as well.

use super::guards::Conditions;
use super::simulation::Simulation;
use crate::jets::{Expansion, ORDERS, Point};
use crate::kernel::{Free, ModeKernel, with_kernel};
use crate::model::{Mode, Transition};
use crate::numerics::Size;

/// Roundings that a number has collected, as a part of what it changes by at its present rate since the start: those of a thousand steps
/// add up as the square root of their number.
pub(super) const COLLECTED: f64 = 32.0 * f64::EPSILON;

/// What is more than this part of the sum of its terms is no zero: the square root of the unit roundoff, so that no rounding decides, were
/// it of a hundred million operations. Whatever is closer to zero is asked of each operation: two bounds that are not the same could
/// each send a guard to the mode of the other.
pub(super) const CLEAR: f64 = 1.0 / (1u64 << 26) as f64;

/// How a number goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Departure {
    /// It is positive, or becomes so at once with the derivative of this `order`, and stays so for a time, s: 0 where that is
    /// not asked for.
    Up { order: usize, until: f64 },
    /// It is negative, or becomes so at once with the derivative of this order.
    Down { order: usize },
    /// It is zero, and all derivatives are, as far as rounding tells; and for a time, s, what rounding makes of these is no more than of
    /// the value: 0 where that is not asked for.
    Stays { until: f64 },
    /// Rounding errors are not known: an operation has no rule, or is singular.
    Unknown,
}

/// What is asked for: results of a tape along the motion of a mode from a state.
struct Question<'a> {
    mode: &'a Mode,
    tape: &'a crate::jets::Tape,
    index: usize,
    at: Point<'a>,
    /// Typical sizes of coordinates and rates.
    sizes: [&'a [f64]; 2],
    /// For how long the series holds, s; 0 where nothing is asked of how long a sign lasts.
    within: f64,
    /// A sign that the derivative of this order decides, or the value itself, need not be known to last.
    shown: usize,
    /// How many of the first derivatives, the value among them, are zero whatever rounding makes of them.
    vanishing: usize,
}

impl Question<'_> {
    /// Expands the motion as far as it takes.
    fn answer(&self, expansion: &mut Expansion) -> Departure {
        let Question {
            mode, tape, index, ..
        } = *self;
        // The value is not known better than the state is: to a rounding of what is typical of it.
        expansion.begin(mode, self.at, Some(self.sizes));
        expansion.expand(mode, tape, 0);
        let value = expansion.result(tape, index)[0];
        if !value.error.is_finite() {
            return Departure::Unknown;
        }
        let first = self.vanishing.max(1);
        let decisive = match value.sign() {
            Some(_) if self.vanishing == 0 => Some(0),
            _ => {
                // It is zero, and leaves zero as the motion from the state that is given does.
                expansion.begin(mode, self.at, None);
                (0..first).for_each(|k| expansion.expand(mode, tape, k));
                (first..ORDERS).find(|&k| {
                    expansion.expand(mode, tape, k);
                    expansion.result(tape, index)[k].sign().is_some()
                })
            }
        };
        let Some(order) = decisive else {
            let others = expansion.result(tape, index)[1..].iter();
            let sizes = others.map(|c| c.value.abs() + c.error);
            let until = outweighs_for(2.0 * value.error, sizes, self.within);
            return Departure::Stays { until };
        };
        if expansion.result(tape, index)[order].sign() == Some(false) {
            return Departure::Down { order };
        }
        if order <= self.shown || self.within <= 0.0 {
            return Departure::Up { order, until: 0.0 };
        }
        for k in order + 1..ORDERS {
            expansion.expand(mode, tape, k);
        }
        let until = self.lasts(&expansion.result(tape, index)[order..]);
        Departure::Up { order, until }
    }

    /// For how long the first of some coefficients outweighs the others twice, s: till then the sign is its own.
    fn lasts(&self, coefficients: &[crate::jets::Bounded]) -> f64 {
        let (first, others) = coefficients.split_first().expect("it was found");
        let others = others.iter().map(|c| c.value.abs() + c.error);
        outweighs_for(first.value - first.error, others, self.within)
    }
}

/// For how long, and no longer than `within`, the first of some coefficients of a power series is at least twice the sum of the sizes of
/// the others, s. Where nothing is known of an order its neighbours tell.
pub(super) fn outweighs_for(
    first: f64,
    others: impl DoubleEndedIterator<Item = f64> + Clone,
    within: f64,
) -> f64 {
    let known = |size: f64| if size.is_finite() { size } else { 0.0 };
    let outweighs = |time: f64| {
        let sum = (others.clone().rev()).fold(0.0, |sum, size| time * (sum + known(size)));
        sum <= 0.5 * first
    };
    // No more than 2³² s, 136 years: what is known to last longer is looked at from there on.
    let mut time = within.min((1u64 << 32) as f64);
    // The second alone tells most of them.
    let next = others.clone().next().map_or(0.0, known);
    while time > 0.0 && time * next > 65_536.0 * first {
        time /= 65_536.0;
    }
    while time > 0.0 && !(time * next <= 0.5 * first && outweighs(time)) {
        time *= 0.5;
    }
    time
}

impl<'p> Simulation<'p> {
    /// How a guard of the present mode goes on from here, of which so many derivatives are known to vanish, the value among
    /// them; the context is set for it. A rise by the derivative of order `shown` need not be known to last.
    #[cold]
    pub fn departure(&mut self, guard: usize, vanishing: usize, shown: usize) -> Departure {
        self.expand_signals();
        let within = self.smooth_from(self.here.now.seconds());
        self.ask(guard, |question, expansion| {
            let question = Question {
                within,
                vanishing,
                shown,
                ..question
            };
            question.answer(expansion)
        })
    }

    /// For how long the series of all inputs hold from a time on, s; it does not depend on when the run ends, which may go on
    /// from there.
    pub(super) fn smooth_from(&self, now: f64) -> f64 {
        // The series of an input ends at its next knot, also where it goes on smoothly.
        self.signals.next_knot(now) - now
    }

    /// Whether a guard of the present mode is at zero or below, as far as roundings tell: its own, and those that it has collected on its
    /// way there.
    #[cold]
    pub fn is_reached(&mut self, guard: usize) -> bool {
        self.expand_signals();
        let now = self.here.now.seconds();
        let [value, rate] = self.ask(guard, |question, expansion| {
            let Question { mode, tape, .. } = question;
            expansion.begin(mode, question.at, Some(question.sizes));
            (0..2).for_each(|order| expansion.expand(mode, tape, order));
            [0, 1].map(|order| expansion.result(tape, guard)[order])
        });
        let error = if value.error.is_finite() {
            value.error
        } else {
            0.0
        };
        value.value <= error + COLLECTED * (rate.value * now).abs()
    }

    /// How high a hop is that begins with the rate u with which the gap of a guard of the present mode closes: u²/2a, where it falls with
    /// the acceleration a; infinite where it does not. With it that acceleration.
    #[cold]
    pub fn bounce(&mut self, guard: usize) -> (f64, f64) {
        self.expand_signals();
        let [rate, half] = self.ask(guard, |question, expansion| {
            let Question { mode, tape, .. } = question;
            expansion.begin(mode, question.at, None);
            (0..3).for_each(|order| expansion.expand(mode, tape, order));
            [1, 2].map(|order| expansion.result(tape, guard)[order].value)
        });
        match half < 0.0 {
            true => (rate * rate / (-4.0 * half), -2.0 * half),
            false => (f64::INFINITY, 0.0),
        }
    }

    /// Whether a guard of the present mode that is a difference, as what is left of friction, is positive, whatever rounding makes of it.
    /// Sets the accelerations.
    pub fn is_clear(&mut self, guard: usize) -> bool {
        let mode = self.mode();
        let of = &mode.guards[guard].kernel;
        with_kernel!(&mode.kernels, k => {
            self.set_accelerations(k).is_ok() && {
                let [q, v, a] = self.here.free(k.size(), &mode.free);
                let at = Free { q: &q, v: &v, a: &a };
                let value = k.guard(&self.context, of, at);
                value > CLEAR * k.guard_magnitude(&self.context, of, at)
            }
        })
    }

    /// Asks something of a guard of the present mode from here: a question about its sign, to be completed.
    fn ask<T>(&mut self, guard: usize, ask: impl FnOnce(Question, &mut Expansion) -> T) -> T {
        let mode = self.mode();
        let question = Question {
            mode,
            tape: &mode.guard_values,
            index: guard,
            at: Point {
                q: &self.here.q,
                v: &self.here.v,
                held: self.context.held(),
                drift: match self.plan.moves[self.here.mode] {
                    true => &self.drift,
                    false => &[],
                },
                discrete: self.context.discrete(),
            },
            sizes: [&self.sizes, &self.rate_sizes],
            within: 0.0,
            vanishing: 0,
            shown: 0,
        };
        ask(question, &mut self.expansion)
    }

    /// The least condition of a transition of a guard. Overwrites `next`.
    #[inline(always)]
    pub fn least_condition<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        transition: &'p Transition,
        at: Free<F>,
    ) -> f64 {
        let mut conditions = Conditions {
            modes: self.modes,
            plan: &self.plan,
            next: &mut self.next,
        };
        conditions.least(kernel, &mut self.context, transition, at)
    }

    /// Whether a transition of a guard may be taken: none of its conditions, of which the least is given, is negative just
    /// after it, in the motion of its target. Overwrites `next`.
    #[inline(always)]
    pub fn may_take<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        transition: &'p Transition,
        (at, least): (Free<F>, f64),
    ) -> bool {
        let holds_just_after = |own: &mut Self| own.holds_just_after(kernel, transition, at);
        least >= 0.0 || (!least.is_nan() && holds_just_after(self))
    }

    /// Whether the conditions of a transition hold just after it although one of them is negative. Overwrites `next`.
    #[cold]
    fn holds_just_after<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        transition: &'p Transition,
        at: Free<F>,
    ) -> bool {
        self.expand_signals();
        kernel.reset(&self.context, &transition.kernel, at, &mut self.next);
        let n = self.here.q.len();
        let (q, rest) = self.next.split_at(n);
        let (v, discrete) = rest.split_at(n);
        let target = &self.modes[transition.target];
        let drift = &mut self.drift_of_target[..n];
        with_kernel!(&target.kernels, k => k.drift(&self.context, drift));
        self.held_by_target.copy_from_slice(self.context.held());
        self.held_by_target[..n].copy_from_slice(q);
        (0..transition.kernel.conditions()).all(|index| {
            let question = Question {
                mode: target,
                tape: &transition.conditions,
                index,
                at: Point {
                    q,
                    v,
                    held: &self.held_by_target,
                    drift: &self.drift_of_target,
                    discrete,
                },
                sizes: [&self.sizes, &self.rate_sizes],
                within: 0.0,
                vanishing: 0,
                shown: 0,
            };
            let departure = question.answer(&mut self.expansion);
            matches!(departure, Departure::Up { .. } | Departure::Stays { .. })
        })
    }

    /// The inputs as they go on from here.
    pub(in crate::hybrid) fn expand_signals(&mut self) {
        let (context, signals) = (&self.context, &*self.signals);
        let t = self.here.now.seconds();
        self.expansion.set_signals(context, signals, t);
    }
}
