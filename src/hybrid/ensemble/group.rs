//! Trajectories of one mode side by side, from one event of each to its next.

use super::super::crossing::Signs;
use super::super::guards;
use super::super::instant::Instant;
use super::super::roots::{Kind, Watch};
use super::super::segment::tolerances;
use super::super::simulation::Simulation;
use crate::input::{LaneSignals, Signals};
use crate::integrate::{LaneMask, LaneTaylor, Lanes, ORDERS};
use crate::kernel::{Free, LaneContext, ModeKernel};
use crate::model::{GuardShape, Mode};
use nalgebra::SVector;

/// What became of a lane in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Outcome {
    /// It goes on.
    GoesOn,
    /// It has come to where its inputs are not smooth, or to the end.
    Until,
    /// A guard, by its index in the mode, has fallen.
    Event(usize),
    /// The step has not been made: something is not as usual and needs to be looked at in full.
    Unclear,
}

/// A guard of the mode: factor · (a coordinate or rate) + offset.
struct LaneGuard<const W: usize> {
    /// Index in the mode.
    guard: usize,
    index: usize,
    rate: bool,
    factor: Lanes<W>,
    offset: Lanes<W>,
    /// Whether it is zero at the start of the step.
    starts_at_zero: LaneMask<W>,
}

/// Up to `W` trajectories in one mode.
pub(super) struct Group<const F: usize, const W: usize> {
    kernel: &'static ModeKernel<F>,
    mode: &'static Mode,
    /// Level of the processor.
    level: usize,
    /// Whether no input ever acts.
    quiet: bool,
    taylor: LaneTaylor<F, W>,
    context: LaneContext<W>,
    signals: LaneSignals<W>,
    guards: Vec<LaneGuard<W>>,
    /// Coordinates and velocities, and what rounding has lost of them.
    state: [[Lanes<W>; F]; 2],
    lost: [[Lanes<W>; F]; 2],
    /// Accelerations, where the segment starts.
    given: [Lanes<W>; F],
    at_start: [bool; W],
    now: [Instant; W],
    /// Where inputs are not smooth, or the end, s.
    last: [f64; W],
    /// Time after which the inputs are analytic, s.
    analytic_from: f64,
    requirements: Vec<Lanes<W>>,
    /// Whether a lane has just been set: what the mode requires has not been looked at.
    unchecked: bool,
    /// What became of each lane in the last step.
    pub outcomes: [Outcome; W],
    /// Steps made in each lane since it was loaded.
    pub steps: [u64; W],
    /// Which lanes hold a trajectory.
    pub occupied: [bool; W],
}

impl<const F: usize, const W: usize> Group<F, W> {
    /// An empty group for the mode of a simulation, whose state is put into the empty lanes.
    pub fn new(
        kernel: &'static ModeKernel<F>,
        level: usize,
        quiet: bool,
        like: &Simulation,
    ) -> Self {
        let (problem, mode) = (like.problem, like.mode());
        let zero = [Lanes::of(0.0); F];
        let guards = like.plan.watched[like.here.mode].iter().map(|watched| {
            let GuardShape::Linear { index, rate, .. } = mode.guards[watched.guard].shape else {
                unreachable!("codegen has looked at the guards of what goes in lanes")
            };
            LaneGuard {
                guard: watched.guard,
                index,
                rate,
                factor: Lanes::of(1.0),
                offset: Lanes::of(0.0),
                starts_at_zero: LaneMask::none(),
            }
        });
        let convolutions = kernel.convolutions(&like.context);
        let mut group = Group {
            kernel,
            mode,
            level,
            quiet,
            taylor: LaneTaylor::new(level, &tolerances(problem, mode), convolutions),
            context: LaneContext::new(kernel, &like.context),
            signals: LaneSignals::new(level, &problem.signals),
            guards: guards.collect(),
            state: [zero; 2],
            lost: [zero; 2],
            given: zero,
            at_start: [true; W],
            now: [Instant::default(); W],
            last: [f64::INFINITY; W],
            analytic_from: analytic_from(&problem.signals),
            requirements: vec![Lanes::of(0.0); mode.requirements.len()],
            unchecked: true,
            outcomes: [Outcome::GoesOn; W],
            steps: [0; W],
            occupied: [false; W],
        };
        for lane in 0..W {
            group.load(lane, like);
        }
        group.occupied = [false; W];
        group
    }

    /// Whether the guards of a simulation that has just entered the mode can be followed in a lane.
    pub fn takes(signs: &Signs) -> bool {
        signs.watches.iter().all(|watch| *watch != Watch::Violated)
    }

