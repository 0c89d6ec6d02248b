//! Time against error: every method at every tolerance, beside a reference of its own.

use super::{Difference, TIGHTEST, scales, variation};
use crate::hybrid::{Method, Problem, Reason, Simulator, simulate};
use crate::record::{Progress, Run, Silent};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// The tolerances of a study, the loosest first.
pub const TOLERANCES: [f64; 11] = [
    1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13,
];

/// The methods of a study. Radau is the first, since it always comes to an end: it sets the time that
/// the others may take.
const METHODS: [Method; 3] = [Method::Radau, Method::Auto, Method::Taylor];

/// A method that takes so many times as long as Radau is given up: it is no choice. Stiff equations
/// take the Taylor method thousands of times as long.
const GIVEN_UP: u32 = 20;

/// Time that every method gets before it is given up, so that short runs are not judged by their noise.
const GRACE: Duration = Duration::from_millis(200);

/// Repeats of a run, of which the fastest counts: until this much time is used, at least three and at
/// most many; one for runs that are longer.
const REPEAT_FOR: Duration = Duration::from_millis(50);
const REPEATS: std::ops::RangeInclusive<usize> = 3..=500;

/// How a run of a study ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// At its end.
    Complete,
    /// The simulation stopped early, for this reason.
    Stopped(String),
    /// It took many times as long as Radau.
    GivenUp,
}

/// A method at a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The method.
    pub method: Method,
    /// What it used, as [`crate::record::Solver::method`] names it.
    pub used: String,
    /// Relative tolerance.
    pub tolerance: f64,
    /// How it ended.
    pub verdict: Verdict,
    /// Difference to the reference; `None` unless it is complete.
    pub error: Option<Difference>,
    /// What the energy balance is off by, J; `None` where no ledger is kept.
    pub imbalance: Option<f64>,
    /// Steps.
    pub steps: u64,
    /// Evaluations of the residual, or orders of series.
    pub evaluations: u64,
    /// Fastest of the repeats, without preparation and without the ledger, s.
    pub seconds: f64,
}

/// What runs are compared with.
#[derive(Debug, Clone)]
pub struct Reference {
    /// By Radau at the tightest tolerance.
    implicit: Run,
    /// By the Taylor method at the tightest tolerance; by Radau at the next, where Taylor was given up.
    other: Run,
    /// Whether the two are by different methods.
    pub independent: bool,
    /// What the two differ by: a bound of the error of the better one, and an estimate of that of both.
    pub bound: Difference,
}

/// A method and tolerance for a wanted error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advice {
    /// Wanted error: see [`Study::advice`].
    pub error: f64,
    /// Index of the row that reaches it in the least time; `None`: none does.
    pub row: Option<usize>,
}

/// Time against error of a scene.
#[derive(Debug, Clone)]
pub struct Study {
    /// The reference; `None` where the study was interrupted before it was there.
    pub reference: Option<Reference>,
    /// A row for each method and tolerance, in the order of the computation.
    pub rows: Vec<Row>,
    /// Whether all rows are there.
    pub complete: bool,
    /// Time that the scene ends at, s.
    duration: f64,
}

/// Ends a run at a deadline, or where `asked` says so.
struct Deadline<'a> {
    at: Option<Instant>,
    asked: &'a dyn Fn() -> bool,
}

