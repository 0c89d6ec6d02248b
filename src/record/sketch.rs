//! What pictures are drawn from: a run's curves, modes and transitions, in bounded memory.
//!
//! Short runs are kept whole. Of longer ones the older half is thinned out again and again: time is cut into
//! intervals of 2ᵏ s, and of the rows in each the first, the last and those with the least and the largest value of
//! each column stay. Intervals of a larger k are made of whole ones of a smaller k, so that the extremes are those of
//! all rows, however often it happens.

use crate::hybrid::Observer;
use crate::hybrid::Run;
use crate::run::Layout;
use crate::run::{Column, Event, Jump, Sides, Snapshot};
use std::ops::{ControlFlow, Range};

/// Most numbers that are kept of the rows: 32 MB, some thousand intervals of a model with twenty columns.
const MOST_OF_ROWS: usize = 1 << 22;
/// The same of the states before and after transitions.
const MOST_OF_SIDES: usize = 1 << 21;
/// Most transitions and visits of modes that are kept.
const MOST_MARKS: usize = 1 << 17;

/// The curves of a run, and when it was in which mode.
#[derive(Debug, Clone)]
pub struct Sketch {
    columns: Vec<Column>,
    rows: ColumnSamples,
    sides: ColumnSamples,
    marks: Marks,
    /// Number of rows and points that it was given.
    taken: usize,
    /// Whether what it was given includes the points between rows.
    has_points: bool,
}

/// Values of columns over time.
#[derive(Debug, Clone)]
struct ColumnSamples {
    /// Number of columns.
    width: usize,
    t: Vec<f64>,
    values: Vec<f64>,
    /// Most rows, even.
    most: usize,
    /// How many rows of the older ones were thinned out.
    thinned: usize,
    /// Length of the intervals in which they were, s.
    interval: f64,
}

/// Transitions, and visits of modes.
#[derive(Debug, Clone)]
pub(crate) struct Marks {
    /// Time, name and target of transitions.
    pub events: Vec<(f64, &'static str, usize)>,
    /// From when to when the run was in which mode, but for the last visit.
    pub visits: Vec<(f64, f64, usize)>,
    /// Names and numbers of transitions, in the order in which they first happened.
    pub counts: Vec<(&'static str, usize)>,
    most: usize,
    /// Length of the intervals of which one transition of a name is kept, s.
    interval: f64,
    /// How many of both lists were thinned out.
    thinned: [usize; 2],
}

impl Sketch {
    /// Nothing yet.
    pub fn new(layout: &Layout) -> Sketch {
        Sketch::with_room(layout, [MOST_OF_ROWS, MOST_OF_SIDES, MOST_MARKS])
    }

    /// Nothing yet, with room for so many numbers of rows and of sides, and so many marks.
    fn with_room(layout: &Layout, [rows, sides, marks]: [usize; 3]) -> Sketch {
        let columns = layout.columns();
        let of_state = columns.iter().filter(|c| c.group.is_of_the_state()).count();
        Sketch {
            rows: ColumnSamples::new(columns.len(), rows),
            sides: ColumnSamples::new(of_state, sides),
            columns,
            marks: Marks {
                events: Vec::new(),
                visits: Vec::new(),
                counts: Vec::new(),
                most: marks,
                interval: 0.0,
                thinned: [0; 2],
            },
            taken: 0,
            has_points: true,
        }
    }

    /// That of a run that is in memory.
    pub fn of(run: &Run) -> Sketch {
        let mut sketch = Sketch::new(&run.layout);
        sketch.lacks_points();
        for (i, &t) in run.trajectory.t.iter().enumerate() {
            sketch.row(t, run.trajectory.row(i));
        }
        for event in &run.events {
            let Event { before, after, .. } = event;
            sketch.event(&event.jump(), Some([before, after]));
        }
        sketch
    }

    /// Takes a row of the trajectory. Times do not decrease.
    pub fn row(&mut self, t: f64, values: &[f64]) {
        self.taken += 1;
        self.rows.push(t, values.iter().copied());
    }

    /// Takes a point between rows. Times do not decrease.
    pub fn point(&mut self, t: f64, values: &[f64]) {
        self.row(t, values);
    }

    /// Takes a transition, with the states before and after it where they are kept. Times do not decrease.
    pub fn event(&mut self, jump: &Jump, sides: Option<[&Snapshot; 2]>) {
        for side in sides.into_iter().flatten() {
            self.sides.push(jump.t, side.values());
        }
        let since = self.marks.visits.last().map(|visit| visit.1);
        let since = since.or(self.rows.t.first().copied()).unwrap_or(jump.t);
        self.marks.push(jump, since);
    }

    /// A column over time: the samples and, for what belongs to the state, both sides of every
    /// transition, in order of time. A sample at the time of a transition comes first.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn curve(&self, column: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let of_state = self.columns[column].group.is_of_the_state();
        let sides = of_state.then(|| self.sides.column(column));
        let mut sides = sides.into_iter().flatten().peekable();
        let mut samples = self.rows.column(column).peekable();
        std::iter::from_fn(move || match (samples.peek(), sides.peek()) {
            (Some(sample), Some(side)) if sample.0 <= side.0 => samples.next(),
            (_, Some(_)) => sides.next(),
            _ => samples.next(),
        })
    }

    /// Number of rows and points that it was given.
    pub(crate) fn taken(&self) -> usize {
        self.taken
    }

    /// Says that of a part of the run there are rows alone, as of one that goes on with files.
    pub fn lacks_points(&mut self) {
        self.has_points = false;
    }

    /// Whether between two neighbours in time there is nothing but a part of a step: points between rows, both sides of every
    /// transition, and none of them left out.
    pub(crate) fn is_whole(&self) -> bool {
        let whole = self.rows.thinned + self.sides.thinned == 0;
        whole && self.has_points && self.sides.t.len() == 2 * self.marks.total()
    }

    /// From when on every row and every transition is kept, s; −∞ where nothing was left out.
    pub fn whole_since(&self) -> f64 {
        self.rows.whole_since().max(self.sides.whole_since())
    }

    /// First time of a row.
    pub(crate) fn first_row(&self) -> Option<f64> {
        self.rows.t.first().copied()
    }

    /// Times of all rows and transitions, in no order.
    pub(crate) fn times(&self) -> impl Iterator<Item = f64> + '_ {
        let events = self.marks.events.iter().map(|event| event.0);
        self.rows.t.iter().copied().chain(events)
    }

