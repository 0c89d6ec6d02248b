//! The progress of a simulation as a line on the terminal.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::clock::SparseClock;
use crate::run::Progress;

/// A line on the standard error that shows the progress; nothing where that is no terminal. The
/// line goes away with the value.
#[derive(Debug)]
pub struct ProgressLine {
    bar: ProgressBar,
    end: f64,
    looks: SparseClock,
    /// When the line was last brought up to date.
    drawn: Option<Instant>,
}

/// Steps of the bar: more than a terminal has columns.
const STEPS: u64 = 1000;

/// Time between two updates of the line: an eye does not follow more.
const REFRESH: Duration = Duration::from_millis(50);

impl ProgressLine {
    /// The progress of a simulation up to time `end` (s).
    pub fn new(end: f64) -> ProgressLine {
        let style = ProgressStyle::with_template("{bar:30} {msg}  {elapsed}, {eta} to go");
        let bar = ProgressBar::new(STEPS).with_style(style.expect("the template is well-formed"));
        ProgressLine {
            bar,
            end,
            looks: SparseClock::new(),
            drawn: None,
        }
    }
}

impl Progress for ProgressLine {
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()> {
        let Some(now) = self.looks.due() else {
            return ControlFlow::Continue(());
        };
        if self.drawn.is_some_and(|drawn| now < drawn + REFRESH) {
            return ControlFlow::Continue(());
        }
        self.drawn = Some(now);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_any_length_show() {
        for step in [Duration::ZERO, Duration::from_millis(30)] {
            let mut line = ProgressLine::new(1.0);
            let begin = Instant::now();
            let (mut t, mut shown) = (0.0, Vec::new());
            while begin.elapsed() < 4 * REFRESH {
                std::thread::sleep(step);
                t = begin.elapsed().as_secs_f64();
                let _ = line.advance(t, 0);
                shown.push(line.bar.position());
            }
            shown.dedup();
            // Up to date to two refreshes, and brought up to date no more often than that.
            let late = t - shown[shown.len() - 1] as f64 / STEPS as f64;
            assert!(
                late <= 2.0 * REFRESH.as_secs_f64() + step.as_secs_f64(),
                "{late}"
            );
            assert!((2..=5).contains(&shown.len()), "{shown:?}");
        }
    }
}
