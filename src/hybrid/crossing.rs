//! The first event within a step.

use super::equations::Equations;
use super::failure::Stoppable;
use super::guards::{self, Conditions};
use super::locate::{Landing, is_rounding, land, land_later};
use super::plan::{Watched, is_impact};
use super::roots::{
    Crossing, Isolation, Kind, Search, Watch, at_most_one, earliest, first_of_several,
};
use super::search::search;
use super::touch::{below, fallen, turns_within_rounding};
use crate::integrate::{LastStep, Motion, OneStep, Path, State};
use crate::kernel::Free;
use crate::model::{Guard, GuardShape, Mode};
use crate::numerics::Size;
use crate::numerics::{Memory, Persist};

/// Remembered signs of what is watched in a mode.
#[derive(Debug, Default)]
pub(super) struct Signs {
    /// Signs at the start of the step.
    pub watches: Vec<Watch>,
    /// What was found of each in the step. Modes watch different numbers: there is room for the most so far.
    pub(super) found: Vec<Search>,
    /// Local time from which each is searched, where that is after the start of the step.
    from: Vec<f64>,
    /// Local time until which each that was zero at the start of the segment is known to be positive; else 0.
    pub(super) away: Vec<f64>,
    /// Whether that of one of them is not 0.
    waits: bool,
    /// Those that turned within rounding in the step and are not positive at its end.
    below: Vec<usize>,
    /// Whether the event of the step is that of a guard that was never seen to be positive.
    pub(super) unseen: bool,
    /// Whether that event is of a gap whose series alone told when.
    by_series: bool,
    /// Those that turned within rounding in the step, and where, local time; they have not fallen.
    touched: Vec<(usize, f64)>,
}

/// What was found in a step is found again in the next.
impl Persist for Signs {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        memory.list(&mut self.watches, || Watch::Dormant)?;
        memory.list(&mut self.away, f64::default)?;
        self.waits.persist(memory)?;
        memory.list(&mut self.below, usize::default)?;
        self.unseen.persist(memory)?;
        self.by_series.persist(memory)
    }
}

impl Persist for Watch {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        memory.one_of(self, &[Watch::Armed, Watch::Dormant, Watch::Violated])
    }
}

/// Result of [`cut`].
pub(super) enum Cut {
    /// No event: the step, perhaps shortened, is the motion; its end was written.
    Nothing,
    /// A guard, by its index in the mode, is crossed `beyond` after the end of the shortened step; the
    /// state there was written.
    Event { guard: usize, beyond: f64 },
    /// A guard that was zero at the start of the segment leaves it downwards; the start was written.
    Violated { guard: usize },
}

/// Events are in order if they are so far apart, as a part of the time since the start of the step: a thousand times what
/// a place near an event is off by.
const APART: f64 = 1.0e-6;

impl Signs {
    /// No signs yet.
    pub fn clear(&mut self) {
        self.watches.clear();
        self.away.clear();
        self.waits = false;
    }

    /// Adds the sign of the next at the start of a segment, and the local time until which it is known to be positive.
    #[inline(always)]
    pub fn remember(&mut self, watch: Watch, away: f64) {
        self.watches.push(watch);
        self.away.push(away);
        self.waits |= away > 0.0;
    }

    /// Local time until which one that was zero at the start of the segment is known to be positive; 0 of others.
    pub fn positive_until(&self, index: usize) -> f64 {
        self.away[index]
    }

    /// Whether one of them is searched only from some time on.
    pub fn waits(&self) -> bool {
        self.waits
    }

    /// Whether the event of the last step is that of a guard that was never seen to be positive: of what is less than
    /// the errors of the step.
    pub fn unseen(&self) -> bool {
        self.unseen
    }

    /// Whether the event of the last step is that of a gap whose series alone told when: of how far it was open its values have
    /// nothing but rounding.
    pub fn by_series(&self) -> bool {
        self.by_series
    }

    /// Those that turned within rounding in the last step, and where, local time.
    pub fn touched(&self) -> &[(usize, f64)] {
        &self.touched
    }

    /// Searches each from the start of a step, or from the time until which it is positive.
    #[inline(always)]
    fn search_from(&mut self, start: f64) {
        let count = self.watches.len();
        self.from[..count].fill(start);
        if self.waits {
            for (from, away) in self.from.iter_mut().zip(&self.away) {
                *from = from.max(*away);
            }
        }
    }

