//! `dalembert precision`.

mod write;

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use super::interrupt;
use super::outcome::{Failure, Outcome, Result};
use super::print;
use super::run::refusal;
use crate::kernel::MODELS;
use crate::precision::Study;
use crate::record::OutputFolder;
use crate::scene::Scene;

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Every method runs the scene at the tolerances 1e-3 … 1e-13, one after the other on one thread. The \
reference is a run at 1e-14 by another method; what two such runs by different methods differ by \
bounds its error, and smaller errors than that are shown as \"≤ bound\". The error of the end is the \
largest of a coordinate or velocity over its typical size (absolute ÷ relative tolerance of the \
scene). Times are the least of repeats, without preparation. A method that takes twenty times as \
long as Radau is given up.

The advice names the fastest tolerance whose error, and that of all tighter ones, is at most the \
wanted one, with every event found. There the error is that of the end, or that of an event's time \
over the duration of the run, whichever is larger.

--out DIR writes precision.csv and precision.svg. Ctrl-C ends the study; the rows done so far are \
shown and written, with status 3.")]
pub struct PrecisionArguments {
    /// Scene file (JSON)
    scene: PathBuf,
    /// Wanted error, for the advice; may be given several times
    #[arg(long, value_name = "ERROR", default_values_t = [1e-3, 1e-6, 1e-9], value_parser = wanted)]
    error: Vec<f64>,
    /// Folder for the table and the plot
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace a value of the scene, such as `parameters.mu_s=0.3`; may be given several times
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
}

/// A positive number.
fn wanted(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(error) if error > 0.0 && error.is_finite() => Ok(error),
        _ => Err("an error is a positive number, such as 1e-6".into()),
    }
}

/// A study and what is to be said about it.
#[derive(Debug)]
struct Precision {
    title: String,
    study: Study,
    /// Wanted errors.
    errors: Vec<f64>,
}

pub fn precision(arguments: &PrecisionArguments) -> Result {
    let scene = Scene::load(&arguments.scene, &arguments.overrides, MODELS)?;
    let problem = &scene.problem;
    let folder = arguments.out.as_deref().map(OutputFolder::new);
    let folder = folder.transpose()?;
    interrupt::listen()?;

    let style = ProgressStyle::with_template("{bar:30} {pos} of {len} runs  {elapsed}");
    let bar = ProgressBar::new(0).with_style(style.expect("the template is well-formed"));
    let study = Study::new(problem, &interrupt::asked, |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let study = study.map_err(|reason| refusal(&scene, &reason))?;
    if study.reference.is_none() {
        return Err(Failure::system(
            "interrupted before the reference was there: nothing can be compared",
        ));
    }
    let complete = study.complete;
    let precision = Precision {
        title: problem.title.clone().unwrap_or(problem.model.name.into()),
        study,
        errors: arguments.error.clone(),
    };
    if let Some(folder) = &folder {
        precision.write(folder)?;
    }
    print::output(&precision)?;
    Ok(match complete {
        true => Outcome::Done,
        false => Outcome::StoppedEarly,
    })
}
