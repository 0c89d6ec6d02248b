//! From model folders to generated C, each model on its own and only when it changed.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::cache::{self, Cache, Compares, Kind};
use super::error::{Error, ModelFailure};
use super::files;
use super::fingerprint::Fingerprint;
use super::generator::Generator;
use super::install::Environment;
use super::owner::Owner;
use super::parallel;

/// Kind of the cache entries that hold generated code.
const KIND: Kind = Kind {
    name: "code",
    compares: Compares::Digests,
};

/// How the generator begins when it names the fault of a model, with file and line.
const NAMED_FAULT: &str = "error: ";

/// A model folder.
#[derive(Debug)]
pub struct Model {
    /// Name of the folder and of the model.
    pub name: String,
    /// The folder, relative to the project, with forward slashes.
    pub folder: String,
    /// Whether the model exists for the test suite alone.
    pub for_tests: bool,
}

/// The generated code of a model.
#[derive(Debug)]
pub struct Generated {
    /// Name of the model.
    pub name: String,
    /// Where it comes from, relative to the project.
    pub folder: String,
    /// The folder of the generated files.
    pub directory: PathBuf,
    /// The C files in it.
    pub sources: Vec<PathBuf>,
    /// The C files in it that are compiled once for each level of the processor; may be none.
    pub lanes: Vec<PathBuf>,
    /// The C file in it with the tables of the model.
    pub tables: PathBuf,
    /// Digest of what it was generated from.
    pub digest: String,
}

/// The models under `models/` and, if asked for, `tests/models/`: every folder with a `model.py`.
/// The order is that of the names, so that nothing depends on the file system.
pub fn discover(project: &Path, with_tests: bool) -> Result<Vec<Model>, Error> {
    let mut models = Vec::new();
    let parents = [("models", false), ("tests/models", true)];
    for (parent, for_tests) in parents {
        if (for_tests && !with_tests) || !project.join(parent).is_dir() {
            continue;
        }
        for path in cache::list(&project.join(parent))? {
            if !path.join("model.py").is_file() {
                continue;
            }
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let folder = format!("{parent}/{name}");
            if !is_module_name(&name) {
                return Err(Error::ModelName { folder });
            }
            models.push(Model {
                name: name.into_owned(),
                folder,
                for_tests,
            });
        }
    }
    models.sort_by(|a, b| a.name.cmp(&b.name));
    match models.windows(2).find(|pair| pair[0].name == pair[1].name) {
        Some([first, second]) => Err(Error::DuplicateModel {
            folders: [first.folder.clone(), second.folder.clone()],
        }),
        _ => Ok(models),
    }
}

/// The generated code of all models, in their order: from the cache where neither the model, nor
/// the generator, nor the lock file changed. A failure reports every model that failed.
pub fn generate(
    project: &Path,
    models: &[Model],
    owner: &Owner,
    generator: &Generator,
    environment: &Environment,
    cache: &Cache,
) -> Result<Vec<Generated>, Error> {
    let results = parallel::map(models, |model| {
        let digest = digest(project, model, owner, generator)?;
        let entry = cache.entry(KIND, &format!("{}-{digest}", model.name), |folder| {
            let for_tests = model.for_tests.then_some("--for-tests");
            run(
                project,
                (&model.name, model.folder.as_ref()),
                ["--owner", owner.tag()].into_iter().chain(for_tests),
                generator,
                environment,
                folder,
            )
        })?;
        read(
            &model.name,
            &model.folder,
            &entry.path.join(&model.name),
            digest,
        )
    });
    let mut generated = Vec::new();
    let mut failures = Vec::new();
    for result in results {
        match result {
            Ok(model) => generated.push(model),
            Err(Error::Models(more)) => failures.extend(more),
            Err(other) => return Err(other),
        }
    }
    if failures.is_empty() {
        Ok(generated)
    } else {
        Err(Error::Models(failures))
    }
}

