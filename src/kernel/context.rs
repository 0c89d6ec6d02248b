//! What generated functions need besides the free coordinates.

use super::lanes::LaneRows;
use super::raw::{Array, RawContext};
use super::tables::ConstantsKernel;
use crate::numerics::{ORDERS, Side};
use std::cell::Cell;
use std::sync::Arc;

/// Numbers of entries of the context arrays of a model; its address identifies the model.
#[derive(Debug)]
pub(crate) struct Dimensions {
    /// Coordinates.
    pub coordinates: usize,
    /// Of each prescribed motion, the signal that is its place.
    pub motions: Box<[usize]>,
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
    pub autonomous: bool,
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
    /// All coordinates, then the places of the prescribed motions; the generated functions read what the mode holds, and where.
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
            autonomous: self.autonomous,
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
pub(crate) struct KeptAngle {
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

/// Room that the functions of a model need besides its dimensions.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rooms {
    /// Numbers that the longest series carries from one order to the next.
    pub workspace: usize,
    /// Most guards of a mode.
    pub guards: usize,
    /// Most conditions of a transition.
    pub conditions: usize,
}

/// Where the signals are kept, to be filled.
pub(crate) struct SignalRooms<'c> {
    /// Signals and their rates.
    pub now: [&'c mut [f64]; 2],
    /// Time and side that they are set for, s; NaN: none.
    pub at: &'c mut (f64, Side),
    /// Taylor coefficients, one row an order.
    pub series: &'c mut [f64],
    /// Of each signal, whether its series is wanted.
    pub expanded: &'c [bool],
    /// Signals at instants that will be asked for soon, a row each; antiderivatives are not among them.
    pub ahead: &'c mut [f64],
}

impl Context {
    /// A context for the model with these dimensions.
    ///
    /// # Panics
    /// If the number of discrete states or parameters is not the model's.
    pub(crate) fn with(
        constants: &ConstantsKernel,
        rooms: Rooms,
        discrete: Vec<f64>,
        parameters: &[f64],
    ) -> Self {
        let dimensions = constants.dimensions.clone();
        assert_eq!(discrete.len(), dimensions.discretes);
        let mut values = vec![0.0; dimensions.constants];
        constants.evaluate(parameters, &mut values);
        let zeros = |count| Array::of(vec![0.0; count]);
        let arrays = Arrays {
            signals: zeros(dimensions.signals),
            signal_rates: zeros(dimensions.signals),
            discrete: Array::of(discrete),
            held: zeros(dimensions.coordinates + dimensions.motions.len()),
            constants: Array::of(values),
            angles: Array::of(vec![Cell::new(KeptAngle::ZERO); dimensions.angles]),
        };
        Context {
            raw: arrays.raw(),
            arrays,
            signals_at: (f64::NAN, Side::Right),
            autonomous: false,
            ahead: vec![0.0; Self::MOST_AHEAD * dimensions.signals].into(),
            signal_series: vec![0.0; ORDERS * dimensions.signals].into(),
            signal_radii: vec![0.0; dimensions.signals].into(),
            guard_series: vec![0.0; ORDERS * rooms.guards].into(),
            conditions: vec![0.0; rooms.conditions].into(),
            workspace: LaneRows::zeros(rooms.workspace.div_ceil(2)),
            dimensions,
        }
    }

    /// Goes over to other constants: those of the same model at these parameters.
    ///
    /// # Panics
    /// As [`Context::with`], and if it is another model.
    pub(crate) fn set_constants(&mut self, constants: &ConstantsKernel, parameters: &[f64]) {
        assert!(Arc::ptr_eq(&self.dimensions, &constants.dimensions));
        constants.evaluate(parameters, &mut self.arrays.constants);
    }

    /// Discrete states.
    pub fn discrete(&self) -> &[f64] {
        &self.arrays.discrete
    }

    /// Discrete states, to be changed.
    pub fn discrete_mut(&mut self) -> &mut [f64] {
        &mut self.arrays.discrete
    }

    /// All coordinates, then the places of the prescribed motions; the generated functions read what the mode holds, and where.
    pub fn held(&self) -> &[f64] {
        &self.arrays.held
    }

    /// The same, to be changed.
    pub fn held_mut(&mut self) -> &mut [f64] {
        &mut self.arrays.held
    }

    /// Lets a mode hold what it holds where the coordinates `q` are, and the motions by the present signals.
    #[inline(always)]
    pub fn hold(&mut self, q: &[f64]) {
        let (own, motions) = self.arrays.held.split_at_mut(q.len());
        own.copy_from_slice(q);
        for (place, &signal) in motions.iter_mut().zip(&self.dimensions.motions) {
            *place = self.arrays.signals[signal];
        }
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

    /// Most instants whose signals are foreseen.
    pub const MOST_AHEAD: usize = 8;

    /// Of each signal, whether its series is wanted.
    pub(crate) fn expanded(&self) -> &[bool] {
        &self.dimensions.expanded
    }

    /// Where the signals are kept, to be filled.
    #[inline(always)]
    pub(crate) fn signal_rooms(&mut self) -> SignalRooms<'_> {
        SignalRooms {
            now: [&mut self.arrays.signals, &mut self.arrays.signal_rates],
            at: &mut self.signals_at,
            series: &mut self.signal_series,
            expanded: &self.dimensions.expanded,
            ahead: &mut self.ahead,
        }
    }

    /// Sets by how much the signals change at most while time goes on by `tau` (s) from where they were expanded
    /// last, as far as their series say that are known to so many orders.
    #[inline(always)]
    pub(super) fn set_signal_radii(&mut self, orders: usize, tau: f64) {
        let width = self.signal_radii.len();
        for &i in self.dimensions.required.iter().filter(|_| !self.autonomous) {
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
