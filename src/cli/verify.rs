//! `dalembert verify`: runs the verification, which is written in Python and travels inside the program.

use std::env;
use std::path::{Path, PathBuf};

use include_dir::{Dir, include_dir};

use super::outcome::{Failure, Outcome, Result};

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Runs codegen/verify, which docs/verification.md describes, with a Python that is found, and packages \
that are installed for it once. The environment variable DALEMBERT_PYTHON names another one, which must have CasADi and \
SymPy. A name is that of a model inside the program; anything else is a folder.")]
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
    /// Also write a LaTeX file of it, for pdflatex
    #[arg(long, value_name = "FILE")]
    latex: Option<PathBuf>,
    /// Also write claims that the script check_certificate.py checks again, with SymPy alone
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
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
    #[arg(long, conflicts_with_all = ["model", "html", "latex", "certificate", "quick", "fail_on"])]
    seeded: bool,
}

/// What ships with the program: names of models that are verified, and the scenes in which slips are simulated.
static SHIPPED: [Dir; 2] = [
    include_dir!("$CARGO_MANIFEST_DIR/models"),
    include_dir!("$CARGO_MANIFEST_DIR/scenes"),
];

pub fn verify(arguments: &VerifyArguments) -> Result {
    let mut shipped = Vec::new();
    for (folder, name) in SHIPPED.iter().zip(["models", "scenes"]) {
        collect(folder, Path::new(name), &mut shipped);
    }
    let shipped: Vec<_> = (shipped.iter())
        .map(|(name, content)| (&**name, *content))
        .collect();
    let verification = dalembert_build::verification(&shipped, &super::folders::progress)?;
    let folder = verification.folder.clone();
    let mut command = verification.command;
    if let Some(model) = &arguments.model {
        // A name comes first: a folder of that name where the command is given is its output.
        let is_name = folder.join("models").join(model).is_dir();
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
    for (option, file) in [
        ("--html", &arguments.html),
        ("--latex", &arguments.latex),
        ("--certificate", &arguments.certificate),
    ] {
        if let Some(file) = file {
            command.arg(option).arg(absolute(file)?);
        }
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
        let program = Path::new(command.get_program()).display();
        Failure::system(format!("{program} does not run: {error}"))
    })?;
    match status.code() {
        Some(0) => Ok(Outcome::Done),
        // What is wrong with the input has been said by the verification itself.
        Some(2) => Err(Failure::Reported { wrong_input: true }),
        _ => Err(Failure::Reported { wrong_input: false }),
    }
}

/// The files of a folder inside the program, by their names in a folder `name`. What Python leaves beside its sources is none.
fn collect(folder: &Dir<'static>, name: &Path, files: &mut Vec<(PathBuf, &'static [u8])>) {
    for file in folder.files() {
        files.push((name.join(file.path()), file.contents()));
    }
    for inner in folder
        .dirs()
        .filter(|inner| !inner.path().ends_with("__pycache__"))
    {
        collect(inner, name, files);
    }
}

fn absolute(path: &Path) -> std::result::Result<PathBuf, Failure> {
    std::path::absolute(path)
        .map_err(|error| Failure::wrong_input(format!("{}: {error}", path.display())))
}
