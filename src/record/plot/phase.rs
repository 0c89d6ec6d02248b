//! Phase portraits: the rate of every coordinate over the coordinate.

use std::collections::HashSet;

use super::canvas::picture;
use super::chart::{Chart, Dimension};
use super::panel::{Area, Curve, range};
use super::symbol::symbol;
use crate::record::{Group, Run};

/// Size of a portrait.
const SIZE: (f64, f64) = (380.0, 330.0);
/// Portraits side by side.
const ACROSS: usize = 3;
/// Cells across a portrait: pieces of a curve between the same two cells are the same.
const CELLS: f64 = 300.0;
/// Pieces of a curve drawn, at about 10 bytes each.
const PIECES: usize = 20_000;

/// Draws the phase portrait of every coordinate that moves, as SVG; `None` when none does.
pub fn phase_portraits(run: &Run) -> Option<String> {
    let coordinates = run.layout.range(Group::Coordinate);
    let velocities = run.layout.range(Group::Velocity);
    let charts: Vec<Chart> = coordinates
        .zip(velocities)
        .filter_map(|(q, v)| portrait(run, q, v))
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

fn portrait(run: &Run, q: usize, v: usize) -> Option<Chart> {
    let points: Vec<_> = run
        .curve(q)
        .map(|p| p.1)
        .zip(run.curve(v).map(|p| p.1))
        .collect();
    let (low, high) = range(points.iter().map(|p| p.0), |_| true)?;
    let (slow, fast) = range(points.iter().map(|p| p.1), |_| true)?;
    if low == high || slow == fast {
        return None;
    }
    let cell = |p: (f64, f64)| {
        let part = |x: f64, from: f64, to: f64| ((x - from) / (to - from) * CELLS) as i32;
        (part(p.0, low, high), part(p.1, slow, fast))
    };
    let (q, v) = (&run.trajectory.columns[q], &run.trajectory.columns[v]);
    Some(Chart {
        title: String::new(),
        x: Dimension::linear(&symbol(&q.name), &q.unit),
        y: Dimension::linear(&symbol(&v.name), &v.unit),
        curves: vec![Curve {
            label: String::new(),
            points: distinct(&points, cell),
        }],
        marks: false,
    })
}

/// The curve without the pieces that would be drawn over earlier ones of the same run, and of what
/// then remains the last [`PIECES`]. Points that are not numbers separate what is left.
fn distinct(points: &[(f64, f64)], cell: impl Fn((f64, f64)) -> (i32, i32)) -> Vec<(f64, f64)> {
    const GAP: (f64, f64) = (f64::NAN, f64::NAN);
    let mut seen = HashSet::new();
    let mut kept = Vec::new();
    for piece in points.windows(2) {
        let (a, b) = (cell(piece[0]), cell(piece[1]));
        if !seen.insert((a.min(b), a.max(b))) {
            continue;
        }
        if kept.last() != Some(&piece[0]) {
            kept.extend([GAP, piece[0]]);
        }
        kept.push(piece[1]);
    }
    kept.split_off(kept.len().saturating_sub(PIECES))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_is_drawn_once() {
        let circle = |i: i32| (f64::from(i) * 0.1 * std::f64::consts::PI).sin_cos();
        let turns: Vec<_> = (0..10_000).map(circle).collect();
        let cell = |p: (f64, f64)| ((p.0 * 50.0).round() as i32, (p.1 * 50.0).round() as i32);
        let kept = distinct(&turns, cell);
        assert_eq!(kept.iter().filter(|p| p.0.is_finite()).count(), 21);
    }
}
