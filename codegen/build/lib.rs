//! From model folders to compiled models: Python with CasADi, generated code, C. The whole of a `build.rs`:
//!
//! ```no_run
//! dalembert_build::models();
//! ```
//!
//! | module | subject |
//! |---|---|
//! | `generator`, `files` | the generator, which travels inside this crate |
//! | `python` | which interpreter, and how it is run |
//! | `install` | the locked packages, from the cache or a registry |
//! | `generate` | from model folders to C |
//! | `compile` | from C to static libraries |
//! | `model` | folders of models, wherever they are, and the judgement on one |
//! | `library`, `index`, `link` | from such a folder to a shared library, while a program runs |
//! | `registry` | the C file that lists the models |
//! | `cache`, `evict` | folders under content keys, and what becomes of old ones |
//! | `fingerprint`, `parallel` | hashes; threads |
//! | `error` | every failure, with what to do |
//!
//! Variables that the user may set:
//!
//! | variable | meaning |
//! |---|---|
//! | `DALEMBERT_PYTHON` | an interpreter that already has the CasADi of the lock file |
//! | `DALEMBERT_CACHE` | folder for installed packages and generated code |
//! | `DALEMBERT_GENERATOR` | a folder `codegen` in place of the generator inside |
//! | `PIP_INDEX_URL`, `PIP_FIND_LINKS`, … | how pip reaches a registry |
//! | `DALEMBERT_SANITIZE` | if set, the C checks its addresses and for undefined behaviour: `.ci/sanitize` |
//! | `CC`, `CFLAGS`, … | the C compiler, as the `cc` crate understands them |

mod cache;
mod compile;
mod error;
mod evict;
mod files;
mod fingerprint;
mod generate;
mod generator;
mod index;
mod install;
mod library;
mod link;
mod model;
mod parallel;
mod python;
mod registry;

use std::env;
use std::path::{Path, PathBuf};

pub use cache::Cache;
pub use error::{Error, InstallCause, ModelFailure};
pub use evict::Item;
pub use generate::is_module_name as is_model_name;
use generator::Bundle;
use install::{Environment, Lock};
pub use library::{Choices, Library, Options, Stage, library};
pub use model::{Sources, check, sources};

/// Builds the models under `models/` of the crate whose build script calls it.
///
/// Reports failures as cargo errors. The exit status stays 0, on which cargo prints those lines
/// alone and still fails the build; a non-zero status would bury them under the build script's
/// whole output.
pub fn models() {
    if let Err(error) = run() {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}

/// Provides everything that the crate includes, links and reads from its build environment.
fn run() -> Result<(), Error> {
    let project = PathBuf::from(cargo("CARGO_MANIFEST_DIR")?);
    let out_dir = PathBuf::from(cargo("OUT_DIR")?);
    let target = cargo("TARGET")?;
    let with_tests = env::var_os("CARGO_FEATURE_TEST_MODELS").is_some();
    watch(&project, with_tests);

    let cache = Cache::shared(&out_dir)?;
    let bundle = Bundle::open()?;
    for file in &bundle.watched {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    let generator = bundle.extract(&cache)?;
    let lock = generator.lock()?;
    let environment = Environment::provide(&lock, &cache, || {})?;
    announce(&environment, &lock);
    announce_build(&target)?;

    let models = generate::discover(&project, with_tests)?;
    let generated =
        generate::generate(&project, &models, &generator, &environment, &cache, &target)?;
    compile::compile(&generator, &generated, &out_dir)
}

/// Tells cargo when to run the build script again.
///
/// `models/` is watched as a whole, because a new folder counts. Not watched are the variables that only
/// lead to Python or to a registry (`PATH`, `HOME`, `PIP_*`): what they led to stays valid, and a
/// build that failed is run again anyway. The generator is part of the build script.
fn watch(project: &Path, with_tests: bool) {
    let tests = with_tests.then_some("tests/models");
    let paths = ["build.rs", "models"].into_iter().chain(tests);
    // Cargo takes a path that is missing for one that changed.
    for path in paths.filter(|path| project.join(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
    let settings = [
        python::SETTING,
        cache::SETTING,
        generator::SETTING,
        compile::SANITIZE,
    ];
    for variable in settings {
        println!("cargo::rerun-if-env-changed={variable}");
    }
}

/// Passes the interpreter on to the crate, which runs Python for verification and in tests: with
/// `DALEMBERT_PYTHON_PATH` as its `PYTHONPATH`, unless that is empty. At run time the variable
/// `DALEMBERT_PYTHON` names another interpreter, with its own packages, as it does here.
fn announce(environment: &Environment, lock: &Lock) {
    let packages = environment.packages.as_deref();
    println!(
        "cargo::rustc-env=DALEMBERT_PYTHON_EXE={}",
        environment.python.executable.display()
    );
    println!(
        "cargo::rustc-env=DALEMBERT_PYTHON_PATH={}",
        packages.unwrap_or(Path::new("")).display()
    );
    println!("cargo::rustc-env=DALEMBERT_CASADI_VERSION={}", lock.casadi);
    if let Some(packages) = packages {
        // Verification needs them later: if they are deleted, the next build brings them back.
        let inventory = packages.join(cache::INVENTORY);
        println!("cargo::rerun-if-changed={}", inventory.display());
    }
    if !environment.can_verify {
        println!(
            "cargo::warning=the interpreter that {} names has no SymPy: `dalembert verify` will \
             not work until `pip install sympy`",
            python::SETTING
        );
    }
}

/// Passes the build script itself on to its tests (`tests/provisioning/`), and what it builds for.
fn announce_build(target: &str) -> Result<(), Error> {
    let script = env::current_exe().map_err(Error::io("find", Path::new("the build script")))?;
    println!(
        "cargo::rustc-env=DALEMBERT_BUILD_SCRIPT={}",
        script.display()
    );
    println!("cargo::rustc-env=DALEMBERT_TARGET={target}");
    Ok(())
}

/// A variable that cargo sets for build scripts.
fn cargo(variable: &'static str) -> Result<String, Error> {
    env::var(variable).map_err(|_| Error::NotUnderCargo { variable })
}