    pub(crate) fn marks(&self) -> &Marks {
        &self.marks
    }

    /// The columns.
    pub(crate) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Index of a column by name.
    pub(crate) fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|c| c.name == name)
    }
}

/// A run goes into a sketch while it is computed, with the points that its curves have between rows.
impl Observer for Sketch {
    fn row(&mut self, t: f64, _mode: usize, values: &[f64]) -> ControlFlow<()> {
        Sketch::row(self, t, values);
        ControlFlow::Continue(())
    }
    fn sees_points(&self) -> bool {
        true
    }
    fn point(&mut self, t: f64, _mode: usize, values: &[f64]) {
        Sketch::point(self, t, values);
    }
    fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        Sketch::event(self, jump, sides.map(|sides| [&sides.before, &sides.after]));
    }
}

/// 2ᵏ above a positive length.
fn power_above(length: f64) -> f64 {
    2f64.powi(length.log2().floor() as i32 + 1)
}

/// A length of intervals: one for all times where there is none yet, since all are the same.
fn length_of(interval: f64) -> f64 {
    if interval > 0.0 {
        interval
    } else {
        f64::INFINITY
    }
}

/// The index of the interval of a time.
fn interval_of(t: f64, interval: f64) -> f64 {
    (t / interval).floor()
}

/// Ranges of a list that lie in one interval each.
fn intervals<'a, T>(
    list: &'a [T],
    time: impl Fn(&T) -> f64 + 'a,
    interval: f64,
) -> impl Iterator<Item = Range<usize>> + 'a {
    let mut start = 0;
    std::iter::from_fn(move || {
        let first = interval_of(time(list.get(start)?), interval);
        let inside = |x: &&T| interval_of(time(x), interval) == first;
        let from = start;
        start += list[from..].iter().take_while(inside).count().max(1);
        Some(from..start)
    })
}

impl ColumnSamples {
    fn new(width: usize, most: usize) -> ColumnSamples {
        ColumnSamples {
            width,
            t: Vec::new(),
            values: Vec::new(),
            most: most / (width + 1) / 2 * 2,
            thinned: 0,
            interval: 0.0,
        }
    }

    fn push(&mut self, t: f64, values: impl Iterator<Item = f64>) {
        if self.t.len() >= self.most {
            self.thin();
        }
        self.t.push(t);
        self.values.extend(values);
    }

    fn column(&self, column: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let width = self.width;
        let value = move |(i, &t): (usize, &f64)| (t, self.values[i * width + column]);
        self.t.iter().enumerate().map(value)
    }

    fn whole_since(&self) -> f64 {
        match self.thinned {
            0 => f64::NEG_INFINITY,
            // The first row after those may be the second one of its time.
            _ => self
                .t
                .get(self.thinned)
                .map_or(f64::INFINITY, |&t| t.next_up()),
        }
    }

