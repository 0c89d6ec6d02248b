//! Trajectories of one mode side by side, from one event of each to its next.

use super::super::accumulation::{Accumulation, SHORTEST_PATTERN, Signature};
use super::super::guards::slope;
use super::super::instant::Instant;
use super::super::plan::is_impact;
use super::super::problem::Accuracy;
use super::super::roots::Watch;
use super::super::simulation::Simulation;
use crate::input::LaneSignals;
use crate::integrate::{LaneMask, LaneTaylor, Lanes, ORDERS};
use crate::kernel::{
    Free, LaneContext, LaneGuard, LaneLevel, LanePast, LanePoint, LaneRows, LaneSystem, ModeKernel,
    lane_departs,
};
use crate::model::{GuardShape, Mode};
use crate::numerics::Const;
use nalgebra::SVector;

/// What became of a lane in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Outcome {
    /// It has come to where its inputs are not smooth, or to the end.
    Until,
    /// A guard, by its index in the mode, has fallen.
    Event(usize),
    /// The step has not been made: something is not as usual and needs to be looked at in full.
    Unclear,
}

/// A guard of the mode that is watched and is a coordinate or a rate.
pub(super) struct CoordinateGuard<const W: usize> {
    /// Index in the mode, and among those that are watched.
    pub guard: usize,
    place: usize,
    /// Index of the coordinate, and whether it is its rate.
    pub of: (usize, bool),
    /// What it is multiplied with: a number, and a discrete state.
    pub factor: (f64, Option<usize>),
    /// Whether something is added.
    pub offset: bool,
    /// Whether it is a stop that is not at zero: of a hop from there the engine alone tells the end, by its series.
    pub is_stop: bool,
    pub linear: LaneGuard<W>,
    /// Its transition, if lanes can take it side by side; the name of that, and what makes its events the same
    /// ([`Signature::key`]).
    pub transition: Option<usize>,
    pub name: &'static str,
    pub key: u64,
    /// Lanes in which it falls in the last step.
    pub falls: LaneMask,
    /// All coordinates, velocities and discrete states after the transition.
    pub reset: LaneRows<W>,
    /// What it is where the transition leads to.
    pub after: LaneGuard<W>,
    /// In powers of a part of the last step.
    pub coefficients: [Lanes<W>; ORDERS],
}

/// What a step computes on its way, where C writes and reads it in one piece: what is copied, or written lane
/// by lane, has to be in memory before it can be read so.
#[repr(C, align(64))]
pub(super) struct Way<const F: usize, const W: usize> {
    pub system: LaneSystem<F, W>,
    /// Inverses of the mass matrices.
    pub inverse: [[Lanes<W>; F]; F],
    /// Absolute times of the analytic pieces of the inputs, s, and how long they last.
    pub pieces: [Lanes<W>; 2],
    /// Infinite.
    pub unlimited: Lanes<W>,
    /// Length of the step, s.
    pub h: Lanes<W>,
    /// Where the first guards fall, as parts of the step; infinite where none does.
    pub places: Lanes<W>,
    /// Duration up to there, s; what it may be lengthened by, and how far that may go.
    pub durations: [Lanes<W>; 3],
}

impl<const F: usize, const W: usize> Way<F, W> {
    fn new() -> Self {
        let zero = Lanes::of(0.0);
        Way {
            system: LaneSystem {
                mass: [[zero; F]; F],
                load: [zero; F],
            },
            inverse: [[zero; F]; F],
            pieces: [zero; 2],
            unlimited: Lanes::of(f64::INFINITY),
            h: zero,
            places: zero,
            durations: [zero; 3],
        }
    }
}

