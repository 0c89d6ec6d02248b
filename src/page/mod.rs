//! Self-contained pages: plots that zoom and are linked, the mechanism in motion, tables, the scene as it was run.
//!
//! A page is one file without links to a network: data as JSON, one script, one style, and uPlot (Leon Sorokin, MIT
//! licence, `assets/uplot-LICENSE`), which draws the plots. The script evaluates the model's drawing
//! (`codegen/drawing.py`) at key frames. Whatever comes from a scene or a model is escaped, in script data too.

mod data;
mod escape;
mod tables;
mod thin;

use crate::record::{Run, Sketch, Summary};
use data::Data;
use escape::{script_data, text};
use std::fmt::Write;

const SCRIPT: &str = include_str!("assets/page.js");
const STYLE: &str = include_str!("assets/page.css");
const PLOTS: &str = include_str!("assets/uplot.js");
const PLOTS_STYLE: &str = include_str!("assets/uplot.css");
const PLOTS_LICENCE: &str = include_str!("assets/uplot-LICENSE");

/// What a page tells besides the run.
#[derive(Debug, Clone, Copy)]
pub struct Told<'a> {
    /// What the model draws ([`crate::model::Variant::drawing`]); empty for nothing.
    pub drawing: &'a str,
    /// Text of the scene file.
    pub scene: &'a str,
    /// The command that made the run.
    pub command: &'a str,
}

/// The page of a run, with the curves of a sketch of it.
pub fn run_page(run: &Run, sketch: &Sketch, told: Told) -> String {
    let summary = Summary::new(run);
    let data = Data::new(run, sketch, told.drawing);
    let title = match summary.title.is_empty() {
        true => &summary.model,
        false => &summary.title,
    };
    let mut page = String::new();
    let mut put = |part: &str| page.push_str(part);
    put("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n");
    put("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    put(&format!("<title>{}</title>\n", text(title)));
    put(&format!(
        "<style>\n{PLOTS_STYLE}\n{STYLE}</style>\n</head><body>\n"
    ));
    put(&format!("<h1>{}</h1>\n", text(title)));
    put(&tables::head(&summary));
    put(CONTROLS);
    put(
        "<h2>Over time</h2>\n<p class=\"faint\">Drag to zoom all panels, double-click for the whole run, click to go \
         to a time. Modes: <span id=\"modes\"></span></p>\n<div id=\"plots\"></div>\n",
    );
    put(&notes(&data));
    put(&tables::all(&summary));
    put("<h2>The scene</h2>\n");
    put(&format!(
        "<p>This run again:</p>\n<pre>{}</pre>\n",
        text(told.command)
    ));
    put(&format!("<pre>{}</pre>\n", text(told.scene.trim_end())));
    let version = env!("CARGO_PKG_VERSION");
    put(&format!(
        "<p class=\"faint\">dalembert {version}. Plots: uPlot, MIT licence.</p>\n"
    ));
    put(&format!(
        "<script type=\"application/json\" id=\"data\">{}</script>\n",
        script_data(&data)
    ));
    put(&format!(
        "<script>\n/* {PLOTS_LICENCE} */\n{PLOTS}\n</script>\n"
    ));
    put(&format!("<script>\n{SCRIPT}</script>\n</body></html>\n"));
    page
}

/// The picture of the mechanism and what plays it.
const CONTROLS: &str = "<div id=\"stage\"><canvas id=\"picture\" tabindex=\"0\" aria-label=\"the mechanism in motion\">\
</canvas><div id=\"readout\"></div><div id=\"forces\"></div></div>
<div class=\"bar\"><button id=\"play\" title=\"space\">play</button>
<input type=\"range\" id=\"time\" min=\"0\" max=\"1\" step=\"any\" value=\"0\" aria-label=\"time\">
<label>speed <select id=\"speed\" title=\"+ and −\"></select></label>
<label><input type=\"checkbox\" id=\"with-forces\"> reactions</label></div>
<div class=\"bar\" id=\"magnify\"><button id=\"magnify-small\">magnify small motions</button></div>
<p class=\"faint\">Keys: space plays, ← and → step from frame to frame, Home and End, + and − change the speed.</p>
";

/// What the plots leave out, and why.
fn notes(data: &Data) -> String {
    let mut notes = String::new();
    for note in &data.notes {
        let _ = writeln!(notes, "<p class=\"faint\">{}</p>", text(note));
    }
    notes
}
