//! From one event to the next: by which method, and how often it is begun anew. `follow` has the steps.

use super::advance::MadeBy;
use super::equations::{Equations, Piece};
use super::failure::Stoppable;
use super::problem::{Accuracy, Method};
use super::simulation::{Simulation, Stop};
use super::solvers::{Slots, SlotsOf, Solvers};
use crate::integrate::{OneStep, Radau, Size, Taylor, Tolerances, stages};
use crate::kernel::{Context, ModeKernel};
use crate::model::Mode;
use crate::run::Progress;

/// What does not change while a mode is followed.
pub(super) struct Stay<'p, F: Size> {
    pub kernel: &'p ModeKernel<F>,
    pub mode: &'p Mode,
    /// Typical sizes of the free coordinates.
    pub scale: F::Vector,
    /// Whether something moves that the mode holds.
    pub moves: bool,
    /// Whether the method follows from what is seen of the stiffness.
    pub chooses: bool,
    /// Whether something is evaluated at the end of every step with the inputs there; the explicit method
    /// goes on from them.
    pub looks_at_ends: bool,
}

impl<'p> Simulation<'p> {
    /// Integrates the present mode until something happens; `stays`: not an event that leads to the same
    /// mode again.
    pub fn advance<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        stays: bool,
        progress: &mut dyn Progress,
    ) -> Stoppable<Stop>
    where
        Solvers: SlotsOf<F>,
    {
        let (problem, accuracy, mode) = (self.problem, self.accuracy, self.mode());
        // What follows an event of contacts is another set of their states.
        let stays = stays && mode.contacts.is_none();
        match stages(problem.accuracy.relative) {
            _ if self.is_explicit() => {
                self.made_by = MadeBy::Taylor;
                let make = |x: &Context| {
                    Taylor::new(
                        &tolerances(kernel.size(), accuracy, mode),
                        kernel.series_kind(x),
                    )
                };
                self.integrate(kernel, |slots| &mut slots.taylor, make, stays, progress)
            }
            5 => {
                self.made_by = MadeBy::RadauOfFive;
                let make = |_: &Context| Radau::new(&tolerances(kernel.size(), accuracy, mode));
                self.integrate(
                    kernel,
                    |slots| &mut slots.radau_of_five,
                    make,
                    stays,
                    progress,
                )
            }
            _ => {
                self.made_by = MadeBy::RadauOfSeven;
                let make = |_: &Context| Radau::new(&tolerances(kernel.size(), accuracy, mode));
                self.integrate(
                    kernel,
                    |slots| &mut slots.radau_of_seven,
                    make,
                    stays,
                    progress,
                )
            }
        }
    }

    /// Whether the present mode is followed by the Taylor method: by choice, or since the implicit one does not resolve its hops.
    pub fn is_explicit(&self) -> bool {
        let prefers_implicit = self.stiffness[self.here.mode].prefers_implicit();
        match self.problem.method {
            Method::Taylor => true,
            // Its polynomials have the rounding of coordinates, a series that of what has moved since the last event.
            Method::Radau => self.accumulation.needs_series() && !prefers_implicit,
            Method::Auto => !prefers_implicit,
        }
    }

    /// Takes the method of the present mode out of its slot, or makes it; follows the motion, and puts it back.
    #[inline(always)]
    fn integrate<F: Size, M>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        slots: impl Fn(&mut Slots<F>) -> &mut [Option<Box<M>>],
        make: impl Fn(&Context) -> M,
        stays: bool,
        progress: &mut dyn Progress,
    ) -> Stoppable<Stop>
    where
        M: for<'a> OneStep<F, Equations<'a, F>>,
        Solvers: SlotsOf<F>,
    {
        let mode = self.here.mode;
        let mut method = match slots(self.solvers.slots())[mode].take() {
            Some(method) => method,
            None => self.begin_with(make(&self.context)),
        };
        let stop = self.stay(kernel, &mut *method, stays, progress);
        slots(self.solvers.slots())[mode] = Some(method);
        stop
    }

    /// Notes the name of a new method.
    #[cold]
    fn begin_with<F: Size, M>(&mut self, method: M) -> Box<M>
    where
        M: for<'a> OneStep<F, Equations<'a, F>>,
    {
        let name = method.name();
        if !self.methods.contains(&name) {
            self.methods.push(name);
        }
        Box::new(method)
    }

    /// Follows the motion from event to event, as long as they lead to the same mode again and it `stays`
    /// there.
    fn stay<F: Size, M>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        method: &mut M,
        stays: bool,
        progress: &mut dyn Progress,
    ) -> Stoppable<Stop>
    where
        M: for<'a> OneStep<F, Equations<'a, F>>,
    {
        let (problem, mode) = (self.problem, self.mode());
        let is_explicit = <M as OneStep<F, Equations<F>>>::EXPLICIT;
        let moves = self.plan.moves[self.here.mode];
        let stay = Stay {
            kernel,
            mode,
            scale: self.scale(kernel.size()),
            moves,
            chooses: problem.method == Method::Auto || self.accumulation.needs_series(),
            looks_at_ends: is_explicit
                || moves
                || mode.contacts.is_some()
                || !mode.requirements.is_empty()
                || !kernel.mass_is_constant()
                || problem.record.every.is_none()
                || self.observers.watch_steps(),
        };
        let needs_accelerations =
            <M as OneStep<F, Equations<F>>>::NEEDS_ACCELERATIONS || !kernel.inertia_is_fixed();
        let mut has_accelerations = true;
        let mut goes_on = self.stage.is_in_segment();
        loop {
            if !goes_on {
                let [q, v, a] = self.here.free(kernel.size(), &mode.free);
                method.restart(0.0, &q, &v, has_accelerations.then_some(&a));
                method.foresee(self.accumulation.foreseen());
            }
            let now = self.here.now.seconds();
            if now >= self.smooth_until {
                let breakpoint = self.signals.next_breakpoint(now);
                let end = problem.end.time.min(self.pause.knot);
                self.smooth_until = breakpoint.min(end);
                self.piece = match self.signals.next_knot(now) == f64::INFINITY {
                    true => Piece::ENDLESS,
                    false => Piece::UNKNOWN,
                };
            }
            match self.follow(&stay, method, std::mem::take(&mut goes_on), progress)? {
                Stop::Event(guard) if stays => {
                    if !self.fire_and_stay(kernel, guard, needs_accelerations)? {
                        return Ok(Stop::Fired);
                    }
                    has_accelerations = needs_accelerations;
                    let changes = stay.chooses
                        && self.stiffness[self.here.mode].prefers_implicit() == is_explicit;
                    if changes || self.observers.recording.wants_checkpoint() {
                        return Ok(Stop::Fired);
                    }
                }
                stop => return Ok(stop),
            }
        }
    }
}

/// Tolerances of the free coordinates of a mode.
pub(super) fn tolerances<F: Size>(size: F, accuracy: &Accuracy, mode: &Mode) -> Tolerances<F> {
    let pick = |full: &[f64]| size.vector(|i| full[mode.free[i]]);
    Tolerances::new(
        accuracy.relative,
        pick(&accuracy.q_absolute),
        pick(&accuracy.v_absolute),
    )
    .expect("a problem's tolerances are positive")
}
