//! A mode's generated equations as the integrator sees them, in the local time of a segment.

use super::instant::Instant;
use super::search::falls_off;
use crate::input::{Side, Signals};
use crate::integrate::{Analytic, ORDERS, Series, Singular, Size, State, System, stretch};
use crate::kernel::{Context, Free, ModeKernel};
use crate::numerics::{Lu, solve_for};

/// What a segment needs to know about time: where it starts, what the inputs do, what drifts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock<'a> {
    /// Start of the segment; local time τ counts from here.
    pub start: Instant,
    /// The inputs.
    pub signals: &'a Signals,
    /// Local time of the segment's last admissible instant and the absolute time it stands for.
    /// Inputs are smooth before it and take their left-hand limits at it.
    pub until: (f64, f64),
    /// Local time of the next instant at which an input may be commanded; infinite where none is, or only at the end of the run.
    pub commanded: f64,
    /// All coordinates at the start, if any drifts.
    pub held: &'a [f64],
    /// Rates of the frozen coordinates; empty if none drifts.
    pub drift: &'a [f64],
}

impl Clock<'_> {
    /// Sets signals and drifting coordinates of the context to those at local time `tau`.
    #[inline(always)]
    fn set(&self, tau: f64, context: &mut Context) {
        if !context.autonomous {
            let (t, side) = self.instant(tau);
            context.set_signals(self.signals, t, side);
        }
        self.set_held(tau, context);
    }

    /// Absolute time that local time `tau` stands for, and the side of it.
    fn instant(&self, tau: f64) -> (f64, Side) {
        match tau < self.until.0 {
            true => (self.start.plus(tau).seconds(), Side::Right),
            false => (self.until.1, Side::Left),
        }
    }

    fn set_held(&self, tau: f64, context: &mut Context) {
        for ((h, q), rate) in context.held_mut().iter_mut().zip(self.held).zip(self.drift) {
            *h = q + rate * tau;
        }
    }

    /// The piece that acts just after local time `tau`, and the absolute time at which it does.
    ///
    /// A knot belongs to the piece after it, even if its local time is rounded to an instant before.
    /// `last` is the piece found before, for an earlier time.
    #[inline(always)]
    fn piece(&self, tau: f64, last: Piece) -> (f64, Piece) {
        let mut t = self.start.plus(tau).seconds();
        if t < last.knot && tau < last.limit {
            return (t.max(last.from), last);
        }
        loop {
            let knot = self.signals.next_knot(t);
            let limit = self.local(knot);
            if limit > tau {
                return (
                    t,
                    Piece {
                        from: t,
                        knot,
                        limit,
                    },
                );
            }
            t = knot;
        }
    }

    /// Local time of the first joint of the inputs that is after local time `tau` as it is rounded there.
    fn next_joint(&self, tau: f64) -> f64 {
        let mut joint = self.signals.next_joint(self.start.plus(tau).seconds());
        while self.local(joint) <= tau {
            joint = self.signals.next_joint(joint);
        }
        self.local(joint)
    }

    /// Local time of an absolute time, which may be infinite.
    #[inline(always)]
    fn local(&self, t: f64) -> f64 {
        match t == f64::INFINITY {
            true => t,
            false => Instant::new(t).since(self.start),
        }
    }
}

/// A stretch of time within which all inputs are analytic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    /// An absolute time from which on it acts, s: its knot, if it was found at an instant that is rounded to before.
    from: f64,
    /// Absolute time at which it ends, s.
    knot: f64,
    /// The same in local time.
    limit: f64,
}

impl Piece {
    /// One that has ended before all times: where it must be looked for.
    pub const UNKNOWN: Piece = Piece {
        from: f64::NEG_INFINITY,
        knot: f64::NEG_INFINITY,
        limit: f64::NEG_INFINITY,
    };
    /// One that never ends.
    pub const ENDLESS: Piece = Piece {
        from: f64::NEG_INFINITY,
        knot: f64::INFINITY,
        limit: f64::INFINITY,
    };
}

/// The reduced system of a mode.
pub(super) struct Equations<'a, F: Size> {
    pub kernel: &'a ModeKernel<F>,
    pub context: &'a mut Context,
    pub clock: Clock<'a>,
    /// Relative tolerance of the run.
    pub tolerance: f64,
    /// Typical sizes of the accelerations' coordinates, for the choice of pivots.
    scale: F::Vector,
    /// Local time for which the context is set; NaN: none.
    set_for: f64,
    /// Whether all of it is set, and not only what the equations of motion need.
    complete: bool,
    /// Whether signals can be computed ahead.
    foresees: bool,
    /// Local times for which the equations' signals are known ahead; NaN: none.
    ahead: [f64; Context::MOST_AHEAD],
    /// The one of them that the context was last set for.
    at_ahead: usize,
    /// Local time about which the guards were last expanded; NaN: none.
    guards_expanded_at: f64,
    /// The piece of the inputs in which the last expansion was.
    piece: Piece,
}

