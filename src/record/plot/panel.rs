//! One pair of axes with curves and their legend.

use plotters::style::RGBColor;

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Font, text_width};
use super::coincide::shared;
use super::decimate::decimate;
use super::palette::{FAINT, GRID, INK, ZERO, line};

/// Font of legends and titles of axes.
pub(super) const TEXT: Font = Font {
    size: 11.0,
    colour: INK,
    bold: false,
};
/// Font of tick labels and of what is said on the side.
pub(super) const SMALL: Font = Font {
    size: 10.0,
    colour: FAINT,
    bold: false,
};
/// Height of a row of a legend.
pub(super) const ROW: f64 = 16.0;
/// Widths of a curve and of everything else that is drawn as a line.
const CURVE: f64 = 1.2;
const HAIR: f64 = 0.7;
/// Width of the piece of line or area in front of a text in a legend, and the space around it.
const SWATCH: f64 = 16.0;
const SPACE: f64 = 5.0;
/// From a vertical axis to the middle of its title.
const TITLE_AWAY: f64 = 58.0;
/// Vertical labels this far apart (px) have nearly as much white as text between them; with more
/// labels than this, the grid draws the eye away from the curves.
const LABEL_DISTANCE: f64 = 18.0;
const MOST_LABELS: usize = 8;
/// Radius of the mark at a point.
const MARK: f64 = 2.6;

/// A curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Curve {
    /// Label in the legend; empty for none.
    pub label: String,
    /// The points.
    pub points: Vec<(f64, f64)>,
    /// How they are shown.
    pub style: Style,
}

/// How the points of a curve are shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Style {
    /// Joined by a line.
    #[default]
    Line,
    /// Each by a mark, without a line.
    Points,
    /// Joined by a thin grey line: what the other curves are read against.
    Background,
}

/// The colour of one of several curves.
fn colour(curves: &[Curve], i: usize) -> RGBColor {
    match curves[i].style {
        Style::Background => ZERO,
        Style::Line | Style::Points => line(i),
    }
}

/// Where a pair of axes is in the picture (px).
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Area {
    pub fn right(&self) -> f64 {
        self.left + self.width
    }
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
    /// The pixel at positions from 0 to 1 on both axes.
    pub fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.left + x * self.width, self.bottom() - y * self.height)
    }
}

/// An entry of a legend.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub label: String,
    pub colour: RGBColor,
    /// Whether the colour fills an area rather than drawing a line.
    pub filled: bool,
}

/// The entries of curves drawn by [`curves`], without those that have no label.
pub(super) fn entries(curves: &[Curve]) -> Vec<Entry> {
    let entry = |(i, c): (usize, &Curve)| Entry {
        label: c.label.clone(),
        colour: colour(curves, i),
        filled: false,
    };
    let labelled = curves
        .iter()
        .enumerate()
        .filter(|(_, c)| !c.label.is_empty());
    labelled.map(entry).collect()
}

/// The places of the entries of a legend of the given width: offset to the right and row.
fn places(entries: &[Entry], width: f64) -> Vec<(f64, usize)> {
    let (mut x, mut row) = (0.0, 0);
    let mut place = |entry: &Entry| {
        let needed = SWATCH + SPACE + text_width(&entry.label, TEXT.size);
        if x > 0.0 && x + needed > width {
            (x, row) = (0.0, row + 1);
        }
        let place = (x, row);
        x += needed + 3.0 * SPACE;
        place
    };
    entries.iter().map(&mut place).collect()
}

/// Height of a legend.
pub(super) fn legend_height(entries: &[Entry], width: f64) -> f64 {
    places(entries, width)
        .last()
        .map_or(0.0, |&(_, row)| (row + 1) as f64 * ROW)
}

/// Draws a legend with its upper left corner at `(left, top)`.
pub(super) fn legend(canvas: &mut Canvas, entries: &[Entry], (left, top): (f64, f64), width: f64) {
    for (entry, (x, row)) in entries.iter().zip(places(entries, width)) {
        let (x, y) = (left + x, top + (row as f64 + 0.5) * ROW);
        if entry.filled {
            canvas.rectangle((x, y - 5.0), (x + SWATCH, y + 5.0), entry.colour);
        } else {
            canvas.line([(x, y), (x + SWATCH, y)], 2.0 * CURVE, entry.colour);
        }
        canvas.text(&entry.label, (x + SWATCH + SPACE, y), Anchor::Left, TEXT);
    }
}

