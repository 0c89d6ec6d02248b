//! Going on with a run that was interrupted or has ended.

use super::failure::Reason;
use super::instant::Instant;
use super::observe::{Collected, Observer, sample_time};
use super::outputs::OwnOutput;
use super::problem::{Collisions, Method, Problem};
use super::simulation::Simulation;
use crate::run::digest;
use crate::run::{Event, Progress, Recorder, Run};
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
    check_rows(problem, &run)?;
    go_on(problem, run, None, progress)
}

/// The same; rows and transitions go to an observer as they come. It was told of those of the earlier run already
/// ([`Replay`]), of which `run` holds none.
///
/// # Errors
/// As [`resume`].
pub fn resume_with(
    problem: &Problem,
    run: Run,
    replayed: Replay,
    observer: &mut dyn Observer,
    progress: &mut dyn Progress,
) -> Result<Run, Reason> {
    go_on(problem, run, Some((replayed, observer)), progress)
}

fn go_on<'p>(
    problem: &'p Problem,
    run: Run,
    told: Option<(Replay, &'p mut dyn Observer)>,
    progress: &mut dyn Progress,
) -> Result<Run, Reason> {
    let clock = WallClock::now();
    check_same(problem, &run)?;
    let wall = run.wall;
    let projected = run.subject.projected.clone();
    let (replayed, observer) = match told {
        Some((replayed, observer)) => (Some(replayed), Some(observer)),
        None => (None, None),
    };
    let mut simulation = Simulation::observed(problem, observer)?;
    simulation.restore(run, replayed)?;
    let outcome = simulation.run(progress);
    let subject = super::simulate::subject(problem);
    let mut run = simulation.finish(outcome.err(), subject, clock);
    run.subject.projected = projected;
    run.wall += wall;
    Ok(run)
}

/// Hands the rows of an earlier run to an observer, all but a last one that is off the grid of the samples: it is where
/// that run has ended, and not this one.
#[derive(Debug)]
pub struct Replay {
    every: Option<f64>,
    /// How many were handed on.
    rows: u64,
    last: Option<f64>,
    /// The next one, with its mode.
    held: Option<(f64, usize)>,
    values: Vec<f64>,
}

impl Replay {
    /// Nothing yet of a run of this problem.
    pub fn new(problem: &Problem) -> Self {
        Replay {
            every: problem.record.every,
            rows: 0,
            last: None,
            held: None,
            values: Vec::new(),
        }
    }

    /// Takes a row: time, mode, values.
    ///
    /// # Errors
    /// [`Reason::OtherRun`] if the one before is not on the grid.
    pub fn row(
        &mut self,
        (t, mode, values): (f64, usize, &[f64]),
        observer: &mut dyn Observer,
    ) -> Result<(), Reason> {
        if let Some((before, _)) = self.held {
            check_row(self.every, self.rows, before)?;
            self.hand_on(observer);
        }
        self.held = Some((t, mode));
        self.values.clear();
        self.values.extend_from_slice(values);
        Ok(())
    }

    /// There are no more.
    pub fn end(&mut self, observer: &mut dyn Observer) {
        let on_grid = |(t, _): &(f64, usize)| is_on_grid(self.every, self.rows, *t);
        if self.held.as_ref().is_some_and(on_grid) {
            self.hand_on(observer);
        }
    }

    fn hand_on(&mut self, observer: &mut dyn Observer) {
        if let Some((t, mode)) = self.held.take() {
            // Nothing is simulated yet that could end here.
            let _ = observer.row(t, mode, &self.values);
            self.rows += 1;
            self.last = Some(t);
        }
    }
}

fn is_on_grid(every: Option<f64>, row: u64, t: f64) -> bool {
    every.is_none() || t == sample_time(every, row)
}

/// A row, counted from 0, must be where the grid of the samples has it.
fn check_row(every: Option<f64>, row: u64, t: f64) -> Result<(), Reason> {
    if is_on_grid(every, row, t) {
        return Ok(());
    }
    let (now, row) = (sample_time(every, row), row + 1);
    let why = format!("row {row} of the trajectory would be at {now} s and is at {t} s");
    let path = "record.every".into();
    Err(Reason::OtherRun { path, why })
}

