//! `dalembert verify`: runs the verification, which is written in Python, with the interpreter that
//! the build has provided (`codegen/build/lib.rs`).

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::outcome::{Failure, Outcome, Result};

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Runs codegen/verify, which codegen/verify/README.md describes, with the interpreter that the build \
has found or provided. The environment variable DALEMBERT_PYTHON names another one, which must \
have SymPy.")]
pub struct VerifyArguments {
    /// Name of the model, or path of its folder
    #[arg(required_unless_present = "seeded")]
    model: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Also write a page with the equations typeset and the differing terms marked
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Skip the proof of definiteness over the whole box of parameters
    #[arg(long)]
    quick: bool,
    /// Exit with status 1 where there is a misprint, or any finding
    #[arg(long, value_parser = ["misprint", "finding"])]
    fail_on: Option<String>,
    /// Findings that --fail-on excuses: lines `id: reason`
    #[arg(long, value_name = "FILE", requires = "fail_on")]
    waivers: Option<PathBuf>,
    /// Instead, put errors into correct equations and show which judgement finds which
    #[arg(long, conflicts_with_all = ["model", "html", "quick", "fail_on"])]
    seeded: bool,
}

/// Variable that names another interpreter, at build time and here.
const SETTING: &str = "DALEMBERT_PYTHON";

/// Folder with `codegen/` and `models/`.
const PROJECT: &str = env!("CARGO_MANIFEST_DIR");

pub fn verify(arguments: &VerifyArguments) -> Result {
    let sources = Path::new(PROJECT).join("codegen").join("verify");
    if !sources.is_dir() {
        return Err(Failure::system(format!(
            "the verification is run from the sources that dalembert was built from, and {} is \
             gone; build it again where the sources are",
            sources.display()
        )));
    }
    let (program, mut command) = python()?;
    command
        .args(["-B", "-m", "codegen", "verify"])
        .current_dir(PROJECT);
    if let Some(model) = &arguments.model {
        // A name comes first: a folder of that name where the command is given is its output.
        let is_name = Path::new(PROJECT).join("models").join(model).is_dir();
        let is_folder = !is_name && model.is_dir();
        command.arg(if is_folder {
            absolute(model)?
        } else {
            model.clone()
        });
    }
    for (flag, given) in [
        ("--json", arguments.json),
        ("--quick", arguments.quick),
        ("--seeded", arguments.seeded),
    ] {
        command.args(given.then_some(flag));
    }
    if let Some(html) = &arguments.html {
        command.arg("--html").arg(absolute(html)?);
    }
    if let Some(kind) = &arguments.fail_on {
        command.args(["--fail-on", kind]);
    }
    if let Some(waivers) = &arguments.waivers {
        command.arg("--waivers").arg(absolute(waivers)?);
    }
    // The verification simulates what each slip does to the model's scenes.
    if !arguments.seeded
        && let Ok(own) = env::current_exe()
    {
        command.arg("--program").arg(own);
    }
    let status = command.status().map_err(|error| {
        let program = program.display();
        Failure::system(format!("{program} does not run: {error}; {}", advice()))
    })?;
    match status.code() {
        Some(0) => Ok(Outcome::Done),
        // What is wrong with the input has been said by the verification itself.
        Some(2) => Err(Failure::Reported { wrong_input: true }),
        _ => Err(Failure::Reported { wrong_input: false }),
    }
}

/// The interpreter and a command that runs it, independent of the caller's Python environment.
fn python() -> std::result::Result<(PathBuf, Command), Failure> {
    let named = env::var_os(SETTING).filter(|value| !value.is_empty());
    let (program, packages) = match named {
        Some(program) => (PathBuf::from(program), OsString::new()),
        None => (
            PathBuf::from(env!("DALEMBERT_PYTHON_EXE")),
            OsString::from(env!("DALEMBERT_PYTHON_PATH")),
        ),
    };
    let mut command = Command::new(&program);
    for (name, _) in env::vars_os() {
        if name
            .to_str()
            .is_some_and(|name| name.starts_with("PYTHON") || name == "VIRTUAL_ENV")
        {
            command.env_remove(name);
        }
    }
    // Without packages and start-up code of the user's own site.
    command.arg("-s").env("PYTHONUTF8", "1");
    if !packages.is_empty() {
        if !Path::new(&packages).is_dir() {
            let packages = Path::new(&packages).display();
            return Err(Failure::system(format!(
                "the Python packages of the build, {packages}, are gone; {}",
                advice()
            )));
        }
        command.arg("-S").env("PYTHONPATH", packages);
    }
    Ok((program, command))
}

/// What to do where Python or its packages are gone.
fn advice() -> String {
    format!("build dalembert again, or let {SETTING} name an interpreter that has SymPy")
}

fn absolute(path: &Path) -> std::result::Result<PathBuf, Failure> {
    std::path::absolute(path)
        .map_err(|error| Failure::wrong_input(format!("{}: {error}", path.display())))
}
