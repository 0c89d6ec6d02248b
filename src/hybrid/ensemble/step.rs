//! A step of trajectories side by side. What the lanes hold does not depend on each other, nor on their
//! number.

use super::super::guards;
use super::super::instant::Instant;
use super::super::roots::{Kind, Watch};
use super::group::{Group, Outcome};
use crate::input::Signals;
use crate::integrate::{LaneMask, Lanes, ORDERS};
use crate::kernel::lane_unmet;

/// Part of a step beyond which a root of its polynomial is not moved by rounding: as in
/// [`super::super::locate`].
const FARTHEST: f64 = 3.8e-6;

/// The first fall of a guard in each lane.
struct Falls<const W: usize> {
    /// Which of the watched guards falls, if any.
    guards: [Option<u32>; W],
    /// Where, as a part of the step; 1 if none falls.
    places: Lanes<W>,
}

impl<const F: usize, const W: usize> Group<F, W> {
    /// Makes a step in each occupied lane; gives the lanes that do not simply go on.
    pub fn step(&mut self, signals: &Signals) -> LaneMask<W> {
        let (t, horizon) = self.pieces(signals);
        let mut unclear = LaneMask::none();
        self.expand(signals, &t, &mut unclear);
        let limits = [&self.last, &horizon];
        let (h, reached) = self.taylor.length(&self.here, limits, &mut unclear);
        let falls = self.first_falls(&h, &mut unclear);
        self.land(&h, &falls, &mut unclear);
        let mut ended = unclear;
        for lane in 0..W {
            self.outcomes[lane] = match falls.guards[lane] {
                Some(number) => Outcome::Event(self.guards[number as usize].guard),
                None if reached.is(lane) => Outcome::Until,
                None => continue,
            };
            ended.set(lane, true);
        }
        self.check_end(signals, &reached, &falls, &mut unclear);

        let made = self.occupied.without(&unclear);
        self.here.take(self.level, &made, &self.next);
        self.at_start = self.at_start.without(&made);
        for guard in &mut self.guards {
            guard.starts_at_zero = guard.starts_at_zero.without(&made);
        }
        for lane in 0..W {
            self.steps[lane] += made.0[lane] & 1;
            if unclear.is(lane) {
                self.outcomes[lane] = Outcome::Unclear;
            }
        }
        ended.or(&unclear)
    }

    /// Absolute times of the analytic pieces of the inputs that act just after the present instants, and
    /// their durations, s. As in [`super::super::equations::Clock`].
    fn pieces(&self, signals: &Signals) -> (Lanes<W>, Lanes<W>) {
        let (mut t, mut durations) = (self.here.t[0], Lanes::of(f64::INFINITY));
        if t.0.iter().any(|&t| t < self.analytic_from) {
            for lane in 0..W {
                let now = self.now(lane);
                (t.0[lane], durations.0[lane]) = piece(signals, now);
            }
        }
        (t, durations)
    }

    /// Expands the motion as a series.
    fn expand(&mut self, signals: &Signals, t: &Lanes<W>, unclear: &mut LaneMask<W>) {
        let order = self.taylor.order();
        let context = &mut self.context;
        if !self.quiet {
            let expanded = context.expanded();
            self.signals.set(signals, t, &mut context.signals);
            let rows = &mut context.signal_series[..(order + 1) * expanded.len()];
            self.signals.series(signals, expanded, rows);
        }
        let which = (self.level, self.quiet);
        let series = &mut self.taylor.series;
        (series.q[0], series.v[0]) = (self.here.q, self.here.v);
        let system = self.kernel.lane_series_start(which, context, series);
        let (here, at_start) = (&self.here, &self.at_start);
        let inverse = self.taylor.begin(here, at_start, &system, unclear);
        let series = &mut self.taylor.series;
        if std::mem::take(&mut self.unchecked) && !self.requirements.is_empty() {
            let at = [&series.q[0], &series.v[0], &series.a[0]];
            let requirements = &mut self.requirements;
            self.kernel
                .lane_requirements(self.level, context, at, requirements);
            lane_unmet(self.level, requirements, unclear);
        }
        self.kernel
            .lane_series_run(which, context, order, &inverse, series);
    }

