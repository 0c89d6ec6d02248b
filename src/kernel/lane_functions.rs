//! Calls into codegen/lanes.c, which is compiled for each level of the processor: what trajectories side by side
//! need besides their model.

use super::lanes::{
    LANE_ROWS, LANES_OF_LEVELS, LaneGuard, LaneLevel, LaneLimits, LanePast, LanePoint, LaneRows,
    LaneSeries, LaneSystem, processor_level,
};
use crate::numerics::{LaneMask, Lanes, ORDERS};
use std::ops::{Deref, DerefMut};

/// What codegen/lanes.c has for every mode, at each level of the processor.
macro_rules! lane_functions {
    ([$($(#[$only:meta])? $level:literal),*] $functions:tt) => {
        lane_functions!(@table $functions);
        /// By level.
        static LANE_FUNCTIONS: &[LaneFunctions] =
            &[$($(#[$only])? lane_functions!(@level $level $functions)),*];
    };
    (@table ($($name:ident($($argument:ty),*) $(-> $result:ty)?;)*)) => {
        pub(super) struct LaneFunctions {
            $(pub(super) $name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }
    };
    (@level $level:literal ($($name:ident($($argument:ty),*) $(-> $result:ty)?;)*)) => {{
        unsafe extern "C" {
            $(
                #[link_name = concat!("dalembert_lane_", stringify!($name), $level)]
                fn $name($(_: $argument),*) $(-> $result)?;
            )*
        }
        LaneFunctions { $($name,)* }
    }};
}

/// A number a lane, or several after each other.
type In = *const f64;
type Out = *mut f64;
/// A bit a lane.
type Bits = u32;
type OutBits = *mut u32;
type Indices = *const usize;

lane_functions!(
    ["_v1", #[cfg(target_arch = "x86_64")] "_v3", #[cfg(target_arch = "x86_64")] "_v4"]
    (
        sin_cos(In, Out, Out);
        sine(In, In, Out);
        sine_series(usize, usize, In, In, In, Out);
        antiderivative(usize, usize, In, In, Out);
        start(usize, In, Out, Out);
        begin(usize, In, Bits, In, Out, Out, Out, Out) -> Bits;
        unmet(usize, In) -> Bits;
        ranges(usize, usize, In, In, In, In, Out, Out);
        signal_radius(usize, usize, In, In, Out);
        length(usize, usize, In, In, In, In, In, In, In, In, Out, OutBits) -> Bits;
        first_crossing(usize, usize, In, In, In, Out, Out, OutBits) -> Bits;
        cross(usize, usize, In, In, In, Bits, In, Out, Out);
        durations(In, In, f64, Out);
        end(usize, usize, In, In, In, In, In, Out);
        crossed(In, In, In) -> Bits;
        take(usize, Bits, In, Out);
        is_apart(usize, usize, usize, Indices, Bits, f64, f64, In, In, In, In, In, OutBits) -> Bits;
        departs(In, In, f64, In, Out) -> Bits;
        leap(usize, usize, usize, Indices, Bits, In, Out, Out);
        note(usize, Bits, In, Out);
        may_exceed(usize, usize, In, In, In, In, In) -> Bits;
    )
);

impl<const W: usize> LaneLevel<W> {
    /// The level of an index into [`LANES_OF_LEVELS`].
    ///
    /// # Panics
    /// If this processor does not have it, or if it does not have `W` lanes: all calls rely on both.
    pub(crate) fn new(index: usize) -> Self {
        Self::on_processor(processor_level(), index)
    }

    /// The same on a processor whose best level is given.
    pub(super) fn on_processor(best: usize, index: usize) -> Self {
        assert!(
            index <= best,
            "the processor has no level {index}, but up to {best}"
        );
        assert_eq!(LANES_OF_LEVELS[index], W, "width of the level");
        LaneLevel {
            index,
            functions: &LANE_FUNCTIONS[index],
        }
    }
}

/// Sines and cosines of lanes (rad), by the bits of [`sin_cos`].
#[inline]
pub(crate) fn lane_sin_cos<const W: usize>(
    level: LaneLevel<W>,
    x: Lanes<W>,
) -> (Lanes<W>, Lanes<W>) {
    let (mut sin, mut cos) = (x, x);
    let (to_sin, to_cos) = ((&raw mut sin).cast(), (&raw mut cos).cast());
    // SAFETY: one number a lane each.
    unsafe { (level.functions.sin_cos)((&raw const x).cast(), to_sin, to_cos) };
    (sin, cos)
}

/// Sines and cosines of eight angles (rad), side by side in lanes of this processor.
pub(crate) fn sin_cos_of_eight(x: &[f64; 8]) -> [[f64; 8]; 2] {
    fn in_lanes<const W: usize>(level: usize, x: &[f64; 8]) -> [[f64; 8]; 2] {
        let level = LaneLevel::new(level);
        let [mut sines, mut cosines] = [[0.0; 8]; 2];
        for from in (0..8).step_by(W) {
            let (sin, cos) = lane_sin_cos(level, Lanes::<W>::from_fn(|lane| x[from + lane]));
            sines[from..from + W].copy_from_slice(&sin.0);
            cosines[from..from + W].copy_from_slice(&cos.0);
        }
        [sines, cosines]
    }
    let level = processor_level();
    match LANES_OF_LEVELS[level] {
        8 => in_lanes::<8>(level, x),
        4 => in_lanes::<4>(level, x),
        _ => in_lanes::<2>(level, x),
    }
}

/// Rate, value, integral and double integral of the sine of each lane at its time (s), on the right of it; the numbers
/// of a sine are those of [`crate::input::Sine`].
#[inline]
pub(crate) fn lane_sine<const W: usize>(
    level: LaneLevel<W>,
    sine: &[Lanes<W>; 8],
    t: &Lanes<W>,
    jet: &mut [Lanes<W>; 4],
) {
    let (t, jet) = ((&raw const *t).cast(), jet.as_mut_ptr().cast());
    // SAFETY: eight numbers a lane, one, four.
    unsafe { (level.functions.sine)(sine.as_ptr().cast(), t, jet) };
}

/// Rows of the Taylor coefficients of a sine into every `stride`-th of `rows`, given its jet. Each is the
/// last but one times the factor and its inverse.
#[inline]
pub(crate) fn lane_sine_series<const W: usize>(
    level: LaneLevel<W>,
    (factor, inverses): (&Lanes<W>, &[f64]),
    jet: &[Lanes<W>; 4],
    stride: usize,
    rows: &mut [Lanes<W>],
) {
    let count = rows.len().div_ceil(stride);
    assert!(inverses.len() >= count);
    let (row, jet) = (rows.as_mut_ptr().cast(), jet.as_ptr().cast());
    let factor = (&raw const *factor).cast();
    let series = level.functions.sine_series;
    // SAFETY: the last of the rows is (count − 1) · stride < their number; inverses are as many.
    unsafe { series(count, stride, factor, inverses.as_ptr(), jet, row) };
}

/// Rows of the Taylor coefficients of an antiderivative into every `stride`-th of `rows` from the second
/// on, given its value; the entries before are those of its derivative. `inverses`: 1/k.
#[inline]
pub(crate) fn lane_antiderivative<const W: usize>(
    level: LaneLevel<W>,
    inverses: &[f64],
    value: &Lanes<W>,
    rows: &mut [Lanes<W>],
    stride: usize,
) {
    let own = &mut rows[1..];
    let count = own.len().div_ceil(stride);
    assert!(inverses.len() >= count);
    let (row, value) = (own.as_mut_ptr().cast(), (&raw const *value).cast());
    let antiderivative = level.functions.antiderivative;
    // SAFETY: the last of the rows is (count − 1) · stride < their number, and one entry is before each;
    // the inverses are as many.
    unsafe { antiderivative(count, stride, inverses.as_ptr(), value, row) };
}

/// Sets coordinates and velocities at the start of a step, the first rows of their series.
#[inline]
pub(crate) fn lane_start<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    point: &LanePoint<F, W>,
    series: &mut LaneSeries<F, W>,
) {
    let [q, v] = [&mut series.q, &mut series.v].map(|rows| rows.as_mut_ptr().cast());
    // SAFETY: a point of F coordinates, and rows of as many.
    unsafe { (level.functions.start)(F, (&raw const *point).cast(), q, v) };
}

/// Inverts the mass matrices, sets the accelerations (those of `point` where a segment starts) and the
/// rows of the series that follow from them. Gives the inverses, and the lanes that have no positive
/// pivots.
#[inline]
pub(crate) fn lane_begin<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    point: &LanePoint<F, W>,
    at_start: LaneMask,
    system: &LaneSystem<F, W>,
    series: &mut LaneSeries<F, W>,
    inverse: &mut [[Lanes<W>; F]; F],
) -> LaneMask {
    let [q, v, a] =
        [&mut series.q, &mut series.v, &mut series.a].map(|rows| rows.as_mut_ptr().cast());
    let begin = level.functions.begin;
    // SAFETY: a point and a system of F coordinates, room for F × F numbers, three rows of each series.
    LaneMask(unsafe {
        begin(
            F,
            (&raw const *point).cast(),
            at_start.0,
            (&raw const *system).cast(),
            inverse.as_mut_ptr().cast(),
            q,
            v,
            a,
        )
    })
}

/// The lanes in which not all of some numbers are positive.
#[inline]
pub(crate) fn lane_unmet<const W: usize>(level: LaneLevel<W>, numbers: &[Lanes<W>]) -> LaneMask {
    let unmet = level.functions.unmet;
    // SAFETY: as many numbers a lane.
    LaneMask(unsafe { unmet(numbers.len(), numbers.as_ptr().cast()) })
}

/// The length at which the last terms of a series equal the tolerance, as it fits into what remains up
/// to the times `last` and not more than `horizon`. Gives the lanes in which it reaches `last`; marks
/// those that are `unclear`, as their series is not finite or their time does not advance.
#[inline]
pub(crate) fn lane_length<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    (limits, tolerances): (&LaneLimits, &[Lanes<W>]),
    series: &LaneSeries<F, W>,
    point: &LanePoint<F, W>,
    [last, horizon]: [&Lanes<W>; 2],
    (h, unclear): (&mut Lanes<W>, &mut LaneMask),
) -> LaneMask {
    let p = limits.order;
    assert!(p >= 5 && p + 2 <= ORDERS && tolerances.len() == 1 + 2 * F);
    let [q, v, a] = [&series.q, &series.v, &series.a].map(|rows| rows.as_ptr().cast());
    let length = level.functions.length;
    // SAFETY: rows up to p + 1 are there, and the tolerances; the rest is one number a lane each.
    LaneMask(unsafe {
        length(
            F,
            p,
            q,
            v,
            a,
            tolerances.as_ptr().cast(),
            limits.terms.as_ptr().cast(),
            (&raw const *point).cast(),
            (&raw const *last).cast(),
            (&raw const *horizon).cast(),
            (&raw mut *h).cast(),
            &mut unclear.0,
        )
    })
}

/// Looks for the first fall of a guard, factor · Σ rows[k · `stride` + i] τᵏ + offset over `count` rows, on 0 < τ ≤ h. Where it is
/// before `place`, a part of h, that becomes it. `coefficients` get those in powers of τ/h. Gives the
/// lanes with such a fall, and those where it takes a closer look.
#[inline]
pub(crate) fn lane_first_crossing<const W: usize>(
    level: LaneLevel<W>,
    (rows, count): (&[Lanes<W>], usize),
    (stride, i): (usize, usize),
    h: &Lanes<W>,
    guard: &LaneGuard<W>,
    coefficients: &mut [Lanes<W>; ORDERS],
    place: &mut Lanes<W>,
) -> [LaneMask; 2] {
    assert!(i < stride && (2..=ORDERS).contains(&count) && rows.len() >= count * stride);
    let mut unclear = 0;
    let row = rows[i..].as_ptr().cast();
    let first_crossing = level.functions.first_crossing;
    // SAFETY: as many rows of so many entries are there, of which entry i is read, and room for all
    // coefficients; the rest is one number a lane each, and a guard.
    let first = unsafe {
        first_crossing(
            count,
            stride,
            row,
            (&raw const *h).cast(),
            (&raw const *guard).cast(),
            coefficients.as_mut_ptr().cast(),
            (&raw mut *place).cast(),
            &mut unclear,
        )
    };
    [LaneMask(first), LaneMask(unclear)]
}

/// Moves `tau` (s) of some lanes on until the guard factor · Σ `rows[k][i]` τᵏ + offset, of `count` rows, is
/// negative there: by `more`, twice as much each time, but not beyond `most`. `lost` is what rounding has lost of the first
/// row.
#[inline]
pub(crate) fn lane_cross<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    (rows, i): (&[[Lanes<W>; F]; LANE_ROWS], usize),
    count: usize,
    lost: &Lanes<W>,
    guard: &LaneGuard<W>,
    lanes: LaneMask,
    [tau, more, most]: &mut [Lanes<W>; 3],
) {
    assert!(i < F && (1..=ORDERS).contains(&count));
    let row = rows.as_flattened()[i..].as_ptr().cast();
    let lost = (&raw const *lost).cast();
    let [tau, more, most] = [tau, more, most].map(|x| (&raw mut *x).cast());
    let guard = (&raw const *guard).cast();
    let cross = level.functions.cross;
    // SAFETY: rows 1 … ORDERS are there, up to which a sum of `count` − 1 is filled up; the rest is one number
    // a lane each, and a guard.
    unsafe { cross(count, F, row, lost, guard, lanes.0, most, more, tau) };
}

/// Durations of steps of length `h` (s) up to the parts `places` of them, all of them where these are more than
/// one; the rounding of that; and the part `farthest` of `h`.
#[inline]
pub(crate) fn lane_durations<const W: usize>(
    level: LaneLevel<W>,
    h: &Lanes<W>,
    places: &Lanes<W>,
    farthest: f64,
    durations: &mut [Lanes<W>; 3],
) {
    let (h, places) = ((&raw const *h).cast(), (&raw const *places).cast());
    let durations = durations.as_mut_ptr().cast();
    // SAFETY: one number a lane each, and room for three.
    unsafe { (level.functions.durations)(h, places, farthest, durations) };
}

/// The lanes in which the value of a guard is negative after `tau`, which is not more than `h` (s).
#[inline]
pub(crate) fn lane_crossed<const W: usize>(
    level: LaneLevel<W>,
    [value, tau, h]: [&Lanes<W>; 3],
) -> LaneMask {
    let [value, tau, h] = [value, tau, h].map(|x| (&raw const *x).cast());
    // SAFETY: one number a lane each.
    LaneMask(unsafe { (level.functions.crossed)(value, tau, h) })
}

/// The points to which series of order `p` lead from a point in the durations `tau` (s).
#[inline]
pub(crate) fn lane_end<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    p: usize,
    series: &LaneSeries<F, W>,
    point: &LanePoint<F, W>,
    tau: &Lanes<W>,
    to: &mut LanePoint<F, W>,
) {
    assert!(p + 2 <= ORDERS);
    let [q, v, a] = [&series.q, &series.v, &series.a].map(|rows| rows.as_ptr().cast());
    let (point, tau) = ((&raw const *point).cast(), (&raw const *tau).cast());
    let end = level.functions.end;
    // SAFETY: rows 1 … ORDERS are there, up to which a sum of p + 1 rows is filled up; the points are
    // those of F coordinates.
    unsafe { end(F, p, q, v, a, point, tau, (&raw mut *to).cast()) };
}

impl<const F: usize, const W: usize> LanePoint<F, W> {
    /// Takes over those of some lanes.
    #[inline]
    pub(crate) fn take(&mut self, level: LaneLevel<W>, lanes: LaneMask, from: &Self) {
        let (from, to) = ((&raw const *from).cast(), (&raw mut *self).cast());
        // SAFETY: a point has as many numbers a lane, one after the other.
        unsafe { (level.functions.take)(5 * F + 2, lanes.0, from, to) };
    }
}

impl<const W: usize> LaneGuard<W> {
    /// Takes over those of some lanes.
    #[inline]
    pub(crate) fn take(&mut self, level: LaneLevel<W>, lanes: LaneMask, from: &Self) {
        let zero = &mut self.starts_at_zero;
        *zero = *zero & !lanes | from.starts_at_zero & lanes;
        let (from, to) = ((&raw const *from).cast(), (&raw mut *self).cast());
        // SAFETY: a guard begins with two numbers a lane.
        unsafe { (level.functions.take)(2, lanes.0, from, to) };
    }
}

/// Takes over numbers of some lanes.
///
/// # Panics
/// If they are not as many.
#[inline]
pub(crate) fn lane_take<const W: usize>(
    level: LaneLevel<W>,
    lanes: LaneMask,
    from: &[Lanes<W>],
    to: &mut [Lanes<W>],
) {
    assert_eq!(from.len(), to.len());
    let count = from.len();
    let (from, to) = (from.as_ptr().cast(), to.as_mut_ptr().cast());
    // SAFETY: the length was checked.
    unsafe { (level.functions.take)(count, lanes.0, from, to) };
}

/// The lanes in which an event, with the states before and after it, is before `last` (s) and certainly ends
/// neither a standstill nor an accumulation as short as its rounding; and those in which it may end another
/// accumulation.
#[inline]
pub(crate) fn lane_is_apart<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    past: &LanePast<F, W>,
    point: &LanePoint<F, W>,
    reset: &[Lanes<W>],
    last: &Lanes<W>,
) -> [LaneMask; 2] {
    let discretes = past.check(reset);
    let is_apart = level.functions.is_apart;
    let mut may_rest = 0;
    // SAFETY: all lengths and indices were checked; the rest is a point and one number a lane.
    let apart = unsafe {
        is_apart(
            F,
            past.coordinates,
            discretes,
            past.free.as_ptr(),
            u32::from(past.may_rest),
            past.hardly,
            past.shortest,
            past.tolerances.as_ptr().cast(),
            (&raw const *point).cast(),
            reset.as_ptr().cast(),
            past.after.as_ptr().cast(),
            (&raw const *last).cast(),
            &mut may_rest,
        )
    };
    [LaneMask(apart), LaneMask(may_rest)]
}

/// Goes on in some lanes from the state that a reset gives, and remembers it.
#[inline]
pub(crate) fn lane_leap<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    lanes: LaneMask,
    reset: &[Lanes<W>],
    point: &mut LanePoint<F, W>,
    past: &mut LanePast<F, W>,
) {
    let discretes = past.check(reset);
    let leap = level.functions.leap;
    // SAFETY: all lengths and indices were checked; the rest is a point.
    unsafe {
        leap(
            F,
            past.coordinates,
            discretes,
            past.free.as_ptr(),
            lanes.0,
            reset.as_ptr().cast(),
            (&raw mut *point).cast(),
            past.after.as_mut_ptr().cast(),
        )
    };
}

/// Has extremes in some lanes take note of a point: of each free coordinate, then of each velocity, four rows: the least
/// value, the greatest one, and when (s) they were first taken.
#[inline]
pub(crate) fn lane_note<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    lanes: LaneMask,
    point: &LanePoint<F, W>,
    extremes: &mut [Lanes<W>],
) {
    assert_eq!(extremes.len(), 8 * F);
    let note = level.functions.note;
    // SAFETY: a point of F coordinates, and four numbers a lane of each of its 2 F values.
    unsafe {
        note(
            F,
            lanes.0,
            (&raw const *point).cast(),
            extremes.as_mut_ptr().cast(),
        )
    }
}

