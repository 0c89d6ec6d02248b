//! From C to static libraries: one for each model, and one for the functions that all of them call.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::cache::Cache;
use super::error::Error;
use super::fingerprint::Fingerprint;
use super::generate::Generated;
use super::parallel;

/// Kind of the entries that hold libraries, in the package's own output folder.
const KIND: &str = "libraries";

/// C that generated code and the crate call, relative to the project.
const ELEMENTARY: &str = "codegen/elementary.c";

/// What becomes a library.
struct Library {
    name: String,
    /// Where its C comes from, relative to the project.
    origin: String,
    directory: PathBuf,
    sources: Vec<PathBuf>,
}

/// Compiles what changed and tells cargo to link all libraries.
///
/// A library is kept under the hash of its C files, the compiler and the flags, so that a model
/// that generated the same C as before is not compiled again.
pub fn compile(project: &Path, models: &[Generated], out_dir: &Path) -> Result<(), Error> {
    let of_model = |model: &Generated| Library {
        name: model.name.clone(),
        origin: model.folder.clone(),
        directory: model.directory.clone(),
        sources: model.sources.clone(),
    };
    let elementary = Library {
        // No model has this name: a model's begins with a letter.
        name: "_elementary".to_owned(),
        origin: ELEMENTARY.to_owned(),
        directory: project.join("codegen"),
        sources: vec![project.join(ELEMENTARY)],
    };
    // What others call comes after them on the command line of a linker.
    let all: Vec<_> = models.iter().map(of_model).chain([elementary]).collect();
    let build = compiler();
    let failed = |what: &str, problem: String| Error::Compiler {
        what: what.to_owned(),
        problem,
    };
    let command = command(&build).map_err(|problem| failed("the models", problem))?;
    let command = Fingerprint::default().with(command);
    let libraries = Cache::at(out_dir);
    let compiled = parallel::map(&all, |library| {
        let hash = command
            .clone()
            .with_files(
                &library.directory,
                library.sources.iter().map(PathBuf::as_path),
            )?
            .finish();
        let key = format!("{}-{hash}", library.name);
        let folder = libraries.entry(KIND, &key, |folder| {
            build
                .clone()
                // Linked below, whether it was compiled now or before.
                .cargo_metadata(false)
                .files(&library.sources)
                .out_dir(folder)
                .try_compile(&library.file())
                .map_err(|error| {
                    failed(
                        &format!("the C code of {}", library.origin),
                        error.to_string(),
                    )
                })
        })?;
        Ok((key, folder))
    });
    let mut keys = Vec::new();
    for (library, result) in all.iter().zip(compiled) {
        let (key, folder) = result?;
        println!("cargo::rustc-link-search=native={}", folder.display());
        println!("cargo::rustc-link-lib=static={}", library.file());
        keys.push(key);
    }
    libraries.retain(KIND, &keys)
}

/// The compiler and its flags. Generated code is the inner loop of every simulation: it is
/// optimised in every profile, in the same way, so that a debug build and a release build give the
/// same bits. For the same reason products and sums are not contracted (a fused multiply-add
/// changes the last bits, and with them the time of an event), and the code is not tuned to the
/// machine of the build.
fn compiler() -> cc::Build {
    let mut build = cc::Build::new();
    build
        // Level 3 makes vectors of the independent sums of a Taylor series; it changes no bit.
        .opt_level(3)
        .debug(false)
        .flag_if_supported("-ffp-contract=off")
        // Generated functions have one signature, whether or not they use every argument.
        .flag_if_supported("-Wno-unused-parameter");
    build
}

/// The command line of the compiler, once it is known to exist: otherwise the `cc` crate would
/// warn once for every flag that it cannot try.
fn command(build: &cc::Build) -> Result<String, String> {
    let found = cc::Build::new()
        .cargo_metadata(false)
        .cargo_warnings(false)
        .try_get_compiler()
        .map_err(|error| error.to_string())?;
    let program = found.path();
    Command::new(program)
        .arg("--version")
        .output()
        .map_err(|error| format!("{}: {error}", program.display()))?;
    let tool = build
        .try_get_compiler()
        .map_err(|error| error.to_string())?;
    Ok(format!("{:?}", tool.to_command()))
}

impl Library {
    /// Its name for the linker.
    fn file(&self) -> String {
        format!("dalembert_{}", self.name)
    }
}
