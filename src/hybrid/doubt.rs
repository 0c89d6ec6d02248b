//! Where a run cannot tell whether a guard falls through zero. (Which of its transitions is taken then, `choice` asks.)
//!
//! A guard that turns close to zero may have crossed it or not: the errors of the steps decide. What they
//! may amount to is known from the tolerances: the initial state and every step may be off by one
//! tolerance, and errors of either sign add up as the root of their number. On the benchmark problems the
//! true error at the end is a hundredth to a half of that. (Errors that the motion amplifies are larger:
//! `dalembert precision` tells.) What such an error changes the guard by is found by making it.
//!
//! The search for the guard's zero bounds how near to zero it turns, at no cost. Only where this is within
//! the error is the minimum looked for.

use super::crossing::Signs;
use super::equations::Equations;
use super::guards::{Conditions, Linear};
use super::plan::Watched;
use super::problem::{Accuracy, Problem};
use super::roots::{Search, Watch};
use super::sensitivity::WatchedGuard;
use crate::integrate::{LastStep, Motion, OneStep};
use crate::model::name::intern;
use crate::model::{Guard, Mode};
use crate::numerics::Size;
use crate::numerics::{Blank, Memory, Persist, persist};
use crate::run::{Doubt, Question, Uncertain};

/// What was found out about the errors of guards, and the doubts.
#[derive(Debug, Default)]
pub(super) struct Doubts {
    /// Number of steps so far.
    steps: u64,
    /// [`tolerances`] at the next power of two of steps, which is more, so that a step takes no root.
    most_tolerances: f64,
    /// Per mode, what an error of one tolerance changes each watched guard by, and its rounding: as it
    /// was at the first step in the mode. Empty: no step yet.
    errors: Vec<Vec<f64>>,
    /// Per mode and transition of its guards, one guard after the other: the same of the condition with the largest one,
    /// at the first event that asked for it. Infinite before that.
    errors_of_conditions: Vec<Vec<f64>>,
    /// Names of guards that were near zero at the end of the last step; with a doubt if they fell so steeply that
    /// it is one only if they do not fall through zero right after it.
    left: Vec<(&'static str, Option<Doubt>)>,
    /// The doubts.
    pub uncertain: Uncertain,
}

impl Persist for Doubts {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.steps.persist(memory)?;
        self.most_tolerances.persist(memory)?;
        (self.errors.iter_mut()).try_for_each(|errors| memory.list(errors, f64::default))?;
        let mut of_conditions = self.errors_of_conditions.iter_mut();
        of_conditions.try_for_each(|errors| memory.slice(errors))?;
        let named = |(name, doubt): &(&str, Option<Doubt>)| (String::from(*name), doubt.clone());
        let mut left: Vec<(String, Option<Doubt>)> = self.left.iter().map(named).collect();
        memory.list(&mut left, || (String::new(), None))?;
        self.left = (left.into_iter().map(|(name, doubt)| (intern(&name), doubt))).collect();
        self.uncertain.total.persist(memory)?;
        memory.list(&mut self.uncertain.first, Doubt::blank)
    }
}

persist!(Doubt {
    t,
    mode,
    guard,
    what,
    value,
    error,
    unit
});

impl Blank for Doubt {
    fn blank() -> Self {
        Doubt {
            t: 0.0,
            mode: String::new(),
            guard: String::new(),
            what: Question::Graze,
            value: 0.0,
            error: 0.0,
            unit: String::new(),
        }
    }
}

impl Persist for Question {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let all = [
            Question::Graze,
            Question::NearMiss,
            Question::Unresolved,
            Question::Choice,
            Question::Unsettled,
        ];
        memory.one_of(self, &all)
    }
}

/// A step and what was found of the guards in it.
pub(super) struct Searched<'s> {
    /// Index of the mode.
    index: usize,
    mode: &'s Mode,
    watched: &'s [Watched],
    signs: &'s Signs,
    found: &'s [Search],
    accuracy: &'s Accuracy,
}