/// The lanes in which a coordinate or a velocity may be beyond its extremes (see [`lane_note`]) inside of a step of duration
/// `tau`, s, by a series of order p.
#[inline]
pub(crate) fn lane_may_exceed<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    p: usize,
    series: &LaneSeries<F, W>,
    tau: &Lanes<W>,
    extremes: &[Lanes<W>],
) -> LaneMask {
    assert!(p >= 1 && p + 2 <= ORDERS && extremes.len() == 8 * F);
    let [q, v, a] = [&series.q, &series.v, &series.a].map(|rows| rows.as_ptr().cast());
    let may_exceed = level.functions.may_exceed;
    // SAFETY: rows up to p + 1 are there, and four numbers a lane of each of 2 F values.
    LaneMask(unsafe {
        may_exceed(
            F,
            p,
            q,
            v,
            a,
            (&raw const *tau).cast(),
            extremes.as_ptr().cast(),
        )
    })
}

impl<const F: usize, const W: usize> LanePast<F, W> {
    /// Number of discrete states in a reset.
    ///
    /// # Panics
    /// If a length or an index does not fit the others.
    #[inline]
    fn check(&self, reset: &[Lanes<W>]) -> usize {
        let coordinates = self.coordinates;
        let discretes = (reset.len().checked_sub(2 * coordinates)).expect("a reset of the model");
        assert!(self.free.len() == F && self.free.iter().all(|&i| i < coordinates));
        assert_eq!(self.after.len(), 2 * F + 1 + discretes);
        assert_eq!(self.tolerances.len(), 1 + 2 * F);
        discretes
    }
}

