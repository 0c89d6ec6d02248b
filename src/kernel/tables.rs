//! What the tables of a model hold: functions, typed by the numbers of coordinates, and what is known of
//! them without a call.

use super::raw::{Raw, RawRun, RawStart};
use super::{Context, Dimensions, LaneLevel};
use crate::numerics::{Const, Dynamic, Lu, Matrix, ORDERS, SeriesKind, Singular, Size};
use std::sync::Arc;

/// What depends on parameters alone.
#[derive(Debug)]
pub struct ConstantsKernel {
    pub(crate) dimensions: Arc<Dimensions>,
    pub(crate) function: Raw,
    pub(crate) count: usize,
}

impl ConstantsKernel {
    /// Number of values.
    pub fn count(&self) -> usize {
        self.count
    }
}

/// State and accelerations of the free coordinates of a mode, as every mode function takes them.
#[derive(Debug)]
pub struct Free<'a, F: Size> {
    /// Coordinates.
    pub q: &'a F::Vector,
    /// Velocities.
    pub v: &'a F::Vector,
    /// Accelerations.
    pub a: &'a F::Vector,
}

/// Mass matrix M and load b of r = M a + b.
#[derive(Debug, Clone)]
pub struct LinearSystem<F: Size> {
    /// M = ∂r/∂a; unsymmetric where friction depends on the accelerations.
    pub mass: F::Matrix,
    /// r at a = 0.
    pub load: F::Vector,
}

impl<F: Size> Clone for Free<'_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: Size> Copy for Free<'_, F> {}

impl<F: Size> LinearSystem<F> {
    /// The accelerations, M⁻¹(−b); `scale`: typical sizes of the coordinates, for the choice of pivots.
    ///
    /// # Errors
    /// [`Singular`] where M is singular.
    #[inline(always)]
    pub fn accelerations(&self, scale: &F::Vector) -> Result<F::Vector, Singular> {
        Ok(self.accelerations_by(&self.factorize(scale)?))
    }

    /// M, factorized.
    #[inline(always)]
    pub(crate) fn factorize(&self, scale: &F::Vector) -> Result<Lu<f64, F>, Singular> {
        Lu::factorize(|i, j| self.mass[(i, j)], scale)
    }

    /// The accelerations, by M as it was factorized.
    #[inline(always)]
    pub(crate) fn accelerations_by(&self, mass: &Lu<f64, F>) -> F::Vector {
        let a = mass.solve(|i| -self.load[i]);
        self.mass.size().vector(|i| a[i])
    }

    /// Sign of the determinant of M; none where M is singular to rounding.
    #[inline(always)]
    pub(crate) fn determinant_sign(&self, scale: &F::Vector) -> Option<i8> {
        Some(self.factorize(scale).ok()?.sign())
    }
}

/// Makes a table of functions with these names.
macro_rules! functions {
    ($($name:ident),* $(,)?) => {
        /// Functions of values that every mode has, each once; what they compute is said by `MODE` in codegen/functions.py.
        #[derive(Debug)]
        pub(crate) struct ModeFunctions {
            $(pub $name: Raw),*
        }

        impl ModeFunctions {
            /// Looks for each by its name.
            pub fn find<E>(find: impl Fn(&str) -> Result<Raw, E>) -> Result<Self, E> {
                Ok(ModeFunctions { $($name: find(stringify!($name))?),* })
            }
        }
    };
}

functions! {
    residual,
    jacobian,
    system,
    inertia,
    jerk_load,
    magnitude,
    reactions,
    outputs,
    energies,
    powers,
    momenta,
    requirements,
    requirement_roundings,
    requirement_bounds,
    drift,
    coordinates,
    rates,
    accelerations,
}