    /// Puts a trajectory, which has just entered the mode, into a lane.
    pub fn load(&mut self, lane: usize, from: &Simulation) {
        self.context.load(lane, &from.context);
        self.set(lane, from);
        for (guard, watch) in self.guards.iter_mut().zip(&from.signs.watches) {
            guard.starts_at_zero.set(lane, *watch == Watch::Dormant);
        }
        self.at_start[lane] = true;
        self.unchecked = true;
        self.steps[lane] = 0;
        self.occupied[lane] = true;
    }

    /// Goes on in the lane that a trajectory is in, after an event whose reset has led to the same mode
    /// again; false where it must enter the mode as any other.
    ///
    /// The accelerations, the mass matrix and what the mode requires are looked at in the next step.
    pub fn go_on(&mut self, lane: usize, from: &Simulation) -> bool {
        self.context.load_state(lane, &from.context);
        self.set(lane, from);
        for guard in &mut self.guards {
            let of = |state: &[Lanes<W>; F]| guard.factor.0[lane] * state[guard.index].0[lane];
            let value = of(&self.state[guard.rate as usize]) + guard.offset.0[lane];
            guard.starts_at_zero.set(lane, value == 0.0);
            let leaves_upwards = !guard.rate && of(&self.state[1]) > 0.0;
            if !(value > 0.0 || value == 0.0 && leaves_upwards) {
                return false;
            }
        }
        self.at_start[lane] = false;
        self.unchecked = true;
        true
    }

    fn set(&mut self, lane: usize, from: &Simulation) {
        let [q, v, a] = from.here.free::<F>(self.mode.free);
        for i in 0..F {
            self.state[0][i].0[lane] = q[i];
            self.state[1][i].0[lane] = v[i];
            self.given[i].0[lane] = a[i];
            self.lost[0][i].0[lane] = 0.0;
            self.lost[1][i].0[lane] = 0.0;
        }
        self.now[lane] = from.here.now;
        let breakpoint = from
            .problem
            .signals
            .next_breakpoint(from.here.now.seconds());
        self.last[lane] = breakpoint.min(from.problem.end.time);
        let zero = SVector::<f64, F>::zeros();
        let origin = Free {
            q: &zero,
            v: &zero,
            a: &zero,
        };
        for guard in &mut self.guards {
            let model = &self.mode.guards[guard.guard];
            let GuardShape::Linear {
                factor,
                discrete,
                offset,
                ..
            } = model.shape
            else {
                unreachable!("codegen has looked at the guards of what goes in lanes")
            };
            let sign = discrete.map_or(1.0, |d| from.context.discrete[d]);
            guard.factor.0[lane] = factor * sign;
            guard.offset.0[lane] = match offset {
                true => self.kernel.guard(&from.context, &model.kernel, origin),
                false => 0.0,
            };
        }
        self.outcomes[lane] = Outcome::GoesOn;
    }

    /// Takes a trajectory out of its lane, where it may be left for [`Group::go_on`].
    pub fn unload(&mut self, lane: usize, into: &mut Simulation) {
        let column = |rows: &[Lanes<W>; F]| SVector::<f64, F>::from_fn(|i, _| rows[i].0[lane]);
        let [q, v, a] = [
            column(&self.state[0]),
            column(&self.state[1]),
            column(&self.given),
        ];
        into.here.set_free(self.mode.free, [&q, &v, &a]);
        into.here.now = match self.outcomes[lane] {
            Outcome::Until => Instant::new(self.last[lane]),
            _ => self.now[lane],
        };
        let t = into.here.now.seconds();
        if !self.quiet && self.outcomes[lane] != Outcome::Until && t == self.signals.time(lane) {
            let signals = &into.problem.signals;
            into.context.set_signals_of_lane(
                &self.signals,
                lane,
                signals,
                t,
                &self.context.signals,
            );
        }
        into.solver.steps += self.steps[lane];
        into.solver.residual_evaluations += self.steps[lane] * self.taylor.order() as u64;
        self.steps[lane] = 0;
    }

    /// Leaves a lane empty.
    pub fn vacate(&mut self, lane: usize) {
        self.occupied[lane] = false;
    }

    /// Makes a step in each occupied lane.
    pub fn step(&mut self, signals: &Signals) {
        step(self, signals);
        // Outside of the vectorised part: what is rare.
        for lane in 0..W {
            if self.occupied[lane] && self.outcomes[lane] != Outcome::Unclear {
                self.steps[lane] += 1;
            }
        }
    }
}

/// Looks for the first fall in a lane in full: infinite if there is none, `None` if there is something
/// else.
#[cold]
fn search<const W: usize>(coefficients: &[Lanes<W>], lane: usize, dormant: bool) -> Option<f64> {
    let mut own = [0.0; ORDERS];
    for (own, of) in own.iter_mut().zip(coefficients) {
        *own = of.0[lane];
    }
    let watch = if dormant {
        own[0] = 0.0;
        Watch::Dormant
    } else {
        Watch::Armed
    };
    let search = guards::search_window(&own[..coefficients.len()], (0.0, 1.0), watch);
    match search.crossing {
        None if search.watch == Watch::Armed => Some(f64::INFINITY),
        Some(crossing) if crossing.kind == Kind::Fall => Some(crossing.outside),
        _ => None,
    }
}

