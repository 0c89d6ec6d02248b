//! The life of a step: made, cut at its first event, seen by observers.

use super::contact::{Conditioning, hold};
use super::crossing::{Cut, cut};
use super::doubt::Searched;
use super::equations::{Clock, Equations, free_of};
use super::failure::{Reason, Stoppable};
use super::guards::Conditions;
use super::inertia::{VANISHED, VANISHES, vanished};
use super::instant::Instant;
use super::margins::Ended;
use super::observe::Step;
use super::segment::Stay;
use super::simulation::{Simulation, Stop, Violation};
use crate::integrate::{Motion, Node, OneStep, SERIES, Size, State, StepError};
use crate::kernel::Context;
use crate::model::Mode;
use crate::numerics::Vector;
use crate::run::Progress;
use std::ops::ControlFlow;

/// Steps in a row that do not advance the time as a double, at most: from the shortest that an instant tells from none, 2⁻¹⁰⁶ of the time, they
/// grow to its last place in 54 doublings, by either method.
const MOST_IDLE: u32 = 2 * 54;

impl Simulation<'_> {
    /// Integrates until something happens, from the start of a segment, or from where it `goes_on` after a pause. The life of a
    /// step:
    ///
    /// 1. The method makes it, up to where inputs are not smooth, or fails.
    /// 2. It is cut at the first event of a guard (`crossing`).
    /// 3. An explicit method that cannot tell whether the guard falls says so, or hands over.
    /// 4. It is cut where a requirement does not hold, or a limit is reached (`margins`).
    /// 5. What its errors leave open is noted (`doubt`).
    /// 6. A mass matrix that is no longer definite ends it.
    /// 7. Observers see it: its rows, extremes, energies (`observe`).
    /// 8. What contacts hold is held, and the end of it becomes the present state.
    /// 9. Observers see that, and progress hears of it.
    /// 10. The method learns how stiff the mode is (`stiffness`).
    /// 11. An event, a breakpoint, the end of the run, another method or a pause ends the segment.
    pub(super) fn follow<F: Size, M>(
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
            moves,
            chooses,
            looks_at_ends,
            ..
        } = stay;
        let problem = self.problem;
        let is_explicit = <M as OneStep<F, Equations<F>>>::EXPLICIT;
        if !goes_on {
            self.began = self.here.now;
            if moves {
                self.at_start.copy_from_slice(self.context.held());
            }
        }
        let (start, last) = (self.began, self.smooth_until);
        let until = Instant::new(last).since(start);
        let clock = Clock {
            start,
            signals: &self.signals,
            until: (until, last),
            commanded: match self.pause.knot < problem.end.time {
                true => Instant::new(self.pause.knot).since(start),
                false => f64::INFINITY,
            },
            held: &self.at_start,
            drift: if moves { &self.drift } else { &[] },
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
        let sign = |context: &Context, state: &State<F>| {
            let system = kernel.system(context, &state.q, &state.v);
            system.determinant_sign(&stay.scale)
        };
        let determinant = mass_changes
            .then(|| sign(equations.context, &began))
            .flatten();
        let vanished = |context: &Context, now: &State<F>, part: f64| {
            let states = [&began, now].map(|state| [&state.q, &state.v]);
            vanished(kernel, context, (problem, mode), (states, part))
        };
        let watches = self.margins.watches(mode);
        let stiffness = &mut self.stiffness[self.here.mode];
        if (chooses || is_explicit) && !goes_on {
            stiffness.begin();
        }
        // Whether steps pass a singular position without the forces of constraints.
        let mut passes = !method.controls_all();
        // The end of the step, or of what its first event leaves of it.
        let mut state = State::origin(kernel.size());
        if !goes_on {
            self.observers.enter(mode, &self.here);
        }
        // Steps in a row after which the time is the same double.
        let mut idle_steps = 0;

        loop {
            // 1. The step.
            let report = method.step(&mut equations, until);
            if report.is_ok_and(|report| report.is_near_end) && last >= problem.end.time {
                self.observers.recording.nears_end();
            }
            if let Err(error) = report {
                if chooses && is_explicit {
                    // What no series reaches the other method may.
                    stiffness.explicit_failure();
                    return Ok(Stop::Method);
                }
                let mass =
                    vanished(equations.context, method.state(), VANISHED).filter(|_| mass_changes);
                return Err(failure_of_step(error, mass, is_explicit.then_some(mode)));
            }

            // 2. The first event.
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
            // 3. Whether the method can tell.
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
                    (self.doubts).about_crossing(step, method, &mut equations, &mut conditions)
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
            // 4. Requirements and limits.
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
            // 5. Doubts.
            let searched = Searched::of((self.here.mode, mode), watched, &self.signs, problem);
            self.doubts
                .search_step(&searched, method, &mut equations, &mut conditions);

            // 6. The mass matrix.
            if mass_changes {
                equations.at(state.t);
                let changes = match (determinant, sign(equations.context, &state)) {
                    (Some(began), Some(now)) => now != began,
                    // Constraints may pass a singular position.
                    (Some(_), None) => mode.contacts.is_none(),
                    (None, _) => false,
                };
                if changes {
                    if let Some(reason) = vanished(equations.context, &state, VANISHED) {
                        return Err(Box::new(reason));
                    }
                    let mode = mode.name;
                    ended = Some(Ended::Unmet(Box::new(Reason::DeterminantChangesSign {
                        mode,
                    })));
                }
            }

            let end = method.end();
            let length = method.dense().expect("a step was made").length();

            // 7. Observers.
            let has_work = <M as OneStep<F, Equations<F>>>::HAS_QUADRATURE
                && kernel.size().get() > 0
                && self.observers.ledger.is_some();
            let work = has_work.then(|| work(method, &mut equations, (&state, beyond)));
            let path = match self.observers.look_within(&equations, end + beyond) {
                true => method.path(&mut equations),
                false => method.motion(),
            };
            let cut = self.observers.step(Step {
                equations: &mut equations,
                motion: path,
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

            // 8. The present state.
            if looks_at_ends {
                equations.at(state.t);
            }
            if let (Some(contacts), None) = (&mode.contacts, event) {
                let State { q, v, a, .. } = &mut state;
                let context = &mut *equations.context;
                hold(context, contacts, [q.as_mut_slice(), v.as_mut_slice()]);
                let here = Conditioning::new(context, contacts, [q.as_slice(), v.as_slice()]);
                let is_near = match &here {
                    Some(here) => here.is_nearly_singular(mode, &mut self.best_determined)?,
                    None => false,
                };
                if let Some(here) = here.filter(|_| is_near || passes) {
                    let before = method.start();
                    let state = [before.q.as_slice(), before.v.as_slice()];
                    // Over a pole the impulses have no value.
                    let leaves_out = passes && here.is_beyond(equations.context, contacts, state);
                    let mut controlled = kernel.size().repeat(1.0);
                    for i in contacts.constraints.iter().map(|c| c.multiplier) {
                        if leaves_out {
                            (q[i], v[i]) = (before.q[i], before.v[i]);
                        }
                        if is_near {
                            controlled[i] = 0.0;
                        }
                    }
                    method.control(&controlled);
                    passes = is_near;
                }
                let held = equations.acceleration_here(q, v);
                *a = held.map_err(|s| Box::new(Reason::singular(mode, &problem.model, s)))?;
                method.correct(q, v, a);
            }
            let at = free_of(&state);

            let advances = start.plus(state.t).seconds() > self.here.now.seconds();
            self.here.now = start.plus(state.t);
            self.here
                .set_free(&mode.free, [&state.q, &state.v, &state.a]);
            if moves {
                self.here.set_all(kernel, equations.context, at);
            }

            // 9. Observers of the state, and progress.
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

            // 10. Stiffness. Roundings that a singular position amplifies look like it.
            let h = end - method.start().t;
            let unseen = event.is_some() && self.signs.unseen();
            if is_explicit && !passes && (event.is_none() || unseen) {
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
            // 11. Whether the segment ends.
            if let Some(guard) = event {
                if chooses && !is_explicit {
                    stiffness.implicit_step(h);
                }
                return Ok(Stop::Event(guard));
            }
            idle_steps = if advances { 0 } else { idle_steps + 1 };
            if idle_steps > MOST_IDLE {
                let mass = vanished(equations.context, &state, VANISHES).filter(|_| mass_changes);
                return Err(Box::new(mass.unwrap_or_else(|| self.runaway())));
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
            if chooses && passes {
                // The explicit method passes: what slowed it down was the pole.
                stiffness.passes_pole();
            }
            if chooses && stiffness.prefers_implicit() == is_explicit {
                return Ok(Stop::Method);
            }
            let pauses = self.here.now.seconds() >= self.pause.at;
            if pauses || self.observers.recording.wants_checkpoint() {
                self.pause.keep_start(&mode.free, &began);
                return Ok(Stop::Pause);
            }
        }
    }
}

impl Simulation<'_> {
    /// Why steps do not advance the time any more.
    #[cold]
    fn runaway(&self) -> Reason {
        let mode = self.mode();
        let is_own = |i: &&usize| {
            mode.contacts
                .as_ref()
                .is_none_or(|of| !of.is_multiplier(**i))
        };
        let speed = |i: usize| self.here.v[i].abs() / self.rate_sizes[i];
        let own = mode.free.iter().filter(is_own);
        let fastest = own.max_by(|&&a, &&b| speed(a).total_cmp(&speed(b)));
        let fastest = *fastest.expect("what moves has a coordinate");
        Reason::Runaway {
            mode: mode.name,
            coordinate: self.problem.model.coordinates[fastest].name,
            rate: self.here.v[fastest],
        }
    }
}

/// Why a step of a mode could not be made, where its mass has not `vanished`; `explicit`: the mode, of the explicit method.
#[cold]
fn failure_of_step(
    error: StepError,
    vanished: Option<Reason>,
    explicit: Option<&Mode>,
) -> Box<Reason> {
    match (vanished, explicit, &error) {
        (Some(reason), ..) => Box::new(reason),
        // Rates that are too fast, and not a mass that goes to zero, where they grow as well.
        (None, Some(mode), StepError::NonFinite { what: SERIES, .. }) => {
            Box::new(Reason::SeriesOverflows { mode: mode.name })
        }
        _ => error.into(),
    }
}

/// [dissipated, input] energy of the last step (J) by the quadrature of its method, up to `beyond` (s) after its end, the state.
fn work<'a, F: Size, M: OneStep<F, Equations<'a, F>>>(
    method: &M,
    equations: &mut Equations<'a, F>,
    (end, beyond): (&State<F>, f64),
) -> [f64; 2] {
    let kernel = equations.kernel;
    let mut sum = [0.0; 2];
    let mut add = |powers: [f64; 2], weight: f64| {
        sum = [0, 1].map(|i| sum[i] + powers[i] * weight);
    };
    for Node { weight, state } in method.nodes() {
        equations.at(state.t);
        add(kernel.powers(equations.context, free_of(&state)), weight);
    }
    if beyond != 0.0 {
        equations.at(end.t);
        add(kernel.powers(equations.context, free_of(end)), beyond);
    }
    sum
}
