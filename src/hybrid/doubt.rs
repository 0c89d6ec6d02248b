//! Where a run cannot tell whether a guard falls through zero.
//!
//! A guard that turns close to zero may have crossed it or not: the errors of the steps decide. What they
//! may amount to is known from the tolerances: the initial state and every step may be off by one
//! tolerance, and errors of either sign add up as the root of their number. On the benchmark problems the
//! true error at the end is a hundredth to a half of that. (Errors that the motion amplifies are larger:
//! `dalembert precision` tells.) What such an error changes the guard by is found by making it.
//!
//! The search for the guard's zero bounds how near to zero it turns, at no cost. Only where this is within
//! the error is the minimum looked for.

use super::equations::Equations;
use super::guards::{Conditions, motion, watched_value};
use super::locate::rate_at;
use super::plan::Watched;
use super::problem::Accuracy;
use super::roots::{Search, Watch, minimum};
use crate::integrate::{Motion, ORDERS, OneStep, State, System};
use crate::kernel::Free;
use crate::model::{Guard, Mode};
use crate::record::{Doubt, Question, Uncertain};
use nalgebra::SVector;

/// Parts of a step among which its least value is looked for. Steps resolve the motion, so that a guard
/// turns once or twice in one.
const PARTS: usize = 8;

/// What was found out about the errors of guards, and the doubts.
#[derive(Debug, Default)]
pub(super) struct Doubts {
    /// Number of steps so far.
    steps: u64,
    /// Per mode, what an error of one tolerance changes each watched guard by, and its rounding: as it
    /// was at the first step in the mode. Empty: no step yet.
    errors: Vec<Vec<f64>>,
    /// Guards that were near zero at the end of the last step; with a doubt if they fell so steeply that
    /// it is one only if they do not fall through zero right after it.
    left: Vec<(&'static Guard, Option<Doubt>)>,
    /// The doubts.
    pub uncertain: Uncertain,
}

/// A step and what was found of the guards in it.
pub(super) struct Searched<'s> {
    /// Index of the mode.
    pub index: usize,
    pub mode: &'static Mode,
    pub watched: &'s [Watched],
    /// Signs at the start of the step.
    pub watches: &'s [Watch],
    pub found: &'s [Search],
    pub accuracy: &'s Accuracy,
}

impl Doubts {
    /// Nothing is known, of a problem with so many modes.
    pub fn new(modes: usize) -> Self {
        Doubts {
            errors: vec![Vec::new(); modes],
            ..Doubts::default()
        }
    }

    /// Forgets the doubts, for the next run.
    pub fn clear(&mut self) {
        self.steps = 0;
        self.left.clear();
        self.uncertain = Uncertain::default();
    }

    /// Looks for doubts in a step that was searched, up to its end or its first event.
    #[inline]
    pub fn look<'a, const F: usize>(
        &mut self,
        step: &Searched,
        method: &impl OneStep<F, Equations<'a, F>>,
        equations: &mut Equations<'a, F>,
        conditions: &mut Conditions,
    ) {
        self.steps += 1;
        let within = self.tolerances() + method.looseness();
        let errors = &self.errors[step.index];
        let certain =
            |(found, error): (&Search, &f64)| found.resolved && !is_near(found, error * within);
        let known = errors.len() == step.found.len() && self.left.is_empty();
        if !(known && step.found.iter().zip(errors).all(certain)) {
            self.examine(step, method, equations, conditions);
        }
    }

    #[cold]
    #[inline(never)]
    fn examine<'a, const F: usize>(
        &mut self,
        step: &Searched,
        method: &impl OneStep<F, Equations<'a, F>>,
        equations: &mut Equations<'a, F>,
        conditions: &mut Conditions,
    ) {
        let tolerances = self.tolerances();
        let within = tolerances + method.looseness();
        if self.errors[step.index].len() != step.found.len() {
            let start = method.start();
            let error = |&watched: &Watched| {
                let mut guard = step.guard(watched, equations, conditions);
                guard.error(start.t, &start.q, &start.v) + guard.rounding(start)
            };
            self.errors[step.index] = step.watched.iter().map(error).collect();
        }
        let left = std::mem::take(&mut self.left);
        for (i, (found, &watched)) in step.found.iter().zip(step.watched).enumerate() {
            let mut guard = step.guard(watched, equations, conditions);
            let end = method.state();
            if !found.resolved {
                let value = guard.value(end.t, &end.q, &end.v);
                let error = guard.error(end.t, &end.q, &end.v) * tolerances;
                let doubt = guard.doubt(end.t, Question::Unresolved, value, error);
                self.uncertain.add(doubt);
                continue;
            }
            if !is_near(found, self.errors[step.index][i] * within) {
                continue;
            }
            let armed = step.watches[i] == Watch::Armed && found.watch == Watch::Armed;
            let (t, what, value) = match found.crossing {
                Some(_) => (end.t, Question::Graze, guard.would_turn(method, found.turn)),
                None if !armed => continue,
                None => match guard.least(method) {
                    Some((t, value)) => (t, Question::NearMiss, value),
                    None => continue,
                },
            };
            if value.abs() > self.errors[step.index][i] * within {
                continue;
            }
            let inside = t < end.t;
            let error = guard.error_at(t, method) * tolerances
                + if inside {
                    guard.error_of_dense_output(t, method)
                } else {
                    0.0
                };
            if value.abs() > error || !guard.matters(t, method) {
                continue;
            }
            let doubt = guard.doubt(t, what, value, error);
            let at_end = what == Question::NearMiss && !inside;
            let turns = !at_end || guard.would_turn(method, found.turn).abs() <= error;
            if at_end {
                let unless_it_falls = (!turns).then(|| doubt.clone());
                self.left.push((guard.guard, unless_it_falls));
            }
            // It may turn in the next step, where it was near zero at the end of this one.
            if turns && !left.iter().any(|(other, _)| other.name == guard.guard.name) {
                self.uncertain.add(doubt);
            }
        }
        // What fell towards zero at the end of the step before did not come there, unless it does now.
        for (guard, doubt) in left {
            let falls = |(found, watched): (&Search, &Watched)| {
                let other = &step.mode.guards[watched.guard];
                found.crossing.is_some() && other.name == guard.name
            };
            let again = self.left.iter().any(|(other, _)| other.name == guard.name);
            if let Some(doubt) = doubt
                && !again
                && !step.found.iter().zip(step.watched).any(falls)
            {
                self.uncertain.add(doubt);
            }
        }
    }

    /// Error of every coordinate and rate, in units of its tolerance.
    fn tolerances(&self) -> f64 {
        1.0 + (self.steps as f64).sqrt()
    }

    /// Takes note of a transition: what its guard fell to has happened.
    pub fn happened(&mut self, guard: &'static Guard) {
        self.left.retain(|(other, _)| other.name != guard.name);
    }
}

