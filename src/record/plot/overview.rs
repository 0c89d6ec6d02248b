//! A run on one page: everything over the same time.

use super::axis::{Axis, Scale};
use super::canvas::{Anchor, Canvas, Font, picture, text_width};
use super::palette::{ALARM, INK, LINE_COLOURS};
use super::panel::{
    Area, Curve, ROW, SMALL, TEXT, curves, entries, grid, horizontal_axis, legend, legend_height,
    range,
};
use super::strip::Strip;
use super::symbol::symbol;
use crate::record::number::rounded;
use crate::record::{Column, Group, Run, Sketch};

/// Width of the picture and of its margins, which hold the labels of the axes and, on the right,
/// the numbers of transitions.
const WIDTH: f64 = 960.0;
const LEFT: f64 = 104.0;
const RIGHT: f64 = 46.0;
const INNER: f64 = WIDTH - LEFT - RIGHT;
/// Height of the axes of a panel, and the space below them.
const PANEL: f64 = 92.0;
const GAP: f64 = 10.0;
/// Height of the labels and the title of the axis of time.
const TIME_AXIS: f64 = 38.0;
/// Height of the title.
const HEAD: f64 = 46.0;

/// A curve that takes less than this part of the height of a panel is not readable there: 9 px.
const READABLE: f64 = 0.1;
/// A quantity that varies by less than this part of its size varies by rounding alone.
const VARIES: f64 = 1e-12;

/// A space at which no line is broken.
const NO_BREAK: &str = "\u{a0}";

const TITLE: Font = Font {
    size: 15.0,
    colour: INK,
    bold: true,
};

/// The curves of one panel.
struct Panel {
    group: Group,
    unit: String,
    range: (f64, f64),
    /// Columns, with the range of each.
    columns: Vec<(usize, (f64, f64))>,
}

/// Draws inputs, coordinates, velocities, outputs, reactions and energies over time, one below the other,
/// with the modes and the transitions underneath, as SVG. Quantities of the same kind and unit
/// share a panel where each is readable there; those that never change are listed.
pub fn overview(run: &Run) -> String {
    overview_of(run, &Sketch::of(run))
}

/// The same from a sketch of a run.
pub(crate) fn overview_of(run: &Run, sketch: &Sketch) -> String {
    let (panels, constants) = panels(run, sketch);
    let time = time_axis(run, sketch);
    let strip = Strip::new(run, sketch);
    let with_curves = |panel| (panel_curves(sketch, &panel), panel);
    let panels: Vec<(Vec<Curve>, Panel)> = panels.into_iter().map(with_curves).collect();
    let notes = wrapped(&constants, INNER);
    let panel_height = |c: &[Curve]| legend_height(&entries(c), INNER) + PANEL + GAP;
    let height = HEAD
        + panels.iter().map(|(c, _)| panel_height(c)).sum::<f64>()
        + TIME_AXIS
        + strip.height(INNER)
        + notes.len() as f64 * ROW
        + 2.0 * GAP;
    picture(WIDTH, height, |canvas| {
        head(canvas, run);
        let mut top = HEAD;
        let mut last = Area {
            left: LEFT,
            top,
            width: INNER,
            height: 0.0,
        };
        for (c, panel) in &panels {
            let legend_entries = entries(c);
            legend(canvas, &legend_entries, (LEFT, top), INNER);
            top += legend_height(&legend_entries, INNER);
            last = Area {
                left: LEFT,
                top,
                width: INNER,
                height: PANEL,
            };
            let y = Axis::new(Scale::Linear, &panel.unit, panel.range, 0.06);
            grid(canvas, last, &time, &y, &axis_title(sketch, panel));
            curves(canvas, last, &time, &y, c, false);
            top += PANEL + GAP;
        }
        horizontal_axis(canvas, last, &time, "time t");
        top = last.bottom() + TIME_AXIS;
        strip.draw(canvas, &time, (LEFT, top), INNER);
        top += strip.height(INNER) + GAP;
        for note in &notes {
            canvas.text(note, (LEFT, top + ROW / 2.0), Anchor::Left, SMALL);
            top += ROW;
        }
    })
}

fn head(canvas: &mut Canvas, run: &Run) {
    let subject = &run.subject;
    let title = if subject.title.is_empty() {
        &subject.model
    } else {
        &subject.title
    };
    canvas.text(title, (LEFT, 16.0), Anchor::Left, TITLE);
    let choices = subject
        .choices
        .iter()
        .map(|(choice, option)| format!("{choice}: {option}"));
    let mut line: Vec<String> = std::iter::once(subject.model.clone())
        .chain(choices)
        .collect();
    let mut font = SMALL;
    if let Some(failure) = &run.failure {
        let place = format!("stopped early at t = {} s", rounded(failure.at.t, 6));
        line = vec![format!("{place}: {}", failure.reason)];
        font.colour = ALARM;
    }
    let line = wrapped(&line.join(" · "), WIDTH - LEFT);
    let first = line.first().map_or("", String::as_str);
    let more = if line.len() > 1 { " …" } else { "" };
    canvas.text(&format!("{first}{more}"), (LEFT, 34.0), Anchor::Left, font);
}

