//! `dalembert run`.

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread;

use super::folders::{self, Needs};
use super::interrupt::{self, Interruptible};
use super::outcome::{Failure, Outcome, Result};
use super::outputs::Outputs;
use super::page::{command_line, write_page};
use super::pictures::{PictureArguments, WindowArguments, refuse_without_plots};
use super::{print, room, warnings, watch};
use crate::hybrid::{Invalid, Problem, Reason, check_same, simulate_from, simulate_with};
use crate::model::Models;
use crate::page::{Told, run_page};
use crate::precision::{COMPARED, Ended, estimate, other, unsettled};
use crate::record::plot::Appearance;
use crate::record::{
    Doubt, Earlier, OutputFolder, ProgressLine, Question, Report, Run, Silent, Sketch,
};
use crate::scene::{Disk, Files, Scene};

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Ctrl-C ends the simulation at its next step or row; what was computed is written, with status 3. A second \
Ctrl-C, or one that comes when the simulation is over and its pictures are drawn, ends it at once, and \
nothing is written.

--resume continues the run in DIR, whether it was interrupted or reached its end, to the end of \
the scene: `dalembert run SCENE --resume out --set end=10`. Model, choices, parameters, inputs, \
initial state, accuracy, method, frozen coordinates, columns and the grid of the samples must be those of the \
run, and its files as they were written; what does not fit is named. It goes on from the last checkpoint of the run, \
of which one is taken every second or so; a shorter run, and one whose end is earlier now than it was, is done again from its start. So the result is, to the last bit, that \
of a run that was never left. Pictures have straight lines between the rows before the checkpoint; where nothing is left to run the \
folder stays as it is.

A second run at a tenth of its tolerance goes beside a run, on another core, of which the first 4000 events alone are kept: \
where another event follows there, the report says so under `uncertain`. It ends with the run at the latest; \
`wall_seconds` is the time of the run alone. Where there is one core it comes after the run and takes about as long.

--error-estimate runs the scene a second time, by another method at a tolerance ten thousand \
times tighter (1e-14 at most), and reports what the two differ by: coordinates and velocities at the end, \
times of events, events that only one of them has. In summary.json it is `error_estimate`. Where there \
is no estimate, the reason is said and the status is 3. Radau stands in where Taylor \
takes twenty times as long. `dalembert precision` has more.")]
pub struct RunArguments {
    /// Scene file (JSON); docs/scene.md describes it
    scene: PathBuf,
    /// Folder for tables and plots; without it only the report is shown
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace a value of the scene, such as `parameters.mu_s=0.3`; may be given several times
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Also write a page with plots that zoom and the mechanism in motion
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Panels of the plots over time, from top to bottom: columns such as theta or theta.rate, several in one panel
    /// as theta+phi, and coordinates, velocities, reactions, energies, inputs
    #[arg(long, value_name = "PANEL,…", value_delimiter = ',')]
    plot_panels: Vec<String>,
    #[command(flatten)]
    window: WindowArguments,
    #[command(flatten)]
    pictures: PictureArguments,
    /// Continue the run in this folder, and write the longer run to --out, or back
    #[arg(long, value_name = "DIR")]
    resume: Option<PathBuf>,
    /// Estimate the error of the run by a second, better one
    #[arg(long)]
    error_estimate: bool,
    /// Run again whenever the scene, its tables or its model change, until Ctrl-C
    #[arg(long, conflicts_with = "resume")]
    watch: bool,
}

pub fn run(arguments: &RunArguments) -> Result {
    if !arguments.watch {
        return once(arguments, &Disk, folders::models(Needs::One));
    }
    watch::whenever_changed(|watched| {
        let seen = watched.clone();
        let models = folders::models_seen(Needs::One, move |folder| seen.note_model(folder));
        once(arguments, watched, models)
    })
}

