//! Calls into the generated C: the only unsafe code of the crate.
//!
//! Every generated function has the signature `Raw`. Safety rests on two facts, both checked
//! here: each output has the length that the generated tables state (the typed wrappers below fix
//! it), and each [`Context`] was made for the model whose functions it is passed to. Guards and
//! transitions, which are passed to a kernel, name their model themselves: that is the one checked.
//!
//! What is for lanes is for the crate alone, since it relies on the level of the processor:
//!
//! ```compile_fail
//! use dalembert::kernel::LaneLevel;
//! ```

mod context;
mod contract;
mod description;
mod few;
mod lanes;
mod load;
mod reader;
mod tables;
#[cfg(test)]
mod tests;

pub use context::Context;
pub(crate) use context::Dimensions;
use context::{Arrays, KeptAngle};
pub use contract::{CONTRACT_VERSION, ContractError, RawFunctions, RawModel};
pub(crate) use few::{copy_few, swap_few};
pub(crate) use lanes::{
    LANE_ROWS, LaneContext, LaneGuard, LaneLevel, LaneLimits, LanePast, LanePoint, LaneRows,
    LaneSeries, LaneSystem,
};
pub use lanes::{LANES_OF_LEVELS, processor_level};
pub use load::Library;
pub(crate) use load::{linked, linked_models, name_of_linked};
pub use tables::{
    ConstantsKernel, Free, GuardKernel, LinearSystem, MOST_FREE, ModeKernel, ModeKernels,
    TransitionKernel, with_kernel,
};

use crate::integrate::{LaneMask, Lanes, ORDERS, Series};
use nalgebra::{SMatrix, SVector};
use std::ops::{Deref, DerefMut};
use std::ptr::NonNull;
use std::sync::Arc;

/// Context of a call, as C sees it: signals, their rates, discrete states, held coordinates,
/// constants, jerks.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct RawContext {
    u: *const f64,
    u_dot: *const f64,
    d: *const f64,
    h: *const f64,
    c: *const f64,
    j: *const f64,
    angles: *mut KeptAngle,
}

// SAFETY: it is what arrays that may be sent to another thread look like to C, and goes with them.
unsafe impl Send for RawContext {}

/// Numbers at an address that stays as long as they are there, so that it can be told to C once.
#[derive(Debug)]
struct Array<T>(NonNull<[T]>);

// SAFETY: it owns its numbers as a box does.
unsafe impl<T: Send> Send for Array<T> {}

impl<T> Array<T> {
    fn of(numbers: Vec<T>) -> Self {
        Array(NonNull::from(Box::leak(numbers.into_boxed_slice())))
    }

    fn pointer(&self) -> *mut T {
        self.0.as_ptr().cast()
    }
}

impl<T> Deref for Array<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        // SAFETY: the numbers are there until it is dropped, and borrowed as it is.
        unsafe { self.0.as_ref() }
    }
}

impl<T> DerefMut for Array<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: as in `deref`.
        unsafe { self.0.as_mut() }
    }
}

impl<T: Clone> Clone for Array<T> {
    fn clone(&self) -> Self {
        Array::of(self.to_vec())
    }
}

impl<T> Drop for Array<T> {
    fn drop(&mut self) {
        // SAFETY: they were a box, and nobody else has taken them back.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) })
    }
}

impl Arrays {
    /// The arrays as C sees them, as long as they are there.
    fn raw(&self) -> RawContext {
        RawContext {
            u: self.signals.pointer(),
            u_dot: self.signal_rates.pointer(),
            d: self.discrete.pointer(),
            h: self.held.pointer(),
            c: self.constants.pointer(),
            // Only the rate of a guard reads jerks.
            j: std::ptr::null(),
            angles: self.angles.pointer().cast(),
        }
    }
}

/// A generated C function.
type Raw = unsafe extern "C" fn(*const f64, *const f64, *const f64, *const RawContext, *mut f64);

/// Generated C functions that expand the motion in time: coefficients of order 0, and of the orders
/// 1 … n − 1. The arrays q, v, a and u hold one row an order.
type RawStart = unsafe extern "C" fn(
    *mut f64,
    *mut f64,
    *mut f64,
    *const f64,
    *const RawContext,
    *mut f64,
    *mut f64,
);
type RawRun = unsafe extern "C" fn(
    usize,
    *mut f64,
    *mut f64,
    *mut f64,
    *const f64,
    *const RawContext,
    *mut f64,
    *mut f64,
);