/// The axis from the first instant of a run to its end.
fn time_axis(run: &Run, sketch: &Sketch) -> Axis {
    let times = sketch.times().chain([run.end.t]);
    let (from, to) = range(times, |_| true).unwrap_or((0.0, 0.0));
    Axis::new(Scale::Linear, "s", (from, to), 0.0)
}

/// Divides the columns among panels; also a sentence about those that never change.
fn panels(run: &Run, sketch: &Sketch) -> (Vec<Panel>, String) {
    const ORDER: [Group; 6] = [
        Group::Input,
        Group::Coordinate,
        Group::Velocity,
        Group::Output,
        Group::Reaction,
        Group::Energy,
    ];
    let mut panels: Vec<Panel> = Vec::new();
    let mut constants = Vec::new();
    for group in ORDER {
        let start = panels.len();
        for i in run.layout.range(group) {
            let column = &sketch.columns()[i];
            let Some(range) = range(sketch.curve(i).map(|p| p.1), |_| true) else {
                continue;
            };
            if !varies(range) {
                let value = rounded(range.0, 6).replace('-', "−");
                let constant = format!("{} = {value} {}", column.name, column.unit);
                constants.push(constant.replace(' ', NO_BREAK));
                continue;
            }
            let fits = |panel: &&mut Panel| panel.takes(column, range);
            match panels[start..].iter_mut().find(fits) {
                Some(panel) => panel.add(i, range),
                None => panels.push(Panel {
                    group,
                    unit: column.unit.clone(),
                    range,
                    columns: vec![(i, range)],
                }),
            }
        }
    }
    let constants = match constants[..] {
        [] => String::new(),
        _ => format!("constant: {}", constants.join(", ")),
    };
    (panels, constants)
}

/// Columns that are drawn together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Grouped {
    /// What they are.
    pub group: Group,
    /// Their indices.
    pub columns: Vec<usize>,
}

/// How a run's columns are divided among panels, the response before the inputs; also a sentence about those that never
/// change.
pub(crate) fn grouped(run: &Run, sketch: &Sketch) -> (Vec<Grouped>, String) {
    let (panels, constants) = panels(run, sketch);
    let mut groups: Vec<Grouped> = (panels.into_iter())
        .map(|panel| Grouped {
            group: panel.group,
            columns: panel.columns.iter().map(|c| c.0).collect(),
        })
        .collect();
    groups.sort_by_key(|g| g.group == Group::Input);
    (groups, constants)
}

fn varies((low, high): (f64, f64)) -> bool {
    high - low > VARIES * low.abs().max(high.abs())
}

fn union(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

impl Panel {
    /// Whether a column with this range, and all that are here, stay readable together.
    fn takes(&self, column: &Column, range: (f64, f64)) -> bool {
        let all = union(self.range, range);
        let readable = |range: (f64, f64)| range.1 - range.0 >= READABLE * (all.1 - all.0);
        self.unit == column.unit
            && self.columns.len() < LINE_COLOURS
            && self.columns.iter().all(|c| readable(c.1))
            && readable(range)
    }
    fn add(&mut self, column: usize, range: (f64, f64)) {
        self.range = union(self.range, range);
        self.columns.push((column, range));
    }
}

fn panel_curves(sketch: &Sketch, panel: &Panel) -> Vec<Curve> {
    let curve = |&(i, _): &(usize, (f64, f64))| {
        let column = &sketch.columns()[i];
        // Of a rate the symbol says it all, and a lone one has it beside its axis.
        let label = match (panel.group, panel.columns.len()) {
            (Group::Velocity, 1) => String::new(),
            (Group::Velocity, _) => symbol(&column.name),
            _ => format!("{}: {}", symbol(&column.name), column.meaning),
        };
        Curve {
            label,
            points: sketch.curve(i).collect(),
        }
    };
    panel.columns.iter().map(curve).collect()
}

/// The symbol of the only quantity of a panel, or the kind of its quantities.
fn axis_title(sketch: &Sketch, panel: &Panel) -> String {
    match (&panel.columns[..], panel.group) {
        ([(i, _)], Group::Coordinate | Group::Velocity | Group::Output | Group::Reaction) => {
            symbol(&sketch.columns()[*i].name)
        }
        (_, Group::Coordinate) => "coordinate".into(),
        (_, Group::Velocity) => "velocity".into(),
        (_, Group::Reaction) => "reaction".into(),
        (_, Group::Output) => "output".into(),
        (_, Group::Energy) => "energy".into(),
        (_, Group::Input) => "input".into(),
        (_, Group::Discrete) => "state".into(),
    }
}

/// A text in lines of the given width, broken at spaces.
fn wrapped(text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), TEXT.size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