/// The inverse of M by elimination without exchanges, where all pivots are positive: else the lane is
/// marked.
#[inline(always)]
fn inverse<const F: usize, const W: usize>(
    mass: &[[Lanes<W>; F]; F],
    unclear: &mut [bool; W],
) -> [[Lanes<W>; F]; F] {
    let mut m = *mass;
    let mut inverse = [[Lanes::of(0.0); F]; F];
    for k in 0..F {
        inverse[k][k] = Lanes::of(1.0);
    }
    // Columns: m[j][i] is the entry of row i.
    for k in 0..F {
        let pivot = m[k][k];
        for lane in 0..W {
            // A pivot within the rounding of its own sum is not told from zero.
            let rounding = (F + 1) as f64 * f64::EPSILON * mass[k][k].0[lane].abs();
            unclear[lane] |= pivot.0[lane].is_nan() || pivot.0[lane] <= rounding;
        }
        for j in 0..F {
            if j > k {
                m[j][k] = m[j][k] / pivot;
            }
            inverse[j][k] = inverse[j][k] / pivot;
        }
        for i in (0..F).filter(|&i| i != k) {
            let factor = m[k][i];
            for j in 0..F {
                if j > k {
                    m[j][i] = m[j][i] - factor * m[j][k];
                }
                inverse[j][i] = inverse[j][i] - factor * inverse[j][k];
            }
        }
    }
    inverse
}

/// Marks the lanes in which not all that is required is positive.
#[inline(always)]
fn unmet<const W: usize>(requirements: &[Lanes<W>], marked: &mut [bool; W]) {
    for value in requirements {
        for lane in 0..W {
            let met = value.0[lane] > 0.0;
            marked[lane] |= !met;
        }
    }
}

/// The last time at which some input is not analytic, s.
fn analytic_from(signals: &Signals) -> f64 {
    let mut last = 0.0;
    loop {
        match signals.next_knot(last) {
            f64::INFINITY => return last,
            knot => last = knot,
        }
    }
}

/// Absolute time of the analytic piece that acts just after an instant, and its duration, s. As in
/// [`super::super::equations::Clock`].
fn piece(signals: &Signals, now: Instant) -> (f64, f64) {
    let mut t = now.seconds();
    loop {
        let knot = signals.next_knot(t);
        if knot == f64::INFINITY {
            return (t, knot);
        }
        let limit = Instant::new(knot).since(now);
        if limit > 0.0 {
            return (t, limit);
        }
        t = knot;
    }
}

