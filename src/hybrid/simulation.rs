//! The run: settle, advance to the next event, apply it, and so on to the end.

use super::accumulation::Accumulation;
use super::advance::{MadeBy, Pause, Stage};
use super::crossing::Signs;
use super::doubt::Doubts;
use super::equations::Piece;
use super::failure::{Reason, Stoppable};
use super::instant::Instant;
use super::limits::Margins;
use super::member::Member;
use super::observe::{Observer, Observers};
use super::plan::Plan;
use super::problem::{Accuracy, Initial, Problem};
use super::solvers::Solvers;
use super::stiffness::Stiffness;
use super::validate::{Invalid, check_accuracy, check_initial, check_parameters};
use super::visited::Visited;
use crate::input::{Side, Signals};
use crate::jets::Expansion;
use crate::kernel::with_kernel;
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::Mode;
use crate::numerics::Size;
use crate::numerics::Vector;
use crate::run::{Progress, Snapshot, Solver};
use std::borrow::Cow;

/// Where the run is: everything but the discrete states, which live in the context.
#[derive(Debug)]
pub(super) struct Here {
    pub now: Instant,
    pub j: u64,
    pub mode: usize,
    /// What is recorded as the mode: its index, or that of the set of contact states in a mode of all sets.
    pub shown: usize,
    /// All coordinates.
    pub q: Box<[f64]>,
    /// All velocities.
    pub v: Box<[f64]>,
    /// All accelerations; those of frozen coordinates are 0.
    pub a: Box<[f64]>,
}

/// A guard that is not respected at the start of a segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Violation {
    /// Index of the guard in its mode.
    pub guard: usize,
    /// Whether it leaves zero at once and from rest: as an impact, a hop of no height.
    pub rests: bool,
}

/// A guard that is zero, whatever rounding makes of its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtZero {
    /// Index of the guard in its mode.
    pub guard: usize,
    /// How many of its first derivatives vanish, the value among them: at least one.
    pub vanishing: usize,
}

/// Why a segment ended.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stop {
    /// The end of the run.
    End,
    /// An input is not smooth here.
    Breakpoint,
    /// Another method is to go on.
    Method,
    /// A guard, by its index in the mode, fell through zero.
    Event(usize),
    /// The same, and its transition was taken.
    Fired,
    /// The time that is advanced to is reached; the segment goes on.
    Pause,
    /// A guard that was zero at the segment's start leaves it downwards.
    Violated(Violation),
}

pub(super) struct Simulation<'p> {
    pub problem: &'p Problem,
    /// Its initial state, or that of the member of an ensemble.
    pub initial: &'p Initial,
    /// Its tolerances, or those of the member.
    pub accuracy: &'p Accuracy,
    /// The inputs of the problem, or those of the member of an ensemble.
    pub given_signals: &'p Signals,
    /// The same, until the caller commands one.
    pub signals: Cow<'p, Signals>,
    /// The modes of the problem's variant.
    pub modes: &'p [Mode],
    pub plan: Plan,
    pub context: Context,
    pub here: Here,
    /// What the context held at the start of the segment, where something moves that the mode holds.
    pub at_start: Box<[f64]>,
    /// Rates of the frozen coordinates in the present mode; 0 of the prescribed motions, which are held where they were.
    pub drift: Box<[f64]>,
    /// Room for those of another mode.
    pub drift_of_target: Box<[f64]>,
    /// Room for what another mode holds, and where.
    pub held_by_target: Box<[f64]>,
    /// Remembered signs of what is watched in the present mode.
    pub signs: Signs,
    pub doubts: Doubts,
    pub margins: Margins<'p>,
    /// Room for a reset: q, v, discrete states.
    pub next: Box<[f64]>,
    pub accumulation: Accumulation,
    pub visited: Visited,
    /// What the run is watched for.
    pub observers: Observers<'p>,
    pub solver: Solver,
    pub solvers: Solvers,
    /// What was seen of the stiffness of each mode.
    pub stiffness: Box<[Stiffness]>,
    /// How well the least determined force of a constraint was determined at best so far.
    pub best_determined: f64,
    /// Until when the inputs are smooth, or the run lasts, s; −∞ where it must be found out.
    pub smooth_until: f64,
    /// The piece of the inputs, where one without end is known.
    pub piece: Piece,
    /// When the present segment began.
    pub began: Instant,
    /// Which method made the last step.
    pub made_by: MadeBy,
    /// Where an advance ends, and how far it is.
    pub pause: Pause,
    pub stage: Stage,
    /// Whether signals can be computed ahead.
    pub foresees: bool,
    /// Per mode: whether its inertia was found to be positive definite in this run.
    pub has_inertia: Box<[bool]>,
    /// Typical sizes of all coordinates: absolute ÷ relative tolerance.
    pub sizes: Box<[f64]>,
    /// The same of their rates.
    pub rate_sizes: Box<[f64]>,
    /// Room for expansions in time.
    pub expansion: Expansion,
    /// Name and order of every method that was used.
    pub methods: Vec<(&'static str, usize)>,
    /// How often the transition that ends the run has happened.
    pub counted: u64,
    /// Guards of contacts that are zero here, whatever rounding makes of their values.
    pub at_zero: Vec<AtZero>,
    /// Coordinates, velocities and discrete states that a run with contacts begins with, once they were found.
    pub begun: Option<Box<[f64]>>,
}

