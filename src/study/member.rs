//! A run of a case: its problem, and its row.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use super::design::number_node;
use super::ending::Ending;
use super::file::{SecondRuns, Study};
use super::measure;
use super::procedure::{Along, Failed};
use super::rows::{Row, Status};
use crate::hybrid::{Observer, Problem, simulate_member};
use crate::integrate::{Const, Tolerances};
use crate::run::{Jump, Sides, Until};
use crate::scene::SceneErrors;
use crate::scene::template::Change;

/// What a second run's tolerance is of the first's.
const TIGHTER: f64 = 1e-2;

/// The tightest tolerance of a second run: no method can tell smaller errors from rounding.
const LEAST: f64 = Tolerances::<Const<0>>::SMALLEST_RELATIVE;

/// How many times the difference to the second run a measure must be away from what decides, to be decided.
const SAFE: f64 = 10.0;

/// How near what decides a second run is made, as a part of the level: a run whose measure its tolerance lets err by more than a
/// tenth of that is not one to count failures with.
const NEAR: f64 = 0.01;

/// Hears nothing: what a study measures is kept by the engine itself.
struct Deaf;

impl Observer for Deaf {
    fn row(&mut self, _: f64, _: usize, _: &[f64]) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    fn sees_rows(&self) -> bool {
        false
    }
    fn event(&mut self, _: &Jump, _: Option<&Sides>) {}
}

/// A run that is to be made.
pub(crate) struct Planned {
    pub case: u64,
    /// The value along the path of an analysis; NaN for a single run.
    pub intensity: f64,
    /// Its problem, or why its scene is none.
    pub problem: Result<Problem, String>,
}

/// A run as far as a study looks at it.
struct Measured {
    values: Vec<f64>,
    failed: Failed,
}

impl Study {
    /// The run of a case, at a value along the path of its analysis.
    pub fn planned(&self, case: u64, value: Option<f64>) -> Planned {
        let changes = self.design.changes(case);
        let at = self.procedure.along().zip(value);
        let problem = self.problem(&changes, at).map_err(|errors| {
            let first = errors.iter().next();
            first.map_or(String::new(), |e| e.kind().to_string())
        });
        Planned {
            case,
            intensity: value.unwrap_or(f64::NAN),
            problem,
        }
    }

    /// Makes a run; `None` if it was stopped.
    pub fn run_alone(&self, planned: &Planned, stop: &AtomicBool) -> Option<Row> {
        let problem = match &planned.problem {
            Ok(problem) => problem,
            Err(reason) => return Some(self.refused(planned, reason.clone())),
        };
        let run = match simulate_member(problem, &mut Deaf, &mut Until(stop)) {
            Ok(run) => run,
            Err(reason) => return Some(self.refused(planned, reason.to_string())),
        };
        if run.failure.is_some() && stop.load(Ordering::Relaxed) {
            return None;
        }
        self.decided(self.row(planned, &run), planned, false, stop)
    }

    /// The row of a run that cannot be started.
    pub fn refused(&self, planned: &Planned, reason: String) -> Row {
        let none = vec![f64::NAN; self.measures.len()];
        Row::refused(planned.case, planned.intensity, none, reason)
    }

    /// The row of a run; whether it is decided is not looked at.
    pub fn row(&self, planned: &Planned, ending: &impl Ending) -> Row {
        let Measured { values, failed } = self.measured(ending);
        let (reason, solver) = (ending.failure(), ending.solver());
        Row {
            case: planned.case,
            intensity: planned.intensity,
            failed,
            undecided: false,
            status: match reason {
                None => Status::Ok,
                Some(_) => Status::Stopped,
            },
            reason,
            t: ending.time(),
            events: ending.count(None) as u64,
            uncertain: ending.uncertain(),
            work: [
                solver.steps,
                solver.rejected,
                solver.residual_evaluations,
                solver.jacobian_evaluations,
                solver.factorizations,
            ],
            values,
        }
    }

    /// A row after a second run, where it is to have one; `None` if that was stopped. `in_lanes`: the first was made in an ensemble.
    pub fn decided(
        &self,
        mut row: Row,
        planned: &Planned,
        in_lanes: bool,
        stop: &AtomicBool,
    ) -> Option<Row> {
        let Ok(problem) = &planned.problem else {
            return Some(row);
        };
        if !self.needs_second(&row) {
            return Some(row);
        }
        // Steps of lanes have other roundings, by which the same steps cannot be known.
        let alone = match in_lanes {
            true => self.alone(problem, stop)?,
            false => None,
        };
        let first = alone.map_or_else(|| row.values.clone(), |run| run.values);
        let mut problem = problem.clone();
        row.undecided = loop {
            tighten(&mut problem);
            let Some(again) = self.alone(&problem, stop)? else {
                break true;
            };
            // A method that is better than it is asked for may take the very same steps: that says nothing.
            let same = again.values.iter().zip(&first);
            let same = same.fold(true, |same, (a, b)| same && a.to_bits() == b.to_bits());
            if !same || problem.accuracy.relative <= LEAST {
                break self.is_undecided(&row, &again);
            }
        };
        Some(row)
    }

