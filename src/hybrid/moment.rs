//! A run at an instant: state, and what follows from it.

use super::advance::MadeBy;
use super::equations::{Clock, Equations};
use super::guards::motion;
use super::instant::Instant;
use super::observe::held;
use super::outputs::Outputs;
use super::problem::Problem;
use super::simulation::Simulation;
use super::solvers::{SlotsOf, Solvers};
use crate::integrate::{OneStep, Path};
use crate::kernel::{Context, Free, ModeKernel, with_kernel};
use crate::model::name::intern;
use crate::model::{Mode, Model};
use crate::numerics::Size;
use crate::numerics::Vector;

/// A time at which the motion is not known: it is before the last step that was made, or after the present time.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the motion at {asked} s is not at hand: it is from {from} s to {to} s; advance to a later time before, or let an observer see every step"
)]
pub struct NotComputed {
    /// The time that was asked for, s.
    pub asked: f64,
    /// The first that is known, s.
    pub from: f64,
    /// The last that is known, s.
    pub to: f64,
}

/// State at a time, in room that is made once.
#[derive(Debug)]
pub(super) struct View {
    pub t: f64,
    pub q: Box<[f64]>,
    pub v: Box<[f64]>,
    pub a: Box<[f64]>,
}

impl View {
    /// With so many coordinates.
    pub fn new(coordinates: usize) -> Self {
        let zeros = || vec![0.0; coordinates].into();
        View {
            t: 0.0,
            q: zeros(),
            v: zeros(),
            a: zeros(),
        }
    }
}

/// A run at an instant: see [`super::Simulator::at`].
#[derive(Debug)]
pub struct Moment<'s> {
    model: &'s Model,
    problem: &'s Problem,
    mode: &'s Mode,
    context: &'s Context,
    view: &'s View,
}

impl<'s> Moment<'s> {
    pub(super) fn new(simulation: &'s Simulation, view: &'s View) -> Self {
        Moment {
            model: &simulation.problem.model,
            problem: simulation.problem,
            mode: simulation.mode(),
            context: &simulation.context,
            view,
        }
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.view.t
    }

    /// Name of the mode; where contacts make it, of the set of their states: `left sticks, right open`, with a mode by
    /// hand before them.
    pub fn mode(&self) -> &'static str {
        match &self.mode.contacts {
            Some(contacts) => {
                let set = contacts.sets().name(contacts.set(self.discrete()));
                match self.problem.variant().modes.len() {
                    1 => intern(&set),
                    _ => intern(&format!("{}, {set}", self.mode.name)),
                }
            }
            None => self.mode.name,
        }
    }

    /// All coordinates, in their units.
    pub fn q(&self) -> &'s [f64] {
        &self.view.q
    }

    /// All velocities, in the units of the coordinates over s.
    pub fn v(&self) -> &'s [f64] {
        &self.view.v
    }

    /// All accelerations, from the equations of motion, in the units of the coordinates over s²; 0 where the mode holds a
    /// coordinate, NaN where the mass matrix is singular.
    pub fn a(&self) -> &'s [f64] {
        &self.view.a
    }

    /// All discrete states.
    pub fn discrete(&self) -> &'s [f64] {
        self.context.discrete()
    }

    /// A coordinate (`theta`), a rate (`theta.rate`) or a discrete state, by its name.
    pub fn state(&self, name: &str) -> Option<f64> {
        let coordinate = |name: &str| self.model.coordinate(name);
        let rate = name.strip_suffix(".rate").and_then(coordinate);
        let discrete = || self.model.discretes.iter().position(|d| d.name == name);
        rate.map(|i| self.view.v[i])
            .or_else(|| coordinate(name).map(|i| self.view.q[i]))
            .or_else(|| discrete().map(|i| self.discrete()[i]))
    }

    /// Value of an input by its name, in its unit; at a breakpoint as it goes on.
    pub fn input(&self, name: &str) -> Option<f64> {
        let input = self.model.inputs.iter().find(|i| i.name == name)?;
        Some(self.context.signals()[input.signal])
    }

    /// Writes all reactions: of the coordinates, 0 where one is free, then of the motions of the ground, in the order of
    /// the model.
    ///
    /// # Panics
    /// If `out` has another length.
    pub fn reactions(&self, out: &mut [f64]) {
        with_kernel!(&self.mode.kernels, k => self.with(k.size(), |at| k.reactions(self.context, at, out)));
    }

    /// All outputs in their units: those of the model, then those of the problem ([`Problem::output_quantities`]).
    pub fn outputs(&self) -> Vec<f64> {
        let mut outputs = Outputs::new(self.problem);
        let mut values = vec![0.0; outputs.count()];
        with_kernel!(&self.mode.kernels, k => self.with(k.size(), |at| {
            outputs.evaluate(k, self.context, at, &mut values);
        }));
        values
    }

    /// Value of an output by its name, in its unit.
    pub fn output(&self, name: &str) -> Option<f64> {
        let index = self.problem.output(name).ok()?;
        Some(self.outputs()[index])
    }

    /// Kinetic and potential energy, J.
    pub fn energies(&self) -> [f64; 2] {
        with_kernel!(&self.mode.kernels, k => self.with(k.size(), |at| k.energies(self.context, at)))
    }

    /// Value of a guard of the present mode by its name, in its unit: positive where the mode is admissible.
    pub fn guard(&self, name: &str) -> Option<f64> {
        let guard = self.mode.guards.iter().find(|guard| guard.name == name)?;
        Some(with_kernel!(&self.mode.kernels, k => {
            self.with(k.size(), |at| k.guard(self.context, &guard.kernel, at))
        }))
    }

    /// Does something with the free coordinates.
    fn with<F: Size, R>(&self, size: F, evaluate: impl FnOnce(Free<F>) -> R) -> R {
        let gather = |full: &[f64]| size.vector(|i| full[self.mode.free[i]]);
        let [q, v, a] = [&self.view.q, &self.view.v, &self.view.a].map(|full| gather(full));
        evaluate(Free {
            q: &q,
            v: &v,
            a: &a,
        })
    }
}

