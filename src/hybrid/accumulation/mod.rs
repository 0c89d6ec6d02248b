//! Recognition of a Zeno accumulation: infinitely many events in finite time.
//!
//! Successive events repeat a pattern (of one hop, or of several, since the pivot alternates and
//! sticks and slips may belong to it) and the durations of the pattern shrink geometrically. Where
//! the pattern's ratio has converged, the limit in time and state is that of the geometric series.
//! The rest of the series is left out only once it moves nothing by more than the tolerances of
//! the run.

mod prediction;

use super::instant::Instant;
use crate::numerics::{Memory, Persist};
use prediction::Prediction;
use std::sync::atomic::{Ordering, compiler_fence};

/// Longest pattern, in events: both pivots × (landing, slip, stick, reversal).
pub const LONGEST_PATTERN: usize = 8;

/// Largest ratio of successive patterns that is told from one: the sum of the series divides by
/// 1 − ratio, which keeps half of a double's digits here (1 − √ε). Events whose ratio is closer to
/// one than this are regular, and rounding decides on which side of one it falls.
const LARGEST_RATIO: f64 = 1.0 - 1.5e-8;

/// Part of the time since the start that the last pattern of several events takes at least while the rest
/// of its series advances the time: √ε = 2⁻²⁶, and twice that for the rounding of the times.
pub const SHORTEST_PATTERN: f64 = 2.0 / (1_u32 << 26) as f64;

/// What makes two events the same, besides the discrete states after them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Signature {
    /// Index of the guard in its mode.
    pub guard: usize,
    /// Index of the transition of the guard.
    pub transition: usize,
    /// Index of the mode entered.
    pub mode: usize,
}

impl Signature {
    /// All of it in one number. A model has fewer of each than 2¹⁶.
    pub fn key(self) -> u64 {
        let [guard, transition, mode] = [self.guard, self.transition, self.mode].map(|i| i as u64);
        guard | transition << 16 | mode << 32
    }

    /// The index of the guard.
    fn guard_of(key: u64) -> usize {
        usize::from(key as u16)
    }
}

/// Limit of an accumulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// When it is reached.
    pub at: Instant,
    /// Coordinates, then velocities, at the limit.
    pub state: Vec<f64>,
    /// What each of them may be off by: what is left of the series moves it, the last two predictions differ, and
    /// their rounding.
    pub uncertainty: Vec<f64>,
    /// The modes that the events of the repeating pattern lead to, that of the last event first.
    pub modes: Vec<usize>,
}

/// A geometric series of patterns.
struct GeometricSeries {
    /// Number of events of the pattern.
    pattern: usize,
    /// Ratio of the durations of the last two patterns, and of the two before.
    ratio: f64,
    ratio_before: f64,
    /// Duration of what is left, s.
    remaining: f64,
    /// Where it ends.
    limit: Instant,
}

impl GeometricSeries {
    /// Sum of what is left, in units of the last term.
    fn factor(&self) -> f64 {
        self.ratio / (1.0 - self.ratio)
    }
}

/// Room for events: a power of two.
const ROOM: usize = Accumulation::MEMORY.next_power_of_two();

/// Numbers that fill a line of the cache.
const LINE: usize = 8;

/// The last events of a run.
#[derive(Debug)]
pub struct Accumulation {
    /// When they happened, and the bits of what makes each the same as others ([`Signature::key`]): of many events these
    /// are looked at, and nothing else.
    times: [[f64; 2]; ROOM],
    keys: [u64; ROOM],
    /// Coordinates, velocities and discrete states after each, as few lines of the cache as hold them.
    records: Box<[f64]>,
    /// Where the first record begins, and how long one is.
    first: usize,
    stride: usize,
    /// Absolute tolerances of coordinates and velocities.
    absolute: Box<[f64]>,
    /// Number of discrete states.
    discretes: usize,
    count: usize,
    /// Number of last events since each of which something moved, but nothing by more than rounding.
    still: usize,
    /// The limit that was told best.
    prediction: Prediction,
    /// Number of last events that the motion did not resolve.
    unresolved: usize,
    /// Whether the last event ended a hop that is lower than what the implicit method tells, and the explicit one does.
    needs_series: bool,
}

impl Persist for Accumulation {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.times.persist(memory)?;
        self.keys.persist(memory)?;
        // Where the first begins is a matter of this process.
        memory.slice(&mut self.records[self.first..][..ROOM * self.stride])?;
        self.count.persist(memory)?;
        self.still.persist(memory)?;
        self.prediction.persist(memory)?;
        self.unresolved.persist(memory)?;
        self.needs_series.persist(memory)
    }
}