    /// The first fall of a guard in each lane.
    fn first_falls(&mut self, h: &Lanes<W>, unclear: &mut LaneMask<W>) -> Falls<W> {
        let mut falls = Falls {
            guards: [None; W],
            places: Lanes::of(1.0),
        };
        for (number, guard) in self.guards.iter_mut().enumerate() {
            let of = (guard.index, guard.rate);
            let numbers = [h, &guard.factor, &guard.offset];
            let zero = &guard.starts_at_zero;
            let found = (self.taylor).first_fall(of, numbers, zero, &mut guard.coefficients);
            let (places, count) = found;
            for lane in 0..W {
                let mut place = places.0[lane];
                if place.is_nan() && self.occupied.is(lane) && !unclear.is(lane) {
                    let coefficients = &guard.coefficients[..count];
                    match search(coefficients, lane, zero.is(lane)) {
                        Some(found) => place = found,
                        None => unclear.set(lane, true),
                    }
                }
                let first = falls.guards[lane].is_none() || place < falls.places.0[lane];
                if place <= 1.0 && first {
                    falls.guards[lane] = Some(number as u32);
                    falls.places.0[lane] = place;
                }
            }
        }
        falls
    }

    /// The end of the step, in `next`: for a fall the first state on its far side.
    fn land(&mut self, h: &Lanes<W>, falls: &Falls<W>, unclear: &mut LaneMask<W>) {
        // A guard that all but fell at the end of the step before does so within the rounding of the start.
        let tau = |lane: usize| (h.0[lane] * falls.places.0[lane]).max(f64::MIN_POSITIVE);
        let mut tau = Lanes::from_fn(tau);
        self.taylor.end(&self.here, &tau, &mut self.next);
        if falls.guards.iter().all(Option::is_none) {
            return;
        }
        let mut last_place = tau.0.map(|tau| tau * f64::EPSILON);
        loop {
            let short = self.not_crossed(falls).without(unclear);
            if !short.any() {
                return;
            }
            for lane in (0..W).filter(|&lane| short.is(lane)) {
                tau.0[lane] += last_place[lane];
                last_place[lane] *= 2.0;
                // Beyond the rounding of the polynomial there is no such state.
                if last_place[lane] > FARTHEST * h.0[lane] || tau.0[lane] > h.0[lane] {
                    unclear.set(lane, true);
                }
            }
            self.taylor.end(&self.here, &tau, &mut self.next);
        }
    }

    /// The lanes in which the guard that falls is not negative at the end of the step.
    fn not_crossed(&self, falls: &Falls<W>) -> LaneMask<W> {
        let mut short = LaneMask::none();
        for (number, guard) in self.guards.iter().enumerate() {
            let here = |lane: &usize| falls.guards[*lane] == Some(number as u32);
            if !(0..W).any(|lane| here(&lane)) {
                continue;
            }
            let at = [&self.next.q, &self.next.v, &self.next.a];
            let value = (self.kernel).lane_guard(self.level, &self.context, guard.guard, at);
            for lane in (0..W).filter(here) {
                let crossed = value.0[lane] < 0.0;
                short.set(lane, self.occupied.is(lane) && !crossed);
            }
        }
        short
    }

    /// What the mode requires must hold at the end of the step; at the end of a segment the caller looks.
    fn check_end(
        &mut self,
        signals: &Signals,
        reached: &LaneMask<W>,
        falls: &Falls<W>,
        unclear: &mut LaneMask<W>,
    ) {
        if self.requirements.is_empty() {
            return;
        }
        let context = &mut self.context;
        if !self.quiet {
            self.signals
                .set(signals, &self.next.t[0], &mut context.signals);
        }
        let at = [&self.next.q, &self.next.v, &self.next.a];
        let requirements = &mut self.requirements;
        self.kernel
            .lane_requirements(self.level, context, at, requirements);
        let mut unmet = LaneMask::none();
        lane_unmet(self.level, requirements, &mut unmet);
        for lane in 0..W {
            if unmet.is(lane) && (falls.guards[lane].is_some() || !reached.is(lane)) {
                unclear.set(lane, true);
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

/// Absolute time of the analytic piece that acts just after an instant, and its duration, s.
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
