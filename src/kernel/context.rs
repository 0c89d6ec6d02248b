//! What generated functions need besides the free coordinates.

use super::few::copy_few;
use super::lanes::LaneRows;
use super::raw::{Array, RawContext};
use crate::input::{LaneSignals, Side, Signals};
use crate::integrate::ORDERS;
use crate::model::Model;
use crate::with_kernel;
use std::cell::Cell;
use std::sync::Arc;

/// Numbers of entries of the context arrays of a model; its address identifies the model.
#[derive(Debug)]
pub(crate) struct Dimensions {
    /// Coordinates.
    pub coordinates: usize,
    /// Ground motions.
    pub motions: usize,
    /// Signals.
    pub signals: usize,
    /// Discrete states.
    pub discretes: usize,
    /// Parameters.
    pub parameters: usize,
    /// Constants computed from the parameters.
    pub constants: usize,
    /// Angles whose sines and cosines are kept.
    pub angles: usize,
    /// Of each signal, whether the equations of motion, the guards or the requirements of some mode depend on it.
    pub expanded: Box<[bool]>,
    /// The signals on which what some mode requires depends.
    pub required: Box<[usize]>,
}

/// What a generated function needs besides the free coordinates. Its arrays keep the lengths that
/// `Dimensions` state, which the calls rely on: nothing outside of `kernel` can replace them.
#[derive(Debug)]
pub struct Context {
    pub(super) dimensions: Arc<Dimensions>,
    pub(super) arrays: Arrays,
    /// The arrays as C sees them.
    pub(super) raw: RawContext,
    /// Time and side that the signals and their rates are set for, s; NaN: none.
    pub(super) signals_at: (f64, Side),
    /// Whether no input ever acts: all signals are zero and stay so.
    pub quiet: bool,
    /// Taylor coefficients of the signals, one row an order.
    pub(super) signal_series: Box<[f64]>,
    /// By how much signals change at most while a step lasts.
    pub(super) signal_radii: Box<[f64]>,
    /// Signals at instants that will be asked for soon, a row each; antiderivatives are not among them.
    ahead: Box<[f64]>,
    /// Taylor coefficients of the guards, one row an order.
    pub(super) guard_series: Box<[f64]>,
    /// Room for the conditions of any transition.
    pub(super) conditions: Box<[f64]>,
    /// What the series functions carry from one order to the next, two numbers an entry: room for the
    /// longest series of all modes.
    pub(super) workspace: LaneRows<2>,
}

/// What every call is given.
#[derive(Debug, Clone)]
pub(super) struct Arrays {
    /// Signals of the inputs at the present time.
    pub signals: Array<f64>,
    /// Time derivatives of the signals.
    pub signal_rates: Array<f64>,
    /// Discrete states.
    pub discrete: Array<f64>,
    /// All coordinates; the generated functions read those that the mode holds.
    pub held: Array<f64>,
    pub constants: Array<f64>,
    /// Sines and cosines that were computed last, for functions that ask for them again.
    pub angles: Array<Cell<KeptAngle>>,
}

impl Clone for Context {
    fn clone(&self) -> Self {
        let arrays = self.arrays.clone();
        Context {
            dimensions: self.dimensions.clone(),
            raw: arrays.raw(),
            arrays,
            signals_at: self.signals_at,
            quiet: self.quiet,
            signal_series: self.signal_series.clone(),
            signal_radii: self.signal_radii.clone(),
            ahead: self.ahead.clone(),
            guard_series: self.guard_series.clone(),
            conditions: self.conditions.clone(),
            workspace: self.workspace.clone(),
        }
    }
}

/// An angle (rad) with its sine and cosine, as C keeps them.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub(super) struct KeptAngle {
    angle: f64,
    sin: f64,
    cos: f64,
}

impl KeptAngle {
    /// The angle 0.
    pub const ZERO: Self = KeptAngle {
        angle: 0.0,
        sin: 0.0,
        cos: 1.0,
    };
}

impl Context {
    /// A context for `model` with the constants of `parameters` (in the order of the model).
    ///
    /// # Panics
    /// If the number of parameters is not the model's.
    pub fn new(model: &Model, parameters: &[f64]) -> Self {
        let dimensions = model.constants.dimensions.clone();
        let modes = model.automata().flat_map(|variant| &variant.modes);
        let rooms = modes.map(|mode| with_kernel!(&mode.kernels, k => (k.workspace(), k.guards)));
        let (workspace, guards) = rooms.fold((0, 0), |most, room| {
            (most.0.max(room.0), most.1.max(room.1))
        });
        let modes = model.automata().flat_map(|variant| &variant.modes);
        let transitions = modes
            .flat_map(|mode| &mode.guards)
            .flat_map(|guard| &guard.transitions);
        let conditions = transitions.map(|t| t.kernel.conditions()).max();
        let mut constants = vec![0.0; dimensions.constants];
        model.constants.evaluate(parameters, &mut constants);
        let zeros = |count| Array::of(vec![0.0; count]);
        let arrays = Arrays {
            signals: zeros(dimensions.signals),
            signal_rates: zeros(dimensions.signals),
            discrete: Array::of(model.discretes.iter().map(|d| d.values[0]).collect()),
            held: zeros(dimensions.coordinates),
            constants: Array::of(constants),
            angles: Array::of(vec![Cell::new(KeptAngle::ZERO); dimensions.angles]),
        };
        Context {
            raw: arrays.raw(),
            arrays,
            signals_at: (f64::NAN, Side::Right),
            quiet: false,
            ahead: vec![0.0; Self::MOST_AHEAD * dimensions.signals].into(),
            signal_series: vec![0.0; ORDERS * dimensions.signals].into(),
            signal_radii: vec![0.0; dimensions.signals].into(),
            guard_series: vec![0.0; ORDERS * guards].into(),
            conditions: vec![0.0; conditions.unwrap_or(0)].into(),
            workspace: LaneRows::zeros(workspace.div_ceil(2)),
            dimensions,
        }
    }