impl Accumulation {
    /// Number of events remembered: three repetitions of the longest pattern and the one before.
    pub const MEMORY: usize = 3 * LONGEST_PATTERN + 1;

    /// Part of itself by which a component moves at most while it stands still: the rounding of a guard, as
    /// many units in the last place as events are remembered.
    pub const HARDLY: f64 = Self::MEMORY as f64 * f64::EPSILON;

    /// No events yet. Given are the absolute tolerances of coordinates and velocities, and the number of discrete
    /// states.
    pub fn new(absolute: Box<[f64]>, discretes: usize) -> Self {
        let numbers = absolute.len() + discretes;
        let stride = match numbers <= LINE {
            true => numbers.next_power_of_two(),
            false => numbers.next_multiple_of(LINE),
        };
        let records = vec![0.0; ROOM * stride + LINE].into_boxed_slice();
        Accumulation {
            times: [[0.0; 2]; ROOM],
            keys: [0; ROOM],
            first: records.as_ptr().align_offset(LINE * size_of::<f64>()) % LINE,
            records,
            stride,
            prediction: Prediction::none(absolute.len()),
            absolute,
            discretes,
            count: 0,
            still: 0,
            unresolved: 0,
            needs_series: false,
        }
    }

    /// Takes other absolute tolerances of coordinates and velocities.
    pub fn set_absolute(&mut self, [q, v]: [&[f64]; 2]) {
        let (of_q, of_v) = self.absolute.split_at_mut(q.len());
        of_q.copy_from_slice(q);
        of_v.copy_from_slice(v);
    }

    /// Forgets all events.
    pub fn clear(&mut self) {
        (self.count, self.still, self.unresolved) = (0, 0, 0);
        self.needs_series = false;
        self.prediction.clear();
    }

    /// Compares coordinates and velocities just before the next event with those after the last one: whether something
    /// moved, but nothing by more than rounding, is remembered with the next one.
    #[inline]
    pub fn compare(&mut self, [q, v]: [&[f64]; 2]) {
        let (last_q, last_v) = match self.count {
            0 => (&[][..], &[][..]),
            _ => self.state(0).split_at(q.len()),
        };
        // A state that is held still is no evidence.
        let moved = hardly_moved(q, last_q).and_then(|q| Some(q | hardly_moved(v, last_v)?));
        self.still = if moved == Some(true) {
            self.still + 1
        } else {
            0
        };
    }

    /// Remembers an event by what makes it the same as others ([`Signature::key`]), with coordinates, velocities and
    /// discrete states after it; those before it were compared.
    #[inline]
    pub fn push(&mut self, key: u64, at: Instant, after: &[f64]) {
        let still = self.still;
        let record = self.push_apart(key, at);
        // Numbers that were written one by one are read one by one.
        for (to, from) in record.iter_mut().zip(after) {
            *to = *from;
            compiler_fence(Ordering::SeqCst);
        }
        self.still = still;
    }

    /// Remembers an event before which something has moved since the one before, by the bits of what makes it the
    /// same as others ([`Signature::key`]); gives room for coordinates, velocities and discrete states after it.
    #[inline]
    pub fn push_apart(&mut self, key: u64, at: Instant) -> &mut [f64] {
        self.still = 0;
        let place = self.count % ROOM;
        self.count += 1;
        self.times[place].copy_from_slice(&at.parts());
        self.keys[place] = key;
        let start = self.first + place * self.stride;
        &mut self.records[start..][..self.absolute.len() + self.discretes]
    }

    /// When the last event happened, if there was one, with coordinates and velocities, and discrete states
    /// after it.
    pub fn last(&self) -> Option<(Instant, &[f64], &[f64])> {
        (self.count > 0).then(|| (self.at(0), self.state(0), self.discrete(0)))
    }

    /// What an event was, and in which mode it happened. Discrete states do not count.
    fn event(&self, back: usize) -> (u64, usize) {
        (self.keys[self.slot(back)], self.mode(back + 1))
    }

    /// Whether the last event was the fall of a guard.
    pub fn was(&self, guard: usize) -> bool {
        self.count > 0 && Signature::guard_of(self.keys[self.slot(0)]) == guard
    }

