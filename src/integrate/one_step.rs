//! What the one-step methods have in common, so that whatever follows a motion can take any of them.

use super::dense::Dense;
use super::radau::Radau;
use super::report::{Counters, StepError, StepReport};
use super::state::{Node, State};
use super::system::System;
use super::tableau::{Coefficients, RadauIia};
use super::taylor::{Analytic, Taylor, TaylorDense};
use crate::numerics::{Series, Size};

/// The last step of a one-step method, whichever method it is.
pub trait LastStep<F: Size> {
    /// The state the last step started from.
    fn start(&self) -> &State<F>;

    /// Time to which the last step led, s.
    fn end(&self) -> f64;

    /// The state the last step led to; computed now if it was not before.
    fn state(&mut self) -> &State<F>;

    /// The motion within the last step.
    ///
    /// # Panics
    /// If none was made.
    fn motion(&self) -> &dyn Motion<F>;

    /// Bound of the error of the dense output inside a step, in units of the tolerance, where it is not
    /// as accurate as the end of the step.
    fn looseness(&self) -> f64 {
        0.0
    }
}

/// A last step that can be made again, for systems of type `Y`.
pub trait Retake<F: Size, Y>: LastStep<F> {
    /// Makes the last step again, with exactly the length `h`.
    ///
    /// # Errors
    /// [`StepError`] if that fails.
    fn step_exactly(&mut self, system: &mut Y, h: f64) -> Result<StepReport, StepError>;

    /// Whether the accelerations of [`LastStep::state`] satisfy the equations to rounding, and not to the
    /// tolerance alone.
    fn has_exact_accelerations(&self) -> bool;
}

/// A one-step method with dense output, for systems of type `Y`.
pub trait OneStep<F: Size, Y>: Retake<F, Y> {
    /// Its dense output.
    type Motion: Motion<F>;

    /// Name, and order of accuracy.
    fn name(&self) -> (&'static str, usize);

    /// Goes on from a state that the last step did not lead to. Accelerations that are not given are those of the
    /// equations, which the first step finds unless it [needs](Self::NEEDS_ACCELERATIONS) them.
    ///
    /// # Panics
    /// If accelerations are needed and not given.
    fn restart(&mut self, t: f64, q: &F::Vector, v: &F::Vector, a: Option<&F::Vector>);

    /// Tells, after a restart, that nothing beyond a time may be needed, s after it: what a step costs may follow from that, its
    /// accuracy does not.
    fn foresee(&mut self, _length: f64) {}

    /// How much of the errors of the coordinates counts in the steps that follow, until the next restart, after which all of it
    /// does: 1, or 0 where a coordinate is not controlled.
    fn control(&mut self, part: &F::Vector);

    /// Whether all of the errors of all coordinates counts.
    fn controls_all(&self) -> bool;

    /// Goes on from a state close to the one that the last step led to, at the same time: what the motion is held at was
    /// off by its error.
    fn correct(&mut self, q: &F::Vector, v: &F::Vector, a: &F::Vector);

    /// Makes one step, not beyond `t_end`.
    ///
    /// # Errors
    /// [`StepError`] when no step, however short, succeeds.
    fn step(&mut self, system: &mut Y, t_end: f64) -> Result<StepReport, StepError>;

    /// The motion within the last step.
    fn dense(&self) -> Option<&Self::Motion>;

    /// The same as accurate as the ends of the step, where that can be had: for what is read off it.
    ///
    /// # Panics
    /// If none was made.
    fn path(&mut self, system: &mut Y) -> &dyn Path<F>;

    /// Whether [`Self::nodes`] are those of a quadrature that is more accurate than the dense output.
    const HAS_QUADRATURE: bool;

    /// Nodes of a quadrature over the last step, as accurate as the step; none where the dense output is that.
    fn nodes(&self) -> impl Iterator<Item = Node<F>>;

    /// Whether a restart needs the accelerations.
    const NEEDS_ACCELERATIONS: bool;

    /// Whether stiffness holds the method back.
    const EXPLICIT: bool;

    /// Length of a step of Radau IIA ÷ that of the last step, as far as accuracy limits both: large
    /// where stiffness holds an explicit method back. 0 where it is less than `least`, and for a method that
    /// is not held back.
    fn lag(&self, _system: &Y, _least: f64) -> f64 {
        0.0
    }

    /// Work done since it was last asked for.
    fn take_counters(&mut self) -> Counters;
}

/// The motion within a step, as values.
pub trait Path<F: Size> {
    /// Start of the step, s.
    fn start(&self) -> f64;