/// A single run of a scene, read from `files`.
fn once(arguments: &RunArguments, files: &dyn Files, models: Models) -> Result {
    if arguments.error_estimate && arguments.resume.is_some() {
        return Err(Failure::wrong_input(
            "--error-estimate and --resume cannot be given together: the estimate compares a run with \
             a better one from the start, of which a resumed run has not all events at hand; run the scene from \
             its start, without --resume",
        ));
    }
    let scene = Scene::load_from(files, &arguments.scene, &arguments.overrides, &models)?;
    let problem = &scene.problem;
    let earlier = match &arguments.resume {
        Some(folder) => {
            let (model, variant) = (&problem.model, problem.variant());
            let earlier = Earlier::open(folder, model, variant, problem.layout());
            let earlier = earlier.map_err(Failure::wrong_input)?;
            check_same(problem, &earlier.run)
                .map_err(|reason| other_run(&scene, folder, &reason))?;
            Some((folder, earlier))
        }
        None => None,
    };
    // Before the simulation, so that a folder that cannot be written costs no time.
    let layout = problem.layout();
    let appearance = Appearance {
        window: arguments.window.window(),
        panels: arguments.plot_panels.clone(),
        ..arguments.pictures.appearance()?
    };
    if arguments.out.is_none() && arguments.resume.is_none() {
        let panels = !arguments.plot_panels.is_empty();
        arguments.pictures.refuse_without_plots()?;
        refuse_without_plots("--plot-window", appearance.window.is_some())?;
        refuse_without_plots("--plot-panels", panels)?;
    }
    let shown = appearance.check(&layout);
    shown.map_err(|message| Failure::wrong_input(format!("--plot-panels: {message}")))?;
    let out = arguments.out.as_ref().or(arguments.resume.as_ref());
    let folder = out.map(|path| OutputFolder::new(path)).transpose()?;
    room::check_disk(&scene, out.map(PathBuf::as_path))?;

    warnings::before(problem);
    let page = arguments.html.is_some();
    let compared = match arguments.error_estimate {
        true => usize::MAX,
        false => COMPARED,
    };
    let mut outputs = Outputs::new(
        (&layout, problem.end.time),
        folder.as_ref(),
        (page, appearance.window),
        compared,
    );
    let mut from = None;
    if let Some((folder, mut earlier)) = earlier {
        let kept = earlier.checkpoint().map_err(Failure::wrong_input)?;
        let kept = kept.filter(|kept| kept.end <= problem.end.time);
        let replayed = outputs.replay(problem, &mut earlier, kept.as_ref());
        let tally = replayed.map_err(Failure::wrong_input)?;
        // Pictures are drawn from the dense output of the steps, and an earlier run has left no more of it than rows: where nothing is
        // left to run the folder stays as it is.
        let stays = !page && arguments.out.is_none() && appearance == Appearance::default();
        if stays && has_ended(problem, &earlier.run) {
            print::output(Report::new(&earlier.run).in_units(&appearance.units))?;
            return Ok(Outcome::Done);
        }
        if let Some(kept) = kept {
            let checkpoint = kept.checkpoint.clone();
            outputs.checkpoints.go_on(kept);
            from = Some((folder, earlier.run, checkpoint, tally));
        }
    }
    let before = outputs.spent();
    interrupt::listen()?;
    let mut progress = Interruptible(ProgressLine::new(problem.end.time));
    let ended = Ended::default();
    let other = || other(problem, &ended, &mut Interruptible(Silent));
    // Of a run that goes on with an earlier one the first events are not at hand; what was in doubt there is told again.
    let is_judged = from.is_none();
    // The other run takes nobody's time on a core of its own.
    let at_once = is_judged && thread::available_parallelism().is_ok_and(|cores| cores.get() > 1);
    let (run, other) = thread::scope(|scope| {
        let beside = at_once.then(|| scope.spawn(other));
        let run = match &from {
            None => simulate_with(problem, &mut outputs, &mut progress),
            Some((_, _, checkpoint, tally)) => {
                let from = (checkpoint, tally.clone());
                simulate_from(problem, from, &mut outputs, &mut progress)
            }
        };
        let end = run.as_ref().map_or(f64::NEG_INFINITY, |run| run.end.t);
        ended.at(end);
        let other = match beside {
            Some(beside) => beside.join().unwrap_or_else(|cause| resume_unwind(cause)),
            None => is_judged.then(other).flatten(),
        };
        (run, other)
    });
    drop(progress);
    let mut run = run.map_err(|reason| match (&reason, &from) {
        (Reason::Checkpoint(_), Some((folder, ..))) => other_run(&scene, folder, &reason),
        _ => refusal(&scene, &reason),
    })?;
    run.wall = run.wall.saturating_sub(outputs.spent() - before);
    if let Some((_, earlier, checkpoint, _)) = &from {
        run.wall += outputs.checkpoints.before();
        let unsettled =
            |doubt: &&Doubt| doubt.what == Question::Unsettled && doubt.t <= checkpoint.time();
        let doubts = earlier.uncertain.first.iter().filter(unsettled);
        doubts
            .cloned()
            .for_each(|doubt| run.uncertain.add_earlier(doubt));
    }
    let doubt = other.and_then(|other| unsettled(problem, &run, &outputs.events(), &other));
    doubt
        .into_iter()
        .for_each(|doubt| run.uncertain.add_earlier(doubt));
    let mut no_estimate = None;
    if arguments.error_estimate {
        let mut progress = Interruptible(ProgressLine::new(problem.end.time));
        run.events = outputs.events();
        match estimate(problem, &run, &mut progress) {
            Ok(error) => run.error = Some(error),
            Err(reason) => no_estimate = Some(reason),
        }
    }
    interrupt::leave();
    // The report is shown also where files cannot be written.
    let report = Report::new(&run).in_units(&appearance.units);
    print::output(&report)?;
    warnings::after(report.summary());
    let Outputs {
        mut stream,
        sketch,
        checkpoints,
        ..
    } = outputs;
    if let Some(stream) = &mut stream {
        stream.checkpoint = checkpoints.kept;
    }
    let sketch = sketch.unwrap_or_else(|| Sketch::new(&layout));
    let written = stream.map(|stream| stream.finish(&run, &sketch, &appearance));
    if let Some(page) = &arguments.html {
        let told = Told {
            drawing: problem.variant().drawing,
            parameters: &problem.model.parameters,
            scene: &scene.source.json(),
            command: &command_line(),
            units: &appearance.units,
        };
        write_page(page, &run_page(&run, &sketch, told))?;
    }
    written.transpose()?;
    if let Some(reason) = &no_estimate {
        print::error(format!("no estimate of the error: {reason}"));
    }
    match &run.failure {
        None if no_estimate.is_some() => Ok(Outcome::StoppedEarly),
        None => Ok(Outcome::Done),
        Some(failure) => {
            let (t, reason) = (failure.at.t, &failure.reason);
            print::error(format!("stopped early at t = {t} s: {reason}"));
            if let Some(out) = out
                && interrupt::asked()
            {
                print::error(format!("continue with --resume {}", out.display()));
            }
            Ok(Outcome::StoppedEarly)
        }
    }
}

