//! From a model folder, wherever it is, to a shared library, while a program runs.
//!
//! What was made is found again by content, without Python and without a compiler being started: the model's
//! Python files and what else its derivation read, the generator, the target, the compiler (by its file) and the flags.
//!
//! | folder in the cache | key | holds |
//! |---|---|---|
//! | `models` | Python files of the model, generator, target | choices, and what else was read: [`Index`] |
//! | `derived` | that, contents of what was read, the variants | the C |
//! | `shared` | that, compiler, flags | the library |

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use super::cache::{Cache, Compares, Entry, Kind};
use super::error::Error;
use super::fingerprint::Fingerprint;
use super::generate::{self, Generated};
use super::generator::Bundle;
use super::index::{Combination, Index};
use super::install::Environment;
use super::link;
use super::model::Model;

/// Kinds of the cache entries.
const DERIVED: Kind = Kind {
    name: "derived",
    compares: Compares::Digests,
};
const SHARED: Kind = Kind {
    name: "shared",
    compares: Compares::Digests,
};

/// Which variants a library has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Choices {
    /// Every combination of the model's choices.
    All,
    /// The one that has these options, by the names of choices, and the defaults for others. Names of no choice
    /// are passed over, and where no combination has the options it is the one of the defaults: the library lists all
    /// of them, so that its user can say what is wrong where it was written.
    Fitting(BTreeMap<String, String>),
}

/// What a library is made for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Options {
    /// The variants.
    pub choices: Choices,
    /// Whether it has functions for trajectories side by side: these take several times longer to compile.
    pub lanes: bool,
}

/// What is being done, where it takes a while.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Python packages are installed.
    Installing,
    /// The equations are derived.
    Deriving,
    /// C is compiled.
    Compiling,
}

/// A model as a shared library. It stays in the cache for as long as this is held.
#[derive(Debug)]
pub struct Library {
    /// Name of the model, which is that of its folder.
    pub name: String,
    /// The library.
    pub path: PathBuf,
    /// The digest inside: of all that the code was made from.
    pub digest: String,
    /// The folder of its C, for the curious.
    pub sources: PathBuf,
    _entry: Entry,
}

/// The library of a model folder, from the cache or made now.
pub fn library(
    folder: &Path,
    options: &Options,
    progress: &dyn Fn(Stage),
) -> Result<Library, Error> {
    let model = Model::at(folder)?;
    let cache = Cache::of_user()?.ok_or(Error::NoCache)?;
    let bundle = Bundle::open()?;
    let key = model.key(&bundle)?;
    let derived = match model.find(&cache, &key, options)? {
        Some(derived) => derived,
        None => {
            // Of several processes that want it at once one derives it, and the others find it.
            let _lock = cache.lock(DERIVED, &key)?;
            match model.find(&cache, &key, options)? {
                Some(derived) => derived,
                None => model.derive(&cache, bundle, &key, options, progress)?,
            }
        }
    };
    let shared = link::key(&derived.digest, options.lanes);
    let entry = match cache.find(SHARED, &shared)? {
        Some(entry) => entry,
        None => {
            progress(Stage::Compiling);
            let generator = Bundle::open()?.extract(&cache)?;
            let generated = derived.read(&model)?;
            let entry = cache.entry(SHARED, &shared, |out| {
                link::library(&generated, &generator, options.lanes, out)
            })?;
            cache.evict(cache.limit())?;
            entry
        }
    };
    Ok(Library {
        path: entry.path.join(link::file(&model.name)),
        name: model.name,
        digest: derived.digest,
        sources: derived.entry.path,
        _entry: entry,
    })
}

/// Derived C in the cache.
struct Derived {
    digest: String,
    entry: Entry,
}

impl Derived {
    fn read(&self, model: &Model) -> Result<Generated, Error> {
        let origin = model.folder.display().to_string();
        let folder = self.entry.path.join(&model.name);
        generate::read(&model.name, &origin, &folder, self.digest.clone())
    }
}

impl Model {
    /// What was derived before from the same.
    fn find(&self, cache: &Cache, key: &str, options: &Options) -> Result<Option<Derived>, Error> {
        let Some(index) = Index::read(cache, key) else {
            return Ok(None);
        };
        let combination = index.combination(&options.choices);
        let digest = self.digest(key, &index.read, combination);
        let entry = cache.find(DERIVED, &format!("{}-{digest}", self.name))?;
        Ok(entry.map(|entry| Derived { digest, entry }))
    }

    /// Digest of all that derived code was made from.
    fn digest(&self, key: &str, read: &[PathBuf], combination: Combination) -> String {
        let mut hash = Fingerprint::default().with(key).with(combination.text());
        for name in read {
            // A file that is gone is as good as another content.
            let content = fs::read(self.absolute.join(name)).map_or(vec![0], |mut content| {
                content.insert(0, 1);
                content
            });
            hash = hash.with(name.as_os_str().as_encoded_bytes()).with(content);
        }
        hash.finish()
    }

    /// Derives it. The lock of the key is held.
    fn derive(
        &self,
        cache: &Cache,
        bundle: Bundle,
        key: &str,
        options: &Options,
        progress: &dyn Fn(Stage),
    ) -> Result<Derived, Error> {
        let generator = bundle.extract(cache)?;
        let lock = generator.lock()?;
        let environment = Environment::provide(&lock, cache, || progress(Stage::Installing))?;
        progress(Stage::Deriving);
        let staging = cache.staging(DERIVED, key)?;
        let mut flags = vec!["--reads".to_owned()];
        if let Choices::Fitting(named) = &options.choices {
            flags.push("--only".to_owned());
            for (choice, option) in named {
                flags.push(format!("--only={choice}={option}"));
            }
        }
        let directory = env::current_dir().map_err(Error::io("find", Path::new(".")))?;
        let result = generate::run(
            &directory,
            (&self.name, &self.absolute),
            flags.iter().map(String::as_str),
            &generator,
            &environment,
            &staging,
        );
        let made = result.and_then(|()| {
            let folder = staging.join(&self.name);
            let index = Index::of(&folder, &self.folder)?;
            let digest = self.digest(key, &index.read, index.combination(&options.choices));
            let entry = cache.entry(DERIVED, &format!("{}-{digest}", self.name), |out| {
                let to = out.join(&self.name);
                fs::rename(&folder, &to).map_err(Error::io("create", &to))
            })?;
            index.write(cache, key)?;
            Ok(Derived { digest, entry })
        });
        cache.unstage(DERIVED, key)?;
        made
    }
}
