//! What generated functions need, and give, for trajectories side by side.

use super::ModeKernel;
use super::context::{Context, Dimensions};
use crate::integrate::{Lanes, ORDERS};

/// Number of lanes at each level of the processor that generated code is compiled for; the same in
/// build/compile.rs.
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

/// What generated functions need besides the free coordinates, for `W` trajectories side by side: as
/// [`Context`], each entry a number a lane.
#[derive(Debug, Clone)]
pub struct LaneContext<const W: usize> {
    pub(super) dimensions: &'static Dimensions,
    /// Signals of the inputs.
    pub signals: Box<[Lanes<W>]>,
    /// Taylor coefficients of the signals, one row an order.
    pub signal_series: Box<[Lanes<W>]>,
    pub(super) discrete: Box<[Lanes<W>]>,
    pub(super) held: Box<[Lanes<W>]>,
    pub(super) constants: Box<[Lanes<W>]>,
    pub(super) workspace: Box<[Lanes<W>]>,
}

impl<const W: usize> LaneContext<W> {
    /// A context for a mode, with the discrete states, held coordinates and constants of `like` in all
    /// lanes.
    pub fn new<const F: usize>(kernel: &ModeKernel<F>, like: &Context) -> Self {
        let zeros = |count: usize| vec![Lanes::of(0.0); count].into_boxed_slice();
        let mut context = LaneContext {
            dimensions: like.dimensions,
            signals: zeros(like.signals.len()),
            signal_series: zeros(like.signal_series.len()),
            discrete: zeros(like.discrete.len()),
            held: zeros(like.held.len()),
            constants: zeros(like.constants.len()),
            workspace: zeros(kernel.workspace()),
        };
        for lane in 0..W {
            context.load(lane, like);
        }
        context
    }

    /// Takes over discrete states, held coordinates and constants of a trajectory.
    ///
    /// # Panics
    /// If it is one of another model.
    pub fn load(&mut self, lane: usize, from: &Context) {
        assert!(std::ptr::eq(self.dimensions, from.dimensions));
        let of = [&from.discrete, &from.held, &from.constants];
        let into = [&mut self.discrete, &mut self.held, &mut self.constants];
        for (into, of) in into.into_iter().zip(of) {
            for (into, of) in into.iter_mut().zip(of) {
                into.0[lane] = *of;
            }
        }
    }

    /// The same for a trajectory whose constants were loaded before.
    pub fn load_state(&mut self, lane: usize, from: &Context) {
        let of = from.discrete.iter().chain(&from.held);
        let into = self.discrete.iter_mut().chain(&mut self.held);
        for (into, of) in into.zip(of) {
            into.0[lane] = *of;
        }
    }
}

/// Mass matrix M, by columns, and load b of r = M a + b, in lanes.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct LaneSystem<const F: usize, const W: usize> {
    /// M = ∂r/∂a.
    pub mass: [[Lanes<W>; F]; F],
    /// r at a = 0.
    pub load: [Lanes<W>; F],
}

/// [`crate::integrate::Series`] in lanes.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub struct LaneSeries<const F: usize, const W: usize> {
    /// Of the coordinates.
    pub q: [[Lanes<W>; F]; ORDERS],
    /// Of the velocities.
    pub v: [[Lanes<W>; F]; ORDERS],
    /// Of the accelerations.
    pub a: [[Lanes<W>; F]; ORDERS],
}