    /// Leaves of the older half of the rows at most a half.
    fn thin(&mut self) {
        let old = self.most / 2;
        // What is kept of an interval at most, and how many intervals there may then be.
        let kept_of_one = 2 + 2 * self.width;
        let count = (old / 2 / kept_of_one).max(1);
        let span = self.t[old - 1] - self.t[0];
        if span > 0.0 {
            // One more interval than the span holds may be touched.
            let least = power_above(span / count.saturating_sub(1).max(1) as f64);
            self.interval = self.interval.max(least);
        }
        let mut kept = 0;
        let length = length_of(self.interval);
        let ranges: Vec<_> = intervals(&self.t[..old], |&t| t, length).collect();
        let mut stays = Vec::new();
        for range in ranges {
            self.extremes(range, &mut stays);
            for &row in &stays {
                self.copy(row, kept);
                kept += 1;
            }
        }
        self.thinned = kept;
        for row in old..self.t.len() {
            self.copy(row, kept);
            kept += 1;
        }
        self.t.truncate(kept);
        self.values.truncate(kept * self.width);
    }

    /// Of some rows the first, the last, and those with the least and the largest value of each column, in order.
    fn extremes(&self, rows: Range<usize>, stays: &mut Vec<usize>) {
        stays.clear();
        stays.extend([rows.start, rows.end - 1]);
        for column in 0..self.width {
            let value = |row: usize| self.values[row * self.width + column];
            let (mut low, mut high) = (rows.start, rows.start);
            for row in rows.clone() {
                // One that is not a number is less and more than nothing.
                let x = value(row);
                if x < value(low) || value(low).is_nan() {
                    low = row;
                }
                if x > value(high) || value(high).is_nan() {
                    high = row;
                }
            }
            stays.extend([low, high]);
        }
        stays.sort_unstable();
        stays.dedup();
    }

    fn copy(&mut self, from: usize, to: usize) {
        let width = self.width;
        self.t[to] = self.t[from];
        let values = from * width..(from + 1) * width;
        self.values.copy_within(values, to * width);
    }
}

impl Marks {
    fn push(&mut self, jump: &Jump, since: f64) {
        if self.events.len().max(self.visits.len()) >= self.most {
            self.thin();
        }
        self.events.push((jump.t, jump.transition, jump.to));
        self.visits.push((since, jump.t, jump.from));
        let known = self.counts.iter_mut();
        match known.into_iter().find(|(name, _)| *name == jump.transition) {
            Some((_, count)) => *count += 1,
            None => self.counts.push((jump.transition, 1)),
        }
    }

    /// Number of all transitions.
    pub fn total(&self) -> usize {
        self.counts.iter().map(|(_, count)| count).sum()
    }