/// Sine and cosine, as C returns them.
#[repr(C)]
struct SinCos {
    sin: f64,
    cos: f64,
}

unsafe extern "C" {
    /// Takes every number.
    safe fn dalembert_sin_cos(x: f64) -> SinCos;

    /// Takes `n` factors, `n` rows of `n` entries, and room for `n` sums.
    fn dalembert_triangular_sums(n: usize, factors: *const f64, table: *const f64, out: *mut f64);

    /// Takes so many coefficients a row of q, v and a, of which so many rows are read, filled up to fours and to
    /// eight; a time; and room for three times as many middles and radii.
    fn dalembert_ranges(
        free: usize,
        rows: usize,
        q: *const f64,
        v: *const f64,
        a: *const f64,
        tau: f64,
        middles: *mut f64,
        radii: *mut f64,
    );
}

/// What codegen/lanes.c has for every mode, at each level of the processor.
macro_rules! lane_functions {
    ([$($(#[$only:meta])? $level:literal),*] $functions:tt) => {
        lane_functions!(@table $functions);
        /// By level.
        static LANE_FUNCTIONS: &[LaneFunctions] =
            &[$($(#[$only])? lane_functions!(@level $level $functions)),*];
    };
    (@table ($($name:ident($($argument:ty),*) $(-> $result:ty)?;)*)) => {
        struct LaneFunctions {
            $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
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
        sine_series(usize, usize, f64, In, In, Out);
        antiderivative(usize, usize, In, In, Out);
        start(usize, In, Out, Out);
        begin(usize, In, Bits, In, Out, Out, Out, Out) -> Bits;
        unmet(usize, In) -> Bits;
        ranges(usize, usize, In, In, In, In, Out, Out);
        signal_radius(usize, usize, In, In, Out);
        length(usize, usize, In, In, In, In, In, In, In, In, Out, OutBits) -> Bits;
        first_fall(usize, usize, In, In, In, Out, Out, OutBits) -> Bits;
        cross(usize, usize, In, In, In, Bits, In, Out, Out);
        durations(In, In, f64, Out);
        end(usize, usize, In, In, In, In, In, Out);
        crossed(In, In, In) -> Bits;
        take(usize, Bits, In, Out);
        is_apart(usize, usize, usize, Indices, Bits, f64, f64, In, In, In, In, In, OutBits) -> Bits;
        departs(In, In, f64, In, Out) -> Bits;
        leap(usize, usize, usize, Indices, Bits, In, Out, Out);
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

/// Rate, value, integral and double integral of a sine at times of lanes (s), on their right; the numbers
/// of a sine are those of [`crate::input::Sine`].
#[inline]
pub(crate) fn lane_sine<const W: usize>(
    level: LaneLevel<W>,
    sine: &[f64; 8],
    t: &Lanes<W>,
    jet: &mut [Lanes<W>; 4],
) {
    let (t, jet) = ((&raw const *t).cast(), jet.as_mut_ptr().cast());
    // SAFETY: eight numbers, one number a lane, four a lane.
    unsafe { (level.functions.sine)(sine.as_ptr(), t, jet) };
}

/// Rows of the Taylor coefficients of a sine into every `stride`-th of `rows`, given its jet. Each is the
/// last but one times the factor and its inverse.
#[inline]
pub(crate) fn lane_sine_series<const W: usize>(
    level: LaneLevel<W>,
    (factor, inverses): (f64, &[f64]),
    jet: &[Lanes<W>; 4],
    stride: usize,
    rows: &mut [Lanes<W>],
) {
    let count = rows.len().div_ceil(stride);
    assert!(inverses.len() >= count);
    let (row, jet) = (rows.as_mut_ptr().cast(), jet.as_ptr().cast());
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
    limits: &LaneLimits,
    series: &LaneSeries<F, W>,
    point: &LanePoint<F, W>,
    [last, horizon]: [&Lanes<W>; 2],
    (h, unclear): (&mut Lanes<W>, &mut LaneMask),
) -> LaneMask {
    let p = limits.order;
    assert!(p >= 5 && p + 2 <= ORDERS && limits.tolerances.len() == 1 + 2 * F);
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
            limits.tolerances.as_ptr(),
            limits.terms.as_ptr().cast(),
            (&raw const *point).cast(),
            (&raw const *last).cast(),
            (&raw const *horizon).cast(),
            (&raw mut *h).cast(),
            &mut unclear.0,
        )
    })
}

/// Looks for the first fall of a guard, factor · Σ `rows[k][i]` τᵏ + offset, on 0 < τ ≤ h. Where it is
/// before `place`, a part of h, that becomes it. `coefficients` get those in powers of τ/h. Gives the
/// lanes with such a fall, and those where it takes a closer look.
#[inline]
pub(crate) fn lane_first_fall<const F: usize, const W: usize>(
    level: LaneLevel<W>,
    (rows, i): (&[[Lanes<W>; F]], usize),
    h: &Lanes<W>,
    guard: &LaneGuard<W>,
    coefficients: &mut [Lanes<W>; ORDERS],
    place: &mut Lanes<W>,
) -> [LaneMask; 2] {
    assert!(i < F && (2..=ORDERS).contains(&rows.len()));
    let mut unclear = 0;
    let row = rows.as_flattened()[i..].as_ptr().cast();
    let first_fall = level.functions.first_fall;
    // SAFETY: as many rows of F entries are there, of which entry i is read, and room for all
    // coefficients; the rest is one number a lane each, and a guard.
    let first = unsafe {
        first_fall(
            rows.len(),
            F,
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
            past.tolerances.as_ptr(),
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

/// Sine and cosine of `x` (rad), by the same function as in generated code: by the same bits on every
/// processor, to less than one unit in the last place. NaN if `x` is not finite.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    let SinCos { sin, cos } = dalembert_sin_cos(x);
    (sin, cos)
}

/// Sums Σ_{k ≤ j} `factors[k]` · `table[k][j]`, by the same bits on every processor (codegen/sums.c). Below its
/// diagonal, for j < k, the table must be zero.
#[inline]
pub fn triangular_sums<const N: usize>(
    factors: &[f64; N],
    table: &[[f64; N]; N],
    sums: &mut [f64; N],
) {
    let table = table.as_ptr().cast();
    // SAFETY: all have the length N, the rows follow each other.
    unsafe { dalembert_triangular_sums(N, factors.as_ptr(), table, sums.as_mut_ptr()) }
}

impl Context {
    /// Calls a generated function.
    ///
    /// # Safety
    /// `q`, `v`, `a` must have the length of the function's free coordinates (where it reads them), it must
    /// not read jerks, and `out` must have room for its outputs.
    #[inline(always)]
    unsafe fn call(
        &self,
        function: Raw,
        dimensions: &Arc<Dimensions>,
        [q, v, a]: [*const f64; 3],
        out: *mut f64,
    ) {
        // SAFETY: the context is of the function's model, the rest is the caller's.
        unsafe { function(q, v, a, self.raw(dimensions), out) }
    }

    /// The context as C sees it.
    ///
    /// # Panics
    /// If it was made for another model. Its arrays have their lengths since it was made.
    #[inline(always)]
    fn raw(&self, dimensions: &Arc<Dimensions>) -> &RawContext {
        assert!(
            Arc::ptr_eq(&self.dimensions, dimensions),
            "a context is used with the functions of the model it was made for"
        );
        &self.raw
    }
}

impl ConstantsKernel {
    /// Values at the parameters of a model, in its order.
    ///
    /// # Panics
    /// If the number of parameters is not the model's, or `out` has not one entry a value.
    pub fn evaluate(&self, parameters: &[f64], out: &mut [f64]) {
        assert_eq!(
            parameters.len(),
            self.dimensions.parameters,
            "number of parameters"
        );
        assert_eq!(out.len(), self.count);
        let mut angles = vec![KeptAngle::ZERO; self.dimensions.angles];
        let raw = RawContext {
            u: std::ptr::null(),
            u_dot: std::ptr::null(),
            d: std::ptr::null(),
            h: std::ptr::null(),
            c: std::ptr::null(),
            j: std::ptr::null(),
            angles: angles.as_mut_ptr(),
        };
        let none = std::ptr::null();
        // SAFETY: the function reads `parameters` only and writes `count` outputs.
        unsafe { (self.function)(parameters.as_ptr(), none, none, &raw, out.as_mut_ptr()) }
    }
}

impl<const F: usize> Free<'_, F> {
    #[inline(always)]
    fn pointers(&self) -> [*const f64; 3] {
        [self.q.as_ptr(), self.v.as_ptr(), self.a.as_ptr()]
    }
}

impl<const F: usize> ModeKernel<F> {
    /// r(q, v, a, u): generalized forces that are missing for equilibrium, one a free coordinate.
    #[inline]
    pub fn residual(&self, x: &Context, at: Free<F>, r: &mut SVector<f64, F>) {
        // SAFETY: F outputs.
        unsafe {
            x.call(
                self.residual,
                &self.dimensions,
                at.pointers(),
                r.as_mut_ptr(),
            )
        }
    }

    /// [∂r/∂a, ∂r/∂v, ∂r/∂q].
    #[inline]
    pub fn jacobian(&self, x: &Context, at: Free<F>, out: &mut [SMatrix<f64, F, F>; 3]) {
        // SAFETY: three dense column-major F × F outputs, contiguous in the array.
        unsafe {
            x.call(
                self.jacobian,
                &self.dimensions,
                at.pointers(),
                out.as_mut_ptr().cast(),
            )
        }
    }

    /// Mass matrix and load at (q, v).
    #[inline]
    pub fn system(&self, x: &Context, q: &SVector<f64, F>, v: &SVector<f64, F>) -> LinearSystem<F> {
        let mut out = LinearSystem {
            mass: SMatrix::zeros(),
            load: SVector::zeros(),
        };
        if F > 0 {
            let at = [q.as_ptr(), v.as_ptr(), v.as_ptr()];
            // SAFETY: F × F and F outputs, contiguous in a repr(C) struct; `a` is not read.
            unsafe { x.call(self.system, &self.dimensions, at, (&raw mut out).cast()) }
        }
        out
    }

    /// Fills `Context::guard_series` with the Taylor coefficients of all guards, one row an order,
    /// along a motion that is known to that order; false if an operation of theirs has no
    /// recurrence.
    ///
    /// # Panics
    /// If `orders` is more than [`ORDERS`].
    pub fn guard_series(&self, x: &mut Context, orders: usize, at: &Series<F>) -> bool {
        let Some(series) = &self.guard_series else {
            return false;
        };
        assert!(orders <= ORDERS);
        let [q, v, a] = [&at.q, &at.v, &at.a].map(|rows| rows.as_ptr().cast::<f64>().cast_mut());
        let (u, w) = (x.signal_series.as_ptr(), x.workspace.as_mut_ptr().cast());
        let out = x.guard_series.as_mut_ptr();
        let raw = x.raw(&self.dimensions);
        // SAFETY: F entries a row of q, v and a, which are only read, and all rows are there; one
        // output a guard and order; guard series and workspace have room for every mode of the model.
        unsafe {
            (series.start)(q, v, a, u, raw, w, out);
            (series.run)(orders, q, v, a, u, raw, w, out);
        }
        true
    }

    /// Begins a Taylor series: mass matrix and load at order 0 of q and v.
    ///
    /// # Panics
    /// If the mode is not analytic.
    #[inline]
    pub fn series_start(&self, x: &mut Context, at: &Series<F>) -> LinearSystem<F> {
        let mut out = LinearSystem {
            mass: SMatrix::zeros(),
            load: SVector::zeros(),
        };
        if F == 0 {
            return out;
        }
        let series = self.motion_series(x).expect("the mode is analytic");
        let [q, v, a] = [&at.q, &at.v, &at.a].map(|rows| rows.as_ptr().cast::<f64>().cast_mut());
        let (u, w) = (x.signal_series.as_ptr(), x.workspace.as_mut_ptr().cast());
        let raw = x.raw(&self.dimensions);
        // SAFETY: F entries a row, which are only read; F × F and F outputs, contiguous in a repr(C)
        // struct; the workspace has room for every mode of the model.
        unsafe { (series.start)(q, v, a, u, raw, w, (&raw mut out).cast()) }
        out
    }

    /// Goes on to the first `n` accelerations of the series begun by [`Self::series_start`], for the
    /// same context: a_k with v_{k+1} and q_{k+2} for k < n. The inverse of M_0 is given, and a_0, v_1,
    /// q_1 and q_2 are.
    ///
    /// # Panics
    /// If the mode is not analytic, or `n` is more than [`ORDERS`] − 2.
    #[inline]
    pub fn series_run(
        &self,
        x: &mut Context,
        n: usize,
        inverse: &SMatrix<f64, F, F>,
        at: &mut Series<F>,
    ) {
        if F == 0 {
            return;
        }
        let series = self.motion_series(x).expect("the mode is analytic");
        assert!(n <= ORDERS - 2);
        let [q, v, a] = [&mut at.q, &mut at.v, &mut at.a].map(|rows| rows.as_mut_ptr().cast());
        let (u, w) = (x.signal_series.as_ptr(), x.workspace.as_mut_ptr().cast());
        let inverse = inverse.as_ptr().cast_mut();
        let raw = x.raw(&self.dimensions);
        // SAFETY: F entries a row of q, v and a, and n + 2 rows are there; the F × F entries of the
        // inverse are only read; the workspace has room for every mode of the model.
        unsafe { (series.run)(n, q, v, a, u, raw, w, inverse) }
    }

    /// Mass matrix without friction: ∂²T/∂v² on the free coordinates.
    pub fn inertia(
        &self,
        x: &Context,
        q: &SVector<f64, F>,
        v: &SVector<f64, F>,
    ) -> SMatrix<f64, F, F> {
        let mut out = SMatrix::<f64, F, F>::zeros();
        let at = [q.as_ptr(), v.as_ptr(), v.as_ptr()];
        // SAFETY: F × F outputs; `a` is not read.
        unsafe { x.call(self.inertia, &self.dimensions, at, out.as_mut_ptr()) }
        out
    }

    /// b with M j + b = 0 for the jerk j; needs the signals to be set.
    pub fn jerk_load(&self, x: &Context, at: Free<F>) -> SVector<f64, F> {
        // SAFETY: F outputs.
        unsafe { self.one_a_coordinate(self.jerk_load, x, at) }
    }

    /// Number of terms × sum of their magnitudes, per equation: times machine epsilon a bound of
    /// the rounding error of the residual.
    pub fn magnitude(&self, x: &Context, at: Free<F>) -> SVector<f64, F> {
        // SAFETY: F outputs.
        unsafe { self.one_a_coordinate(self.magnitude, x, at) }
    }

    /// What a function of the mode gives, one number a free coordinate.
    ///
    /// # Safety
    /// The function must have F outputs.
    unsafe fn one_a_coordinate(&self, function: Raw, x: &Context, at: Free<F>) -> SVector<f64, F> {
        let mut out = SVector::<f64, F>::zeros();
        if F > 0 {
            // SAFETY: as the caller promises.
            unsafe { x.call(function, &self.dimensions, at.pointers(), out.as_mut_ptr()) }
        }
        out
    }

    /// Reactions of all coordinates (0 where free), then of the ground motions.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate and motion.
    #[inline]
    pub fn reactions(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        assert_eq!(
            out.len(),
            self.dimensions.coordinates + self.dimensions.motions
        );
        // SAFETY: the length was checked.
        unsafe {
            x.call(
                self.reactions,
                &self.dimensions,
                at.pointers(),
                out.as_mut_ptr(),
            )
        }
    }

    /// [kinetic, potential] energy, J, in the inertial frame.
    pub fn energies(&self, x: &Context, at: Free<F>) -> [f64; 2] {
        let mut out = [0.0; 2];
        // SAFETY: two outputs.
        unsafe {
            x.call(
                self.energies,
                &self.dimensions,
                at.pointers(),
                out.as_mut_ptr(),
            )
        }
        out
    }

    /// [dissipated, input] power, W.
    #[inline]
    pub fn powers(&self, x: &Context, at: Free<F>) -> [f64; 2] {
        let mut out = [0.0; 2];
        // SAFETY: two outputs.
        unsafe {
            x.call(
                self.powers,
                &self.dimensions,
                at.pointers(),
                out.as_mut_ptr(),
            )
        }
        out
    }

    /// ∂T/∂v of all coordinates, then of the ground motions.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate and motion.
    pub fn momenta(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        assert_eq!(
            out.len(),
            self.dimensions.coordinates + self.dimensions.motions
        );
        // SAFETY: the length was checked.
        unsafe {
            x.call(
                self.momenta,
                &self.dimensions,
                at.pointers(),
                out.as_mut_ptr(),
            )
        }
    }

    /// What must be positive in this mode.
    ///
    /// # Panics
    /// If `out` has not one entry a requirement.
    #[inline]
    pub fn requirements(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        let (function, count) = self.requirements;
        assert_eq!(out.len(), count);
        // SAFETY: the length was checked.
        unsafe { x.call(function, &self.dimensions, at.pointers(), out.as_mut_ptr()) }
    }

    /// Lower bounds of what must be positive, while time goes on by `tau` (s) from where the series of motion
    /// and signals, of so many orders, were begun. Not positive or not a number where nothing is known.
    ///
    /// # Panics
    /// If `out` has not one entry a requirement, or `orders` is more than [`ORDERS`] − 2.
    #[inline]
    pub fn requirement_bounds(
        &self,
        x: &mut Context,
        (at, orders): (&Series<F>, usize),
        tau: f64,
        out: &mut [f64],
    ) {
        assert_eq!(out.len(), self.requirements.1);
        assert!(orders + 2 <= ORDERS);
        let zero = [SVector::<f64, F>::zeros(); 3];
        let (mut middles, mut radii) = (zero, zero);
        let [q, v, a] = [&at.q, &at.v, &at.a].map(|rows| rows.as_ptr().cast());
        let (to_middles, to_radii) = (middles.as_mut_ptr().cast(), radii.as_mut_ptr().cast());
        // SAFETY: F entries a row, and all ORDERS rows are there, those beyond the order zero; room for three times F.
        unsafe { dalembert_ranges(F, orders + 2, q, v, a, tau, to_middles, to_radii) };
        x.set_signal_radii(orders, tau);
        let u = match x.quiet {
            true => x.arrays.signals.as_ptr(),
            false => x.signal_series.as_ptr(),
        };
        let raw = RawContext {
            u,
            u_dot: x.signal_radii.as_ptr(),
            j: radii.as_ptr().cast(),
            ..*x.raw(&self.dimensions)
        };
        let [q, v, a] = middles.each_ref().map(|of| of.as_ptr());
        // SAFETY: the length of `out` was checked; an entry a signal; F entries each, and three times F
        // radii.
        unsafe { (self.requirement_bounds)(q, v, a, &raw, out.as_mut_ptr()) }
    }

    /// Constant rates of the frozen coordinates (0 where one rests or is free).
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate.
    pub fn held_rates(&self, x: &Context, out: &mut [f64]) {
        self.of_held(self.held_rates, x, out);
    }

    /// Coordinates as the mode holds them; those that it leaves free or holds wherever they were as the context has
    /// them.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate.
    pub fn held_values(&self, x: &Context, out: &mut [f64]) {
        self.of_held(self.held_values, x, out);
    }

    /// What a function of the mode gives that has one output a coordinate and does not depend on those that are free.
    fn of_held(&self, function: Raw, x: &Context, out: &mut [f64]) {
        assert_eq!(out.len(), self.dimensions.coordinates);
        let none = SVector::<f64, F>::zeros();
        let at = Free {
            q: &none,
            v: &none,
            a: &none,
        };
        // SAFETY: the length was checked.
        unsafe { x.call(function, &self.dimensions, at.pointers(), out.as_mut_ptr()) }
    }

    /// Value of a guard of this mode.
    ///
    /// # Panics
    /// If it is one of another model, or of another number of free coordinates; so do the other
    /// functions that are passed a guard or a transition.
    #[inline]
    pub fn guard(&self, x: &Context, guard: &GuardKernel, at: Free<F>) -> f64 {
        assert_eq!(guard.free, F, "a guard is evaluated in its own mode");
        let mut out = 0.0;
        // SAFETY: one output; the guard's number of free coordinates was checked.
        unsafe { x.call(guard.value, &guard.dimensions, at.pointers(), &mut out) }
        out
    }

    /// Derivative of a guard along the flow with jerk `j`; needs the signals to be set.
    pub fn guard_rate(
        &self,
        x: &Context,
        guard: &GuardKernel,
        at: Free<F>,
        j: &SVector<f64, F>,
    ) -> f64 {
        assert_eq!(guard.free, F, "a guard is evaluated in its own mode");
        let mut out = 0.0;
        let [q, v, a] = at.pointers();
        let raw = RawContext {
            j: j.as_ptr(),
            ..*x.raw(&guard.dimensions)
        };
        // SAFETY: one output; the guard's number of free coordinates was checked.
        unsafe { (guard.rate)(q, v, a, &raw, &mut out) }
        out
    }

    /// Sum of the absolute values of the terms that a guard is the sum of, in its unit.
    pub fn guard_magnitude(&self, x: &Context, guard: &GuardKernel, at: Free<F>) -> f64 {
        assert_eq!(guard.free, F, "a guard is evaluated in its own mode");
        let mut out = 0.0;
        // SAFETY: one output; the guard's number of free coordinates was checked.
        unsafe { x.call(guard.magnitude, &guard.dimensions, at.pointers(), &mut out) }
        out
    }

    /// The reset of a transition out of this mode: all q, all v, all discrete states after it.
    ///
    /// # Panics
    /// If `out` has not two entries a coordinate and one a discrete state.
    pub fn reset(&self, x: &Context, transition: &TransitionKernel, at: Free<F>, out: &mut [f64]) {
        assert_eq!(
            transition.source_free, F,
            "a reset is evaluated in its source mode"
        );
        let dimensions = &transition.dimensions;
        assert_eq!(out.len(), 2 * dimensions.coordinates + dimensions.discretes);
        // SAFETY: the lengths were checked.
        unsafe {
            x.call(
                transition.reset,
                dimensions,
                at.pointers(),
                out.as_mut_ptr(),
            )
        }
    }

    /// The conditions of a transition into this mode, which is taken only if none is negative; none
    /// if the transition is unconditional.
    pub fn conditions<'x>(
        &self,
        x: &'x mut Context,
        transition: &TransitionKernel,
        at: Free<F>,
    ) -> &'x [f64] {
        let Some((function, free, count)) = transition.condition else {
            return &[];
        };
        assert_eq!(free, F, "a condition is evaluated in the target mode");
        let out = x.conditions[..count].as_mut_ptr();
        // SAFETY: room for `count` outputs; the number of free coordinates was checked.
        unsafe { x.call(function, &transition.dimensions, at.pointers(), out) }
        &x.conditions[..count]
    }
}

impl<const W: usize> LaneContext<W> {
    /// The context as C sees it.
    #[inline(always)]
    fn raw(&self, dimensions: &Arc<Dimensions>) -> RawContext {
        assert!(
            Arc::ptr_eq(&self.dimensions, dimensions)
                && self.signals.len() == dimensions.signals
                && self.signal_series.len() == ORDERS * dimensions.signals,
            "a context is used with the functions of the model it was made for"
        );
        RawContext {
            u: self.signals.as_ptr().cast(),
            // Rates and jerks are not read by what is compiled for lanes.
            u_dot: std::ptr::null(),
            d: self.discrete.as_ptr().cast(),
            h: self.held.as_ptr().cast(),
            c: self.constants.as_ptr().cast(),
            j: std::ptr::null(),
            angles: self.angles.as_ptr().cast_mut().cast(),
        }
    }
}

impl<const F: usize> ModeKernel<F> {
    /// As [`Self::series_start`]; `quiet`: no input acts.
    ///
    /// # Panics
    /// If the mode does not go in lanes; so do the other functions for lanes.
    pub(crate) fn lane_series_start<const W: usize>(
        &self,
        (level, quiet): (LaneLevel<W>, bool),
        x: &mut LaneContext<W>,
        at: &mut LaneSeries<F, W>,
        out: &mut LaneSystem<F, W>,
    ) {
        let kernel = self.lane_kernel(level);
        let series = if quiet {
            &kernel.quiet_series
        } else {
            &kernel.series
        };
        let raw = x.raw(&self.dimensions);
        assert!(x.workspace.len() >= self.workspace());
        let [q, v, a] = [&mut at.q, &mut at.v, &mut at.a].map(|rows| rows.as_mut_ptr().cast());
        let (u, w) = (x.signal_series.as_ptr().cast(), x.workspace.as_mut_ptr());
        // SAFETY: as in `series_start`, with `W` numbers for each, which the level was compiled for.
        unsafe { (series.start)(q, v, a, u, &raw, w.cast(), (&raw mut *out).cast()) }
    }

    /// As [`Self::series_run`].
    pub(crate) fn lane_series_run<const W: usize>(
        &self,
        (level, quiet): (LaneLevel<W>, bool),
        x: &mut LaneContext<W>,
        n: usize,
        inverse: &[[Lanes<W>; F]; F],
        at: &mut LaneSeries<F, W>,
    ) {
        let kernel = self.lane_kernel(level);
        let series = if quiet {
            &kernel.quiet_series
        } else {
            &kernel.series
        };
        assert!(n <= ORDERS - 2);
        let raw = x.raw(&self.dimensions);
        assert!(x.workspace.len() >= self.workspace());
        let [q, v, a] = [&mut at.q, &mut at.v, &mut at.a].map(|rows| rows.as_mut_ptr().cast());
        let (u, w) = (x.signal_series.as_ptr().cast(), x.workspace.as_mut_ptr());
        let inverse = inverse.as_ptr().cast::<f64>().cast_mut();
        // SAFETY: as in `series_run`, with `W` numbers for each, which the level was compiled for.
        unsafe { (series.run)(n, q, v, a, u, &raw, w.cast(), inverse) }
    }

    /// As [`Self::requirement_bounds`], one lane entry a requirement; `quiet`: no input acts.
    pub(crate) fn lane_requirement_bounds<const W: usize>(
        &self,
        (level, quiet): (LaneLevel<W>, bool),
        x: &mut LaneContext<W>,
        (at, orders): (&LaneSeries<F, W>, usize),
        tau: &Lanes<W>,
        out: &mut [Lanes<W>],
    ) {
        assert_eq!(out.len(), self.requirements.1);
        assert!(orders > 0 && orders + 2 <= ORDERS);
        let functions = level.functions;
        let zero = [[Lanes::<W>::of(0.0); F]; 3];
        let (mut middles, mut radii) = (zero, zero);
        let [q, v, a] = [&at.q, &at.v, &at.a].map(|rows| rows.as_ptr().cast());
        let (to_middles, to_radii) = (middles.as_mut_ptr().cast(), radii.as_mut_ptr().cast());
        let tau = (&raw const *tau).cast();
        // SAFETY: as in `requirement_bounds`.
        unsafe { (functions.ranges)(F, orders + 2, q, v, a, tau, to_middles, to_radii) }
        let signals = self.dimensions.signals;
        assert_eq!(x.signal_radii.len(), signals);
        let raw = x.raw(&self.dimensions);
        let u = x.signal_series.as_ptr().cast();
        for &i in self.dimensions.required.iter().filter(|_| !quiet) {
            let own = (&raw mut x.signal_radii[i]).cast();
            // SAFETY: a row an order, each with an entry a signal, and this one is there.
            unsafe {
                (functions.signal_radius)(
                    orders,
                    signals,
                    x.signal_series[i..].as_ptr().cast(),
                    tau,
                    own,
                )
            }
        }
        let raw = RawContext {
            u,
            u_dot: x.signal_radii.as_ptr().cast(),
            j: radii.as_ptr().cast(),
            ..raw
        };
        let [q, v, a] = middles.each_ref().map(|of| of.as_ptr().cast());
        let function = self.lane_kernel(level).requirement_bounds;
        // SAFETY: as in `requirement_bounds`; the level was compiled for `W` lanes.
        unsafe { function(q, v, a, &raw, out.as_mut_ptr().cast()) }
    }

    /// As [`Self::guard`], by the index of the guard in the mode.
    pub(crate) fn lane_guard<const W: usize>(
        &self,
        level: LaneLevel<W>,
        x: &LaneContext<W>,
        guard: usize,
        [q, v, a]: [&[Lanes<W>; F]; 3],
    ) -> Lanes<W> {
        let function =
            self.lane_kernel(level).guards[guard].expect("a guard of a mode that goes in lanes");
        let raw = x.raw(&self.dimensions);
        let mut out = Lanes::of(0.0);
        let [q, v, a] = [q, v, a].map(|x| x.as_ptr().cast());
        // SAFETY: one output; the level was compiled for `W` lanes.
        unsafe { function(q, v, a, &raw, (&raw mut out).cast()) }
        out
    }

    /// As [`Self::reset`], by the indices of the guard and its transition.
    ///
    /// # Panics
    /// If [`Self::stays_in_lanes`] denies it, or `out` has not two entries a coordinate and one a discrete
    /// state.
    pub(crate) fn lane_reset<const W: usize>(
        &self,
        level: LaneLevel<W>,
        x: &LaneContext<W>,
        (guard, transition): (usize, usize),
        [q, v, a]: [&[Lanes<W>; F]; 3],
        out: &mut [Lanes<W>],
    ) {
        let dimensions = &self.dimensions;
        assert_eq!(out.len(), 2 * dimensions.coordinates + dimensions.discretes);
        let function = self.lane_kernel(level).resets[guard][transition];
        let function = function.expect("the transition stays in lanes");
        let raw = x.raw(dimensions);
        let [q, v, a] = [q, v, a].map(|x| x.as_ptr().cast());
        // SAFETY: the length was checked; the level was compiled for `W` lanes.
        unsafe { function(q, v, a, &raw, out.as_mut_ptr().cast()) }
    }
}