impl Progress for Deadline<'_> {
    fn advance(&mut self, _: f64, _: u64) -> ControlFlow<()> {
        match (self.asked)() || self.at.is_some_and(|at| Instant::now() > at) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

impl Study {
    /// Studies a problem. `asked` is looked at after every step and ends the study early; `row_done` is
    /// told the number of rows done and of all.
    ///
    /// # Errors
    /// As [`simulate`].
    pub fn new(
        problem: &Problem,
        asked: &dyn Fn() -> bool,
        mut row_done: impl FnMut(usize, usize),
    ) -> Result<Self, Reason> {
        let mut study = Study {
            reference: None,
            rows: Vec::new(),
            complete: false,
            duration: problem.end.time,
        };
        let all = METHODS.len() * TOLERANCES.len();
        row_done(0, all);
        study.reference = Reference::new(problem, asked)?;
        let Some(reference) = &study.reference else {
            return Ok(study);
        };
        for tolerance in TOLERANCES {
            let mut limit = None;
            for method in METHODS {
                let Some(row) = row(problem, (method, tolerance), reference, limit, asked)? else {
                    return Ok(study);
                };
                if method == Method::Radau {
                    let seconds = Duration::from_secs_f64(row.seconds);
                    limit = Some((seconds * GIVEN_UP).max(GRACE));
                }
                study.rows.push(row);
                row_done(study.rows.len(), all);
            }
        }
        study.complete = true;
        Ok(study)
    }

    /// The fastest row for a wanted error that finds every event. All tighter tolerances of its method
    /// must reach the error too: a row that is better than those is luck. The error is that of the end
    /// (in typical sizes) or that of an event's time (over the duration of the run), whichever is larger.
    pub fn advice(&self, error: f64) -> Advice {
        let reaches = |row: &Row| {
            row.error.as_ref().is_some_and(|found| {
                let events = found.events;
                let larger = found.end.max(events.time / self.duration);
                larger <= error && events.missed + events.extra == 0
            })
        };
        let reliable = |row: &Row| {
            let same = self.rows.iter().filter(|other| other.method == row.method);
            let mut tighter = same.filter(|other| other.tolerance <= row.tolerance);
            tighter.all(|other| reaches(other) || other.verdict == Verdict::GivenUp)
        };
        let rows = self.rows.iter().enumerate();
        let good = rows.filter(|(_, row)| reaches(row) && reliable(row));
        // `auto` may have made the very steps of another method: then it is the one to name.
        let copies_auto = |row: &Row| {
            self.rows.iter().any(|auto| {
                let work = |row: &Row| (row.steps, row.evaluations);
                auto.method == Method::Auto
                    && row.method != Method::Auto
                    && (auto.tolerance, work(auto)) == (row.tolerance, work(row))
            })
        };
        let good = good.filter(|(_, row)| !copies_auto(row));
        let fastest = good.min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
        Advice {
            error,
            row: fastest.map(|(i, _)| i),
        }
    }
}

impl Reference {
    /// `None` if it was interrupted.
    fn new(problem: &Problem, asked: &dyn Fn() -> bool) -> Result<Option<Self>, Reason> {
        let run = |method, tolerance, at| {
            let mut deadline = Deadline { at, asked };
            simulate(&variation(problem, method, tolerance), &mut deadline)
        };
        let start = Instant::now();
        let implicit = run(Method::Radau, TIGHTEST, None)?;
        let limit = (start.elapsed() * GIVEN_UP).max(GRACE);
        let taylor = run(Method::Taylor, TIGHTEST, Some(Instant::now() + limit))?;
        let independent =
            taylor.failure.is_none() && taylor.solver.method != implicit.solver.method;
        let other = match independent {
            true => taylor,
            false => run(Method::Radau, 10.0 * TIGHTEST, None)?,
        };
        if asked() {
            return Ok(None);
        }
        Ok(Some(Reference {
            bound: Difference::new(&other, &implicit, &scales(problem)),
            implicit,
            other,
            independent,
        }))
    }

    /// The run that runs of a method are compared with: by another method, where there is one.
    fn of(&self, method: Method) -> &Run {
        match method {
            Method::Radau if self.independent => &self.other,
            _ => &self.implicit,
        }
    }

    /// Why the reference itself stopped early, if it did.
    pub fn failure(&self) -> Option<&crate::record::Failure> {
        self.implicit.failure.as_ref()
    }

    /// Number of events of the reference.
    pub fn events(&self) -> usize {
        self.implicit.events.len()
    }
}

/// A row; `None` if it was interrupted.
fn row(
    problem: &Problem,
    (method, tolerance): (Method, f64),
    reference: &Reference,
    limit: Option<Duration>,
    asked: &dyn Fn() -> bool,
) -> Result<Option<Row>, Reason> {
    let mut problem = variation(problem, method, tolerance);
    let start = Instant::now();
    let at = limit.map(|limit| start + limit);
    let run = simulate(&problem, &mut Deadline { at, asked })?;
    let mut seconds = start.elapsed().as_secs_f64();
    if asked() {
        return Ok(None);
    }
    let verdict = match &run.failure {
        None => Verdict::Complete,
        Some(_) if at.is_some_and(|at| Instant::now() > at) => Verdict::GivenUp,
        Some(failure) => Verdict::Stopped(failure.reason.clone()),
    };
    let complete = verdict == Verdict::Complete;
    if complete {
        problem.record.ledger = false;
        seconds = fastest(&problem, asked)?;
        if asked() {
            return Ok(None);
        }
    }
    let scales = scales(&problem);
    Ok(Some(Row {
        method,
        tolerance,
        verdict,
        error: complete.then(|| Difference::new(&run, reference.of(method), &scales)),
        imbalance: run.energy.as_ref().map(|energy| energy.imbalance().abs()),
        steps: run.solver.steps,
        evaluations: run.solver.residual_evaluations,
        used: run.solver.method,
        seconds,
    }))
}

/// Least time of repeats, s.
fn fastest(problem: &Problem, asked: &dyn Fn() -> bool) -> Result<f64, Reason> {
    let mut simulator = Simulator::new(problem)?;
    let mut least = f64::INFINITY;
    let begin = Instant::now();
    for repeat in 1..=*REPEATS.end() {
        let start = Instant::now();
        // It has come to its end before.
        simulator.run(&mut Silent)?;
        least = least.min(start.elapsed().as_secs_f64());
        let used = begin.elapsed();
        let enough = repeat >= *REPEATS.start() || used > 10 * REPEAT_FOR;
        if asked() || enough && used > REPEAT_FOR {
            break;
        }
    }
    Ok(least)
}