/// Up to `W` trajectories in one mode.
pub(super) struct Group<'p, const F: usize, const W: usize> {
    pub kernel: &'p ModeKernel<Const<F>>,
    pub mode: &'p Mode,
    /// Index of the mode.
    pub index: usize,
    /// Level of the processor.
    pub level: LaneLevel<W>,
    /// Whether no input ever acts.
    pub autonomous: bool,
    pub taylor: LaneTaylor<F, W>,
    pub context: LaneContext<W>,
    pub signals: LaneSignals<'p, W>,
    pub guards: Vec<CoordinateGuard<W>>,
    /// Indices of the other guards that are watched, in the mode, and room for the coefficients of one.
    pub general: Vec<usize>,
    pub room: [Lanes<W>; ORDERS],
    /// Where the trajectories are. Accelerations are given where a segment starts.
    pub here: LanePoint<F, W>,
    /// Where the step under way leads to.
    pub next: LanePoint<F, W>,
    /// What a step computes on its way.
    pub way: Way<F, W>,
    pub at_start: LaneMask,
    /// What was before the last step.
    pub past: LanePast<F, W>,
    /// Discrete states before a transition.
    pub left: LaneRows<W>,
    /// Where inputs are not smooth, or the end, s.
    pub last: Lanes<W>,
    /// Times after which the inputs are analytic, s.
    pub analytic_from: Lanes<W>,
    /// Lower bounds, in the last step, of what the mode requires to be positive, and of margins.
    pub bounds: LaneRows<W>,
    /// Of each margin, the lanes in which it has been reached before.
    pub passed: Vec<LaneMask>,
    /// Extremes of free coordinates and their velocities, where they are looked for: see [`crate::kernel::lane_note`].
    pub extremes: Option<LaneRows<W>>,
    /// Lanes that have not made the last step.
    pub unclear: LaneMask,
    /// Steps of the group, and how many of them each lane has not made since it was loaded or came before.
    pub steps: u64,
    pub missed: [u64; W],
    /// Which lanes hold a trajectory.
    pub occupied: LaneMask,
}

impl<'p, const F: usize, const W: usize> Group<'p, F, W> {
    /// An empty group for the mode of a simulation, whose state is put into the empty lanes. `order`: where it is to be
    /// lower than usual.
    pub fn new(
        kernel: &'p ModeKernel<Const<F>>,
        level: LaneLevel<W>,
        autonomous: bool,
        order: Option<usize>,
        like: &Simulation<'p>,
    ) -> Self {
        let (problem, mode) = (like.problem, like.mode());
        let context = LaneContext::new(kernel, &like.context);
        let (coordinates, discretes) = (like.here.q.len(), context.discrete().len());
        let all = &like.plan.watched[like.here.mode];
        let general = all.iter().map(|watched| watched.guard);
        let general: Vec<usize> = general.filter(|&g| mode.guards[g].is_general()).collect();
        let guards = all.iter().enumerate().filter_map(|(place, watched)| {
            let GuardShape::Linear {
                index,
                rate,
                factor,
                discrete,
                offset,
            } = mode.guards[watched.guard].shape
            else {
                return None;
            };
            let linear = LaneGuard {
                factor: Lanes::of(1.0),
                offset: Lanes::of(0.0),
                starts_at_zero: LaneMask::NONE,
            };
            let own = &mode.guards[watched.guard];
            let is_stop = is_impact(own) && !own.is_exact();
            let transition =
                transition_in_lanes(like, watched.guard).filter(|_| general.is_empty() && !is_stop);
            let signature = Signature {
                guard: watched.guard,
                transition: transition.unwrap_or_default(),
                mode: like.here.mode,
            };
            Some(CoordinateGuard {
                guard: watched.guard,
                place,
                of: (index, rate),
                factor: (factor, discrete),
                offset,
                is_stop,
                linear,
                transition,
                name: transition.map_or("", |t| own.transitions[t].name),
                key: signature.key(),
                falls: LaneMask::NONE,
                reset: LaneRows::zeros(2 * coordinates + discretes),
                after: linear,
                coefficients: [Lanes::of(0.0); ORDERS],
            })
        });
        let guards = guards.collect();
        let kind = kernel.series_kind(&like.context);
        let mut group = Group {
            kernel,
            mode,
            index: like.here.mode,
            level,
            autonomous,
            taylor: LaneTaylor::new(level, problem.accuracy.relative, kind, order),
            context,
            signals: LaneSignals::new(level, &problem.signals),
            guards,
            general,
            room: [Lanes::of(0.0); ORDERS],
            here: LanePoint::zero(),
            next: LanePoint::zero(),
            way: Way::new(),
            at_start: LaneMask::ALL,
            past: LanePast {
                coordinates,
                free: mode.free.clone(),
                may_rest: like.plan.rests(like.here.mode),
                hardly: Accumulation::HARDLY,
                shortest: SHORTEST_PATTERN,
                tolerances: LaneRows::zeros(1 + 2 * F),
                after: LaneRows::zeros(2 * F + 1 + discretes),
            },
            left: LaneRows::zeros(discretes),
            last: Lanes::of(f64::INFINITY),
            analytic_from: Lanes::of(problem.signals.last_knot()),
            bounds: LaneRows::zeros(mode.requirements.len() + mode.margins.len()),
            passed: vec![LaneMask::NONE; mode.margins.len()],
            extremes: like
                .observers
                .watch_extremes()
                .then(|| LaneRows::zeros(8 * F)),
            unclear: LaneMask::NONE,
            steps: 0,
            missed: [0; W],
            occupied: LaneMask::NONE,
        };
        for lane in 0..W {
            group.load(lane, like);
            group.vacate(lane);
        }
        group
    }

