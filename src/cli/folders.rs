//! What the commands share that may be given model folders.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::outcome::Failure;
use super::print;
use crate::folders::{self, Choices, Error, FolderError, Options, Stage};
use crate::model::{FolderRefused, Model, Models};

/// Whether models are built from folders; `--no-build` says that they are not.
static BUILDS: AtomicBool = AtomicBool::new(true);

/// Refuses folders from now on.
pub fn refuse() {
    BUILDS.store(false, Ordering::Relaxed);
}

/// Which variants a command needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// That of the scene.
    One,
    /// All.
    All,
}

/// The models that scenes may name: those of the program, and folders.
pub fn models(needs: Needs) -> Models {
    models_seen(needs, |_| ())
}

/// The same; `seen` hears of every folder that is named, before it is read.
pub fn models_seen(needs: Needs, seen: impl Fn(&Path) + Send + Sync + 'static) -> Models {
    Models::linked().with_folders(move |folder, named| {
        seen(folder);
        let choices = match needs {
            Needs::One => Choices::Fitting(named.clone()),
            Needs::All => Choices::All,
        };
        load(folder, choices).map_err(|failure| {
            let text = failure.to_string();
            let text = text.trim_start_matches("error: ");
            let (message, help) = text.split_once("\nto do: ").unwrap_or((text, ""));
            FolderRefused {
                message: message.to_owned(),
                help: (!help.is_empty()).then(|| help.to_owned()),
            }
        })
    })
}

/// The model in a folder, or that of a name. A name comes first: without a slash a folder is one that no model is called.
pub fn find(
    model: &str,
    named: BTreeMap<String, String>,
) -> std::result::Result<Arc<Model>, Failure> {
    let folder = Path::new(model);
    match super::models::find(model) {
        Err(_) if Models::is_folder(model) || folder.join("model.py").is_file() => {
            load(folder, Choices::Fitting(named))
        }
        found => found,
    }
}

fn load(folder: &Path, choices: Choices) -> std::result::Result<Arc<Model>, Failure> {
    if !BUILDS.load(Ordering::Relaxed) {
        return Err(Failure::wrong_input(format!(
            "{}: --no-build refuses models from folders: they run their model.py and the code made from it\n\
             to do: name a model of the program, or leave --no-build out",
            folder.display()
        )));
    }
    let options = Options {
        choices,
        lanes: false,
    };
    Ok(folders::load(folder, &options, &progress)?)
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::Build(error) => error.into(),
            FolderError::Load { .. } => Failure::wrong_input(error),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            // What the system refused; all others say what is to be changed, or installed.
            Error::Io { .. } | Error::NoCache => Failure::system(error),
            _ => Failure::wrong_input(error),
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
