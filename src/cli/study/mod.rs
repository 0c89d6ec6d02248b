//! `dalembert study`.

mod report;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};

use super::folders::{self, Needs};
use super::interrupt;
use super::outcome::{Failure, Outcome, Result};
use super::{print, room};
use crate::page::study::study_page;
use crate::study::{
    Column, Ended, Finished, Outcome as StudyOutcome, Shard, Study, StudyFolder, StudyFolderError,
    Watch, finish, finished, quoted, run,
};

#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_long_help = "\
A study varies a scene; docs/studies.md describes its file. DIR gets runs.parquet (a row a run), summary.json, study.json (the \
study as it was run), plots and a page; capacities.csv where capacities are searched. The same study gives the same bytes, \
whatever the number of threads, and however often it was interrupted.

Ctrl-C stops it; what is finished is kept, with status 3, and --resume goes on. A program that is killed loses what it \
computed in the last second. --shard 3/8 computes the third of eight parts; `dalembert study merge` puts them together.

A run that stops early, or a case that is no scene, is a row with the reason; the status is 0."
)]
pub struct StudyArguments {
    #[command(subcommand)]
    command: Option<Action>,
    #[command(flatten)]
    whole: Option<RunArguments>,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Put the parts of a study together that were computed by --shard
    Merge(MergeArguments),
}