impl<'p> Simulation<'p> {
    /// A simulation before its first instant, which keeps rows and transitions in memory.
    pub fn new(problem: &'p Problem) -> Result<Self, Reason> {
        Self::observed(problem, None)
    }

    /// A simulation before its first instant; rows and transitions go to `observer`, else to memory.
    pub fn observed(
        problem: &'p Problem,
        observer: Option<&'p mut dyn Observer>,
    ) -> Result<Self, Reason> {
        let model = &problem.model;
        problem.check()?;
        let plan = Plan::new(problem)?;
        let mut context = Context::new(model, &problem.parameters);
        context
            .discrete_mut()
            .copy_from_slice(&problem.initial.discrete);
        context.autonomous = problem.signals.is_zero();
        let foresees = context.can_foresee(&problem.signals);
        let n = model.coordinates.len();
        let modes = &problem.automaton().modes;
        let accuracy = &problem.accuracy;
        let absolute = [&accuracy.q_absolute[..], &accuracy.v_absolute].concat();
        let zeros = |count: usize| vec![0.0; count].into_boxed_slice();
        let sizes = |absolute: &[f64]| absolute.iter().map(|a| a / accuracy.relative).collect();
        let context_signals = context.signals().len();
        Ok(Simulation {
            problem,
            initial: &problem.initial,
            accuracy,
            given_signals: &problem.signals,
            signals: Cow::Borrowed(&problem.signals),
            modes,
            plan,
            context,
            here: Here {
                now: Instant::default(),
                j: 0,
                mode: 0,
                shown: 0,
                q: problem.initial.q.clone().into(),
                v: problem.initial.v.clone().into(),
                a: zeros(n),
            },
            at_start: zeros(n + model.motions.len()),
            drift: zeros(n + model.motions.len()),
            drift_of_target: zeros(n + model.motions.len()),
            held_by_target: zeros(n + model.motions.len()),
            signs: Signs::default(),
            doubts: Doubts::new(modes),
            margins: Margins::new(problem),
            next: zeros(2 * n + model.discretes.len()),
            accumulation: Accumulation::new(absolute.into(), model.discretes.len()),
            visited: Visited::default(),
            observers: Observers::new(problem, observer),
            solver: Solver::default(),
            solvers: Solvers::new(modes),
            stiffness: vec![Stiffness::default(); modes.len()].into(),
            best_determined: 0.0,
            smooth_until: f64::NEG_INFINITY,
            piece: Piece::UNKNOWN,
            began: Instant::default(),
            made_by: MadeBy::default(),
            pause: Pause::new(n),
            stage: Stage::Start,
            foresees,
            has_inertia: vec![false; modes.len()].into(),
            sizes: sizes(&accuracy.q_absolute),
            rate_sizes: sizes(&accuracy.v_absolute),
            expansion: Expansion::new(
                [n, model.motions.len(), context_signals],
                &problem.parameters,
            ),
            methods: Vec::new(),
            counted: 0,
            at_zero: Vec::new(),
            begun: None,
        })
    }

