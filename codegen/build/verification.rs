//! The verification of printed equations (codegen/verify), which is Python: with the generator inside and an interpreter
//! that is found when it runs.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::cache::{Cache, Compares, Entry, Kind};
use super::error::Error;
use super::fingerprint::Fingerprint;
use super::generator::{Bundle, Generator};
use super::install::Environment;
use super::library::Stage;

/// Kind of the cache entries that hold what a program has in it of models and scenes.
const KIND: Kind = Kind {
    name: "shipped",
    compares: Compares::Digests,
};

/// A verification that is ready to run.
#[derive(Debug)]
pub struct Verification {
    /// Runs it; its arguments follow. Relative paths in them are below [`Verification::folder`].
    pub command: Command,
    /// Where it runs: the folder of what was shipped.
    pub folder: PathBuf,
    _generator: Generator,
    _environment: Environment,
    _shipped: Entry,
}

/// Makes ready to run the verification in a folder with the files that are `shipped`, names and contents: models in `models`,
/// scenes in `scenes`. `progress` is told when packages must be installed.
pub fn verification(
    shipped: &[(&Path, &[u8])],
    progress: &dyn Fn(Stage),
) -> Result<Verification, Error> {
    let cache = Cache::of_user()?.ok_or(Error::NoCache)?;
    let generator = Bundle::open()?.extract(&cache)?;
    let lock = generator.lock()?;
    let environment = Environment::provide(&lock, &cache, || progress(Stage::Installing))?;
    let digest = shipped
        .iter()
        .fold(Fingerprint::default(), |hash, (name, content)| {
            hash.with(name.as_os_str().as_encoded_bytes()).with(content)
        });
    let shipped = cache.entry(KIND, &digest.finish(), |folder| {
        for (name, content) in shipped {
            let path = folder.join(name);
            let parent = path.parent().unwrap_or(folder);
            fs::create_dir_all(parent).map_err(Error::io("create", parent))?;
            fs::write(&path, content).map_err(Error::io("write", &path))?;
        }
        Ok(())
    })?;
    let mut command = environment.command();
    command
        .current_dir(&generator.root)
        .args(["-m", "codegen", "--directory"])
        .arg(&shipped.path)
        .arg("verify");
    Ok(Verification {
        command,
        folder: shipped.path.clone(),
        _generator: generator,
        _environment: environment,
        _shipped: shipped,
    })
}
