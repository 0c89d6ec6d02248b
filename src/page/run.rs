//! The page of a run.

use super::frames::Motion;
use super::plots::{Column, Plot};
use super::table::number;
use super::{Cell, Page, Table};
use crate::model::Parameter;
use crate::record::plot::{Appearance, Grouped, grouped, portraits, symbol};
use crate::record::{ColumnKind, Run, Sketch, Summary, Units};

/// What a page tells besides the run.
#[derive(Debug, Clone, Copy)]
pub struct Told<'a> {
    /// What the model draws ([`crate::model::Variant::drawing`]); empty for nothing.
    pub drawing: &'a str,
    /// The parameters of the model ([`crate::model::Model::parameters`]): their units and meanings.
    pub parameters: &'a [Parameter],
    /// The scene as it was run.
    pub scene: &'a str,
    /// The command that made the run.
    pub command: &'a str,
    /// The reader's units.
    pub units: &'a Units,
}

/// The page of a run, with the curves of a sketch of it.
pub fn run_page(run: &Run, sketch: &Sketch, told: Told) -> String {
    let summary = Summary::new(run);
    // A page shows all of a run; what to look at is chosen on it.
    let everything = Appearance::default();
    let (groups, constants) = grouped(run, sketch, &everything);
    let drawn: Vec<usize> = groups.iter().flat_map(|g| g.columns.clone()).collect();
    let motion = Motion::new(run, sketch, told.drawing, &drawn);
    let mut page = Page::new(match summary.title.is_empty() {
        true => &summary.model,
        false => &summary.title,
    });
    page.set_units(told.units);
    head(&mut page, &summary);
    page.body.push_str(CONTROLS);
    page.heading("Over time");
    page.body.push_str(
        "<p class=\"faint\"><span class=\"hint\">Drag to zoom all plots, double-click for the whole run, click to go to a time; \
         transitions are the marks at the top of each plot. </span>Modes: <span id=\"modes\"></span></p>\n",
    );
    let (mut thinned, mut is_any_drawn) = (None, false);
    for group in &groups {
        let plot = columns(sketch, group);
        thinned = thinned.or(plot.thinned());
        for reason in plot.left_out() {
            page.note(reason);
        }
        if !plot.is_empty() {
            page.plot(plot);
            is_any_drawn = true;
        }
    }
    if is_any_drawn {
        page.body.push_str(
            "<div class=\"plot\"><div class=\"below\">time t <span data-unit=\"s\"></span></div></div>\n",
        );
        match (thinned, sketch.is_whole()) {
            (None, true) => page.note(BETWEEN),
            (None, false) => page.note(LINES),
            (Some(_), _) => {}
        }
    }
    if let Some([kept, all]) = thinned {
        let all = all.max(sketch.taken());
        page.note(&format!(
            "Curves keep {kept} of {all} points: of each part of the run the first and those with the least and the largest \
             value, so that no extreme is lost; zoomed in until they lie apart they are marked by dots. What lies between them is in \
             trajectory.csv."
        ));
    }
    if groups.is_empty() {
        page.note("Nothing that was recorded changes, so there is nothing to draw over time.");
    }
    if !constants.is_empty() {
        page.note(&constants);
    }
    motion.notes.iter().for_each(|note| page.note(note));
    let portraits = portraits(run, sketch, &everything);
    if !portraits.is_empty() {
        page.heading("Phase portraits");
        page.body.push_str("<div class=\"side-by-side\">\n");
        portraits
            .iter()
            .for_each(|chart| page.plot(Plot::of_path(chart)));
        page.body.push_str("</div>\n");
    }
    tables(&mut page, &summary, sketch);
    parameters(&mut page, &summary, told.parameters);
    page.source("The scene", told.command, told.scene);
    page.data.motion = Some(motion);
    page.finish()
}

/// The picture of the mechanism and what plays it.
const CONTROLS: &str = "<div id=\"stage\"><canvas id=\"picture\" tabindex=\"0\" role=\"img\" \
aria-label=\"the mechanism in motion\"></canvas><div id=\"readout\"></div><div id=\"forces\"></div></div>
<div class=\"bar\"><button id=\"play\" title=\"space\">play</button>
<input type=\"range\" id=\"time\" min=\"0\" max=\"1\" step=\"any\" value=\"0\" aria-label=\"time\">
<label>speed <select id=\"speed\" title=\"+ and −\"></select></label>
<label title=\"c\"><input type=\"checkbox\" id=\"with-forces\"> contacts and forces</label></div>
<div class=\"bar\" id=\"magnify\"><button id=\"magnify-small\">magnify small motions</button></div>
<p class=\"faint hint\">Keys: space plays, ← and → go from frame to frame, Home and End, + and − change the speed, i and o \
zoom in and out about the time shown, 0 shows the whole run, c contacts and forces.</p>
";

/// What curves are between the points that a page has of them.
const BETWEEN: &str = "Curves are those of the run at its rows, at up to 32 points of each step and on both sides of each \
transition. Zoom in until these lie apart and dots mark them: between them coordinates follow the cubic through values and \
rates, rates its derivative, and all else straight lines.";

/// The same where not everything is kept, as of a run that goes on with the files of an earlier one.
const LINES: &str = "Of a part of this run there are rows or extremes alone, so curves are straight lines between what is kept: zoom \
in until dots mark it.";

