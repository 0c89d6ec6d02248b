//! Model folders, wherever they are, and the judgement on one.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::cache::Cache;
use super::error::{Error, ModelFailure};
use super::files;
use super::fingerprint::Fingerprint;
use super::generate;
use super::generator::Bundle;
use super::index::Index;
use super::install::Environment;
use super::library::Stage;
use super::link;

/// A model folder.
pub struct Model {
    /// Its name: that of the folder, as far as it can be one.
    pub name: String,
    /// As it was named.
    pub folder: PathBuf,
    /// Without links and `..`.
    pub absolute: PathBuf,
}

impl Model {
    /// The model in a folder, which must have a `model.py` and a name that code can have.
    pub fn at(folder: &Path) -> Result<Self, Error> {
        let wrong = |problem: String, advice| Error::Folder {
            folder: folder.to_owned(),
            problem,
            advice,
        };
        let name_a_folder = "name a folder that has a model.py; `dalembert new` makes one";
        let advice = |error: &io::Error| match error.kind() {
            io::ErrorKind::PermissionDenied => "allow yourself to read the folder and its model.py",
            _ => name_a_folder,
        };
        let absolute = fs::canonicalize(folder)
            .map_err(|error| wrong(format!("no model folder: {error}"), advice(&error)))?;
        if !absolute.is_dir() {
            return Err(wrong(
                "a file, not a model folder".to_owned(),
                name_a_folder,
            ));
        }
        let file = absolute.join("model.py");
        fs::read(&file).map_err(|error| {
            wrong(
                format!("the model folder has no readable model.py: {error}"),
                advice(&error),
            )
        })?;
        let name = absolute.file_name().unwrap_or_default().to_string_lossy();
        Ok(Self {
            name: generate::module_name(&name),
            folder: folder.to_owned(),
            absolute,
        })
    }

    /// Its Python files, relative to the folder.
    fn python(&self) -> Result<Vec<PathBuf>, Error> {
        let mut files = files::sources(&self.absolute).map_err(Error::io("list", &self.folder))?;
        files.retain(|file| file.extension().is_some_and(|ending| ending == "py"));
        Ok(files)
    }

    /// The key of what is known of the model before it was run. Of its files those in Python count: others, such as scenes
    /// and results, count if it reads them.
    pub fn key(&self, bundle: &Bundle) -> Result<String, Error> {
        let files = self.python()?;
        let hash = Fingerprint::default()
            .with(link::TARGET)
            .with(&bundle.digest)
            .with(&self.name)
            .with_files(&self.absolute, files.iter().map(PathBuf::as_path))?;
        Ok(format!("{}-{}", self.name, hash.finish()))
    }
}

/// The files that make a model what it is.
#[derive(Debug, Default)]
pub struct Sources {
    /// The Python files in its folder.
    pub python: Vec<PathBuf>,
    /// What the derivation of its present state read besides, if there was one.
    pub read: Vec<PathBuf>,
}

/// The files that make the model in a folder what it is.
pub fn sources(folder: &Path) -> Result<Sources, Error> {
    let model = Model::at(folder)?;
    let python = model.python()?;
    let index = match Cache::of_user()? {
        Some(cache) => Index::read(&cache, &model.key(&Bundle::open()?)?),
        None => None,
    };
    let read = index.map_or(Vec::new(), |index| index.read);
    let absolute = |files: Vec<PathBuf>| -> Vec<PathBuf> {
        files.iter().map(|file| model.absolute.join(file)).collect()
    };
    Ok(Sources {
        python: absolute(python),
        read: absolute(read),
    })
}

/// Judges the model in a folder, without compiling it: all errors that are independent of each other, else its modes, as
/// `codegen/judge.py` has it. `progress` is told when packages must be installed.
pub fn check(folder: &Path, progress: &dyn Fn(Stage)) -> Result<Value, Error> {
    let model = Model::at(folder)?;
    let cache = Cache::of_user()?.ok_or(Error::NoCache)?;
    let generator = Bundle::open()?.extract(&cache)?;
    let lock = generator.lock()?;
    let environment = Environment::provide(&lock, &cache, || progress(Stage::Installing))?;
    let directory = env::current_dir().map_err(Error::io("find", Path::new(".")))?;
    let mut command = environment.command();
    command
        .current_dir(&generator.root)
        .args(["-m", "codegen", "--directory"])
        .arg(directory)
        .args(["check", "--model-dir"])
        .arg(&model.absolute)
        .args(["--name", &model.name]);
    let output = command
        .output()
        .map_err(Error::io("run", Path::new(command.get_program())))?;
    let answer = serde_json::from_slice(&output.stdout).ok();
    answer.filter(|_| output.status.success()).ok_or_else(|| {
        Error::Models(vec![ModelFailure {
            folder: folder.display().to_string(),
            fault: None,
            status: output.status.to_string(),
            output: String::from_utf8_lossy(&output.stderr).into_owned(),
        }])
    })
}
