//! Prescribed functions of time: what a scene's `inputs` say, evaluated as the signals of a model.
//!
//! An input of kind [`InputKind::Acceleration`] fills three signals: acceleration, velocity and
//! displacement of the ground, or of what else it moves. The last two are the exact antiderivatives of the first, for tables and
//! sums too; nothing is integrated numerically. Both are zero at t = 0, unless the motion starts elsewhere.
//!
//! Functions may jump, start and end. At such a breakpoint there are two limits:
//! [`Signals::evaluate`] gives the right-hand one and [`Signals::evaluate_left`] the left-hand one.
//! Over a segment `(t0, t1]` without a breakpoint inside, `evaluate` at `t0` and `evaluate_left`
//! after it give the values of one continuous function, whose slope or higher derivatives may jump at joints.

mod commanded;
mod context;
mod function;
mod lanes;
mod sine;
mod spline;
mod table;

pub use crate::numerics::Side;
pub use commanded::Command;
pub use function::{Function, Jet};
pub(crate) use lanes::LaneSignals;
pub use sine::Sine;
pub use table::{Interpolation, Outside, Table, TableError};

use crate::model::{Input, InputKind};
use crate::numerics::Memory;

/// All inputs of a model, as functions of the absolute time of a run.
///
/// The layout of the signal vector is [`Input::signal`]: acceleration, velocity and displacement
/// for an acceleration, the value alone for a value. Nothing here allocates after construction.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    channels: Vec<Channel>,
}

#[derive(Debug, Clone, PartialEq)]
struct Channel {
    kind: InputKind,
    signal: usize,
    function: Function,
}

impl Signals {
    /// One function for each of the inputs, in their order and in their units.
    ///
    /// # Panics
    /// If there are not as many functions as inputs.
    pub fn new(inputs: &[Input], functions: Vec<Function>) -> Self {
        assert_eq!(inputs.len(), functions.len(), "one function for each input");
        let channels = inputs
            .iter()
            .zip(functions)
            .map(|(input, function)| Channel {
                kind: input.kind,
                signal: input.signal,
                function,
            })
            .collect();
        Signals { channels }
    }

    /// Hands on the numbers that decide the functions, one after the other: the same for the same functions, whatever
    /// they are called or how they are printed.
    pub(crate) fn content(&self, put: &mut dyn FnMut(f64)) {
        put(self.channels.len() as f64);
        for channel in &self.channels {
            channel.function.content(put);
        }
    }