/// Whether a guard turns, or would have turned, within `error` of zero.
fn is_near(found: &Search, error: f64) -> bool {
    match found.crossing {
        Some(_) => -found.turn <= error,
        None => found.turn <= error,
    }
}

impl Searched<'_> {
    fn guard<'e, 'a, 'c, const F: usize>(
        &'e self,
        watched: Watched,
        equations: &'e mut Equations<'a, F>,
        conditions: &'e mut Conditions<'c>,
    ) -> WatchedGuard<'e, 'a, 'c, F> {
        WatchedGuard {
            step: self,
            guard: &self.mode.guards[watched.guard],
            watched,
            equations,
            conditions,
        }
    }
}

fn dense_of<'m, 'a, const F: usize, M: OneStep<F, Equations<'a, F>>>(
    method: &'m M,
) -> &'m M::Motion {
    method.dense().expect("a step was made")
}

/// What is watched, with what it is evaluated by.
struct WatchedGuard<'e, 'a, 'c, const F: usize> {
    step: &'e Searched<'e>,
    guard: &'static Guard,
    watched: Watched,
    equations: &'e mut Equations<'a, F>,
    conditions: &'e mut Conditions<'c>,
}

impl<'a, const F: usize> WatchedGuard<'_, 'a, '_, F> {
    /// Its value in a state at local time `t`.
    fn value(&mut self, t: f64, q: &SVector<f64, F>, v: &SVector<f64, F>) -> f64 {
        let mut a = SVector::zeros();
        if self.equations.acceleration(t, q, v, &mut a).is_err() {
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
    fn error(&mut self, t: f64, q: &SVector<f64, F>, v: &SVector<f64, F>) -> f64 {
        let accuracy = self.step.accuracy;
        let value = self.value(t, q, v);
        let mut sum = 0.0;
        for (i, &full) in self.step.mode.free.iter().enumerate() {
            let (mut moved, mut faster) = (*q, *v);
            moved[i] += accuracy.q_absolute[full] + accuracy.relative * q[i].abs();
            faster[i] += accuracy.v_absolute[full] + accuracy.relative * v[i].abs();
            sum += (self.value(t, &moved, v) - value).abs();
            sum += (self.value(t, q, &faster) - value).abs();
        }
        // What the mode holds has its errors from the modes before.
        for i in (0..accuracy.q_absolute.len()).filter(|i| !self.step.mode.free.contains(i)) {
            let held = self.equations.context.held[i];
            let tolerance = accuracy.q_absolute[i] + accuracy.relative * held.abs();
            self.equations.context.held[i] = held + tolerance;
            sum += (self.value(t, q, v) - value).abs();
            self.equations.context.held[i] = held;
        }
        // Not a number: there it has no value.
        sum.max(0.0)
    }

    /// A tolerance of its own terms, which bounds what its error changes by while it comes to zero.
    fn rounding(&self, state: &State<F>) -> f64 {
        if self.watched.condition.is_some() {
            return 0.0;
        }
        let at = Free {
            q: &state.q,
            v: &state.v,
            a: &state.a,
        };
        let (kernel, context) = (self.equations.kernel, &*self.equations.context);
        let magnitude = kernel.guard_magnitude(context, &self.guard.kernel, at);
        self.step.accuracy.relative * magnitude
    }

    /// Place and value of its least value in the last step; `None` if that is at the start.
    fn least(&mut self, method: &impl OneStep<F, Equations<'a, F>>) -> Option<(f64, f64)> {
        let (start, end, dense) = (method.start(), method.state(), dense_of(method));
        if self.watched.condition.is_none() {
            if rate_at(self.equations, self.guard, end) <= 0.0 {
                return Some((end.t, self.value(end.t, &end.q, &end.v)));
            }
            if rate_at(self.equations, self.guard, start) >= 0.0 {
                return None;
            }
        }
        let mut own = |t: f64| {
            let [q, v, _] = motion(self.equations, dense, t, false);
            self.value(t, &q, &v)
        };
        let length = end.t - start.t;
        let place = |k: usize| match k {
            PARTS => end.t,
            k => start.t + k as f64 / PARTS as f64 * length,
        };
        let values: [f64; PARTS + 1] = std::array::from_fn(|k| own(place(k)));
        let least = (0..=PARTS).min_by(|&i, &j| values[i].total_cmp(&values[j]))?;
        let (low, high) = (least.saturating_sub(1), (least + 1).min(PARTS));
        let (t, value) = minimum(&mut own, (place(low), place(high)));
        match value < values[0] {
            true if value < values[PARTS] => Some((t, value)),
            true => Some((end.t, values[PARTS])),
            false => None,
        }
    }

    /// The same where the last step is at local time `t`.
    fn error_at(&mut self, t: f64, method: &impl OneStep<F, Equations<'a, F>>) -> f64 {
        let [q, v, _] = motion(self.equations, dense_of(method), t, false);
        self.error(t, &q, &v)
    }

    /// What it is off by at local time `t` because the dense output is not as accurate as the end of the
    /// step. There its accelerations differ from those that the equations ask for; the difference changes
    /// its sign as often as there are coefficients in them, and makes its rate and its change of a
    /// coordinate in the time between two such places.
    fn error_of_dense_output(&mut self, t: f64, method: &impl OneStep<F, Equations<'a, F>>) -> f64 {
        let (start, end, dense) = (method.start().t, method.state().t, dense_of(method));
        let mut defect = SVector::<f64, F>::zeros();
        for k in 0..PARTS {
            let place = start + (k as f64 + 0.5) / PARTS as f64 * (end - start);
            let (q, v, a) = dense.at(place);
            let mut exact = a;
            if self
                .equations
                .acceleration(place, &q, &v, &mut exact)
                .is_ok()
            {
                defect = defect.zip_map(&(exact - a), |most, part| most.max(part.abs()));
            }
        }
        let mut coefficients = [0.0; ORDERS];
        let in_rate = (0..F).map(|i| dense.polynomial(i, true, &mut coefficients));
        let time = dense.length() / (in_rate.max().unwrap_or(2) - 1) as f64;
        let [q, v, _] = motion(self.equations, dense, t, false);
        let value = self.value(t, &q, &v);
        let mut sum = 0.0;
        for i in 0..F {
            let (mut moved, mut faster) = (q, v);
            faster[i] += defect[i] * time;
            moved[i] += 0.5 * defect[i] * (time * time);
            sum += (self.value(t, &moved, &v) - value).abs();
            sum += (self.value(t, &q, &faster) - value).abs();
        }
        sum.max(0.0)
    }

    /// The value at which it would turn back after the end of the last step, by its slope and curvature
    /// there, which are more accurate than what the search has `found` on the dense output.
    fn would_turn(&mut self, method: &impl OneStep<F, Equations<'a, F>>, found: f64) -> f64 {
        let (start, end) = (method.start(), method.state());
        if self.watched.condition.is_some() || found == 0.0 {
            return found;
        }
        let before = end.t - (end.t - start.t) / PARTS as f64;
        let [q, v, a] = motion(self.equations, dense_of(method), before, true);
        let before = State { t: before, q, v, a };
        let [earlier, slope] =
            [&before, end].map(|state| rate_at(self.equations, self.guard, state));
        let curvature = (slope - earlier) / (end.t - before.t);
        let value = self.value(end.t, &end.q, &end.v);
        match curvature > 0.0 {
            true => value - slope * slope / (2.0 * curvature),
            false => f64::NEG_INFINITY,
        }
    }

    /// The doubt about it at local time `t`.
    fn doubt(&self, t: f64, what: Question, value: f64, error: f64) -> Doubt {
        let (guard, unit) = match self.watched.condition {
            None => (self.guard.name.to_owned(), self.guard.unit.to_owned()),
            Some((transition, _)) => {
                let name = self.guard.transitions[transition].name;
                (format!("condition of {name}"), String::new())
            }
        };
        Doubt {
            t: self.equations.clock.start.plus(t).seconds(),
            mode: self.step.mode.name.to_owned(),
            guard,
            what,
            value,
            error,
            unit,
        }
    }

    /// Whether its fall would be an event where the last step is at local time `t`: one that acts
    /// together with conditions needs the other part.
    fn matters(&mut self, t: f64, method: &impl OneStep<F, Equations<'a, F>>) -> bool {
        if !self.conditions.are_part_of(self.guard) {
            return true;
        }
        let [q, v, a] = motion(self.equations, dense_of(method), t, true);
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
