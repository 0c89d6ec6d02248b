//! What errors of the motion do to a guard, and how near to zero it comes in a step.

use super::equations::{Equations, free_of};
use super::guards::{Conditions, Linear, motion, watched_value};
use super::locate::{depends_on_accelerations, rate_at};
use super::plan::Watched;
use super::problem::Accuracy;
use super::roots::{Search, minimum};
use super::search::{falls_off, orders_of_guards};
use crate::integrate::{LastStep, Motion, ORDERS, State, System};
use crate::integrate::{Size, Vector};
use crate::kernel::Free;
use crate::model::{Guard, Mode};

/// Parts of a step among which its least value is looked for: a step is a period at most, in which a guard
/// turns twice.
const PARTS: usize = 8;

/// What is watched, with what it is evaluated by.
pub(super) struct WatchedGuard<'e, 'a, 'c, F: Size> {
    pub mode: &'e Mode,
    pub accuracy: &'e Accuracy,
    pub guard: &'e Guard,
    pub watched: Watched,
    pub equations: &'e mut Equations<'a, F>,
    pub conditions: &'e mut Conditions<'c>,
}

impl<F: Size> WatchedGuard<'_, '_, '_, F> {
    /// What is watched, where it is linear.
    fn linear(&self) -> Option<Linear> {
        let linear = Linear::of(self.guard.shape, self.equations.context);
        linear.filter(|_| self.watched.condition.is_none())
    }

    /// The same where nothing is added, which may depend on the time.
    fn multiple(&self) -> Option<Linear> {
        self.linear().filter(|linear| !linear.offset)
    }

    /// Its value in a state at local time `t`.
    pub fn value(&mut self, t: f64, q: &F::Vector, v: &F::Vector) -> f64 {
        if let Some(linear) = self.multiple() {
            let state = if linear.rate { v } else { q };
            return linear.factor * state[linear.index];
        }
        let mut a = q.size().zeros();
        let needs_accelerations = self.watched.condition.is_some()
            || depends_on_accelerations((self.guard, self.watched));
        if !needs_accelerations {
            self.equations.at(t);
        } else if self.equations.acceleration(t, q, v, &mut a).is_err() {
            return f64::NAN;
        }
        let at = Free { q, v, a: &a };
        let (kernel, context) = (self.equations.kernel, &mut *self.equations.context);
        watched_value(
            kernel,
            context,
            self.conditions,
            self.guard,
            self.watched,
            at,
        )
    }

    /// What errors of one tolerance in every coordinate and rate change it by; 0 where it has no value.
    pub fn error(&mut self, t: f64, q: &F::Vector, v: &F::Vector) -> f64 {
        let accuracy = self.accuracy;
        let value = self.value(t, q, v);
        let mut sum = 0.0;
        for (i, &full) in self.mode.free.iter().enumerate() {
            let (mut moved, mut faster) = (q.clone(), v.clone());
            moved[i] += accuracy.q_absolute[full] + accuracy.relative * q[i].abs();
            faster[i] += accuracy.v_absolute[full] + accuracy.relative * v[i].abs();
            sum += (self.value(t, &moved, v) - value).abs();
            sum += (self.value(t, q, &faster) - value).abs();
        }
        // What the mode holds has its errors from the modes before.
        for i in (0..accuracy.q_absolute.len()).filter(|i| !self.mode.free.contains(i)) {
            let held = self.equations.context.held()[i];
            let tolerance = accuracy.q_absolute[i] + accuracy.relative * held.abs();
            self.equations.context.held_mut()[i] = held + tolerance;
            sum += (self.value(t, q, v) - value).abs();
            self.equations.context.held_mut()[i] = held;
        }
        // Not a number: there it has no value.
        sum.max(0.0)
    }

    /// A tolerance of its own terms, which bounds what its error changes by while it comes to zero.
    pub fn tolerance(&self, state: &State<F>) -> f64 {
        if self.watched.condition.is_some() {
            return 0.0;
        }
        let (kernel, context) = (self.equations.kernel, &*self.equations.context);
        let magnitude = kernel.guard_magnitude(context, &self.guard.kernel, free_of(state));
        self.accuracy.relative * magnitude
    }

    /// Its own rounding where the last step is at local time `t`; 0 of a condition.
    pub fn rounding_at(&mut self, t: f64, method: &dyn LastStep<F>) -> f64 {
        if self.multiple().is_some() || self.watched.condition.is_some() {
            return 0.0;
        }
        let [q, v, a] = motion(self.equations, method.motion(), t, true);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let (kernel, context) = (self.equations.kernel, &*self.equations.context);
        kernel.guard_rounding(context, &self.guard.kernel, at)
    }

    /// Place and value of its least value in the last step but where it rises from the start, or from local time `from`
    /// where that is later; `None` if it only rises.
    pub fn least(&mut self, from: f64, method: &mut dyn LastStep<F>) -> Option<(f64, f64)> {
        let end = method.state().clone();
        let (start, dense) = (method.start(), method.motion());
        let rate = |state, own: &mut Self| match own.watched.condition {
            None => rate_at(own.equations, own.guard, state),
            Some(_) => f64::NAN,
        };
        let mut own = self.changes(dense);
        match own.as_ref().and_then(Changes::rises_throughout) {
            Some(true) => return None,
            Some(false) => return Some((end.t, self.value(end.t, &end.q, &end.v))),
            None => {}
        }
        let from = from.max(start.t);
        if from >= end.t {
            return None;
        }
        let place = |k: usize| match k {
            PARTS => end.t,
            k => from + k as f64 / PARTS as f64 * (end.t - from),
        };
        if let Some(own) = &mut own {
            own.coefficients[0] = self.value(start.t, &start.q, &start.v);
        }
        let inside = |watched: &mut Self, t: f64| match &own {
            Some(own) => own.value((t - dense.start()) / dense.length()),
            None => watched.value_within(dense, t),
        };
        let values: [f64; PARTS + 1] = std::array::from_fn(|k| match k {
            // More accurate than the dense output.
            PARTS => self.value(end.t, &end.q, &end.v),
            k => inside(self, place(k)),
        });
        let falls = |&k: &usize| values[k + 1] < values[k];
        // Between the first two places it may turn; at the start its slope tells at once that it falls.
        let first = match from == start.t && rate(start, self) < 0.0 {
            true => 0,
            false => (0..PARTS).find(falls)?,
        };
        let least = (first..=PARTS).min_by(|&i, &j| values[i].total_cmp(&values[j]))?;
        if least == PARTS && rate(&end, self) <= 0.0 {
            return Some((end.t, values[PARTS]));
        }
        let (low, high) = (least.saturating_sub(1), (least + 1).min(PARTS));
        let (t, mut value) = minimum(&mut |t| inside(self, t), (place(low), place(high)));
        if self.linear().is_none() {
            // Its own series, which is as accurate as an acceleration of the dense output, tells the place alone.
            value = self.value_within(dense, t);
        }
        Some(match value < values[PARTS] {
            true => (t, value),
            false => (end.t, values[PARTS]),
        })
    }

    /// How it changes from the start of the last step, in powers of the part of its length: as its coordinate or rate does, or on a step of the
    /// Taylor method by its own series, where that holds for the whole step. `None`: by its values alone.
    fn changes(&mut self, dense: &dyn Motion<F>) -> Option<Changes> {
        let Some(Linear {
            index,
            rate,
            factor,
            ..
        }) = self.linear()
        else {
            return self.own_series(dense);
        };
        let mut coefficients = [0.0; ORDERS];
        let count = dense.coefficients(rate);
        dense.polynomial((index, rate), factor, 1, &mut coefficients[1..count]);
        Some(Changes {
            coefficients,
            count,
        })
    }

    /// The same by its own series.
    fn own_series(&mut self, dense: &dyn Motion<F>) -> Option<Changes> {
        // Conditions have none of their own.
        if self.watched.condition.is_some() || self.watched.conditional {
            return None;
        }
        let (series, orders) = dense.series()?;
        let expanded = orders_of_guards(self.equations, dense, orders);
        (self.equations).expand_guards(dense.start(), expanded, series);
        let mut coefficients = [0.0; ORDERS];
        let own = &mut coefficients[..expanded];
        let (kernel, context) = (self.equations.kernel, &*self.equations.context);
        kernel.guard_coefficients(context, self.watched.guard, own);
        let mut power = 1.0;
        for own in &mut *own {
            *own *= power;
            power *= dense.length();
        }
        let count = own.iter().rposition(|&c| c != 0.0).map_or(1, |k| k + 1);
        falls_off((own, 0), (count, orders), self.equations.tolerance).then_some(Changes {
            coefficients,
            count,
        })
    }

    /// Its value on the dense output at local time `t`.
    pub fn value_within(&mut self, dense: &dyn Motion<F>, t: f64) -> f64 {
        if self.multiple().is_some() {
            let (q, v) = dense.state_at(t);
            return self.value(t, &q, &v);
        }
        let [q, v, _] = motion(self.equations, dense, t, false);
        self.value(t, &q, &v)
    }

    /// What errors of one tolerance change it by where the last step is at local time `t`.
    pub fn error_at(&mut self, t: f64, method: &dyn LastStep<F>) -> f64 {
        let [q, v, _] = motion(self.equations, method.motion(), t, false);
        self.error(t, &q, &v)
    }

    /// Where behind its fall at the end of the last step, which was cut there, it is least up to where the step led
    /// before, local time, and its value.
    pub fn deepest(&mut self, method: &dyn LastStep<F>) -> (f64, f64) {
        let (from, dense) = (method.end(), method.motion());
        let to = dense.start() + dense.length();
        let mut deepest = (from, f64::INFINITY);
        for k in 0..=PARTS {
            let t = from + k as f64 / PARTS as f64 * (to - from);
            let value = self.value_within(dense, t);
            // What is not a number is no depth.
            if value < deepest.1 {
                deepest = (t, value);
            }
        }
        deepest
    }

    /// What it is off by at local time `t` because the dense output is not as accurate as the end of the
    /// step. There its accelerations differ from those that the equations ask for; the difference changes
    /// its sign as often as there are coefficients in them, and makes its rate and its change of a
    /// coordinate in the time between two such places.
    pub fn error_of_dense_output(&mut self, t: f64, method: &dyn LastStep<F>) -> f64 {
        let (start, end, dense) = (method.start().t, method.end(), method.motion());
        let size = self.equations.kernel.size();
        let mut defect = size.zeros();
        for k in 0..PARTS {
            let place = start + (k as f64 + 0.5) / PARTS as f64 * (end - start);
            let (q, v, a) = dense.at(place);
            let mut exact = a.clone();
            if self
                .equations
                .acceleration(place, &q, &v, &mut exact)
                .is_ok()
            {
                for i in 0..size.get() {
                    defect[i] = defect[i].max((exact[i] - a[i]).abs());
                }
            }
        }
        let time = dense.length() / (dense.coefficients(true) - 1) as f64;
        let [q, v, _] = motion(self.equations, dense, t, false);
        let value = self.value(t, &q, &v);
        let mut sum = 0.0;
        for i in 0..size.get() {
            let (mut moved, mut faster) = (q.clone(), v.clone());
            faster[i] += defect[i] * time;
            moved[i] += 0.5 * defect[i] * (time * time);
            sum += (self.value(t, &moved, &v) - value).abs();
            sum += (self.value(t, &q, &faster) - value).abs();
        }
        sum.max(0.0)
    }

    /// The value at which it would turn back after the end of the last step, by its slope and curvature
    /// there, which are more accurate than what the search has `found` on the dense output.
    pub fn would_turn(&mut self, method: &mut dyn LastStep<F>, found: &Search) -> f64 {
        let end = method.state().clone();
        let start = method.start();
        let touches = found.crossing.is_some() && found.turn == 0.0;
        if self.watched.condition.is_some() || touches {
            return found.turn;
        }
        let before = end.t - (end.t - start.t) / PARTS as f64;
        let [q, v, a] = motion(self.equations, method.motion(), before, true);
        let before = State { t: before, q, v, a };
        let [earlier, slope] =
            [&before, &end].map(|state| rate_at(self.equations, self.guard, state));
        let curvature = (slope - earlier) / (end.t - before.t);
        let value = self.value(end.t, &end.q, &end.v);
        match curvature > 0.0 {
            true => value - slope * slope / (2.0 * curvature),
            false => f64::NEG_INFINITY,
        }
    }

    /// Whether its fall would be an event where the last step is at local time `t`: one that acts
    /// together with conditions needs the other part.
    pub fn matters(&mut self, t: f64, method: &dyn LastStep<F>) -> bool {
        if !self.watched.conditional {
            return true;
        }
        let [q, v, a] = motion(self.equations, method.motion(), t, true);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let (kernel, context) = (self.equations.kernel, &mut *self.equations.context);
        if self.watched.condition.is_some() {
            return kernel.guard(context, &self.guard.kernel, at) < 0.0;
        }
        let conditions = &mut *self.conditions;
        let allowed = conditions.plan;
        let mut admissible = self
            .guard
            .transitions
            .iter()
            .filter(|t| allowed.allowed[t.target]);
        admissible.any(|t| conditions.least(kernel, context, t, at) >= 0.0)
    }
}

/// How a guard changes from the start of a step: a polynomial in the part of its length.
struct Changes {
    coefficients: [f64; ORDERS],
    /// Number of those that are not zero.
    count: usize,
}

impl Changes {
    fn value(&self, s: f64) -> f64 {
        let highest_first = self.coefficients[..self.count].iter().rev();
        highest_first.fold(0.0, |sum, c| sum * s + c)
    }

    /// Whether it rises in the whole of the step, or falls: where the first coefficient of its slope outweighs all others. `None`:
    /// it may turn.
    fn rises_throughout(&self) -> Option<bool> {
        let [first, others @ ..] = &self.coefficients[1..self.count] else {
            return None;
        };
        let others: f64 = (others.iter().zip(2_u8..))
            .map(|(c, k)| f64::from(k) * c.abs())
            .sum();
        (first.abs() > others).then_some(*first > 0.0)
    }
}
