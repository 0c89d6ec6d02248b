//! Who hears how far a simulation is.

use std::ops::ControlFlow;

/// Hears now and then how far a simulation is.
pub trait Progress {
    /// The simulation has reached time `t` (s) after `events` transitions. It is called after every
    /// step, so it must be cheap; `Break` stops the run, which keeps what it has.
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()>;
}

/// Hears and says nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn advance(&mut self, _t: f64, _events: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}
