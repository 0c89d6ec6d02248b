//! The step: attempts, acceptance, restarts, and steps of exact length.

use super::controller::{Controller, GROWTH, Pace};
use super::dense::Dense;
use super::estimate::Estimate;
use super::first_step;
use super::newton::{Newton, Outcome, Stages};
use super::one_step::Path;
use super::refined::Refined;
use super::report::{Counters, StepError, StepReport};
use super::state::{Lost, Node, State, add, fit};
use super::system::System;
use super::tableau::{Coefficients, RadauIia};
use super::tolerances::{Control, Tolerances, Weights};
use crate::numerics::{Blank, Kept, Memory, Persist, Series, Size, Vector, persist};

/// A Jacobian with which Newton's iteration contracted at least this fast serves the next step too.
const REUSE: f64 = 1e-3;

/// A successful attempt.
struct Trial {
    error: f64,
    iterations: u32,
}

/// Where the matrices in use come from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Linearized {
    /// The step being made.
    Now,
    /// A step before it.
    Before,
}

/// Radau IIA with `S` stages for a [`System`] of `F` coordinates.
///
/// Use: [`Radau::new`], [`Radau::restart`], then [`Radau::step`] as often as wanted; after each step
/// the motion in it is [`Radau::dense`]. After an event [`Radau::step_exactly`] takes the same step
/// again up to the event, and [`Radau::restart`] goes on from the state behind it.
#[derive(Debug, Clone)]
pub struct Radau<const S: usize, F: Size> {
    control: Control<F>,
    controller: Controller,
    newton: Newton<S, F>,
    /// Where M, C and K were evaluated, if that is not to be done again.
    linearization: Option<Linearized>,
    /// Proposed length of the next step; `None` after a restart.
    proposal: Option<f64>,
    start: State<F>,
    end: State<F>,
    lost_at_start: Lost<F>,
    lost: Lost<F>,
    stages: Stages<S, F>,
    /// Motion in the last step; `None` after a restart.
    dense: Kept<Dense<S, F>>,
    /// It as accurate as the ends, and whether that was looked for and found.
    refined: Refined<F>,
    is_refined: Cached,
    /// Components that the last step did not resolve.
    unresolved: F::List<bool>,
    /// How much of the error of each coordinate counts.
    controlled: F::Vector,
    /// Room for the motion to first order.
    uniform: Series<F>,
    counters: Counters,
}

persist!([const S: usize, F: Size] Radau<S, F> {
    controller, newton, linearization, proposal, start, end, lost_at_start, lost, stages, dense, unresolved, controlled, counters,
    is_refined
} but { control, uniform, refined });

/// What was found and can be found again: a run that goes on from a checkpoint does so.
#[derive(Debug, Clone)]
struct Cached(Option<bool>);

impl Persist for Cached {
    fn persist(&mut self, _: &mut Memory) -> Option<()> {
        self.0 = None;
        Some(())
    }
}

impl Blank for Linearized {
    fn blank() -> Self {
        Linearized::Now
    }
}

impl Persist for Linearized {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        memory.one_of(self, &[Linearized::Now, Linearized::Before])
    }
}

