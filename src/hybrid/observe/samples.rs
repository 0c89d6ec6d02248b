//! Samples of the trajectory.

use super::super::failure::{Reason, Stoppable};
use super::super::simulation::Simulation;
use super::ledger::RunningLedger;
use crate::kernel::with_kernel;
use crate::kernel::{Context, Free, ModeKernel};
use crate::record::{Group, Layout};
use std::ops::ControlFlow;

/// What a row needs besides the state.
pub(super) struct Row<'a> {
    pub layout: &'a Layout,
    pub q: &'a [f64],
    pub v: &'a [f64],
    /// Stored energy is filled in here; the rest of the ledger is given.
    pub ledger: [f64; 4],
}

impl Row<'_> {
    /// Fills a row; the context is set to its time.
    pub fn fill<const F: usize>(
        mut self,
        kernel: &ModeKernel<F>,
        context: &Context,
        at: Free<F>,
        row: &mut [f64],
    ) {
        let n = self.q.len();
        row[..n].copy_from_slice(self.q);
        row[n..2 * n].copy_from_slice(self.v);
        let reactions = self.layout.range(Group::Reaction);
        if !reactions.is_empty() {
            kernel.reactions(context, at, &mut row[reactions]);
        }
        row[self.layout.range(Group::Discrete)].copy_from_slice(context.discrete());
        let energies = self.layout.range(Group::Energy);
        if !energies.is_empty() {
            let [kinetic, potential] = kernel.energies(context, at);
            self.ledger[0] = kinetic + potential;
            row[energies].copy_from_slice(&self.ledger);
        }
        let inputs = self.layout.range(Group::Input);
        if !inputs.is_empty() {
            row[inputs].copy_from_slice(context.signals());
        }
    }
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

/// When samples are due.
#[derive(Debug)]
pub(in crate::hybrid) struct Samples {
    every: Option<f64>,
    /// Index of the next one.
    index: u64,
    /// Its time, s: infinite without a grid, but for the first one.
    next: f64,
}

impl Samples {
    /// From one on, by its index.
    pub fn from(every: Option<f64>, index: u64) -> Self {
        let next = match index {
            0 => 0.0,
            _ => sample_time(every, index),
        };
        Samples { every, index, next }
    }

    /// Time of the next one, s.
    #[inline(always)]
    pub fn next(&self) -> f64 {
        self.next
    }

    /// The next one was recorded.
    pub fn pass(&mut self) {
        *self = Samples::from(self.every, self.index + 1);
    }

    /// Back to the first.
    pub fn rewind(&mut self) {
        *self = Samples::from(self.every, 0);
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
        let row = Row {
            layout: &observers.layout,
            q: &here.q,
            v: &here.v,
            ledger: row_of(observers.ledger.as_ref(), [0.0; 2]),
        };
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = here.free(&mode.free);
            observers.recording.row(t, here.mode, |values| {
                row.fill(k, context, Free { q: &q, v: &v, a: &a }, values)
            })
        })
    }
}
