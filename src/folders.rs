//! Models from folders: derived, compiled and loaded while the program runs (`dalembert-build`).
//!
//! This runs the folder's `model.py` and the code that is made from it.

use std::path::Path;
use std::sync::Arc;

pub use dalembert_build::{Choices, Error, Options, Sources, Stage, sources};

use crate::kernel::ContractError;
use crate::model::Model;

/// Why there is no model of a folder.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// It could not be built.
    #[error("{0}")]
    Build(Error),
    /// What was built cannot be loaded.
    #[error("{file}: {error}", file = .file.display())]
    Load {
        /// The library.
        file: std::path::PathBuf,
        /// What is wrong with it.
        error: ContractError,
    },
}

/// The model in a folder, with the variants that are asked for. `progress` is told what takes a while; what was built
/// before is loaded at once.
///
/// # Errors
/// [`FolderError`] if it is no model, Python or a compiler is missing, or the cache cannot be written.
pub fn load(
    folder: &Path,
    options: &Options,
    progress: &dyn Fn(Stage),
) -> Result<Arc<Model>, FolderError> {
    let library =
        dalembert_build::library(folder, options, progress).map_err(FolderError::Build)?;
    let model = Model::load(&library.path, Some(&library.digest));
    let model = model.map_err(|error| FolderError::Load {
        file: library.path.clone(),
        error,
    })?;
    Ok(Arc::new(model))
}