impl<'a, F: Size> Equations<'a, F> {
    pub fn new(
        kernel: &'a ModeKernel<F>,
        context: &'a mut Context,
        clock: Clock<'a>,
        tolerance: f64,
        scale: F::Vector,
        foresees: bool,
        piece: Piece,
    ) -> Self {
        Equations {
            kernel,
            context,
            clock,
            tolerance,
            scale,
            set_for: f64::NAN,
            complete: false,
            foresees,
            ahead: [f64::NAN; Context::MOST_AHEAD],
            at_ahead: 0,
            guards_expanded_at: f64::NAN,
            piece,
        }
    }

    /// The longest window from local time `tau` in which the values of what depends on inputs tell how it goes, s: a period of the fastest
    /// sine. Steps in which the motion depends on no input may be longer.
    pub fn told_by_values(&self, tau: f64) -> f64 {
        4.0 * self.resolution(tau)
    }

    /// Sets the context to local time `tau`.
    #[inline]
    pub fn at(&mut self, tau: f64) {
        if tau != self.set_for || !self.complete {
            // Without inputs and drifts nothing there changes with time.
            if !(self.context.autonomous && self.clock.drift.is_empty()) {
                self.clock.set(tau, self.context);
            }
            (self.set_for, self.complete) = (tau, true);
        }
    }

    /// Sets the context to local time `tau` as far as the equations of motion need it.
    #[inline(always)]
    pub fn at_stage(&mut self, tau: f64) {
        if tau == self.set_for {
            return;
        }
        // They are asked for one after the other.
        let next = (self.at_ahead + 1) % Context::MOST_AHEAD;
        let index = match self.ahead[next] == tau {
            true => Some(next),
            false => self.ahead.iter().position(|&ahead| ahead == tau),
        };
        match index {
            Some(index) => {
                self.at_ahead = index;
                self.context.set_foreseen_signals(index);
                self.clock.set_held(tau, self.context);
                (self.set_for, self.complete) = (tau, false);
            }
            None => self.at(tau),
        }
    }

    /// The accelerations at a point whose time the context is set for.
    #[inline]
    pub fn acceleration_here(&self, q: &F::Vector, v: &F::Vector) -> Result<F::Vector, Singular> {
        self.kernel
            .system(self.context, q, v)
            .accelerations(&self.scale)
    }

    /// Expands the guards about the start of a step of the Taylor method, local time `tau`, unless
    /// that was done before.
    pub fn expand_guards(&mut self, tau: f64, orders: usize, series: &Series<F>) {
        if tau != self.guards_expanded_at {
            self.at(tau);
            self.kernel.guard_series(self.context, orders, series);
            self.guards_expanded_at = tau;
        }
    }

    /// The jerk at a point whose time the context and its signal rates are set for.
    pub fn jerk(&self, at: Free<F>) -> Result<F::Vector, Singular> {
        let mass = self.kernel.system(self.context, at.q, at.v).mass;
        let load = self.kernel.jerk_load(self.context, at);
        solve_for(&mass, |i| -load[i], &self.scale)
    }

    /// A bound of the fastest decay at a point whose time the context is set for, 1/s: the norm of M⁻¹C,
    /// rates measured by typical sizes. 0 where M is singular.
    pub fn decay_rate(&self, at: Free<F>) -> f64 {
        let size = self.kernel.size();
        let mut jacobian = std::array::from_fn(|_| size.zero_matrix());
        self.kernel.jacobian(self.context, at, &mut jacobian);
        let [mass, damping, _] = jacobian;
        let Ok(lu) = Lu::<f64, F>::factorize(|i, j| mass[(i, j)], &self.scale) else {
            return 0.0;
        };
        let mut sums = size.zeros();
        for j in 0..size.get() {
            let column = lu.solve(|i| damping[(i, j)]);
            for i in 0..size.get() {
                sums[i] += column[i].abs() * self.scale[j];
            }
        }
        (0..size.get()).fold(0.0, |most, i| f64::max(most, sums[i] / self.scale[i]))
    }
}