impl Doubts {
    /// Nothing is known, of a problem with these modes.
    pub fn new(modes: &[Mode]) -> Self {
        let unknown = |mode: &Mode| vec![f64::INFINITY; index_of(mode, mode.guards.len(), 0)];
        Doubts {
            errors: vec![Vec::new(); modes.len()],
            errors_of_conditions: modes.iter().map(unknown).collect(),
            ..Doubts::default()
        }
    }

    /// Forgets what is known of the errors, for other parameters.
    pub fn forget_errors(&mut self) {
        self.errors.iter_mut().for_each(Vec::clear);
        let of_conditions = self.errors_of_conditions.iter_mut();
        of_conditions.for_each(|errors| errors.fill(f64::INFINITY));
    }

    /// Forgets the doubts, for the next run.
    pub fn clear(&mut self) {
        self.steps = 0;
        self.left.clear();
        self.uncertain = Uncertain::default();
    }

    /// Searches a step for doubts, one that was searched, up to its end or its first event.
    #[inline]
    pub fn search_step<'a, F: Size>(
        &mut self,
        step: &Searched,
        method: &mut impl OneStep<F, Equations<'a, F>>,
        equations: &mut Equations<'a, F>,
        conditions: &mut Conditions,
    ) {
        self.count_step();
        let within = self.most_tolerances + method.looseness();
        let errors = &self.errors[step.index];
        let certain =
            |(found, error): (&Search, &f64)| found.resolved && !is_near(found, error * within);
        let nothing_touched = self.left.is_empty() && step.signs.touched().is_empty();
        let known = errors.len() == step.found.len() && nothing_touched;
        if !(known && step.found.iter().zip(errors).all(certain)) {
            self.examine(step, method, equations, conditions);
        }
    }

    #[inline]
    fn count_step(&mut self) {
        self.steps += 1;
        if self.steps.is_power_of_two() {
            self.most_tolerances = tolerances(2 * self.steps);
        }
    }

    #[cold]
    #[inline(never)]
    fn examine<'a, F: Size>(
        &mut self,
        step: &Searched,
        method: &mut dyn LastStep<F>,
        equations: &mut Equations<'a, F>,
        conditions: &mut Conditions,
    ) {
        let tolerances = tolerances(self.steps);
        let within = tolerances + method.looseness();
        if self.errors[step.index].len() != step.found.len() {
            let start = method.start();
            let error = |&watched: &Watched| {
                let mut guard = step.guard(watched, equations, conditions);
                guard.error(start.t, &start.q, &start.v) + guard.tolerance(start)
            };
            self.errors[step.index] = step.watched.iter().map(error).collect();
        }
        for &(i, t) in step.signs.touched() {
            let mut guard = step.guard(step.watched[i], equations, conditions);
            if guard.matters(t, method) {
                let error = guard.error_at(t, method) * tolerances + guard.rounding_at(t, method);
                let value = guard.value_within(method.motion(), t);
                self.uncertain
                    .add(guard.doubt(t, Question::Graze, value, error));
            }
        }
        let left = std::mem::take(&mut self.left);
        for (i, (found, &watched)) in step.found.iter().zip(step.watched).enumerate() {
            if step.mode.guards[watched.guard].is_chart() {
                // In either coordinates the motion is the same.
                continue;
            }
            let mut guard = step.guard(watched, equations, conditions);
            let end = method.state().clone();
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
            // One that starts at zero has risen from it.
            let positive = step.signs.watches[i] != Watch::Violated && found.watch == Watch::Armed;
            let (t, what, value) = match found.crossing {
                Some(_) => (end.t, Question::Graze, guard.would_turn(method, found)),
                None if !positive => continue,
                None => match guard.least(step.signs.positive_until(i), method) {
                    Some((t, value)) => (t, Question::NearMiss, value),
                    None => continue,
                },
            };
            if value.abs() > self.errors[step.index][i] * within {
                continue;
            }
            let inside = t < end.t;
            let error = guard.error_at(t, method) * tolerances
                + guard.rounding_at(t, method)
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
            let turns = !at_end || guard.would_turn(method, found).abs() <= error;
            if at_end {
                let unless_it_falls = (!turns).then(|| doubt.clone());
                self.left.push((guard.guard.name, unless_it_falls));
            }
            // It may turn in the next step, where it was near zero at the end of this one.
            if turns && !left.iter().any(|(other, _)| *other == guard.guard.name) {
                self.uncertain.add(doubt);
            }
        }
        // What fell towards zero at the end of the step before did not come there, unless it does now.
        for (guard, doubt) in left {
            let falls = |(found, watched): (&Search, &Watched)| {
                let other = &step.mode.guards[watched.guard];
                found.crossing.is_some() && other.name == guard
            };
            let again = self.left.iter().any(|(other, _)| *other == guard);
            if let Some(doubt) = doubt
                && !again
                && !step.found.iter().zip(step.watched).any(falls)
            {
                self.uncertain.add(doubt);
            }
        }
    }

    /// The doubt about an event at the end of a step of the explicit method: whether its guard falls, where the step, as it
    /// was before the cut, does not show it to fall by more than the error that one tolerance at the start and one of the
    /// step make, and either never shows it to be positive by more, or outlasts the fastest decay. Such a step is as long
    /// as it is because its last terms are less than the tolerance, as is all that the guard does in it.
    #[inline(always)]
    pub fn about_crossing<'a, F: Size>(
        &mut self,
        (step, outlasts): (&Searched, bool),
        method: &impl OneStep<F, Equations<'a, F>>,
        equations: &mut Equations<'a, F>,
        conditions: &mut Conditions,
    ) -> Option<Doubt> {
        let fallen = step.found.iter().position(|f| f.crossing.is_some())?;
        let watched = step.watched[fallen];
        if step.mode.guards[watched.guard].is_chart() {
            return None;
        }
        let error = self.errors[step.index].get(fallen);
        // What it moves by, or has risen to, is by far more, as it mostly is.
        let enough = 2.0 * tolerances(1) * error.copied().unwrap_or(f64::INFINITY);
        let shape = step.mode.guards[watched.guard].shape;
        if !outlasts
            && watched.condition.is_none()
            && let Some(linear) = Linear::of(shape, equations.context)
        {
            let dense = method.dense().expect("a step was made");
            let [_, moves] = dense.value_and_slope((linear.index, linear.rate), linear.factor);
            if moves.abs() > enough {
                return None;
            }
        }
        Self::about_small_crossing(
            (step, fallen),
            (outlasts, enough),
            method,
            equations,
            conditions,
        )
    }

    /// The same of the guard of an index, where its slope does not tell at once. There is none if it was more than `enough`
    /// at the start of the step, which tells nothing where the step outlasts the fastest decay, or comes to less than −`enough`.
    #[inline(never)]
    fn about_small_crossing<'a, F: Size>(
        (step, fallen): (&Searched, usize),
        (outlasts, enough): (bool, f64),
        method: &dyn LastStep<F>,
        equations: &mut Equations<'a, F>,
        conditions: &mut Conditions,
    ) -> Option<Doubt> {
        let mut guard = step.guard(step.watched[fallen], equations, conditions);
        let start = method.start();
        let risen = guard.value(start.t, &start.q, &start.v);
        if !outlasts && risen > enough {
            return None;
        }
        let dense = method.motion();
        if guard.value_within(dense, dense.start() + dense.length()) < -enough {
            return None;
        }
        let (t, value) = guard.deepest(method);
        let error = tolerances(1) * guard.error_at(t, method) + guard.rounding_at(t, method);
        let is_small = -value <= error && (outlasts || risen <= error);
        is_small.then(|| guard.doubt(t, Question::Graze, value, error))
    }

    /// Whether the least condition of a transition, by the index of its mode, its guard and its own, may be within its
    /// error. The initial state has none.
    #[inline(always)]
    pub fn may_leave_open(
        &self,
        (index, mode): (usize, &Mode),
        (guard, transition): (usize, usize),
        least: f64,
    ) -> bool {
        let error = self.errors_of_conditions[index][index_of(mode, guard, transition)];
        let certain = least.abs() > error * self.most_tolerances;
        self.steps > 0 && !certain
    }

    /// Takes note of what an error of one tolerance changes a transition's conditions by at most.
    pub fn know_conditions(
        &mut self,
        (index, mode): (usize, &Mode),
        (guard, transition): (usize, usize),
        error: f64,
    ) {
        let known = &mut self.errors_of_conditions[index][index_of(mode, guard, transition)];
        if *known == f64::INFINITY {
            *known = error;
        }
    }

    /// Error of every coordinate and rate so far, in units of its tolerance.
    pub fn tolerances(&self) -> f64 {
        tolerances(self.steps)
    }

    /// Takes note of a transition: what its guard fell to has happened.
    #[inline(always)]
    pub fn happened(&mut self, guard: &Guard) {
        if !self.left.is_empty() {
            self.left.retain(|(other, _)| *other != guard.name);
        }
    }
}