    /// Makes room for the search of as many as there are signs.
    #[inline(always)]
    pub fn start(&mut self) {
        let count = self.watches.len();
        if self.found.len() < count {
            self.found.resize(count, Search::nothing(Watch::Dormant));
            self.from.resize(count, 0.0);
        }
    }

    /// What was found of each in the step.
    pub fn found(&self) -> &[Search] {
        &self.found[..self.watches.len()]
    }

    /// Of each: the sign, what was found, and from where it is searched.
    #[inline(always)]
    fn parts(&mut self) -> (&mut [Watch], &mut [Search], &mut [f64]) {
        let count = self.watches.len();
        (
            &mut self.watches,
            &mut self.found[..count],
            &mut self.from[..count],
        )
    }

    /// The signs at the end of the step are those at the start of the next.
    pub fn go_on(&mut self) {
        for (watch, found) in self.watches.iter_mut().zip(&self.found) {
            *watch = found.watch;
        }
        self.waits |= !self.below.is_empty();
        for i in self.below.drain(..) {
            (self.watches[i], self.away[i]) = (Watch::Violated, f64::MIN_POSITIVE);
        }
    }
}

/// Cuts the last step at its first event, and writes the state there. The shortened step is searched again, since it
/// is a better solution than the dense output of the longer one.
pub(super) fn cut<'a, F: Size, M: OneStep<F, Equations<'a, F>>>(
    method: &mut M,
    equations: &mut Equations<'a, F>,
    conditions: &mut Conditions,
    (mode, watched): (&Mode, &[Watched]),
    (signs, landed): (&mut Signs, &mut State<F>),
) -> Stoppable<Cut> {
    let start = method.start().t;
    signs.search_from(start);
    (signs.unseen, signs.by_series) = (false, false);
    signs.touched.clear();
    if signs.waits {
        wake(method, equations, (mode, watched), signs);
    }
    let mut hides = false;
    loop {
        let dense = method.dense().expect("a step was made");
        let to = method.end();
        let time = match M::EXPLICIT {
            true => {
                let (watches, found, from) = signs.parts();
                // What is a coordinate or a rate costs little to search, and behind its event no other need be searched.
                let is_coordinate = |&i: &usize| is_coordinate(mode, watched[i]);
                let all = 0..watched.len();
                let others = all.clone().filter(|i| !is_coordinate(i));
                let order = all.filter(is_coordinate).chain(others);
                let mut nearest = to;
                let only = at_most_one(
                    (start, to),
                    watches,
                    found,
                    order,
                    |i, _, to, watch, found| {
                        let of = (&mode.guards[watched[i].guard], watched[i]);
                        let is_coordinate = is_coordinate(&i);
                        let to = if is_coordinate { to } else { nearest };
                        let window = (from[i], to);
                        let what = (watch, Isolation::Root, &mut *found);
                        match from[i] < to {
                            true => search(equations, conditions, dense, of, window, what),
                            false => *found = Search::nothing(watch),
                        }
                        if let (true, Some(crossing)) = (is_coordinate, found.crossing) {
                            let apart = APART * (crossing.outside - start);
                            nearest = nearest.min(crossing.outside + apart);
                        }
                    },
                );
                match only {
                    Some(only) => only.time,
                    None => put_in_order(equations, conditions, dense, (mode, watched), to, signs),
                }
            }
            false => search_all(equations, conditions, dense, (mode, watched), to, signs),
        };
        let (watches, found, from) = signs.parts();
        if hides {
            // They came to zero within rounding.
            for ((found, &watch), &from) in found.iter_mut().zip(&*watches).zip(&*from) {
                if watch == Watch::Armed && from > start {
                    found.turn = found.turn.min(0.0);
                }
            }
        }
        let first = time.and_then(|_| found.iter().position(|f| f.crossing.is_some()));
        let until = first.and_then(|first| found[first].crossing);
        if signs.waits {
            let until = until.map_or(to, |crossing| crossing.outside);
            let watched = (mode, watched);
            let fallen = fallen(method, equations, conditions, watched, signs, until)?;
            if let Some((guard, state)) = fallen {
                *landed = state;
                return Ok(Cut::Event { guard, beyond: 0.0 });
            }
        }
        let dense = method.dense().expect("a step was made");
        let (watches, found, from) = signs.parts();
        let Some(first) = first else {
            landed.clone_from(method.state());
            if hides {
                signs.below = below(equations, conditions, (mode, watched), signs, landed);
            }
            return Ok(Cut::Nothing);
        };
        let crossing = found[first].crossing.expect("it was found by it");
        let index = watched[first].guard;
        let guard = (&mode.guards[index], watched[first]);
        if crossing.kind == Kind::LeavesNegative && start == 0.0 && !watched[first].conditional {
            landed.clone_from(method.start());
            return Ok(Cut::Violated { guard: index });
        }
        let is_event = crossing.kind != Kind::Pole
            && (!watched[first].conditional
                || acts_together(equations, conditions, dense, guard, crossing));
        if !is_event {
            // The sign changes, but not through zero, or the other part of a conditional guard does not agree.
            watches[first] = Watch::Violated;
            from[first] = crossing.outside;
            continue;
        }
        let is_of_forces = watched[first].condition.is_none()
            && mode.is_of_forces(index, equations.context.discrete());
        let turns = (&found[first], crossing);
        if is_of_forces && turns_within_rounding(method, equations, conditions, guard, turns) {
            watches[first] = Watch::Violated;
            from[first] = crossing.outside.max(from[first].next_up());
            signs.touched.push((first, crossing.outside));
            continue;
        }
        // A contact that has left its gap, or its stop, within this step: where how far is below the rounding of its own value, it
        // is known from its series alone.
        let from_zero = watches[first] == Watch::Dormant && start == 0.0;
        let mut crossing = crossing;
        let is_stop = is_impact(guard.0) && !guard.0.is_exact() && !watched[first].conditional;
        let is_gap = mode.contacts.is_some() || is_stop;
        if M::EXPLICIT && from_zero && is_gap && crossing.kind == Kind::Crossing {
            let found = &mut found[first];
            let (start_of, dense) = (from[first], method.dense().expect("a step was made"));
            let window = (start_of, to);
            let what = (Watch::Dormant, Isolation::Bracket, &mut *found);
            search(equations, conditions, dense, guard, window, what);
            if let Some(of_series) = found.crossing {
                let t = of_series.outside;
                let (q, v, a) = dense.at(t);
                let end = State { t, q, v, a };
                let step = (method.start(), &end);
                if is_rounding(equations, conditions, guard, step)
                    && (mode.contacts.is_some()
                        || !closes_beside(equations, conditions, (mode, watched, first), step))
                {
                    method.step_exactly(equations, t - start)?;
                    landed.clone_from(method.state());
                    signs.by_series = true;
                    return Ok(Cut::Event {
                        guard: index,
                        beyond: 0.0,
                    });
                }
                crossing = of_series;
            }
        }
        let landing = match land(
            method,
            equations,
            conditions,
            guard,
            (crossing, is_of_forces),
            landed,
        )? {
            Landing::Short => {
                let of = (crossing, to);
                land_later(method, equations, conditions, guard, of, landed)?
            }
            landing => landing,
        };
        match landing {
            Landing::On { beyond } => {
                return Ok(Cut::Event {
                    guard: index,
                    beyond,
                });
            }
            Landing::Short => {}
            Landing::Hidden => {
                // Also where it was dormant.
                watches[first] = Watch::Armed;
                from[first] = method.end();
                hides = true;
            }
        }
    }
}

