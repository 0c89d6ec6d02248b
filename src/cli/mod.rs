//! The command line: one module a command, and what they share.
//!
//! | status | meaning |
//! |---|---|
//! | 0 | done |
//! | 1 | the system failed: a file could not be written, Python did not run |
//! | 2 | the input is wrong; nothing was written |
//! | 3 | a simulation stopped early; what was computed is written, with the reason |
//!
//! Results go to the standard output, errors and progress to the standard error.

mod cache;
mod check;
mod checkpoints;
mod compare;
mod describe;
mod folders;
mod fragility;
mod interrupt;
mod models;
mod motion;
mod new;
mod outcome;
mod outputs;
mod page;
mod pictures;
mod precision;
mod print;
mod room;
mod run;
mod schema;
mod study;
mod table;
mod verify;
mod warnings;
mod watch;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(
    version,
    about = "Simulates mechanical systems that stick, slip, rock and impact",
    after_help = "Exit status: 0 done; 1 the system failed; 2 the input is wrong and nothing was \
                  written; 3 a simulation stopped early and what was computed is written."
)]
struct Arguments {
    /// Refuse models from folders: a scene that names one runs its model.py and the code made from it
    #[arg(long, global = true)]
    no_build: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Simulate a scene; write tables and plots
    Run(run::RunArguments),
    /// Simulate a scene under every variant of its model; show them side by side
    Compare(compare::CompareArguments),
    /// Run a scene by every method at every tolerance; show time against error
    Precision(precision::PrecisionArguments),
    /// Show what ground-motion records hold: peaks, intensity, spectra
    Motion(motion::MotionArguments),
    /// Vary a scene: sweeps, Monte Carlo, stripes, incremental dynamic analysis, critical values
    Study(study::StudyArguments),
    /// Fit a fragility curve to a table of runs or capacities
    Fragility(fragility::FragilityArguments),
    /// Make a model folder to start from
    New(new::NewArguments),
    /// Say what is wrong with a model folder, or what the model is
    Check(check::CheckArguments),
    /// List the models
    Models(models::ModelsArguments),
    /// Show what a model offers: parameters, modes, guards, transitions, reactions, cost
    Describe(describe::DescribeArguments),
    /// Print the format of scenes as a JSON Schema
    Schema(schema::SchemaArguments),
    /// Show, limit or clear what is kept of models that were built
    Cache(cache::CacheArguments),
    /// Judge the hand-written equations of a model against its energies
    Verify(verify::VerifyArguments),
}

/// Runs the command of the process's arguments.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if arguments.no_build {
        folders::refuse();
    }
    let result = match arguments.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Precision(arguments) => precision::precision(&arguments),
        Command::Motion(arguments) => motion::motion(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Fragility(arguments) => fragility::fragility(&arguments),
        Command::New(arguments) => new::new(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Models(arguments) => models::models(&arguments),
        Command::Describe(arguments) => describe::describe(&arguments),
        Command::Schema(arguments) => schema::schema(&arguments),
        Command::Cache(arguments) => cache::cache(&arguments),
        Command::Verify(arguments) => verify::verify(&arguments),
    };
    outcome::exit_code(result)
}
