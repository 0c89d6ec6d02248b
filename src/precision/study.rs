//! Time against error: every method at every tolerance, beside a reference of its own.

use super::attempt::{Attempt, attempt};
use super::{Bound, Difference, GIVEN_UP, Reference, variation};
use crate::hybrid::{Method, Problem, Reason, Simulator};
use crate::record::Progress;
use std::time::{Duration, Instant};

/// The tolerances of a study, the loosest first.
pub const TOLERANCES: [f64; 11] = [
    1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13,
];

/// The methods of a study. Radau is the first, since it always comes to an end: it sets the time that
/// the others may take.
const METHODS: [Method; 3] = [Method::Radau, Method::Auto, Method::Taylor];

/// Time that every method gets before it is given up, so that short runs are not judged by their noise.
const GRACE: Duration = Duration::from_millis(200);

/// Repeats of a run, of which the fastest counts: until this much time is used, at least three and at
/// most many; one for runs that are longer.
const REPEAT_FOR: Duration = Duration::from_millis(50);
const REPEATS: std::ops::RangeInclusive<usize> = 3..=500;

/// A method at a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The method.
    pub method: Method,
    /// Relative tolerance.
    pub tolerance: f64,
    /// How its run ended.
    pub verdict: Verdict,
}

/// How a run of a study ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// At its end.
    Complete(Measured),
    /// The simulation stopped early.
    Stopped {
        /// When, s.
        at: f64,
        /// Why.
        reason: Reason,
    },
    /// It took [`GIVEN_UP`] times as long as Radau.
    GivenUp {
        /// How long it took until then, s.
        seconds: f64,
    },
    /// The study was interrupted before it was there.
    Interrupted,
}

/// What a run costs and how far it is from the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The methods that made its steps, as [`crate::record::Solver::method`] names them.
    pub used: String,
    /// Difference to the reference.
    pub error: Difference,
    /// How often it says that it cannot tell whether an event happens.
    pub uncertain: u64,
    /// What the energy balance is off by, J; `None` where no ledger is kept.
    pub imbalance: Option<f64>,
    /// Steps.
    pub steps: u64,
    /// Evaluations of the residual, or orders of series.
    pub evaluations: u64,
    /// Fastest of the repeats, without preparation and without the ledger, s.
    pub seconds: f64,
}

/// Time against error of a scene.
#[derive(Debug, Clone)]
pub struct Study {
    /// The reference; `None` where the study was interrupted before it was there.
    pub reference: Option<Reference>,
    /// A row for each tolerance and method, in the order of the computation.
    pub rows: Vec<Row>,
}

impl Row {
    /// What the run costs and how far it is from the reference, if it came to its end.
    pub fn measured(&self) -> Option<&Measured> {
        match &self.verdict {
            Verdict::Complete(measured) => Some(measured),
            _ => None,
        }
    }
}

impl Study {
    /// Studies a problem. `progress` hears of every step and may end the study early; `row_done` is
    /// told the number of rows done and of all.
    ///
    /// # Errors
    /// As [`crate::hybrid::simulate`].
    pub fn new(
        problem: &Problem,
        progress: &mut dyn Progress,
        mut row_done: impl FnMut(usize, usize),
    ) -> Result<Self, Reason> {
        let planned = TOLERANCES.map(|tolerance| METHODS.map(|method| (method, tolerance)));
        let planned = planned.as_flattened();
        row_done(0, planned.len());
        let reference = Reference::new(problem, progress)?;
        let mut rows: Vec<Row> = Vec::new();
        let mut limit = None;
        for &(method, tolerance) in planned {
            let start = Instant::now();
            let interrupted = rows
                .last()
                .is_some_and(|r| r.verdict == Verdict::Interrupted);
            let verdict = match &reference {
                Some(reference) if !interrupted => {
                    let limit = limit.filter(|_| method != Method::Radau);
                    let problem = variation(&reference.problem, method, tolerance);
                    measure(problem, reference, limit, progress)?
                }
                _ => Verdict::Interrupted,
            };
            if method == Method::Radau {
                let took = match &verdict {
                    Verdict::Complete(measured) => Duration::from_secs_f64(measured.seconds),
                    _ => start.elapsed(),
                };
                limit = Some((took * GIVEN_UP).max(GRACE));
            }
            rows.push(Row {
                method,
                tolerance,
                verdict,
            });
            row_done(rows.len(), planned.len());
        }
        Ok(Study { reference, rows })
    }