/// Digest of all that the code of a model is generated from. It is the same on every platform, as the code is.
pub fn digest(
    project: &Path,
    model: &Model,
    owner: &Owner,
    generator: &Generator,
) -> Result<String, Error> {
    let folder = project.join(&model.folder);
    let files = files::sources(&folder).map_err(Error::io("list", &folder))?;
    let hash = Fingerprint::default()
        .with(&generator.digest)
        .with(owner.tag())
        .with_files(project, files.iter().map(PathBuf::as_path))?;
    Ok(hash.finish())
}

/// Runs the generator on one model, for which it makes a sub-folder of `out`. Paths in messages are relative to `directory`, as
/// the model's `folder` is.
pub fn run<'a>(
    directory: &Path,
    (name, folder): (&str, &Path),
    options: impl IntoIterator<Item = &'a str>,
    generator: &Generator,
    environment: &Environment,
    out: &Path,
) -> Result<(), Error> {
    let mut command = environment.command();
    command
        .current_dir(&generator.root)
        .args(["-m", "codegen", "--directory"])
        .arg(directory)
        .args(["generate", "--model-dir"])
        .arg(folder)
        .args(["--name", name])
        .arg("--out")
        .arg(out)
        .args(options);
    let output = command
        .output()
        .map_err(Error::io("run", Path::new(command.get_program())))?;
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stderr);
    Err(Error::Models(vec![ModelFailure {
        folder: folder.display().to_string(),
        fault: text.trim().strip_prefix(NAMED_FAULT).map(str::to_owned),
        status: output.status.to_string(),
        output: text.into_owned(),
    }]))
}

/// Reads what the generator wrote for a model into a folder.
pub fn read(name: &str, origin: &str, folder: &Path, digest: String) -> Result<Generated, Error> {
    let wrong = |problem: &str| Error::Manifest {
        folder: origin.to_owned(),
        problem: problem.to_owned(),
    };
    let text = |name: &str| {
        fs::read_to_string(folder.join(name))
            .map_err(|error| wrong(&format!("no readable {name}: {error}")))
    };
    let manifest: Value = serde_json::from_str(&text("manifest.json")?)
        .map_err(|error| wrong(&format!("a manifest.json that is not JSON: {error}")))?;
    let tables = manifest["tables"]
        .as_str()
        .ok_or_else(|| wrong("a manifest.json without the file name `tables`"))?;
    let files = |list: &str| {
        let names = manifest[list].as_array();
        let names = names.and_then(|all| all.iter().map(Value::as_str).collect::<Option<Vec<_>>>());
        names.map(|all| all.iter().map(|name| folder.join(name)).collect::<Vec<_>>())
    };
    let sources = files("sources")
        .filter(|names| !names.is_empty())
        .ok_or_else(|| wrong("a manifest.json without the list of file names `sources`"))?;
    let lanes = files("lanes")
        .ok_or_else(|| wrong("a manifest.json without the list of file names `lanes`"))?;
    Ok(Generated {
        name: name.to_owned(),
        folder: origin.to_owned(),
        directory: folder.to_owned(),
        sources,
        lanes,
        tables: folder.join(tables),
        digest,
    })
}

/// The name of a model in a folder of any name: lower-case letters, digits and single underscores of it, a letter first.
pub fn module_name(folder: &str) -> String {
    let mut name = String::new();
    for c in folder.chars().map(|c| c.to_ascii_lowercase()) {
        match c.is_ascii_alphanumeric() {
            true => name.push(c),
            false if name.ends_with('_') || name.is_empty() => {}
            false => name.push('_'),
        }
    }
    let name = name.trim_end_matches('_');
    match name.starts_with(|c: char| c.is_ascii_lowercase()) {
        true => name.to_owned(),
        false if name.is_empty() => "model".to_owned(),
        false => format!("model_{name}"),
    }
}

/// Whether a name can be that of a Python module and part of the names of C functions, in which single underscores separate.
pub fn is_module_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        && !name.contains("__")
        && !name.ends_with('_')
}
