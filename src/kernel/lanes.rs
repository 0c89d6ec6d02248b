//! What generated functions need, and give, for trajectories side by side.

use super::context::{Context, Dimensions};
use super::lane_functions::LaneFunctions;
use super::tables::ModeKernel;
use crate::numerics::Const;
use crate::numerics::{LaneMask, Lanes, ORDERS};
use std::cell::Cell;
use std::sync::Arc;

/// Number of lanes at each level of the processor that generated code is compiled for; the same in
/// codegen/build/compile.rs.
pub const LANES_OF_LEVELS: &[usize] = &[
    2,
    #[cfg(target_arch = "x86_64")]
    4,
    #[cfg(target_arch = "x86_64")]
    8,
];

/// The best level of this processor, an index into [`LANES_OF_LEVELS`].
pub fn processor_level() -> usize {
    #[cfg(target_arch = "x86_64")]
    {
        let best = ["avx512f", "avx512dq", "avx512vl"];
        let has = |name| match name {
            "avx512f" => std::arch::is_x86_feature_detected!("avx512f"),
            "avx512dq" => std::arch::is_x86_feature_detected!("avx512dq"),
            _ => std::arch::is_x86_feature_detected!("avx512vl"),
        };
        if best.into_iter().all(has) {
            return 2;
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            return 1;
        }
    }
    0
}

/// What is called for trajectories side by side at a level of the processor, which has `W` lanes.
#[derive(Clone, Copy)]
pub(crate) struct LaneLevel<const W: usize> {
    /// Index into [`LANES_OF_LEVELS`].
    pub(super) index: usize,
    pub(super) functions: &'static LaneFunctions,
}

/// As many lanes as fill some lines of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Block<const W: usize>([Lanes<W>; Block::<0>::LANES]);

impl<const W: usize> Block<W> {
    /// Numbers a lane.
    pub const LANES: usize = 8;
}

/// An array of lanes that begins with a line of the cache: a vector of a whole line is read at once.
#[derive(Debug, Clone)]
pub(crate) struct LaneRows<const W: usize> {
    pub(super) blocks: Box<[Block<W>]>,
    /// Number of lanes, of which the blocks have no fewer.
    pub(super) count: usize,
}

impl<const W: usize> LaneRows<W> {
    /// So many zeros.
    pub fn zeros(count: usize) -> Self {
        // Lanes are aligned to two numbers: one alone would leave a gap.
        const {
            assert!(size_of::<Block<W>>() == size_of::<[[f64; W]; Block::<0>::LANES]>());
        }
        let block = Block([Lanes::of(0.0); Block::<0>::LANES]);
        LaneRows {
            blocks: vec![block; count.div_ceil(Block::<0>::LANES)].into(),
            count,
        }
    }

    /// Sets all numbers of a lane.
    pub fn fill_lane(&mut self, lane: usize, x: f64) {
        self.iter_mut().for_each(|row| row.0[lane] = x);
    }
}

impl<const W: usize> Default for LaneRows<W> {
    fn default() -> Self {
        Self::zeros(0)
    }
}

/// What generated functions need besides the free coordinates, for `W` trajectories side by side: as
/// [`Context`], each entry a number a lane.
#[derive(Debug, Clone)]
pub(crate) struct LaneContext<const W: usize> {
    pub(super) dimensions: Arc<Dimensions>,
    /// Signals of the inputs.
    pub signals: LaneRows<W>,
    /// Taylor coefficients of the signals, one row an order.
    pub signal_series: LaneRows<W>,
    /// By how much signals change at most while a step lasts.
    pub(super) signal_radii: LaneRows<W>,
    pub(super) discrete: LaneRows<W>,
    pub(super) held: LaneRows<W>,
    pub(super) constants: LaneRows<W>,
    /// Taylor coefficients of the guards, one row an order, where one of them is not linear; those beyond the last order are zero, as in
    /// [`LaneSeries`].
    pub(super) guard_series: LaneRows<W>,
    pub(super) workspace: LaneRows<W>,
    /// Angles that sine and cosine were computed of last, which a function of C may replace.
    pub(super) angles: Box<[Cell<Block<W>>]>,
}

