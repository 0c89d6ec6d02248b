//! Names of models, coordinates, modes and the like: each kept once, for the life of the process.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

/// The text that is kept for all that read alike. Errors and results hold names without a model, and compare them
/// often; there are few, however often models are loaded.
pub fn intern(text: &str) -> &'static str {
    static NAMES: Mutex<Option<HashSet<&'static str>>> = Mutex::new(None);
    // A set is whole between any two insertions.
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    let names = names.get_or_insert_default();
    if let Some(known) = names.get(text) {
        return known;
    }
    let kept: &'static str = Box::leak(text.into());
    names.insert(kept);
    kept
}