    /// Time since the event before the last one that was like it, s, if one is remembered: others may have happened at the same instant.
    pub fn last_hop(&self) -> Option<f64> {
        let known = LONGEST_PATTERN.min(self.count.saturating_sub(2));
        let before = (1..=known).find(|&p| self.event(p) == self.event(0))?;
        Some(self.at(0).since(self.at(before)))
    }

    /// Slot of the event so many before the last.
    #[inline]
    fn slot(&self, back: usize) -> usize {
        (self.count - 1 - back) % ROOM
    }

    #[inline]
    fn at(&self, back: usize) -> Instant {
        Instant::of_parts(self.times[self.slot(back)])
    }

    /// The mode that an event has led to ([`Signature::key`]).
    fn mode(&self, back: usize) -> usize {
        (self.keys[self.slot(back)] >> 32) as usize
    }

    /// Coordinates, velocities and discrete states after an event.
    #[inline]
    fn record(&self, back: usize) -> &[f64] {
        let start = self.first + self.slot(back) * self.stride;
        &self.records[start..][..self.absolute.len() + self.discretes]
    }

    fn state(&self, back: usize) -> &[f64] {
        &self.record(back)[..self.absolute.len()]
    }

    fn discrete(&self, back: usize) -> &[f64] {
        &self.record(back)[self.absolute.len()..]
    }

    /// Whether two events are the same but for time and state.
    #[inline]
    fn are_alike(&self, one: usize, other: usize) -> bool {
        if self.keys[self.slot(one)] != self.keys[self.slot(other)] {
            return false;
        }
        let mut pairs = self.discrete(one).iter().zip(self.discrete(other));
        pairs.all(|(a, b)| a.to_bits() == b.to_bits())
    }

    /// How long it takes at most, as far as the last events tell, until something happens after the last of them, s: as
    /// long as after the event before that was like it, where that took less than after the one before it. Infinite where
    /// nothing is told. Discrete states do not count: of what they say about what is open nothing follows.
    pub fn foreseen(&self) -> f64 {
        let known = LONGEST_PATTERN.min(self.count.saturating_sub(2) / 2);
        let Some(p) = (1..=known).find(|&p| self.event(p) == self.event(0)) else {
            return f64::INFINITY;
        };
        let after = |back: usize| self.at(back - 1).since(self.at(back));
        match self.event(2 * p) == self.event(0) && after(p) < after(2 * p) {
            true => after(p),
            false => f64::INFINITY,
        }
    }

    /// The limit, if the last events accumulate and what is left of the series moves no component
    /// of the state by more than its tolerance; `relative` is the relative one, and the accuracy asked of
    /// the limit's time.
    pub fn limit(&self, relative: f64) -> Option<Limit> {
        let known = LONGEST_PATTERN.min(self.count.saturating_sub(1) / 3);
        if known == 0 {
            return None;
        }
        let is_short = self.is_short();
        // What repeats after p events repeats after a multiple of p, and leaves as much.
        let single = self.are_alike(0, 1) && (is_short || self.may_be_last(relative));
        // The last event of a pattern of several whose rest is negligible is within the tolerances of the one before.
        let several = known > 1 && (is_short || self.changes_within((1.0, 1.0), relative));
        if !single && !several {
            return None;
        }
        let patterns = (if single { 1 } else { 2 })..=(if several { known } else { 1 });
        let series = patterns
            .into_iter()
            .find_map(|p| self.series(p, relative))?;
        let ends = self.is_negligible(&series, relative);
        ends.then(|| self.end_of(&series))
    }

    /// The limit, if the last events accumulate, however far the rest of the series moves the state.
    pub fn extrapolated(&self, relative: f64) -> Option<Limit> {
        let known = LONGEST_PATTERN.min(self.count.saturating_sub(1) / 3);
        let series = (1..=known).find_map(|p| self.series(p, relative))?;
        Some(self.end_of(&series))
    }

