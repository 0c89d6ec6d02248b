//! Going on with a run that was interrupted or has ended.

use super::failure::Reason;
use super::instant::Instant;
use super::observe::{Samples, sample_time};
use super::problem::Problem;
use super::simulation::Simulation;
use crate::record::digest::digest;
use crate::record::{Event, Progress, Recorder, Run};
use std::time::Instant as WallClock;

/// Continues a run from its end to the end of the problem, and gives the whole: tables, counters
/// and ledger go on where they were.
///
/// The integrator starts anew at the last state, in the mode the run was in; so the result is that
/// of an uninterrupted run up to the accuracy, not to the last bit. Two things are not remembered:
/// the intervals of an accumulation that had begun, which is recognised again from those that
/// follow, and the digits of t beyond a double.
///
/// # Errors
/// [`Reason::OtherRun`] if the run is not one of this problem.
pub fn resume(problem: &Problem, run: Run, progress: &mut dyn Progress) -> Result<Run, Reason> {
    let clock = WallClock::now();
    check(problem, &run)?;
    let wall = run.wall;
    let mut simulation = Simulation::new(problem)?;
    simulation.restore(run);
    let outcome = simulation.run(progress);
    let mut run = simulation.finish(outcome.err(), clock);
    run.wall += wall;
    Ok(run)
}

/// Model, choices and columns are those of the problem, or the run could not have been read.
fn check(problem: &Problem, run: &Run) -> Result<(), Reason> {
    let now = problem.model.parameters.iter().zip(&problem.parameters);
    for ((parameter, &now), (_, then)) in now.zip(&run.subject.parameters) {
        if now.to_bits() != then.to_bits() {
            let name = parameter.name;
            let why = format!("`{name}` is {now} now and was {then}");
            return Err(Reason::OtherRun { why });
        }
    }
    let now = digests(problem);
    for (part, digest) in &now {
        let then = run.subject.digests.iter().find(|(name, _)| name == part);
        if then.is_none_or(|(_, then)| then != digest) {
            let why = match part.as_str() {
                "model" => "the model, or what makes code of it, was changed since".into(),
                part => format!("`{part}` is not what it was"),
            };
            return Err(Reason::OtherRun { why });
        }
    }
    // The last row may be off the grid: it is where the run ended.
    let rows = run.trajectory.t.iter().enumerate();
    let grid = rows.take(run.trajectory.len().saturating_sub(1));
    let every = problem.record.every;
    for (i, &t) in grid.filter(|_| every.is_some()) {
        let now = sample_time(every, i as u64);
        if t != now {
            let why = format!(
                "row {} of the trajectory would be at {now} s and is at {t} s",
                i + 1
            );
            return Err(Reason::OtherRun { why });
        }
    }
    Ok(())
}

/// Digests of the model and of what a run is simulated with, but for its end and what is recorded: as (part, digest),
/// by the keys of a scene.
pub(super) fn digests(problem: &Problem) -> Vec<(String, String)> {
    // Numbers are printed with all their digits.
    let text = |part: &dyn std::fmt::Debug| digest(format!("{part:?}"));
    let parts = [
        ("accuracy", text(&problem.accuracy)),
        ("freeze", text(&problem.freeze)),
        ("initial", text(&problem.initial)),
        ("inputs", text(&problem.signals)),
        ("method", text(&problem.method)),
        ("model", problem.model.digest.to_owned()),
    ];
    parts.map(|(part, digest)| (part.to_owned(), digest)).into()
}

impl Simulation<'_> {
    /// Goes to the end of a run, and takes over what it has recorded.
    fn restore(&mut self, run: Run) {
        let Run {
            mut trajectory,
            events,
            end,
            solver,
            energy,
            peaks,
            uncertain,
            reached,
            ..
        } = run;
        self.margins.go_on(&reached);
        self.here.now = Instant::new(end.t);
        self.here.j = end.j;
        self.here.mode = end.mode;
        self.here.q.copy_from_slice(&end.state.q);
        self.here.v.copy_from_slice(&end.state.v);
        self.context
            .discrete_mut()
            .copy_from_slice(&end.state.discrete);
        self.observers.go_on(energy.as_ref(), &peaks);
        self.doubts.go_on(solver.steps, uncertain);
        self.solver = solver;
        if let Some((name, _)) = self.problem.end.after {
            self.counted = events.iter().filter(|e| e.transition == name).count() as u64;
        }
        self.jumps = events.iter().map(Event::jump).collect();
        if self.problem.record.event_states {
            let states = events.into_iter().map(|e| [e.before, e.after]);
            self.states_at_jumps = states.collect();
        }
        let every = self.problem.record.every;
        let is_on_grid = |i: usize, t: f64| every.is_none() || t == sample_time(every, i as u64);
        if let Some(last) = trajectory.len().checked_sub(1)
            && !is_on_grid(last, trajectory.t[last])
        {
            trajectory.truncate(last);
        }
        self.observers.samples = Samples::from(every, trajectory.len() as u64);
        let to_come = every.map_or(0, |every| {
            Recorder::grid_rows(self.problem.end.time - end.t, every)
        });
        self.observers.recorder = Recorder::continuing(trajectory, to_come);
    }
}
