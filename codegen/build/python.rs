//! The Python interpreter: which one, whether it will do, and how it is run.

use std::env;
use std::ffi::{OsStr, OsString};
use std::fmt;
use std::io;
use std::path::{self, Path, PathBuf};
use std::process::Command;

use super::error::Error;

/// Variable that names an interpreter which already has CasADi. Nothing is installed for it.
pub const SETTING: &str = "DALEMBERT_PYTHON";

/// Oldest Python whose wheels are in the lock file.
pub const OLDEST: Version = Version(3, 9);

/// Newest Python whose wheels are in the lock file. Bounds only what the build installs; an
/// interpreter that already has CasADi may be newer.
const NEWEST: Version = Version(3, 14);

/// Names tried on the search path, best first: what a user means by Python, then by version.
const NAMES: [&str; 8] = [
    "python3",
    "python",
    "python3.14",
    "python3.13",
    "python3.12",
    "python3.11",
    "python3.10",
    "python3.9",
];

/// Variables of pip that say how to reach a registry. pip's other variables say how and where to
/// install, which is ours to say.
const REGISTRY_SETTINGS: [&str; 13] = [
    "PIP_INDEX_URL",
    "PIP_EXTRA_INDEX_URL",
    "PIP_NO_INDEX",
    "PIP_FIND_LINKS",
    "PIP_TRUSTED_HOST",
    "PIP_PROXY",
    "PIP_CERT",
    "PIP_CLIENT_CERT",
    "PIP_TIMEOUT",
    "PIP_DEFAULT_TIMEOUT",
    "PIP_RETRIES",
    "PIP_CACHE_DIR",
    "PIP_CONFIG_FILE",
];

/// Says what the interpreter is, a line each. The version comes first and in words that Python 2
/// understands too, so that an old interpreter is named as such and not as a broken one.
const PROBE: &str = "
import sys
print('%d.%d' % sys.version_info[:2])
import importlib.util, platform, sysconfig
gil = '' if not sysconfig.get_config_var('Py_GIL_DISABLED') else ' (free-threaded)'
print(sys.executable)
print(sys.implementation.name + gil)
print(platform.machine(), sysconfig.get_platform(), sysconfig.get_config_var('EXT_SUFFIX'))
print(importlib.util.find_spec('pip') is not None)
";

/// Major and minor version of Python.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version(u32, u32);

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.0, self.1)
    }
}

/// An interpreter that answered.
#[derive(Debug)]
pub struct Python {
    /// Its executable, as it names itself (a shim on the search path is looked through).
    pub executable: PathBuf,
    /// Its version.
    pub version: Version,
    /// `cpython`, `pypy`, …
    pub implementation: String,
    /// Machine, platform and suffix of its extension modules: what decides which wheels fit.
    pub platform: String,
    /// Whether it has pip.
    pub has_pip: bool,
}

/// Why an interpreter will not do.
#[derive(Debug)]
pub enum Rejection {
    /// There is no such program.
    NotFound,
    /// It did not run, or not as Python does.
    Unusable(String),
    /// Older than the models' code, or newer than the lock file.
    Version(Version),
    /// Not the standard interpreter, for which there are wheels.
    Implementation(String),
    /// pip is missing and CasADi is not installed yet.
    NoPip(Version),
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejection::NotFound => write!(f, "no such program"),
            Rejection::Unusable(why) => write!(f, "does not run as Python does: {why}"),
            Rejection::Version(version) => {
                write!(f, "is Python {version}; needed is {OLDEST} to {NEWEST}")
            }
            Rejection::Implementation(name) => {
                write!(f, "is {name}; CasADi exists for CPython only")
            }
            Rejection::NoPip(version) => write!(f, "is Python {version}, but has no pip"),
        }
    }
}

impl Python {
    /// Asks `program` (a path, or a name on the search path) what it is.
    pub fn probe(program: &OsStr) -> Result<Self, Rejection> {
        let output = command(program)
            .args(["-c", PROBE])
            .output()
            .map_err(|error| match error.kind() {
                io::ErrorKind::NotFound => Rejection::NotFound,
                _ => Rejection::Unusable(error.to_string()),
            })?;
        let answer = String::from_utf8_lossy(&output.stdout);
        Self::parse(&answer).unwrap_or_else(|| {
            let complaint = String::from_utf8_lossy(&output.stderr);
            let complaint = complaint
                .lines()
                .map(str::trim)
                .find(|line| !line.is_empty());
            let status = output.status.to_string();
            Err(Rejection::Unusable(complaint.unwrap_or(&status).to_owned()))
        })
    }