    /// Makes the two runs about a capacity again where no measure says how near they are; `None` if they were stopped.
    pub fn check_bracket(&self, case: u64, rows: &mut [Row], stop: &AtomicBool) -> Option<()> {
        let judged_by_measure = self.failure.as_ref().is_some_and(|f| f.measure().is_some());
        if self.second_runs != SecondRuns::Near || judged_by_measure {
            return Some(());
        }
        let runs: Vec<(f64, Failed)> = rows.iter().map(|r| (r.intensity, r.failed)).collect();
        let Some(bracket) = self.procedure.bracket(&runs) else {
            return Some(());
        };
        for value in bracket {
            let Some(row) = rows.iter_mut().find(|row| row.intensity == value) else {
                continue;
            };
            let Ok(mut problem) = self.planned(case, Some(value)).problem else {
                continue;
            };
            tighten(&mut problem);
            let again = self.alone(&problem, stop)?;
            row.undecided = again.is_none_or(|again| again.failed != row.failed);
        }
        Some(())
    }

    /// The problem of a case, at a value along the path of its analysis.
    pub fn problem(
        &self,
        changes: &[Change],
        at: Option<(&Along, f64)>,
    ) -> Result<Problem, SceneErrors> {
        let mut all: Vec<Change> = changes
            .iter()
            .map(|change| Change {
                path: change.path,
                value: change.value.clone(),
            })
            .collect();
        all.extend(at.map(|(along, value)| Change {
            path: &along.names,
            value: number_node(value, &along.place),
        }));
        let mut problem = self.template.scene(&all)?.problem;
        problem.record = measure::record(&self.measures, &problem);
        Ok(problem)
    }

    fn measured(&self, ending: &impl Ending) -> Measured {
        let values: Vec<f64> = measure::values(&self.measures, ending).collect();
        let failure = self.failure.as_ref();
        let failed = failure.and_then(|failure| match ending.failure() {
            None => failure.happened(ending, &values),
            Some(_) => failure.happened_early(&self.measures, ending, &values),
        });
        Measured { values, failed }
    }

    /// Whether a run is so near what decides that it is made again.
    fn needs_second(&self, row: &Row) -> bool {
        let Some(failure) = &self.failure else {
            return false;
        };
        if row.failed.is_none() {
            return false;
        }
        match (self.second_runs, failure.margin(&row.values)) {
            (SecondRuns::None, _) => false,
            (SecondRuns::All, _) => true,
            (SecondRuns::Near, Some((margin, level))) => margin.abs() <= NEAR * level.abs(),
            // Of a limit state nobody knows how near it was: an analysis looks at the two runs about the capacity.
            (SecondRuns::Near, None) => self.procedure.along().is_none(),
        }
    }

    /// A run by itself; the inner `None` where it cannot start, the outer where it was stopped.
    fn alone(&self, problem: &Problem, stop: &AtomicBool) -> Option<Option<Measured>> {
        let run = simulate_member(problem, &mut Deaf, &mut Until(stop));
        match run {
            Ok(run) if run.failure.is_some() && stop.load(Ordering::Relaxed) => None,
            Ok(run) => Some(Some(self.measured(&run))),
            Err(_) => Some(None),
        }
    }

    /// Whether a run and its second, better one leave it open whether it failed.
    fn is_undecided(&self, row: &Row, again: &Measured) -> bool {
        let index = self.failure.as_ref().and_then(|failure| failure.measure());
        let margin = self.failure.as_ref().and_then(|f| f.margin(&row.values));
        match (index, margin) {
            (Some(index), Some((margin, _))) => {
                let difference = (row.values[index] - again.values[index]).abs();
                difference.is_nan() || margin.abs() <= SAFE * difference
            }
            _ => row.failed != again.failed,
        }
    }
}

/// Tightens the tolerances for a second run.
fn tighten(problem: &mut Problem) {
    let accuracy = &mut problem.accuracy;
    let factor = (accuracy.relative * TIGHTER).max(LEAST) / accuracy.relative;
    accuracy.relative *= factor;
    let absolute = accuracy
        .q_absolute
        .iter_mut()
        .chain(&mut accuracy.v_absolute);
    absolute.for_each(|tolerance| *tolerance *= factor);
}
