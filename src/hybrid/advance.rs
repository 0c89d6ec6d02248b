//! A run in parts: advanced to a time, or to its next event, and commanded between them.
//!
//! What is advanced to need not be the end of a step: where no input is commanded the last step is made as long as ever,
//! and the state at the time is that of its dense output. So a run does not depend, to the last bit, on the times at which
//! it is looked at. Where inputs are commanded a step ends at the time, since another motion may begin there.

use super::failure::{Reason, Stoppable};
use super::simulation::{Simulation, Stop};
use crate::input::Command;
use crate::integrate::State;
use crate::kernel::with_kernel;
use crate::numerics::Size;
use crate::numerics::{Memory, Persist};
use crate::run::Progress;

/// Why an advance ended where it did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// The time was reached.
    Time,
    /// One or several transitions have happened at one instant, and it was asked to stop there.
    Event,
    /// The same, and infinitely many of them have come to rest.
    Rest,
    /// A limit state was reached at which the run ends.
    Limit,
    /// The problem's own end was reached.
    End,
}

/// How far a run in parts is.
#[derive(Debug, Clone, Default)]
pub(super) enum Stage {
    /// Before its first instant.
    #[default]
    Start,
    /// The mode at the present instant is to be found.
    Settle,
    /// A segment begins.
    Entered,
    /// Between two steps of a segment.
    Between,
    /// After a step that ends its segment, before what happens there.
    Pending(Stop),
    /// At its end.
    Over,
    /// Something has stopped it before its end.
    Failed(Box<Reason>),
}

impl Stage {
    /// Whether a segment was left between two of its steps.
    pub fn is_in_segment(&self) -> bool {
        matches!(self, Stage::Between)
    }

    /// Whether the run does not go on.
    pub fn is_ended(&self) -> bool {
        matches!(self, Stage::Over | Stage::Failed(_))
    }

    /// Whether the last thing that was done is a step.
    pub fn is_after_step(&self) -> bool {
        matches!(self, Stage::Between | Stage::Pending(_))
    }
}

/// The method that made a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) enum MadeBy {
    #[default]
    Taylor,
    RadauOfFive,
    RadauOfSeven,
}

/// Where an advance ends.
#[derive(Debug)]
pub(super) struct Pause {
    /// Steps go on up to here, s; infinite in a run as a whole.
    pub at: f64,
    /// No step leads beyond this, s; infinite where no input is commanded.
    pub knot: f64,
    /// Coordinates and velocities with which the segment that is left has begun; of free ones alone.
    began: [Box<[f64]>; 2],
}

/// The state with which the segment has begun; where the next advance ends it says itself.
impl Persist for Pause {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let [q, v] = &mut self.began;
        memory.slice(q)?;
        memory.slice(v)
    }
}

impl Pause {
    /// Never, with so many coordinates.
    pub fn new(coordinates: usize) -> Self {
        Pause {
            at: f64::INFINITY,
            knot: f64::INFINITY,
            began: [0; 2].map(|_| vec![0.0; coordinates].into()),
        }
    }

    /// The run is one as a whole.
    pub fn never(&mut self) {
        (self.at, self.knot) = (f64::INFINITY, f64::INFINITY);
    }

    /// Keeps the state with which the segment has begun.
    pub fn keep_start<F: Size>(&mut self, free: &[usize], began: &State<F>) {
        let [q, v] = &mut self.began;
        for (i, &full) in free.iter().enumerate() {
            (q[full], v[full]) = (began.q[i], began.v[i]);
        }
    }

    /// That state, at the local time zero; without accelerations.
    pub fn began<F: Size>(&self, size: F, free: &[usize]) -> State<F> {
        let [q, v] = (self.began.each_ref()).map(|full| size.vector(|i| full[free[i]]));
        State {
            q,
            v,
            ..State::origin(size)
        }
    }
}