/// Whether a coordinate or a rate is watched.
#[inline(always)]
fn is_coordinate(mode: &Mode, watched: Watched) -> bool {
    let shape = mode.guards[watched.guard].shape;
    matches!(shape, GuardShape::Linear { .. }) && watched.condition.is_none()
}

/// Guards that were zero at the start of the segment and are not searched before some time of the last step: one that its
/// dense output does not show to be positive there, by its error, must show it before its fall counts.
#[cold]
fn wake<F: Size>(
    method: &dyn LastStep<F>,
    equations: &mut Equations<F>,
    (mode, watched): (&Mode, &[Watched]),
    signs: &mut Signs,
) {
    let dense = method.motion();
    for (i, watch) in signs.watches.iter_mut().enumerate() {
        let away = signs.away[i];
        if *watch == Watch::Armed && away > method.start().t && away < method.end() {
            let [q, v, a] = guards::motion(equations, dense, away, true);
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            let kernel = equations.kernel;
            let guard = &mode.guards[watched[i].guard];
            if kernel.guard(equations.context, &guard.kernel, at) <= 0.0 {
                *watch = Watch::Violated;
            }
        }
    }
}

/// Searches a guard, unless the window from which it is searched is empty.
#[inline(never)]
fn search_from<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    dense: &impl Motion<F>,
    guard: (&Guard, Watched),
    (from, to): (f64, f64),
    (watch, isolation, found): (Watch, Isolation, &mut Search),
) {
    if from >= to {
        *found = Search::nothing(watch);
        return;
    }
    let what = (watch, isolation, found);
    search(equations, conditions, dense, guard, (from, to), what);
}

