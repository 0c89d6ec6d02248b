//! The Taylor method: the motion's own power series, to an order chosen by the tolerance.
//!
//! A step expands the motion about its start ([`Analytic`]), takes the length at which the last
//! terms fall below the tolerance, and ends at the value of the polynomial there (Jorba, À. and
//! Zou, M. (2005), Experiment. Math. 14(1), 99–117). The polynomial is the dense output, so a step
//! that is cut by an event is not made again.
//!
//! Not for stiff equations: the length is bounded by the radius of convergence, thus by a few times
//! the shortest time scale, resolved or not.

mod dense;
mod lanes;
mod length;
mod series;

use length::Orders;

pub use dense::TaylorDense;
pub(crate) use lanes::LaneTaylor;
pub use series::Analytic;

use super::logarithm::root;
use super::report::{Counters, StepError, StepReport};
use super::state::{Lost, State, add, fit};
use super::tableau::{Coefficients, RadauIia};
use super::tolerances::{Control, Tolerances};
use crate::numerics::{
    Kept, Lu, Matrix, Memory, ORDERS, Persist, Series, SeriesKind, Size, Vector, persist,
};

/// What is not finite where the coefficients of a series leave the range of doubles.
pub(crate) const SERIES: &str = "the Taylor series of the motion";

/// Error estimate of Radau IIA: that of a velocity with the term c·τ^`power` is `error`·c·h^`power`, in
/// units of the tolerance.
#[derive(Debug, Clone, Copy)]
struct Implicit {
    power: usize,
    error: f64,
}

impl Implicit {
    fn new<const S: usize, F: Size>(tolerances: &Tolerances<F>) -> Self
    where
        RadauIia<S>: Coefficients<S>,
    {
        let power = S + 1;
        let factorial: f64 = (1..=power).map(|k| k as f64).product();
        let loosening = Control::new::<S>(tolerances).loosening;
        Implicit {
            power,
            error: RadauIia::<S>::TABLEAU.error_constant * factorial / loosening,
        }
    }
}

/// What was done last. In one number: what is read right after it was written must be read as it was written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Last {
    Restart,
    /// A step that starts where the last restart did.
    FirstStep,
    Step,
    /// A step that was not the first, and failed.
    Failure,
}

impl Last {
    fn is_step(self) -> bool {
        matches!(self, Last::FirstStep | Last::Step)
    }
}

/// The Taylor method for an [`Analytic`] system of `F` coordinates. It is used as
/// [`super::Radau`] is.
#[derive(Debug, Clone)]
pub struct Taylor<F: Size> {
    tolerances: Tolerances<F>,
    order: usize,
    /// The lower order where there are many steps.
    lower: Option<usize>,
    /// Of each order that a step can have.
    orders: Orders,
    /// How many steps that the inputs limited took an order, and how many others went on from a step.
    limited: [u64; ORDERS],
    unlimited: u64,
    start: State<F>,
    end: State<F>,
    lost_at_start: Lost<F>,
    lost: Lost<F>,
    dense: TaylorDense<F>,
    /// Length of the last step where its end is known by its time alone; it is computed when it is asked
    /// for, since an event may shorten the step before.
    open: Option<f64>,
    last: Last,
    /// Reciprocal tolerances of coordinates and velocities at the start of the step.
    weights: [F::Vector; 2],
    /// How much of the error of each coordinate counts.
    controlled: F::Vector,
    /// The mass matrix at the start of the last step, and its inverse; `None` where it has none.
    inverse: Kept<(F::Matrix, F::Matrix)>,
    /// Whether the accelerations after a restart were given.
    accelerations_given: bool,
    implicit: Implicit,
    /// Length of the last step as far as accuracy limits it; infinite where nothing was expanded yet.
    length: f64,
    /// What the first step after a restart need not go beyond, s after it.
    foreseen: f64,
    counters: Counters,
}

persist!([F: Size] Taylor<F> {
    start, end, lost_at_start, lost, dense, open, last, weights, controlled, inverse, accelerations_given, length, counters
} but { tolerances, order, lower, orders, limited, unlimited, implicit, foreseen });

impl Persist for Last {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let all = [Last::Restart, Last::FirstStep, Last::Step, Last::Failure];
        memory.one_of(self, &all)
    }
}