    /// Finds the mode of the initial state, and opens the ledger.
    pub fn begin(&mut self) -> Result<(), Reason> {
        let problem = self.problem;
        self.find_start(&problem.parameters)?;
        self.observe_start();
        Ok(())
    }

    /// The observers see the state that the run starts from.
    fn observe_start(&mut self) {
        if self.observers.watch_steps() {
            let stored = self.stored_energy();
            self.observers.begin(stored);
            self.observers.jump(&self.here, [&[], &[]], Some(stored));
        }
    }

    /// Takes the place of a member of an ensemble, at its start.
    pub fn become_member(&mut self, member: &Member<'p>) -> Result<(), Reason> {
        let model = &self.problem.model;
        check_parameters(model, member.parameters)?;
        check_initial(model, member.initial, self.problem.project)?;
        self.become_shaken(member.signals)?;
        self.initial = member.initial;
        self.become_accurate(member.accuracy)?;
        self.context.set_parameters(model, member.parameters);
        self.expansion.set_parameters(member.parameters);
        self.doubts.forget_errors();
        self.margins.outputs.set_parameters(member.parameters);
        self.observers.outputs.set_parameters(member.parameters);
        self.begun = None;
        self.rewind(0);
        self.find_start(member.parameters)
    }

    /// Takes the tolerances of a member.
    fn become_accurate(&mut self, accuracy: &'p Accuracy) -> Result<(), Reason> {
        if accuracy == self.accuracy {
            return Ok(());
        }
        check_accuracy(&self.problem.model, accuracy)?;
        let (own, scene) = (accuracy.relative, self.problem.accuracy.relative);
        if own != scene {
            return Err(Invalid::OtherTolerance { own, scene }.into());
        }
        self.accuracy = accuracy;
        let sizes = [
            (&mut self.sizes, &accuracy.q_absolute),
            (&mut self.rate_sizes, &accuracy.v_absolute),
        ];
        for (sizes, absolute) in sizes {
            sizes
                .iter_mut()
                .zip(absolute)
                .for_each(|(size, absolute)| *size = absolute / own);
        }
        (self.accumulation).set_absolute([&accuracy.q_absolute, &accuracy.v_absolute]);
        self.solvers.set_accuracy(self.modes, accuracy);
        Ok(())
    }

    /// Takes the inputs of a member. Those that never act are left out of the equations of a scene, for all its members.
    fn become_shaken(&mut self, signals: &'p Signals) -> Result<(), Reason> {
        let scene = &self.problem.signals;
        if signals == scene {
            // So that members with the same inputs are known by it.
            self.given_signals = scene;
        } else {
            for (i, input) in self.problem.model.inputs.iter().enumerate() {
                if scene.input_is_zero(i) && !signals.input_is_zero(i) {
                    let input = input.name;
                    return Err(Invalid::NotInScene { input }.into());
                }
            }
            self.given_signals = signals;
        }
        self.signals = Cow::Borrowed(self.given_signals);
        self.context.forget_signals();
        self.piece = Piece::UNKNOWN;
        Ok(())
    }

    /// Finds the mode of the initial state.
    fn find_start(&mut self, parameters: &[f64]) -> Result<(), Reason> {
        if self.modes[0].contacts.is_some() {
            self.start_contacts(parameters)?;
            return match self.problem.project {
                true => self.check_projected(),
                false => Ok(()),
            };
        }
        if self.problem.at_rest {
            return self.start_at_rest(parameters);
        }
        self.follow_unstated();
        if self.problem.project {
            self.project_gaps();
            self.check_projected()?;
        }
        self.choose_initial_mode()?;
        self.follow_others();
        self.here.shown = self.here.mode;
        self.set_context();
        let kernels = &self.mode().kernels;
        with_kernel!(kernels, k => self.follow_slip_rates(k));
        let follows = self.here.q[..] != self.initial.q || self.here.v[..] != self.initial.v;
        if follows || self.context.discrete() != self.initial.discrete {
            let discrete = self.context.discrete();
            self.begun = Some([&*self.here.q, &*self.here.v, discrete].concat().into());
        }
        self.check_start(parameters)
    }

