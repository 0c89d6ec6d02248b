//! What can go wrong while the build script prepares Python and the models, each with what to do.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::python::Rejection;

/// A failure of the build script. Its text is meant for the person who runs `cargo build`: what
/// is wrong, where, and what to do.
#[derive(Debug)]
pub enum Error {
    /// An environment variable has a value that cannot be used.
    Setting {
        /// Name of the variable.
        name: &'static str,
        /// Its value.
        value: String,
        /// Why it cannot be used.
        problem: String,
        /// What to do instead.
        advice: String,
    },
    /// No interpreter on the search path will do.
    NoInterpreter {
        /// Every name that was tried, with the reason against it.
        rejected: Vec<(String, Rejection)>,
    },
    /// The lock file does not pin CasADi.
    Lock {
        /// The lock file.
        path: PathBuf,
    },
    /// pip could not install the locked packages.
    Install {
        /// CasADi and the version that the lock file pins.
        package: String,
        /// The interpreter whose pip ran.
        python: PathBuf,
        /// The lock file.
        lock: PathBuf,
        /// Why it failed.
        cause: InstallCause,
        /// What pip wrote.
        output: String,
    },
    /// CasADi was installed but cannot be imported.
    Import {
        /// The interpreter.
        python: PathBuf,
        /// What Python wrote.
        output: String,
    },
    /// A folder under `models/` whose name cannot be that of a Python module and of C functions.
    ModelName {
        /// The folder, relative to the project.
        folder: String,
    },
    /// Two model folders of one name.
    DuplicateModel {
        /// The folders, relative to the project.
        folders: [String; 2],
    },
    /// Code generation refused one or more models.
    Models(Vec<ModelFailure>),
    /// Code generation reported success, but what it wrote is not what the build needs.
    Manifest {
        /// The model's folder.
        folder: String,
        /// What is missing or wrong.
        problem: String,
    },
    /// The C compiler failed.
    Compiler {
        /// What was being compiled.
        what: String,
        /// The message of the `cc` crate.
        problem: String,
    },
    /// The C compiler refused generated C.
    Refused {
        /// What was being compiled.
        what: String,
        /// The compiler, with its flags.
        command: String,
        /// What it wrote.
        output: String,
        /// The folder of the C.
        kept: PathBuf,
    },
    /// What should be a model folder is none.
    Folder {
        /// The folder, as it was named.
        folder: PathBuf,
        /// Why it is none.
        problem: String,
        /// What to do.
        advice: &'static str,
    },
    /// There is no folder for a cache.
    NoCache,
    /// A file operation failed.
    Io {
        /// What was attempted, as an infinitive: "create", "read", …
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The generator has no version of the contract.
    NoContract {
        /// What the line that is missing begins with.
        line: &'static str,
    },
    /// A crate builds models and does not depend on the engine.
    NoEngine {
        /// Version of this crate.
        build: &'static str,
    },
    /// The engine of a crate is of another version than this crate.
    Skew {
        /// Version of the engine.
        engine: String,
        /// Version of this crate.
        build: &'static str,
    },
    /// The engine of a crate was built for another contract than the generator makes models for.
    OtherContract {
        /// Version of both crates.
        version: &'static str,
        /// Version and digest of the contract that the engine was built for.
        engine: String,
        /// Version and digest of the generator's.
        build: String,
    },
    /// Models cannot be generated, and C that was generated before does not fit.
    Packaged {
        /// What is wrong with that C.
        reasons: Vec<String>,
        /// Why it cannot be generated.
        cause: Box<Error>,
    },
    /// Cargo's own environment for build scripts is incomplete.
    NotUnderCargo {
        /// The missing variable.
        variable: &'static str,
    },
}

/// Why pip failed, as far as its output tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InstallCause {
    /// pip found no file to install: no network, no registry, or no wheel for this platform.
    /// (pip says "No matching distribution found" for all of these.)
    NothingFound,
    /// A file differs from the one that was locked.
    HashMismatch,
    /// Anything else; pip's own words follow.
    Other,
}