/// As many angles (rad), each with its sine and its cosine: those of zero.
fn zero_angles<const W: usize>(count: usize) -> Box<[Cell<Block<W>>]> {
    let mut rows = LaneRows::zeros(3 * count);
    let cosines = rows.iter_mut().skip(2).step_by(3);
    cosines.for_each(|cosine| *cosine = Lanes::of(1.0));
    rows.blocks.iter().map(|block| Cell::new(*block)).collect()
}

impl<const W: usize> LaneContext<W> {
    /// A context for a mode, with the discrete states, held coordinates and constants of `like` in all
    /// lanes.
    pub fn new<const F: usize>(kernel: &ModeKernel<Const<F>>, like: &Context) -> Self {
        let zeros = LaneRows::zeros;
        let mut context = LaneContext {
            dimensions: like.dimensions.clone(),
            signals: zeros(like.arrays.signals.len()),
            signal_series: zeros(like.signal_series.len()),
            signal_radii: zeros(like.arrays.signals.len()),
            discrete: zeros(like.arrays.discrete.len()),
            held: zeros(like.arrays.held.len()),
            constants: zeros(like.arrays.constants.len()),
            guard_series: zeros(kernel.guards * LANE_ROWS),
            workspace: zeros(kernel.workspace()),
            angles: zero_angles(like.dimensions.angles),
        };
        for lane in 0..W {
            context.load(lane, like);
        }
        context
    }

    /// Of each signal, whether Taylor series depend on it; and room for the signals and for their series.
    pub fn signals_mut(&mut self) -> (&[bool], [&mut LaneRows<W>; 2]) {
        let room = [&mut self.signals, &mut self.signal_series];
        (&self.dimensions.expanded, room)
    }

    /// Takes over discrete states, held coordinates and constants of a trajectory.
    ///
    /// # Panics
    /// If it is one of another model.
    pub fn load(&mut self, lane: usize, from: &Context) {
        assert!(Arc::ptr_eq(&self.dimensions, &from.dimensions));
        let of = [
            &from.arrays.discrete,
            &from.arrays.held,
            &from.arrays.constants,
        ];
        let into = [&mut self.discrete, &mut self.held, &mut self.constants];
        for (into, of) in into.into_iter().zip(of) {
            for (into, of) in into.iter_mut().zip(&**of) {
                into.0[lane] = *of;
            }
        }
    }

    /// Discrete states.
    pub fn discrete(&self) -> &[Lanes<W>] {
        &self.discrete
    }

    /// Discrete states, to be changed.
    pub fn discrete_mut(&mut self) -> &mut [Lanes<W>] {
        &mut self.discrete
    }

    /// The same for a trajectory whose constants were loaded before.
    pub fn load_state(&mut self, lane: usize, from: &Context) {
        for (into, of) in self.discrete.iter_mut().zip(from.arrays.discrete.iter()) {
            into.0[lane] = *of;
        }
        for (into, of) in self.held.iter_mut().zip(from.arrays.held.iter()) {
            into.0[lane] = *of;
        }
    }
}

/// Mass matrix M, by columns, and load b of r = M a + b, in lanes.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub(crate) struct LaneSystem<const F: usize, const W: usize> {
    /// M = ∂r/∂a.
    pub mass: [[Lanes<W>; F]; F],
    /// r at a = 0.
    pub load: [Lanes<W>; F],
}

/// Where trajectories are.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct LanePoint<const F: usize, const W: usize> {
    /// Coordinates.
    pub q: [Lanes<W>; F],
    /// Velocities.
    pub v: [Lanes<W>; F],
    /// Accelerations.
    pub a: [Lanes<W>; F],
    /// What rounding has lost of coordinates and of velocities.
    pub lost: [[Lanes<W>; F]; 2],
    /// Time as a sum of two doubles, as in [`crate::hybrid`]'s instants, s.
    pub t: [Lanes<W>; 2],
}

