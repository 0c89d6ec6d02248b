//! A run that may take too long.

use crate::hybrid::{Problem, Reason, simulate};
use crate::record::{Progress, Run, SparseClock};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// How a run ended.
#[derive(Debug)]
pub enum Attempt {
    /// At its end, or early for a reason of its own.
    Done(Run),
    /// It took too long.
    GivenUp(Run),
    /// From outside.
    Interrupted,
}

/// Progress with a limit of time.
struct Limited<'a> {
    progress: &'a mut dyn Progress,
    deadline: Option<Instant>,
    looks: SparseClock,
    expired: bool,
    interrupted: bool,
}

impl Progress for Limited<'_> {
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()> {
        self.interrupted = self.progress.advance(t, events).is_break();
        if let Some(now) = self.looks.due() {
            self.expired = self.deadline.is_some_and(|at| now > at);
        }
        match self.interrupted || self.expired {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// Simulates a problem, for no longer than `limit` if there is one.
///
/// # Errors
/// As [`simulate`].
pub fn attempt(
    problem: &Problem,
    limit: Option<Duration>,
    progress: &mut dyn Progress,
) -> Result<Attempt, Reason> {
    let mut limited = Limited {
        progress,
        deadline: limit.map(|limit| Instant::now() + limit),
        looks: SparseClock::new(),
        expired: false,
        interrupted: false,
    };
    let run = simulate(problem, &mut limited)?;
    Ok(match (limited.interrupted, limited.expired) {
        (true, _) => Attempt::Interrupted,
        (false, true) => Attempt::GivenUp(run),
        (false, false) => Attempt::Done(run),
    })
}
