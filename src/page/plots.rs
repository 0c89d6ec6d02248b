//! Plots of a page, as its scripts draw them.

use super::escape::{plain, symbols, text};
use super::thin::thin;
use crate::record::exact;
use crate::record::plot::{Chart, Curve, Dimension, Scale, Style};
use serde::Serialize;
use std::fmt::Write;

/// Most points of a plot: more than a screen is wide, also after a zoom tenfold, and some megabytes at most.
const MOST_POINTS: usize = 20_000;

/// Curves over one pair of axes.
#[derive(Debug, Serialize)]
pub(super) struct Plot {
    x: Axis,
    y: Axis,
    marks: bool,
    /// Whether x is the time of a run, whose modes and transitions are shown with it.
    time: bool,
    /// Whether the curves are a motion in the plane: its start and its direction are shown.
    path: bool,
    /// Whether all that a run told of these columns is kept, so that between two points lies a part of one step.
    whole: bool,
    /// Abscissas, which curves may share.
    xs: Vec<Vec<f64>>,
    curves: Vec<Line>,
    #[serde(skip)]
    title: String,
    /// What is not drawn, and why.
    #[serde(skip)]
    left_out: Vec<String>,
    /// How many points of how many a curve keeps, where that are not all.
    #[serde(skip)]
    thinned: Option<[usize; 2]>,
}

#[derive(Debug, Clone, Serialize)]
struct Axis {
    /// Words, without any markup.
    label: String,
    unit: String,
    log: bool,
    #[serde(skip)]
    html: String,
}

#[derive(Debug, Serialize)]
struct Line {
    name: String,
    /// Index of its abscissas.
    x: usize,
    y: Vec<f64>,
    style: Style,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<String>,
    #[serde(skip)]
    html: String,
}

/// A column over time.
pub(super) struct Column<'a> {
    pub name: &'a str,
    /// How a textbook prints it.
    pub symbol: String,
    pub meaning: &'a str,
    pub y: Vec<f64>,
}

impl Axis {
    fn new(dimension: &Dimension) -> Axis {
        Axis {
            label: plain(&dimension.title),
            unit: dimension.unit.clone(),
            log: dimension.scale == Scale::Log,
            html: symbols(&dimension.title),
        }
    }

    /// Whether a value has a place on it.
    fn has(&self, x: f64) -> bool {
        x.is_finite() && (!self.log || x > 0.0)
    }

    /// Why values between these two cannot be drawn, if so: a canvas divides by the range and multiplies by pixels.
    fn refuses(&self, low: f64, high: f64) -> bool {
        let (range, largest) = (high - low, high.abs().max(low.abs()));
        let tiny = largest < 1e-290 && largest > 0.0;
        !range.is_finite() || largest >= 1e300 || tiny || range > 0.0 && range <= 1e-290
    }
}

/// Least and largest of values that are numbers.
fn range<'a>(values: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let finite = values.filter(|x| !x.is_nan());
    finite.fold(none, |(low, high), &x| (low.min(x), high.max(x)))
}

impl Plot {
    /// A chart; `notes` of its points, curve by curve, or none.
    pub fn new(chart: &Chart, notes: &[Vec<String>]) -> Plot {
        let mut plot = Plot {
            x: Axis::new(&chart.x),
            y: Axis::new(&chart.y),
            marks: chart.marks,
            time: false,
            path: false,
            whole: false,
            xs: Vec::new(),
            curves: Vec::new(),
            title: symbols(&chart.title),
            left_out: Vec::new(),
            thinned: None,
        };
        for (i, curve) in chart.curves.iter().enumerate() {
            let name = plain(&curve.label);
            let has_place = |p: &(f64, f64)| plot.x.has(p.0) && plot.y.has(p.1);
            let (low, high) = range(curve.points.iter().map(|p| &p.1));
            let (first, last) = range(curve.points.iter().map(|p| &p.0));
            let reason = match curve.points.iter().any(has_place) {
                false => Some("it has no point with a place on these axes".to_owned()),
                true if plot.y.refuses(low, high) => Some(from_to(low, high, &plot.y.unit)),
                true if plot.x.refuses(first, last) => Some(from_to(first, last, &plot.x.unit)),
                true => None,
            };
            if let Some(reason) = reason {
                let what = if name.is_empty() {
                    &plot.y.label
                } else {
                    &name
                };
                plot.left_out.push(format!("not drawn: {what}, {reason}"));
                continue;
            }
            // What has no place separates what is left and right of it.
            let points = curve.points.iter();
            let points: Vec<(f64, f64)> = points
                .map(|p| if has_place(p) { *p } else { (p.0, f64::NAN) })
                .collect();
            let notes = notes.get(i).cloned().unwrap_or_default();
            plot.add(curve, points, name, notes);
        }
        plot
    }

