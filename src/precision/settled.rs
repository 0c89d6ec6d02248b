//! Whether another tolerance gives the same events.

use super::{TIGHTEST, TOLERANCES, match_events, variation};
use crate::hybrid::{Observer, Problem, simulate_with};
use crate::record::{Doubt, Event, Jump, Progress, Question, Run, Snapshot};
use std::ops::ControlFlow;

/// How much tighter the tolerance of the other run is: its errors are then small beside those of the run that is judged,
/// and it takes about a fifth more steps.
const TIGHTER: f64 = 10.0;

/// So many events are compared, from the first on: the cost of matching two sequences grows as its square.
pub const COMPARED: usize = 4000;

/// The first events of a run, and where it ends.
struct First {
    events: Vec<Event>,
}

impl Observer for First {
    fn row(&mut self, _: f64, _: usize, _: &[f64]) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn event(&mut self, jump: &Jump, _: Option<&[Snapshot; 2]>) {
        self.events.push(Event::new(jump, Default::default()));
    }
}

/// Progress up to so many events.
struct UpTo<'p>(usize, &'p mut dyn Progress);

impl Progress for UpTo<'_> {
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()> {
        match events < self.0 as u64 {
            true => self.1.advance(t, events),
            false => ControlFlow::Break(()),
        }
    }
}

/// The doubt about the first event of a run that is another one, or comes at another time by more than the loosest
/// tolerance of a study, where the tolerance is a tenth of that of the run (ten times it where that would be below
/// [`TIGHTEST`]). Where errors grow from event to event, or a guard turns so close to zero that rounding decides, no tolerance
/// settles what happens, and no value of a guard shows it.
///
/// `events` are the first events of the run, at most [`COMPARED`]. Where the run or the other one is in doubt, or ends, it
/// is judged up to there. `None`: nothing differs, or the other run did not come to its end because `progress` ended it.
pub fn unsettled(
    problem: &Problem,
    run: &Run,
    events: &[Event],
    progress: &mut dyn Progress,
) -> Option<Doubt> {
    let variant = problem.variant();
    if variant.modes.iter().all(|mode| mode.guards.is_empty()) {
        return None;
    }
    let relative = problem.accuracy.relative;
    let tolerance = match relative / TIGHTER {
        tighter if tighter >= TIGHTEST => tighter,
        _ => relative * TIGHTER,
    };
    let other = variation(problem, problem.method, tolerance);
    let mut first = First { events: Vec::new() };
    let mut enough = UpTo(COMPARED, progress);
    let other = simulate_with(&other, &mut first, &mut enough).ok()?;
    let until = [run, &other]
        .iter()
        .flat_map(|run| run.uncertain.first.iter().map(|doubt| doubt.t))
        .fold(run.end.t.min(other.end.t), f64::min);
    let events = &events[..events.len().min(COMPARED)];
    let found = match_events(events, &first.events);
    // As late as that it may be the one at the end, of a run that ends just before it.
    if found.until >= until * (1.0 - TOLERANCES[0]) {
        return None;
    }
    let its = events.iter().chain(&first.events);
    let event = its.min_by(|a, b| {
        let late = |event: &Event| (event.t - found.until).abs();
        late(a).total_cmp(&late(b))
    })?;
    Some(Doubt {
        t: found.until,
        mode: variant.modes[event.from].name.to_owned(),
        guard: event.transition.to_owned(),
        what: Question::Unsettled,
        value: found.apart,
        error: relative * found.common,
        unit: "s".to_owned(),
    })
}
