//! Where the tolerances leave it open which transition of a guard is taken.
//!
//! Conditions decide about that where the guard has fallen. One that is no farther from zero than its error may hold or
//! not: what errors of the motion make of it is found by making them (`sensitivity`), as of a guard (`doubt`).

use super::doubt::Doubts;
use super::equations::{Clock, Equations, Piece};
use super::guards::Conditions;
use super::plan::Watched;
use super::sensitivity::WatchedGuard;
use super::simulation::Simulation;
use crate::integrate::Size;
use crate::kernel::ModeKernel;
use crate::run::{Doubt, Question};

impl<'p> Simulation<'p> {
    /// Adds a doubt if errors of the state may lead to another transition of a guard than was chosen, or to none; the
    /// context is set for the state. Overwrites `next`.
    #[cold]
    #[inline(never)]
    pub fn doubt_choice<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        guard: usize,
        chosen: Option<usize>,
    ) {
        let (index, mode) = (self.here.mode, self.mode());
        let [q, v, _] = self.here.free(kernel.size(), &mode.free);
        let scale = self.scale(kernel.size());
        let clock = Clock {
            start: self.here.now,
            signals: &self.signals,
            // As just after the event.
            until: (f64::INFINITY, f64::INFINITY),
            commanded: f64::INFINITY,
            held: &[],
            drift: &[],
        };
        let (accuracy, piece) = (&self.problem.accuracy, Piece::UNKNOWN);
        let context = &mut self.context;
        let mut equations = Equations::new(
            kernel,
            context,
            clock,
            accuracy.relative,
            scale,
            self.foresees,
            piece,
        );
        let mut conditions = Conditions {
            modes: self.modes,
            plan: &self.plan,
            next: &mut self.next,
        };
        let watched = self.plan.watched[index].iter();
        let conditional = { watched }.any(|w| w.guard == guard && w.conditional);
        let mut asked = WatchedGuard {
            mode,
            accuracy,
            guard: &mode.guards[guard],
            watched: Watched {
                guard,
                condition: None,
                conditional,
            },
            equations: &mut equations,
            conditions: &mut conditions,
        };
        let doubts: &mut Doubts = &mut self.doubts;
        let tolerances = doubts.tolerances();
        if conditional {
            // Where it is not the guard itself that falls, a condition is zero because that is the event.
            let error = tolerances * asked.error(0.0, &q, &v);
            if asked.value(0.0, &q, &v).abs() > error {
                return;
            }
        }
        let transitions = mode.guards[guard].transitions.iter().enumerate();
        let looked_at = transitions.take(chosen.map_or(usize::MAX, |t| t + 1));
        let mut found: Option<Doubt> = None;
        for (t, transition) in looked_at.filter(|(_, t)| self.plan.allowed[t.target]) {
            let mut most = 0.0;
            let mut open: Option<Doubt> = None;
            let mut fails = false;
            for component in 0..transition.kernel.conditions() {
                asked.watched.condition = Some((t, component));
                let value = -asked.value(0.0, &q, &v);
                let one = asked.error(0.0, &q, &v);
                most = f64::max(most, one);
                let error = tolerances * one;
                if one > 0.0 && value.abs() <= error {
                    open = Some(asked.doubt(0.0, Question::Choice, value, error));
                } else if value < 0.0 {
                    fails = true;
                }
            }
            doubts.know_conditions((index, mode), (guard, t), most);
            // One that certainly fails keeps the transition from being taken, whatever the others do.
            found = found.or(open.filter(|_| !fails));
        }
        if let Some(doubt) = found {
            doubts.uncertain.add(doubt);
        }
    }
}