/// Whether a run has come to the end of a problem.
fn has_ended(problem: &Problem, run: &Run) -> bool {
    let after = problem.end.after;
    run.end.t >= problem.end.time
        || after.is_some_and(|(name, count)| run.tally.count(name) as u64 >= count)
}

/// Why a run cannot be continued with a scene, pointing at the line of it that does not fit.
fn other_run(scene: &Scene, folder: &Path, reason: &Reason) -> Failure {
    let path = match reason {
        Reason::OtherRun { path, .. } => path,
        _ => "",
    };
    let help = Some("continue it with the scene it was made with");
    let message = format!("{}: {reason}", folder.display());
    scene.source.error_at(path, message, help).into()
}

/// What to do about a state beyond a stop.
fn beyond(may_project: bool) -> &'static str {
    match may_project {
        true => {
            "start on the admissible side, or let it be moved there: `\"initial\": { …, \"project\": true }`"
        }
        false => "start on the admissible side",
    }
}

/// Why a scene cannot even be started, pointing at the part of it that is to blame.
pub fn refusal(scene: &Scene, reason: &Reason) -> Failure {
    let may_project = scene.problem.variant().has_inadmissible() && !scene.problem.project;
    let (path, help) = match reason {
        Reason::NoModeLeft { .. } => ("freeze".into(), "freeze fewer coordinates"),
        Reason::Invalid(Invalid::BeyondStop { coordinate, .. }) => {
            (format!("initial.{coordinate}"), beyond(may_project))
        }
        Reason::Beyond { of, .. } => (format!("initial.{of}"), beyond(may_project)),
        Reason::Initial { .. } if may_project => (
            "initial".into(),
            "change the initial state, or let it be moved: `\"initial\": { …, \"project\": true }`",
        ),
        Reason::NoRest { .. } => (
            "initial".into(),
            "give coordinates nearer to where it rests, `\"initial\": { …, \"at_rest\": true }`, or an initial state",
        ),
        _ => (
            "initial".into(),
            "change the initial state, or name another mode in `initial.mode`",
        ),
    };
    let source = &scene.source;
    source
        .error_at(&path, reason.to_string(), Some(help))
        .into()
}
