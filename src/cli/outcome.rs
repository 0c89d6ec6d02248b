//! How a command ends, and the exit status that says so.

use std::fmt::{self, Display};
use std::io::{self, IsTerminal};
use std::process::ExitCode;

use super::print;
use crate::record::FolderError;
use crate::scene::{SceneError, SceneErrors};

/// How a command ended that had a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All of it was done.
    Done,
    /// A simulation stopped early; what was computed is written.
    StoppedEarly,
}

/// Why a command has no result: a text for the terminal, and whose fault it is.
#[derive(Debug)]
pub enum Failure {
    /// The input is wrong; nothing was written.
    WrongInput(String),
    /// The system refused something that the input has a right to.
    System(String),
    /// Another program has said what failed.
    Reported {
        /// Whether the input is wrong.
        wrong_input: bool,
    },
}

/// The result of a command.
pub type Result = std::result::Result<Outcome, Failure>;

impl Failure {
    /// The input is wrong, in a sentence.
    pub fn wrong_input(what: impl Display) -> Failure {
        Failure::WrongInput(format!("error: {what}"))
    }

    /// The system refused something, in a sentence.
    pub fn system(what: impl Display) -> Failure {
        Failure::System(format!("error: {what}"))
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Failure::WrongInput(message) | Failure::System(message) => f.write_str(message),
            Failure::Reported { .. } => Ok(()),
        }
    }
}

impl From<SceneErrors> for Failure {
    fn from(errors: SceneErrors) -> Self {
        Failure::WrongInput(errors.render(io::stderr().is_terminal()))
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        SceneErrors::from(error).into()
    }
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::Io { .. } => Failure::system(error),
            _ => Failure::wrong_input(error),
        }
    }
}

/// Says on the standard error what failed, if something did.
pub fn say(result: &Result) {
    if let Err(Failure::WrongInput(message) | Failure::System(message)) = result {
        print::error(message);
    }
}

/// Says what failed, and gives the exit status.
pub fn exit_code(result: Result) -> ExitCode {
    say(&result);
    ExitCode::from(match result {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::StoppedEarly) => 3,
        Err(Failure::WrongInput(_) | Failure::Reported { wrong_input: true }) => 2,
        Err(Failure::System(_) | Failure::Reported { wrong_input: false }) => 1,
    })
}