    /// Whether the guards of a simulation that has just entered the mode can be followed in a lane.
    pub fn takes(of: &Simulation) -> bool {
        let (signs, mode) = (&of.signs, of.mode());
        let watched = signs.watches.iter().zip(&of.plan.watched[of.here.mode]);
        let mut known = watched.map(|(watch, watched)| match watch {
            Watch::Armed => true,
            // Of a general guard the values near zero are roundings.
            Watch::Dormant => !mode.guards[watched.guard].is_general(),
            Watch::Violated => false,
        });
        !signs.waits() && known.all(|known| known)
    }

    /// Puts a trajectory, which has just entered the mode, into a lane.
    pub fn load(&mut self, lane: usize, from: &Simulation<'p>) {
        self.context.load(lane, &from.context);
        self.set_tolerances(lane, from.accuracy);
        self.set(lane, from);
        for guard in &mut self.guards {
            let dormant = from.signs.watches[guard.place] == Watch::Dormant;
            guard.linear.starts_at_zero.set(lane, dormant);
        }
        if !std::ptr::eq(self.signals.of(lane), from.given_signals) {
            self.signals.load(lane, from.given_signals);
            self.analytic_from.0[lane] = from.given_signals.last_knot();
        }
        let breakpoint = from.signals.next_breakpoint(from.here.now.seconds());
        self.last.0[lane] = breakpoint.min(from.problem.end.time);
        self.at_start.set(lane, true);
        self.missed[lane] = self.steps;
        self.occupied.set(lane, true);
    }

    /// Goes on in the lane that a trajectory is in, after an event whose reset has led to the same mode
    /// again; false where it must enter the mode as any other.
    ///
    /// The accelerations, the mass matrix and what the mode requires are looked at in the next step.
    pub fn go_on(&mut self, lane: usize, from: &Simulation) -> bool {
        if !self.general.is_empty() {
            return false;
        }
        self.context.load_state(lane, &from.context);
        self.set(lane, from);
        let here = LaneMask(1 << lane);
        for guard in &mut self.guards {
            let (index, rate) = guard.of;
            let of = match rate {
                true => (&self.here.v[index], None),
                false => (&self.here.q[index], Some(&self.here.v[index])),
            };
            let (factor, discrete) = guard.factor;
            let discrete = discrete.map(|d| &self.context.discrete()[d]);
            guard.after.offset = guard.linear.offset;
            let departs = lane_departs(self.level, of, factor, discrete, &mut guard.after);
            guard.linear.take(self.level, here, &guard.after);
            if !departs.is(lane) {
                return false;
            }
        }
        self.at_start.set(lane, false);
        true
    }

    fn set_tolerances(&mut self, lane: usize, accuracy: &Accuracy) {
        let tolerances = &mut self.past.tolerances;
        tolerances[0].0[lane] = accuracy.relative;
        for (i, &coordinate) in self.mode.free.iter().enumerate() {
            tolerances[1 + i].0[lane] = accuracy.q_absolute[coordinate];
            tolerances[1 + F + i].0[lane] = accuracy.v_absolute[coordinate];
        }
    }

