//! What pictures and pages are to look like: arguments that commands share.

use super::outcome::Failure;
use crate::record::Units;
use crate::record::plot::{Appearance, Format, LEAST};
use clap::builder::PossibleValuesParser;

#[derive(Debug, Clone, clap::Args)]
pub struct UnitsArguments {
    /// Show lengths, times, angles, forces, … in these units: mm,ms,deg,kN; tables in files keep the model's
    #[arg(long, value_name = "UNIT,…", value_delimiter = ',')]
    units: Vec<String>,
}

#[derive(Debug, Clone, clap::Args)]
pub struct PictureArguments {
    /// Width and height of plots in pixels, such as 1200x800
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size)]
    plot_size: Option<(f64, f64)>,
    /// Formats of plots: svg, png, pdf; svg if absent
    #[arg(long, value_name = "FORMAT,…", value_delimiter = ',', value_parser = formats())]
    plot_format: Vec<String>,
    #[command(flatten)]
    units: UnitsArguments,
}

#[derive(Debug, Clone, clap::Args)]
pub struct WindowArguments {
    /// Plot this part of the time only, in s, such as 0.2:0.5
    #[arg(long, value_name = "FROM:TO", value_parser = window)]
    plot_window: Option<(f64, f64)>,
}

impl UnitsArguments {
    /// The units.
    pub fn units(&self) -> Result<Units, Failure> {
        Units::new(self.units.iter().map(String::as_str))
            .map_err(|message| Failure::wrong_input(format!("--units: {message}")))
    }
}

impl PictureArguments {
    /// How pictures look, with all of time and all panels.
    pub fn appearance(&self) -> Result<Appearance, Failure> {
        let named = |name: &String| Format::ALL.iter().find(|f| f.ending() == name).copied();
        let mut formats: Vec<Format> = self.plot_format.iter().filter_map(named).collect();
        formats.dedup();
        let is_png = |format: &&Format| format.ending() == "png";
        if let (Some(png), Some((width, height))) = (formats.iter().find(is_png), self.plot_size)
            && !png.has_room((width, height))
        {
            return Err(Failure::wrong_input(format!(
                "--plot-size: a PNG of {width}x{height}, with two pixels on each, has more than 100 million; choose a smaller \
                 size, or pdf or svg"
            )));
        }
        Ok(Appearance {
            units: self.units.units()?,
            size: self.plot_size,
            formats,
            ..Appearance::default()
        })
    }
}

impl PictureArguments {
    /// For a command without a folder for plots, which these arguments would say nothing about.
    pub fn refuse_without_plots(&self) -> Result<(), Failure> {
        refuse_without_plots("--plot-size", self.plot_size.is_some())?;
        refuse_without_plots("--plot-format", !self.plot_format.is_empty())
    }
}

/// Refuses an argument about plots where none are written.
pub fn refuse_without_plots(argument: &str, is_given: bool) -> Result<(), Failure> {
    match is_given {
        false => Ok(()),
        true => Err(Failure::wrong_input(format!(
            "{argument} says how plots look, and none are written without a folder; add --out DIR, or leave it out (a page \
             shows all of a run, and its reader zooms there)"
        ))),
    }
}

impl WindowArguments {
    /// The window, s.
    pub fn window(&self) -> Option<(f64, f64)> {
        self.plot_window
    }
}

/// The formats of this build, by their endings.
fn formats() -> PossibleValuesParser {
    PossibleValuesParser::new(Format::ALL.iter().map(|format| format.ending()))
}

fn size(text: &str) -> Result<(f64, f64), String> {
    let (width, height) = LEAST;
    let wrong =
        || format!("a size is two numbers of pixels, at least {width}x{height}, such as 1200x800");
    let (w, h) = text.split_once(['x', '×']).ok_or_else(wrong)?;
    // A picture of more pixels is no picture that a program opens.
    let number = |text: &str, least: f64| {
        let found = text.trim().parse::<u32>().ok().map(f64::from);
        found
            .filter(|n| (least..=20_000.0).contains(n))
            .ok_or_else(wrong)
    };
    Ok((number(w, width)?, number(h, height)?))
}

fn window(text: &str) -> Result<(f64, f64), String> {
    let wrong = "a window is two times in s, the first before the second, such as 0.2:0.5";
    let (from, to) = text.split_once(':').ok_or(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|t| t.is_finite());
    match (number(from), number(to)) {
        (Some(from), Some(to)) if from < to => Ok((from, to)),
        _ => Err(wrong.into()),
    }
}