/// Compares what a run was simulated with with a problem: parameters, inputs, initial state, accuracy, method, and the
/// model itself. (Model, choices and columns are the same, or it could not have been read.)
///
/// # Errors
/// [`Reason::OtherRun`] with the first that differs.
pub fn check_same(problem: &Problem, run: &Run) -> Result<(), Reason> {
    let now = problem.model.parameters.iter().zip(&problem.parameters);
    for ((parameter, &now), (_, then)) in now.zip(&run.subject.parameters) {
        if now.to_bits() != then.to_bits() {
            let name = parameter.name;
            let why = format!("`{name}` is {now} now and was {then}");
            let path = format!("parameters.{name}");
            return Err(Reason::OtherRun { path, why });
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
            let path = part.clone();
            return Err(Reason::OtherRun { path, why });
        }
    }
    Ok(())
}

/// The rows of a run must be on the grid, but for the last: it is where the run ended.
fn check_rows(problem: &Problem, run: &Run) -> Result<(), Reason> {
    let rows = run.trajectory.t.iter().zip(0..);
    let mut grid = rows.take(run.trajectory.len().saturating_sub(1));
    grid.try_for_each(|(&t, i)| check_row(problem.record.every, i, t))
}

/// Digests of the model and of what a run is simulated with, but for its end and what is recorded: as (part, digest),
/// by the keys of a scene.
pub(super) fn digests(problem: &Problem) -> Vec<(String, String)> {
    let Problem {
        model,
        accuracy,
        initial,
        ..
    } = problem;
    let mut frozen: Vec<&str> = (problem.freeze.iter())
        .map(|&i| &*model.coordinates[i].name)
        .collect();
    frozen.sort_unstable();
    frozen.dedup();
    let modes = &problem.variant().modes;
    let mode = initial.mode.map_or("", |mode| &*modes[mode].name);
    let method = match problem.method {
        Method::Auto => "auto",
        Method::Radau => "radau",
        Method::Taylor => "taylor",
    };
    // What the method of integration and the law of impacts are; the latter where it is not the default.
    let collisions = match problem.collisions == Collisions::default() {
        true => String::new(),
        false => format!(" {:?}", problem.collisions),
    };
    let method = format!("{method}{collisions}");
    let outputs = problem
        .outputs
        .iter()
        .map(|OwnOutput { quantity, formula }| {
            format!("{}\n{}\n{}\n", quantity.name, quantity.unit, formula.text())
        });
    let outputs: Vec<String> = outputs.collect();
    let accuracy_lists = [&accuracy.q_absolute, &accuracy.v_absolute];
    let initial_lists = [&initial.q, &initial.v, &initial.discrete];
    let parts = [
        (
            "accuracy",
            content("", |put| {
                put(accuracy.relative);
                put_lists(&accuracy_lists, put);
            }),
        ),
        ("freeze", content(&frozen.join(" "), |_| {})),
        (
            "initial",
            content(mode, |put| {
                put_lists(&initial_lists, put);
                if problem.project {
                    put(1.0);
                }
                if problem.at_rest {
                    put(2.0);
                }
            }),
        ),
        ("inputs", content("", |put| problem.signals.content(put))),
        ("method", content(&method, |_| {})),
        ("model", model.digest.to_owned()),
        ("outputs", content(&outputs.concat(), |_| {})),
    ];
    parts.map(|(part, digest)| (part.to_owned(), digest)).into()
}

/// Digest of a text and of numbers, by their bits.
fn content(text: &str, numbers: impl FnOnce(&mut dyn FnMut(f64))) -> String {
    let mut bytes = text.as_bytes().to_vec();
    bytes.push(0);
    numbers(&mut |x| bytes.extend(x.to_bits().to_le_bytes()));
    digest(bytes)
}

/// Lists of numbers, each with its length.
fn put_lists(lists: &[&Vec<f64>], put: &mut dyn FnMut(f64)) {
    for list in lists {
        put(list.len() as f64);
        list.iter().copied().for_each(&mut *put);
    }
}

