//! Ctrl-C, and inputs that change under a run: a simulation ends at its next step or row and keeps what it has.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use super::outcome::Failure;
use crate::record::Progress;

/// Whether a signal asked the process to end.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether the run that goes on is of an input that has changed since.
static OUTDATED: AtomicBool = AtomicBool::new(false);

/// Whether no simulation goes on any more that could end early.
static LEFT: AtomicBool = AtomicBool::new(false);

/// What a shell reports for a process that SIGINT ended: 128 + 2.
const ENDED_BY_SIGNAL: i32 = 130;

/// The answer to the first signal.
const HEARD: &str = "interrupted: it ends with what was computed; Ctrl-C again ends it at once";

/// From here on SIGINT (Ctrl-C), SIGTERM and SIGHUP end simulations early instead of the process.
/// A second signal ends the process at once, and so does any after [`leave`].
pub fn listen() -> Result<(), Failure> {
    static LISTENS: AtomicBool = AtomicBool::new(false);
    LEFT.store(false, Ordering::Relaxed);
    if LISTENS.swap(true, Ordering::Relaxed) {
        return Ok(());
    }
    let on_signal = || {
        if ASKED.swap(true, Ordering::Relaxed) || LEFT.load(Ordering::Relaxed) {
            process::exit(ENDED_BY_SIGNAL);
        }
        // Files and pictures of what there is may take longer than one likes to wait for an answer. Where nobody reads it any
        // more it ends all the same.
        let _ = writeln!(io::stderr(), "{HEARD}");
    };
    ctrlc::set_handler(on_signal)
        .map_err(|error| Failure::system(format!("cannot listen to Ctrl-C: {error}")))
}

/// The simulations have ended: from here on a signal ends the process, wherever it is.
pub fn leave() {
    LEFT.store(true, Ordering::Relaxed);
}

/// The input is read anew.
pub fn up_to_date() {
    OUTDATED.store(false, Ordering::Relaxed);
}

/// The input of the run that goes on has changed: it ends at its next step or row.
pub fn outdate() {
    OUTDATED.store(true, Ordering::Relaxed);
}

/// Whether a signal asked the process to end.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Progress that ends a simulation where a signal asks for it, or its input has changed.
pub struct Interruptible<P>(pub P);

impl<P: Progress> Progress for Interruptible<P> {
    fn advance(&mut self, t: f64, events: u64) -> ControlFlow<()> {
        if asked() || OUTDATED.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        self.0.advance(t, events)
    }
}
