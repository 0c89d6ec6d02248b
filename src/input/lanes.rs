//! Signals of trajectories side by side.

use super::{INVERSES, Side, Signals};
use crate::integrate::Lanes;
use crate::model::InputKind;

/// The signals of several trajectories, each at its own time.
#[derive(Debug, Clone)]
pub struct LaneSignals<const W: usize> {
    /// Level of the processor, as in [`crate::kernel::LANES_OF_LEVELS`].
    level: usize,
    /// Times that the signals are set for, s; NaN: none.
    t: [f64; W],
    /// Rate of the function of each channel.
    rates: Box<[Lanes<W>]>,
}

impl<const W: usize> LaneSignals<W> {
    /// Not set for any time yet.
    pub fn new(level: usize, signals: &Signals) -> Self {
        LaneSignals {
            level,
            t: [f64::NAN; W],
            rates: vec![Lanes::of(0.0); signals.channels.len()].into(),
        }
    }

    /// Fills `u` with the signals right after the times `t` (s), unless it was for the same times
    /// before.
    #[inline(always)]
    pub fn set(&mut self, signals: &Signals, t: &[f64; W], u: &mut [Lanes<W>]) {
        if self.t == *t {
            return;
        }
        self.t = *t;
        for (c, rate) in signals.channels.iter().zip(&mut self.rates) {
            let jets = c.function.at_lanes(self.level, t, Side::Right);
            *rate = Lanes::from_fn(|i| jets[i].rate);
            u[c.signal] = Lanes::from_fn(|i| jets[i].value);
            if c.kind == InputKind::Acceleration {
                u[c.signal + 1] = Lanes::from_fn(|i| jets[i].integral);
                u[c.signal + 2] = Lanes::from_fn(|i| jets[i].double_integral);
            }
        }
    }

    /// What [`Signals::jets`] gives for the time of a lane; `u` was set with it.
    pub fn of_lane(
        &self,
        lane: usize,
        signals: &Signals,
        from: &[Lanes<W>],
        u: &mut [f64],
        u_dot: &mut [f64],
    ) {
        for (u, from) in u.iter_mut().zip(from) {
            *u = from.0[lane];
        }
        for (c, rate) in signals.channels.iter().zip(&self.rates) {
            u_dot[c.signal] = rate.0[lane];
            if c.kind == InputKind::Acceleration {
                u_dot[c.signal + 1] = u[c.signal];
                u_dot[c.signal + 2] = u[c.signal + 1];
            }
        }
    }

    /// Time that the signals of a lane are set for, s; NaN: none.
    pub fn time(&self, lane: usize) -> f64 {
        self.t[lane]
    }

    /// Fills `rows` with the Taylor coefficients of the signals about the times that `u` was set for.
    /// As [`Signals::series`].
    #[inline(always)]
    pub fn series(&self, signals: &Signals, u: &[Lanes<W>], rows: &mut [Lanes<W>]) {
        let width = u.len();
        if width == 0 {
            return;
        }
        let orders = rows.len() / width;
        let mut room = [Lanes::of(0.0); Signals::MOST_ORDERS];
        for (c, rate) in signals.channels.iter().zip(&self.rates) {
            let coefficients = &mut room[..orders];
            let known = [u[c.signal], *rate];
            c.function.series_of_lanes(&self.t, known, coefficients);
            for (row, value) in rows.chunks_exact_mut(width).zip(&*coefficients) {
                row[c.signal] = *value;
            }
            if c.kind == InputKind::Acceleration {
                rows[c.signal + 1] = u[c.signal + 1];
                rows[c.signal + 2] = u[c.signal + 2];
                for k in 1..orders {
                    for antiderivative in [c.signal + 1, c.signal + 2] {
                        rows[k * width + antiderivative] =
                            rows[(k - 1) * width + antiderivative - 1] * INVERSES[k];
                    }
                }
            }
        }
    }
}
