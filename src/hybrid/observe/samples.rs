//! Samples of the trajectory.

use super::interpolants::Polynomial;
use super::ledger::RunningLedger;
use super::{Observers, Part, Sampled, Step};
use crate::hybrid::contact::hold;
use crate::hybrid::equations::Equations;
use crate::hybrid::failure::{Reason, Stoppable};
use crate::hybrid::guards;
use crate::hybrid::instant::Instant;
use crate::hybrid::outputs::Outputs;
use crate::hybrid::simulation::{Here, Simulation};
use crate::kernel::with_kernel;
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::{Contacts, Mode};
use crate::numerics::{Memory, Persist};
use crate::numerics::{Size, Vector};
use crate::run::{ColumnKind, Layout};
use std::ops::ControlFlow;

/// What a row needs besides the state.
pub(super) struct RowSource<'a> {
    pub layout: &'a Layout,
    pub q: &'a [f64],
    pub v: &'a [f64],
    /// The discrete states that are recorded, by their indices.
    pub discretes: &'a [usize],
    /// Evaluates outputs, with the mode.
    pub outputs: (&'a mut Outputs, &'a Mode),
    /// Stored energy is filled in here; the rest of the ledger is given.
    pub ledger: [f64; 4],
}

impl RowSource<'_> {
    /// Fills a row; the context is set to its time.
    pub fn fill<F: Size>(
        mut self,
        kernel: &ModeKernel<F>,
        context: &Context,
        at: Free<F>,
        row: &mut [f64],
    ) {
        let n = self.layout.coordinates.len();
        row[..n].copy_from_slice(&self.q[..n]);
        row[n..2 * n].copy_from_slice(&self.v[..n]);
        let reactions = self.layout.range(ColumnKind::Reaction);
        if has_reactions(self.layout, self.outputs.1) {
            self.outputs
                .0
                .reactions(kernel, context, at, &mut row[reactions]);
        }
        let discrete = self.layout.range(ColumnKind::Discrete);
        for (into, &i) in row[discrete].iter_mut().zip(self.discretes) {
            *into = context.discrete()[i];
        }
        let outputs = self.layout.range(ColumnKind::Output);
        if !outputs.is_empty() {
            self.outputs
                .0
                .evaluate(kernel, context, at, &mut row[outputs]);
        }
        let energies = self.layout.range(ColumnKind::Energy);
        if !energies.is_empty() {
            let [kinetic, potential] = kernel.energies(context, at);
            self.ledger[0] = kinetic + potential;
            row[energies].copy_from_slice(&self.ledger);
        }
        let inputs = self.layout.range(ColumnKind::Input);
        if !inputs.is_empty() {
            row[inputs].copy_from_slice(context.signals());
        }
    }
}

/// Whether reactions are recorded that a mode has: of a free coordinate there is none.
pub(super) fn has_reactions(layout: &Layout, mode: &Mode) -> bool {
    let n = layout.coordinates.len();
    layout.reactions.len() > mode.free.iter().filter(|&&i| i < n).count()
}

/// The ledger's entries of a row, with the work since it was brought up to date and without the stored energy; zero where no ledger is kept.
pub(super) fn row_of(ledger: Option<&RunningLedger>, work: [f64; 2]) -> [f64; 4] {
    ledger.map_or([0.0; 4], |ledger| ledger.row(0.0, work))
}

/// Time of a sample of the grid, s; infinite without a grid.
pub(in crate::hybrid) fn sample_time(every: Option<f64>, index: u64) -> f64 {
    match every {
        Some(_) if index == 0 => 0.0,
        Some(every) => index as f64 * every,
        None => f64::INFINITY,
    }
}

/// Points that a curve has in a step: a line between two of them is off by (4/32)²/8 = 0.2 % of the amplitude of an
/// oscillation, 4 rad of which are about the longest step that any method takes (0.45 % where rows make the distance
/// 1.5 times as long).
const POINTS: f64 = 32.0;
/// Points that a curve has in the time of a run, at most: some on each pixel of a screen, also after a zoom.
const POINTS_OF_A_RUN: f64 = 5000.0;

/// Points of curves, between the rows.
#[derive(Debug)]
pub(super) struct Points {
    /// The window of time that is looked at closely, s.
    window: Option<[f64; 2]>,
    /// Those of a step before, in and after the window.
    grids: [Grid; 3],
    /// The next one in local time, and half of the distance to the one that follows it, s.
    next: f64,
    margin: f64,
    /// When the last one or the last row was, s.
    last: f64,
}

/// Evenly spaced points in a part of a step, in local time, s.
#[derive(Debug, Clone, Copy, Default)]
struct Grid {
    /// The first one, and the end, at which there is none: the next grid or step begins there, or it is an event, which has rows of
    /// its own.
    first: f64,
    end: f64,
    /// From one point to the next.
    spacing: f64,
}

