//! The models that are linked into a program, by name.

use super::Model;
use super::load;
use crate::kernel::{self, ContractError, RawModel};
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Models by name, each read when it is first asked for; and, if somebody makes them, models from folders.
pub struct Models {
    linked: BTreeMap<&'static str, &'static RawModel>,
    read: Mutex<BTreeMap<&'static str, Arc<Model>>>,
    folders: Option<Box<FromFolder>>,
    dynamic: bool,
}

/// Makes the model of a folder. The second argument holds what a scene may mean for its choices, by name: options of those
/// that it has.
pub type FromFolder =
    dyn Fn(&Path, &BTreeMap<String, String>) -> Result<Arc<Model>, FolderRefused> + Send + Sync;

/// Why there is no model of a folder.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct FolderRefused {
    /// What is wrong, and where.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}

/// The models that the build script of the calling crate linked, which calls `dalembert_build::models()`: those in the
/// folder `models` of that crate, as [`Models`].
///
/// ```ignore
/// let models = dalembert::models!();
/// let scene = Scene::load(Path::new("scenes/upright.json"), &[], &models)?;
/// ```
///
/// The models that come with dalembert are not among them: `Models::linked().and(dalembert::models!())?` has both.
///
/// # Panics
/// If the program was put together from parts of different versions.
#[macro_export]
macro_rules! models {
    () => {
        $crate::model::Models::of_build($crate::linked!())
    };
}

/// Two crates have a model of one name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "two crates of the program have a model `{name}`; rename one of the folders, or keep the two sets of models apart"
)]
pub struct SameName {
    /// The name.
    pub name: &'static str,
}

/// The models that come with this crate.
///
/// # Panics
/// If the program was put together from parts of different versions.
pub fn models() -> &'static Models {
    static MODELS: OnceLock<Models> = OnceLock::new();
    MODELS.get_or_init(Models::linked)
}

impl Models {
    /// As [`models()`], to which more can be added.
    ///
    /// # Panics
    /// As [`models()`].
    pub fn linked() -> Models {
        Models::of_build(kernel::linked_models())
    }

    /// What the build of a crate linked: see [`crate::models!`].
    ///
    /// # Panics
    /// If a model is of another version of the contract.
    #[doc(hidden)]
    pub fn of_build(linked: &'static [&'static RawModel]) -> Models {
        let models = Models::of(linked);
        models.unwrap_or_else(|error| panic!("a model that is linked into the program: {error}"))
    }

    /// These models and those of another crate.
    ///
    /// # Errors
    /// [`SameName`] if both have a model of one name: neither hides the other.
    pub fn and(self, other: Models) -> Result<Models, SameName> {
        let mut linked = self.linked;
        for (name, raw) in other.linked {
            if linked.insert(name, raw).is_some() {
                return Err(SameName { name });
            }
        }
        Ok(Models {
            linked,
            read: Mutex::default(),
            folders: self.folders.or(other.folders),
            dynamic: self.dynamic || other.dynamic,
        })
    }

    /// The same, with models from folders.
    pub fn with_folders(
        self,
        make: impl Fn(&Path, &BTreeMap<String, String>) -> Result<Arc<Model>, FolderRefused>
        + Send
        + Sync
        + 'static,
    ) -> Models {
        Models {
            folders: Some(Box::new(make)),
            ..self
        }
    }

    /// The same models, whose modes all go by what serves any number of free coordinates: the same bits, and slower.
    #[must_use]
    pub fn with_dynamic_sizes(self) -> Models {
        Models {
            dynamic: true,
            read: Mutex::default(),
            ..self
        }
    }

    /// Whether a name is that of a folder: anything with a slash is.
    pub fn is_folder(name: &str) -> bool {
        name.contains('/') || cfg!(windows) && name.contains('\\')
    }

    /// The model of a folder.
    ///
    /// # Errors
    /// [`FolderRefused`] if it has none, or nobody here makes models from folders.
    pub fn from_folder(
        &self,
        folder: &Path,
        named: &BTreeMap<String, String>,
    ) -> Result<Arc<Model>, FolderRefused> {
        let Some(make) = &self.folders else {
            return Err(FolderRefused {
                message: "models from folders are not built here".to_owned(),
                help: Some("name a model that is linked into the program".to_owned()),
            });
        };
        make(folder, named)
    }

    fn of(linked: &'static [&'static RawModel]) -> Result<Self, ContractError> {
        let named = linked
            .iter()
            .map(|raw| Ok((kernel::name_of_linked(raw)?, *raw)));
        Ok(Models {
            linked: named.collect::<Result<_, _>>()?,
            read: Mutex::default(),
            folders: None,
            dynamic: false,
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
            let model = load::linked(raw, self.dynamic);
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