    /// The limit, if the last events repeat without advancing the time, with changes of the rates that shrink geometrically: of
    /// impacts of several contacts in turn that are closer to each other than the time tells.
    pub fn at_one_instant(&self, relative: f64) -> Option<Limit> {
        let known = LONGEST_PATTERN.min(self.count.saturating_sub(1) / 3);
        (1..=known).find_map(|p| {
            let at = self.at(0);
            let stands = at.since(self.at(3 * p)) < at.seconds().abs() * f64::EPSILON;
            if !(stands && (0..2 * p).all(|i| self.are_alike(i, i + p))) {
                return None;
            }
            let [last, middle, first] = [0, 1, 2].map(|k| self.change_of_rates(k * p, p));
            let (ratio, ratio_before) = (last / middle, middle / first);
            if !(ratio < LARGEST_RATIO && ratio_before < LARGEST_RATIO) {
                return None;
            }
            let limit = self.end_of(&GeometricSeries {
                pattern: p,
                ratio,
                ratio_before,
                remaining: 0.0,
                limit: at,
            });
            let now = self.state(0).iter().zip(&self.absolute);
            let told = limit.state.iter().zip(&limit.uncertainty);
            // The last two predictions agree.
            let has_converged = now
                .zip(told)
                .all(|((now, absolute), (value, uncertainty))| {
                    uncertainty - (value - now).abs() <= absolute + relative * now.abs()
                });
            has_converged.then_some(limit)
        })
    }

    /// The largest change of a rate over the `p` events before the one so many back, in tolerances.
    fn change_of_rates(&self, back: usize, p: usize) -> f64 {
        let rates = self.absolute.len() / 2..;
        let [now, before] = [back, back + p].map(|back| &self.state(back)[rates.clone()]);
        let changes = now.iter().zip(before).map(|(a, b)| (a - b).abs());
        let in_tolerances = changes
            .zip(&self.absolute[rates.clone()])
            .map(|(c, a)| c / a);
        in_tolerances.fold(0.0, f64::max)
    }

    /// Counts the last events that the motion does not resolve; whether the memory is full of them.
    pub fn is_unresolved(&mut self, unresolved: bool) -> bool {
        self.unresolved = if unresolved { self.unresolved + 1 } else { 0 };
        self.unresolved >= Self::MEMORY
    }

    /// Says whether the last event ended a hop that only the explicit method resolves.
    pub fn set_needs_series(&mut self, needs: bool) {
        self.needs_series = needs;
    }

    /// Whether it did.
    pub fn needs_series(&self) -> bool {
        self.needs_series
    }

    /// Whether the time since the last event but one is so short that the rest of a series, at least
    /// last²/middle with the durations of the last two patterns, may not advance the time t, which middle is
    /// less than: shorter than √ε t.
    fn is_short(&self) -> bool {
        let [now, before] = [0, 1].map(|back| self.at(back).seconds());
        now - before <= SHORTEST_PATTERN * now
    }

    /// Whether `part` of what the last event differs by from the one before is within `room` times the tolerances.
    #[inline(always)]
    fn changes_within(&self, (part, room): (f64, f64), relative: f64) -> bool {
        let pairs = self.state(0).iter().zip(self.state(1));
        pairs.zip(&self.absolute).all(|((now, before), absolute)| {
            part * (now - before).abs() <= room * (absolute + relative * now.abs())
        })
    }

    /// Whether what is left of a pattern of one event, if it is one, may be negligible
    /// ([`Self::is_negligible`]): looked at first, since it seldom is.
    #[inline]
    fn may_be_last(&self, relative: f64) -> bool {
        let at = [0, 1, 2].map(|back| self.at(back));
        let [last, middle] = [at[0].since(at[1]), at[1].since(at[2])];
        last < middle && self.changes_within((last, middle - last), relative)
    }

    /// The geometric series of a pattern of `p` events, if its limit has converged.
    #[inline]
    fn series(&self, p: usize, relative: f64) -> Option<GeometricSeries> {
        let (series, uncertainty) = self.candidate(p)?;
        let limit = series.limit.seconds().abs();
        let has_converged = uncertainty <= (relative * limit).max(limit * f64::EPSILON);
        has_converged.then_some(series)
    }

    /// The series of a pattern of `p` events as the last durations give it, and how much, s, its limit differs from that of the
    /// durations before.
    #[inline]
    fn candidate(&self, p: usize) -> Option<(GeometricSeries, f64)> {
        if !self.are_alike(0, p) {
            return None;
        }
        let at = [0, 1, 2].map(|k| self.at(k * p));
        let [last, middle] = [0, 1].map(|k| at[k].since(at[k + 1]));
        // The last may be shorter than the resolution of an instant.
        if !(0.0 <= last && last < middle) {
            return None;
        }
        let first = at[2].since(self.at(3 * p));
        if middle >= first {
            return None;
        }
        let (ratio, ratio_before) = (last / middle, middle / first);
        if ratio >= LARGEST_RATIO || ratio_before >= LARGEST_RATIO {
            return None;
        }
        let remaining = last * (ratio / (1.0 - ratio));
        let limit = at[0].plus(remaining);
        let predicted_before = at[1].plus(middle * ratio_before / (1.0 - ratio_before));
        let uncertainty = limit.since(predicted_before).abs();
        let repeats = (1..2 * p).all(|i| self.are_alike(i, i + p));
        let series = GeometricSeries {
            pattern: p,
            ratio,
            ratio_before,
            remaining,
            limit,
        };
        repeats.then_some((series, uncertainty))
    }