/// The generated functions of one mode with F free coordinates.
#[derive(Debug)]
pub struct ModeKernel<F: Size> {
    pub(crate) size: F,
    pub(crate) dimensions: Arc<Dimensions>,
    pub(crate) functions: ModeFunctions,
    /// Number of outputs.
    pub(crate) outputs: usize,
    /// Number of requirements and margins.
    pub(crate) requirements: usize,
    pub(crate) series: SeriesKernel,
    /// The same where no input acts.
    pub(crate) autonomous_series: SeriesKernel,
    pub(crate) guard_series: SeriesKernel,
    /// Number of series of guards, and of what else swings with inputs.
    pub(crate) guards: usize,
    /// Those that swing with inputs while the motion itself may not.
    pub(crate) swinging: Box<[usize]>,
    pub(crate) mass_is_constant: bool,
    pub(crate) inertia_is_fixed: bool,
    pub(crate) is_linear: bool,
    /// Of contacts and constraints, with the number of results.
    pub(crate) contact_values: Option<(Raw, usize)>,
    /// The same of their lines.
    pub(crate) lines: Option<(Raw, usize)>,
    /// Of what impulses act along, where walls, belts or constraints move.
    pub(crate) carried: Option<(Raw, usize)>,
    /// Of what the mode holds and depends on what is free.
    pub(crate) roundings: Option<(Raw, usize)>,
    /// By level of the processor; none where the mode does not go in lanes.
    pub(crate) lanes: Box<[LaneKernel]>,
}

/// The generated functions of a mode for trajectories side by side, at a level of the processor.
#[derive(Debug)]
pub struct LaneKernel {
    pub(crate) series: SeriesKernel,
    /// The same where no input acts.
    pub(crate) autonomous_series: SeriesKernel,
    pub(crate) requirement_bounds: Raw,
    /// Where the mode has guards that are not linear.
    pub(crate) guard_series: Option<SeriesKernel>,
}

/// The generated Taylor series of a mode.
#[derive(Debug)]
pub struct SeriesKernel {
    pub(crate) start: RawStart,
    pub(crate) run: RawRun,
    /// Doubles of the workspace that do not grow with the order.
    pub(crate) lead: usize,
    /// Doubles of the workspace for each order.
    pub(crate) row: usize,
    /// Convolutions that an order takes.
    pub(crate) convolutions: usize,
    /// Whether all coefficients vanish beyond order 0, or of guards beyond the orders of the motion.
    pub(crate) ends: bool,
}

impl<F: Size> ModeKernel<F> {
    /// Number of free coordinates.
    #[inline(always)]
    pub fn size(&self) -> F {
        self.size
    }

    /// Whether the mass matrix stays the same while the mode lasts.
    pub fn mass_is_constant(&self) -> bool {
        self.mass_is_constant
    }

    /// Whether mass matrix and inertia follow from the parameters alone.
    pub fn inertia_is_fixed(&self) -> bool {
        self.inertia_is_fixed
    }

    /// Whether the equations are linear: all of [`Self::jacobian`] stays the same while the mode lasts.
    pub fn is_linear(&self) -> bool {
        self.is_linear
    }

    /// What the equations tell about the Taylor series of the motion.
    pub fn series_kind(&self, x: &Context) -> SeriesKind {
        let series = self.motion_series(x);
        // Guards are expanded as far as the motion, and may depend on inputs where the motion does not.
        match series.convolutions {
            0 if series.ends && self.guards_end(x) => SeriesKind::Ends,
            0 => SeriesKind::Entire,
            convolutions => SeriesKind::Convolved(convolutions),
        }
    }

    /// Whether the series of the guards end with those of the coordinates.
    #[inline]
    pub fn guards_end(&self, x: &Context) -> bool {
        self.guard_series.ends && x.autonomous
    }

    #[inline]
    pub(crate) fn motion_series(&self, x: &Context) -> &SeriesKernel {
        match x.autonomous {
            true => &self.autonomous_series,
            false => &self.series,
        }
    }

    /// Doubles of workspace that the series of this mode need.
    pub(crate) fn workspace(&self) -> usize {
        let all = [&self.series, &self.autonomous_series, &self.guard_series];
        all.map(|s| s.lead + s.row * ORDERS)
            .into_iter()
            .fold(0, usize::max)
    }

    /// Writes the first coefficients of a guard, by its index in the mode, in powers of time; set by
    /// [`Self::guard_series`].
    #[inline]
    pub fn guard_coefficients(&self, x: &Context, guard: usize, out: &mut [f64]) {
        let rows = x.guard_series.chunks_exact(self.guards);
        for (out, row) in out.iter_mut().zip(rows) {
            *out = row[guard];
        }
    }

