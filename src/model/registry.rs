//! The models that are linked into a program, by name.

use super::Model;
use crate::kernel::{self, ContractError, RawModel};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Models by name; each is read when it is first asked for.
pub struct Models {
    linked: BTreeMap<&'static str, &'static RawModel>,
    read: Mutex<BTreeMap<&'static str, Arc<Model>>>,
}

/// The models that come with this crate.
///
/// # Panics
/// If the program was put together from parts of different versions.
pub fn models() -> &'static Models {
    static MODELS: OnceLock<Models> = OnceLock::new();
    MODELS.get_or_init(|| {
        let models = Models::of(kernel::linked_models());
        models.unwrap_or_else(|error| panic!("a model that is linked into the program: {error}"))
    })
}

impl Models {
    /// What a build linked.
    ///
    /// # Errors
    /// [`ContractError`] if a model is of another version.
    pub fn of(linked: &'static [&'static RawModel]) -> Result<Self, ContractError> {
        let named = linked
            .iter()
            .map(|raw| Ok((kernel::name_of_linked(raw)?, *raw)));
        Ok(Models {
            linked: named.collect::<Result<_, _>>()?,
            read: Mutex::default(),
        })
    }

    /// The names, in their order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.linked.keys().copied()
    }

    /// The model of a name.
    ///
    /// # Panics
    /// If what was generated for it is not as the contract says, which its version rules out.
    pub fn find(&self, name: &str) -> Option<Arc<Model>> {
        let (name, raw) = self.linked.get_key_value(name)?;
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let model = read.entry(name).or_insert_with(|| {
            let model = kernel::linked(raw);
            Arc::new(model.unwrap_or_else(|error| panic!("the model `{name}`: {error}")))
        });
        Some(model.clone())
    }

    /// All of them, in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = Arc<Model>> {
        self.names().filter_map(|name| self.find(name))
    }
}

impl fmt::Debug for Models {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}