    /// Leaves of the older half at most a half: of the transitions of an interval the first of each name and the last;
    /// of its visits one of each mode, as long as all of them together.
    fn thin(&mut self) {
        let old = self.most / 2;
        let modes = self.visits.iter().map(|visit| visit.2).max().unwrap_or(0) + 1;
        let kept_of_one = (self.counts.len() + 1).max(modes);
        let count = (old / 2 / kept_of_one).max(1);
        let last = [
            self.events.get(old - 1).map(|e| e.0),
            self.visits.get(old - 1).map(|v| v.1),
        ];
        let first = self.visits[0].0.min(self.events[0].0);
        let span = last.into_iter().flatten().fold(first, f64::max) - first;
        if span > 0.0 {
            let least = power_above(span / count.saturating_sub(1).max(1) as f64);
            self.interval = self.interval.max(least);
        }
        let interval = length_of(self.interval);
        if self.events.len() >= self.most {
            let mut kept: Vec<(f64, &'static str, usize)> = Vec::with_capacity(self.most);
            for range in intervals(&self.events[..old], |e| e.0, interval) {
                let start = kept.len();
                let last = range.end - 1;
                for (i, &event) in self.events[range.clone()].iter().enumerate() {
                    let is_known = kept[start..].iter().any(|k| k.1 == event.1);
                    if !is_known || range.start + i == last {
                        kept.push(event);
                    }
                }
            }
            self.thinned[0] = kept.len();
            kept.extend_from_slice(&self.events[old..]);
            self.events = kept;
        }
        if self.visits.len() >= self.most {
            let mut kept: Vec<(f64, f64, usize)> = Vec::with_capacity(self.most);
            for range in intervals(&self.visits[..old], |v| v.1, interval) {
                let visits = &self.visits[range];
                let (mut at, end) = (visits[0].0, visits[visits.len() - 1].1);
                let start = kept.len();
                for visit in visits {
                    let length = visit.1 - visit.0;
                    match kept[start..].iter_mut().find(|k| k.2 == visit.2) {
                        Some(known) => known.1 += length,
                        None => kept.push((0.0, length, visit.2)),
                    }
                }
                // Lengths become ends, one after the other.
                for known in &mut kept[start..] {
                    (known.0, known.1) = (at, (at + known.1).min(end));
                    at = known.1;
                }
                kept.last_mut().expect("there is a visit").1 = end;
            }
            self.thinned[1] = kept.len();
            kept.extend_from_slice(&self.visits[old..]);
            self.visits = kept;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Quantity;
    use proptest::prelude::*;

    fn layout() -> Layout {
        let quantity = |name: &str| vec![Quantity::new(name, "m", "")];
        Layout {
            coordinates: quantity("x"),
            velocities: quantity("x.rate"),
            energies: vec![Quantity::new("energy.stored", "J", "")],
            modes: crate::run::ModeNames::listed(vec!["a".into(), "b".into()]),
            ..Layout::default()
        }
    }

    fn jump(t: f64, from: usize) -> Jump {
        Jump {
            t,
            j: 0,
            transition: ["go", "come"][from],
            from,
            to: 1 - from,
            energy: None,
        }
    }

    #[test]
    fn a_long_run_takes_bounded_room_and_keeps_its_extremes() {
        let mut sketch = Sketch::with_room(&layout(), [4096, 2048, 256]);
        let spikes = [(777, 9.0), (54_321, -8.0), (99_999, 5.0)];
        let x = |i: usize| {
            let spike = spikes.iter().find(|s| s.0 == i);
            spike.map_or((i as f64 * 0.37).sin(), |s| s.1)
        };
        let mut time_in = [0.0; 2];
        for i in 0..200_000_usize {
            let t = i as f64 * 1e-3;
            sketch.row(t, &[x(i), 0.0, 1.0]);
            if i % 10 == 9 {
                let from = i / 10 % 2;
                let state = Snapshot {
                    q: vec![x(i)],
                    v: vec![0.0],
                    ..Snapshot::default()
                };
                sketch.event(&jump(t, from), Some([&state, &state]));
                time_in[from] += if i == 9 { t } else { 0.01 };
            }
            assert!(sketch.rows.t.len() <= 1024 && sketch.sides.t.len() <= 682);
            assert!(sketch.marks.events.len() <= 256 && sketch.marks.visits.len() <= 256);
        }
        assert!(sketch.rows.t.is_sorted() && sketch.sides.t.is_sorted());
        for (i, value) in spikes {
            let point = (i as f64 * 1e-3, value);
            assert!(sketch.curve(0).any(|p| p == point), "{point:?}");
        }
        assert_eq!(sketch.rows.t[0], 0.0);
        assert_eq!(sketch.marks.counts, [("go", 10_000), ("come", 10_000)]);
        let visits = &sketch.marks.visits;
        assert!(visits.windows(2).all(|w| w[0].1 == w[1].0));
        for mode in 0..2 {
            let kept: f64 = visits
                .iter()
                .filter(|v| v.2 == mode)
                .map(|v| v.1 - v.0)
                .sum();
            assert!(
                (kept - time_in[mode]).abs() < 1e-9,
                "{kept} {}",
                time_in[mode]
            );
        }
        // The newest half is whole.
        let since = sketch.whole_since();
        let whole = sketch.rows.t.iter().filter(|&&t| t >= since);
        assert!(whole.clone().count() > 300 && since < 199.9);
        assert!(whole.is_sorted_by(|a, b| *b - *a < 1.5e-3));
    }

    proptest! {
        #[test]
        fn every_interval_keeps_first_last_least_and_largest(
            steps in prop::collection::vec((0.0..0.4f64, -1.0..1.0f64), 300..900),
        ) {
            let mut sketch = Sketch::with_room(&layout(), [512, 512, 64]);
            let (mut t, mut all) = (0.0, Vec::new());
            for (dt, x) in steps {
                t += dt;
                all.push((t, x));
                sketch.row(t, &[x, 0.0, 0.0]);
            }
            let interval = sketch.rows.interval;
            let inside = |of: &[(f64, f64)], i: f64| -> Vec<f64> {
                of.iter().filter(|p| interval_of(p.0, interval) == i).map(|p| p.1).collect()
            };
            let kept: Vec<_> = sketch.curve(0).collect();
            // Those that are thinned out for good.
            let until = interval_of(kept[sketch.rows.thinned].0, interval);
            for i in (0..until as i32).map(f64::from) {
                let (all, some) = (inside(&all, i), inside(&kept, i));
                prop_assert_eq!(all.first(), some.first());
                prop_assert_eq!(all.last(), some.last());
                for pick in [f64::min, f64::max] {
                    let all = all.iter().copied().reduce(pick);
                    prop_assert_eq!(all, some.iter().copied().reduce(pick));
                }
            }
        }
    }
}