/// A model that code generation refused.
#[derive(Debug)]
pub struct ModelFailure {
    /// The model's folder, relative to the project.
    pub folder: String,
    /// The fault in the model, with file and line, if the generator named it.
    pub fault: Option<String>,
    /// How the generator ended.
    pub status: String,
    /// All that the generator wrote to standard error.
    pub output: String,
}

impl Error {
    /// Wraps an I/O error: `.map_err(Error::io("create", path))`.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Error + use<> {
        let path = path.to_owned();
        move |source| Error::Io {
            action,
            path,
            source,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Setting {
                name,
                value,
                problem,
                advice,
            } => {
                writeln!(f, "{name}={value}: {problem}")?;
                write!(f, "to do: {advice}")
            }
            Error::NoInterpreter { rejected } => no_interpreter(f, rejected),
            Error::Lock { path } => write!(
                f,
                "{}: no line `casadi==VERSION`\nto do: restore the file, or recreate it as \
                 requirements.in beside it says",
                path.display()
            ),
            Error::Install {
                package,
                python,
                lock,
                cause,
                output,
            } => install(f, package, python, lock, *cause, output),
            Error::Import { python, output } => {
                writeln!(
                    f,
                    "CasADi was installed for {}, but cannot be imported. Python says:",
                    python.display()
                )?;
                quote(f, output)?;
                write!(
                    f,
                    "to do: repair what it names, or let DALEMBERT_PYTHON name another interpreter"
                )
            }
            Error::ModelName { folder } => write!(
                f,
                "{folder}: a model's folder name becomes a Python module and part of C names\n\
                 to do: rename the folder: lower-case letters, digits and single underscores, \
                 a letter first and no underscore last"
            ),
            Error::DuplicateModel {
                folders: [first, second],
            } => write!(
                f,
                "{first} and {second} have the same name\nto do: rename one of the folders"
            ),
            Error::Models(failures) => models(f, failures),
            Error::Manifest { folder, problem } => write!(
                f,
                "{folder}: code generation wrote {problem}\n\
                 to do: this is a fault of codegen/, not of the model; please report it"
            ),
            Error::Compiler { what, problem } => write!(
                f,
                "cannot compile {what}: {problem}\n\
                 to do: install a C compiler (cc, gcc or clang), or let CC name one"
            ),
            Error::Refused {
                what,
                command,
                output,
                kept,
            } => {
                writeln!(f, "cannot compile {what}: `{command}` says:")?;
                quote(f, output)?;
                write!(
                    f,
                    "the C is in {}\nto do: if the compiler is a usual one, please report it; else let CC name another",
                    kept.display()
                )
            }
            Error::Folder {
                folder,
                problem,
                advice,
            } => write!(f, "{}: {problem}\nto do: {advice}", folder.display()),
            Error::NoCache => write!(
                f,
                "there is no folder for compiled models: the home folder cannot be written\n\
                 to do: let {} name a folder that can",
                super::cache::SETTING
            ),
            Error::Io {
                action,
                path,
                source,
            } => {
                write!(f, "cannot {action} {}: {source}", path.display())
            }
            Error::NoContract { line } => write!(
                f,
                "contract.h of the generator has no line `{line}NUMBER`\n\
                 to do: restore the file; if DALEMBERT_GENERATOR is set, unset it"
            ),
            Error::NoEngine { build } => write!(
                f,
                "this crate builds models, but nothing to run them: dalembert is none of its dependencies\n\
                 to do: add dalembert = \"{build}\" to [dependencies] in Cargo.toml"
            ),
            Error::Skew { engine, build } => write!(
                f,
                "this crate has dalembert {engine} and dalembert-build {build}: models that the one builds the other \
                 cannot run\n\
                 to do: in Cargo.toml give dalembert under [dependencies] and dalembert-build under [build-dependencies] \
                 the same version"
            ),
            Error::OtherContract {
                version,
                engine,
                build,
            } => write!(
                f,
                "dalembert {version} was built for models of the contract {engine}, and the generator of dalembert-build \
                 {version} makes those of the contract {build}\n\
                 to do: take both crates from one source; DALEMBERT_GENERATOR, if it is set, must be the same for both"
            ),
            Error::Packaged { reasons, cause } => {
                writeln!(f, "the C that was generated before does not fit:")?;
                quote(f, &reasons.join("\n"))?;
                write!(f, "and it cannot be generated anew: {cause}")
            }
            Error::NotUnderCargo { variable } => {
                write!(
                    f,
                    "{variable} is not set\nto do: run the build script through cargo"
                )
            }
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::Io { source, .. } => Some(source),
            Error::Packaged { cause, .. } => Some(cause),
            _ => None,
        }
    }
}