impl Simulation<'_> {
    /// Goes to the end of a run, and takes over what it has recorded, or what of it was replayed to the observer.
    fn restore(&mut self, run: Run, replayed: Option<Replay>) -> Result<(), Reason> {
        let Run {
            mut trajectory,
            events,
            tally,
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
        self.here.shown = end.mode;
        self.here.mode = match self.modes[0].contacts {
            Some(_) => 0,
            None => end.mode,
        };
        self.here.q[..end.state.q.len()].copy_from_slice(&end.state.q);
        self.here.v[..end.state.v.len()].copy_from_slice(&end.state.v);
        // Multipliers are behind the coordinates. Nothing depends on them but the outputs that are their rates, the impulses:
        // these go on where they are recorded.
        let coordinates = self.problem.model.coordinates.iter();
        for (coordinate, rate) in coordinates.zip(self.here.v.iter_mut()) {
            let recorded = coordinate.impulse.and_then(|i| end.state.outputs.get(i));
            if let Some(&impulse) = recorded {
                *rate = impulse;
            }
        }
        self.context.discrete_mut()[..end.state.discrete.len()]
            .copy_from_slice(&end.state.discrete);
        if self.modes[0].contacts.is_some() {
            self.resume_contacts(end.mode)?;
        }
        self.observers.go_on(energy.as_ref(), &peaks);
        self.doubts.go_on(solver.steps, uncertain);
        self.solver = solver;
        if let Some((name, _)) = self.problem.end.after {
            self.counted = tally.count(name) as u64;
        }
        let every = self.problem.record.every;
        let recording = &mut self.observers.recording;
        let rows = match replayed {
            Some(replayed) => {
                recording.continue_told(tally, replayed.last);
                replayed.rows
            }
            None => {
                if let Some(last) = trajectory.len().checked_sub(1)
                    && !is_on_grid(every, last as u64, trajectory.t[last])
                {
                    trajectory.truncate(last);
                }
                let (rows, last) = (trajectory.len() as u64, trajectory.t.last().copied());
                let to_come = every.map_or(0, |every| {
                    Recorder::grid_rows(self.problem.end.time - end.t, every)
                });
                let jumps = events.iter().map(Event::jump).collect();
                let sides = match self.problem.record.event_states {
                    true => events.into_iter().map(|e| [e.before, e.after]).collect(),
                    false => Vec::new(),
                };
                let collected = Collected::continuing(trajectory, to_come, jumps, sides);
                recording.continue_with(collected, last);
                rows
            }
        };
        self.observers.samples.go_to(rows);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::{Function, Interpolation, Outside, Sine, Table};
    use crate::model::models;

    fn problem() -> Problem {
        let model = models().iter().find(|m| m.name == "hand_coulomb");
        let mut problem = Problem::new(&model.unwrap());
        let table = Table::new(
            &[0.0, 1.0, 3.0],
            &[0.0, 2.0, 1.0],
            Interpolation::Linear,
            Outside::Hold,
        );
        let force = [
            Function::from(table.unwrap()),
            Function::from(Sine::new(1.5, 2.0, 0.25)),
            Function::constant(0.5),
        ];
        problem.set_input("force", Function::sum(force)).unwrap();
        problem
    }

    #[test]
    fn digests_are_of_what_a_scene_says_and_not_of_how_it_is_printed() {
        let of = |problem: &Problem| {
            let all = digests(problem).into_iter();
            all.filter(|(part, _)| part != "model").collect::<Vec<_>>()
        };
        let known = of(&problem());
        let expected = [
            ("accuracy", "f76df14f3e8cd409"),
            ("freeze", "6e340b9cffb37a98"),
            ("initial", "b56575d097d9e31e"),
            ("inputs", "24943f835e047dee"),
            ("method", "99501bbdabca4107"),
            ("outputs", "6e340b9cffb37a98"),
        ];
        let named = known
            .iter()
            .map(|(part, digest)| (part.as_str(), digest.as_str()));
        assert_eq!(named.collect::<Vec<_>>(), expected);
        let changed = |change: &dyn Fn(&mut Problem)| -> Vec<String> {
            let mut problem = problem();
            change(&mut problem);
            let now = of(&problem).into_iter().zip(known.clone());
            now.filter(|(now, then)| now != then)
                .map(|(now, _)| now.0)
                .collect()
        };
        assert_eq!(changed(&|p| p.title = Some("another".into())), [""; 0]);
        assert_eq!(changed(&|p| p.end.time = 7.0), [""; 0]);
        assert_eq!(
            changed(&|p| p.accuracy.v_absolute[0] *= 1.0 + f64::EPSILON),
            ["accuracy"]
        );
        assert_eq!(changed(&|p| p.freeze = vec![0]), ["freeze"]);
        assert_eq!(changed(&|p| p.initial.q[0] = -0.0), ["initial"]);
        assert_eq!(changed(&|p| p.initial.mode = Some(0)), ["initial"]);
        assert_eq!(changed(&|p| p.method = Method::Radau), ["method"]);
        let sine = Function::from(Sine::new(1.5, 2.0, 0.25));
        assert_eq!(
            changed(&|p| p.set_input("force", sine.clone()).unwrap()),
            ["inputs"]
        );
    }
}
