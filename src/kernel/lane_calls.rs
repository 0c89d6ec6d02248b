//! Calls into the generated C of a model, for trajectories side by side.

use super::context::Dimensions;
use super::lanes::{LANE_ROWS, LaneContext, LaneLevel, LaneSeries, LaneSystem};
use super::raw::RawContext;
use super::tables::{GuardKernel, ModeKernel, TransitionKernel};
use crate::numerics::{Const, Lanes, ORDERS};
use std::sync::Arc;

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

impl<const F: usize> ModeKernel<Const<F>> {
    /// As [`Self::series_start`]; `autonomous`: no input acts.
    ///
    /// # Panics
    /// If the mode does not go in lanes; so do the other functions for lanes.
    pub(crate) fn lane_series_start<const W: usize>(
        &self,
        (level, autonomous): (LaneLevel<W>, bool),
        x: &mut LaneContext<W>,
        at: &mut LaneSeries<F, W>,
        out: &mut LaneSystem<F, W>,
    ) {
        let kernel = self.lane_kernel(level);
        let series = if autonomous {
            &kernel.autonomous_series
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
        (level, autonomous): (LaneLevel<W>, bool),
        x: &mut LaneContext<W>,
        n: usize,
        inverse: &[[Lanes<W>; F]; F],
        at: &mut LaneSeries<F, W>,
    ) {
        let kernel = self.lane_kernel(level);
        let series = if autonomous {
            &kernel.autonomous_series
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

    /// As [`Self::guard_series`]: gives the coefficients, one row an order, as many rows as those of a series have.
    ///
    /// # Panics
    /// If no guard of the mode is more than a coordinate or a rate.
    pub(crate) fn lane_guard_series<'x, const W: usize>(
        &self,
        level: LaneLevel<W>,
        x: &'x mut LaneContext<W>,
        orders: usize,
        at: &mut LaneSeries<F, W>,
    ) -> &'x [Lanes<W>] {
        let series = self.lane_kernel(level).guard_series.as_ref();
        let series = series.expect("a guard is not linear");
        let raw = x.raw(&self.dimensions);
        assert!(orders <= ORDERS && x.workspace.len() >= self.workspace());
        assert!(x.guard_series.len() == self.guards * LANE_ROWS);
        let [q, v, a] = [&mut at.q, &mut at.v, &mut at.a].map(|rows| rows.as_mut_ptr().cast());
        let (u, w) = (x.signal_series.as_ptr().cast(), x.workspace.as_mut_ptr());
        let out = x.guard_series.as_mut_ptr().cast();
        // SAFETY: as in `guard_series`, with `W` numbers for each, which the level was compiled for.
        unsafe {
            (series.start)(q, v, a, u, &raw, w.cast(), out);
            (series.run)(orders, q, v, a, u, &raw, w.cast(), out);
        }
        &x.guard_series
    }

    /// As [`Self::requirement_bounds`], one lane entry a requirement; `autonomous`: no input acts.
    pub(crate) fn lane_requirement_bounds<const W: usize>(
        &self,
        (level, autonomous): (LaneLevel<W>, bool),
        x: &mut LaneContext<W>,
        (at, orders): (&LaneSeries<F, W>, usize),
        tau: &Lanes<W>,
        out: &mut [Lanes<W>],
    ) {
        assert_eq!(out.len(), self.requirements);
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
        for &i in self.dimensions.required.iter().filter(|_| !autonomous) {
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

    /// As [`Self::guard`].
    pub(crate) fn lane_guard<const W: usize>(
        &self,
        level: LaneLevel<W>,
        x: &LaneContext<W>,
        guard: &GuardKernel,
        [q, v, a]: [&[Lanes<W>; F]; 3],
    ) -> Lanes<W> {
        assert_eq!(guard.free, F, "a guard is evaluated in its own mode");
        let function = guard.in_lanes[level.index].expect("a guard of a mode that goes in lanes");
        let raw = x.raw(&guard.dimensions);
        let mut out = Lanes::of(0.0);
        let [q, v, a] = [q, v, a].map(|x| x.as_ptr().cast());
        // SAFETY: one output; the guard's number of free coordinates was checked; the level was compiled for `W` lanes.
        unsafe { function(q, v, a, &raw, (&raw mut out).cast()) }
        out
    }

    /// As [`Self::reset`].
    ///
    /// # Panics
    /// If [`TransitionKernel::stays_in_lanes`] denies it, or `out` has not two entries a coordinate and one a discrete
    /// state.
    pub(crate) fn lane_reset<const W: usize>(
        &self,
        level: LaneLevel<W>,
        x: &LaneContext<W>,
        transition: &TransitionKernel,
        [q, v, a]: [&[Lanes<W>; F]; 3],
        out: &mut [Lanes<W>],
    ) {
        assert_eq!(
            transition.source_free, F,
            "a reset is evaluated in its source mode"
        );
        let dimensions = &transition.dimensions;
        assert_eq!(out.len(), 2 * dimensions.coordinates + dimensions.discretes);
        let function = transition.in_lanes[level.index].expect("the transition stays in lanes");
        let raw = x.raw(dimensions);
        let [q, v, a] = [q, v, a].map(|x| x.as_ptr().cast());
        // SAFETY: the lengths were checked; the level was compiled for `W` lanes.
        unsafe { function(q, v, a, &raw, out.as_mut_ptr().cast()) }
    }
}