impl<'p> Simulation<'p> {
    /// Evaluates the run at time `t`, s: at the present time, or within the last step. Leaves the context set to it.
    pub fn evaluate_at(&mut self, t: f64, view: &mut View) -> Result<(), NotComputed> {
        let mode = self.mode();
        with_kernel!(&mode.kernels, k => self.evaluate_by(k, t, view))
    }

    fn evaluate_by<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        t: f64,
        view: &mut View,
    ) -> Result<(), NotComputed>
    where
        Solvers: SlotsOf<F>,
    {
        let (mode, index) = (self.mode(), self.here.mode);
        let now = self.here.now.seconds();
        view.q.copy_from_slice(&self.here.q);
        view.v.copy_from_slice(&self.here.v);
        view.a.fill(0.0);
        view.t = t;
        let moves = self.plan.moves[index];
        if t == now {
            self.set_context();
            let [q, v, _] = self.here.free(kernel.size(), &mode.free);
            let system = kernel.system(&self.context, &q, &v);
            let a = system.accelerations(&self.scale(kernel.size()));
            let a = a.unwrap_or_else(|_| kernel.size().repeat(f64::NAN));
            (mode.free.iter().zip(a.as_slice())).for_each(|(&full, &a)| view.a[full] = a);
            if moves {
                let at = Free {
                    q: &q,
                    v: &v,
                    a: &a,
                };
                kernel.accelerations(&self.context, at, &mut view.a);
            }
            return Ok(());
        }
        let scale = self.scale(kernel.size());
        let is_after_step = self.stage.is_after_step();
        if !moves {
            self.context.hold(&self.here.q);
        }
        let mut equations = Equations::new(
            kernel,
            &mut self.context,
            Clock {
                start: self.began,
                signals: &self.signals,
                // Before the end of the step no input breaks.
                until: (f64::INFINITY, f64::INFINITY),
                commanded: f64::INFINITY,
                held: &self.at_start,
                drift: if moves { &self.drift } else { &[] },
            },
            self.problem.accuracy.relative,
            scale,
            self.foresees,
            self.piece,
        );
        let to = self.here.now.since(self.began);
        let slots = self.solvers.slots();
        let path: Option<&dyn Path<F>> = match self.made_by {
            _ if !is_after_step => None,
            MadeBy::Taylor => path_of(&mut slots.taylor[index], &mut equations),
            MadeBy::RadauOfFive => path_of(&mut slots.radau_of_five[index], &mut equations),
            MadeBy::RadauOfSeven => path_of(&mut slots.radau_of_seven[index], &mut equations),
        };
        let found = match is_after_step {
            true => within(&mut equations, path, to, t),
            false => Err(now),
        };
        let [q, v, a] = found.map_err(|from| NotComputed {
            asked: t,
            from,
            to: now,
        })?;
        let [q, v, a] = match &mode.contacts {
            Some(contacts) => {
                let tau = Instant::new(t).since(equations.clock.start);
                held(&mut equations, contacts, tau, [q, v, a])
            }
            None => [q, v, a],
        };
        for (i, &full) in mode.free.iter().enumerate() {
            (view.q[full], view.v[full], view.a[full]) = (q[i], v[i], a[i]);
        }
        if moves {
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            kernel.coordinates(equations.context, at, &mut view.q);
            kernel.rates(equations.context, at, &mut view.v);
            kernel.accelerations(equations.context, at, &mut view.a);
        }
        Ok(())
    }
}

/// The motion in the last step of a method, if it has made one.
fn path_of<'m, 'a, F: Size, M: OneStep<F, Equations<'a, F>>>(
    method: &'m mut Option<Box<M>>,
    equations: &mut Equations<'a, F>,
) -> Option<&'m dyn Path<F>> {
    let method = method.as_deref_mut()?;
    method.dense()?;
    Some(method.path(equations))
}

/// The motion at time `t`, s, if it is within a step that ends at local time `to`; else when that begins, s.
fn within<F: Size>(
    equations: &mut Equations<F>,
    path: Option<&dyn Path<F>>,
    to: f64,
    t: f64,
) -> Result<[F::Vector; 3], f64> {
    let began = equations.clock.start;
    let seconds = |tau: f64| began.plus(tau).seconds();
    let path = path.ok_or(seconds(to))?;
    let from = path.start();
    match seconds(from) <= t && t <= seconds(to) {
        true => {
            let tau = Instant::new(t).since(began).clamp(from, to);
            Ok(motion(equations, path, tau, true))
        }
        false => Err(seconds(from)),
    }
}
