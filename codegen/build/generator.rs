//! The generator, which travels inside this crate: Python and C, written into the cache to be run.

use std::borrow::Cow;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use super::cache::{Cache, Compares, Entry, Kind};
use super::error::Error;
use super::files;
use super::fingerprint::Fingerprint;
use super::install::Lock;

/// Variable that names a folder `codegen` to use in place of the one inside: to work on the generator.
pub const SETTING: &str = "DALEMBERT_GENERATOR";

/// Kind of the cache entries that hold generators.
const KIND: Kind = Kind {
    name: "generator",
    compares: Compares::Digests,
};

/// Its package, and so the folder that holds it.
const PACKAGE: &str = "codegen";

/// The files of the generator, by their paths below its folder.
const EMBEDDED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/generator.rs"));

/// The files of the generator, which are not on the disk yet.
pub struct Bundle {
    files: Files,
    /// Digest of all of its files.
    pub digest: String,
    /// The files it was read from, if [`SETTING`] names a folder.
    pub watched: Vec<PathBuf>,
}

impl Bundle {
    /// The generator inside, or the one that [`SETTING`] names.
    pub fn open() -> Result<Self, Error> {
        let (files, watched) = match env::var_os(SETTING).filter(|value| !value.is_empty()) {
            Some(folder) => read(Path::new(&folder))?,
            None => (embedded(), Vec::new()),
        };
        let digest = (files.iter())
            .fold(Fingerprint::default(), |hash, (name, content)| {
                hash.with(name).with(content)
            })
            .finish();
        Ok(Self {
            files,
            digest,
            watched,
        })
    }

    /// The text of one of its files, and a digest of it; nothing of one that it lacks.
    pub fn text(&self, name: &str) -> (Cow<'_, str>, String) {
        let found = self.files.iter().find(|(file, _)| file == name);
        let content = found.map_or(&[][..], |(_, content)| content);
        let digest = Fingerprint::default().with(content).finish();
        (String::from_utf8_lossy(content), digest)
    }

    /// Writes the generator into the cache, where it is not there already.
    pub fn extract(self, cache: &Cache) -> Result<Generator, Error> {
        let entry = cache.entry(KIND, &self.digest, |root| {
            let folder = root.join(PACKAGE);
            for (name, content) in &self.files {
                let path = folder.join(name);
                let parent = path.parent().unwrap_or(&folder);
                fs::create_dir_all(parent).map_err(Error::io("create", parent))?;
                fs::write(&path, content).map_err(Error::io("write", &path))?;
            }
            Ok(())
        })?;
        Ok(Generator {
            root: entry.path.clone(),
            digest: self.digest,
            _entry: entry,
        })
    }
}

/// A generator that can be run.
#[derive(Debug)]
pub struct Generator {
    /// The folder from which Python imports the package `codegen`.
    pub root: PathBuf,
    /// Digest of all of its files.
    pub digest: String,
    _entry: Entry,
}

impl Generator {
    /// Its lock file.
    pub fn lock(&self) -> Result<Lock, Error> {
        Lock::read(self.file("requirements.lock"))
    }

    /// A file of it: `file("lanes.c")`.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    /// The folder of its package.
    pub fn folder(&self) -> PathBuf {
        self.root.join(PACKAGE)
    }
}

/// Names below the generator's folder, and contents.
type Files = Vec<(String, Cow<'static, [u8]>)>;

fn embedded() -> Files {
    let file = |&(name, content): &(&str, &'static [u8])| (name.to_owned(), content.into());
    EMBEDDED.iter().map(file).collect()
}

/// The generator in a folder, and the files that were read.
fn read(folder: &Path) -> Result<(Files, Vec<PathBuf>), Error> {
    let setting = |error: std::io::Error| Error::Setting {
        name: SETTING,
        value: folder.display().to_string(),
        problem: error.to_string(),
        advice:
            "let it name the folder codegen of a source tree, or unset it: the generator is inside"
                .to_owned(),
    };
    let paths = files::of_generator(folder).map_err(setting)?;
    let mut files = Files::new();
    for path in &paths {
        let name = path.strip_prefix(folder).unwrap_or(path);
        let name: Vec<_> = name.iter().map(|part| part.to_string_lossy()).collect();
        let content = fs::read(path).map_err(Error::io("read", path))?;
        files.push((name.join("/"), content.into()));
    }
    Ok((files, paths))
}

#[cfg(test)]
mod tests {
    use super::EMBEDDED;

    #[test]
    fn the_generator_inside_is_whole_and_has_no_tests() {
        let has = |name: &str| EMBEDDED.iter().any(|(found, _)| *found == name);
        for name in [
            "__main__.py",
            "model.py",
            "lanes.c",
            "lanes.h",
            "requirements.lock",
            "verify/cli.py",
            "verify/examples/tank/paper.py",
        ] {
            assert!(has(name), "{name}");
        }
        for (name, _) in EMBEDDED {
            assert!(!name.contains("tests/"), "{name}");
            assert!(!name.ends_with(".rs") && !name.ends_with(".pyc"), "{name}");
        }
    }
}
