//! From one event to the next: steps and crossings on their dense output, which observers look at.

use super::advance::MadeBy;
use super::contact::hold;
use super::crossing::{Cut, cut};
use super::doubt::Searched;
use super::equations::{Clock, Equations, Piece, free_of};
use super::failure::{Reason, Stoppable};
use super::guards::Conditions;
use super::inertia::vanished;
use super::instant::Instant;
use super::margins::Ended;
use super::observe::{Step, copy_drifting};
use super::problem::{Accuracy, Method};
use super::simulation::{Simulation, Stop, Violation};
use super::solvers::{Slots, SlotsOf, Solvers};
use crate::integrate::Size;
use crate::integrate::{
    Motion, Node, OneStep, Radau, SERIES, State, StepError, Taylor, Tolerances, determinant_sign,
    stages,
};
use crate::kernel::{Context, ModeKernel};
use crate::model::Mode;
use crate::numerics::copy_few;
use crate::run::Progress;
use std::ops::ControlFlow;

/// What does not change while a mode is followed.
struct Stay<'p, F: Size> {
    kernel: &'p ModeKernel<F>,
    mode: &'p Mode,
    /// Typical sizes of the free coordinates.
    scale: F::Vector,
    /// Whether some frozen coordinate drifts.
    drifts: bool,
    /// Whether the method follows from what is seen of the stiffness.
    chooses: bool,
    /// Whether something is evaluated at the end of every step with the inputs there; the explicit method
    /// goes on from them.
    looks_at_ends: bool,
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
            _ if self.is_explicit(kernel) => {
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

    /// Whether the present mode is followed by the Taylor method.
    pub fn is_explicit<F: Size>(&self, kernel: &ModeKernel<F>) -> bool {
        kernel.is_analytic()
            && match self.problem.method {
                Method::Taylor => true,
                Method::Radau => false,
                Method::Auto => !self.stiffness[self.here.mode].prefers_implicit(),
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
        let drifts = self.plan.drifts[self.here.mode];
        let stay = Stay {
            kernel,
            mode,
            scale: self.scale(kernel.size()),
            drifts,
            chooses: problem.method == Method::Auto && kernel.is_analytic(),
            looks_at_ends: is_explicit
                || drifts
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
                    if stay.chooses
                        && self.stiffness[self.here.mode].prefers_implicit() == is_explicit
                    {
                        return Ok(Stop::Fired);
                    }
                }
                stop => return Ok(stop),
            }
        }
    }

    /// Integrates until something happens, from the start of a segment, or from where it `goes_on` after a pause.
    fn follow<F: Size, M>(
        &mut self,
        stay: &Stay<F>,
        method: &mut M,
        goes_on: bool,
        progress: &mut dyn Progress,
    ) -> Stoppable<Stop>
    where
        M: for<'a> OneStep<F, Equations<'a, F>>,
    {
        let &Stay {
            kernel,
            mode,
            drifts,
            chooses,
            looks_at_ends,
            ..
        } = stay;
        let problem = self.problem;
        let is_explicit = <M as OneStep<F, Equations<F>>>::EXPLICIT;
        if !goes_on {
            self.began = self.here.now;
            if drifts {
                copy_few(&self.here.q, &mut self.at_start);
            }
        }
        let (start, last) = (self.began, self.smooth_until);
        let until = Instant::new(last).since(start);
        let clock = Clock {
            start,
            signals: &self.signals,
            until: (until, last),
            held: &self.at_start,
            drift: if drifts { &self.drift } else { &[] },
        };
        let mut equations = Equations::new(
            kernel,
            &mut self.context,
            clock,
            problem.accuracy.relative,
            stay.scale.clone(),
            self.foresees,
            self.piece,
        );
        let watched = &self.plan.watched[self.here.mode];
        let mut conditions = Conditions {
            modes: self.modes,
            plan: &self.plan,
            next: &mut self.next,
        };
        let mass_changes = !kernel.mass_is_constant();
        let began = match goes_on {
            true => self.pause.began(kernel.size(), &mode.free),
            false => method.state().clone(),
        };
        if goes_on {
            equations.at(method.end());
        }
        let determinant = match mass_changes {
            true => determinant_sign(&kernel.system(equations.context, &began.q, &began.v).mass),
            false => 1,
        };
        let vanished = |context: &Context, now: &State<F>| {
            let states = [&began, now].map(|state| [&state.q, &state.v]);
            vanished(kernel, context, (problem, mode), states)
        };
        let watches = self.margins.watches(mode);
        let stiffness = &mut self.stiffness[self.here.mode];
        if (chooses || is_explicit) && !goes_on {
            stiffness.begin();
        }
        // The end of the step, or of what its first event leaves of it.
        let mut state = State::origin(kernel.size());
        if !goes_on {
            self.observers.enter(mode, &self.here);
        }

        loop {
            if let Err(error) = method.step(&mut equations, until) {
                if chooses && is_explicit {
                    // What no series reaches the other method may.
                    stiffness.explicit_failure();
                    return Ok(Stop::Method);
                }
                let mass = vanished(equations.context, method.state()).filter(|_| mass_changes);
                if let Some(reason) = mass {
                    return Err(Box::new(reason));
                }
                // Rates that are too fast, and not a mass that goes to zero, where they grow as well.
                if is_explicit && matches!(error, StepError::NonFinite { what: SERIES, .. }) {
                    let mode = mode.name;
                    return Err(Box::new(Reason::SeriesOverflows { mode }));
                }
                return Err(error.into());
            }

            let made = method.end() - method.start().t;
            let mut found = cut(
                method,
                &mut equations,
                &mut conditions,
                (mode, watched),
                (&mut self.signs, &mut state),
            )?;
            if let Some(what) = state.not_finite() {
                return Err(Box::new(Reason::NotFinite { what }));
            }
            if is_explicit && matches!(found, Cut::Event { .. }) {
                let h = method.dense().expect("a step was made").length();
                let rate = || {
                    equations.at(state.t);
                    equations.decay_rate(free_of(&state))
                };
                let outlasts = stiffness.outlasts_decay(h, rate);
                let searched = Searched::of((self.here.mode, mode), watched, &self.signs, problem);
                let step = (&searched, outlasts);
                if let Some(doubt) =
                    (self.doubts).about_fall(step, method, &mut equations, &mut conditions)
                {
                    // Of a decay that is over the implicit method can tell.
                    if !(chooses && outlasts) {
                        self.doubts.uncertain.add(doubt);
                    }
                    if chooses {
                        stiffness.explicit_step_is_blind(h);
                        return Ok(Stop::Method);
                    }
                }
            }
            let mut ended = None;
            if watches && !(self.margins).hold_throughout(method, &mut equations, mode, state.t) {
                (found, ended) = self.margins.cut_where_reached(
                    method,
                    &mut equations,
                    &mut conditions,
                    (mode, watched, start),
                    (&mut self.signs, &mut state),
                    found,
                )?;
            }
            let (event, beyond) = match found {
                Cut::Nothing => (None, 0.0),
                Cut::Event { guard, beyond } => (Some(guard), beyond),
                Cut::Violated { guard } => {
                    return Ok(Stop::Violated(Violation { guard, rests: true }));
                }
            };
            let searched = Searched::of((self.here.mode, mode), watched, &self.signs, problem);
            self.doubts
                .look(&searched, method, &mut equations, &mut conditions);

            if mass_changes {
                equations.at(state.t);
                let mass = kernel.system(equations.context, &state.q, &state.v).mass;
                if determinant_sign(&mass) != determinant {
                    if let Some(reason) = vanished(equations.context, &state) {
                        return Err(Box::new(reason));
                    }
                    let mode = mode.name;
                    ended = Some(Ended::Unmet(Box::new(Reason::DeterminantChangesSign {
                        mode,
                    })));
                }
            }

            let end = method.end();
            let dense = method.dense().expect("a step was made");
            let length = dense.length();

            let mut work = None;
            if <M as OneStep<F, Equations<F>>>::HAS_QUADRATURE
                && kernel.size().get() > 0
                && self.observers.ledger.is_some()
            {
                let mut sum = [0.0; 2];
                let mut add = |powers: [f64; 2], weight: f64| {
                    sum = [0, 1].map(|i| sum[i] + powers[i] * weight);
                };
                for Node { weight, state } in method.nodes() {
                    equations.at(state.t);
                    add(kernel.powers(equations.context, free_of(&state)), weight);
                }
                if beyond != 0.0 {
                    equations.at(state.t);
                    add(kernel.powers(equations.context, free_of(&state)), beyond);
                }
                work = Some(sum);
            }
            let cut = self.observers.step(Step {
                equations: &mut equations,
                motion: dense,
                mode,
                here: &mut self.here,
                end,
                beyond,
                work,
            });
            if let ControlFlow::Break(t) = cut {
                // The state is that of the sample.
                self.here.now = Instant::new(t);
                return Err(Box::new(Reason::Interrupted));
            }

            if looks_at_ends {
                equations.at(state.t);
            }
            if let (Some(contacts), None) = (&mode.contacts, event) {
                let State { q, v, a, .. } = &mut state;
                hold(kernel, equations.context, contacts, [q, v]);
                let held = equations.acceleration_here(q, v);
                *a = held.map_err(|s| Box::new(Reason::singular(mode, &problem.model, s)))?;
                method.correct(q, v, a);
            }
            let at = free_of(&state);

            self.here.now = start.plus(state.t);
            self.here
                .set_free(&mode.free, [&state.q, &state.v, &state.a]);
            if drifts {
                copy_drifting(&mut self.here.q, &mode.drifts, equations.context.held());
            }

            let mut flow = ControlFlow::Continue(());
            if problem.record.every.is_none() {
                flow = self
                    .observers
                    .sample_end(&equations, (mode, &self.here), at);
            }
            if event.is_some() {
                self.observers.jump(&self.here, [&[], &[]], None);
            }
            match ended {
                Some(Ended::Unmet(reason)) => return Err(reason),
                Some(Ended::Limit) => return Ok(Stop::End),
                None => {}
            }
            let heard = progress.advance(self.here.now.seconds(), self.here.j);
            if heard.is_break() || flow.is_break() {
                return Err(Box::new(Reason::Interrupted));
            }

            let h = end - method.start().t;
            let unseen = event.is_some() && self.signs.unseen();
            if is_explicit && (event.is_none() || unseen) {
                let h = if unseen { length } else { h };
                let rate = || equations.decay_rate(at);
                if chooses {
                    stiffness.explicit_step(h, |least| method.lag(&equations, least), rate);
                } else {
                    let left = problem.end.time - self.here.now.seconds();
                    if let Some(rate) = stiffness.explicit_step_alone(h, left, rate) {
                        let mode = mode.name;
                        let (steps, step) = (left / h, h);
                        return Err(Box::new(Reason::Stiff {
                            mode,
                            rate,
                            step,
                            steps,
                        }));
                    }
                }
                if unseen {
                    stiffness.go_on();
                }
            }
            if let Some(guard) = event {
                if chooses && !is_explicit {
                    stiffness.implicit_step(h);
                }
                return Ok(Stop::Event(guard));
            }
            self.signs.go_on();
            if chooses && !is_explicit {
                // A cut where nothing falls after all says nothing against the step that was made.
                stiffness.implicit_step(made);
            }
            if end >= until {
                self.here.now = Instant::new(last);
                if last >= problem.end.time {
                    return Ok(Stop::End);
                }
                let breaks = last < self.pause.knot
                    || clock.signals.next_breakpoint(start.seconds()) <= last;
                if breaks {
                    return Ok(Stop::Breakpoint);
                }
            }
            if chooses && stiffness.prefers_implicit() == is_explicit {
                return Ok(Stop::Method);
            }
            if self.here.now.seconds() >= self.pause.at {
                self.pause.keep_start(&mode.free, &began);
                return Ok(Stop::Pause);
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
