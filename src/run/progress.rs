//! Who hears how far a simulation is.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// Hears now and then how far a simulation is.
pub trait Progress {
    /// The simulation has reached time `t` (s) after `events` transitions. It is called after every
    /// step, so it must be cheap; `Break` stops the run, which keeps what it has.
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()>;
}

/// Stops a run when a flag becomes true.
#[derive(Debug, Clone, Copy)]
pub struct Until<'s>(pub &'s AtomicBool);

impl Until<'_> {
    /// Whether the flag is true.
    pub fn is_reached(self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Progress for Until<'_> {
    fn advance(&mut self, _t: f64, _events: u64) -> ControlFlow<()> {
        match self.is_reached() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// Hears and says nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn advance(&mut self, _t: f64, _events: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}
