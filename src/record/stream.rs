//! The files of a run: its tables are written while it goes on, in bounded memory, everything else when it has ended.

use std::path::Path;
use std::time::{Duration, Instant};

use super::folder::{StagedFile, Staging, io_error};
use super::kept::CHECKPOINT;
use super::plot::{Appearance, overview_of, phase_portraits_of};
use super::sketch::Sketch;
use super::summary::SUMMARY;
use super::table::{EVENTS, EventsTable, METADATA, TRAJECTORY, TrajectoryTable, write_metadata};
use super::{FolderError, Kept, Layout, OutputFolder, Summary};
use crate::hybrid::Run;
use crate::run::{Jump, Snapshot};

/// Name of the picture of everything over time, without the format.
pub const OVERVIEW: &str = "overview";
/// Name of the phase portraits, without the format.
pub const PHASE: &str = "phase";

/// Numbers that are written at once: so many that looks at the clock cost nothing, and so few that nobody waits for them.
const AT_ONCE: usize = 8192;

/// The files of a run on their way into a folder. The first row or transition opens them. What cannot be written does not
/// end the run: [`Stream::finish`] says so.
pub struct Stream {
    folder: OutputFolder,
    layout: Layout,
    open: Option<Open>,
    failed: Option<FolderError>,
    /// Rows that are still to be written: time and values of each, and its mode.
    rows: Vec<f64>,
    modes: Vec<usize>,
    /// Transitions that are, and the states before and after each.
    jumps: Vec<Jump>,
    states: Vec<f64>,
    spent: Duration,
    /// The last checkpoint of the run, by which it can be gone on with.
    pub checkpoint: Option<Kept>,
}

/// The tables, which are written at the same time.
struct Open {
    staging: Staging,
    trajectory: TrajectoryTable<StagedFile>,
    events: EventsTable<StagedFile>,
}

impl Stream {
    /// Files of a run with this layout, for a folder.
    pub fn new(folder: &OutputFolder, layout: &Layout) -> Stream {
        Stream {
            folder: folder.clone(),
            layout: layout.clone(),
            open: None,
            failed: None,
            rows: Vec::new(),
            modes: Vec::new(),
            jumps: Vec::new(),
            states: Vec::new(),
            spent: Duration::ZERO,
            checkpoint: None,
        }
    }

    /// Takes a row of the trajectory.
    pub fn row(&mut self, t: f64, mode: usize, values: &[f64]) {
        self.rows.push(t);
        self.rows.extend_from_slice(values);
        self.modes.push(mode);
        self.write_if_due();
    }

    /// Takes a transition, with the states before and after it and its impulses where they are kept.
    pub fn event(&mut self, jump: &Jump, sides: Option<([&Snapshot; 2], &[f64])>) {
        self.jumps.push(*jump);
        if let Some((sides, impulses)) = sides {
            for side in sides {
                self.states.extend(side.values());
            }
            self.states.extend_from_slice(impulses);
        }
        self.write_if_due();
    }

    /// Time that writing took so far.
    pub fn spent(&self) -> Duration {
        self.spent
    }

    fn write_if_due(&mut self) {
        let is_first = self.open.is_none() && self.failed.is_none();
        if is_first || self.rows.len() + self.states.len() + self.jumps.len() >= AT_ONCE {
            self.write();
        }
    }

    /// Writes what there is; what fails is kept for the end.
    fn write(&mut self) {
        let start = Instant::now();
        if self.failed.is_none() {
            self.failed = self.try_to_write().err();
        }
        self.rows.clear();
        self.modes.clear();
        self.jumps.clear();
        self.states.clear();
        self.spent += start.elapsed();
    }

    fn try_to_write(&mut self) -> Result<(), FolderError> {
        let open = match &mut self.open {
            Some(open) => open,
            None => self.open.insert(Open::new(&self.folder, &self.layout)?),
        };
        let width = self.rows.len() / self.modes.len().max(1);
        for (row, &mode) in self.rows.chunks(width.max(1)).zip(&self.modes) {
            let written = open.trajectory.row(row[0], mode, &row[1..]);
            written.map_err(io_error("write", Path::new(TRAJECTORY)))?;
        }
        let width = self.states.len() / self.jumps.len().max(1);
        for (i, jump) in self.jumps.iter().enumerate() {
            let written = open
                .events
                .row(jump, &self.states[i * width..(i + 1) * width]);
            written.map_err(io_error("write", Path::new(EVENTS)))?;
        }
        Ok(())
    }

    /// Writes everything else of the run, with pictures as `appearance` says, and puts all of it in the place of the files of
    /// the last one.
    pub fn finish(
        mut self,
        run: &Run,
        sketch: &Sketch,
        appearance: &Appearance,
    ) -> Result<(), FolderError> {
        self.write();
        if let Some(error) = self.failed {
            return Err(error);
        }
        let Open {
            mut staging,
            trajectory,
            events,
        } = self.open.expect("opened by the first write");
        let trajectory = trajectory.finish();
        staging.close(trajectory.map_err(io_error("write", Path::new(TRAJECTORY)))?)?;
        let events = events.finish();
        staging.close(events.map_err(io_error("write", Path::new(EVENTS)))?)?;
        staging.file(METADATA, |out| write_metadata(run, out))?;
        staging.file(SUMMARY, |out| Summary::new(run).write(out))?;
        if let Some(kept) = &self.checkpoint {
            staging.file(CHECKPOINT, |out| Ok(serde_json::to_writer(out, kept)?))?;
        }
        staging.picture(
            OVERVIEW,
            &overview_of(run, sketch, appearance),
            appearance.formats(),
        )?;
        if let Some(portraits) = phase_portraits_of(run, sketch, appearance) {
            staging.picture(PHASE, &portraits, appearance.formats())?;
        }
        staging.put_in_place()
    }
}

impl Open {
    fn new(folder: &OutputFolder, layout: &Layout) -> Result<Open, FolderError> {
        let mut staging = folder.stage()?;
        let trajectory = TrajectoryTable::new(staging.create(TRAJECTORY)?, layout);
        let events = EventsTable::new(staging.create(EVENTS)?, layout);
        Ok(Open {
            trajectory: trajectory.map_err(io_error("write", Path::new(TRAJECTORY)))?,
            events: events.map_err(io_error("write", Path::new(EVENTS)))?,
            staging,
        })
    }
}

impl Run {
    /// Writes a run that is in memory: the tables, the summary and the pictures. A run that stopped early is
    /// written in the same way, as far as it came, with the reason in the summary.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), FolderError> {
        let mut stream = Stream::new(folder, &self.layout);
        for (i, &t) in self.trajectory.t.iter().enumerate() {
            let mode = self.trajectory.mode[i];
            stream.row(t, mode, self.trajectory.row(i));
        }
        for event in &self.events {
            let sides = ([&event.before, &event.after], &*event.impulses);
            stream.event(&event.jump(), Some(sides));
        }
        stream.finish(self, &Sketch::of(self), &Appearance::default())
    }
}
