//! The runs of a case.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use super::design::number_node;
use super::file::{SecondRuns, Study};
use super::measure;
use super::procedure::{Along, Failed, Procedure};
use super::rows::{Row, Status};
use crate::hybrid::{Observer, Problem, simulate_member};
use crate::integrate::{Const, Tolerances};
use crate::run::{Jump, Progress, Run, Snapshot};
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
    fn event(&mut self, _: &Jump, _: Option<&[Snapshot; 2]>) {}
}

/// Ends a run when the study is to stop.
struct Stoppable<'s>(&'s AtomicBool);

impl Progress for Stoppable<'_> {
    fn advance(&mut self, _: f64, _: u64) -> ControlFlow<()> {
        match self.0.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// A run as far as a study looks at it.
struct Measured {
    values: Vec<f64>,
    failed: Failed,
}

impl Study {
    /// All runs of a case in the order in which they are made; `None` if the study was stopped meanwhile.
    pub fn runs_of(&self, case: u64, stop: &AtomicBool) -> Option<Vec<Row>> {
        let changes = self.design.changes(case);
        let Some(along) = self.procedure.along() else {
            return Some(vec![self.run(case, &changes, None, stop)?]);
        };
        let mut rows: Vec<Row> = Vec::new();
        let mut runs: Vec<(f64, Failed)> = Vec::new();
        loop {
            let next = match &self.procedure {
                Procedure::Ida(ida) => ida.next(&runs),
                Procedure::Critical(critical) => critical.next(&runs),
                Procedure::Once { .. } => None,
            };
            let Some(value) = next else { break };
            let row = self.run(case, &changes, Some((along, value)), stop)?;
            runs.push((value, row.failed));
            rows.push(row);
        }
        self.check_bracket(case, &changes, &mut rows, stop)?;
        Some(rows)
    }

    /// Runs the two runs about a capacity again where no measure says how near they are.
    fn check_bracket(
        &self,
        case: u64,
        changes: &[Change],
        rows: &mut [Row],
        stop: &AtomicBool,
    ) -> Option<()> {
        let judged_by_measure = self.failure.as_ref().is_some_and(|f| f.measure().is_some());
        if self.second_runs != SecondRuns::Near || judged_by_measure {
            return Some(());
        }
        let Some(along) = self.procedure.along() else {
            return Some(());
        };
        let runs: Vec<(f64, Failed)> = rows.iter().map(|r| (r.intensity, r.failed)).collect();
        let Some(bracket) = self.procedure.bracket(&runs) else {
            return Some(());
        };
        for value in bracket {
            let Some(row) = rows.iter_mut().find(|row| row.intensity == value) else {
                continue;
            };
            let Ok(mut problem) = self.problem(changes, Some((along, value))) else {
                continue;
            };
            let again = self.again(&mut problem, stop)?;
            row.undecided = again.is_none_or(|again| again.failed != row.failed);
            debug_assert_eq!(row.case, case);
        }
        Some(())
    }

    /// The problem of a case, at a value along the path of its analysis.
    fn problem(
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

    /// A run and its row; `None` if it was stopped.
    fn run(
        &self,
        case: u64,
        changes: &[Change],
        at: Option<(&Along, f64)>,
        stop: &AtomicBool,
    ) -> Option<Row> {
        let refused = |reason: String| {
            let none = vec![f64::NAN; self.measures.len()];
            let intensity = at.map_or(f64::NAN, |(_, value)| value);
            Row::refused(case, intensity, none, reason)
        };
        let problem = match self.problem(changes, at) {
            Ok(problem) => problem,
            Err(errors) => {
                let first = errors.iter().next();
                return Some(refused(
                    first.map_or(String::new(), |e| e.kind().to_string()),
                ));
            }
        };
        let run = match simulate_member(&problem, &mut Deaf, &mut Stoppable(stop)) {
            Ok(run) => run,
            Err(reason) => return Some(refused(reason.to_string())),
        };
        if run.failure.is_some() && stop.load(Ordering::Relaxed) {
            return None;
        }
        let Measured { values, failed } = self.measured(&run);
        let mut row = Row {
            case,
            intensity: at.map_or(f64::NAN, |(_, value)| value),
            failed,
            undecided: false,
            status: match run.failure {
                None => Status::Ok,
                Some(_) => Status::Stopped,
            },
            reason: run.failure.as_ref().map(|f| f.reason.clone()),
            t: run.end.t,
            events: run.tally.total() as u64,
            uncertain: run.uncertain.total,
            work: [
                run.solver.steps,
                run.solver.rejected,
                run.solver.residual_evaluations,
                run.solver.jacobian_evaluations,
                run.solver.factorizations,
            ],
            values,
        };
        if self.needs_second(&row) {
            let mut problem = problem;
            row.undecided = loop {
                let Some(again) = self.again(&mut problem, stop)? else {
                    break true;
                };
                // A method that is better than it is asked for may take the very same steps: that says nothing.
                let same = again.values.iter().zip(&row.values);
                let same = same.fold(true, |same, (a, b)| same && a.to_bits() == b.to_bits());
                if !same || problem.accuracy.relative <= LEAST {
                    break self.is_undecided(&row, &again);
                }
            };
        }
        Some(row)
    }

    fn measured(&self, run: &Run) -> Measured {
        let values: Vec<f64> = measure::values(&self.measures, run).collect();
        let failed = self.failure.as_ref().and_then(|failure| match run.failure {
            None => failure.happened(run, &values),
            Some(_) => failure.happened_early(&self.measures, run, &values),
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

    /// The run of a problem whose tolerance is tightened; the inner `None` where it cannot start, the outer where it was stopped.
    fn again(&self, problem: &mut Problem, stop: &AtomicBool) -> Option<Option<Measured>> {
        let accuracy = &mut problem.accuracy;
        let factor = (accuracy.relative * TIGHTER).max(LEAST) / accuracy.relative;
        accuracy.relative *= factor;
        let absolute = accuracy
            .q_absolute
            .iter_mut()
            .chain(&mut accuracy.v_absolute);
        absolute.for_each(|tolerance| *tolerance *= factor);
        let run = simulate_member(problem, &mut Deaf, &mut Stoppable(stop));
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
