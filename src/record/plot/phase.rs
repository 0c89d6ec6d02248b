//! Phase portraits: the rate of every coordinate over the coordinate.

use std::collections::HashSet;

use super::appearance::Appearance;
use super::canvas::{Anchor, Canvas, Picture, picture};
use super::chart::{Chart, Dimension};
use super::palette::{PAPER, line};
use super::panel::{Area, Curve, SMALL, range};
use super::symbol::symbol;
use crate::record::number::rounded;
use crate::record::{ColumnKind, Run, Sketch};

/// Size of a portrait.
const SIZE: (f64, f64) = (380.0, 330.0);
/// Portraits side by side.
const ACROSS: usize = 3;
/// Cells across a portrait: pieces of a curve between the same two cells are the same.
const CELLS: f64 = 200.0;
/// Pieces of a curve drawn: 10 to 100 bytes each, so that a portrait stays near a megabyte at worst.
const PIECES: usize = 16_000;

/// Draws the phase portrait of every coordinate that moves, as SVG; `None` when none does.
pub fn phase_portraits(run: &Run) -> Option<String> {
    phase_portraits_of(run, &Sketch::of(run), &Appearance::default()).map(|picture| picture.svg())
}

/// The same from a sketch of a run, as `appearance` says; of a long one what is kept whole.
pub(crate) fn phase_portraits_of(
    run: &Run,
    sketch: &Sketch,
    appearance: &Appearance,
) -> Option<Picture> {
    let charts = portraits(run, sketch, appearance);
    if charts.is_empty() {
        return None;
    }
    let (across, down) = (charts.len().min(ACROSS), charts.len().div_ceil(ACROSS));
    let (width, height) = match appearance.size {
        Some((width, height)) => (width / across as f64, height / down as f64),
        None => SIZE,
    };
    let size = (width * across as f64, height * down as f64);
    Some(picture(size.0, size.1, |canvas| {
        for (i, chart) in charts.iter().enumerate() {
            let area = Area {
                left: (i % across) as f64 * width,
                top: (i / across) as f64 * height,
                width,
                height,
            };
            let (inner, [x, y]) = chart.draw(canvas, area, &appearance.units);
            let at = |p: &(f64, f64)| inner.at(x.position(p.0), y.position(p.1));
            let path: Vec<_> = chart.curves[0].points.iter().map(at).collect();
            way(canvas, &path);
            // Beside the title of the axis, where no curve is.
            let corner = (inner.right(), inner.bottom() + 25.0);
            canvas.text("○ start", corner, Anchor::Right, SMALL);
        }
    }))
}

/// The phase portraits of the coordinates that move, as charts of a path in the plane.
pub(crate) fn portraits(run: &Run, sketch: &Sketch, appearance: &Appearance) -> Vec<Chart> {
    let coordinates = run.layout.range(ColumnKind::Coordinate);
    let velocities = run.layout.range(ColumnKind::Velocity);
    let of = |(q, v)| portrait(sketch, (q, v), appearance.window);
    coordinates.zip(velocities).filter_map(of).collect()
}

/// Way along a path from one arrow to the next, px, and how many there are at least and at most.
const BETWEEN_ARROWS: f64 = 150.0;
const ARROWS: (f64, f64) = (2.0, 12.0);
/// Length and half width of an arrow, and radius of the mark at the start, px.
const ARROW: (f64, f64) = (9.0, 3.6);
const START: f64 = 4.0;

/// Draws the direction of a path of pixels, and where it starts.
fn way(canvas: &mut Canvas, path: &[(f64, f64)]) {
    let length = |ends: &[(f64, f64)]| (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1);
    let lengths = || path.windows(2).map(|ends| (ends, length(ends)));
    let drawn = || lengths().filter(|(_, l)| l.is_finite() && *l > 0.0);
    let total: f64 = drawn().map(|(_, l)| l).sum();
    let count = (total / BETWEEN_ARROWS).clamp(ARROWS.0, ARROWS.1).floor();
    let mut next = total / count / 2.0;
    let mut gone = 0.0;
    for (ends, length) in drawn() {
        gone += length;
        if gone >= next {
            let (a, b) = (ends[0], ends[1]);
            let (ux, uy) = ((b.0 - a.0) / length, (b.1 - a.1) / length);
            let side = |s: f64| {
                let back = (b.0 - ux * ARROW.0, b.1 - uy * ARROW.0);
                (back.0 - uy * s * ARROW.1, back.1 + ux * s * ARROW.1)
            };
            canvas.polygon([b, side(1.0), side(-1.0)], line(0));
            next += total / count;
        }
    }
    if let Some(start) = path.iter().find(|p| p.0.is_finite() && p.1.is_finite()) {
        canvas.disc(*start, START, line(0));
        canvas.disc(*start, START - 1.5, PAPER);
    }
}

