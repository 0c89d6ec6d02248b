//! `dalembert precision`.

mod json;
mod page;
mod write;

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use super::folders::{self, Needs};
use super::interrupt::{self, Interruptible};
use super::outcome::{Outcome, Result};
use super::page::write_page;
use super::pictures::PictureArguments;
use super::print;
use super::run::refusal;
use crate::precision::Study;
use crate::record::plot::Appearance;
use crate::record::{OutputFolder, Silent};
use crate::scene::Scene;

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Every method runs the scene at the tolerances 1e-3 … 1e-13, one after the other on one thread. The \
reference is a run at 1e-14 by another method; what two such runs by different methods differ by, and \
the rounding of their steps, bounds its error, and smaller errors than that are shown as \"≤ bound\". \
Where the two have different events, or at times that differ by a thousandth, or stop early, the \
scene is compared up to there.

The error of the end is the largest of a coordinate or velocity over what a relative tolerance of 1 \
would allow: its typical size (absolute ÷ relative tolerance of the scene) and its magnitude. Events \
are the same if the names of their transitions are, in their order. An accumulation has infinitely \
many, of which a tighter tolerance records more: those that only one run records right before a rest \
of both are counted as `in tails`, not as missed or extra.

Times are the least of repeats, without preparation and ledger. A method that takes twenty times as \
long as Radau is given up.

The advice names the fastest tolerance whose error, and that of all tighter ones, is at most the \
wanted one, with every event found. There the error is that of the end, or that of an event's time \
over the duration of the run, whichever is larger, and the bound comes on top.

--out DIR writes precision.csv and precision.svg. --json prints, instead of the tables, an object with \
`rows` (a run each, as in precision.csv; null where there is nothing), `reference` (what they were \
compared with, its bounds, its horizon where it is not determined to the end of the scene) and `advice` \
(for each wanted error the method and tolerance, or why there is none). Errors are relative, times in s, \
energies in J.

Ctrl-C ends the study; what was done so far is \
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
    /// Also write a page with a plot that zooms
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    pictures: PictureArguments,
    /// Print JSON
    #[arg(long)]
    json: bool,
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
    /// How its plot looks.
    appearance: Appearance,
}

pub fn precision(arguments: &PrecisionArguments) -> Result {
    let scene = Scene::load(
        &arguments.scene,
        &arguments.overrides,
        &folders::models(Needs::One),
    )?;
    let problem = &scene.problem;
    let folder = arguments.out.as_deref().map(OutputFolder::new);
    let folder = folder.transpose()?;
    let appearance = arguments.pictures.appearance()?;
    if folder.is_none() {
        arguments.pictures.refuse_without_plots()?;
    }
    interrupt::listen()?;

    let style = ProgressStyle::with_template("{bar:30} {pos} of {len} runs  {elapsed}");
    let bar = ProgressBar::new(0).with_style(style.expect("the template is well-formed"));
    let study = Study::new(problem, &mut Interruptible(Silent), |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    interrupt::leave();
    let precision = Precision {
        title: problem.title.clone().unwrap_or(problem.model.name.into()),
        study: study.map_err(|reason| refusal(&scene, &reason))?,
        errors: arguments.error.clone(),
        appearance,
    };
    if let Some(folder) = &folder {
        precision.write(folder)?;
    }
    if let Some(path) = &arguments.html {
        write_page(path, &precision.page(&scene))?;
    }
    match arguments.json {
        true => print::output(format_args!("{:#}", precision.json()))?,
        false => print::output(&precision)?,
    }
    Ok(match precision.study.is_complete() {
        true => Outcome::Done,
        false => Outcome::StoppedEarly,
    })
}
