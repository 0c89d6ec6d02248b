//! A problem in, a [`Run`] out.

use super::failure::Reason;
use super::observe::{Observer, Observers};
use super::problem::Problem;
use super::result::{Failure, Run};
use super::simulation::Simulation;
use crate::kernel::with_kernel;
use crate::run::{HybridState, Progress, Subject};
use std::time::Instant as WallClock;

/// Simulates a problem to its end, or until something stops it; the run then says why.
///
/// # Errors
/// [`Reason`] if the problem cannot even be started: its initial state fits no mode, or the scene
/// froze what every mode needs.
pub fn simulate(problem: &Problem, progress: &mut dyn Progress) -> Result<Run, Reason> {
    simulate_and_tell(problem, None, progress)
}

/// The same; rows and transitions go to an observer as they come, and the run holds none of them.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_with(
    problem: &Problem,
    observer: &mut dyn Observer,
    progress: &mut dyn Progress,
) -> Result<Run, Reason> {
    simulate_and_tell(problem, Some(observer), progress)
}

fn simulate_and_tell<'p>(
    problem: &'p Problem,
    observer: Option<&'p mut dyn Observer>,
    progress: &mut dyn Progress,
) -> Result<Run, Reason> {
    let clock = WallClock::now();
    let mut simulation = Simulation::observed(problem, observer)?;
    simulation.begin()?;
    let outcome = simulation.run(progress);
    let subject = subject(problem);
    Ok(simulation.finish(outcome.err(), subject, clock))
}

/// One of many runs: as [`simulate_with`], without the names and digests that say what was simulated, which of a short run
/// cost more than its motion.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_member(
    problem: &Problem,
    observer: &mut dyn Observer,
    progress: &mut dyn Progress,
) -> Result<Run, Reason> {
    let clock = WallClock::now();
    let mut simulation = Simulation::observed(problem, Some(observer))?;
    simulation.begin()?;
    let outcome = simulation.run(progress);
    Ok(simulation.finish(outcome.err(), Subject::default(), clock))
}

/// What a problem is, by names and digests.
pub(super) fn subject(problem: &Problem) -> Subject {
    Subject {
        model: problem.model.name.into(),
        title: problem.title.clone().unwrap_or_default(),
        choices: (problem.model.choices.iter().zip(&problem.variant().options))
            .map(|(choice, option)| (choice.name.into(), (*option).into()))
            .collect(),
        parameters: (problem.model.parameters.iter().zip(&problem.parameters))
            .map(|(p, &value)| (p.name.into(), value))
            .collect(),
        digests: super::resume::digests(problem),
        projected: Vec::new(),
    }
}

impl Simulation<'_> {
    /// Names the methods in the account of the work, after those of the run that was resumed.
    fn name_methods(&mut self) {
        let mut named = std::mem::take(&mut self.solver.method);
        for (name, order) in &self.methods {
            let method = format!("{name}, order {order}");
            if !named.split("; ").any(|known| known == method) {
                let separator = if named.is_empty() { "" } else { "; " };
                named = format!("{named}{separator}{method}");
            }
        }
        self.solver.method = named;
    }

    /// By how much a projection, or the search for rest, has changed the initial state.
    fn projected(&self) -> Vec<(String, f64)> {
        let moves = self.problem.project || self.problem.at_rest;
        let (Some(begun), true) = (&self.begun, moves) else {
            return Vec::new();
        };
        let (layout, n) = (&self.observers.layout, self.here.q.len());
        let (q, v) = (&self.initial.q, &self.initial.v);
        let places = layout.coordinates.iter().zip(begun.iter().zip(q));
        let rates = layout.velocities.iter().zip(begun[n..].iter().zip(v));
        places
            .chain(rates)
            .map(|(quantity, (now, then))| (quantity.name.clone(), now - then))
            .filter(|(_, change)| *change != 0.0)
            .collect()
    }

    fn place(&mut self) -> HybridState {
        HybridState {
            t: self.here.now.seconds(),
            j: self.here.j,
            mode: self.here.shown,
            state: self.snapshot(),
        }
    }

    /// Everything that was recorded, as far as it came.
    pub fn finish(mut self, reason: Option<Reason>, mut subject: Subject, clock: WallClock) -> Run {
        subject.projected = self.projected();
        self.set_context();
        let last = self.observers.recording.last_row();
        if self.observers.recording.sees_rows && last.is_none_or(|t| t < self.here.now.seconds()) {
            // It is the last one in any case.
            let _ = self.sample_here();
        }
        if reason.is_some() {
            // A mode that goes on after an event has none before its first step; where the equations have none,
            // those before stay.
            let mode = self.mode();
            let _ = with_kernel!(&mode.kernels, k => self.set_accelerations(k));
        }
        let problem = self.problem;
        let end = self.place();
        if self.observers.watch_steps() {
            let stored = self.stored_energy();
            self.observers.jump(&self.here, [&[], &[]], Some(stored));
        }
        let energy = self
            .observers
            .ledger
            .as_ref()
            .map(|l| l.close(self.stored_energy()));
        self.name_methods();
        let wall = clock.elapsed();
        let peaks = self.observers.peaks();
        let Observers {
            layout, recording, ..
        } = self.observers;
        let (trajectory, events, tally) = recording.finish(&layout);
        Run {
            subject,
            peaks,
            layout,
            trajectory,
            events,
            tally,
            failure: reason.map(|reason| Failure {
                reason,
                at: end.clone(),
            }),
            end,
            solver: self.solver,
            energy,
            error: None,
            uncertain: self.doubts.uncertain,
            reached: {
                let mut reached = self.margins.reached();
                reached.validity.splice(..0, problem.invalid_parameters());
                reached
            },
            wall,
        }
    }
}