    /// The functions, one for each input of the model.
    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        self.channels.iter().map(|c| &c.function)
    }

    /// Lets the motion whose acceleration an input is, by its index, be at this place at t = 0, or move at this rate.
    pub(crate) fn start(&mut self, input: usize, place: Option<f64>, rate: Option<f64>) {
        let function = &mut self.channels[input].function;
        let mut start = function.start();
        start.place = place.unwrap_or(start.place);
        start.rate = rate.unwrap_or(start.rate);
        *function = std::mem::take(function).starting(start);
    }

    /// Gives an input, by its index, another function; the motion whose acceleration it is starts where it did.
    pub(crate) fn set(&mut self, input: usize, function: Function) {
        let own = &mut self.channels[input].function;
        *own = function.starting(own.start());
    }

    /// Whether the function of some input is set by the caller while a run goes on.
    pub fn are_commanded(&self) -> bool {
        self.functions().any(Function::is_commanded)
    }

    /// Commands an input, by its index, from time `t` (s) on. Gives whether its function changes, or `None` if it cannot
    /// be commanded.
    pub(crate) fn command(&mut self, input: usize, t: f64, command: Command) -> Option<bool> {
        self.channels[input].function.command(t, command)
    }

    /// What was commanded, written or read.
    pub(crate) fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        (self.channels.iter_mut()).try_for_each(|channel| channel.function.persist(memory))
    }

    /// Forgets all commands.
    pub(crate) fn rewind(&mut self) {
        for channel in &mut self.channels {
            channel.function.rewind();
        }
    }

    /// Whether no function ever differs from zero.
    pub fn is_zero(&self) -> bool {
        (0..self.channels.len()).all(|input| self.input_is_zero(input))
    }

    /// Whether the function of an input, by its index, never differs from zero.
    pub fn input_is_zero(&self, input: usize) -> bool {
        self.channels[input].function == Function::zero()
    }

    /// Fills `u`, of length [`crate::model::Model::signal_count`], with the signals at time `t`
    /// (s); at a breakpoint with their right-hand limits.
    pub fn evaluate(&self, t: f64, u: &mut [f64]) {
        self.fill_values(t, Side::Right, u);
    }

    /// As [`Signals::evaluate`], with the left-hand limits at a breakpoint.
    pub fn evaluate_left(&self, t: f64, u: &mut [f64]) {
        self.fill_values(t, Side::Left, u);
    }

    /// Fills `u_dot` with the time derivatives of the signals at `t` (s); at a breakpoint with
    /// their right-hand limits.
    pub fn rate(&self, t: f64, u_dot: &mut [f64]) {
        self.fill_rates(t, Side::Right, u_dot);
    }

    /// As [`Signals::rate`], with the left-hand limits at a breakpoint.
    pub fn rate_left(&self, t: f64, u_dot: &mut [f64]) {
        self.fill_rates(t, Side::Left, u_dot);
    }

    /// Fills `u` and `u_dot` with the signals and their rates at `t` (s), as they are on that side.
    #[inline(always)]
    pub fn jets(&self, t: f64, side: Side, u: &mut [f64], u_dot: &mut [f64]) {
        for c in &self.channels {
            let jet = c.function.at(t, side);
            c.set_values(&jet, u);
            c.set_rates(&jet, u_dot);
        }
    }

    /// Fills a row of `rows`, each `width` long, with the signals of each of up to eight instants, as
    /// [`Signals::jets`] does, antiderivatives left out.
    pub fn values(&self, at: &[(f64, Side)], width: usize, rows: &mut [f64]) {
        for c in &self.channels {
            let values = c.function.values(at);
            for (value, row) in values[..at.len()].iter().zip(rows.chunks_exact_mut(width)) {
                row[c.signal] = *value;
            }
        }
    }

    /// Whether an antiderivative that can differ from zero is among the signals that are `wanted`.
    pub fn want_antiderivatives(&self, wanted: &[bool]) -> bool {
        let wants = |c: &Channel| wanted[c.antiderivatives()].contains(&true);
        (self.channels.iter()).any(|c| c.function != Function::zero() && wants(c))
    }

    /// The last time at which some input is not analytic, s; 0 if there is none after the start.
    pub(crate) fn last_knot(&self) -> f64 {
        (self.functions().map(Function::last_knot)).fold(0.0, f64::max)
    }

    /// The first time after `t` at which some input breaks (a jump, the start or
    /// the end of a pulse or a table), in s; infinite if there is none. The motion starts anew there.
    pub fn next_breakpoint(&self, t: f64) -> f64 {
        self.channels
            .iter()
            .map(|c| c.function.next_breakpoint(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// The first time after `t` at which the slope or the third derivative of some input jumps, and no breakpoint
    /// tells of it, in s; infinite if there is none. Methods of a fixed order lose it across such a time.
    pub fn next_joint(&self, t: f64) -> f64 {
        self.channels
            .iter()
            .map(|c| c.function.next_joint(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// The longest window after `t` over which every input is close to a polynomial of low degree,
    /// in s; infinite where breakpoints and joints alone limit it. It keeps a step from stepping over a
    /// pulse that its stages do not see; see [`Function::resolution`].
    pub fn resolution(&self, t: f64) -> f64 {
        self.channels
            .iter()
            .map(|c| c.function.resolution(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// The first time after `t` at which some input is not analytic, in s; infinite if there is none.
    #[inline(always)]
    pub fn next_knot(&self, t: f64) -> f64 {
        self.channels
            .iter()
            .map(|c| c.function.next_knot(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// Fills `rows` with the Taylor coefficients of the signals about `t` (s), as they go on after
    /// it: one row an order, with the layout of [`Signals::evaluate`]. They hold until
    /// [`Signals::next_knot`]. `u` and `u_dot` are what [`Signals::jets`] gives on the right of `t`.
    /// The antiderivatives of an acceleration are filled in where one of them is `wanted`. Those of an input that is zero
    /// are not written: they must be zero.
    ///
    /// # Panics
    /// If there are more than [`Signals::MOST_ORDERS`] rows.
    #[inline(always)]
    pub fn series(&self, t: f64, [u, u_dot]: [&[f64]; 2], wanted: &[bool], rows: &mut [f64]) {
        let width = u.len();
        for c in &self.channels {
            if c.function == Function::zero() {
                // So are its antiderivatives.
                continue;
            }
            let known = [u[c.signal], u_dot[c.signal]];
            let column = &mut rows[c.signal..];
            c.function.series(t, Side::Right, known, width, column);
            if wanted[c.antiderivatives()].contains(&true) {
                let orders = rows.len() / width;
                rows[c.signal + 1] = u[c.signal + 1];
                rows[c.signal + 2] = u[c.signal + 2];
                for k in 1..orders {
                    for antiderivative in [c.signal + 1, c.signal + 2] {
                        rows[k * width + antiderivative] =
                            rows[(k - 1) * width + antiderivative - 1] * INVERSES[k];
                    }
                }
            }
        }
    }

    /// Most orders of [`Signals::series`].
    pub const MOST_ORDERS: usize = 36;

    fn fill_values(&self, t: f64, side: Side, u: &mut [f64]) {
        for c in &self.channels {
            c.set_values(&c.function.at(t, side), u);
        }
    }

    fn fill_rates(&self, t: f64, side: Side, u_dot: &mut [f64]) {
        for c in &self.channels {
            c.set_rates(&c.function.at(t, side), u_dot);
        }
    }
}

impl Channel {
    /// Signals beside the function itself.
    fn antiderivatives(&self) -> std::ops::Range<usize> {
        self.signal + 1..self.signal + self.kind.signals()
    }

    fn set_values(&self, jet: &Jet, u: &mut [f64]) {
        match self.kind {
            InputKind::Acceleration => {
                let values = [jet.value, jet.integral, jet.double_integral];
                u[self.signal..self.signal + 3].copy_from_slice(&values);
            }
            InputKind::Value => u[self.signal] = jet.value,
        }
    }

    fn set_rates(&self, jet: &Jet, u_dot: &mut [f64]) {
        match self.kind {
            InputKind::Acceleration => {
                let rates = [jet.rate, jet.value, jet.integral];
                u_dot[self.signal..self.signal + 3].copy_from_slice(&rates);
            }
            InputKind::Value => u_dot[self.signal] = jet.rate,
        }
    }
}

/// 1/k; the first is not used.
const INVERSES: [f64; Signals::MOST_ORDERS] = {
    let mut inverses = [f64::INFINITY; Signals::MOST_ORDERS];
    let mut k = 1;
    while k < inverses.len() {
        inverses[k] = 1.0 / k as f64;
        k += 1;
    }
    inverses
};

#[cfg(test)]
mod tests;