impl Simulation<'_> {
    /// Advances to a time, s, or to the next event where it is `to_event`, whichever comes first. What happens at the
    /// very time is not done yet.
    pub fn advance_until(
        &mut self,
        time: f64,
        to_event: bool,
        progress: &mut dyn Progress,
    ) -> Result<Stopped, Reason> {
        if let Stage::Failed(reason) = &self.stage {
            return Err((**reason).clone());
        }
        self.pause.at = time;
        if self.signals.are_commanded() {
            // The time advanced to before was the end of steps, and this one is now.
            self.pause.knot = time;
            self.smooth_until = f64::NEG_INFINITY;
        }
        let outcome = self.go_on((to_event, false), progress);
        self.count_work();
        outcome.map_err(|reason| {
            self.stage = Stage::Failed(reason.clone());
            *reason
        })
    }

    /// Goes on to the end of the run.
    pub fn go_on_to_end(&mut self, progress: &mut dyn Progress) -> Result<(), Reason> {
        self.pause.never();
        let outcome = self.go_on((false, true), progress);
        self.count_work();
        outcome.map(drop).map_err(|reason| *reason)
    }

    /// Does one thing after the other until an advance ends. `stays`: events that lead to the same mode again are passed
    /// in one.
    fn go_on(
        &mut self,
        (to_event, stays): (bool, bool),
        progress: &mut dyn Progress,
    ) -> Stoppable<Stopped> {
        let transitions = self.here.j;
        loop {
            if self.observers.recording.wants_checkpoint() && !self.stage.is_ended() {
                self.count_work();
                let checkpoint = self.checkpoint(self.here.now.seconds())?;
                self.observers.recording.checkpoint(checkpoint);
            }
            let now = self.here.now.seconds();
            let (is_there, is_beyond) = (now >= self.pause.at, now > self.pause.at);
            match self.stage {
                Stage::Start => {
                    self.check_energy()?;
                    self.stage = Stage::Settle;
                }
                Stage::Settle => {
                    self.stage = match self.settle()? {
                        true => Stage::Entered,
                        false => Stage::Over,
                    };
                    if to_event && self.here.j > transitions {
                        let rests = self.visited.transitions().any(|name| name == "rest");
                        return Ok(match rests {
                            true => Stopped::Rest,
                            false => Stopped::Event,
                        });
                    }
                }
                // The end of a run at that very time takes none.
                Stage::Pending(Stop::End) if !is_beyond => {
                    self.pass(Stop::End)?;
                    self.stage = Stage::Over;
                }
                Stage::Entered | Stage::Between | Stage::Pending(_) if is_there => {
                    return Ok(Stopped::Time);
                }
                Stage::Entered | Stage::Between => {
                    let mode = self.mode();
                    let stop = with_kernel!(&mode.kernels, k => self.advance(k, stays, progress))?;
                    self.stage = match stop {
                        Stop::Pause => Stage::Between,
                        stop => Stage::Pending(stop),
                    };
                }
                Stage::Pending(stop) => {
                    self.stage = match self.pass(stop)? {
                        true => Stage::Settle,
                        false => Stage::Over,
                    };
                }
                Stage::Over => {
                    return Ok(match self.margins.has_ended() {
                        true => Stopped::Limit,
                        false => Stopped::End,
                    });
                }
                Stage::Failed(_) => unreachable!("what has failed does not go on"),
            }
        }
    }

    /// Commands an input, by its index, from the present instant on; `None`: it cannot be commanded.
    pub fn command(&mut self, input: usize, command: Command) -> Option<()> {
        let now = self.here.now.seconds();
        let changes = self.signals.to_mut().command(input, now, command)?;
        if changes {
            self.context.forget_signals();
            self.smooth_until = f64::NEG_INFINITY;
            self.stage = match std::mem::take(&mut self.stage) {
                // A guard or a condition may be another one at once.
                Stage::Between => Stage::Pending(Stop::Breakpoint),
                Stage::Entered => Stage::Settle,
                stage => stage,
            };
        }
        Some(())
    }

    /// The inputs are those that the run starts with.
    pub fn forget_commands(&mut self) {
        if let std::borrow::Cow::Owned(signals) = &mut self.signals {
            signals.rewind();
            self.context.forget_signals();
        }
    }
}