impl Points {
    /// None yet; in the window, if there is one, there are as many as else in the time of a run.
    pub fn new(window: Option<[f64; 2]>) -> Self {
        Points {
            window,
            grids: Default::default(),
            next: f64::INFINITY,
            margin: 0.0,
            last: f64::NEG_INFINITY,
        }
    }

    /// Those of a step between two local times that begins at time `t`, with rows at these intervals, which are points as
    /// well: between two of them there are so many that their distance is nearest to that of a grid without rows. The run
    /// ends at time `end`, if not before. All in s.
    pub fn enter(&mut self, [from, to]: [f64; 2], t: f64, every: Option<f64>, end: f64) {
        let [opens, closes] = self.window.unwrap_or([f64::INFINITY; 2]);
        let local = |time: f64| (from + (time - t)).clamp(from, to);
        let borders = [from, local(opens), local(closes), to];
        for (k, grid) in self.grids.iter_mut().enumerate() {
            let [begins, ends] = [borders[k], borders[k + 1]];
            let shown = if k == 1 { closes - opens } else { end };
            let (of_part, least) = ((ends - begins) / POINTS, shown / POINTS_OF_A_RUN);
            let wanted = of_part.max(least);
            let every = every.unwrap_or(f64::INFINITY);
            let spacing = match every < f64::INFINITY {
                true => every / (every / wanted).round().max(1.0),
                false => wanted,
            };
            // The border of the window is a point, too.
            let first = match begins == from {
                true => from + of_part.max(self.last + least - t),
                false => begins,
            };
            *grid = Grid {
                first: match spacing < every {
                    true => first,
                    false => f64::INFINITY,
                },
                end: ends,
                spacing,
            };
        }
        self.follow(f64::NEG_INFINITY);
    }

    /// The next one is that which follows a local time, s; infinite where there is none.
    fn follow(&mut self, point: f64) {
        let next = |grid: &Grid| grid.first.max(point + grid.spacing);
        let grid = self.grids.iter().find(|grid| next(grid) < grid.end);
        let found = grid.map(|grid| (next(grid), grid.spacing / 2.0));
        (self.next, self.margin) = found.unwrap_or((f64::INFINITY, 0.0));
    }

    /// Local time of the next one, s, if it comes before a row, by more than half of a distance: else the row is the point.
    fn next_before(&self, row: f64) -> Option<f64> {
        (self.next + self.margin < row).then_some(self.next)
    }

    /// One was told, or a row, for a local time and this time, s.
    fn pass(&mut self, tau: f64, t: f64) {
        self.last = t;
        self.follow(tau);
    }
}

/// When samples are due.
#[derive(Debug)]
pub(in crate::hybrid) struct Samples {
    every: Option<f64>,
    /// Whether anybody sees them.
    seen: bool,
    /// Index of the next one.
    index: u64,
    /// Its time, s: infinite without a grid, but for the first one, and where nobody sees it.
    next: f64,
}

impl Persist for Samples {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.index.persist(memory)?;
        self.go_to(self.index);
        Some(())
    }
}

impl Samples {
    /// From the first one on; none where they are not `seen`.
    pub fn new(every: Option<f64>, seen: bool) -> Self {
        let (index, next) = (0, 0.0);
        let mut samples = Samples {
            every,
            seen,
            index,
            next,
        };
        samples.go_to(0);
        samples
    }

    /// The next one is that of an index.
    pub fn go_to(&mut self, index: u64) {
        self.index = index;
        self.next = match index {
            _ if !self.seen => f64::INFINITY,
            0 => 0.0,
            _ => sample_time(self.every, index),
        };
    }

    /// Time of the next one, s.
    #[inline(always)]
    pub fn next(&self) -> f64 {
        self.next
    }

    /// The next one was recorded.
    pub fn pass(&mut self) {
        self.go_to(self.index + 1);
    }

    /// Back to the first.
    pub fn rewind(&mut self) {
        self.go_to(0);
    }
}

/// A state of a step's dense output, with what contacts and constraints hold brought back to where they hold it.
#[cold]
pub(in crate::hybrid) fn held<F: Size>(
    equations: &mut Equations<F>,
    contacts: &Contacts,
    tau: f64,
    [mut q, mut v, a]: [F::Vector; 3],
) -> [F::Vector; 3] {
    equations.at(tau);
    hold(
        equations.context,
        contacts,
        [q.as_mut_slice(), v.as_mut_slice()],
    );
    let a = equations.acceleration_here(&q, &v).unwrap_or(a);
    [q, v, a]
}

