//! The progress of a simulation.

use std::ops::ControlFlow;

use indicatif::{ProgressBar, ProgressStyle};

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

/// A line on the standard error that shows the progress; nothing where that is no terminal. The
/// line goes away with the value.
#[derive(Debug)]
pub struct ProgressLine {
    bar: ProgressBar,
    end: f64,
    calls: u32,
}

/// Steps of the bar: more than a terminal has columns.
const STEPS: u64 = 1000;

/// Calls between two looks at the line: some thousand steps take about a millisecond.
const STRIDE: u32 = 4096;

impl ProgressLine {
    /// The progress of a simulation up to time `end` (s).
    pub fn new(end: f64) -> ProgressLine {
        let style = ProgressStyle::with_template("{bar:30} {msg}  {elapsed}, {eta} to go");
        let bar = ProgressBar::new(STEPS).with_style(style.expect("the template is well-formed"));
        ProgressLine { bar, end, calls: 0 }
    }
}

impl Progress for ProgressLine {
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()> {
        self.calls = (self.calls + 1) % STRIDE;
        if self.calls != 0 {
            return ControlFlow::Continue(());
        }
        self.bar.set_position((t / self.end * STEPS as f64) as u64);
        self.bar
            .set_message(format!("t = {t:.4} of {} s, {events} events", self.end));
        ControlFlow::Continue(())
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