    /// Whether trajectories of this mode can go side by side.
    pub fn goes_in_lanes(&self) -> bool {
        !self.lanes.is_empty()
    }

    #[inline]
    pub(crate) fn lane_kernel<const W: usize>(&self, level: LaneLevel<W>) -> &LaneKernel {
        &self.lanes[level.index]
    }
}

impl TransitionKernel {
    /// Whether it can be taken in lanes, if its mode goes in them.
    pub fn stays_in_lanes(&self) -> bool {
        self.in_lanes.iter().any(Option::is_some)
    }

    /// Whether it says its impulses.
    pub fn says_impulses(&self) -> bool {
        self.impulses.is_some()
    }

    /// Number of conditions.
    pub fn conditions(&self) -> usize {
        self.condition.map_or(0, |(_, _, count)| count)
    }
}

/// A generated guard.
#[derive(Debug)]
pub struct GuardKernel {
    /// Of its model.
    pub(crate) dimensions: Arc<Dimensions>,
    pub(crate) free: usize,
    pub(crate) value: Raw,
    pub(crate) rate: Raw,
    pub(crate) magnitude: Raw,
    pub(crate) rounding: Raw,
    /// The value in lanes, by level of the processor.
    pub(crate) in_lanes: Box<[Option<Raw>]>,
}

/// A generated transition: its reset, the conditions with the target's number of
/// free coordinates and the number of conditions, and its impulses.
#[derive(Debug)]
pub struct TransitionKernel {
    /// Of its model.
    pub(crate) dimensions: Arc<Dimensions>,
    pub(crate) source_free: usize,
    pub(crate) reset: Raw,
    pub(crate) condition: Option<(Raw, usize, usize)>,
    /// The impulses of an impact of contacts and their number, if it says them.
    pub(crate) impulses: Option<(Raw, usize)>,
    /// The reset in lanes, by level of the processor, if it leads to the same mode and changes nothing that it holds.
    pub(crate) in_lanes: Box<[Option<Raw>]>,
}

/// The functions of a mode, typed by its number of free coordinates: the event engine is compiled for each of the small ones,
/// and once for all others.
#[derive(Debug)]
pub enum ModeKernels {
    /// A mode with 0 free coordinates.
    F0(ModeKernel<Const<0>>),
    /// A mode with 1 free coordinates.
    F1(ModeKernel<Const<1>>),
    /// A mode with 2 free coordinates.
    F2(ModeKernel<Const<2>>),
    /// A mode with 3 free coordinates.
    F3(ModeKernel<Const<3>>),
    /// A mode with 4 free coordinates.
    F4(ModeKernel<Const<4>>),
    /// A mode with 5 free coordinates.
    F5(ModeKernel<Const<5>>),
    /// A mode with 6 free coordinates.
    F6(ModeKernel<Const<6>>),
    /// A mode with any number of free coordinates.
    Any(ModeKernel<Dynamic>),
}

/// Runs an expression with the typed kernel of a mode: `with_kernel!(kernels, k => expression)`. Another one may be given for
/// modes whose number of free coordinates is known when the program runs.
#[macro_export]
macro_rules! with_kernel {
    ($kernels:expr, $kernel:ident => $body:expr) => {
        $crate::with_kernel!($kernels, $kernel => $body, $kernel => $body)
    };
    ($kernels:expr, $kernel:ident => $body:expr, $any:ident => $of_any:expr) => {
        match $kernels {
            $crate::kernel::ModeKernels::F0($kernel) => $body,
            $crate::kernel::ModeKernels::F1($kernel) => $body,
            $crate::kernel::ModeKernels::F2($kernel) => $body,
            $crate::kernel::ModeKernels::F3($kernel) => $body,
            $crate::kernel::ModeKernels::F4($kernel) => $body,
            $crate::kernel::ModeKernels::F5($kernel) => $body,
            $crate::kernel::ModeKernels::F6($kernel) => $body,
            $crate::kernel::ModeKernels::Any($any) => $of_any,
        }
    };
}
pub use crate::with_kernel;
