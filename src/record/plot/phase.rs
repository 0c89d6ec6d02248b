//! Phase portraits: the rate of every coordinate over the coordinate.

use std::collections::HashSet;

use super::canvas::picture;
use super::chart::{Chart, Dimension};
use super::panel::{Area, Curve, range};
use super::symbol::symbol;
use crate::record::number::rounded;
use crate::record::{Group, Run, Sketch};

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
    phase_portraits_of(run, &Sketch::of(run))
}

/// The same from a sketch of a run; of a long one what is kept whole.
pub(crate) fn phase_portraits_of(run: &Run, sketch: &Sketch) -> Option<String> {
    let coordinates = run.layout.range(Group::Coordinate);
    let velocities = run.layout.range(Group::Velocity);
    let charts: Vec<Chart> = coordinates
        .zip(velocities)
        .filter_map(|(q, v)| portrait(sketch, q, v))
        .collect();
    if charts.is_empty() {
        return None;
    }
    let across = charts.len().min(ACROSS);
    let (width, height) = SIZE;
    let picture_size = (
        width * across as f64,
        height * charts.len().div_ceil(ACROSS) as f64,
    );
    Some(picture(picture_size.0, picture_size.1, |canvas| {
        for (i, chart) in charts.iter().enumerate() {
            let (left, top) = ((i % across) as f64 * width, (i / across) as f64 * height);
            chart.draw(
                canvas,
                Area {
                    left,
                    top,
                    width,
                    height,
                },
            );
        }
    }))
}

fn portrait(sketch: &Sketch, q: usize, v: usize) -> Option<Chart> {
    // Between rows that are apart there is no line to draw.
    let since = sketch.whole_since();
    let left_out = sketch.curve(q).take_while(|p| p.0 < since).count();
    let values = |i: usize| sketch.curve(i).skip(left_out).map(|p| p.1);
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
            label: String::new(),
            points: pieces,
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
