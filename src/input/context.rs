//! The signals of a context: set, foreseen, expanded.

use super::{LaneSignals, Signals};
use crate::kernel::Context;
use crate::numerics::Side;

impl Context {
    /// The functions of the signals are others now.
    pub fn forget_signals(&mut self) {
        let room = self.signal_rooms();
        room.at.0 = f64::NAN;
        room.series.fill(0.0);
    }

    /// Sets signals and their rates to those at time `t` (s), as they are on that side.
    #[inline]
    pub fn set_signals(&mut self, signals: &Signals, t: f64, side: Side) {
        if self.autonomous {
            return;
        }
        let room = self.signal_rooms();
        if *room.at != (t, side) {
            let [values, rates] = room.now;
            signals.jets(t, side, values, rates);
            *room.at = (t, side);
        }
    }

    /// Whether [`Context::foresee_signals`] gives all that the equations of motion need: they depend on
    /// no antiderivative of an input, and on some input at all.
    pub fn can_foresee(&self, signals: &Signals) -> bool {
        !self.autonomous && !signals.want_antiderivatives(self.expanded())
    }

    /// Computes the signals at up to [`Context::MOST_AHEAD`] instants side by side, for
    /// [`Context::set_foreseen_signals`]; antiderivatives are left out.
    pub fn foresee_signals(&mut self, signals: &Signals, at: &[(f64, Side)]) {
        let room = self.signal_rooms();
        signals.values(at, room.now[0].len(), room.ahead);
    }

    /// Sets the signals to those of an instant that was foreseen, by its index: enough for the equations
    /// of motion, and for nothing else.
    #[inline]
    pub fn set_foreseen_signals(&mut self, index: usize) {
        let room = self.signal_rooms();
        let [values, _] = room.now;
        let row = &room.ahead[index * values.len()..][..values.len()];
        values.copy_from_slice(row);
        room.at.0 = f64::NAN;
    }

    /// Sets signals and their rates to those of a lane, as they are right after its time.
    pub(crate) fn set_signals_of_lane<const W: usize>(&mut self, of: &LaneSignals<W>, lane: usize) {
        let room = self.signal_rooms();
        let [values, rates] = room.now;
        of.of_lane(lane, values, rates);
        *room.at = (of.time(lane), Side::Right);
    }

    /// Sets signals, rates and Taylor coefficients of the signals to those just after time `t` (s).
    #[inline]
    pub fn expand_signals(&mut self, signals: &Signals, t: f64, orders: usize) {
        if !self.autonomous {
            self.set_signals(signals, t, Side::Right);
            let room = self.signal_rooms();
            let [values, rates] = room.now;
            let rows = &mut room.series[..orders * values.len()];
            signals.series(t, [values, rates], room.expanded, rows);
        }
    }
}
