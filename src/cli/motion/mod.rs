//! `dalembert motion`.

mod charts;
mod json;
mod page;
mod write;

use std::path::{Path, PathBuf};

use super::outcome::{Failure, Outcome, Result};
use super::page::write_page;
use super::pictures::{PictureArguments, WindowArguments, refuse_without_plots};
use super::print;
use crate::motion::{Channel, Given, Measures, Ordinate, Unit, ordinate};
use crate::record::OutputFolder;
use crate::record::plot::Appearance;
use crate::scene::{Record, SceneError};

/// Periods of a spectrum that names none: from `FIRST` to `LAST`, s, spread evenly by their logarithm.
const FIRST: f64 = 0.01;
const LAST: f64 = 10.0;
const COUNT: usize = 91;

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Formats are recognised by content: PEER AT2, K-NET and KiK-net, ESM (DYNA 1.2), COSMOS V1.20, SMC, CESMD V2, \
and columns of numbers; docs/motions.md describes them. A file is held against its own header; where they \
contradict each other, that is a warning, or an error where values are missing.

Velocity and displacement are zero at the first sample. Everything is exact for accelerations that are linear \
between samples and zero outside, but for peak velocity and displacement, which are those at samples. The \
spectrum is ω² times the largest displacement of an oscillator relative to the ground, at any time, also after \
the record.

--json prints an object (for several files a list of them) in m and s: `file`, `format`, `channels` (`name`, \
`unit` of the file, `dt`, null where steps differ, `points`, `duration`, `pga` with `value`, `signed` and `t`, \
`pgv`, `pgd`, `arias`, `significant_duration`, `mean`, `end_velocity`, `end_displacement`), `spectrum` of the \
first of these channels (`channel`, `damping`, `periods`, `psa_samples` at samples, `psa` at any time), `spectra` \
of all, and `notes`.

--out DIR writes measures and spectra as tables, and plots: acceleration, velocity, displacement, the growth of the \
Arias intensity (Husid plot), spectra of pseudo-acceleration, pseudo-velocity and displacement. --html FILE writes \
them as one page.")]
pub struct MotionArguments {
    /// Record files
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Periods of the spectrum, s, separated by commas; by default 91 from 0.01 to 10 s
    #[arg(long, value_name = "T,…", value_delimiter = ',', value_parser = period)]
    periods: Vec<f64>,
    /// Damping ratio of the spectrum
    #[arg(long, value_name = "RATIO", default_value_t = 0.05, value_parser = damping)]
    damping: f64,
    /// Only this channel, by name or by number from 1
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// Subtract the mean of the samples
    #[arg(long)]
    remove_mean: bool,
    /// Unit of the values, if the file states none: g, m/s^2, cm/s^2, …
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    unit: Option<Unit>,
    /// Step in s, if the file states none
    #[arg(long, value_name = "SECONDS", value_parser = period)]
    dt: Option<f64>,
    /// Folder for tables and plots
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Also write a page with plots that zoom
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    window: WindowArguments,
    #[command(flatten)]
    pictures: PictureArguments,
}

fn period(text: &str) -> std::result::Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(time) if time > 0.0 && time.is_finite() => Ok(time),
        _ => Err("it is a positive number of seconds, such as 0.5".into()),
    }
}

fn damping(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(ratio) if (0.0..1.0).contains(&ratio) => Ok(ratio),
        _ => Err("a damping ratio is from 0 to below 1, such as 0.05".into()),
    }
}

fn unit(text: &str) -> std::result::Result<Unit, String> {
    Unit::parse(text).ok_or_else(|| {
        let known: Vec<_> = Unit::names().collect();
        format!("known units: {}", known.join(", "))
    })
}

/// A channel and what is told of it.
#[derive(Debug)]
struct Told {
    channel: Channel,
    measures: Measures,
    /// One for each period.
    spectrum: Vec<Ordinate>,
}

/// A file and what is told of it.
struct File<'a> {
    path: &'a Path,
    record: Record,
    channels: Vec<Told>,
}

/// The files, with the periods and the damping of the spectra, and how plots look.
struct Report<'a> {
    files: Vec<File<'a>>,
    periods: Vec<f64>,
    damping: f64,
    appearance: Appearance,
}

pub fn motion(arguments: &MotionArguments) -> Result {
    let appearance = Appearance {
        window: arguments.window.window(),
        ..arguments.pictures.appearance()?
    };
    if arguments.out.is_none() {
        arguments.pictures.refuse_without_plots()?;
        refuse_without_plots("--plot-window", appearance.window.is_some())?;
    }
    let out = arguments.out.as_ref();
    let folder = out.map(|path| OutputFolder::new(path)).transpose()?;
    let periods = if arguments.periods.is_empty() {
        let ratio = (LAST / FIRST).ln() / (COUNT - 1) as f64;
        (0..COUNT)
            .map(|i| FIRST * (ratio * i as f64).exp())
            .collect()
    } else {
        arguments.periods.clone()
    };
    let files: std::result::Result<Vec<_>, _> = arguments
        .files
        .iter()
        .map(|path| file(path, arguments, &periods))
        .collect();
    let report = Report {
        files: files?,
        periods,
        damping: arguments.damping,
        appearance,
    };
    if let Some(folder) = &folder {
        report.write(folder)?;
    }
    if let Some(path) = &arguments.html {
        write_page(path, &report.page())?;
    }
    if arguments.json {
        print::output(format_args!("{:#}", report.json()))?;
    } else {
        print::output(&report)?;
    }
    for file in &report.files {
        for note in file.record.motion.notes.iter().filter(|note| note.doubt) {
            let (path, line) = (file.path.display(), file.record.line(note));
            print::error(format!("warning: {path}:{line}: {}", note.message));
        }
    }
    Ok(Outcome::Done)
}

fn file<'a>(
    path: &'a Path,
    arguments: &MotionArguments,
    periods: &[f64],
) -> std::result::Result<File<'a>, Failure> {
    let bytes = std::fs::read(path).map_err(|e| SceneError::unreadable(path.to_owned(), &e))?;
    let given = Given {
        unit: arguments.unit,
        dt: arguments.dt,
    };
    let record = Record::read(&bytes, path, &given)?;
    let channels = match &arguments.channel {
        None => record.motion.channels.iter().collect(),
        Some(name) => {
            let found = record.channel(Some(name)).map_err(|(message, names)| {
                let names = names.join("`, `");
                Failure::wrong_input(format!("{}: {message}; it has `{names}`", path.display()))
            })?;
            vec![found]
        }
    };
    let told = |channel: &Channel| {
        let mut channel = channel.clone();
        if arguments.remove_mean {
            channel.samples = channel.samples.without_mean();
        }
        let samples = &channel.samples;
        Told {
            measures: Measures::of(samples),
            spectrum: periods
                .iter()
                .map(|&t| ordinate(samples, t, arguments.damping))
                .collect(),
            channel,
        }
    };
    let channels = channels.into_iter().map(told).collect();
    Ok(File {
        path,
        record,
        channels,
    })
}
