//! `dalembert compare`.

mod measures;
mod page;
mod write;

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use super::folders::{self, Needs};
use super::interrupt::{self, Interruptible};
use super::outcome::{Failure, Outcome, Result};
use super::page::write_page;
use super::pictures::{PictureArguments, WindowArguments, refuse_without_plots};
use super::run::refusal;
use super::{models, print, room};
use crate::hybrid::simulate_with;
use crate::model::Model;
use crate::record::plot::Appearance;
use crate::record::{OutputFolder, Run, Silent, Sketch};
use crate::scene::Scene;

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Each variant is a combination of the options of the model's choices (`dalembert describe MODEL` \
lists them). A variant that is refused, or that stops early, says why and where, below the table; \
that is a result, so the status is 0. Ctrl-C ends all simulations; status 3.

--out DIR writes the table as comparison.csv, and a plot over time for each coordinate.")]
pub struct CompareArguments {
    /// Scene file (JSON)
    scene: PathBuf,
    /// Vary this choice only, such as `rules`; may be given several times; by default all choices
    #[arg(long, value_name = "CHOICE")]
    vary: Vec<String>,
    /// Folder for the table and the plots
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Also write a page with plots that zoom
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    window: WindowArguments,
    #[command(flatten)]
    pictures: PictureArguments,
    /// Replace a value of the scene in all variants, such as `parameters.mu_s=0.3`
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
}

/// A comparison of the variants of a model on one scene.
#[derive(Debug)]
struct Comparison<'m> {
    model: &'m Model,
    /// How its plots look.
    appearance: Appearance,
    /// Names of the choices that vary.
    choices: Vec<&'static str>,
    cases: Vec<Case>,
}

/// One variant.
#[derive(Debug)]
struct Case {
    /// Options of the choices that vary.
    options: Vec<&'static str>,
    /// The run, complete or stopped early, with its curves, or why there is none.
    run: std::result::Result<(Run, Sketch), String>,
}

impl Case {
    /// The options in words.
    fn label(&self) -> String {
        self.options.join(" · ")
    }
}

pub fn compare(arguments: &CompareArguments) -> Result {
    let scene = Scene::load(
        &arguments.scene,
        &arguments.overrides,
        &folders::models(Needs::All),
    )?;
    let model = &*scene.problem.model;
    let varied = varied(model, &arguments.vary)?;
    let folder = arguments
        .out
        .as_deref()
        .map(OutputFolder::new)
        .transpose()?;
    let appearance = Appearance {
        window: arguments.window.window(),
        ..arguments.pictures.appearance()?
    };
    if folder.is_none() {
        arguments.pictures.refuse_without_plots()?;
        refuse_without_plots("--plot-window", appearance.window.is_some())?;
    }
    interrupt::listen()?;

    let combinations = combinations(model, &varied);
    let style = ProgressStyle::with_template("{bar:30} {pos} of {len} variants  {elapsed}");
    let bar = ProgressBar::new(combinations.len() as u64)
        .with_style(style.expect("the template is well-formed"));
    let variants = combinations.len();
    let cases = combinations.into_par_iter().map(|options| {
        let case = case(model, &varied, options, (arguments, variants));
        bar.inc(1);
        case
    });
    let comparison = Comparison {
        model,
        appearance,
        choices: varied.iter().map(|&i| model.choices[i].name).collect(),
        cases: cases.collect(),
    };
    bar.finish_and_clear();
    interrupt::leave();

    if let Some(folder) = &folder {
        comparison.write(folder)?;
    }
    if let Some(path) = &arguments.html {
        write_page(path, &comparison.page(&scene))?;
    }
    print::output(&comparison)?;
    Ok(if interrupt::asked() {
        Outcome::StoppedEarly
    } else {
        Outcome::Done
    })
}

/// Indices of the choices that vary.
fn varied(model: &Model, names: &[String]) -> std::result::Result<Vec<usize>, Failure> {
    if model.choices.is_empty() {
        let name = model.name;
        return Err(Failure::wrong_input(format!(
            "the model `{name}` has no choices, so there is nothing to compare; run the scene \
             twice with different `--set` instead"
        )));
    }
    if names.is_empty() {
        return Ok((0..model.choices.len()).collect());
    }
    let known: Vec<&str> = model.choices.iter().map(|c| c.name).collect();
    let mut varied = Vec::new();
    for name in names {
        let i = models::place("choice", name, &known)?;
        if !varied.contains(&i) {
            varied.push(i);
        }
    }
    Ok(varied)
}

/// The combinations of options that the model offers for the choices that vary, in its order.
fn combinations(model: &Model, varied: &[usize]) -> Vec<Vec<&'static str>> {
    let mut combinations = Vec::new();
    for variant in &model.variants {
        let options = varied.iter().map(|&i| variant.options[i]).collect();
        if !combinations.contains(&options) {
            combinations.push(options);
        }
    }
    combinations
}

/// Reads the scene once more under these options, and runs it: whatever the scene says is checked
/// against the variant, such as the name of a mode.
fn case(
    model: &Model,
    varied: &[usize],
    options: Vec<&'static str>,
    (arguments, variants): (&CompareArguments, usize),
) -> Case {
    let settings = varied.iter().zip(&options);
    let settings = settings.map(|(&i, option)| format!("{}={option}", model.choices[i].name));
    let overrides: Vec<String> = arguments
        .overrides
        .iter()
        .cloned()
        .chain(settings)
        .collect();
    let run = Scene::load(&arguments.scene, &overrides, &folders::models(Needs::All))
        .map_err(|errors| errors.to_string())
        .and_then(|scene| {
            room::check_memory(&scene, variants).map_err(|error| error.to_string())?;
            let mut sketch = Sketch::new(&scene.problem.layout());
            let run = simulate_with(&scene.problem, &mut sketch, &mut Interruptible(Silent));
            let run = run.map_err(|reason| refusal(&scene, &reason).to_string())?;
            Ok((run, sketch))
        });
    Case { options, run }
}
