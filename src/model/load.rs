//! From a compiled model to a [`Model`]: linked into the program, or loaded from a shared library.

use super::{Model, description};
use crate::kernel::{ContractError, RawModel, open, parts_of_linked};
use std::path::Path;

impl Model {
    /// Loads a model from a shared library.
    ///
    /// The library is code: what it does when it is loaded, and what its functions do, no check can tell. Mark,
    /// version and digest are compared before anything in it is called. The caller answers for the file being the one that was
    /// compiled from generated code: a cache compares its digest.
    ///
    /// # Errors
    /// [`ContractError`] if it is no library of this system, no model, of another version, or not made from what
    /// `digest` tells, if that is given.
    pub fn load(file: &Path, digest: Option<&str>) -> Result<Model, ContractError> {
        let (parts, library) = open(file, digest)?;
        description::model(&parts, Some(library), false)
    }
}

/// A model that is linked into the program; `dynamic`: what serves any number of free coordinates serves the small ones,
/// too.
///
/// # Errors
/// [`ContractError`] if it is of another version.
pub(crate) fn linked(raw: &'static RawModel, dynamic: bool) -> Result<Model, ContractError> {
    description::model(&parts_of_linked(raw)?, None, dynamic)
}