impl<F: Size> Taylor<F> {
    /// An integrator at rest at zero; call [`Taylor::restart`] before the first step.
    pub fn new(tolerances: &Tolerances<F>, kind: SeriesKind) -> Self {
        let size = tolerances.size();
        let relative = tolerances.relative();
        let order = length::order(relative, kind, size.get());
        let implicit = match super::stages(relative) {
            5 => Implicit::new::<5, F>(tolerances),
            _ => Implicit::new::<7, F>(tolerances),
        };
        debug_assert!(implicit.power <= order, "the series has no such term");
        Taylor {
            implicit,
            length: f64::INFINITY,
            foreseen: f64::INFINITY,
            tolerances: tolerances.clone(),
            order,
            lower: length::half_period(relative, kind),
            orders: Orders::new(relative, (implicit.power, order), kind, size.get()),
            limited: [0; ORDERS],
            unlimited: 0,
            start: State::origin(size),
            end: State::origin(size),
            lost_at_start: Lost::nothing(size),
            lost: Lost::nothing(size),
            dense: TaylorDense {
                t0: 0.0,
                h: 0.0,
                t_end: 0.0,
                order,
                known: order,
                series: Series::zero(size),
            },
            open: None,
            last: Last::Restart,
            weights: [size.zeros(), size.zeros()],
            controlled: size.repeat(1.0),
            inverse: Kept::nothing((size.zero_matrix(), size.zero_matrix())),
            accelerations_given: false,
            counters: Counters::default(),
        }
    }

    /// Forgets what was inverted and how long steps were, so that the work of the next run does not depend on the one before.
    pub(crate) fn forget(&mut self) {
        self.inverse.clear();
        self.length = f64::INFINITY;
    }

    /// Takes other absolute tolerances, before a [`Taylor::restart`].
    pub(crate) fn set_tolerances(&mut self, of: impl FnOnce(F) -> Tolerances<F>) {
        let tolerances = of(self.tolerances.size());
        debug_assert!(tolerances.relative() == self.tolerances.relative());
        self.tolerances = tolerances;
    }

    /// Goes on from a state that the last step did not lead to, as [`super::Radau::restart`]. Accelerations that are
    /// not given are those of the equations; [`Taylor::state`] has zeros instead before the first step.
    pub fn restart(&mut self, t: f64, q: &F::Vector, v: &F::Vector, a: Option<&F::Vector>) {
        self.controlled = q.size().repeat(1.0);
        self.weights = self.weights_at(q, v);
        self.end = State {
            t,
            q: q.clone(),
            v: v.clone(),
            a: a.cloned().unwrap_or_else(|| q.size().zeros()),
        };
        self.accelerations_given = a.is_some();
        self.lost = Lost::nothing(q.size());
        self.open = None;
        self.last = Last::Restart;
        self.foreseen = f64::INFINITY;
    }

    /// As [`super::OneStep::control`].
    pub fn control(&mut self, part: &F::Vector) {
        self.controlled.clone_from(part);
    }

    /// Whether all of the errors of all coordinates counts.
    pub fn controls_all(&self) -> bool {
        self.controlled.as_slice().iter().all(|&part| part == 1.0)
    }

    /// As [`super::OneStep::foresee`].
    #[inline]
    pub fn foresee(&mut self, length: f64) {
        self.foreseen = length;
    }

    /// Goes on from a state close to the one that the last step led to, at its time.
    pub fn correct(&mut self, q: &F::Vector, v: &F::Vector) {
        self.state();
        self.end.q.clone_from(q);
        self.end.v.clone_from(v);
        let t = self.lost.t;
        self.lost = Lost::nothing(q.size());
        self.lost.t = t;
    }

    /// Order of the method: that of the last coefficient of the velocities.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The one order with which the steps made so far would have cost least, if most of them went no farther than to where an
    /// input is not smooth.
    pub(crate) fn order_between_knots(&self) -> Option<usize> {
        let most = self.limited.iter().sum::<u64>() > self.unlimited;
        most.then(|| self.orders.cheapest_for(&self.limited))
    }

    /// The state the last step started from; after a restart, that of the step before it.
    pub fn start(&self) -> &State<F> {
        &self.start
    }