/// Indents the words of another program, so that they are told from ours.
fn quote(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    text.lines()
        .filter(|line| !line.trim().is_empty())
        .try_for_each(|line| writeln!(f, "    {line}"))
}

fn no_interpreter(f: &mut fmt::Formatter<'_>, rejected: &[(String, Rejection)]) -> fmt::Result {
    let found: Vec<_> = rejected
        .iter()
        .filter(|(_, reason)| !matches!(reason, Rejection::NotFound))
        .collect();
    if found.is_empty() {
        let names: Vec<_> = rejected.iter().map(|(name, _)| name.as_str()).collect();
        writeln!(f, "no Python found: none of {}", names.join(", "))?;
    } else {
        writeln!(f, "no Python found that can install CasADi:")?;
        for (name, reason) in found {
            writeln!(f, "    {name}: {reason}")?;
        }
    }
    write!(
        f,
        "to do: install Python {} or newer with pip (Debian, Ubuntu: apt install python3 \
         python3-pip; Fedora: dnf install python3-pip), or let DALEMBERT_PYTHON name an \
         interpreter that already has CasADi",
        super::python::OLDEST
    )
}

fn install(
    f: &mut fmt::Formatter<'_>,
    package: &str,
    python: &Path,
    lock: &Path,
    cause: InstallCause,
    output: &str,
) -> fmt::Result {
    let (python, lock) = (python.display(), lock.display());
    match cause {
        InstallCause::NothingFound => writeln!(
            f,
            "cannot fetch {package}: pip of {python} reaches no package registry, or the registry \
             has no file for this platform (there is none for musl, say)"
        )?,
        InstallCause::HashMismatch => writeln!(
            f,
            "refused {package}: a fetched file is not the one that {lock} pins \
             by its hash"
        )?,
        InstallCause::Other => writeln!(f, "cannot install {package}: pip of {python} failed")?,
    }
    match cause {
        InstallCause::NothingFound => {
            writeln!(f, "to do, one of:")?;
            writeln!(
                f,
                "    with a network: check the connection, or the proxy and index that pip uses \
                 (PIP_PROXY, PIP_INDEX_URL, PIP_CERT, PIP_CONFIG_FILE are passed on)"
            )?;
            writeln!(
                f,
                "    without: on a machine of the same kind that has one, `python3 -m pip download \
                 --no-deps --only-binary :all: --require-hashes -r {lock} -d \
                 wheels`; copy the folder wheels here and build with PIP_NO_INDEX=1 \
                 PIP_FIND_LINKS=/path/to/wheels"
            )?;
            writeln!(
                f,
                "    or let DALEMBERT_PYTHON name an interpreter that already has {package}"
            )?;
        }
        InstallCause::HashMismatch => writeln!(
            f,
            "to do: find out who changed the file (a mirror, a proxy, a folder of wheels); pip \
             names it below"
        )?,
        InstallCause::Other => writeln!(
            f,
            "to do: remove the cause that pip names below, or let DALEMBERT_PYTHON name an \
             interpreter that already has {package}"
        )?,
    }
    writeln!(f, "pip says:")?;
    // One of pip's retries tells why; the others tell the same.
    let mut retries = 0;
    let words: Vec<_> = output
        .lines()
        .filter(|line| {
            retries += usize::from(line.contains("Retrying ("));
            !line.contains("Retrying (") || retries == 1
        })
        .collect();
    quote(f, &words.join("\n"))
}

fn models(f: &mut fmt::Formatter<'_>, failures: &[ModelFailure]) -> fmt::Result {
    for failure in failures {
        if let Some(fault) = &failure.fault {
            writeln!(f, "{fault}")?;
        } else {
            writeln!(
                f,
                "{}: code generation ended with {} and did not name the fault; Python says:",
                failure.folder, failure.status
            )?;
            quote(f, &failure.output)?;
        }
    }
    Ok(())
}
