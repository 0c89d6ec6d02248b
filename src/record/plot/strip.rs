//! The modes and the transitions over time.

use super::axis::Axis;
use super::canvas::{Anchor, Canvas};
use super::palette::{INK, area};
use super::panel::{Area, Entry, SMALL, TEXT, frame, legend, legend_height};
use crate::record::{Run, Sketch};

/// Height of the strip of the modes, and of the lane of a transition.
const STRIP: f64 = 18.0;
const LANE: f64 = 13.0;
/// Space between the strip, its legend and the lanes.
const GAP: f64 = 5.0;

/// The modes a run was in, and its transitions by name.
pub(super) struct Strip {
    /// Intervals `(from, to, mode)`.
    intervals: Vec<(f64, f64, usize)>,
    /// The modes that occur.
    modes: Vec<usize>,
    entries: Vec<Entry>,
    /// Name, number and times, in the order of first occurrence.
    lanes: Vec<(&'static str, usize, Vec<f64>)>,
}

impl Strip {
    /// The strip of a run, or of what a window of time shows of it; transitions are counted in the whole run.
    pub fn new(run: &Run, sketch: &Sketch, window: Option<(f64, f64)>) -> Strip {
        let marks = sketch.marks();
        let mut intervals = marks.visits.clone();
        let since = intervals.last().map(|visit| visit.1);
        let since = since.or(sketch.first_row()).unwrap_or(run.end.t);
        intervals.push((since, run.end.t, run.end.mode));
        let (from, to) = window.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        intervals.retain(|&(since, until, _)| since <= to && until >= from);
        let lane = |&(name, count): &(&'static str, usize)| {
            let shown = |t: f64| from <= t && t <= to;
            let of_name = marks
                .events
                .iter()
                .filter(|event| event.1 == name && shown(event.0));
            (name, count, of_name.map(|event| event.0).collect())
        };
        let lanes = marks.counts.iter().map(lane).collect();
        let mut modes: Vec<usize> = intervals.iter().map(|i| i.2).collect();
        modes.sort_unstable();
        modes.dedup();
        let entry = |&mode: &usize| Entry {
            label: run.layout.modes.name(mode).into_owned(),
            colour: area(mode),
            filled: true,
        };
        let entries = modes.iter().map(entry).collect();
        Strip {
            intervals,
            modes,
            entries,
            lanes,
        }
    }

    /// Height of the strip, its legend and the lanes.
    pub fn height(&self, width: f64) -> f64 {
        STRIP + GAP + legend_height(&self.entries, width) + self.lanes.len() as f64 * LANE
    }

    /// Draws it with its upper left corner at `(left, top)`.
    pub fn draw(&self, canvas: &mut Canvas, time: &Axis, (left, top): (f64, f64), width: f64) {
        let strip = Area {
            left,
            top,
            width,
            height: STRIP,
        };
        canvas.text("mode", (left - GAP, top + STRIP / 2.0), Anchor::Right, TEXT);
        self.draw_modes(canvas, time, strip);
        frame(canvas, strip);
        let below = strip.bottom() + GAP;
        legend(canvas, &self.entries, (left, below), width);
        let mut top = below + legend_height(&self.entries, width);
        for (name, count, times) in &self.lanes {
            let lane = Area {
                left,
                top,
                width,
                height: LANE,
            };
            let middle = top + LANE / 2.0;
            canvas.text(name, (left - GAP, middle), Anchor::Right, SMALL);
            canvas.text(
                &count.to_string(),
                (lane.right() + GAP, middle),
                Anchor::Left,
                SMALL,
            );
            draw_ticks(canvas, time, lane, times);
            top += LANE;
        }
    }

    /// Every column of pixels is divided among the modes by the time they took in it, so that a
    /// strip with thousands of changes shows how much of each there was.
    fn draw_modes(&self, canvas: &mut Canvas, time: &Axis, strip: Area) {
        let columns = strip.width as usize;
        let place = |mode| {
            self.modes
                .binary_search(&mode)
                .expect("every mode that occurs is listed")
        };
        let mut shares = vec![vec![0.0; self.modes.len()]; columns];
        for &(from, to, mode) in &self.intervals {
            let at = |t| (time.position(t) * strip.width).clamp(0.0, strip.width);
            let (from, to) = (at(from), at(to));
            let last = (to.ceil() as usize).min(columns);
            for (i, column) in shares.iter_mut().enumerate().take(last).skip(from as usize) {
                column[place(mode)] += to.min((i + 1) as f64) - from.max(i as f64);
            }
        }
        for (k, &mode) in self.modes.iter().enumerate() {
            let bounds = |i: usize| {
                let below: f64 = shares[i][..k].iter().sum();
                (below, below + shares[i][k])
            };
            for run in runs(columns, |i| shares[i][k] > 0.0) {
                let step = |i: usize, y: f64| [(i, y), (i + 1, y)];
                let lower = run.clone().flat_map(|i| step(i, bounds(i).0));
                let upper = run.clone().flat_map(|i| step(i, bounds(i).1)).rev();
                let corner = |(i, y): (usize, f64)| {
                    (
                        strip.left + i as f64,
                        strip.bottom() - y.min(1.0) * strip.height,
                    )
                };
                let polygon: Vec<_> = lower.chain(upper).map(corner).collect();
                canvas.polygon(polygon, area(mode));
            }
        }
    }
}

/// One tick for every column of pixels with a transition.
fn draw_ticks(canvas: &mut Canvas, time: &Axis, lane: Area, times: &[f64]) {
    let columns = lane.width as usize;
    let mut hit = vec![false; columns + 1];
    for &t in times {
        hit[(time.position(t).clamp(0.0, 1.0) * lane.width) as usize] = true;
    }
    for run in runs(hit.len(), |i| hit[i]) {
        let (from, to) = (lane.left + run.start as f64, lane.left + run.end as f64);
        canvas.rectangle((from, lane.top + 2.0), (to, lane.bottom() - 2.0), INK);
    }
}

/// The maximal ranges of `0..n` in which `holds` is true.
fn runs(n: usize, holds: impl Fn(usize) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = None;
    for i in 0..=n {
        match (start, i < n && holds(i)) {
            (None, true) => start = Some(i),
            (Some(from), false) => {
                runs.push(from..i);
                start = None;
            }
            _ => {}
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_maximal() {
        let holds = [true, true, false, true];
        assert_eq!(runs(4, |i| holds[i]), [0..2, 3..4]);
        assert_eq!(runs(0, |_| true), []);
    }
}
