//! A run on one page: everything over the same time.

use super::appearance::{Appearance, Asked, windowed};
use super::axis::{Axis, Scale};
use super::canvas::{Anchor, Canvas, Font, Picture, picture, text_width};
use super::palette::{ALARM, INK, LINE_COLOURS};
use super::panel::{
    Area, Curve, ROW, SMALL, TEXT, curves, entries, grid, horizontal_axis, legend, legend_height,
    range,
};
use super::strip::Strip;
use super::symbol::symbol;
use crate::record::number::rounded;
use crate::record::{Column, ColumnKind, Run, Sketch};

/// Width of the picture where no other is asked for, and of its margins, which hold the labels of the axes and, on the
/// right, the numbers of transitions.
const WIDTH: f64 = 960.0;
const LEFT: f64 = 104.0;
const RIGHT: f64 = 46.0;
/// Height of the axes of a panel, at least where another is asked for, and the space below them.
const PANEL: f64 = 92.0;
const LEAST_PANEL: f64 = 40.0;
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
    group: ColumnKind,
    unit: String,
    range: (f64, f64),
    /// Columns, with the range of each.
    columns: Vec<(usize, (f64, f64))>,
}

/// Draws coordinates, velocities, outputs, reactions, energies and inputs over time, one below the other,
/// with the modes and the transitions underneath, as SVG. Quantities of the same kind and unit
/// share a panel where each is readable there; those that never change are listed.
pub fn overview(run: &Run) -> String {
    overview_of(run, &Sketch::of(run), &Appearance::default()).svg()
}

/// The same from a sketch of a run, as `appearance` says, whose panels are those of the run.
pub(crate) fn overview_of(run: &Run, sketch: &Sketch, appearance: &Appearance) -> Picture {
    let (panels, constants) = panels(run, sketch, appearance);
    let time = time_axis(run, sketch, appearance);
    let strip = Strip::new(run, sketch, appearance.window);
    let with_curves = |panel| (panel_curves(sketch, &panel, appearance), panel);
    let panels: Vec<(Vec<Curve>, Panel)> = panels.into_iter().map(with_curves).collect();
    let width = appearance.size.map_or(WIDTH, |size| size.0);
    let inner = width - LEFT - RIGHT;
    let notes = wrapped(&constants, inner);
    let legends = panels
        .iter()
        .map(|(c, _)| legend_height(&entries(c), inner) + GAP);
    let without_panels = HEAD
        + legends.sum::<f64>()
        + TIME_AXIS
        + strip.height(inner)
        + notes.len() as f64 * ROW
        + 2.0 * GAP;
    let count = panels.len() as f64;
    let panel_height = match appearance.size {
        Some((_, height)) => ((height - without_panels) / count.max(1.0)).max(LEAST_PANEL),
        None => PANEL,
    };
    let height = without_panels + count * panel_height;
    picture(width, height, |canvas| {
        head(canvas, run, width);
        let mut top = HEAD;
        let mut last = Area {
            left: LEFT,
            top,
            width: inner,
            height: 0.0,
        };
        for (c, panel) in &panels {
            let legend_entries = entries(c);
            legend(canvas, &legend_entries, (LEFT, top), inner);
            top += legend_height(&legend_entries, inner);
            last = Area {
                left: LEFT,
                top,
                width: inner,
                height: panel_height,
            };
            let y = Axis::new(
                Scale::Linear,
                &panel.unit,
                &appearance.units,
                panel.range,
                0.06,
            );
            grid(canvas, last, &time, &y, &axis_title(sketch, panel));
            curves(canvas, last, &time, &y, c, false);
            top += panel_height + GAP;
        }
        horizontal_axis(canvas, last, &time, "time t");
        top = last.bottom() + TIME_AXIS;
        strip.draw(canvas, &time, (LEFT, top), inner);
        top += strip.height(inner) + GAP;
        for note in &notes {
            canvas.text(note, (LEFT, top + ROW / 2.0), Anchor::Left, SMALL);
            top += ROW;
        }
    })
}

fn head(canvas: &mut Canvas, run: &Run, width: f64) {
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
    let line = wrapped(&line.join(" · "), width - LEFT);
    let first = line.first().map_or("", String::as_str);
    let more = if line.len() > 1 { " …" } else { "" };
    canvas.text(&format!("{first}{more}"), (LEFT, 34.0), Anchor::Left, font);
}

/// The axis of the window, or from the first instant of a run to its end.
fn time_axis(run: &Run, sketch: &Sketch, appearance: &Appearance) -> Axis {
    let times = sketch.times().chain([run.end.t]);
    let all = range(times, |_| true).unwrap_or((0.0, 0.0));
    let shown = appearance.window.unwrap_or(all);
    Axis::new(Scale::Linear, "s", &appearance.units, shown, 0.0)
}

