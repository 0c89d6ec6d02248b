//! Transitions of lanes side by side: those that most events are. A guard falls, the reset leads to the same
//! mode, nothing stands still, and no guard acts at once. All others are taken by the engine for single runs.

use super::super::simulation::Simulation;
use super::group::{CoordinateGuard, Group};
use crate::integrate::{LaneMask, Lanes};
use crate::kernel::{lane_departs, lane_is_apart, lane_leap, lane_take};
use crate::run::Jump;

impl<const F: usize, const W: usize> Group<'_, F, W> {
    /// Takes the transitions of lanes that have just come to an event, where they are plain; gives these
    /// lanes, which go on, and those of them in which events may accumulate. Nothing has changed in the others.
    pub fn transit(&mut self) -> [LaneMask; 2] {
        let [mut gone, mut may_rest] = [LaneMask::NONE; 2];
        for number in 0..self.guards.len() {
            let guard = &self.guards[number];
            if let Some(transition) = guard.transition
                && guard.falls.any()
            {
                let taken = self.take(number, transition);
                [gone, may_rest] = [gone | taken[0], may_rest | taken[1]];
            }
        }
        [gone, may_rest]
    }

    /// The same for the events of a guard.
    fn take(&mut self, number: usize, transition: usize) -> [LaneMask; 2] {
        let (level, kernel) = (self.level, self.kernel);
        let guard = &mut self.guards[number];
        let lanes = guard.falls;
        let transition = &self.mode.guards[guard.guard].transitions[transition].kernel;
        let mut reset = std::mem::take(&mut guard.reset);
        let at = [&self.here.q, &self.here.v, &self.here.a];
        kernel.lane_reset(level, &self.context, transition, at, &mut reset);
        let [apart, may_rest] = lane_is_apart(level, &self.past, &self.here, &reset, &self.last);
        let tried = lanes & apart;
        let plain = match tried.any() {
            true => self.arrive(tried, &reset),
            false => tried,
        };
        self.guards[number].reset = reset;
        [plain, plain & may_rest]
    }

    /// Sets lanes to the state after a reset, where no guard acts there at once: gives these lanes.
    fn arrive(&mut self, tried: LaneMask, reset: &[Lanes<W>]) -> LaneMask {
        let (level, kernel) = (self.level, self.kernel);
        let coordinates = self.past.coordinates;
        let discrete = &reset[2 * coordinates..];
        lane_take(
            level,
            LaneMask::ALL,
            self.context.discrete(),
            &mut self.left,
        );
        lane_take(level, tried, discrete, self.context.discrete_mut());
        let mut plain = tried;
        for guard in &mut self.guards {
            let (index, rate) = guard.of;
            let (q, v) = (self.mode.free[index], coordinates + self.mode.free[index]);
            let of = match rate {
                true => (&reset[v], None),
                false => (&reset[q], Some(&reset[v])),
            };
            if guard.offset {
                let zero = [Lanes::of(0.0); F];
                let (context, origin) = (&self.context, [&zero; 3]);
                let own = &self.mode.guards[guard.guard].kernel;
                guard.after.offset = kernel.lane_guard(level, context, own, origin);
            }
            let (factor, discrete) = (guard.factor.0, guard.factor.1.map(|d| &discrete[d]));
            plain = plain & lane_departs(level, of, factor, discrete, &mut guard.after);
        }
        let back = tried & !plain;
        if back.any() {
            lane_take(level, back, &self.left, self.context.discrete_mut());
        }
        for guard in &mut self.guards {
            guard.linear.take(level, plain, &guard.after);
        }
        lane_leap(level, plain, reset, &mut self.here, &mut self.past);
        self.note_here(plain);
        plain
    }

    /// Records the transition of a guard that a lane has just taken: as [`Simulation::fire`], where the time advances
    /// before the next one, no transition is counted, and nothing is asked about doubts.
    pub fn record(&self, guard: &CoordinateGuard<W>, lane: usize, into: &mut Simulation) {
        let at = self.now(lane);
        let here = &mut into.here;
        here.j += 1;
        into.observers.recording.push(Jump {
            t: at.seconds(),
            j: here.j,
            transition: guard.name,
            from: self.index,
            to: self.index,
            energy: None,
        });
        let after = into.accumulation.push_apart(guard.key, at);
        for (after, row) in after.iter_mut().zip(&*guard.reset) {
            *after = row.0[lane];
        }
    }
}