/// Index of a transition of a guard among all of a mode.
#[inline(always)]
fn index_of(mode: &Mode, guard: usize, transition: usize) -> usize {
    let before = mode.guards[..guard].iter().map(|g| g.transitions.len());
    before.sum::<usize>() + transition
}

/// Error of every coordinate and rate after so many steps, in units of its tolerance.
fn tolerances(steps: u64) -> f64 {
    1.0 + (steps as f64).sqrt()
}

/// Whether a guard turns, or would have turned, within `error` of zero.
fn is_near(found: &Search, error: f64) -> bool {
    match found.crossing {
        Some(_) => -found.turn <= error,
        None => found.turn <= error,
    }
}

impl<'s> Searched<'s> {
    /// The last step, in a mode with its index, of a problem.
    pub fn of(
        (index, mode): (usize, &'s Mode),
        watched: &'s [Watched],
        signs: &'s Signs,
        problem: &'s Problem,
    ) -> Self {
        Searched {
            index,
            mode,
            watched,
            signs,
            found: signs.found(),
            accuracy: &problem.accuracy,
        }
    }

    fn guard<'e, 'a, 'c, F: Size>(
        &'e self,
        watched: Watched,
        equations: &'e mut Equations<'a, F>,
        conditions: &'e mut Conditions<'c>,
    ) -> WatchedGuard<'e, 'a, 'c, F> {
        WatchedGuard {
            mode: self.mode,
            accuracy: self.accuracy,
            guard: &self.mode.guards[watched.guard],
            watched,
            equations,
            conditions,
        }
    }
}

impl<F: Size> WatchedGuard<'_, '_, '_, F> {
    /// The doubt about it at local time `t`.
    pub fn doubt(&self, t: f64, what: Question, value: f64, error: f64) -> Doubt {
        let (guard, unit) = match self.watched.condition {
            None => (self.guard.name.to_owned(), self.guard.unit.to_owned()),
            Some((transition, _)) => {
                let name = self.guard.transitions[transition].name;
                (format!("condition of {name}"), String::new())
            }
        };
        Doubt {
            t: self.equations.clock.start.plus(t).seconds(),
            mode: self.mode.name.to_owned(),
            guard,
            what,
            value,
            error,
            unit,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_of_the_errors_holds_in_every_step_of_a_run() {
        let mut doubts = Doubts::new(&[]);
        for steps in 1..5000 {
            doubts.count_step();
            assert_eq!(doubts.steps, steps);
            let (own, bound) = (tolerances(steps), doubts.most_tolerances);
            assert!(own <= bound && bound <= 2.0 * own, "{steps}: {own} {bound}");
        }
    }
}