    /// Goes back to the start, in the mode that was found for it.
    pub fn rewind(&mut self, mode: usize) {
        let initial = self.initial;
        self.here.now = Instant::default();
        self.smooth_until = f64::NEG_INFINITY;
        self.forget_commands();
        self.pause.never();
        self.stage = Stage::Start;
        self.here.j = 0;
        self.here.mode = mode;
        self.here.q.copy_from_slice(&initial.q);
        self.here.v.copy_from_slice(&initial.v);
        self.here.a.fill(0.0);
        self.context
            .discrete_mut()
            .copy_from_slice(&initial.discrete);
        if let Some(begun) = &self.begun {
            let (q, rest) = begun.split_at(self.here.q.len());
            let (v, discrete) = rest.split_at(q.len());
            self.here.q.copy_from_slice(q);
            self.here.v.copy_from_slice(v);
            self.context.discrete_mut().copy_from_slice(discrete);
        } else if initial.mode.is_some() {
            self.apply_drift();
        }
        self.here.shown = self.shown();
        self.at_zero.clear();
        self.stiffness.fill(Stiffness::default());
        self.has_inertia.fill(false);
        self.best_determined = 0.0;
        self.accumulation.clear();
        self.visited.clear();
        self.doubts.clear();
        self.margins.clear();
        self.solver = Solver::default();
        self.solvers.forget();
        self.counted = 0;
        self.set_context();
        self.observers.rewind();
        self.observe_start();
    }

