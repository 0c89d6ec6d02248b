//! Largest and smallest values of what a run records, and when it first takes them.

use super::interpolants::{Interpolants, point};
use crate::numerics::{Memory, Persist};
use crate::run::{ColumnKind, Layout, Peak};
use std::ops::Range;

/// The extremes so far, one of each column that has one.
#[derive(Debug)]
pub struct Extremes {
    pub coordinates: usize,
    pub reactions: Range<usize>,
    pub outputs: Range<usize>,
    pub energies: Range<usize>,
    /// By column; a column without a value yet has the times NaN.
    peaks: Box<[Peak]>,
}

impl Persist for Extremes {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.peaks.iter_mut().try_for_each(|peak| {
            let Peak {
                max,
                t_max,
                min,
                t_min,
            } = peak;
            [max, t_max, min, t_min]
                .into_iter()
                .try_for_each(|x| x.persist(memory))
        })
    }
}

impl Extremes {
    /// Nothing seen of any column.
    pub fn new(layout: &Layout) -> Self {
        let nothing = Peak {
            max: f64::NEG_INFINITY,
            t_max: f64::NAN,
            min: f64::INFINITY,
            t_min: f64::NAN,
        };
        Extremes {
            coordinates: layout.coordinates.len(),
            reactions: layout.range(ColumnKind::Reaction),
            outputs: layout.range(ColumnKind::Output),
            energies: layout.range(ColumnKind::Energy),
            peaks: vec![nothing; layout.columns().len()].into(),
        }
    }

    /// Those of a column so far.
    pub fn peak(&self, column: usize) -> Peak {
        self.peaks[column]
    }

    /// A column has a value at time `t`, s. One that is not a number is passed over.
    #[inline]
    pub fn note(&mut self, column: usize, t: f64, x: f64) {
        let peak = &mut self.peaks[column];
        if x > peak.max || peak.t_max.is_nan() && x == peak.max {
            (peak.max, peak.t_max) = (x, t);
        }
        if x < peak.min || peak.t_min.is_nan() && x == peak.min {
            (peak.min, peak.t_min) = (x, t);
        }
    }

    /// Coordinates and velocities have these values at time `t`, s.
    pub fn note_state(&mut self, t: f64, [q, v]: [&[f64]; 2]) {
        for (i, (&q, &v)) in q.iter().zip(v).take(self.coordinates).enumerate() {
            self.note(i, t, q);
            self.note(self.coordinates + i, t, v);
        }
    }

    /// Columns, as far as there are any, have these values at time `t`, s.
    pub fn note_all(&mut self, columns: Range<usize>, t: f64, values: &[f64]) {
        for (column, &x) in columns.zip(values) {
            self.note(column, t, x);
        }
    }

    /// Largest magnitude that a column has had.
    fn magnitude(&self, column: usize) -> f64 {
        let Peak { max, min, .. } = self.peaks[column];
        match self.peaks[column].t_max.is_nan() {
            true => 0.0,
            false => max.abs().max(min.abs()),
        }
    }

    /// Whether a function may take a value on its window that is above, or below, all that its column has had, and
    /// its polynomial cannot tell where. Its `rate` may be a function as well: where that keeps its sign the ends of the
    /// window are extremes. `scale` is the size of what it is a sum of, where that may be more than its own.
    pub fn is_open(
        &self,
        of: &Interpolants,
        function: usize,
        column: usize,
        tolerance: f64,
        (rate, scale): (Option<usize>, f64),
    ) -> bool {
        let error = of.error(function);
        let size = of.size(function).max(self.magnitude(column)).max(scale);
        error > tolerance * size
            && self.may_exceed(of, function, column, error) != [false; 2]
            && !rate.is_some_and(|rate| of.keeps_sign(rate))
    }

    /// Whether a function may exceed the largest value of its column between nodes, and fall below the smallest.
    fn may_exceed(
        &self,
        of: &Interpolants,
        function: usize,
        column: usize,
        error: f64,
    ) -> [bool; 2] {
        let ([highest, lowest], peak) = (of.range(function), &self.peaks[column]);
        let room = of.overshoot(function) + error;
        [highest + room > peak.max, lowest - room < peak.min]
    }

    /// Takes the values of a function at the nodes, at times given by `time` (of the place in the window), and gives
    /// the places between nodes at which it may exceed the largest value and fall below the smallest.
    pub fn update(
        &mut self,
        of: &Interpolants,
        function: usize,
        column: usize,
        rate: Option<usize>,
        time: impl Fn(f64) -> f64,
    ) -> [Option<f64>; 2] {
        for value in of.range(function) {
            let peak = self.peaks[column];
            if value > peak.max || value < peak.min {
                let t = time(point(of.node_of(function, value)));
                self.note(column, t, value);
            }
        }
        let may = self.may_exceed(of, function, column, of.error(function));
        if may == [false; 2] || rate.is_some_and(|rate| of.keeps_sign(rate)) {
            return [None; 2];
        }
        let Peak { max, min, .. } = self.peaks[column];
        [(may[0], 1.0, max), (may[1], -1.0, -min)]
            .map(|(may, sign, best)| may.then(|| of.summit(function, sign, best)).flatten())
    }

    /// The extremes, `(column, peak)`, of all columns that have had a value.
    pub fn finish(&self) -> Vec<(usize, Peak)> {
        let peaks = self.peaks.iter().copied().enumerate();
        peaks.filter(|(_, peak)| !peak.t_max.is_nan()).collect()
    }
}