fn portrait(sketch: &Sketch, (q, v): (usize, usize), window: Option<(f64, f64)>) -> Option<Chart> {
    // Between rows that are apart there is no line to draw.
    let since = sketch.whole_since();
    let (from, to) = window.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let since = since.max(from);
    let left_out = sketch.curve(q).take_while(|p| p.0 < since).count();
    let values = |i: usize| {
        let shown = sketch.curve(i).skip(left_out);
        shown.take_while(|p| p.0 <= to).map(|p| p.1)
    };
    let points: Vec<_> = values(q).zip(values(v)).collect();
    let (low, high) = range(points.iter().map(|p| p.0), |_| true)?;
    let (slow, fast) = range(points.iter().map(|p| p.1), |_| true)?;
    if low == high || slow == fast {
        return None;
    }
    let cell = |p: (f64, f64)| {
        // Halves: a difference of the largest doubles is none.
        let part = |x: f64, from: f64, to: f64| {
            ((0.5 * x - 0.5 * from) / (0.5 * to - 0.5 * from) * CELLS) as i32
        };
        (part(p.0, low, high), part(p.1, slow, fast))
    };
    let (pieces, from) = distinct(&points, cell);
    let title = match sketch.curve(q).nth(left_out + from) {
        Some((t, _)) if left_out + from > 0 => format!("from t = {} s on", rounded(t, 4)),
        _ => String::new(),
    };
    let (q, v) = (&sketch.columns()[q], &sketch.columns()[v]);
    Some(Chart {
        title,
        x: Dimension::linear(&symbol(&q.name), &q.unit),
        y: Dimension::linear(&symbol(&v.name), &v.unit),
        curves: vec![Curve {
            points: pieces,
            ..Curve::default()
        }],
        marks: false,
    })
}

/// The curve in pieces from one cell to another, without those that an earlier one covers, and of
/// what then remains the last [`PIECES`]; also the index of the first point that is left. Points
/// that are not numbers separate what is left.
fn distinct(
    points: &[(f64, f64)],
    cell: impl Fn((f64, f64)) -> (i32, i32),
) -> (Vec<(f64, f64)>, usize) {
    let mut steps: Vec<usize> = (0..points.len()).collect();
    steps.dedup_by_key(|&mut i| cell(points[i]));
    let mut seen = HashSet::new();
    let mut is_new = |a: (i32, i32), b: (i32, i32)| seen.insert((a.min(b), a.max(b)));
    let mut pieces: Vec<(usize, usize)> = steps.windows(2).map(|w| (w[0], w[1])).collect();
    pieces.retain(|&(from, to)| is_new(cell(points[from]), cell(points[to])));
    let pieces = &pieces[pieces.len().saturating_sub(PIECES)..];
    let mut kept = Vec::new();
    let mut last = None;
    for &(from, to) in pieces {
        if last != Some(from) {
            kept.extend([(f64::NAN, f64::NAN), points[from]]);
        }
        kept.push(points[to]);
        last = Some(to);
    }
    (kept, pieces.first().map_or(0, |piece| piece.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_is_drawn_once() {
        let circle = |i: i32| (f64::from(i) * 0.1 * std::f64::consts::PI).sin_cos();
        let turns: Vec<_> = (0..10_000).map(circle).collect();
        let cell = |p: (f64, f64)| ((p.0 * 50.0).round() as i32, (p.1 * 50.0).round() as i32);
        let (kept, from) = distinct(&turns, cell);
        assert_eq!(from, 0);
        assert_eq!(kept.iter().filter(|p| p.0.is_finite()).count(), 21);
    }
}
