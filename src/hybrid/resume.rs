//! Going on with a run from a checkpoint that was taken on its way.

use super::checkpoint::Checkpoint;
use super::failure::Reason;
use super::observe::{Observer, sample_time};
use super::outputs::OwnOutput;
use super::problem::{Collisions, Method, Problem};
use super::result::Run;
use super::simulate::subject;
use super::simulation::Simulation;
use crate::run::digest;
use crate::run::{Progress, Tally};
use std::time::Instant as WallClock;

/// Simulates a problem from a checkpoint on, as [`super::simulate_with`] does from the start: to the last bit the rows,
/// transitions and results are those of a run that was never left. `before` is the tally of the transitions before it, of which,
/// as of the rows, the observer was told.
///
/// # Errors
/// [`Reason::Checkpoint`] if it is not one of this problem; else as [`super::simulate`].
pub fn simulate_from(
    problem: &Problem,
    (checkpoint, before): (&Checkpoint, Tally),
    observer: &mut dyn Observer,
    progress: &mut dyn Progress,
) -> Result<Run, Reason> {
    let clock = WallClock::now();
    let mut simulation = Simulation::observed(problem, Some(observer))?;
    simulation.begin()?;
    simulation.restore(checkpoint)?;
    simulation.observers.recording.go_on(before);
    let outcome = simulation.go_on_to_end(progress);
    Ok(simulation.finish(outcome.err(), subject(problem), clock))
}

/// Refuses a row of an earlier run, counted from 0, that is not where the grid of the samples has it.
///
/// # Errors
/// [`Reason::OtherRun`].
pub fn check_row(problem: &Problem, row: u64, t: f64) -> Result<(), Reason> {
    let every = problem.record.every;
    let now = sample_time(every, row);
    if every.is_none() || t == now {
        return Ok(());
    }
    let row = row + 1;
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