impl Observers<'_> {
    /// Local time of the next sample or point of curves, if one is due up to local time `to`, and whether it is a point.
    pub(super) fn due<F: Size>(&self, equations: &Equations<F>, to: f64) -> Option<(f64, bool)> {
        let next = self.samples.next();
        let sample = match next < f64::INFINITY {
            true => Instant::new(next).since(equations.clock.start),
            false => f64::INFINITY,
        };
        let point = self.points.next_before(sample);
        let tau = point.unwrap_or(sample);
        (tau <= to).then_some((tau, point.is_some()))
    }

    /// Records the samples that are due in a part of a step.
    pub(super) fn sample<F: Size>(
        &mut self,
        step: &mut Step<F>,
        part: Part,
        work: Option<&[Polynomial; 2]>,
    ) -> ControlFlow<Sampled> {
        let to = match part.is_last {
            true => step.end + step.beyond,
            false => part.to,
        };
        while let Some((tau, is_point)) = self.due(step.equations, to) {
            let equations = &mut *step.equations;
            let [q, v, a] = guards::motion(
                equations,
                step.motion,
                tau,
                self.needs_accelerations(step.mode),
            );
            let (mode, here) = (step.mode, &mut *step.here);
            let [q, v, a] = match &mode.contacts {
                Some(contacts) => held(equations, contacts, tau, [q, v, a]),
                None => [q, v, a],
            };
            here.set_free(&mode.free, [&q, &v, &a]);
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            if !equations.clock.drift.is_empty() {
                here.set_all(equations.kernel, equations.context, at);
            }
            let place = (tau - part.from) / (part.to - part.from);
            let work = work.map_or([0.0; 2], |work| work.each_ref().map(|w| w.value(place)));
            let row = RowSource {
                layout: &self.layout,
                q: &here.q,
                v: &here.v,
                discretes: &self.discretes,
                outputs: (&mut self.outputs, mode),
                ledger: row_of(self.ledger.as_ref(), work),
            };
            let (kernel, context) = (equations.kernel, &*equations.context);
            let fill = |values: &mut [f64]| row.fill(kernel, context, at, values);
            if is_point {
                let t = equations.clock.start.plus(tau).seconds();
                self.recording.point(t, here.shown, fill);
                self.points.pass(tau, t);
                continue;
            }
            let t = self.samples.next();
            let flow = self.recording.row(t, here.shown, fill);
            self.samples.pass();
            if self.recording.sees_points {
                self.points.pass(tau, t);
            }
            if flow.is_break() {
                let from = part.from;
                return ControlFlow::Break(Sampled { from, tau, t });
            }
        }
        ControlFlow::Continue(())
    }

    /// Records the state at the end of a step, whose time the context is set for.
    pub fn sample_end<F: Size>(
        &mut self,
        equations: &Equations<F>,
        (mode, here): (&Mode, &Here),
        at: Free<F>,
    ) -> ControlFlow<()> {
        let row = RowSource {
            layout: &self.layout,
            q: &here.q,
            v: &here.v,
            discretes: &self.discretes,
            outputs: (&mut self.outputs, mode),
            ledger: row_of(self.ledger.as_ref(), [0.0; 2]),
        };
        let (kernel, context) = (equations.kernel, &*equations.context);
        let fill = |values: &mut [f64]| row.fill(kernel, context, at, values);
        self.recording.row(here.now.seconds(), here.shown, fill)
    }
}

impl Simulation<'_> {
    /// Whether a sample up to the present instant is not recorded yet.
    #[inline(always)]
    pub fn has_sample_left(&self) -> bool {
        self.observers.samples.next() <= self.here.now.seconds().min(self.problem.end.time)
    }

    /// Records the samples up to the present instant that no segment has covered: the first one,
    /// and those that an accumulation left out.
    #[inline(always)]
    pub fn flush_samples(&mut self) -> Stoppable<()> {
        while self.has_sample_left() {
            let flow = match self.problem.record.every {
                None => self.sample_here(),
                Some(_) => self.sample_at(self.observers.samples.next()),
            };
            self.observers.samples.pass();
            if flow.is_break() {
                return Err(Box::new(Reason::Interrupted));
            }
        }
        Ok(())
    }

    /// Records the present state.
    pub fn sample_here(&mut self) -> ControlFlow<()> {
        self.sample_at(self.here.now.seconds())
    }

    fn sample_at(&mut self, t: f64) -> ControlFlow<()> {
        let mode = self.mode();
        let Simulation {
            observers,
            here,
            context,
            ..
        } = self;
        let row = RowSource {
            layout: &observers.layout,
            q: &here.q,
            v: &here.v,
            discretes: &observers.discretes,
            outputs: (&mut observers.outputs, mode),
            ledger: row_of(observers.ledger.as_ref(), [0.0; 2]),
        };
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = here.free(k.size(), &mode.free);
            observers.recording.row(t, here.shown, |values| {
                row.fill(k, context, Free { q: &q, v: &v, a: &a }, values)
            })
        })
    }
}
