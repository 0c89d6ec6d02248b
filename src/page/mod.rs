//! Self-contained pages: plots that zoom and are linked, the mechanism in motion, tables, what made them.
//!
//! A [`Page`] is put together from parts: text, tables ([`Table`]), plots (a [`Chart`] of [`crate::record::plot`], as
//! static pictures show it), and what runs it again. [`run_page`] adds the mechanism of a run. The result is one file
//! without links to a network: data as JSON, scripts, a style, and uPlot (Leon Sorokin, MIT licence,
//! `assets/uplot-LICENSE`), which draws axes. Whatever comes from a scene or a model is escaped, in script data too.
//!
//! | asset | subject |
//! |---|---|
//! | `assets/page.js` | numbers, units of the reader's choice, light and dark |
//! | `assets/plots.js` | curves, zoom, values read out |
//! | `assets/mechanism.js` | the drawing of a model (`codegen/drawing.py`) at a time |
//! | `assets/player.js` | playing, keys |
//! | `assets/matrix.js` | the points of a study in plots of its columns against each other |

mod escape;
mod frames;
#[cfg(feature = "cli")]
mod matrix;
mod plots;
mod run;
#[cfg(feature = "cli")]
pub(crate) mod study;
mod table;
mod thin;

pub use run::{Told, run_page};
pub use table::{Cell, Table};

use crate::record::Units;
use crate::record::plot::Chart;
use escape::{script_data, text};
use frames::Motion;
#[cfg(feature = "cli")]
use matrix::Matrix;
use plots::Plot;
use serde::Serialize;
use std::fmt::Write;

const SCRIPTS: [&str; 2] = [
    include_str!("assets/page.js"),
    include_str!("assets/plots.js"),
];
/// Scripts of pages with a motion.
const OF_MOTION: [&str; 2] = [
    include_str!("assets/mechanism.js"),
    include_str!("assets/player.js"),
];
/// The style, which the report of `verify` has too: `codegen/page.css`, which the build puts there.
const STYLE: &str = include_str!(concat!(env!("OUT_DIR"), "/page.css"));
const PLOTS: &str = include_str!("assets/uplot.js");
const PLOTS_STYLE: &str = include_str!("assets/uplot.css");
const PLOTS_LICENCE: &str = include_str!("assets/uplot-LICENSE");

/// A page, to which parts are added in the order in which they are to stand.
#[derive(Debug)]
pub struct Page {
    title: String,
    body: String,
    data: Data,
}

/// Everything that the scripts read.
#[derive(Debug, Default, Serialize)]
struct Data {
    /// The reader's units, by the units of models that they stand for.
    units: Units,
    plots: Vec<Plot>,
    /// Of the page of a run.
    motion: Option<Motion>,
    /// Of the page of a study.
    #[cfg(feature = "cli")]
    matrix: Option<Matrix>,
}

impl Page {
    /// A page with this title, which also is its first heading.
    pub fn new(title: &str) -> Page {
        Page {
            title: title.to_owned(),
            body: format!("<h1>{}</h1>\n", text(title)),
            data: Data::default(),
        }
    }

    /// In which units numbers are shown first; the reader can choose others on the page.
    pub fn set_units(&mut self, units: &Units) {
        self.data.units = units.clone();
    }

    /// A heading.
    pub fn heading(&mut self, words: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", text(words));
    }

    /// A paragraph.
    pub fn paragraph(&mut self, words: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", text(words));
    }

    /// What is said on the side.
    pub fn note(&mut self, words: &str) {
        let _ = writeln!(self.body, "<p class=\"faint\">{}</p>", text(words));
    }

    /// What is wrong.
    pub fn alarm(&mut self, words: &str) {
        let _ = writeln!(self.body, "<p class=\"alarm\">{}</p>", text(words));
    }

    /// A text as it is, line by line.
    pub fn listing(&mut self, lines: &str) {
        let _ = writeln!(self.body, "<pre>{}</pre>", text(lines.trim_end()));
    }

    /// A table.
    pub fn table(&mut self, table: &Table) {
        self.body.push_str(&table.html());
    }

    /// A plot. Plots over the same quantity and unit on linear axes, such as time, zoom together.
    pub fn chart(&mut self, chart: &Chart) {
        self.chart_with_notes(chart, &[]);
    }

    /// A plot whose points, curve by curve, have notes, such as the command that makes a point again: a click on a
    /// point shows its note, to be copied.
    pub fn chart_with_notes(&mut self, chart: &Chart, notes: &[Vec<String>]) {
        let plot = Plot::new(chart, notes);
        for reason in plot.left_out() {
            self.note(reason);
        }
        self.plot(plot);
    }

    fn plot(&mut self, plot: Plot) {
        self.body.push_str(&plot.html(self.data.plots.len()));
        self.data.plots.push(plot);
    }

    /// What makes the page again: a command, and the text of the file that it reads.
    pub fn source(&mut self, what: &str, command: &str, file: &str) {
        self.heading(what);
        self.paragraph("Made by");
        self.listing(command);
        self.listing(file);
    }

    /// The page as HTML.
    pub fn finish(self) -> String {
        let mut page = String::new();
        let mut put = |part: &str| page.push_str(part);
        put("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n");
        put("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
        put(&format!("<title>{}</title>\n", text(&self.title)));
        put(&format!(
            "<style>\n{PLOTS_STYLE}\n{STYLE}</style>\n</head><body>\n"
        ));
        put("<div class=\"bar tools\" id=\"tools\"></div>\n");
        put(
            "<noscript><p class=\"alarm\">Plots and motion need JavaScript, which is switched off here.</p></noscript>\n",
        );
        put(&self.body);
        let version = env!("CARGO_PKG_VERSION");
        put(&format!(
            "<p class=\"faint\">dalembert {version}. Axes: uPlot, MIT licence.</p>\n"
        ));
        put(&format!(
            "<script type=\"application/json\" id=\"data\">{}</script>\n",
            script_data(&self.data)
        ));
        put(&format!(
            "<script>\n/* {PLOTS_LICENCE} */\n{PLOTS}\n</script>\n"
        ));
        put("<script>\n\"use strict\";\n(() => {\n");
        SCRIPTS.iter().for_each(|script| put(script));
        if self.data.motion.is_some() {
            OF_MOTION.iter().for_each(|script| put(script));
        }
        #[cfg(feature = "cli")]
        if self.data.matrix.is_some() {
            put(matrix::SCRIPT);
        }
        put("})();\n</script>\n</body></html>\n");
        page
    }
}
