//! `ivp` restarted in place: its one-step methods with a hook after each step, which finds the events on
//! their dense output and changes time and state. The step length is kept over an event.

use crate::Run;
use crate::ivp_rows::System;
use ivp::dense::StepInterpolant;
use ivp::matrix::MatrixStorage;
use ivp::methods::{DOP853, DOPRI5, RADAU, Tolerance};
use ivp::solout::{ControlFlag, SolOut};

/// Rows of the methods that suit the problem.
pub fn rows(system: &System, tolerance: f64, stiff: bool) {
    macro_rules! row {
        ($name:literal, $builder:expr) => {
            let solver = $builder.max_steps(Run::MOST_STEPS).build();
            let absolute = system.problem.absolute(tolerance);
            crate::measure("ivp", $name, system.problem, tolerance, |run| {
                let mut hook = Hook::new(system, tolerance, run);
                while hook.goes_on() {
                    let y = hook.y.clone();
                    let (relative, absolute) = (
                        Tolerance::from(tolerance),
                        Tolerance::from(absolute.clone()),
                    );
                    let (from, end) = (hook.run.time, system.problem.end());
                    match solver.solve(system, from, &y, end, relative, absolute, Some(&mut hook)) {
                        Ok(outcome) if outcome.status.is_success() => {
                            hook.run.steps += outcome.steps.accepted
                        }
                        _ => hook.run.status = -1,
                    }
                }
                hook.run.y = hook.y;
            });
        };
    }
    let radau = RADAU::builder().mass_storage(MatrixStorage::Identity);
    row!("Radau in place", radau);
    if !stiff {
        row!("DOP853 in place", DOP853::builder());
        row!("DOPRI5 in place", DOPRI5::builder());
    }
}

struct Hook<'a> {
    system: &'a System<'a>,
    run: &'a mut Run,
    /// Present state.
    y: Vec<f64>,
    ended: bool,
    /// Of the guards at the start of a step, at its end, and at a trial time.
    at_start: Vec<f64>,
    at_end: Vec<f64>,
    values: Vec<f64>,
}

impl<'a> Hook<'a> {
    fn new(system: &'a System<'a>, tolerance: f64, run: &'a mut Run) -> Self {
        let problem = system.problem;
        let mut y = vec![0.0; problem.states()];
        problem.start(&mut y, tolerance);
        let guards = vec![0.0; problem.guards()];
        Hook {
            system,
            run,
            y,
            ended: false,
            at_start: guards.clone(),
            at_end: guards.clone(),
            values: guards,
        }
    }

    /// An event in the last step before the end leaves a solver behind that has finished.
    fn goes_on(&mut self) -> bool {
        !self.ended && self.run.time < self.system.problem.end() && !self.run.runaway()
    }

    /// A guard at a time of the step; the state there stays in `y`.
    fn value(&mut self, guard: usize, t: f64, step: &StepInterpolant) -> f64 {
        step.interpolate(t, &mut self.y);
        self.system.problem.values(t, &self.y, &mut self.values);
        self.values[guard]
    }

    /// Where a guard falls in a step: the first number at which it is not positive.
    fn fall(&mut self, guard: usize, from: f64, to: f64, step: &StepInterpolant) -> Option<f64> {
        let (mut left, mut at_left) = (from, self.at_start[guard]);
        let (mut right, mut at_right) = (to, self.at_end[guard]);
        if at_right >= 0.0 || at_left < 0.0 {
            return None;
        }
        // A guard that starts at zero rises first: at some fraction of the step, unless rounding hides it.
        let mut length = to - from;
        while at_left <= 0.0 {
            length /= 2.0;
            left = from + length;
            if left == from {
                return None;
            }
            at_left = self.value(guard, left, step);
        }
        // Bisection and secants in turn.
        for bisects in [false, true].into_iter().cycle() {
            let middle = left + (right - left) / 2.0;
            let secant = left + (right - left) * (at_left / (at_left - at_right));
            let inside = |t: f64| t > left && t < right;
            let t = if bisects || !inside(secant) {
                middle
            } else {
                secant
            };
            if !inside(t) {
                break;
            }
            let here = self.value(guard, t, step);
            let (end, at) = match here > 0.0 {
                true => (&mut left, &mut at_left),
                false => (&mut right, &mut at_right),
            };
            (*end, *at) = (t, here);
        }
        Some(right)
    }
}

impl SolOut for Hook<'_> {
    fn solout(
        &mut self,
        from: f64,
        to: &mut f64,
        y: &mut [f64],
        step: Option<&StepInterpolant<'_>>,
    ) -> ControlFlag {
        let problem = self.system.problem;
        problem.values(*to, y, &mut self.at_end);
        let mut first: Option<(f64, usize)> = None;
        if let Some(step) = step.filter(|_| *to > from) {
            for guard in 0..problem.guards() {
                let t = self.fall(guard, from, *to, step);
                first = t
                    .map(|t| (t, guard))
                    .into_iter()
                    .chain(first)
                    .reduce(|a, b| if b.0 < a.0 { b } else { a });
            }
            if let Some((t, guard)) = first {
                step.interpolate(t, y);
                self.run.events.push(t);
                self.ended = problem.event(t, y, guard);
                *to = t;
                problem.values(t, y, &mut self.at_end);
            }
        }
        std::mem::swap(&mut self.at_start, &mut self.at_end);
        self.y.copy_from_slice(y);
        self.run.time = *to;
        match first {
            _ if self.ended || self.run.runaway() => ControlFlag::Interrupt,
            Some(_) => ControlFlag::ModifiedSolution,
            None => ControlFlag::Continue,
        }
    }
}
