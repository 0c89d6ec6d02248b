//! Text for the terminal, or for a pipe that somebody may close before its end.

use std::fmt::Display;
use std::io::{self, Write};

use super::outcome::Failure;

/// Writes to the standard output. A reader that has seen enough (`| head`) is no failure.
pub fn output(text: impl Display) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::system(format!(
            "cannot write to the standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Writes to the standard error; there is nowhere to report that it is closed.
pub fn error(text: impl Display) {
    let _ = writeln!(io::stderr(), "{text}");
}
