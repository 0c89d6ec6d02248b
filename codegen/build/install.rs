//! The locked Python packages: CasADi for code generation, SymPy for verification.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::cache::{Cache, Compares, Entry, Kind};
use super::error::{Error, InstallCause};
use super::fingerprint::Fingerprint;
use super::python::{self, Python};

/// Kind of the cache entries that hold installed packages.
/// pip has checked their hashes.
const KIND: Kind = Kind {
    name: "python",
    compares: Compares::Sizes,
};

/// Imports what code generation imports and tells the version; on a second line, whether
/// verification can run.
const CHECK: &str = "
import importlib.util, casadi
print(casadi.__version__)
print(importlib.util.find_spec('sympy') is not None)
";

/// The lock file: names, versions and hashes of the packages.
#[derive(Debug)]
pub struct Lock {
    /// Where it is.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// The version of CasADi that it pins.
    pub casadi: String,
}

impl Lock {
    /// Reads the lock file.
    pub fn read(path: PathBuf) -> Result<Self, Error> {
        let text = fs::read_to_string(&path).map_err(Error::io("read", &path))?;
        let casadi = text
            .lines()
            .find_map(|line| line.strip_prefix("casadi=="))
            .and_then(|rest| rest.split_whitespace().next())
            .map(str::to_owned);
        match casadi {
            Some(casadi) => Ok(Self { path, text, casadi }),
            None => Err(Error::Lock { path }),
        }
    }

    /// Name of the cache entry that holds these packages for an interpreter.
    fn key(&self, python: &Python) -> String {
        let Python {
            implementation,
            version,
            platform,
            ..
        } = python;
        let hash = Fingerprint::default()
            .with(&self.text)
            .with(implementation)
            .with(version.to_string())
            .with(platform)
            .finish();
        format!("{implementation}-{version}-{hash}")
    }
}

/// An interpreter with CasADi.
#[derive(Debug)]
pub struct Environment {
    /// The interpreter.
    pub python: Python,
    /// The folder of the installed packages; `None` if the interpreter has its own.
    pub packages: Option<PathBuf>,
    /// Whether SymPy is there, which verification needs and the build does not.
    pub can_verify: bool,
    _entry: Option<Entry>,
}

impl Environment {
    /// The interpreter that the user names, which must have the CasADi of the lock file; else one
    /// from the search path, with the locked packages from the cache or, once, from a registry.
    /// `installing` is called before something is installed.
    pub fn provide(lock: &Lock, cache: &Cache, installing: impl FnOnce()) -> Result<Self, Error> {
        match python::named() {
            Some(python) => Self::given(python?, lock),
            None => Self::managed(lock, cache, installing),
        }
    }

    fn given(python: Python, lock: &Lock) -> Result<Self, Error> {
        let refuse = |problem: String| Error::Setting {
            name: python::SETTING,
            value: python.executable.display().to_string(),
            problem,
            advice: format!(
                "install casadi=={} for it, let {} name an interpreter that has it, or unset the \
                 variable: the build then installs CasADi by itself",
                lock.casadi,
                python::SETTING
            ),
        };
        let output = run(python.command().args(["-c", CHECK]))?;
        let answer = String::from_utf8_lossy(&output.stdout);
        let mut answer = answer.lines();
        let Some(version) = answer.next().filter(|_| output.status.success()) else {
            let complaint = String::from_utf8_lossy(&output.stderr);
            // A traceback names the error last.
            let complaint = complaint.trim().lines().last().unwrap_or_default();
            return Err(refuse(format!(
                "this interpreter cannot import CasADi: {complaint}"
            )));
        };
        if version != lock.casadi {
            return Err(refuse(format!(
                "this interpreter has CasADi {version}; needed is {}",
                lock.casadi
            )));
        }
        let can_verify = answer.next() == Some("True");
        Ok(Self {
            python,
            packages: None,
            can_verify,
            _entry: None,
        })
    }

    fn managed(lock: &Lock, cache: &Cache, installing: impl FnOnce()) -> Result<Self, Error> {
        let python = python::discover(|python| cache.contains(KIND, &lock.key(python)))?;
        let entry = cache.entry(KIND, &lock.key(&python), |folder| {
            installing();
            install(lock, &python, folder)
        })?;
        Ok(Self {
            python,
            packages: Some(entry.path.clone()),
            can_verify: true,
            _entry: Some(entry),
        })
    }

    /// A command that runs the interpreter with its packages.
    pub fn command(&self) -> Command {
        let mut command = self.python.command();
        if let Some(folder) = &self.packages {
            only(&mut command, folder);
        }
        command
    }
}

/// Has an interpreter see the packages in a folder, and none of its own site, which may run code at its
/// start.
fn only<'a>(command: &'a mut Command, folder: &Path) -> &'a mut Command {
    command.arg("-S").env("PYTHONPATH", folder)
}

/// Installs the locked packages into an empty folder.
fn install(lock: &Lock, python: &Python, folder: &Path) -> Result<(), Error> {
    let output = run(python
        .command()
        .args([
            "-m",
            "pip",
            "install",
            "--no-deps",
            "--only-binary",
            ":all:",
        ])
        .args(["--no-compile", "--require-hashes", "--no-input"])
        .args(["--disable-pip-version-check", "--target"])
        .args([folder, "-r".as_ref(), &lock.path])
        // A configuration file may ask for these, and both contradict --target.
        .envs([("PIP_USER", "0"), ("PIP_REQUIRE_VIRTUALENV", "0")]))?;
    if !output.status.success() {
        let output = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(Error::Install {
            package: format!("CasADi {}", lock.casadi),
            python: python.executable.clone(),
            lock: lock.path.clone(),
            cause: cause(&output),
            output,
        });
    }
    // Shows that the packages work. As the only run without -B it also leaves the bytecode of
    // what code generation imports, which later runs then need not compile: 0.14 s for the
    // import instead of 0.44 s. `pip --compile` would spend many seconds on all of SymPy.
    let mut check = python.command_that_keeps_bytecode();
    let output = run(only(&mut check, folder).args(["-c", CHECK]))?;
    if output.status.success() {
        Ok(())
    } else {
        Err(Error::Import {
            python: python.executable.clone(),
            output: String::from_utf8_lossy(&output.stderr).into_owned(),
        })
    }
}

/// Reads the cause of a failure off pip's words, which have been stable for ten years.
fn cause(output: &str) -> InstallCause {
    if output.contains("DO NOT MATCH THE HASHES") {
        InstallCause::HashMismatch
    } else if output.contains("No matching distribution found") {
        InstallCause::NothingFound
    } else {
        InstallCause::Other
    }
}

/// Runs a command to its end.
fn run(command: &mut Command) -> Result<Output, Error> {
    command
        .output()
        .map_err(Error::io("run", Path::new(command.get_program())))
}
