//! `dalembert run`.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::interrupt::{self, Interruptible};
use super::outcome::{Failure, Outcome, Result};
use super::{print, room, warnings};
use crate::hybrid::{Invalid, Problem, Reason, resume, simulate};
use crate::model::models;
use crate::page::{Told, run_page};
use crate::precision::estimate;
use crate::record::{OutputFolder, ProgressLine, Report, Run};
use crate::scene::Scene;

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Ctrl-C ends the simulation at its next step; what was computed is written, with status 3. A second \
Ctrl-C ends it at once, and nothing is written.

--resume continues the run in DIR, whether it was interrupted or reached its end, to the end of \
the scene: `dalembert run SCENE --resume out --set end=10`. Model, choices, parameters, inputs, \
initial state, accuracy, method, frozen coordinates, columns and the grid of the samples must be those of the \
run, and its files as they were written; what does not fit is named. The integrator starts anew at \
the last state, so the result is that of an uninterrupted run up to the accuracy, not to the bit.

--error-estimate runs the scene a second time, by another method at a tolerance ten thousand \
times tighter (1e-14 at most), and reports what the two differ by: coordinates and velocities at the end, \
times of events, events that only one of them has. In summary.json it is `error_estimate`. Where there \
is no estimate, the reason is said and the status is 3. Radau stands in where Taylor has no series or \
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
    /// Continue the run in this folder, and write the longer run to --out, or back
    #[arg(long, value_name = "DIR")]
    resume: Option<PathBuf>,
    /// Estimate the error of the run by a second, better one
    #[arg(long)]
    error_estimate: bool,
}

pub fn run(arguments: &RunArguments) -> Result {
    if arguments.error_estimate && arguments.resume.is_some() {
        return Err(Failure::wrong_input(
            "--error-estimate and --resume cannot be given together: the estimate compares a run with \
             a better one from the start, and a resumed run starts anew on the way; run the scene from \
             its start, without --resume",
        ));
    }
    let scene = Scene::load(&arguments.scene, &arguments.overrides, models())?;
    let problem = &scene.problem;
    let earlier = match &arguments.resume {
        Some(folder) => Some(
            Run::read(
                folder,
                &problem.model,
                problem.variant(),
                problem.record.columns,
            )
            .map_err(Failure::wrong_input)?,
        ),
        None => None,
    };
    // Before the simulation, so that a folder that cannot be written costs no time.
    let out = arguments.out.as_ref().or(arguments.resume.as_ref());
    let folder = out.map(|path| OutputFolder::new(path)).transpose()?;
    room::check(&scene, out.map(PathBuf::as_path))?;

    warnings::before(problem);
    interrupt::listen()?;
    let mut progress = Interruptible(ProgressLine::new(problem.end.time));
    let run = match earlier {
        None => simulate(problem, &mut progress),
        Some(earlier) => resume(problem, earlier, &mut progress),
    };
    drop(progress);
    let mut run = run.map_err(|reason| match (&reason, &arguments.resume) {
        (Reason::OtherRun { .. }, Some(folder)) => Failure::wrong_input(format!(
            "{}: {reason}; continue it with the scene it was made with",
            folder.display()
        )),
        _ => refusal(&scene, &reason),
    })?;
    let mut no_estimate = None;
    if arguments.error_estimate {
        let mut progress = Interruptible(ProgressLine::new(problem.end.time));
        match estimate(problem, &run, &mut progress) {
            Ok(error) => run.error = Some(error),
            Err(reason) => no_estimate = Some(reason),
        }
    }
    // The report is shown also where files cannot be written.
    let written = folder.as_ref().map(|folder| run.write(folder));
    let page =
        (arguments.html.as_ref()).map(|page| write_page(page, &run, &arguments.scene, problem));
    let report = Report::new(&run);
    print::output(&report)?;
    warnings::after(report.summary());
    written.transpose()?;
    page.transpose()?;
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

/// Writes the page of a run, whole or not at all.
fn write_page(
    path: &Path,
    run: &Run,
    scene: &Path,
    problem: &Problem,
) -> std::result::Result<(), Failure> {
    let failed = |error: &dyn std::fmt::Display| {
        Failure::system(format!("cannot write the page {}: {error}", path.display()))
    };
    let arguments: Vec<String> = std::env::args().skip(1).map(|a| quoted(&a)).collect();
    let text = std::fs::read_to_string(scene).unwrap_or_default();
    let page = run_page(
        run,
        Told {
            drawing: problem.variant().drawing,
            scene: &text,
            command: &format!("dalembert {}", arguments.join(" ")),
        },
    );
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::fs::Permissions;
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(Permissions::from_mode(0o666)); // less the umask
    }
    let mut file = builder
        .tempfile_in(folder.unwrap_or(Path::new(".")))
        .map_err(|e| failed(&e))?;
    file.write_all(page.as_bytes())
        .and_then(|()| file.as_file().sync_all())
        .map_err(|e| failed(&e))?;
    file.persist(path).map_err(|e| failed(&e.error))?;
    Ok(())
}

/// An argument as a shell takes it.
fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-=+,:@%".contains(c);
    match !argument.is_empty() && argument.chars().all(plain) {
        true => argument.to_owned(),
        false => format!("'{}'", argument.replace('\'', "'\\''")),
    }
}

/// Why a scene cannot even be started, pointing at the part of it that is to blame.
pub fn refusal(scene: &Scene, reason: &Reason) -> Failure {
    let (path, help) = match reason {
        Reason::NoModeLeft { .. } => ("freeze".into(), "freeze fewer coordinates"),
        Reason::NoSeries { .. } => ("method".into(), "choose `auto` or `radau`"),
        Reason::Invalid(Invalid::BeyondStop { coordinate, .. }) => (
            format!("initial.{coordinate}"),
            "start on the admissible side",
        ),
        Reason::Beyond { of, .. } => (format!("initial.{of}"), "start on the admissible side"),
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
