//! `dalembert run`.

use super::{STOPPED_EARLY, WRONG_INPUT};
use crate::hybrid::simulate;
use crate::kernel::MODELS;
use crate::record::{OutputFolder, ProgressLine, Report};
use crate::scene::Scene;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, clap::Args)]
pub struct RunArguments {
    /// Scene file (JSON); docs/scene.md describes it
    scene: PathBuf,
    /// Folder for tables and plots; without it only the report is shown
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replaces a value of the scene, such as `parameters.mu_s=0.3`
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
}

pub fn run(arguments: &RunArguments) -> ExitCode {
    let scene = match Scene::load(&arguments.scene, &arguments.overrides, MODELS) {
        Ok(scene) => scene,
        Err(errors) => return wrong_input(&errors),
    };
    // Before the simulation, so that a folder that cannot be written costs no time.
    let folder = match arguments.out.as_deref().map(OutputFolder::new).transpose() {
        Ok(folder) => folder,
        Err(error) => return wrong_input(&format!("error: {error}")),
    };
    let problem = &scene.problem;
    let mut progress = ProgressLine::new(problem.end.time);
    let run = match simulate(problem, &mut progress) {
        Ok(run) => run,
        Err(reason) => {
            let help = "change the initial state, or name another mode in `initial.mode`";
            return wrong_input(
                &scene
                    .source
                    .error_at("initial", reason.to_string(), Some(help)),
            );
        }
    };
    drop(progress);
    if let Some(folder) = &folder
        && let Err(error) = run.write(folder)
    {
        return wrong_input(&format!("error: {error}"));
    }
    println!("{}", Report::new(&run));
    match &run.failure {
        None => ExitCode::SUCCESS,
        Some(failure) => {
            eprintln!(
                "stopped early at t = {} s: {}",
                failure.at.t, failure.reason
            );
            ExitCode::from(STOPPED_EARLY)
        }
    }
}

fn wrong_input(error: &dyn std::fmt::Display) -> ExitCode {
    eprintln!("{error}");
    ExitCode::from(WRONG_INPUT)
}