    /// Goes over to other parameters.
    ///
    /// # Panics
    /// As [`Context::new`], and if it is another model.
    pub fn set_parameters(&mut self, model: &Model, parameters: &[f64]) {
        assert!(Arc::ptr_eq(&self.dimensions, &model.constants.dimensions));
        model
            .constants
            .evaluate(parameters, &mut self.arrays.constants);
    }

    /// Discrete states.
    pub fn discrete(&self) -> &[f64] {
        &self.arrays.discrete
    }

    /// Discrete states, to be changed.
    pub fn discrete_mut(&mut self) -> &mut [f64] {
        &mut self.arrays.discrete
    }

    /// All coordinates; the generated functions read those that the mode holds.
    pub fn held(&self) -> &[f64] {
        &self.arrays.held
    }

    /// All coordinates, to be changed.
    pub fn held_mut(&mut self) -> &mut [f64] {
        &mut self.arrays.held
    }

    /// Signals of the inputs at the present time.
    pub fn signals(&self) -> &[f64] {
        &self.arrays.signals
    }

    /// Time derivatives of the signals.
    pub fn signal_rates(&self) -> &[f64] {
        &self.arrays.signal_rates
    }

    /// Signals and their rates, for values of one's own.
    pub fn signals_mut(&mut self) -> [&mut [f64]; 2] {
        self.signals_at.0 = f64::NAN;
        [&mut self.arrays.signals, &mut self.arrays.signal_rates]
    }

    /// The functions of the signals are others now.
    pub fn forget_signals(&mut self) {
        self.signals_at.0 = f64::NAN;
    }

    /// Sets signals and their rates to those at time `t` (s), as they are on that side.
    #[inline]
    pub fn set_signals(&mut self, signals: &Signals, t: f64, side: Side) {
        if !self.quiet && self.signals_at != (t, side) {
            signals.jets(
                t,
                side,
                &mut self.arrays.signals,
                &mut self.arrays.signal_rates,
            );
            self.signals_at = (t, side);
        }
    }

    /// Most instants of [`Context::foresee_signals`].
    pub const MOST_AHEAD: usize = 8;

    /// Whether [`Context::foresee_signals`] gives all that the equations of motion need: they depend on
    /// no antiderivative of an input, and on some input at all.
    pub fn can_foresee(&self, signals: &Signals) -> bool {
        !self.quiet && !signals.want_antiderivatives(&self.dimensions.expanded)
    }

    /// Computes the signals at up to [`Context::MOST_AHEAD`] instants side by side, for
    /// [`Context::set_foreseen_signals`]; antiderivatives are left out.
    pub fn foresee_signals(&mut self, signals: &Signals, at: &[(f64, Side)]) {
        signals.values(at, self.arrays.signals.len(), &mut self.ahead);
    }

    /// Sets the signals to those of an instant that was foreseen, by its index: enough for the equations
    /// of motion, and for nothing else.
    #[inline]
    pub fn set_foreseen_signals(&mut self, index: usize) {
        let width = self.arrays.signals.len();
        let row = &self.ahead[index * width..][..width];
        copy_few(row, &mut self.arrays.signals);
        self.signals_at.0 = f64::NAN;
    }

    /// Sets signals and their rates to those of a lane, as they are right after its time.
    pub(crate) fn set_signals_of_lane<const W: usize>(
        &mut self,
        of: &LaneSignals<W>,
        lane: usize,
        signals: &Signals,
    ) {
        of.of_lane(
            lane,
            signals,
            &mut self.arrays.signals,
            &mut self.arrays.signal_rates,
        );
        self.signals_at = (of.time(lane), Side::Right);
    }

    /// Sets signals, rates and Taylor coefficients of the signals to those just after time `t` (s).
    #[inline]
    pub fn expand_signals(&mut self, signals: &Signals, t: f64, orders: usize) {
        if !self.quiet {
            self.set_signals(signals, t, Side::Right);
            let rows = &mut self.signal_series[..orders * self.arrays.signals.len()];
            let known = [&*self.arrays.signals, &self.arrays.signal_rates];
            signals.series(t, known, &self.dimensions.expanded, rows);
        }
    }

    /// Sets by how much the signals change at most while time goes on by `tau` (s) from where they were expanded
    /// last, as far as their series say that are known to so many orders.
    #[inline(always)]
    pub(super) fn set_signal_radii(&mut self, orders: usize, tau: f64) {
        let width = self.signal_radii.len();
        for &i in self.dimensions.required.iter().filter(|_| !self.quiet) {
            let rows = self.signal_series[..orders * width].chunks_exact(width);
            let (mut radius, mut power) = (0.0, 1.0);
            for row in rows.skip(1) {
                power *= tau;
                radius += row[i].abs() * power;
            }
            self.signal_radii[i] = radius;
        }
    }
}
