//! C that was generated before and is part of a crate, which then builds without Python: in its folder `generated`.
//!
//! A build with [`SETTING`] writes it, once for all platforms. It is taken as long as it is what would be generated: its
//! digest is that of the models, of the generator and of the crate's name and version.

use std::env;
use std::fs;
use std::path::Path;

use serde_json::Value;
use sha2::{Digest, Sha256};

use super::cache;
use super::error::Error;
use super::generate::{self, Generated, Model};
use super::generator::Generator;
use super::owner::Owner;

/// Variable that has a build write the folder.
pub const SETTING: &str = "DALEMBERT_PREGENERATE";

/// The folder.
pub const FOLDER: &str = "generated";

/// File with the digest of what a model was generated from, and the manifest of the files beside it.
const DIGEST: &str = "digest";
const MANIFEST: &str = "manifest.json";

/// Whether the folder is to be written.
pub fn is_wanted() -> bool {
    env::var_os(SETTING).is_some_and(|value| !value.is_empty())
}

/// What a crate has in the folder.
#[derive(Debug)]
pub enum Packaged {
    /// All of its models, as they would be generated.
    Whole(Vec<Generated>),
    /// Not all of them; with what is wrong with those that are there.
    Unfit(Vec<String>),
}

/// What a crate has of its models.
pub fn find(
    project: &Path,
    models: &[Model],
    owner: &Owner,
    generator: &Generator,
) -> Result<Packaged, Error> {
    let (mut whole, mut reasons) = (Vec::new(), Vec::new());
    for model in models {
        let folder = project.join(FOLDER).join(&model.name);
        if folder.is_dir() {
            let digest = generate::digest(project, model, owner, generator)?;
            match read(model, &folder, digest) {
                Ok(generated) => whole.push(generated),
                Err(reason) => reasons.push(format!("{FOLDER}/{}: {reason}", model.name)),
            }
        }
    }
    Ok(match whole.len() == models.len() {
        true => Packaged::Whole(whole),
        false => Packaged::Unfit(reasons),
    })
}

/// The C of a model, or why it is not what would be generated.
fn read(model: &Model, folder: &Path, digest: String) -> Result<Generated, String> {
    let made_from = fs::read_to_string(folder.join(DIGEST)).unwrap_or_default();
    if made_from.trim() != digest {
        return Err(
            "made from other files, by another dalembert-build, or for a crate of another name or version".to_owned(),
        );
    }
    let generated = generate::read(&model.name, &model.folder, folder, digest);
    let generated = generated.map_err(|error| error.to_string())?;
    match is_whole(folder, &generated) {
        true => Ok(generated),
        false => Err("its files were changed since they were generated".to_owned()),
    }
}

/// Why models cannot be generated, where C that was generated before does not fit.
pub fn explain(reasons: Vec<String>, cause: Error) -> Error {
    match reasons.is_empty() {
        true => cause,
        false => Error::Packaged {
            reasons,
            cause: Box::new(cause),
        },
    }
}

/// Whether the C is what the manifest has the digest of (`content`, codegen/generate.py).
fn is_whole(folder: &Path, generated: &Generated) -> bool {
    let text = fs::read(folder.join(MANIFEST)).unwrap_or_default();
    let manifest: Value = serde_json::from_slice(&text).unwrap_or_default();
    let files = (generated.sources.iter().chain(&generated.lanes)).chain([&generated.tables]);
    let mut hash = Sha256::new();
    for file in files {
        match fs::read(file) {
            Ok(text) => hash.update(text),
            Err(_) => return false,
        }
    }
    let found: String = (hash.finalize().iter().map(|byte| format!("{byte:02x}"))).collect();
    manifest["content"] == found
}

/// Writes what was generated into a crate, in place of what was there; models for tests are no part of a package.
pub fn write(project: &Path, models: &[Model], generated: &[Generated]) -> Result<(), Error> {
    let folder = project.join(FOLDER);
    let staging = project.join(format!("{FOLDER}.partial"));
    cache::remove(&staging)?;
    let shipped = generated.iter().zip(models);
    for (model, _) in shipped.filter(|(_, model)| !model.for_tests) {
        let out = staging.join(&model.name);
        fs::create_dir_all(&out).map_err(Error::io("create", &out))?;
        let manifest = model.directory.join(MANIFEST);
        let files = model.sources.iter().chain(&model.lanes);
        for file in files.chain([&model.tables, &manifest]) {
            let to = out.join(file.file_name().unwrap_or_default());
            fs::copy(file, &to).map_err(Error::io("write", &to))?;
        }
        let digest = out.join(DIGEST);
        fs::write(&digest, format!("{}\n", model.digest)).map_err(Error::io("write", &digest))?;
    }
    cache::remove(&folder)?;
    fs::rename(&staging, &folder).map_err(Error::io("create", &folder))
}
