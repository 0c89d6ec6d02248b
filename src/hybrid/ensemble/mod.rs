//! Many trajectories of one scene, with parameters, inputs and initial states of their own.
//!
//! Trajectories in the same mode go side by side, one in each lane of a vector register: each at its
//! own time, with steps and events of its own (`group`, `step`), and takes the transitions that most events
//! are (`transit`). What is not a plain step, a plain fall of a guard or a plain transition is done by the
//! engine for single runs, on the trajectory alone, and so are the step in which a guard falls that is more than a coordinate or a
//! rate, and a mode that does not go in lanes: stiff ones, and those that drift. A trajectory that leaves its mode makes
//! room for the next that has entered it (`worker`).
//!
//! What a trajectory gives is independent of the others, of their number, of the number of lanes and of
//! threads: to the bit. A single run by the Taylor method takes the same steps, with other roundings; from knot to knot of
//! a table it chooses the order of each, where lanes have one for all.

mod extremes;
mod group;
mod step;
mod transit;
mod worker;

use super::failure::Reason;
use super::member::Member;
use super::problem::{Method, Problem, Record};
use super::simulation::Simulation;
use crate::kernel::{LANES_OF_LEVELS, processor_level, with_kernel};
use crate::run::{Jump, Layout, Peak, Reached, Recorded, Snapshot, Solver, Until};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize};
use worker::Worker;

/// A scene made ready for many runs.
pub struct Ensemble {
    problem: Problem,
    /// Whether the trajectories in a mode are to go side by side.
    in_lanes: Vec<bool>,
    /// Orders of modes whose steps go from knot to knot of inputs, where they are to be lower than usual.
    orders: Vec<Option<usize>>,
    /// Level of the processor.
    level: usize,
}

/// A trajectory at its end.
pub struct Finished<'a, 'p> {
    simulation: &'a mut Simulation<'p>,
    /// Why it stopped before its end, if it did.
    pub failure: Option<Reason>,
    /// Whether it could be started; if not, it has no state.
    pub has_begun: bool,
}

impl Ensemble {
    /// Prepares a scene. Neither a trajectory nor the ledger, states at events or extremes are recorded.
    ///
    /// With [`Method::Auto`] the scene itself is run once: modes that turn out to be stiff in it do not
    /// go in lanes, and where most steps go from knot to knot of a record, they have the order that costs least.
    ///
    /// # Errors
    /// As [`super::simulate`].
    pub fn new(problem: &Problem) -> Result<Self, Reason> {
        let never = AtomicBool::new(false);
        Self::prepare(problem, (false, Recorded::default()), Until(&never))
    }

    /// The same with what the problem records, as far as that is extremes of coordinates and velocities ([`Finished::peak`]), and
    /// reactions and outputs at the end ([`Finished::state`]): `None` where it records more. The run of the scene ends when `stop` becomes
    /// true.
    ///
    /// # Errors
    /// As [`super::simulate`].
    pub fn recording(problem: &Problem, stop: &AtomicBool) -> Result<Option<Self>, Reason> {
        let Record {
            columns,
            ledger,
            extremes,
            ..
        } = problem.record;
        let more = ledger || columns.energies || extremes && (columns.reactions || columns.outputs);
        match more {
            true => Ok(None),
            false => Self::prepare(problem, (extremes, columns), Until(stop)).map(Some),
        }
    }

    fn prepare(
        problem: &Problem,
        (extremes, columns): (bool, Recorded),
        mut stop: Until,
    ) -> Result<Self, Reason> {
        problem.check()?;
        let mut problem = problem.clone();
        problem.record.ledger = false;
        problem.record.event_states = false;
        problem.record.extremes = extremes;
        problem.record.columns = columns;
        problem.record.every = Some(problem.end.time);
        let modes = &problem.automaton().modes;
        let mut pilot = Simulation::new(&problem)?;
        pilot.begin()?;
        let stiff = match problem.method {
            Method::Radau => vec![true; modes.len()],
            Method::Taylor => vec![false; modes.len()],
            Method::Auto => {
                // Where it fails it has shown what it can.
                let _ = pilot.run(&mut stop);
                let verdicts = pilot.stiffness.iter();
                verdicts.map(|s| s.is_stiff()).collect()
            }
        };
        let orders = (0..modes.len())
            .map(|mode| pilot.solvers.order_between_knots(mode))
            .collect();
        // Where what the scene freezes leaves conditional transitions alone, the fall of a guard may be no event.
        let watched = pilot.plan.watched.iter();
        let always = watched.map(|of_mode| of_mode.iter().all(|watched| !watched.conditional));
        let always: Vec<bool> = always.collect();
        drop(pilot);
        let in_lanes = (modes.iter().zip(stiff).zip(always))
            .map(|((mode, stiff), always)| {
                !stiff
                    && always
                    && problem.limits.own.is_empty()
                    && with_kernel!(&mode.kernels, k => k.goes_in_lanes())
            })
            .collect();
        Ok(Ensemble {
            problem,
            in_lanes,
            orders,
            level: processor_level(),
        })
    }