    /// Whether all runs were made.
    pub fn is_complete(&self) -> bool {
        let interrupted = |row: &Row| row.verdict == Verdict::Interrupted;
        self.reference.is_some() && !self.rows.iter().any(interrupted)
    }

    /// The fastest row that finds every event with an error of at most `wanted`. The error is that of
    /// the end, or that of an event's time over the duration of the run, whichever is larger; that of
    /// the reference comes on top. All tighter tolerances of its method must reach it too: a row that is
    /// better than those is luck.
    pub fn advice(&self, wanted: f64) -> Option<&Row> {
        let reference = self.reference.as_ref()?;
        let duration = reference.problem.end.time;
        let Bound { end, event_time } = reference.bound;
        let reaches = |found: &Measured| {
            let Difference {
                end: error, events, ..
            } = &found.error;
            let larger = (error + end).max((events.time + event_time) / duration);
            larger <= wanted && events.missed + events.extra == 0
        };
        let reliable = |row: &&Row| {
            let same = self.rows.iter().filter(|other| other.method == row.method);
            let tighter = same.filter(|other| other.tolerance < row.tolerance);
            row.measured().is_some_and(reaches) && tighter.filter_map(Row::measured).all(reaches)
        };
        // `auto` may have made the very steps of another method: then it is the one to name.
        let copies_auto = |row: &Row| {
            let work = |row: &Row| row.measured().map(|m| (m.steps, m.evaluations));
            self.rows.iter().any(|auto| {
                auto.method == Method::Auto
                    && row.method != Method::Auto
                    && (auto.tolerance, work(auto)) == (row.tolerance, work(row))
            })
        };
        let good = self
            .rows
            .iter()
            .filter(reliable)
            .filter(|row| !copies_auto(row));
        let seconds = |row: &Row| row.measured().map_or(f64::INFINITY, |m| m.seconds);
        good.min_by(|a, b| seconds(a).total_cmp(&seconds(b)))
    }
}

/// Runs a problem once for its error and then for its time.
fn measure(
    mut problem: Problem,
    reference: &Reference,
    limit: Option<Duration>,
    progress: &mut dyn Progress,
) -> Result<Verdict, Reason> {
    let run = match attempt(&problem, limit, progress)? {
        Attempt::Done(run) => run,
        Attempt::GivenUp(run) => {
            let seconds = run.wall.as_secs_f64();
            return Ok(Verdict::GivenUp { seconds });
        }
        Attempt::Interrupted => return Ok(Verdict::Interrupted),
    };
    if let Some(failure) = run.failure {
        let (at, reason) = (failure.at.t, failure.reason);
        return Ok(Verdict::Stopped { at, reason });
    }
    problem.record.ledger = false;
    problem.record.extremes = false;
    let Some(seconds) = fastest(&problem, progress)? else {
        return Ok(Verdict::Interrupted);
    };
    Ok(Verdict::Complete(Measured {
        error: reference.error(&run),
        uncertain: run.uncertain.total,
        imbalance: run.energy.as_ref().map(|energy| energy.imbalance().abs()),
        steps: run.solver.steps,
        evaluations: run.solver.residual_evaluations,
        used: run.solver.method,
        seconds,
    }))
}

/// Least time of repeats, s; `None` if it was interrupted. The run has come to its end before.
fn fastest(problem: &Problem, progress: &mut dyn Progress) -> Result<Option<f64>, Reason> {
    let mut simulator = Simulator::new(problem)?;
    let mut least = f64::INFINITY;
    let begin = Instant::now();
    for repeat in 1..=*REPEATS.end() {
        let start = Instant::now();
        match simulator.run(progress) {
            Err(Reason::Interrupted) => return Ok(None),
            outcome => outcome?,
        }
        least = least.min(start.elapsed().as_secs_f64());
        let used = begin.elapsed();
        let enough = repeat >= *REPEATS.start() || used > 10 * REPEAT_FOR;
        if enough && used > REPEAT_FOR {
            break;
        }
    }
    Ok(Some(least))
}