impl<F: Size> System<F> for Equations<'_, F> {
    fn is_linear(&self) -> bool {
        self.kernel.is_linear()
    }

    fn foresee(&mut self, times: &[f64]) {
        if !self.foresees {
            return;
        }
        let clock = &self.clock;
        let mut at = [(0.0, Side::Right); Context::MOST_AHEAD];
        for (at, &tau) in at.iter_mut().zip(times) {
            *at = clock.instant(tau);
        }
        self.context
            .foresee_signals(clock.signals, &at[..times.len()]);
        self.ahead.fill(f64::NAN);
        self.ahead[..times.len()].copy_from_slice(times);
        self.at_ahead = Context::MOST_AHEAD - 1;
    }

    fn resolution(&self, t: f64) -> f64 {
        let clock = &self.clock;
        match self.context.autonomous {
            true => f64::INFINITY,
            false => clock.signals.resolution(clock.start.plus(t).seconds()),
        }
    }

    fn swings(&self) -> bool {
        !self.kernel.swinging().is_empty()
    }

    fn swing_limit(&mut self, t: f64, (series, orders): (&Series<F>, usize), most: f64) -> f64 {
        self.guards_expanded_at = f64::NAN;
        // The implicit method has none of the signals.
        if !self.context.autonomous {
            let (from, piece) = self.clock.piece(t, self.piece);
            self.piece = piece;
            self.context
                .expand_signals(self.clock.signals, from, orders + 1);
        }
        self.expand_guards(t, orders, series);
        let (mut own, mut scaled) = ([0.0; ORDERS], [0.0; ORDERS]);
        let (own, scaled) = (&mut own[..orders], &mut scaled[..orders]);
        // A power of two beyond `most`, and halves of it: no step depends on when the run ends.
        let beyond =
            2.0 * f64::from_bits(most.to_bits() & !((1 << (f64::MANTISSA_DIGITS - 1)) - 1));
        let mut h = beyond;
        for &guard in self.kernel.swinging() {
            self.kernel.guard_coefficients(self.context, guard, own);
            // A pole has no series; its values are looked at.
            if !own.iter().all(|c| c.is_finite()) {
                continue;
            }
            let count = own.iter().rposition(|&c| c != 0.0).map_or(1, |k| k + 1);
            loop {
                stretch(own, |c| *c, (1.0, h, 0), scaled);
                if h == 0.0 || falls_off((scaled, 0), (count, orders), self.tolerance) {
                    break;
                }
                h *= 0.5;
            }
        }
        match h > 0.0 && h < most {
            true => h,
            false => f64::INFINITY,
        }
    }

    fn smooth_until(&self, t: f64) -> f64 {
        match self.context.autonomous {
            true => f64::INFINITY,
            false => self.clock.next_joint(t),
        }
    }

    #[inline]
    fn residual(&mut self, t: f64, q: &F::Vector, v: &F::Vector, a: &F::Vector, r: &mut F::Vector) {
        self.at_stage(t);
        self.kernel.residual(self.context, Free { q, v, a }, r);
    }

    #[inline]
    fn jacobian(
        &mut self,
        t: f64,
        q: &F::Vector,
        v: &F::Vector,
        a: &F::Vector,
        m: &mut F::Matrix,
        c: &mut F::Matrix,
        k: &mut F::Matrix,
    ) {
        self.at(t);
        let size = self.kernel.size();
        let mut out = [size.zero_matrix(), size.zero_matrix(), size.zero_matrix()];
        self.kernel
            .jacobian(self.context, Free { q, v, a }, &mut out);
        [*m, *c, *k] = out;
    }

    #[inline]
    fn acceleration(
        &mut self,
        t: f64,
        q: &F::Vector,
        v: &F::Vector,
        a: &mut F::Vector,
    ) -> Result<(), Singular> {
        self.at_stage(t);
        *a = self.acceleration_here(q, v)?;
        Ok(())
    }
}

impl<F: Size> Analytic<F> for Equations<'_, F> {
    #[inline]
    fn start(&mut self, t: f64, order: usize, series: &Series<F>) -> (F::Matrix, F::Vector) {
        self.clock.set_held(t, self.context);
        if !self.context.autonomous {
            let (from, piece) = self.clock.piece(t, self.piece);
            self.piece = piece;
            let signals = self.clock.signals;
            self.context.expand_signals(signals, from, order + 1);
        }
        (self.set_for, self.complete) = (t, true);
        let system = self.kernel.series_start(self.context, series);
        (system.mass, system.load)
    }

    #[inline]
    fn run(&mut self, n: usize, inverse: &F::Matrix, series: &mut Series<F>) {
        self.kernel.series_run(self.context, n, inverse, series)
    }

    fn horizon(&mut self, t: f64) -> f64 {
        if self.context.autonomous {
            return f64::INFINITY;
        }
        self.piece = self.clock.piece(t, self.piece).1;
        self.piece.limit.min(self.clock.commanded)
    }
}

/// A state without its time.
pub(super) fn free_of<F: Size>(state: &State<F>) -> Free<'_, F> {
    Free {
        q: &state.q,
        v: &state.v,
        a: &state.a,
    }
}