#[derive(Debug, Args)]
struct RunArguments {
    /// Study file (JSON)
    study: PathBuf,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace a value of the study, such as `random.count=100`; may be given several times
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Go on with the study in DIR
    #[arg(long)]
    resume: bool,
    /// Compute a part alone, such as 3/8
    #[arg(long, value_name = "PART/OF", value_parser = shard)]
    shard: Option<Shard>,
    /// Write the table as CSV, too
    #[arg(long)]
    csv: bool,
    /// Number of threads; by default as many as there are processors
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

#[derive(Debug, Args)]
struct MergeArguments {
    /// Study file (JSON) that the parts are of
    study: PathBuf,
    /// Folders of the parts
    #[arg(required = true, value_name = "PART")]
    parts: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace a value of the study, as for the parts
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Write the table as CSV, too
    #[arg(long)]
    csv: bool,
}

/// `3/8`.
fn shard(text: &str) -> std::result::Result<Shard, String> {
    let parts = text.split_once('/');
    let number = |text: &str| text.parse::<u64>().ok();
    match parts.and_then(|(part, of)| Some((number(part)?, number(of)?))) {
        Some((part, of)) if part >= 1 && part <= of => Ok(Shard { part, of }),
        _ => Err("a part is such as 3/8: its number from 1, and how many there are".into()),
    }
}

impl From<StudyFolderError> for Failure {
    fn from(error: StudyFolderError) -> Self {
        match error {
            StudyFolderError::Io { .. } => Failure::system(error),
            _ => Failure::wrong_input(error),
        }
    }
}

pub fn study(arguments: &StudyArguments) -> Result {
    match (&arguments.command, &arguments.whole) {
        (Some(Action::Merge(merge)), _) => merged(merge),
        (None, Some(whole)) => computed(whole),
        (None, None) => Err(Failure::wrong_input("name a study file")),
    }
}

/// Reads a study whose results are to be in a folder.
fn load(path: &Path, overrides: &[String], out: &Path) -> std::result::Result<Study, Failure> {
    let models = folders::models(Needs::All);
    let room = |cases: f64| room::check_rows(cases, out);
    Ok(Study::load(path, overrides, &models, &room)?)
}

fn computed(arguments: &RunArguments) -> Result {
    let study = load(&arguments.study, &arguments.overrides, &arguments.out)?;
    let mut folder = StudyFolder::open(&arguments.out, &study.key, arguments.resume)?;
    if folder.is_complete() {
        let out = arguments.out.display();
        print::output(format_args!("{out}: the study is complete"))?;
        return Ok(Outcome::Done);
    }
    let mut known = folder.finished(study.measures.len())?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let cases = study.cases();
    let of_shard = (0..cases).filter(|&case| shard.has(case));
    let pending: Vec<u64> = of_shard.filter(|case| !known.contains_key(case)).collect();
    interrupt::listen()?;
    let mut line = Line::new(pending.len() as u64);
    let ended = in_pool(arguments.threads, || {
        run(&study, &pending, &mut folder, &mut line)
    })?;
    drop(line);
    interrupt::leave();
    known.extend(folder.finished(study.measures.len())?);
    if ended == Ended::Stopped {
        print::error(format!(
            "interrupted after {} of {cases} cases; go on with --resume",
            known.len()
        ));
        return Ok(Outcome::StoppedEarly);
    }
    if (known.len() as u64) < cases {
        print::output(format_args!(
            "{} of {cases} cases are finished; `dalembert study merge` puts parts together",
            known.len()
        ))?;
        return Ok(Outcome::Done);
    }
    let paths = (&*arguments.study, &*arguments.out);
    write(&study, &folder, &known, arguments.csv, paths)
}

fn merged(arguments: &MergeArguments) -> Result {
    let study = load(&arguments.study, &arguments.overrides, &arguments.out)?;
    let mut all = Finished::new();
    for part in &arguments.parts {
        for (case, rows) in finished(part, &study.key, study.measures.len())? {
            if all.get(&case).is_some_and(|known| !same(known, &rows)) {
                let part = part.display();
                return Err(Failure::wrong_input(format!(
                    "{part}: case {case} has another result than in another part, so one of them is not of this program; \
                     compute it again"
                )));
            }
            all.insert(case, rows);
        }
    }
    let cases = study.cases();
    if let Some(missing) = (0..cases).find(|case| !all.contains_key(case)) {
        let count = cases - all.len() as u64;
        return Err(Failure::wrong_input(format!(
            "{count} of {cases} cases are in none of these parts, the first is case {missing}; compute the shards that are missing, \
             or go on with those that were interrupted by --resume"
        )));
    }
    let folder = StudyFolder::open(&arguments.out, &study.key, false)?;
    let paths = (&*arguments.study, &*arguments.out);
    write(&study, &folder, &all, arguments.csv, paths)
}

/// Whether the rows of a case are the same to the bit.
fn same(one: &[crate::study::Row], other: &[crate::study::Row]) -> bool {
    // Values that are not there are NaN, which equals nothing.
    format!("{one:?}") == format!("{other:?}")
}

/// Writes the results and shows them.
fn write(
    study: &Study,
    folder: &StudyFolder,
    finished: &Finished,
    csv: bool,
    (file, out): (&Path, &Path),
) -> Result {
    // Results do not depend on the folder that they are in.
    let made_by = format!(
        "dalembert study {} --out DIR",
        quoted(&file.display().to_string())
    );
    let page = |outcome: &StudyOutcome, columns: &[Column], summary: &serde_json::Value| {
        study_page(outcome, columns, summary, &made_by)
    };
    let found = finish(study, folder, finished, csv, &page)?;
    print::output(report::Report { found: &found, out })?;
    Ok(Outcome::Done)
}

/// Does something on so many threads.
fn in_pool<T: Send>(
    threads: Option<u16>,
    work: impl FnOnce() -> std::result::Result<T, StudyFolderError> + Send,
) -> std::result::Result<T, Failure> {
    let Some(threads) = threads else {
        return Ok(work()?);
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build();
    let pool = pool.map_err(|e| Failure::system(format!("cannot start {threads} threads: {e}")))?;
    Ok(pool.install(work)?)
}

/// The progress of a study: how many cases are finished, how fast, and how long it will take.
struct Line {
    bar: ProgressBar,
}

impl Line {
    fn new(cases: u64) -> Line {
        let style = ProgressStyle::with_template(
            "{bar:30} {human_pos} of {human_len} cases, {per_sec}, {elapsed}, {eta} to go",
        );
        let bar = ProgressBar::new(cases).with_style(style.expect("the template is well-formed"));
        Line { bar }
    }
}

impl Watch for Line {
    fn progress(&mut self, finished: u64) -> ControlFlow<()> {
        self.bar.set_position(finished);
        match interrupt::asked() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