/// Draws the grid of an area, the labels of the vertical axis and its title.
pub(super) fn grid(canvas: &mut Canvas, area: Area, x: &Axis, y: &Axis, title: &str) {
    for tick in x.ticks(horizontal_ticks(area)) {
        canvas.line([area.at(tick.at, 0.0), area.at(tick.at, 1.0)], HAIR, GRID);
    }
    let mut labels: f64 = 0.0;
    for tick in y.ticks(((area.height / LABEL_DISTANCE) as usize).min(MOST_LABELS)) {
        labels = labels.max(text_width(&tick.label, SMALL.size));
        let colour = if tick.label == "0" { ZERO } else { GRID };
        canvas.line([area.at(0.0, tick.at), area.at(1.0, tick.at)], HAIR, colour);
        let (left, at) = area.at(0.0, tick.at);
        canvas.text(&tick.label, (left - SPACE, at), Anchor::Right, SMALL);
    }
    let middle = area.top + area.height / 2.0;
    // Titles stand in one line, but for those whose labels come as far.
    let away = TITLE_AWAY.max(SPACE + labels + TEXT.size);
    canvas.text(
        &y.title(title),
        (area.left - away, middle),
        Anchor::Upwards,
        TEXT,
    );
    frame(canvas, area);
}

/// Draws the border of an area.
pub(super) fn frame(canvas: &mut Canvas, area: Area) {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
    canvas.line(corners.map(|(x, y)| area.at(x, y)), HAIR, FAINT);
}

/// Draws the labels of the horizontal axis and its title below an area, 34 px high.
pub(super) fn horizontal_axis(canvas: &mut Canvas, area: Area, x: &Axis, title: &str) {
    for tick in x.ticks(horizontal_ticks(area)) {
        let (at, bottom) = area.at(tick.at, 0.0);
        canvas.text(&tick.label, (at, bottom + 10.0), Anchor::Centre, SMALL);
    }
    let middle = area.left + area.width / 2.0;
    canvas.text(
        &x.title(title),
        (middle, area.bottom() + 25.0),
        Anchor::Centre,
        TEXT,
    );
}

/// Labels 55 px apart do not touch.
fn horizontal_ticks(area: Area) -> usize {
    (area.width / 55.0) as usize
}

/// Draws curves into an area, each in its colour, with marks at the points if wanted. Where curves lie on each other
/// their colours alternate.
pub(super) fn curves(
    canvas: &mut Canvas,
    area: Area,
    x: &Axis,
    y: &Axis,
    curves: &[Curve],
    marks: bool,
) {
    let pixels = |curve: &Curve| -> Vec<(f64, f64)> {
        let at = |&(a, b): &(f64, f64)| area.at(x.position(a), y.position(b));
        curve.points.iter().map(at).collect()
    };
    let finite = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
    let in_order = |curve: &Curve| curve.points.is_sorted_by(|a, b| a.0 <= b.0);
    if curves.iter().all(in_order) {
        let decimated = |curve: &Curve| match curve.style {
            Style::Points => Vec::new(),
            Style::Line | Style::Background => decimate(pixels(curve).into_iter()),
        };
        let lines: Vec<_> = curves.iter().map(decimated).collect();
        let parts = shared(&lines, area.left, area.width);
        for (i, part) in parts.into_iter().enumerate() {
            for piece in part {
                canvas.line(piece, CURVE, colour(curves, i));
            }
            if marks {
                lines[i]
                    .iter()
                    .for_each(|&p| canvas.disc(p, MARK, colour(curves, i)));
            }
        }
    } else {
        for (i, curve) in curves.iter().enumerate() {
            let width = match curve.style {
                Style::Points => continue,
                Style::Line => CURVE,
                Style::Background => HAIR,
            };
            for piece in pixels(curve).split(|p| !finite(p)) {
                canvas.line(piece.iter().copied(), width, colour(curves, i));
                if marks {
                    piece
                        .iter()
                        .for_each(|&p| canvas.disc(p, MARK, colour(curves, i)));
                }
            }
        }
    }
    for (i, curve) in curves.iter().enumerate() {
        if curve.style == Style::Points {
            let points = pixels(curve).into_iter().filter(finite);
            points.for_each(|p| canvas.disc(p, MARK, colour(curves, i)));
        }
    }
}

/// Smallest and largest finite value, with `keep` deciding which values count.
pub(super) fn range(
    values: impl Iterator<Item = f64>,
    keep: impl Fn(f64) -> bool,
) -> Option<(f64, f64)> {
    let values = values.filter(|&x| x.is_finite() && keep(x));
    values.fold(None, |range, x| {
        let (low, high) = range.unwrap_or((x, x));
        Some((x.min(low), x.max(high)))
    })
}
