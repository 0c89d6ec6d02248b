//! What is told of a run while it is computed, and to whom.

use super::super::checkpoint::Checkpoint;
use super::super::problem::Problem;
use crate::run::{Jump, Layout, Recorder, Sides, Trajectory};
use std::ops::ControlFlow;

/// Hears of a run as it goes on: of rows of samples and of transitions, and, if it wants, of every step with its
/// dense output. What it makes of them the engine does not know; it keeps nothing of them itself.
pub trait Observer {
    /// A row of the trajectory at time `t` (s), in a mode by its index, laid out as [`Layout::range`] says. `Break`
    /// ends the run at this row.
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()>;

    /// Whether [`Observer::row`] is to be called; asked once, before the run. Rows that nobody sees are not computed.
    fn sees_rows(&self) -> bool {
        true
    }

    /// A transition, with the states (coordinates, rates, discrete states, reactions) before and after it and its impulses where
    /// [`crate::hybrid::Record::event_states`] asks for them.
    fn event(&mut self, jump: &Jump, sides: Option<&Sides>);

    /// Whether [`Observer::point`] is to be called; asked once, before the run.
    fn sees_points(&self) -> bool {
        false
    }

    /// The window of time, s, in which curves are looked at: it has as many points as else a whole run; asked once, before the run.
    fn window(&self) -> Option<[f64; 2]> {
        None
    }

    /// A point of the dense output between rows, laid out as a row: as many a step as a curve needs to look like one,
    /// where rows are further apart than that.
    fn point(&mut self, _t: f64, _mode: usize, _values: &[f64]) {}

    /// Whether [`Observer::step`] is to be called; asked once, before the run.
    fn sees_steps(&self) -> bool {
        false
    }

    /// A step that was made.
    fn step(&mut self, _step: &mut MadeStep) {}

    /// Whether [`Observer::wants_checkpoint`] is to be called; asked once, before the run.
    fn keeps_checkpoints(&self) -> bool {
        false
    }

    /// Whether a checkpoint is wanted; asked between steps, until one is taken.
    fn wants_checkpoint(&mut self) -> bool {
        false
    }

    /// A checkpoint: the rows and transitions that were told so far are those before it.
    fn checkpoint(&mut self, _checkpoint: Checkpoint) {}
}

/// Fills in coordinates and velocities at a time.
pub(super) type StateAt<'s> = dyn FnMut(f64, &mut [f64], &mut [f64]) + 's;

/// A step that was made, up to its first event if it has one, with its dense output.
pub struct MadeStep<'s> {
    /// When it begins, s.
    pub from: f64,
    /// When it ends, s.
    pub to: f64,
    /// Index of its mode.
    pub mode: usize,
    pub(super) state: &'s mut StateAt<'s>,
}

impl MadeStep<'_> {
    /// All coordinates and velocities at time `t`, s, from [`MadeStep::from`] to [`MadeStep::to`].
    pub fn state_at(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) {
        (self.state)(t, q, v);
    }
}

impl<O: Observer + ?Sized> Observer for &mut O {
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()> {
        (**self).row(t, mode, values)
    }
    fn sees_rows(&self) -> bool {
        (**self).sees_rows()
    }
    fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        (**self).event(jump, sides);
    }
    fn sees_points(&self) -> bool {
        (**self).sees_points()
    }
    fn window(&self) -> Option<[f64; 2]> {
        (**self).window()
    }
    fn point(&mut self, t: f64, mode: usize, values: &[f64]) {
        (**self).point(t, mode, values);
    }
    fn sees_steps(&self) -> bool {
        (**self).sees_steps()
    }
    fn step(&mut self, step: &mut MadeStep) {
        (**self).step(step);
    }
    fn keeps_checkpoints(&self) -> bool {
        (**self).keeps_checkpoints()
    }
    fn wants_checkpoint(&mut self) -> bool {
        (**self).wants_checkpoint()
    }
    fn checkpoint(&mut self, checkpoint: Checkpoint) {
        (**self).checkpoint(checkpoint);
    }
}

/// Keeps all rows and transitions in memory.
#[derive(Debug)]
pub struct Collected {
    recorder: Recorder,
    jumps: Vec<Jump>,
    /// States before and after each of them, where they are kept.
    sides: Vec<Sides>,
}

impl Collected {
    /// Nothing yet of a problem, with room for all rows on the grid of its samples.
    pub fn new(problem: &Problem, layout: &Layout) -> Self {
        let every = problem.record.every;
        let rows = every.map_or(0, |every| Recorder::grid_rows(problem.end.time, every));
        Collected {
            recorder: Recorder::new(layout, rows + 1),
            jumps: Vec::new(),
            sides: Vec::new(),
        }
    }

    /// Forgets everything, and keeps the room.
    pub(super) fn clear(&mut self) {
        self.recorder.clear();
        self.jumps.clear();
        self.sides.clear();
    }

    /// The transitions so far.
    pub fn jumps(&self) -> &[Jump] {
        &self.jumps
    }

    /// Adds a transition without its states.
    pub(in crate::hybrid) fn push(&mut self, jump: Jump) {
        self.jumps.push(jump);
    }

    /// Trajectory, transitions, and their states.
    pub(super) fn into_parts(self) -> (Trajectory, Vec<Jump>, Vec<Sides>) {
        (self.recorder.finish(), self.jumps, self.sides)
    }
}

impl Observer for Collected {
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()> {
        let fill = |row: &mut [f64]| row.copy_from_slice(values);
        self.recorder.push_row(t, mode, fill);
        ControlFlow::Continue(())
    }

    fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        self.jumps.push(*jump);
        self.sides.extend(sides.cloned());
    }
}