/// Sets a guard to `factor` · discrete state, if it has one, times a coordinate or rate `x`, plus the offset
/// that it has, at the start of a step. Gives the lanes in which it is positive, or zero and rises with the
/// `rate` of the coordinate.
#[inline]
pub(crate) fn lane_departs<const W: usize>(
    level: LaneLevel<W>,
    (x, rate): (&Lanes<W>, Option<&Lanes<W>>),
    factor: f64,
    discrete: Option<&Lanes<W>>,
    guard: &mut LaneGuard<W>,
) -> LaneMask {
    let pointer = |x: Option<&Lanes<W>>| x.map_or(std::ptr::null(), |x| (&raw const *x).cast());
    let (x, rate, discrete) = (pointer(Some(x)), pointer(rate), pointer(discrete));
    let departs = level.functions.departs;
    // SAFETY: one number a lane each, where it is given, and a guard.
    LaneMask(unsafe { departs(x, rate, factor, discrete, (&raw mut *guard).cast()) })
}

impl<const W: usize> Deref for LaneRows<W> {
    type Target = [Lanes<W>];
    #[inline]
    fn deref(&self) -> &[Lanes<W>] {
        // SAFETY: a block is nothing but numbers a lane, without gaps, which `zeros` checks when it is compiled.
        // Since they were made there are blocks for so many.
        unsafe { std::slice::from_raw_parts(self.blocks.as_ptr().cast(), self.count) }
    }
}

impl<const W: usize> DerefMut for LaneRows<W> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [Lanes<W>] {
        // SAFETY: as in `deref`.
        unsafe { std::slice::from_raw_parts_mut(self.blocks.as_mut_ptr().cast(), self.count) }
    }
}
