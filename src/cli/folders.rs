//! What the commands share that are given model folders.

use super::outcome::Failure;
use super::print;
use dalembert_build::{Error, Stage};

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Models(_) | Error::Folder { .. } | Error::ModelName { .. } => {
                Failure::wrong_input(error)
            }
            _ => Failure::system(error),
        }
    }
}

/// Says on the standard error what takes a while.
pub fn progress(stage: Stage) {
    print::error(match stage {
        Stage::Installing => "installing the Python packages (once; about 110 MB)",
        Stage::Deriving => "deriving the equations",
        Stage::Compiling => "compiling",
    });
}