    fn set(&mut self, lane: usize, from: &Simulation) {
        let here = &mut self.here;
        let [q, v, a] = from.here.free(self.kernel.size(), &self.mode.free);
        for i in 0..F {
            here.q[i].0[lane] = q[i];
            here.v[i].0[lane] = v[i];
            here.a[i].0[lane] = a[i];
            here.lost[0][i].0[lane] = 0.0;
            here.lost[1][i].0[lane] = 0.0;
        }
        let [high, low] = from.here.now.parts();
        (here.t[0].0[lane], here.t[1].0[lane]) = (high, low);
        for (margin, passed) in self.passed.iter_mut().enumerate() {
            passed.set(lane, !from.margins.is_pending(margin));
        }
        self.load_extremes(lane, &from.observers);
        self.note_here(LaneMask(1 << lane));
        self.past.after.fill_lane(lane, f64::NAN);
        if let Some((at, states, discretes)) = from.accumulation.last() {
            let after = &mut self.past.after;
            for (i, &coordinate) in self.mode.free.iter().enumerate() {
                after[i].0[lane] = states[coordinate];
                after[F + i].0[lane] = states[from.here.q.len() + coordinate];
            }
            after[2 * F].0[lane] = at.seconds();
            for (after, discrete) in after[2 * F + 1..].iter_mut().zip(discretes) {
                after.0[lane] = *discrete;
            }
        }
        let zero = SVector::<f64, F>::zeros();
        let origin = Free {
            q: &zero,
            v: &zero,
            a: &zero,
        };
        for guard in &mut self.guards {
            guard.linear.factor.0[lane] = slope(guard.factor, &from.context);
            if guard.offset {
                let own = &self.mode.guards[guard.guard].kernel;
                guard.linear.offset.0[lane] = self.kernel.guard(&from.context, own, origin);
            }
        }
    }

    /// The present instant of a lane.
    pub fn now(&self, lane: usize) -> Instant {
        let [high, low] = &self.here.t;
        Instant::of_parts([high.0[lane], low.0[lane]])
    }

    /// What became of a lane that does not simply go on after the last step.
    pub fn outcome(&self, lane: usize) -> Outcome {
        let fallen = self.guards.iter().find(|guard| guard.falls.is(lane));
        match fallen {
            _ if self.unclear.is(lane) => Outcome::Unclear,
            Some(guard) => Outcome::Event(guard.guard),
            None => Outcome::Until,
        }
    }

    /// Takes a trajectory out of its lane, where it may be left for [`Group::go_on`].
    pub fn unload(&mut self, lane: usize, into: &mut Simulation) {
        let column = |rows: &[Lanes<W>; F]| SVector::<f64, F>::from_fn(|i, _| rows[i].0[lane]);
        let here = &self.here;
        let [q, v, a] = [column(&here.q), column(&here.v), column(&here.a)];
        into.here.set_free(&self.mode.free, [&q, &v, &a]);
        self.unload_extremes(lane, &mut into.observers);
        let discrete = into.context.discrete_mut().iter_mut();
        for (into, of) in discrete.zip(self.context.discrete()) {
            *into = of.0[lane];
        }
        let outcome = self.outcome(lane);
        into.here.now = match outcome {
            Outcome::Until => Instant::new(self.last.0[lane]),
            _ => self.now(lane),
        };
        let t = into.here.now.seconds();
        if !self.autonomous && outcome != Outcome::Until && t == self.signals.time(lane) {
            into.context.set_signals_of_lane(&self.signals, lane);
        }
        let steps = self.steps - self.missed[lane];
        into.solver.steps += steps;
        into.solver.residual_evaluations += steps * self.taylor.order() as u64;
        self.missed[lane] = self.steps;
    }

    /// Leaves a lane empty.
    pub fn vacate(&mut self, lane: usize) {
        self.occupied.set(lane, false);
    }
}

/// The transition that a guard of the present mode takes under any conditions, if lanes can take it side by side.
fn transition_in_lanes(of: &Simulation, guard: usize) -> Option<usize> {
    let transitions = &of.mode().guards[guard].transitions;
    let first = transitions.iter().position(|t| of.plan.allowed[t.target])?;
    // Where it ends the run its number is counted.
    let ends = |(name, _)| name == transitions[first].name;
    let stays = !of.problem.end.after.is_some_and(ends)
        && !transitions[first].conditional
        && transitions[first].kernel.stays_in_lanes();
    stays.then_some(first)
}
