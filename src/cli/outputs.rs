//! What `dalembert run` makes of a run while it goes on.

use std::ops::ControlFlow;
use std::time::Duration;

use super::checkpoints::Checkpoints;
use super::interrupt;
use crate::hybrid::{Checkpoint, Observer, Problem, check_row};
use crate::record::{
    Earlier, Event, Jump, Kept, Layout, OutputFolder, ReadError, Sides, Sketch, Stream, Tally,
};

/// The files of a run, what its pictures are drawn from, and its transitions, each where it is wanted.
pub struct Outputs {
    pub stream: Option<Stream>,
    pub sketch: Option<Sketch>,
    /// The window of time that pictures show, s.
    window: Option<(f64, f64)>,
    jumps: Vec<Jump>,
    /// So many transitions are kept.
    compared: usize,
    pub checkpoints: Checkpoints,
}

impl Outputs {
    /// Outputs of a run to this end (s) to a folder, where there is one; a sketch for that, of which pictures show a `window` of time (s), or for a
    /// `page`; the first transitions, as many as are `compared`.
    pub fn new(
        (layout, end): (&Layout, f64),
        folder: Option<&OutputFolder>,
        (page, window): (bool, Option<(f64, f64)>),
        compared: usize,
    ) -> Outputs {
        Outputs {
            stream: folder.map(|folder| Stream::new(folder, layout)),
            sketch: (folder.is_some() || page).then(|| Sketch::new(layout)),
            window,
            jumps: Vec::new(),
            compared,
            checkpoints: Checkpoints::new(end),
        }
    }

    /// The transitions that were kept, without their states.
    pub fn events(&self) -> Vec<Event> {
        let event = |jump: &Jump| Event::new(jump, Default::default());
        self.jumps.iter().map(event).collect()
    }

    /// Time that writing files took so far.
    pub fn spent(&self) -> Duration {
        let stream = self.stream.as_ref();
        stream.map_or(Duration::ZERO, Stream::spent)
    }

    /// Takes the rows and transitions of a run before the checkpoint from which it goes on, if it has one; gives the tally of
    /// these transitions. All rows but the last, which is where the run has ended, must be where the problem has them.
    pub fn replay(
        &mut self,
        problem: &Problem,
        earlier: &mut Earlier,
        kept: Option<&Kept>,
    ) -> Result<Tally, ReadError> {
        let (rows, events) = kept.map_or((0, 0), |kept| (kept.rows, kept.events));
        if let (Some(sketch), Some(_)) = (&mut self.sketch, kept) {
            sketch.lacks_points();
        }
        let (mut row, mut before) = (0, None);
        earlier.rows(|t, mode, values| {
            if let Some(before) = before.replace(t) {
                check_row(problem, row - 1, before).map_err(|reason| reason.to_string())?;
            }
            if row < rows {
                // Nothing is simulated yet that could end here.
                let _ = self.row(t, mode, values);
            }
            row += 1;
            Ok(())
        })?;
        let (mut event, mut tally) = (0, Tally::default());
        earlier.events(|jump, sides| {
            if event < events {
                self.event(jump, Some(sides));
                tally.note(jump);
            }
            event += 1;
        })?;
        Ok(tally)
    }
}

impl Observer for Outputs {
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()> {
        self.checkpoints.rows += 1;
        if let Some(stream) = &mut self.stream {
            stream.row(t, mode, values);
        }
        if let Some(sketch) = &mut self.sketch {
            sketch.row(t, values);
        }
        match interrupt::asked() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Of a run without files there is nothing to go on with.
    fn keeps_checkpoints(&self) -> bool {
        self.stream.is_some()
    }

    fn wants_checkpoint(&mut self) -> bool {
        self.checkpoints.is_due()
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) {
        let spent = self.spent();
        self.checkpoints.take(checkpoint, spent);
    }

    /// Without files and pictures nobody does.
    fn sees_rows(&self) -> bool {
        self.stream.is_some() || self.sketch.is_some()
    }

    fn sees_points(&self) -> bool {
        self.sketch.is_some()
    }

    fn window(&self) -> Option<[f64; 2]> {
        self.window.map(<[f64; 2]>::from)
    }

    fn point(&mut self, t: f64, _mode: usize, values: &[f64]) {
        if let Some(sketch) = &mut self.sketch {
            sketch.point(t, values);
        }
    }

    fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        let states = sides.map(|sides| [&sides.before, &sides.after]);
        let impulses = sides.map_or(&[][..], |sides| &sides.impulses);
        self.checkpoints.events += 1;
        if let Some(stream) = &mut self.stream {
            stream.event(jump, states.map(|states| (states, impulses)));
        }
        if let Some(sketch) = &mut self.sketch {
            sketch.event(jump, states);
        }
        if self.jumps.len() < self.compared {
            self.jumps.push(*jump);
        }
    }
}