    /// Coordinates, velocities and accelerations at time `t` of the step.
    fn at(&self, t: f64) -> (F::Vector, F::Vector, F::Vector);

    /// Coordinates and velocities alone.
    #[inline]
    fn state_at(&self, t: f64) -> (F::Vector, F::Vector) {
        let (q, v, _) = self.at(t);
        (q, v)
    }
}

/// The motion within a step: each coordinate is a polynomial.
pub trait Motion<F: Size>: Path<F> {
    /// Length of the step that the polynomial was made for, s.
    fn length(&self) -> f64;

    /// The motion as a Taylor series and the number of its orders that are known of everything, if
    /// that is what it is.
    fn series(&self) -> Option<(&Series<F>, usize)> {
        None
    }

    /// Number of coefficients of a coordinate, or of its `rate`; at most [`super::ORDERS`].
    fn coefficients(&self, rate: bool) -> usize;

    /// Writes these coefficients, in powers of s = (t − start)/length, of `factor` times coordinate `index`
    /// or its rate, from the power `first` on, as many as there is room for. What is beyond them stays as it
    /// was.
    fn polynomial(&self, of: (usize, bool), factor: f64, first: usize, out: &mut [f64]);

    /// The first two of them: value and slope at the start.
    #[inline]
    fn value_and_slope(&self, of: (usize, bool), factor: f64) -> [f64; 2] {
        let mut two = [0.0; 2];
        self.polynomial(of, factor, 0, &mut two);
        two
    }
}

impl<const S: usize, F: Size> LastStep<F> for Radau<S, F>
where
    RadauIia<S>: Coefficients<S>,
{
    fn start(&self) -> &State<F> {
        self.start()
    }

    fn end(&self) -> f64 {
        self.end()
    }

    fn state(&mut self) -> &State<F> {
        Radau::state(self)
    }

    fn motion(&self) -> &dyn Motion<F> {
        self.dense().expect("a step was made")
    }

    fn looseness(&self) -> f64 {
        self.looseness()
    }
}

impl<const S: usize, F: Size, Y: System<F>> Retake<F, Y> for Radau<S, F>
where
    RadauIia<S>: Coefficients<S>,
{
    fn step_exactly(&mut self, system: &mut Y, h: f64) -> Result<StepReport, StepError> {
        self.step_exactly(system, h)
    }

    fn has_exact_accelerations(&self) -> bool {
        true
    }
}

impl<const S: usize, F: Size, Y: System<F>> OneStep<F, Y> for Radau<S, F>
where
    RadauIia<S>: Coefficients<S>,
{
    type Motion = Dense<S, F>;

    const NEEDS_ACCELERATIONS: bool = true;

    const EXPLICIT: bool = false;

    const HAS_QUADRATURE: bool = true;

    fn name(&self) -> (&'static str, usize) {
        ("Radau IIA", 2 * S - 1)
    }

    fn restart(&mut self, t: f64, q: &F::Vector, v: &F::Vector, a: Option<&F::Vector>) {
        let a = a.expect("accelerations are needed");
        self.restart(t, q, v, a);
    }

    fn control(&mut self, part: &F::Vector) {
        self.control(part);
    }

    fn controls_all(&self) -> bool {
        self.controls_all()
    }

    fn correct(&mut self, q: &F::Vector, v: &F::Vector, a: &F::Vector) {
        self.correct(q, v, a);
    }

    fn step(&mut self, system: &mut Y, t_end: f64) -> Result<StepReport, StepError> {
        let now = self.end();
        let t_end = t_end.min(system.smooth_until(now));
        let mut h_max = system.resolution(now);
        if system.swings() {
            let most = h_max.min(t_end - now);
            let limit = system.swing_limit(now, (self.uniform_motion(), 2 * S - 1), most);
            h_max = h_max.min(limit);
        }
        self.step(system, t_end, h_max)
    }

    fn dense(&self) -> Option<&Dense<S, F>> {
        self.dense()
    }

    fn path(&mut self, system: &mut Y) -> &dyn Path<F> {
        self.path(system)
    }

    fn nodes(&self) -> impl Iterator<Item = Node<F>> {
        self.stages()
    }

    fn take_counters(&mut self) -> Counters {
        self.take_counters()
    }
}

impl<F: Size> LastStep<F> for Taylor<F> {
    fn start(&self) -> &State<F> {
        self.start()
    }