/// A step of each lane. What the lanes hold does not depend on each other, nor on their number.
fn step<const F: usize, const W: usize>(group: &mut Group<F, W>, signals: &Signals) {
    let mut unclear = [false; W];
    let mut t = [0.0; W];
    let (mut remaining, mut horizon) = (Lanes::of(f64::INFINITY), Lanes::of(f64::INFINITY));
    for lane in 0..W {
        let now = group.now[lane];
        remaining.0[lane] = Instant::new(group.last[lane]).since(now);
        (t[lane], horizon.0[lane]) = match group.analytic_from <= now.seconds() {
            true => (now.seconds(), f64::INFINITY),
            false => piece(signals, now),
        };
    }
    let order = group.taylor.order();
    let context = &mut group.context;
    if !group.quiet {
        group.signals.set(signals, &t, &mut context.signals);
        let rows = (order + 1) * context.signals.len();
        let rows = &mut context.signal_series[..rows];
        group.signals.series(signals, &context.signals, rows);
    }

    // The motion as a series.
    let series = &mut group.taylor.series;
    [series.q[0], series.v[0]] = group.state;
    let kernel = group.kernel;
    let system = kernel.lane_series_start(group.level, group.quiet, context, series);
    let inverse = inverse(&system.mass, &mut unclear);
    for i in 0..F {
        let mut acceleration = Lanes::of(0.0);
        for j in 0..F {
            acceleration = acceleration - inverse[j][i] * system.load[j];
        }
        let given = &group.given[i];
        series.a[0][i] = Lanes::from_fn(|lane| match group.at_start[lane] {
            true => given.0[lane],
            false => acceleration.0[lane],
        });
        series.q[1][i] = series.v[0][i];
        series.v[1][i] = series.a[0][i];
        series.q[2][i] = series.a[0][i] * 0.5;
    }
    if std::mem::take(&mut group.unchecked) && !group.requirements.is_empty() {
        let at = [&series.q[0], &series.v[0], &series.a[0]];
        let requirements = &mut group.requirements;
        kernel.lane_requirements(group.level, context, at, requirements);
        unmet(requirements, &mut unclear);
    }
    let which = (group.level, group.quiet);
    kernel.lane_series_run(which, context, order, &inverse, series);
    let h = group.taylor.length(&remaining, &horizon);
    for lane in 0..W {
        unclear[lane] |= !group.taylor.is_finite(lane) || t[lane] + h.0[lane] == t[lane];
    }

    // The first fall of a guard.
    let mut fallen = [usize::MAX; W];
    let mut place = Lanes::of(1.0);
    for (number, guard) in group.guards.iter().enumerate() {
        let mut coefficients = [Lanes::of(0.0); ORDERS];
        let of = (guard.index, guard.rate);
        let numbers = [&h, &guard.factor, &guard.offset];
        let zero = &guard.starts_at_zero;
        let (falls, count) = group
            .taylor
            .first_fall(of, numbers, zero, &mut coefficients);
        for lane in 0..W {
            let mut s = falls.0[lane];
            if s.is_nan() && group.occupied[lane] && !unclear[lane] {
                match search(&coefficients[..count], lane, zero.is(lane)) {
                    Some(found) => s = found,
                    None => unclear[lane] = true,
                }
            }
            if s <= 1.0 && (fallen[lane] == usize::MAX || s < place.0[lane]) {
                (fallen[lane], place.0[lane]) = (number, s);
            }
        }
    }

    // The end of the step: for a fall the first state on its far side.
    let mut tau = h * place;
    // A guard that all but fell at the end of the step before does so within the rounding of the start.
    tau = tau.map(|tau| if tau > 0.0 { tau } else { f64::MIN_POSITIVE });
    let mut last_place = tau * f64::EPSILON;
    let (mut state, mut lost) = group.taylor.state(&tau, &group.lost);
    let acceleration = group.taylor.acceleration(&tau);
    loop {
        let mut short = [false; W];
        for (number, guard) in group.guards.iter().enumerate() {
            if !fallen.contains(&number) {
                continue;
            }
            let at = [&state[0], &state[1], &acceleration];
            let value = kernel.lane_guard(group.level, &group.context, guard.guard, at);
            for lane in 0..W {
                let here = fallen[lane] == number && group.occupied[lane] && !unclear[lane];
                let crossed = value.0[lane] < 0.0;
                short[lane] |= here && !crossed;
            }
        }
        if !short.contains(&true) {
            break;
        }
        for lane in 0..W {
            if short[lane] {
                tau.0[lane] += last_place.0[lane];
                last_place.0[lane] *= 2.0;
                // Beyond the rounding of the polynomial there is no such state.
                unclear[lane] |=
                    last_place.0[lane] > FARTHEST * h.0[lane] || tau.0[lane] > h.0[lane];
            }
        }
        (state, lost) = group.taylor.state(&tau, &group.lost);
    }
    let (mut end, mut until) = (group.now, [false; W]);
    for lane in 0..W {
        end[lane] = group.now[lane].plus(tau.0[lane]);
        until[lane] = fallen[lane] == usize::MAX && h.0[lane] == remaining.0[lane];
    }

    // What the mode requires must hold there; at the end of the segment the caller looks.
    if !group.requirements.is_empty() {
        let context = &mut group.context;
        if !group.quiet {
            for lane in 0..W {
                t[lane] = end[lane].seconds();
            }
            group.signals.set(signals, &t, &mut context.signals);
        }
        let at = [&state[0], &state[1], &acceleration];
        let requirements = &mut group.requirements;
        kernel.lane_requirements(group.level, context, at, requirements);
        let mut here = [false; W];
        unmet(requirements, &mut here);
        for lane in 0..W {
            unclear[lane] |= here[lane] && !until[lane];
        }
    }

    for lane in 0..W {
        if !group.occupied[lane] {
            continue;
        }
        if unclear[lane] {
            group.outcomes[lane] = Outcome::Unclear;
            continue;
        }
        for x in 0..2 {
            for i in 0..F {
                group.state[x][i].0[lane] = state[x][i].0[lane];
                group.lost[x][i].0[lane] = lost[x][i].0[lane];
            }
        }
        for i in 0..F {
            group.given[i].0[lane] = acceleration[i].0[lane];
        }
        group.at_start[lane] = false;
        group.now[lane] = end[lane];
        for guard in &mut group.guards {
            guard.starts_at_zero.set(lane, false);
        }
        group.outcomes[lane] = match fallen[lane] {
            usize::MAX if until[lane] => Outcome::Until,
            usize::MAX => Outcome::GoesOn,
            number => Outcome::Event(group.guards[number].guard),
        };
    }
}

/// Part of a step beyond which a root of its polynomial is not moved by rounding: as in
/// [`super::super::locate`].
const FARTHEST: f64 = 3.8e-6;