/// The order of groups where none is asked for: the response before what causes it.
const ORDER: [ColumnKind; 6] = [
    ColumnKind::Coordinate,
    ColumnKind::Velocity,
    ColumnKind::Output,
    ColumnKind::Reaction,
    ColumnKind::Energy,
    ColumnKind::Input,
];

/// Divides the columns among panels; also a sentence about those that never change.
fn panels(run: &Run, sketch: &Sketch, appearance: &Appearance) -> (Vec<Panel>, String) {
    let asked = appearance.asked(&run.layout).unwrap_or_default();
    let asked = match asked.is_empty() {
        true => ORDER.map(Asked::Group).to_vec(),
        false => asked,
    };
    let mut panels: Vec<Panel> = Vec::new();
    let mut constants = Vec::new();
    for asked in asked {
        let start = panels.len();
        let (columns, in_one) = match asked {
            Asked::Group(group) => (run.layout.range(group).collect(), false),
            Asked::Columns(columns) => (columns, true),
        };
        for i in columns {
            let column = &sketch.columns()[i];
            let values = windowed(sketch.curve(i), appearance.window);
            let Some(range) = range(values.iter().map(|p| p.1), |_| true) else {
                continue;
            };
            if !varies(range) && !in_one {
                let (value, unit) = appearance.units.show(range.0, &column.unit);
                let value = rounded(value, 6).replace('-', "−");
                let constant = format!("{} = {value} {unit}", column.name);
                constants.push(constant.replace(' ', NO_BREAK));
                continue;
            }
            let fits = |panel: &&mut Panel| in_one || panel.takes(column, range);
            match panels[start..].iter_mut().find(fits) {
                Some(panel) => panel.add(i, range),
                None => panels.push(Panel {
                    group: column.group,
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
    /// Their indices.
    pub columns: Vec<usize>,
}

/// How a run's columns are divided among panels; also a sentence about those that never change.
pub(crate) fn grouped(
    run: &Run,
    sketch: &Sketch,
    appearance: &Appearance,
) -> (Vec<Grouped>, String) {
    let (panels, constants) = panels(run, sketch, appearance);
    let grouped = |panel: Panel| Grouped {
        columns: panel.columns.iter().map(|c| c.0).collect(),
    };
    (panels.into_iter().map(grouped).collect(), constants)
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

fn panel_curves(sketch: &Sketch, panel: &Panel, appearance: &Appearance) -> Vec<Curve> {
    let curve = |&(i, _): &(usize, (f64, f64))| {
        let column = &sketch.columns()[i];
        // Of a rate the symbol says it all, and a lone one has it beside its axis.
        let label = match (panel.group, panel.columns.len()) {
            (ColumnKind::Velocity, 1) if is_short(&column.name, &panel.unit) => String::new(),
            (ColumnKind::Velocity, _) => symbol(&column.name),
            _ => format!("{}: {}", symbol(&column.name), column.meaning),
        };
        Curve {
            label,
            points: windowed(sketch.curve(i), appearance.window),
            ..Curve::default()
        }
    };
    panel.columns.iter().map(curve).collect()
}

/// Whether the symbol of a quantity has room beside a panel, with its unit, if it has one, and a prefix to that.
fn is_short(name: &str, unit: &str) -> bool {
    let unit = match unit {
        "1" => String::new(),
        unit => format!(" (m{unit})"),
    };
    text_width(&format!("{}{unit}", symbol(name)), TEXT.size) <= PANEL + GAP
}

/// The symbol of the only quantity of a panel, where it has room, or the kind of its quantities.
fn axis_title(sketch: &Sketch, panel: &Panel) -> String {
    let name = |i: usize| &*sketch.columns()[i].name;
    match (&panel.columns[..], panel.group) {
        (
            &[(i, _)],
            ColumnKind::Coordinate
            | ColumnKind::Velocity
            | ColumnKind::Output
            | ColumnKind::Reaction,
        ) if is_short(name(i), &panel.unit) => symbol(name(i)),
        (_, ColumnKind::Coordinate) => "coordinate".into(),
        (_, ColumnKind::Velocity) => "velocity".into(),
        (_, ColumnKind::Reaction) => "reaction".into(),
        (_, ColumnKind::Output) => "output".into(),
        (_, ColumnKind::Energy) => "energy".into(),
        (_, ColumnKind::Input) => "input".into(),
        (_, ColumnKind::Discrete) => "state".into(),
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