impl<const F: usize, const W: usize> LanePoint<F, W> {
    /// All at rest at zero.
    pub fn zero() -> Self {
        let zero = [Lanes::of(0.0); F];
        LanePoint {
            q: zero,
            v: zero,
            a: zero,
            lost: [zero; 2],
            t: [Lanes::of(0.0); 2],
        }
    }
}

/// A guard that is factor · (a coordinate or rate) + offset.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct LaneGuard<const W: usize> {
    /// ±1, or what the model says.
    pub factor: Lanes<W>,
    /// In its own unit.
    pub offset: Lanes<W>,
    /// Lanes in which it is zero at the start of the step: there the factor τ is divided out.
    pub starts_at_zero: LaneMask,
}

/// What an event is told from the end of an accumulation by: see [`crate::hybrid`]'s accumulations.
#[derive(Debug, Clone)]
pub(crate) struct LanePast<const F: usize, const W: usize> {
    /// Number of all coordinates.
    pub coordinates: usize,
    /// Indices of the free ones.
    pub free: Box<[usize]>,
    /// Whether an accumulation is looked for.
    pub may_rest: bool,
    /// Part of itself that a component moves by at most while it stands still.
    pub hardly: f64,
    /// Part of the time that the last pattern of an accumulation takes at least.
    pub shortest: f64,
    /// The relative tolerance, and the absolute ones of free coordinates and velocities.
    pub tolerances: LaneRows<W>,
    /// After the last event: free coordinates, their velocities, the time (s), discrete states; not a
    /// number before the first one.
    pub after: LaneRows<W>,
}

/// Rows of a series in lanes: those beyond its order are zero, and fill up fours.
pub(crate) const LANE_ROWS: usize = ORDERS + 1;

/// [`crate::integrate::Series`] in lanes.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct LaneSeries<const F: usize, const W: usize> {
    /// Of the coordinates.
    pub q: [[Lanes<W>; F]; LANE_ROWS],
    /// Of the velocities.
    pub v: [[Lanes<W>; F]; LANE_ROWS],
    /// Of the accelerations.
    pub a: [[Lanes<W>; F]; LANE_ROWS],
}

/// What limits the lengths of the steps of a series.
#[derive(Debug, Clone)]
pub(crate) struct LaneLimits {
    /// Order p of the series.
    pub order: usize,
    /// The terms that limit it, of powers n = p − 1, p, p + 1, p − 3 and p − 2: 1/n; ½ − 1/(2n); and what is added to
    /// their logarithms ÷ n, so that they are those of reciprocal lengths.
    pub terms: [[f64; 5]; 3],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_arch = "x86_64")]
    #[should_panic(expected = "the processor has no level 2, but up to 1")]
    fn code_for_a_better_processor_is_not_handed_out() {
        let _ = LaneLevel::<8>::on_processor(1, 2);
    }

    #[test]
    #[should_panic(expected = "width of the level")]
    fn a_level_has_its_own_width() {
        let _ = LaneLevel::<8>::on_processor(0, 0);
    }

    /// As `struct dalembert_angle` in codegen/lanes.h: an angle, its sine, its cosine, without gaps.
    #[test]
    fn kept_angles_are_zero_at_first() {
        fn check<const W: usize>() {
            for count in [0, 1, 4] {
                let blocks = zero_angles::<W>(count);
                let rows: Vec<_> = blocks.iter().flat_map(|block| block.get().0).collect();
                assert!(rows.len() >= 3 * count);
                for angle in rows[..3 * count].chunks(3) {
                    assert_eq!(angle, [0.0, 0.0, 1.0].map(Lanes::<W>::of));
                }
            }
        }
        check::<2>();
        check::<4>();
        check::<8>();
    }
}