/// Whether another stop than the first that closes in a step is closed at its end, as far as rounding tells: the values tell their order.
#[cold]
fn closes_beside<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    (mode, watched, first): (&Mode, &[Watched], usize),
    step: (&State<F>, &State<F>),
) -> bool {
    watched.iter().enumerate().any(|(i, watched)| {
        let other = &mode.guards[watched.guard];
        let is_stop = i != first && is_impact(other) && !other.is_exact();
        is_stop && is_rounding(equations, conditions, (other, *watched), step)
    })
}

/// Time of the first events of a step up to `to`, where places near the events of several guards were found: where
/// these may not be in order, all are isolated.
#[cold]
fn put_in_order<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    dense: &impl Motion<F>,
    (mode, watched): (&Mode, &[Watched]),
    to: f64,
    signs: &mut Signs,
) -> Option<f64> {
    let start = dense.start();
    let (watches, found, from) = signs.parts();
    let set_apart = |found: &mut Search| {
        if let Some(crossing) = &mut found.crossing {
            let apart = APART * (crossing.outside - start);
            crossing.inside = crossing.inside.min(crossing.outside - apart);
        }
    };
    found.iter_mut().for_each(set_apart);
    let set = first_of_several((start, to), watches, found, |i, _, to, watch, found| {
        let of = (&mode.guards[watched[i].guard], watched[i]);
        let what = (watch, Isolation::Root, &mut *found);
        search_from(equations, conditions, dense, of, (from[i], to), what);
        set_apart(found);
    });
    match found.iter().filter(|f| f.crossing.is_some()).count() {
        1 => set.time,
        _ => search_all(equations, conditions, dense, (mode, watched), to, signs),
    }
}

/// Time of the first events of a step up to `to`, all of them isolated.
fn search_all<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    dense: &impl Motion<F>,
    (mode, watched): (&Mode, &[Watched]),
    to: f64,
    signs: &mut Signs,
) -> Option<f64> {
    let (watches, found, from) = signs.parts();
    let search = |i: usize, _: f64, to: f64, watch: Watch, found: &mut Search| {
        let of = (&mode.guards[watched[i].guard], watched[i]);
        let what = (watch, Isolation::Bracket, found);
        search_from(equations, conditions, dense, of, (from[i], to), what)
    };
    earliest(dense.start(), to, watches, found, search).time
}

/// Whether the other part of a conditional guard agrees where one part falls through zero: where the guard does, that
/// the conditions of some transition hold; where a condition comes to hold, that the guard is violated and the others of
/// its transition hold. The part that falls is not asked for its value, which rounding may keep at zero there.
fn acts_together<F: Size>(
    equations: &mut Equations<F>,
    conditions: &mut Conditions,
    dense: &impl Motion<F>,
    (guard, watched): (&Guard, Watched),
    crossing: Crossing,
) -> bool {
    let [q, v, a] = guards::motion(equations, dense, crossing.outside, true);
    let at = Free {
        q: &q,
        v: &v,
        a: &a,
    };
    let (kernel, context) = (equations.kernel, &mut *equations.context);
    match watched.condition {
        None => {
            let plan = conditions.plan;
            let mut allowed = guard.transitions.iter().filter(|t| plan.allowed[t.target]);
            allowed.any(|t| conditions.least(kernel, context, t, at) >= 0.0)
        }
        Some((t, component)) => {
            let transition = &guard.transitions[t];
            kernel.guard(context, &guard.kernel, at) <= 0.0
                && conditions.least_but(kernel, context, (transition, component), at) >= 0.0
        }
    }
}