impl<const S: usize, F: Size> Radau<S, F>
where
    RadauIia<S>: Coefficients<S>,
{
    /// An integrator at rest at zero; call [`Radau::restart`] before the first step.
    pub fn new(tolerances: &Tolerances<F>) -> Self {
        let size = tolerances.size();
        Radau {
            control: Control::new::<S>(tolerances),
            controller: Controller::new(),
            newton: Newton::new(size),
            linearization: None,
            proposal: None,
            start: State::origin(size),
            end: State::origin(size),
            lost_at_start: Lost::nothing(size),
            lost: Lost::nothing(size),
            stages: Stages::zeros(size),
            dense: Kept::nothing(Dense::zero(size)),
            refined: Refined::nothing(size),
            is_refined: Cached(None),
            unresolved: size.list(false),
            controlled: size.repeat(1.0),
            uniform: Series::zero(size),
            counters: Counters::default(),
        }
    }

    /// Takes other absolute tolerances, before a [`Radau::restart`].
    pub(crate) fn set_tolerances(&mut self, of: impl FnOnce(F) -> Tolerances<F>) {
        self.control = Control::new::<S>(&of(self.end.q.size()));
    }

    /// The motion from the end of the last step to first order: what moves faster has an error that limits the step.
    pub(super) fn uniform_motion(&mut self) -> &Series<F> {
        let (State { q, v, .. }, series) = (&self.end, &mut self.uniform);
        for i in 0..q.size().get() {
            (series.q[0][i], series.v[0][i], series.q[1][i]) = (q[i], v[i], v[i]);
        }
        series
    }

    /// Goes on from a state that the last step did not lead to: the initial state, or that behind an
    /// event. `a` are the accelerations at the state, r(t, q, v, a) = 0. The equations may be
    /// others than before. The length of the first step is estimated, unless
    /// [`Radau::suggest`] is called.
    pub fn restart(&mut self, t: f64, q: &F::Vector, v: &F::Vector, a: &F::Vector) {
        let size = q.size();
        self.end = State {
            t,
            q: q.clone(),
            v: v.clone(),
            a: a.clone(),
        };
        self.start = self.end.clone();
        self.lost = Lost::nothing(size);
        self.lost_at_start = self.lost.clone();
        self.controller = Controller::new();
        self.newton.forget();
        self.linearization = None;
        self.proposal = None;
        self.dense.clear();
        self.unresolved = size.list(false);
        self.controlled = size.repeat(1.0);
    }

    /// As [`super::OneStep::control`].
    pub fn control(&mut self, part: &F::Vector) {
        self.controlled.clone_from(part);
    }

    /// Whether all of the errors of all coordinates counts.
    pub fn controls_all(&self) -> bool {
        self.controlled.as_slice().iter().all(|&part| part == 1.0)
    }

    /// Goes on from a state close to the one that the last step led to, at its time.
    pub fn correct(&mut self, q: &F::Vector, v: &F::Vector, a: &F::Vector) {
        let State { t, .. } = self.end;
        let [q, v, a] = [q, v, a].map(Clone::clone);
        let lost = self.lost.t;
        self.end = State { t, q, v, a };
        self.lost = Lost::nothing(self.end.size());
        self.lost.t = lost;
    }

    /// Sets the length with which the next step is tried, s; positive.
    pub fn suggest(&mut self, h: f64) {
        self.proposal = Some(h);
    }

    /// Length with which the next step would be tried, s; `None` if it is to be estimated.
    pub fn proposal(&self) -> Option<f64> {
        self.proposal
    }

    /// The state the last step started from.
    pub fn start(&self) -> &State<F> {
        &self.start
    }

    /// Time to which the last step led, s.
    pub fn end(&self) -> f64 {
        self.end.t
    }

    /// The state the last step led to (or the restart set).
    pub fn state(&self) -> &State<F> {
        &self.end
    }

    /// The motion within the last step; `None` after a restart.
    pub fn dense(&self) -> Option<&Dense<S, F>> {
        self.dense.get()
    }

    /// The same as accurate as the ends of the step, where the equations are not stiff; else the dense output.
    ///
    /// # Panics
    /// If no step was made.
    pub(super) fn path<Y: System<F>>(&mut self, system: &mut Y) -> &dyn Path<F> {
        let dense = self.dense.get().expect("a step was made");
        let start = &self.start;
        let refined = &mut self.refined;
        let is_refined = *self.is_refined.0.get_or_insert_with(|| {
            let weights = self.control.weights(&start.q, &start.v, &self.controlled);
            let (end, _) = ended(start, &self.lost_at_start, &self.stages, dense.t_end);
            (0..start.size().get()).all(|i| !self.unresolved[i])
                && refined.refine(system, [start, &end], dense, &weights)
        });
        match is_refined {
            true => refined,
            false => dense,
        }
    }

    /// The stages of the last step, in the order of time; the last is its end. Meaningless after a
    /// restart or a failure.
    pub fn stages(&self) -> impl Iterator<Item = Node<F>> {
        let tableau = RadauIia::<S>::TABLEAU;
        let h = self.dense.get().map_or(0.0, |dense| dense.h);
        (0..S).map(move |i| Node {
            weight: h * tableau.a[S - 1][i],
            state: State {
                t: self.start.t + tableau.c[i] * h,
                q: self.stages.q[i].clone(),
                v: self.stages.v[i].clone(),
                a: self.stages.a[i].clone(),
            },
        })
    }

    /// Tolerance of the error estimate ÷ tolerance asked for: the dense output, of a lower order than
    /// the steps but a higher one than the estimate, may err by so much in units of the latter.
    pub fn looseness(&self) -> f64 {
        self.control.loosening
    }

    /// Work done since construction, or since it was last taken.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Work done since it was last taken.
    pub fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }

    /// Makes one step with error control, not beyond `t_end` and not longer than `h_max` (∞ where
    /// nothing limits it). Attempts that fail are repeated with shorter lengths. A step that could
    /// reach `t_end` ends there exactly; if two are needed they have equal lengths.
    ///
    /// The dense output of a component is the collocation polynomial where stiffness alone made the
    /// step acceptable: where its unfiltered estimate exceeds the tolerance and the filter more
    /// than halved it. There the accelerations at the step's start belong to a transient that the
    /// step does not resolve.
    ///
    /// # Errors
    /// [`StepError`] when no step, however short, succeeds. State and dense output remain those of
    /// the step before.
    ///
    /// # Panics
    /// If `t_end` is not after the present time, or `h_max` is not positive.
    pub fn step<Y: System<F>>(
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
        if let (None, Some(what)) = (self.dense.get(), self.end.not_finite()) {
            return Err(StepError::NonFinite {
                t: self.end.t,
                h: 0.0,
                what,
            });
        }
        let origin = self.end.clone();
        let weights = self.control.weights(&origin.q, &origin.v, &self.controlled);
        let keep = system.is_linear() || self.newton.rate <= REUSE;
        self.linearization = match self.linearization {
            Some(_) if keep => Some(Linearized::Before),
            _ => None,
        };
        let remaining = (t_end - origin.t) - self.lost.t;
        let (mut h, mut is_near_end) = match self.proposal {
            Some(h) => (h, false),
            None => {
                if self.linearization.is_none() {
                    self.linearize(system, &origin);
                }
                let most = h_max.min(remaining);
                let Radau {
                    control,
                    newton,
                    counters,
                    ..
                } = self;
                let (h, is_most) = first_step::estimate(
                    system, &origin, most, control, &weights, newton, counters,
                );
                (h, is_most && remaining <= h_max)
            }
        };
        let proposed = h;
        let mut discarded = 0;
        loop {
            let free = h.min(h_max);
            h = fit(h, remaining, h_max);
            is_near_end |= h == remaining || h != free;
            let end = match h == remaining {
                true => (t_end, 0.0),
                false => add(origin.t, h, self.lost.t),
            };
            match self.trial(system, &origin, (h, end.0), &weights) {
                Ok(Trial { error, iterations }) => {
                    self.accept(&origin, self.lost.clone(), h, end);
                    let rate = if iterations > 1 {
                        self.newton.rate
                    } else {
                        0.0
                    };
                    let pace = Pace {
                        error,
                        effort: Newton::<S, F>::effort(iterations),
                        rate,
                    };
                    let next = self
                        .controller
                        .after_acceptance::<S>(h, &pace, discarded > 0);
                    // A step cut short by a limit says nothing against the longer one.
                    let cut = discarded == 0 && h < proposed;
                    self.proposal = Some(if cut { next.max(proposed) } else { next });
                    self.counters.steps += 1;
                    let report = self.report(error, iterations, discarded);
                    return Ok(StepReport {
                        is_near_end,
                        ..report
                    });
                }
                Err(failure) => {
                    discarded += 1;
                    self.discard(system, &origin, &failure);
                    h *= self.controller.after_failure::<S>(&failure);
                    if origin.t + h == origin.t {
                        return Err(failure);
                    }
                }
            }
        }
    }

    /// One attempt of length `h` to time `t_end` with its error estimate; an error above the tolerance is a failure.
    #[inline]
    fn trial<Y: System<F>>(
        &mut self,
        system: &mut Y,
        origin: &State<F>,
        (h, t_end): (f64, f64),
        weights: &Weights<F>,
    ) -> Result<Trial, StepError> {
        let t = origin.t;
        let limit = Newton::<S, F>::LIMIT;
        let iterations = self.attempt(system, origin, (h, t_end), weights, limit)?;
        let raw = Estimate::raw(h, origin, &self.stages);
        let filtered = raw.filtered(h, &self.newton);
        let error = filtered.method_error(&raw, h, &self.newton, weights, self.control.loosening);
        if error.is_nan() {
            return Err(StepError::NonFinite {
                t,
                h,
                what: "the error estimate",
            });
        }
        if error >= 1.0 {
            return Err(StepError::Tolerance { t, h, error });
        }
        for i in 0..origin.size().get() {
            let size = raw.size(i, weights);
            self.unresolved[i] = size > 1.0 && filtered.size(i, weights) < 0.5 * size;
        }
        Ok(Trial { error, iterations })
    }

    /// Counts a failed attempt and decides on the matrices for the next.
    #[cold]
    fn discard<Y: System<F>>(&mut self, system: &mut Y, origin: &State<F>, failure: &StepError) {
        let rejected = matches!(failure, StepError::Tolerance { .. });
        match rejected {
            true => self.counters.rejected += 1,
            false => self.counters.newton_failures += 1,
        }
        if system.is_linear() {
            return;
        }
        if !rejected {
            // The extrapolation that gave the last Jacobian is not to be trusted.
            self.linearize(system, origin);
        } else if self.linearization == Some(Linearized::Before) {
            self.linearization = None;
        }
    }

    /// Takes the last step again from its start, with exactly the length `h` and no error control:
    /// a state of full order where an event was located on the dense output, which serves for
    /// starting values. May be repeated. The proposal for the next step is kept. Right after a
    /// restart it makes the first step.
    ///
    /// # Errors
    /// [`StepError`] if the stage equations cannot be solved. State and dense output remain those of
    /// the step before.
    ///
    /// # Panics
    /// If `h` is not positive.
    pub fn step_exactly<Y: System<F>>(
        &mut self,
        system: &mut Y,
        h: f64,
    ) -> Result<StepReport, StepError> {
        assert!(h > 0.0, "h = {h} is not positive");
        let origin = self.start.clone();
        let weights = self.control.weights(&origin.q, &origin.v, &self.controlled);
        let end = add(origin.t, h, self.lost_at_start.t);
        let (step, limit) = ((h, end.0), Newton::<S, F>::PATIENCE);
        let mut solved = self.attempt(system, &origin, step, &weights, limit);
        if solved.is_err() && !system.is_linear() {
            self.linearize(system, &origin);
            solved = self.attempt(system, &origin, step, &weights, limit);
        }
        let iterations = solved?;
        self.accept(&origin, self.lost_at_start.clone(), h, end);
        self.counters.retaken += 1;
        Ok(self.report(f64::NAN, iterations, 0))
    }

    /// Evaluates M, C and K at `state`.
    #[inline]
    fn linearize<Y: System<F>>(&mut self, system: &mut Y, state: &State<F>) {
        self.newton.linearize(system, state, &mut self.counters);
        self.linearization = Some(Linearized::Now);
    }

    /// Solves the stage equations of a step of length `h` to time `t_end` in at most `limit`
    /// iterations; gives their number.
    #[inline]
    fn attempt<Y: System<F>>(
        &mut self,
        system: &mut Y,
        origin: &State<F>,
        (h, t_end): (f64, f64),
        weights: &Weights<F>,
        limit: u32,
    ) -> Result<u32, StepError> {
        let t = origin.t;
        let tableau = RadauIia::<S>::TABLEAU;
        // The stages of the last step are gone.
        self.is_refined.0.get_or_insert(false);
        match self.dense.get() {
            // The first iteration solves a linear system, wherever it starts from. Seven stages serve
            // tolerances at which rounding counts: there the correction is kept small.
            _ if S <= 5 && system.is_linear() => self.stages.coast(origin, h),
            // One stage: the polynomial passes through the end points, its second derivative says
            // nothing. Nor does that of a step that was taken again and is much shorter, up to an event: far beyond it is rounding alone.
            Some(dense) if S > 1 && h <= GROWTH * dense.h => {
                let offset = origin.t - dense.t0;
                for i in 0..S {
                    self.stages.a[i] = dense.acceleration(offset + tableau.c[i] * h);
                }
                self.stages.extend(origin, h);
            }
            _ => {
                self.stages.a.fill(origin.a.clone());
                self.stages.extend(origin, h);
            }
        }
        if self.linearization.is_none() {
            // At a stage inside, the matrices are closer to those at all stages than at the start.
            self.linearize(system, &self.stages.state(S / 2, t, h));
        }
        if let Err(singular) =
            self.newton
                .factorize(h, self.control.row_scale(), &mut self.counters)
        {
            return Err(match self.newton.matrices.is_finite() {
                true => StepError::Singular {
                    t,
                    h,
                    coordinate: singular.coordinate,
                },
                false => StepError::NonFinite {
                    t,
                    h,
                    what: "the Jacobian",
                },
            });
        }
        let Radau {
            newton,
            stages,
            control,
            counters,
            ..
        } = self;
        let tolerance = control.newton;
        match newton.solve(
            system,
            origin,
            (h, t_end),
            stages,
            weights,
            tolerance,
            limit,
            counters,
        ) {
            Outcome::Converged { iterations } => Ok(iterations),
            Outcome::Slow { rate } => Err(StepError::Newton { t, h, rate }),
            Outcome::NonFinite => Err(StepError::NonFinite {
                t,
                h,
                what: "the residual",
            }),
        }
    }

    /// Makes the solved stages the step from `origin`, which ends at `t`, rounded by `t_lost`.
    #[inline]
    fn accept(&mut self, origin: &State<F>, lost: Lost<F>, h: f64, (t, t_lost): (f64, f64)) {
        let (end, mut now_lost) = ended(origin, &lost, &self.stages, t);
        now_lost.t = t_lost;
        self.is_refined = Cached(None);
        self.start.clone_from(origin);
        self.end = end;
        self.lost_at_start = lost;
        self.lost = now_lost;
        let times = (origin.t, h, t);
        self.dense
            .write()
            .interpolate(times, origin, &self.stages.a, &self.unresolved);
    }

    fn report(&self, error: f64, iterations: u32, discarded: u32) -> StepReport {
        let (t_start, t_end) = (self.start.t, self.end.t);
        let h = self.dense.get().map_or(0.0, |dense| dense.h);
        StepReport {
            t_start,
            t_end,
            h,
            error,
            iterations,
            discarded,
            is_near_end: false,
        }
    }
}

/// The state at time `t`, s, that the stages of a step lead to from its start, and what is lost in rounding it.
#[inline(always)]
fn ended<const S: usize, F: Size>(
    start: &State<F>,
    lost: &Lost<F>,
    stages: &Stages<S, F>,
    t: f64,
) -> (State<F>, Lost<F>) {
    let mut end = State {
        a: stages.a[S - 1].clone(),
        t,
        ..start.clone()
    };
    let mut now_lost = Lost::nothing(start.size());
    for l in 0..start.size().get() {
        (end.q[l], now_lost.q[l]) = add(start.q[l], stages.q_change[l], lost.q[l]);
        (end.v[l], now_lost.v[l]) = add(start.v[l], stages.v_change[l], lost.v[l]);
    }
    (end, now_lost)
}
