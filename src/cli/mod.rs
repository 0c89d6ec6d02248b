//! The command line.

mod run;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// The input is wrong; nothing was written.
const WRONG_INPUT: u8 = 2;
/// The simulation stopped early; what was computed is written.
const STOPPED_EARLY: u8 = 3;

#[derive(Debug, Parser)]
#[command(
    version,
    about = "Simulates mechanical systems that stick, slip, rock and impact"
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Simulates a scene and writes tables and plots
    Run(run::RunArguments),
}

/// Runs the command of the process's arguments.
pub fn main() -> ExitCode {
    match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
    }
}
