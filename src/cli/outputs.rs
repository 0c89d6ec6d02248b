//! What `dalembert run` makes of a run while it goes on.

use std::ops::ControlFlow;

use super::interrupt;
use crate::hybrid::{Observer, Reason, Replay};
use crate::record::{
    Earlier, Event, Jump, Layout, OutputFolder, ReadError, Sketch, Snapshot, Stream,
};

/// The files of a run, what its pictures are drawn from, and its transitions, each where it is wanted.
pub struct Outputs {
    pub stream: Option<Stream>,
    pub sketch: Option<Sketch>,
    /// The window of time that pictures show, s.
    window: Option<(f64, f64)>,
    jumps: Vec<Jump>,
    /// So many transitions are kept.
    kept: usize,
}

/// Why an earlier run cannot be gone on with.
pub enum NotReplayed {
    /// It cannot be read.
    Unread(ReadError),
    /// It is not one of this problem.
    Other(Reason),
}

impl Outputs {
    /// Outputs to a folder, where there is one; a sketch for that, of which pictures show a `window` of time (s), or for a
    /// `page`; the first transitions, as many as are `compared`.
    pub fn new(
        layout: &Layout,
        folder: Option<&OutputFolder>,
        (page, window): (bool, Option<(f64, f64)>),
        compared: usize,
    ) -> Outputs {
        Outputs {
            stream: folder.map(|folder| Stream::new(folder, layout)),
            sketch: (folder.is_some() || page).then(|| Sketch::new(layout)),
            window,
            jumps: Vec::new(),
            kept: compared,
        }
    }

    /// The transitions that were kept, without their states.
    pub fn events(&self) -> Vec<Event> {
        let event = |jump: &Jump| Event::new(jump, Default::default());
        self.jumps.iter().map(event).collect()
    }

    /// Takes the rows and transitions of a run that is to go on.
    pub fn replay(
        &mut self,
        earlier: &mut Earlier,
        replay: &mut Replay,
    ) -> Result<(), NotReplayed> {
        if let Some(sketch) = &mut self.sketch {
            sketch.lacks_points();
        }
        let mut other = None;
        let rows = earlier.rows(|t, mode, values| {
            replay.row((t, mode, values), self).map_err(|reason| {
                let words = reason.to_string();
                other = Some(reason);
                words
            })
        });
        match (rows, other) {
            (_, Some(reason)) => return Err(NotReplayed::Other(reason)),
            (rows, None) => rows.map_err(NotReplayed::Unread)?,
        }
        replay.end(self);
        let events = earlier.events(|jump, sides| self.event(jump, Some(sides)));
        events.map_err(NotReplayed::Unread)
    }
}

impl Observer for Outputs {
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()> {
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

    fn event(&mut self, jump: &Jump, sides: Option<&[Snapshot; 2]>) {
        let sides = sides.map(|[before, after]| [before, after]);
        if let Some(stream) = &mut self.stream {
            stream.event(jump, sides);
        }
        if let Some(sketch) = &mut self.sketch {
            sketch.event(jump, sides);
        }
        if self.jumps.len() < self.kept {
            self.jumps.push(*jump);
        }
    }
}