    /// A chart of a motion in the plane.
    pub fn of_path(chart: &Chart) -> Plot {
        Plot {
            path: true,
            ..Plot::new(chart, &[])
        }
    }

    /// Adds a curve of a chart with these points of it.
    fn add(&mut self, of: &Curve, points: Vec<(f64, f64)>, name: String, notes: Vec<String>) {
        let (t, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let kept = match t.is_sorted() {
            true => thin(&[&y], y.len(), MOST_POINTS),
            // Of a path in the plane the chart has left what is seen.
            false => (0..t.len()).collect(),
        };
        let pick = |of: &[f64]| -> Vec<f64> { kept.iter().map(|&i| of[i]).collect() };
        let x = self.abscissas(pick(&t));
        let notes = kept.iter().filter_map(|&i| notes.get(i).cloned()).collect();
        self.curves.push(Line {
            name,
            x,
            y: pick(&y),
            style: of.style,
            notes,
            html: symbols(&of.label),
        });
    }

    /// The index of these abscissas, among those that there are if possible.
    fn abscissas(&mut self, t: Vec<f64>) -> usize {
        let same = |known: &Vec<f64>| {
            known.len() == t.len()
                && known
                    .iter()
                    .zip(&t)
                    .all(|(a, b)| a.to_bits() == b.to_bits())
        };
        self.xs.iter().position(same).unwrap_or_else(|| {
            self.xs.push(t);
            self.xs.len() - 1
        })
    }

    /// Columns of a run over the same times; `whole` where all that it told of them is in them.
    pub fn of_columns(unit: &str, t: &[f64], columns: Vec<Column>, whole: bool) -> Plot {
        let mut plot = Plot {
            x: Axis::new(&Dimension::linear("time t", "s")),
            y: Axis::new(&Dimension::linear("", unit)),
            marks: false,
            time: true,
            path: false,
            whole,
            xs: Vec::new(),
            curves: Vec::new(),
            title: String::new(),
            left_out: Vec::new(),
            thinned: None,
        };
        let (drawn, refused): (Vec<Column>, Vec<Column>) =
            columns.into_iter().partition(|column| {
                let (low, high) = range(column.y.iter());
                !plot.y.refuses(low, high)
            });
        for column in refused {
            let (low, high) = range(column.y.iter());
            let reason = from_to(low, high, unit);
            plot.left_out
                .push(format!("not drawn: {}, {reason}", column.name));
        }
        if drawn.is_empty() {
            return plot;
        }
        let values: Vec<&[f64]> = drawn.iter().map(|column| &column.y[..]).collect();
        let kept = thin(&values, t.len(), MOST_POINTS);
        plot.thinned = (kept.len() < t.len()).then_some([kept.len(), t.len()]);
        plot.whole = whole && plot.thinned.is_none();
        let pick = |of: &[f64]| -> Vec<f64> { kept.iter().map(|&i| of[i]).collect() };
        plot.xs.push(pick(t));
        for column in &drawn {
            plot.curves.push(Line {
                name: column.name.to_owned(),
                x: 0,
                y: pick(&column.y),
                style: Style::Line,
                notes: Vec::new(),
                html: format!(
                    "{} <span class=\"faint\">{}</span>",
                    symbols(&column.symbol),
                    text(column.meaning)
                ),
            });
        }
        plot
    }

    /// What is not drawn, and why.
    pub fn left_out(&self) -> &[String] {
        &self.left_out
    }

    /// How many points of how many a curve keeps, where that are not all.
    pub fn thinned(&self) -> Option<[usize; 2]> {
        self.thinned
    }

    /// Whether nothing is drawn.
    pub fn is_empty(&self) -> bool {
        self.curves.is_empty()
    }

    /// The place of the plot, with its legend, on a page where it is the `index`-th.
    pub fn html(&self, index: usize) -> String {
        if self.is_empty() {
            return format!(
                "<p class=\"faint\">{}: there is nothing to draw.</p>\n",
                self.heading()
            );
        }
        let mut out = format!("<figure class=\"plot\" id=\"plot-{index}\">\n<figcaption>");
        let heading = self.heading();
        if !heading.is_empty() {
            let _ = write!(out, "<b>{heading}</b> ");
        }
        for (i, curve) in self.curves.iter().enumerate() {
            // A lone curve without a name is what the heading names.
            let swatch = match self.curves.len() == 1 && curve.html.is_empty() {
                true => String::new(),
                false => format!("<i class=\"s{}\"></i>{} ", curve.colour(i), curve.html),
            };
            let _ = write!(
                out,
                "<span class=\"key\" data-curve=\"{i}\">{swatch}<output></output></span>"
            );
        }
        let unit = text(&self.y.unit);
        let label = &self.y.html;
        if label.is_empty() || self.heading() == *label {
            let _ = write!(out, "<span class=\"unit\" data-unit=\"{unit}\"></span>");
        } else {
            let _ = write!(
                out,
                "<span class=\"unit\">{label} <span data-unit=\"{unit}\"></span></span>"
            );
        }
        out.push_str("</figcaption>\n<div class=\"axes\"></div>");
        if !self.time {
            let unit = text(&self.x.unit);
            let _ = write!(
                out,
                "<div class=\"below\">{} <span data-unit=\"{unit}\"></span></div>",
                self.x.html
            );
        }
        out.push_str("<div class=\"note\"></div></figure>\n");
        out
    }

    fn heading(&self) -> String {
        match self.title.is_empty() && !self.time {
            true => self.y.html.clone(),
            false => self.title.clone(),
        }
    }
}

/// Colours that the style has for curves; the last is grey.
const COLOURS: usize = 8;

impl Line {
    /// The number of its colour, where it is the `i`-th of a plot.
    fn colour(&self, i: usize) -> usize {
        match self.style {
            Style::Background => COLOURS - 1,
            Style::Line | Style::Points => i % COLOURS,
        }
    }
}

fn from_to(low: f64, high: f64, unit: &str) -> String {
    format!("from {} to {} {unit}", exact(low), exact(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<(f64, f64)>, y: Dimension) -> Chart {
        Chart {
            title: "a<b".into(),
            x: Dimension::linear("time t", "s"),
            y,
            curves: vec![Curve {
                label: "c&d".into(),
                points,
                ..Curve::default()
            }],
            marks: true,
        }
    }

    #[test]
    fn labels_are_escaped_where_they_are_markup() {
        let plot = Plot::new(&chart(vec![(0.0, 1.0)], Dimension::linear("e>f", "m")), &[]);
        let html = plot.html(3);
        assert!(html.contains("id=\"plot-3\"") && html.contains("a&lt;b"));
        assert!(
            html.contains("c&amp;d") && html.contains("e&gt;f"),
            "{html}"
        );
    }

    #[test]
    fn what_cannot_be_drawn_is_said() {
        for (points, y, words) in [
            (
                vec![(0.0, -1.0)],
                Dimension::log("y", "m"),
                "no point with a place",
            ),
            (vec![], Dimension::linear("y", "m"), "no point with a place"),
            (
                vec![(0.0, f64::NAN)],
                Dimension::linear("y", "m"),
                "no point with a place",
            ),
            (vec![(0.0, 1e301)], Dimension::linear("y", "m"), "from 1"),
            (
                vec![(0.0, 1e-308), (1.0, 2e-308)],
                Dimension::linear("y", "m"),
                "e-308",
            ),
        ] {
            let plot = Plot::new(&chart(points, y), &[]);
            assert!(plot.left_out()[0].contains(words), "{:?}", plot.left_out());
            assert!(plot.html(0).contains("nothing to draw"));
        }
    }

    #[test]
    fn points_without_a_place_separate_pieces() {
        let points = vec![(0.0, 1.0), (1.0, 0.0), (2.0, 3.0)];
        let plot = Plot::new(&chart(points, Dimension::log("y", "m")), &[]);
        assert!(plot.curves[0].y[1].is_nan() && plot.curves[0].y[2] == 3.0);
    }
}