/// The curves of a group.
fn columns(sketch: &Sketch, group: &Grouped) -> Plot {
    let column = |&i: &usize| &sketch.columns()[i];
    let Some(first) = group.columns.first() else {
        return Plot::of_columns("1", &[], Vec::new(), false);
    };
    let t: Vec<f64> = sketch.curve(*first).map(|(t, _)| t).collect();
    let columns = group.columns.iter().map(|i| Column {
        name: &column(i).name,
        symbol: symbol(&column(i).name),
        meaning: match column(i).group {
            // Of a rate the symbol says it all.
            ColumnKind::Velocity => "",
            _ => &column(i).meaning,
        },
        y: sketch.curve(*i).map(|(_, x)| x).collect(),
    });
    let whole = sketch.is_whole();
    Plot::of_columns(&column(first).unit, &t, columns.collect(), whole)
}

/// Model, choices, and how the run ended.
fn head(page: &mut Page, summary: &Summary) {
    let choices: String = (summary.choices.0.iter())
        .map(|(choice, option)| format!(" · {choice}: {option}"))
        .collect();
    page.paragraph(&format!("{}{choices}", summary.model));
    match &summary.failure {
        None => page.paragraph(&format!(
            "Reached t = {} s in mode {}, after {} transitions.",
            number(summary.end.t),
            summary.end.mode,
            summary.events.total
        )),
        Some(failure) => page.alarm(&format!(
            "Stopped early at t = {} s in mode {}: {}",
            number(failure.at.t),
            failure.at.mode,
            failure.reason
        )),
    }
    for state in &summary.reached.limit_states {
        let (name, t, message) = (&state.name, number(state.t), &state.message);
        page.paragraph(&format!("Limit state {name} at t = {t} s: {message}."));
    }
    for left in &summary.reached.validity {
        let (condition, message) = (&left.condition, &left.message);
        let from = (left.t).map_or(String::new(), |t| format!(" from t = {} s on", number(t)));
        page.alarm(&format!("Not {condition}{from}: {message}."));
    }
}

/// Extremes, transitions, energies.
fn tables(page: &mut Page, summary: &Summary, sketch: &Sketch) {
    let end = &summary.end;
    let at_end = |name: &str| end.state().find(|(n, _)| n == name).map(|(_, x)| *x);
    let meaning = |name: &str| match sketch.column(name) {
        Some(i) => sketch.columns()[i].meaning.clone(),
        None => String::new(),
    };
    page.heading("Extremes");
    let heads = ["", "unit", "end", "min", "at t", "max", "at t", "meaning"];
    let mut table = Table::new(heads);
    table = table.unit(4, "s").unit(6, "s");
    for (name, p) in &summary.peaks.0 {
        let number = |x: f64, unit: &str| Cell::Number(x, unit.to_owned());
        table.row([
            Cell::from(name.clone()),
            Cell::Unit(p.unit.clone()),
            at_end(name).map_or("".into(), |x| number(x, &p.unit)),
            number(p.min, &p.unit),
            number(p.t_min, "s"),
            number(p.max, &p.unit),
            number(p.t_max, "s"),
            Cell::from(meaning(name)),
        ]);
    }
    page.table(&table);
    if summary.events.total > 0 {
        page.heading("Transitions");
        let mut table =
            Table::new(["", "count", "energy lost", "of them with a gain"]).unit(2, "J");
        for (name, count) in summary.events.by_transition.iter() {
            let impacts = &summary.impacts.by_transition.0;
            let lost = impacts.iter().find(|(n, _)| n == name).map(|(_, i)| i);
            table.row([
                Cell::from(*name),
                Cell::plain(*count as f64),
                lost.map_or("".into(), |i| Cell::Number(i.lost, "J".into())),
                lost.map_or("".into(), |i| Cell::plain(i.gaining as f64)),
            ]);
        }
        page.table(&table);
    }
    if let Some(energy) = &summary.energy {
        page.heading("Energies");
        let mut table = Table::new(["", "energy"]).unit(1, "J");
        for (name, x) in [
            ("initial", energy.initial),
            ("+ input work", energy.input_work),
            ("− dissipated", energy.dissipated),
            ("− lost at impacts", energy.lost_at_impacts),
            ("= final", energy.final_),
            ("imbalance", energy.imbalance),
        ] {
            table.row([Cell::from(name), Cell::Number(x, "J".into())]);
        }
        page.table(&table);
        page.note(&format!("Frame: {}.", energy.frame));
    }
}

/// The parameters with their units and meanings, and how much work the run was.
fn parameters(page: &mut Page, summary: &Summary, of_model: &[Parameter]) {
    page.heading("Parameters");
    let mut table = Table::new(["", "value", "unit", "meaning"]);
    for (name, x) in &summary.parameters.0 {
        let known = of_model.iter().find(|p| p.name == name);
        let (unit, meaning) = known.map_or(("1", ""), |p| (p.unit, p.meaning));
        table.row([
            Cell::from(name.clone()),
            Cell::Number(*x, unit.to_owned()),
            Cell::Unit(unit.to_owned()),
            Cell::from(meaning),
        ]);
    }
    page.table(&table);
    let solver = &summary.solver;
    page.note(&format!(
        "{}: {} steps, {} rejected; {} s.",
        solver.method,
        solver.steps,
        solver.rejected,
        number(summary.wall_seconds)
    ));
}
