//! The build script of a crate with models: the engine's, or that of a crate which depends on the engine.

use std::env;
use std::path::{Path, PathBuf};

use super::cache::{self, Cache};
use super::compile;
use super::engine::Contract;
use super::error::Error;
use super::generate;
use super::generator::{self, Bundle};
use super::install::{Environment, Lock};
use super::owner::Owner;
use super::packaged::{self, Packaged};
use super::python;

/// Variable that docs.rs sets. Documentation links nothing, so it needs no models.
const DOCUMENTATION: &str = "DOCS_RS";

/// Builds the models under `models/` of the crate whose build script calls it; `dalembert::models!()` in that crate are
/// they.
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

/// Provides everything that the crate links and reads from its build environment.
fn run() -> Result<(), Error> {
    let project = PathBuf::from(cargo("CARGO_MANIFEST_DIR")?);
    let out_dir = PathBuf::from(cargo("OUT_DIR")?);
    let target = cargo("TARGET")?;
    let owner = Owner::of_build()?;
    let is_engine = owner == Owner::Engine;
    let with_tests = is_engine && env::var_os("CARGO_FEATURE_TEST_MODELS").is_some();
    watch(&project, with_tests);
    // The name by which the macro finds the list.
    println!(
        "cargo::rustc-env=DALEMBERT_MODELS={}",
        owner.symbol("models")
    );

    let bundle = Bundle::open()?;
    for file in &bundle.watched {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    let contract = Contract::of(&bundle)?;
    match is_engine {
        true => contract.tell(),
        false => contract.compare()?,
    }
    if env::var_os(DOCUMENTATION).is_some() {
        return Ok(());
    }

    let cache = Cache::shared(&out_dir)?;
    let generator = bundle.extract(&cache)?;
    // The engine can do without its models.
    let is_shipped = !is_engine || env::var_os("CARGO_FEATURE_SHIPPED_MODELS").is_some();
    let models = match is_shipped {
        true => generate::discover(&project, with_tests)?,
        false => Vec::new(),
    };
    let generated = match packaged::find(&project, &models, &owner, &generator)? {
        Packaged::Whole(generated) => generated,
        Packaged::Unfit(reasons) => {
            let lock = generator.lock()?;
            let environment = Environment::provide(&lock, &cache, || {});
            let environment = environment.map_err(|cause| packaged::explain(reasons, cause))?;
            if is_engine {
                announce(&environment, &lock, &target)?;
            }
            let generated =
                generate::generate(&project, &models, &owner, &generator, &environment, &cache)?;
            if packaged::is_wanted() {
                packaged::write(&project, &models, &generated)?;
            }
            generated
        }
    };
    compile::compile(&generator, &generated, &owner, &out_dir)
}

/// Tells cargo when to run the build script again.
///
/// `models/` is watched as a whole, because a new folder counts. Not watched are the variables that only
/// lead to Python or to a registry (`PATH`, `HOME`, `PIP_*`): what they led to stays valid, and a
/// build that failed is run again anyway. The generator is part of the build script.
fn watch(project: &Path, with_tests: bool) {
    let tests = with_tests.then_some("tests/models");
    let paths = ["build.rs", "models", packaged::FOLDER]
        .into_iter()
        .chain(tests);
    // Cargo takes a path that is missing for one that changed.
    for path in paths.filter(|path| project.join(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
    let settings = [
        python::SETTING,
        cache::SETTING,
        generator::SETTING,
        packaged::SETTING,
        compile::SANITIZE,
        DOCUMENTATION,
    ];
    for variable in settings {
        println!("cargo::rerun-if-env-changed={variable}");
    }
}

/// Passes to the engine's tests what they run: the interpreter, with `DALEMBERT_PYTHON_PATH` as its `PYTHONPATH`, unless that
/// is empty; and the build script itself (`tests/provisioning/`), with what it builds for.
fn announce(environment: &Environment, lock: &Lock, target: &str) -> Result<(), Error> {
    let packages = environment.packages.as_deref();
    let script = env::current_exe().map_err(Error::io("find", Path::new("the build script")))?;
    for (variable, value) in [
        ("PYTHON_EXE", environment.python.executable.display()),
        ("PYTHON_PATH", packages.unwrap_or(Path::new("")).display()),
        ("CASADI_VERSION", Path::new(&lock.casadi).display()),
        ("BUILD_SCRIPT", script.display()),
        ("TARGET", Path::new(target).display()),
    ] {
        println!("cargo::rustc-env=DALEMBERT_{variable}={value}");
    }
    if let Some(packages) = packages {
        // The tests need them later: if they are deleted, the next build brings them back.
        let inventory = packages.join(cache::INVENTORY);
        println!("cargo::rerun-if-changed={}", inventory.display());
    }
    if !environment.can_verify {
        println!(
            "cargo::warning=the interpreter that {} names has no SymPy: `dalembert verify` will \
             not work with it until `pip install sympy`",
            python::SETTING
        );
    }
    Ok(())
}

/// A variable that cargo sets for build scripts.
fn cargo(variable: &'static str) -> Result<String, Error> {
    env::var(variable).map_err(|_| Error::NotUnderCargo { variable })
}
