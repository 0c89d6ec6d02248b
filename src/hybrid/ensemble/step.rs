//! A step of trajectories side by side. What the lanes hold does not depend on each other, nor on their
//! number.

use super::super::instant::Instant;
use super::super::roots::{Isolation, Kind, Search, Watch};
use super::super::search::{Coefficients, search_window};
use super::group::{Group, Way};
use crate::input::Signals;
use crate::integrate::{LaneMask, Lanes};
use crate::kernel::{
    LaneGuard, lane_crossed, lane_durations, lane_first_crossing, lane_take, lane_unmet,
};

/// Part of a step beyond which a root of its polynomial is not moved by rounding: as in
/// [`super::super::locate`].
const FARTHEST: f64 = 3.8e-6;

impl<const F: usize, const W: usize> Group<'_, F, W> {
    /// Makes a step in each occupied lane; gives the lanes that do not simply go on.
    pub fn step(&mut self) -> LaneMask {
        let in_pieces = self.find_pieces();
        let mut unclear = self.expand(in_pieces);
        let horizon = match in_pieces {
            true => &self.way.pieces[1],
            false => &self.way.unlimited,
        };
        let limits = ([&self.last, horizon], &self.past.tolerances[..]);
        let to = (&mut self.way.h, &mut unclear);
        let reached = self.taylor.length(&self.here, limits, to);
        let falls = self.first_crossings(&mut unclear);
        unclear = unclear | self.land(falls);
        unclear = unclear | self.unmet();
        let until = reached & !falls;

        let made = self.occupied & !unclear;
        self.find_extremes(made);
        self.here.take(self.level, made, &self.next);
        self.at_start = self.at_start & !made;
        for guard in &mut self.guards {
            let zero = &mut guard.linear.starts_at_zero;
            *zero = *zero & !made;
            guard.falls = guard.falls & made;
        }
        self.steps += 1;
        self.unclear = unclear & self.occupied;
        for lane in self.unclear.lanes() {
            self.missed[lane] += 1;
        }
        (falls | until | unclear) & self.occupied
    }

    /// Sets the absolute times of the analytic pieces of the inputs that act just after the present instants,
    /// and their durations; false where all lanes are in the last one. As in
    /// [`super::super::equations::Clock`].
    fn find_pieces(&mut self) -> bool {
        let [high, _] = &self.here.t;
        let from = self.analytic_from.0.iter();
        let in_pieces = (high.0.iter().zip(from)).fold(false, |any, (t, from)| any | (t < from));
        for lane in (0..W).filter(|_| in_pieces) {
            let now = self.now(lane);
            let [t, durations] = &mut self.way.pieces;
            (t.0[lane], durations.0[lane]) = piece(self.signals.of(lane), now);
        }
        in_pieces
    }

    /// Expands the motion as a series; gives the lanes in which that is not as usual.
    fn expand(&mut self, in_pieces: bool) -> LaneMask {
        let order = self.taylor.order();
        let context = &mut self.context;
        if !self.autonomous {
            let t = match in_pieces {
                true => &self.way.pieces[0],
                false => &self.here.t[0],
            };
            let (expanded, [values, rows]) = context.signals_mut();
            self.signals.set(t, values);
            let rows = &mut rows[..(order + 1) * expanded.len()];
            self.signals.series(expanded, rows);
        }
        let which = (self.level, self.autonomous);
        let (system, inverse) = (&mut self.way.system, &mut self.way.inverse);
        self.taylor.start_at(&self.here);
        let series = &mut self.taylor.series;
        self.kernel
            .lane_series_start(which, context, series, system);
        let unclear = self
            .taylor
            .begin(&self.here, self.at_start, system, inverse);
        let series = &mut self.taylor.series;
        self.kernel
            .lane_series_run(which, context, order, inverse, series);
        unclear
    }

    /// Looks for the first fall of a guard in each lane; gives the lanes with one.
    fn first_crossings(&mut self, unclear: &mut LaneMask) -> LaneMask {
        let mut falls = LaneMask::NONE;
        let Way {
            h,
            places,
            unlimited,
            ..
        } = &mut self.way;
        let (none, all) = (std::slice::from_ref(unlimited), LaneMask::ALL);
        lane_take(self.level, all, none, std::slice::from_mut(places));
        for number in 0..self.guards.len() {
            let guard = &mut self.guards[number];
            let (linear, coefficients) = (&guard.linear, &mut guard.coefficients);
            let found = self
                .taylor
                .first_crossing(guard.of, h, linear, coefficients, places);
            let ([mut first, look], count) = found;
            for lane in (look & self.occupied & !*unclear).lanes() {
                let dormant = guard.linear.starts_at_zero.is(lane);
                match search(&guard.coefficients[..count], lane, dormant) {
                    Some(place) if place < places.0[lane] => {
                        places.0[lane] = place;
                        first.set(lane, true);
                    }
                    Some(_) => {}
                    None => unclear.set(lane, true),
                }
            }
            guard.falls = first;
            for before in &mut self.guards[..number] {
                before.falls = before.falls & !first;
            }
            falls = falls | first;
        }
        if !self.general.is_empty() {
            self.search_general(unclear);
        }
        falls
    }

    /// Marks the lanes in which a guard that is no coordinate and no rate may fall before the first of those that are, by its own
    /// series, or that does not fall off: that is for the engine.
    fn search_general(&mut self, unclear: &mut LaneMask) {
        let order = self.taylor.order();
        let (context, series) = (&mut self.context, &mut self.taylor.series);
        let rows = (self.kernel).lane_guard_series(self.level, context, order, series);
        let Way { h, places, .. } = &self.way;
        let relative = self.past.tolerances[0].0;
        let itself = LaneGuard {
            factor: Lanes::of(1.0),
            offset: Lanes::of(0.0),
            starts_at_zero: LaneMask::NONE,
        };
        for &guard in &self.general {
            let (coefficients, mut place) = (&mut self.room, *places);
            let (all, which) = ((rows, order), (self.kernel.guards, guard));
            let [falls, looks] =
                lane_first_crossing(self.level, all, which, h, &itself, coefficients, &mut place);
            let mut sizes = [Lanes::<W>::of(0.0); 2];
            for (k, own) in coefficients[..order].iter().enumerate() {
                let last = k + 2 >= order;
                for lane in 0..W {
                    sizes[0].0[lane] += own.0[lane].abs();
                    sizes[1].0[lane] += if last { own.0[lane].abs() } else { 0.0 };
                }
            }
            *unclear = *unclear | falls | looks;
            for lane in 0..W {
                // As the search of a single run, which says why.
                let most = relative[lane] * ((order * order) as f64 * sizes[0].0[lane]);
                let falls_off = sizes[1].0[lane] <= most;
                let is_positive = coefficients[0].0[lane] > 0.0;
                if !(falls_off && is_positive) {
                    unclear.set(lane, true);
                }
            }
        }
    }

    /// Goes to the end of the step, in `next`: for a fall to the first state on its far side. Gives the
    /// lanes that have none.
    fn land(&mut self, falls: LaneMask) -> LaneMask {
        // A guard that all but fell at the end of the step before does so within the rounding of the start.
        let Way {
            h,
            places,
            durations,
            ..
        } = &mut self.way;
        lane_durations(self.level, h, places, FARTHEST, durations);
        let mut unclear = LaneMask::NONE;
        if !falls.any() {
            self.taylor.end(&self.here, &durations[0], &mut self.next);
            return unclear;
        }
        for guard in &self.guards {
            let (linear, lanes) = (&guard.linear, guard.falls);
            (self.taylor).cross(&self.here, guard.of, linear, lanes, durations);
        }
        let tau = &durations[0];
        self.taylor.end(&self.here, tau, &mut self.next);
        // The guards' own values decide: they may round an offset in another way.
        for guard in &self.guards {
            let at = [&self.next.q, &self.next.v, &self.next.a];
            let (kernel, context) = (self.kernel, &self.context);
            let own = &self.mode.guards[guard.guard].kernel;
            let value = kernel.lane_guard(self.level, context, own, at);
            if guard.is_stop {
                unclear = unclear | guard.falls & guard.linear.starts_at_zero;
            }
            // Beyond the rounding of the polynomial there is no such state.
            let crossed = lane_crossed(self.level, [&value, tau, h]);
            unclear = unclear | guard.falls & !crossed;
        }
        unclear
    }

    /// The lanes in which it is not certain that all that the mode requires holds in the whole step, and that
    /// no limit is reached.
    fn unmet(&mut self) -> LaneMask {
        if self.bounds.is_empty() {
            return LaneMask::NONE;
        }
        let which = (self.level, self.autonomous);
        let series = (&self.taylor.series, self.taylor.order());
        let [tau, ..] = &self.way.durations;
        let bounds = &mut self.bounds;
        self.kernel
            .lane_requirement_bounds(which, &mut self.context, series, tau, bounds);
        let margins = bounds.len() - self.passed.len();
        for (bound, passed) in bounds[margins..].iter_mut().zip(&self.passed) {
            for lane in (*passed & self.occupied).lanes() {
                bound.0[lane] = f64::INFINITY;
            }
        }
        lane_unmet(self.level, bounds)
    }
}

/// Looks for the first fall in a lane in full: infinite if there is none, `None` if there is something
/// else.
#[cold]
fn search<const W: usize>(coefficients: &[Lanes<W>], lane: usize, dormant: bool) -> Option<f64> {
    let own = Coefficients {
        count: coefficients.len(),
        constant: match dormant {
            true => 0.0,
            false => coefficients[0].0[lane],
        },
        rises: coefficients.get(1).is_some_and(|slope| slope.0[lane] > 0.0),
        write: &mut |first, out: &mut [f64]| {
            for (own, of) in out.iter_mut().zip(&coefficients[first..]) {
                *own = of.0[lane];
            }
            if dormant && first == 0 {
                out[0] = 0.0;
            }
        },
    };
    let watch = match dormant {
        true => Watch::Dormant,
        false => Watch::Armed,
    };
    let mut search = Search::nothing(watch);
    let window = ((0.0, 1.0), Isolation::Bracket);
    search_window(own, window, (watch, &mut search));
    match search.crossing {
        None if search.watch == Watch::Armed => Some(f64::INFINITY),
        Some(crossing) if crossing.kind == Kind::Crossing => Some(crossing.outside),
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
