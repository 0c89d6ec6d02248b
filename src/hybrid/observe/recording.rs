//! Where rows and transitions go.

use super::super::accumulation::Accumulation;
use super::super::checkpoint::Checkpoint;
use super::super::problem::Problem;
use super::observer::{Collected, MadeStep, Observer};
use crate::model::name::intern;
use crate::numerics::{Memory, Persist};
use crate::run::{Event, Jump, Layout, Sides, Tally, Trajectory};
use std::ops::ControlFlow;

/// What rows and transitions are told to, one of them.
enum To<'o> {
    /// Memory.
    Collected(Collected),
    /// An observer from outside.
    Observer(Box<dyn Observer + 'o>),
}

/// The rows and transitions of a run on their way to who wants them.
pub(in crate::hybrid) struct Recording<'o> {
    to: To<'o>,
    /// Whether the observer sees rows, steps, and points between rows.
    pub sees_rows: bool,
    pub sees_steps: bool,
    pub sees_points: bool,
    /// Whether it is asked for wanting checkpoints.
    keeps_checkpoints: bool,
    /// Whether the run is so near its end that one with a later end would not be the same here.
    is_near_end: bool,
    /// The window of time that it looks at closely, s.
    pub window: Option<[f64; 2]>,
    /// Room for a row.
    row: Box<[f64]>,
    /// Time of the last one, s.
    last: Option<f64>,
    /// What was counted of the transitions that an observer was told of.
    tally: Tally,
    /// The last of these, as many as an accumulation is recognised by.
    recent: Vec<&'static str>,
}

/// The time of the last row, and the names of the last transitions; those in memory are only the ones that follow.
impl Persist for Recording<'_> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.last.persist(memory)?;
        let mut recent: Vec<String> = self.recent().into_iter().rev().map(String::from).collect();
        memory.list(&mut recent, String::new)?;
        if memory.is_read() {
            if let To::Collected(collected) = &mut self.to {
                collected.clear();
            }
            self.recent = recent.iter().map(|name| intern(name)).collect();
        }
        Some(())
    }
}

impl<'o> Recording<'o> {
    /// Into memory.
    pub fn collected(problem: &Problem, layout: &Layout) -> Self {
        Self::new(To::Collected(Collected::new(problem, layout)), layout)
    }

    /// To an observer.
    pub fn told(observer: &'o mut dyn Observer, layout: &Layout) -> Self {
        Recording {
            sees_rows: observer.sees_rows(),
            sees_steps: observer.sees_steps(),
            sees_points: observer.sees_points(),
            keeps_checkpoints: observer.keeps_checkpoints(),
            window: observer.window(),
            ..Self::new(To::Observer(Box::new(observer)), layout)
        }
    }

    fn new(to: To<'o>, layout: &Layout) -> Self {
        Recording {
            to,
            sees_rows: true,
            sees_steps: false,
            sees_points: false,
            keeps_checkpoints: false,
            is_near_end: false,
            window: None,
            row: vec![0.0; layout.columns().len()].into(),
            last: None,
            tally: Tally::default(),
            recent: Vec::new(),
        }
    }

    /// Goes on after transitions of which the observer was told.
    pub fn go_on(&mut self, tally: Tally) {
        self.tally = tally;
    }

    /// A step is shaped by the end of the run.
    pub fn nears_end(&mut self) {
        self.is_near_end = true;
    }

    /// Whether the observer wants a checkpoint, and one would be that of a run with a later end, too.
    #[inline(always)]
    pub fn wants_checkpoint(&mut self) -> bool {
        self.keeps_checkpoints
            && !self.is_near_end
            && match &mut self.to {
                To::Collected(_) => false,
                To::Observer(observer) => observer.wants_checkpoint(),
            }
    }

    /// A checkpoint.
    pub fn checkpoint(&mut self, checkpoint: Checkpoint) {
        if let To::Observer(observer) = &mut self.to {
            observer.checkpoint(checkpoint);
        }
    }

    /// Forgets what is in memory.
    pub fn rewind(&mut self) {
        if let To::Collected(collected) = &mut self.to {
            collected.clear();
        }
        self.recent.clear();
        self.last = None;
        self.is_near_end = false;
    }

    /// A row, which `fill` fills.
    pub fn row(&mut self, t: f64, mode: usize, fill: impl FnOnce(&mut [f64])) -> ControlFlow<()> {
        self.row.fill(0.0);
        fill(&mut self.row);
        self.last = Some(t);
        match &mut self.to {
            To::Collected(collected) => collected.row(t, mode, &self.row),
            To::Observer(observer) => observer.row(t, mode, &self.row),
        }
    }

    /// A point between rows, which `fill` fills.
    pub fn point(&mut self, t: f64, mode: usize, fill: impl FnOnce(&mut [f64])) {
        if let To::Observer(observer) = &mut self.to {
            self.row.fill(0.0);
            fill(&mut self.row);
            observer.point(t, mode, &self.row);
        }
    }

    /// Time of the last row, s.
    pub fn last_row(&self) -> Option<f64> {
        self.last
    }

    /// A transition.
    pub fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        match &mut self.to {
            To::Collected(collected) => collected.event(jump, sides),
            To::Observer(observer) => {
                self.tally.note(jump);
                if self.recent.len() == Accumulation::MEMORY {
                    self.recent.remove(0);
                }
                self.recent.push(jump.transition);
                observer.event(jump, sides);
            }
        }
    }

    /// A transition in memory, without its states.
    #[inline(always)]
    pub fn push(&mut self, jump: Jump) {
        if let To::Collected(collected) = &mut self.to {
            collected.push(jump);
        }
    }

    /// A step.
    pub fn step(&mut self, step: &mut MadeStep) {
        if let To::Observer(observer) = &mut self.to {
            observer.step(step);
        }
    }

    /// The transitions so far that are in memory.
    pub fn jumps(&self) -> &[Jump] {
        match &self.to {
            To::Collected(collected) => collected.jumps(),
            To::Observer(_) => &[],
        }
    }

    /// Names of the last transitions, at most as many as an accumulation is recognised by, the latest first.
    pub fn recent(&self) -> Vec<&'static str> {
        let of_memory = self.jumps().iter().rev().take(Accumulation::MEMORY);
        let of_memory = of_memory.map(|jump| jump.transition);
        let all = of_memory.chain(self.recent.iter().rev().copied());
        all.take(Accumulation::MEMORY).collect()
    }

    /// Rows and transitions as far as they are in memory, and the tally of all.
    pub fn finish(self, layout: &Layout) -> (Trajectory, Vec<Event>, Tally) {
        let To::Collected(collected) = self.to else {
            let columns = layout.columns();
            let none = Trajectory {
                columns,
                ..Trajectory::default()
            };
            return (none, Vec::new(), self.tally);
        };
        let (trajectory, jumps, sides) = collected.into_parts();
        let tally = Tally::of(jumps.iter().copied());
        let sides = sides.into_iter();
        let sides = sides.chain(std::iter::repeat_with(Default::default));
        let events = jumps.iter().zip(sides);
        let events = events.map(|(jump, sides)| Event::new(jump, sides));
        (trajectory, events.collect(), tally)
    }
}

impl std::fmt::Debug for Recording<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Recording").finish_non_exhaustive()
    }
}