    /// The same by the functions for a lower level of the processor, an index into
    /// [`LANES_OF_LEVELS`]: it gives the same bits.
    ///
    /// # Panics
    /// If this processor does not have the level.
    pub fn at_level(mut self, level: usize) -> Self {
        assert!(level <= processor_level(), "the processor has that level");
        self.level = level;
        self
    }

    /// Runs all members, on the threads of the present pool of rayon; gives what `extract` takes from
    /// each, in their order.
    pub fn run<T: Send>(
        &self,
        members: &[Member],
        extract: impl Fn(usize, Finished) -> T + Sync,
    ) -> Vec<T> {
        let workers = rayon::current_num_threads().clamp(1, members.len().max(1));
        let next = AtomicUsize::new(0);
        let run = |_| {
            let mut results = Vec::new();
            let mut take = |member: usize, finished: Finished| {
                results.push((member, extract(member, finished)));
            };
            let never = AtomicBool::new(false);
            self.work(members, (&next, workers), Until(&never), &mut take);
            results
        };
        // Each takes the next member when it has room for one, so none waits while there are any.
        let parts = (0..workers).into_par_iter().with_max_len(1).map(run);
        let parts: Vec<Vec<(usize, T)>> = parts.collect();
        let mut results: Vec<Option<T>> = members.iter().map(|_| None).collect();
        for (member, result) in parts.into_iter().flatten() {
            results[member] = Some(result);
        }
        let results = results.into_iter();
        results
            .map(|result| result.expect("every member comes to its end"))
            .collect()
    }
}

impl Ensemble {
    /// Runs all members on this thread; `take` gets each at its end. Those that have not come to it when `stop` becomes true
    /// are left out.
    pub fn run_here(
        &self,
        members: &[Member],
        stop: &AtomicBool,
        mut take: impl FnMut(usize, Finished),
    ) {
        self.work(members, (&AtomicUsize::new(0), 1), Until(stop), &mut take);
    }

    /// Runs members until there are no more, from the `next` on that no other of so many workers has started.
    fn work(
        &self,
        members: &[Member],
        share: (&AtomicUsize, usize),
        stop: Until,
        take: &mut impl FnMut(usize, Finished),
    ) {
        match LANES_OF_LEVELS[self.level] {
            8 => Worker::<8>::new(self, members, share, stop).run(take),
            4 => Worker::<4>::new(self, members, share, stop).run(take),
            _ => Worker::<2>::new(self, members, share, stop).run(take),
        }
    }

    /// Whether a problem differs from that of the ensemble in nothing but what members differ in ([`Member`]).
    pub fn is_like(&self, problem: &Problem) -> bool {
        let own = &self.problem;
        let zero = |of: &Problem, input: usize| of.signals.input_is_zero(input);
        std::sync::Arc::ptr_eq(&own.model, &problem.model)
            && own.chosen == problem.chosen
            && (0..own.model.inputs.len()).all(|i| zero(own, i) == zero(problem, i))
            && own.project == problem.project
            && own.at_rest == problem.at_rest
            && own.stated == problem.stated
            && own.unstated == problem.unstated
            && own.freeze == problem.freeze
            && own.end == problem.end
            && own.limits == problem.limits
            && own.outputs == problem.outputs
            && own.accuracy.relative == problem.accuracy.relative
            && own.method == problem.method
            && own.collisions == problem.collisions
    }
}

impl Finished<'_, '_> {
    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.simulation.here.now.seconds()
    }

    /// Index of the last mode in the variant of the problem.
    pub fn mode(&self) -> usize {
        self.simulation.here.mode
    }

    /// All coordinates.
    pub fn q(&self) -> &[f64] {
        &self.simulation.here.q
    }

    /// All velocities.
    pub fn v(&self) -> &[f64] {
        &self.simulation.here.v
    }

    /// All discrete states.
    pub fn discrete(&self) -> &[f64] {
        self.simulation.context.discrete()
    }

    /// The state, with reactions and outputs where the scene of the ensemble records them.
    pub fn state(&mut self) -> Snapshot {
        self.simulation.snapshot()
    }

    /// Names of what a state consists of.
    pub fn layout(&self) -> &Layout {
        &self.simulation.observers.layout
    }

    /// The extremes of a coordinate or, behind all of these, of a velocity, by its index; `None` where none are looked for.
    pub fn peak(&self, column: usize) -> Option<Peak> {
        let observers = &self.simulation.observers;
        observers.watch_extremes().then(|| observers.peak(column))
    }

    /// The transitions.
    pub fn events(&self) -> &[Jump] {
        self.simulation.observers.recording.jumps()
    }

    /// Limit states that were reached, and conditions on the motion under which the model is meant that were left.
    pub fn reached(&self) -> Reached {
        self.simulation.margins.reached()
    }

    /// Steps made, in lanes and alone.
    pub fn steps(&self) -> u64 {
        self.simulation.solver.steps
    }

    /// Work done, in lanes and alone; the method is not named.
    pub fn solver(&self) -> &Solver {
        &self.simulation.solver
    }
}