    /// Whether what is left of a series moves nothing by more than the tolerances.
    fn is_negligible(&self, series: &GeometricSeries, relative: f64) -> bool {
        // Below one unit in the last place of t the series cannot advance the time any more.
        if series.remaining < series.limit.seconds().abs() * f64::EPSILON {
            return true;
        }
        let p = series.pattern;
        let (now, before) = (self.state(0), self.state(p));
        (0..now.len()).all(|i| {
            let change = (now[i] - before[i]) * series.factor();
            // The largest departure within the pattern is seen between its events: bound it by
            // what the events of the last pattern differ by.
            let spread = (0..p).map(|k| (self.state(k)[i] - now[i]).abs());
            spread.fold(change.abs(), f64::max) <= self.absolute[i] + relative * now[i].abs()
        })
    }

    /// Where a series ends.
    fn end_of(&self, series: &GeometricSeries) -> Limit {
        let p = series.pattern;
        let [now, before, earlier] = [0, p, 2 * p].map(|back| self.state(back));
        let mut state = now.to_vec();
        let mut uncertainty = vec![0.0; now.len()];
        for (i, value) in state.iter_mut().enumerate() {
            let factor_before = series.ratio_before / (1.0 - series.ratio_before);
            let limit_before = before[i] + (before[i] - earlier[i]) * factor_before;
            let left = (now[i] - before[i]) * series.factor();
            *value += left;
            // A component whose limit is not told from zero, by two successive predictions and the
            // rounding of the extrapolation, dies with the pattern.
            let size = now[i].abs() + before[i].abs();
            let rounding = f64::EPSILON * size * (1.0 + series.factor());
            let differs = (*value - limit_before).abs() + rounding;
            uncertainty[i] = left.abs() + differs;
            if value.abs() <= differs {
                *value = 0.0;
            }
        }
        Limit {
            at: series.limit,
            state,
            uncertainty,
            modes: (0..p).map(|back| self.mode(back)).collect(),
        }
    }

    /// Whether the last events have a limit, to the relative accuracy `relative`, before which no time is left: what is
    /// left of the series does not advance the time by one unit in its last place. Then the run can go on in a rest
    /// only.
    #[inline]
    pub fn is_over(&self, relative: f64) -> bool {
        let known = LONGEST_PATTERN.min(self.count.saturating_sub(1) / 3);
        if known == 0 {
            return false;
        }
        self.is_short() && self.has_limit_within(known, relative)
    }

    #[cold]
    fn has_limit_within(&self, known: usize, relative: f64) -> bool {
        let place = self.at(0).seconds().abs() * f64::EPSILON;
        let mut all = (1..=known).filter_map(|p| self.series(p, relative));
        all.any(|series| {
            let steady = (series.ratio - series.ratio_before).abs() <= relative * series.ratio;
            steady && series.remaining < place
        })
    }

    /// Whether the memory is full of events that together do not advance the time by one unit in
    /// its last place, or between which nothing moves by more than rounding; `new`: when the last of them happened,
    /// which was remembered a moment before.
    pub fn stands_still(&self, new: Instant) -> bool {
        self.count >= Self::MEMORY && {
            let old = self.at(Self::MEMORY - 1);
            new.since(old) < new.seconds().abs() * f64::EPSILON || self.still >= Self::MEMORY
        }
    }
}

/// Whether any of some numbers differs from what it was before; `None` where one does by more than the rounding of a guard
/// ([`Accumulation::HARDLY`]).
#[inline(always)]
fn hardly_moved(now: &[f64], before: &[f64]) -> Option<bool> {
    let mut moved = false;
    for (now, before) in now.iter().zip(before) {
        moved |= now != before;
        let hardly = (now - before).abs() <= Accumulation::HARDLY * before.abs();
        if !hardly {
            return None;
        }
    }
    Some(moved)
}

#[cfg(test)]
mod tests;