    pub fn mode(&self) -> &'p Mode {
        &self.modes[self.here.mode]
    }

    /// What is recorded as the mode.
    pub fn shown(&self) -> usize {
        match &self.mode().contacts {
            Some(contacts) => {
                let set = contacts.set(self.context.discrete());
                self.here.mode * contacts.sets().count() + set
            }
            None => self.here.mode,
        }
    }

    /// The name of what is recorded as a mode.
    pub fn name_of(&self, shown: usize) -> String {
        self.observers.layout.modes.name(shown).into_owned()
    }

    /// Simulates from here to the end.
    pub fn run(&mut self, progress: &mut dyn Progress) -> Result<(), Reason> {
        self.stage = Stage::Start;
        self.go_on_to_end(progress)
    }

    /// Adds the work that the methods have done since it was last counted.
    pub fn count_work(&mut self) {
        let solver = &mut self.solver;
        self.solvers.take_counters(|counters| {
            solver.steps += counters.steps;
            solver.rejected += counters.rejected + counters.newton_failures;
            solver.residual_evaluations += counters.residual_evaluations;
            solver.jacobian_evaluations += counters.jacobian_evaluations;
            solver.factorizations += counters.factorizations;
        });
    }

    /// From an admissible mode through the next event; false at the end of the run.
    pub fn advance_to_event(&mut self, progress: &mut dyn Progress) -> Stoppable<bool> {
        let mode = self.mode();
        let stop = with_kernel!(&mode.kernels, k => self.advance(k, false, progress))?;
        self.pass(stop)
    }

    /// Does what the end of a segment asks for; false at the end of the run.
    pub fn pass(&mut self, stop: Stop) -> Stoppable<bool> {
        match stop {
            Stop::End => {
                if !(are_finite(&self.here.q) && are_finite(&self.here.v)) {
                    let what = "a coordinate or a velocity";
                    return Err(Box::new(Reason::NotFinite { what }));
                }
                self.set_context();
                self.check_energy()?;
                return Ok(false);
            }
            Stop::Breakpoint | Stop::Method => self.visited.clear(),
            Stop::Event(guard) => {
                self.visited.clear();
                self.fire(guard)?;
            }
            Stop::Fired | Stop::Pause => {}
            Stop::Violated(violation) => self.resolve(violation)?,
        }
        Ok(true)
    }

    /// Finds the admissible mode at the present instant: every violated guard is one transition. False
    /// if the run is over.
    pub fn settle(&mut self) -> Stoppable<bool> {
        loop {
            let mode = self.mode();
            match with_kernel!(&mode.kernels, k => self.enter(k))? {
                None => break,
                Some(_) if self.is_over() => break,
                Some(violation) => self.resolve(violation)?,
            }
        }
        self.flush_samples()?;
        Ok(!self.is_over())
    }

    pub fn is_over(&self) -> bool {
        let after = self.problem.end.after;
        self.margins.has_ended()
            || self.here.now.seconds() >= self.problem.end.time
            || after.is_some_and(|(_, count)| self.counted >= count)
    }

    /// Sets signals and held coordinates to the present instant.
    #[inline(always)]
    pub fn set_context(&mut self) {
        let t = self.here.now.seconds();
        self.context.set_signals(&self.signals, t, Side::Right);
        self.context.hold(&self.here.q);
    }

    /// Sets the free coordinates of the present mode, for whose time the context is set, and what moves with them.
    #[inline(always)]
    pub fn set_here<F: Size>(&mut self, kernel: &ModeKernel<F>, [q, v, a]: [&F::Vector; 3]) {
        self.here.a.fill(0.0);
        self.here.set_free(&self.mode().free, [q, v, a]);
        if self.plan.moves[self.here.mode] {
            self.here.set_all(kernel, &self.context, Free { q, v, a });
        }
    }

    /// Where energies are kept they are finite.
    pub fn check_energy(&self) -> Stoppable<()> {
        match &self.observers.ledger {
            Some(ledger) if !are_finite(&ledger.row(self.stored_energy(), [0.0; 2])) => {
                let what = "an energy";
                Err(Box::new(Reason::NotFinite { what }))
            }
            _ => Ok(()),
        }
    }

    /// T + V here, J.
    pub fn stored_energy(&self) -> f64 {
        let mode = self.mode();
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            let [kinetic, potential] = k.energies(&self.context, Free { q: &q, v: &v, a: &a });
            kinetic + potential
        })
    }

    /// The state here, with reactions and outputs where they are recorded.
    pub fn snapshot(&mut self) -> Snapshot {
        let layout = &self.observers.layout;
        let [mut reactions, mut outputs] =
            [&layout.reactions, &layout.outputs].map(|group| vec![0.0; group.len()]);
        let mode = self.mode();
        if !reactions.is_empty() || !outputs.is_empty() {
            with_kernel!(&mode.kernels, k => {
                let [q, v, a] = self.here.free(k.size(), &mode.free);
                let at = Free { q: &q, v: &v, a: &a };
                if !reactions.is_empty() {
                    (self.observers.outputs).reactions(k, &self.context, at, &mut reactions);
                }
                if !outputs.is_empty() {
                    self.observers.outputs.evaluate(k, &self.context, at, &mut outputs);
                }
            });
        }
        let layout = &self.observers.layout;
        let n = layout.coordinates.len();
        let seen = self.problem.variant().discretes.iter();
        Snapshot {
            q: self.here.q[..n].to_vec(),
            v: self.here.v[..n].to_vec(),
            discrete: seen.map(|&i| self.context.discrete()[i]).collect(),
            reactions,
            outputs,
        }
    }
}

fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

impl Here {
    /// Free coordinates, velocities and accelerations.
    #[inline(always)]
    pub fn free<F: Size>(&self, size: F, free: &[usize]) -> [F::Vector; 3] {
        let gather = |full: &[f64]| size.vector(|i| full[free[i]]);
        [gather(&self.q), gather(&self.v), gather(&self.a)]
    }

    /// Sets the free coordinates.
    #[inline(always)]
    pub fn set_free<V: Vector>(&mut self, free: &[usize], [q, v, a]: [&V; 3]) {
        for (i, &full) in free.iter().enumerate() {
            (self.q[full], self.v[full], self.a[full]) = (q[i], v[i], a[i]);
        }
    }

    /// Sets what a mode holds though it moves, for whose time the context is set, and the free coordinates.
    pub fn set_all<F: Size>(&mut self, kernel: &ModeKernel<F>, context: &Context, at: Free<F>) {
        kernel.coordinates(context, at, &mut self.q);
        kernel.rates(context, at, &mut self.v);
        kernel.accelerations(context, at, &mut self.a);
    }
}
