//! Whether another tolerance gives the same events.

use super::{TIGHTEST, TOLERANCES, match_events, variation};
use crate::hybrid::{Observer, Problem, simulate_with};
use crate::record::{Doubt, Event, Jump, Progress, Question, Run, Sides};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

/// How much tighter the tolerance of the other run is: its errors are then small beside those of the run that is judged,
/// and it takes about a fifth more steps.
const TIGHTER: f64 = 10.0;

/// So many events are compared, from the first on: the cost of matching two sequences grows as its square.
pub const COMPARED: usize = 4000;

/// When the run that is judged has ended, s: what the other one does later decides nothing.
#[derive(Debug)]
pub struct Ended(AtomicU64);

impl Default for Ended {
    /// It goes on.
    fn default() -> Self {
        Ended(AtomicU64::new(f64::INFINITY.to_bits()))
    }
}

impl Ended {
    /// It has ended.
    pub fn at(&self, t: f64) {
        self.0.store(t.to_bits(), Ordering::Relaxed);
    }

    fn t(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

/// The other run: its first events, where it ends, and where it is in doubt.
#[derive(Debug)]
pub struct Other {
    run: Run,
    events: Vec<Event>,
}

/// Keeps the events of a run.
struct First<'e>(&'e mut Vec<Event>);

impl Observer for First<'_> {
    fn row(&mut self, _: f64, _: usize, _: &[f64]) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn sees_rows(&self) -> bool {
        false
    }

    fn event(&mut self, jump: &Jump, _: Option<&Sides>) {
        self.0.push(Event::new(jump, Default::default()));
    }
}

/// Progress up to so many events, and to the end of the run that is judged.
struct UpTo<'p> {
    events: u64,
    ended: &'p Ended,
    progress: &'p mut dyn Progress,
}

impl Progress for UpTo<'_> {
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()> {
        match events < self.events && t <= self.ended.t() {
            true => self.progress.advance(t, events),
            false => ControlFlow::Break(()),
        }
    }
}

/// Runs a problem at a tenth of its tolerance (ten times it where that would be below [`TIGHTEST`]), up to [`COMPARED`]
/// events and to where the run that is judged `ended`, which may go on at the same time. `None` where it has no guards, or
/// cannot be started.
pub fn other(problem: &Problem, ended: &Ended, progress: &mut dyn Progress) -> Option<Other> {
    let modes = &problem.variant().modes;
    if modes.iter().all(|mode| mode.guards.is_empty()) {
        return None;
    }
    let relative = problem.accuracy.relative;
    let tolerance = match relative / TIGHTER {
        tighter if tighter >= TIGHTEST => tighter,
        _ => relative * TIGHTER,
    };
    let other = variation(problem, problem.method, tolerance);
    let mut events = Vec::new();
    let mut enough = UpTo {
        events: COMPARED as u64,
        ended,
        progress,
    };
    let run = simulate_with(&other, &mut First(&mut events), &mut enough).ok()?;
    Some(Other { run, events })
}

/// The doubt about the first event of a run that is another one in the [`other`] run, or comes at another time by more than
/// the loosest tolerance of a study. Where errors grow from event to event, or a guard turns so close to zero that rounding
/// decides, no tolerance settles what happens, and no value of a guard shows it.
///
/// `events` are the first events of the run, at most [`COMPARED`]. Where the run or the other one is in doubt, or ends, it
/// is judged up to there. `None`: nothing differs up to there.
pub fn unsettled(problem: &Problem, run: &Run, events: &[Event], other: &Other) -> Option<Doubt> {
    let until = [run, &other.run]
        .iter()
        .flat_map(|run| run.uncertain.first.iter().map(|doubt| doubt.t))
        .fold(run.end.t.min(other.run.end.t), f64::min);
    let events = &events[..events.len().min(COMPARED)];
    let found = match_events(events, &other.events);
    // As late as that it may be the one at the end, of a run that ends just before it.
    if found.until >= until * (1.0 - TOLERANCES[0]) {
        return None;
    }
    let its = events.iter().chain(&other.events);
    let event = its.min_by(|a, b| {
        let late = |event: &Event| (event.t - found.until).abs();
        late(a).total_cmp(&late(b))
    })?;
    Some(Doubt {
        t: found.until,
        mode: run.layout.modes.name(event.from).into_owned(),
        guard: event.transition.to_owned(),
        what: Question::Unsettled,
        value: found.apart,
        error: problem.accuracy.relative * found.common,
        unit: "s".to_owned(),
    })
}