    /// Reads the answer to [`PROBE`]; `None` if it is not one.
    fn parse(answer: &str) -> Option<Result<Self, Rejection>> {
        let mut lines = answer.lines();
        let (major, minor) = lines.next()?.split_once('.')?;
        let version = Version(major.parse().ok()?, minor.parse().ok()?);
        if version < OLDEST {
            return Some(Err(Rejection::Version(version)));
        }
        Some(Ok(Self {
            version,
            executable: lines.next()?.into(),
            implementation: lines.next()?.to_owned(),
            platform: lines.next()?.to_owned(),
            has_pip: lines.next()? == "True",
        }))
    }

    /// Whether the lock file has wheels for it, and there is a way to install them.
    fn installable(self, installed: impl FnOnce(&Self) -> bool) -> Result<Self, Rejection> {
        if self.version > NEWEST {
            Err(Rejection::Version(self.version))
        } else if self.implementation != "cpython" {
            Err(Rejection::Implementation(self.implementation))
        } else if !self.has_pip && !installed(&self) {
            Err(Rejection::NoPip(self.version))
        } else {
            Ok(self)
        }
    }

    /// A command that runs this interpreter independent of the caller's Python environment, and
    /// writes no bytecode next to the sources.
    pub fn command(&self) -> Command {
        command(self.executable.as_os_str())
    }

    /// The same, but it leaves the bytecode of what it imports.
    pub fn command_that_keeps_bytecode(&self) -> Command {
        isolated(self.executable.as_os_str())
    }
}

/// The first interpreter on the search path for which CasADi is `installed` or can be.
pub fn discover(installed: impl Fn(&Python) -> bool) -> Result<Python, Error> {
    let mut rejected = Vec::new();
    for name in NAMES {
        match Python::probe(name.as_ref()).and_then(|python| python.installable(&installed)) {
            Ok(python) => return Ok(python),
            Err(reason) => rejected.push((name.to_owned(), reason)),
        }
    }
    Err(Error::NoInterpreter { rejected })
}

/// The interpreter that [`SETTING`] names, if it is set.
pub fn named() -> Option<Result<Python, Error>> {
    let program = env::var_os(SETTING).filter(|value| !value.is_empty())?;
    let probed = Python::probe(&program).map(|python| Python {
        // A path is run as it was given: it may be a script that sets up what its Python needs.
        executable: path::absolute(&program)
            .ok()
            .filter(|_| Path::new(&program).components().count() > 1)
            .unwrap_or(python.executable),
        ..python
    });
    Some(probed.map_err(|reason| {
        Error::Setting {
            name: SETTING,
            value: program.to_string_lossy().into_owned(),
            problem: reason.to_string(),
            advice: "let it name an interpreter that has CasADi, or unset it: the build then \
                 installs CasADi by itself"
                .to_owned(),
        }
    }))
}

/// A command that runs `program` as Python and writes no bytecode.
fn command(program: &OsStr) -> Command {
    let mut command = isolated(program);
    command.arg("-B");
    command
}

/// A command that runs `program` as Python, in UTF-8 and without the caller's Python environment:
/// an active virtual environment, module paths, packages and start-up code of the user's own site, pip's
/// options other than how to reach a registry.
fn isolated(program: &OsStr) -> Command {
    let mut command = Command::new(program);
    command.arg("-s");
    for (name, _) in env::vars_os().filter(|(name, _)| is_foreign(name)) {
        command.env_remove(name);
    }
    command.env("PYTHONUTF8", "1");
    command
}

/// Whether a variable of the caller would change what Python or pip do for us.
fn is_foreign(name: &OsString) -> bool {
    let Some(name) = name.to_str() else {
        return false;
    };
    name == "VIRTUAL_ENV"
        || name.starts_with("PYTHON")
        || (name.starts_with("PIP_") && !REGISTRY_SETTINGS.contains(&name))
}