    fn end(&self) -> f64 {
        self.end()
    }

    fn state(&mut self) -> &State<F> {
        self.state()
    }

    fn motion(&self) -> &dyn Motion<F> {
        self.dense().expect("a step was made")
    }
}

impl<F: Size, Y: Analytic<F>> Retake<F, Y> for Taylor<F> {
    fn step_exactly(&mut self, system: &mut Y, h: f64) -> Result<StepReport, StepError> {
        self.step_exactly(system, h)
    }

    fn has_exact_accelerations(&self) -> bool {
        false
    }
}

impl<F: Size, Y: Analytic<F>> OneStep<F, Y> for Taylor<F> {
    type Motion = TaylorDense<F>;

    const NEEDS_ACCELERATIONS: bool = false;

    const EXPLICIT: bool = true;

    const HAS_QUADRATURE: bool = false;

    fn lag(&self, system: &Y, least: f64) -> f64 {
        self.lag(system, least)
    }

    fn name(&self) -> (&'static str, usize) {
        ("Taylor", self.order())
    }

    fn restart(&mut self, t: f64, q: &F::Vector, v: &F::Vector, a: Option<&F::Vector>) {
        self.restart(t, q, v, a);
    }

    fn foresee(&mut self, length: f64) {
        self.foresee(length);
    }

    fn control(&mut self, part: &F::Vector) {
        self.control(part);
    }

    fn controls_all(&self) -> bool {
        self.controls_all()
    }

    fn correct(&mut self, q: &F::Vector, v: &F::Vector, _: &F::Vector) {
        self.correct(q, v);
    }

    fn step(&mut self, system: &mut Y, t_end: f64) -> Result<StepReport, StepError> {
        // The terms of the motion tell what the inputs do, unless nothing moves: guards on reactions
        // then swing with the inputs alone.
        let h_max = match self.start().size().get() {
            0 => system.resolution(self.end()),
            _ => f64::INFINITY,
        };
        self.step(system, t_end, h_max)
    }

    fn dense(&self) -> Option<&TaylorDense<F>> {
        self.dense()
    }

    fn path(&mut self, _: &mut Y) -> &dyn Path<F> {
        self.dense().expect("a step was made")
    }

    fn nodes(&self) -> impl Iterator<Item = Node<F>> {
        std::iter::empty()
    }

    fn take_counters(&mut self) -> Counters {
        self.take_counters()
    }
}

impl<const S: usize, F: Size> Path<F> for Dense<S, F> {
    fn start(&self) -> f64 {
        self.start()
    }

    fn at(&self, t: f64) -> (F::Vector, F::Vector, F::Vector) {
        self.at(t)
    }
}

impl<const S: usize, F: Size> Motion<F> for Dense<S, F> {
    fn length(&self) -> f64 {
        self.length()
    }

    fn coefficients(&self, rate: bool) -> usize {
        if rate { Self::DEGREE } else { Self::DEGREE + 1 }
    }

    fn polynomial(&self, (index, rate): (usize, bool), factor: f64, first: usize, out: &mut [f64]) {
        let powers = first..self.coefficients(rate);
        for (power, out) in powers.zip(out) {
            *out = factor
                * match rate {
                    true => self.rate_coefficient(index, power),
                    false => self.coefficient(index, power),
                };
        }
    }
}

impl<F: Size> Path<F> for TaylorDense<F> {
    fn start(&self) -> f64 {
        self.start()
    }

    fn at(&self, t: f64) -> (F::Vector, F::Vector, F::Vector) {
        self.at(t)
    }

    #[inline]
    fn state_at(&self, t: f64) -> (F::Vector, F::Vector) {
        self.change_from_start(t - self.start())
    }
}

impl<F: Size> Motion<F> for TaylorDense<F> {
    fn length(&self) -> f64 {
        self.length()
    }

    fn series(&self) -> Option<(&Series<F>, usize)> {
        Some((self.series(), self.orders()))
    }

    #[inline]
    fn coefficients(&self, rate: bool) -> usize {
        self.count(rate)
    }

    #[inline]
    fn polynomial(&self, of: (usize, bool), factor: f64, first: usize, out: &mut [f64]) {
        self.scaled(of, factor, first, out);
    }

    #[inline]
    fn value_and_slope(&self, of: (usize, bool), factor: f64) -> [f64; 2] {
        self.first_two(of, factor)
    }
}