    /// Time to which the last step led, s.
    pub fn end(&self) -> f64 {
        self.end.t
    }

    /// The state the last step led to (or the restart set).
    #[inline(always)]
    pub fn state(&mut self) -> &State<F> {
        if let Some(h) = self.open.take() {
            self.complete(h);
        }
        &self.end
    }

    /// The motion within the last step; `None` after a restart or a failure.
    pub fn dense(&self) -> Option<&TaylorDense<F>> {
        self.last.is_step().then_some(&self.dense)
    }

    /// Work done since it was last taken. An order of a series counts as an evaluation of the residual.
    pub fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }

    /// Makes one step, not beyond `t_end`, not longer than `h_max` (∞ where nothing limits it) and
    /// not beyond [`Analytic::horizon`]. A step that could reach `t_end` ends there exactly.
    ///
    /// # Errors
    /// [`StepError`] if the mass matrix is singular, a coefficient is not finite, or the step would
    /// be shorter than the resolution of time. The state remains that of the step before.
    ///
    /// # Panics
    /// If `t_end` is not after the present time, or `h_max` is not positive.
    pub fn step<Y: Analytic<F>>(
        &mut self,
        system: &mut Y,
        t_end: f64,
        h_max: f64,
    ) -> Result<StepReport, StepError> {
        assert!(
            t_end > self.end.t,
            "t_end = {t_end} is not after t = {}",
            self.end.t
        );
        assert!(h_max > 0.0, "h_max = {h_max} is not positive");
        self.state();
        // Before the expansion, so that no division is left to wait for behind it.
        if self.last != Last::Restart {
            self.weights = self.weights_at(&self.end.q, &self.end.v);
        }
        let from = self.end.t;
        let remaining = (t_end - from) - self.lost.t;
        let horizon = system.horizon(from) - from;
        let order = self.order_up_to(horizon);
        match horizon < f64::INFINITY {
            _ if !self.last.is_step() => {}
            true => self.limited[order] += 1,
            false => self.unlimited += 1,
        }
        self.expand(system, order)?;
        self.length = self.accurate_length();
        let mut is_near_end = false;
        if let Some(lower) = self.lower
            && lower < self.dense.known
            && self.length * length::MANY < horizon
        {
            is_near_end = self.length * length::MANY >= remaining;
            if !is_near_end {
                self.lower_order(lower);
                self.length = self.accurate_length();
            }
        }
        let mut h_max = h_max.min(horizon);
        if system.swings() {
            let most = fit(self.length, remaining, h_max);
            let series = (&self.dense.series, self.dense.known);
            h_max = h_max.min(system.swing_limit(from, series, most));
        }
        let h = fit(self.length, remaining, h_max);
        is_near_end |= h == remaining || h != self.length.min(h_max);
        if from + h == from {
            return Err(StepError::Tolerance {
                t: from,
                h,
                error: 1.0,
            });
        }
        let t = (h == remaining).then_some(t_end);
        self.start_here();
        self.finish(h, t);
        self.dense.h = h;
        self.counters.steps += 1;
        let report = self.report();
        Ok(StepReport {
            is_near_end,
            ..report
        })
    }

    /// Shortens the last step to the length `h`, or makes a step of it right after a restart. The
    /// polynomial is kept. May be repeated.
    ///
    /// # Errors
    /// As for [`Taylor::step`].
    ///
    /// # Panics
    /// If `h` is not positive.
    pub fn step_exactly<Y: Analytic<F>>(
        &mut self,
        system: &mut Y,
        h: f64,
    ) -> Result<StepReport, StepError> {
        assert!(h > 0.0, "h = {h} is not positive");
        if !self.last.is_step() {
            self.expand(system, self.order)?;
            self.start_here();
            self.dense.h = h;
        }
        self.finish(h, None);
        self.counters.retaken += 1;
        Ok(self.report())
    }

    /// The order of a step that need not go beyond `horizon`, or, after a restart, beyond what was foreseen, s: the least whose
    /// step would be twice as long, as far as the length of the step before tells. Twice, since that tells the radius of
    /// convergence to some per cent only, and what follows has another.
    #[inline]
    fn order_up_to(&self, horizon: f64) -> usize {
        let needed = match self.last {
            Last::FirstStep | Last::Step => horizon,
            Last::Restart => self.foreseen,
            Last::Failure => f64::INFINITY,
        };
        match needed < f64::INFINITY && self.length < f64::INFINITY {
            true => {
                let last = (self.dense.known, self.length);
                self.orders.least(last, 2.0 * needed)
            }
            false => self.order,
        }
    }

    /// Expands the motion about the end of the last step to an order, or to the lower one where it is not finite.
    fn expand<Y: Analytic<F>>(&mut self, system: &mut Y, order: usize) -> Result<(), StepError> {
        let restarted = self.last == Last::Restart;
        if !restarted {
            self.last = Last::Failure;
        }
        let origin = &self.end;
        let t = origin.t;
        if let Some(what) = origin.not_finite() {
            return Err(StepError::NonFinite { t, h: 0.0, what });
        }
        self.dense.t0 = t;
        let series = &mut self.dense.series;
        let n = origin.size().get();
        for i in 0..n {
            (series.q[0][i], series.v[0][i]) = (origin.q[i], origin.v[i]);
        }
        let (mass, load) = system.start(t, order, series);
        if self.inverse.get().is_none_or(|(of, _)| *of != mass) {
            self.invert(mass)?;
        }
        let (_, inverse) = self.inverse.get().expect("it was inverted");
        let (origin, series) = (&mut self.end, &mut self.dense.series);
        // A restart may give the accelerations: zero where they are not told from it, so that the motion
        // leaves with the sign of the jerk.
        if !(restarted && self.accelerations_given) {
            let a = inverse.times(&load);
            origin.a = a.size().vector(|i| -a[i]);
        }
        for i in 0..n {
            let a = origin.a[i];
            (series.a[0][i], series.v[1][i], series.q[2][i]) = (a, a, a * 0.5);
            series.q[1][i] = origin.v[i];
        }
        system.run(order, inverse, series);
        self.counters.residual_evaluations += order as u64;
        let before = std::mem::replace(&mut self.dense.known, order);
        if order < before {
            self.leave_out(order, before + 2);
        }
        // What is not finite stays so in all higher orders.
        let is_finite =
            |order: usize| (0..n).all(|i| self.dense.series.a[order - 1][i].is_finite());
        match self.lower {
            _ if is_finite(order) => {}
            Some(lower) if lower < order && is_finite(lower) => self.lower_order(lower),
            _ => {
                return Err(StepError::NonFinite {
                    t,
                    h: 0.0,
                    what: SERIES,
                });
            }
        }
        self.find_last();
        Ok(())
    }

    /// Leaves out the coefficients that a method of lower order does not have.
    #[cold]
    fn lower_order(&mut self, order: usize) {
        self.leave_out(order, ORDERS);
        self.dense.known = order;
        self.find_last();
    }

    /// Sets the coefficients that an order does not have to zero, in rows below `end`.
    fn leave_out(&mut self, order: usize, end: usize) {
        let series = &mut self.dense.series;
        let n = series.size().get();
        for k in order..end {
            for i in 0..n {
                series.a[k][i] = 0.0;
                if k > order {
                    series.v[k][i] = 0.0;
                }
                if k > order + 1 {
                    series.q[k][i] = 0.0;
                }
            }
        }
    }

    /// Looks for the last coefficients that differ from zero.
    #[inline(always)]
    fn find_last(&mut self) {
        let series = &self.dense.series;
        let n = series.size().get();
        let last = (0..self.dense.known).rposition(|k| (0..n).any(|i| series.a[k][i] != 0.0));
        self.dense.order = last.map_or(1, |last| last + 1);
    }

    /// Inverts the mass matrix.
    fn invert(&mut self, mass: F::Matrix) -> Result<(), StepError> {
        self.inverse.clear();
        let t = self.dense.t0;
        let scale = self.tolerances.v_absolute();
        let lu = Lu::<f64, F>::factorize(|i, j| mass[(i, j)], scale).map_err(|singular| {
            let coordinate = singular.coordinate;
            StepError::Singular {
                t,
                h: 0.0,
                coordinate,
            }
        })?;
        let inverse = self.inverse.write();
        lu.inverse(|i, j, entry| inverse.1[(i, j)] = entry);
        self.counters.factorizations += 1;
        inverse.0 = mass;
        Ok(())
    }

    /// Reciprocal tolerances of given coordinates and velocities, times how much of the error of each counts.
    fn weights_at(&self, q: &F::Vector, v: &F::Vector) -> [F::Vector; 2] {
        let relative = self.tolerances.relative();
        let weights = |absolute: &F::Vector, x: &F::Vector| {
            x.size()
                .vector(|i| self.controlled[i] / (absolute[i] + relative * x[i].abs()))
        };
        [
            weights(self.tolerances.q_absolute(), q),
            weights(self.tolerances.v_absolute(), v),
        ]
    }

    /// The length at which the last terms equal the tolerance, as far as those before agree.
    #[inline(always)]
    fn accurate_length(&self) -> f64 {
        let Series { q, v, .. } = &self.dense.series;
        let [of_q, of_v] = &self.weights;
        let of_q = |power: usize| largest::<F>(&q[power], of_q);
        let of_v = |power: usize| largest::<F>(&v[power], of_v);
        let p = self.dense.known;
        let sizes = [
            of_v(p - 1),
            f64::max(of_v(p), of_q(p)),
            of_q(p + 1),
            of_v(p - 3),
            of_v(p - 2),
        ];
        self.orders.terms(p).length(sizes)
    }

    /// Length of a step of Radau IIA, as the term of its error estimate allows, ÷ that of the last step, as
    /// far as accuracy limits both; 0 where it is less than `least`.
    pub fn lag<Y: Analytic<F>>(&self, system: &Y, least: f64) -> f64 {
        let Implicit { power, error } = self.implicit;
        let [_, of_v] = &self.weights;
        let size = largest::<F>(&self.dense.series.v[power], of_v) * error;
        // Already the step that is `least` times as long has too large an error, or has none.
        let limit = least * self.length;
        let is_less = (0..power).fold(size, |error, _| error * limit) >= 1.0;
        if is_less || self.length == f64::INFINITY {
            return 0.0;
        }
        let t = self.start.t;
        let longest = system.resolution(t).min(system.smooth_until(t) - t);
        let implicit = root(size, power).min(longest);
        let lag = implicit / self.length;
        if lag < least { 0.0 } else { lag }
    }

    /// The step starts where the last one ended.
    #[inline]
    fn start_here(&mut self) {
        self.start.clone_from(&self.end);
        self.lost_at_start.clone_from(&self.lost);
    }

    /// Ends the step after `h`, at `t` if that is given.
    #[inline]
    fn finish(&mut self, h: f64, t: Option<f64>) {
        (self.end.t, self.lost.t) = match t {
            Some(t) => (t, 0.0),
            None => add(self.start.t, h, self.lost_at_start.t),
        };
        self.dense.t_end = self.end.t;
        self.open = Some(h);
        self.last = match self.last {
            Last::Restart | Last::FirstStep => Last::FirstStep,
            Last::Step | Last::Failure => Last::Step,
        };
    }

    /// Computes the state at the end of the step of length `h`. The acceleration is that of the polynomial:
    /// as good as the tolerance.
    #[inline(always)]
    fn complete(&mut self, h: f64) {
        let (start, lost) = (&self.start, &self.lost_at_start);
        let (dq, dv) = self.dense.change(h);
        for i in 0..start.size().get() {
            (self.end.q[i], self.lost.q[i]) = add(start.q[i], dq[i], lost.q[i]);
            (self.end.v[i], self.lost.v[i]) = add(start.v[i], dv[i], lost.v[i]);
        }
        self.end.a = self.dense.acceleration(h);
    }

    /// The last terms have set the length: there is no other estimate of the error.
    fn report(&self) -> StepReport {
        StepReport {
            t_start: self.start.t,
            t_end: self.end.t,
            h: self.end.t - self.start.t,
            error: f64::NAN,
            iterations: 0,
            discarded: 0,
            is_near_end: false,
        }
    }
}

/// The largest component of a coefficient, weighted.
#[inline]
fn largest<F: Size>(coefficient: &F::Row, weights: &F::Vector) -> f64 {
    (0..weights.size().get()).fold(0.0, |most, i| {
        f64::max(most, coefficient[i].abs() * weights[i])
    })
}
