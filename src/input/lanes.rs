//! Signals of trajectories side by side.

use super::{INVERSES, Jet, Signals};
use crate::kernel::{LaneLevel, lane_antiderivative, lane_take};
use crate::model::InputKind;
use crate::numerics::{LaneMask, Lanes};

/// Value, rate and antiderivatives of a function at times of its own for each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct LaneJet<const W: usize>(
    /// As C has them: rate, value, integral, double integral.
    pub [Lanes<W>; 4],
);

impl<const W: usize> LaneJet<W> {
    /// Jets of each lane.
    pub fn from_jets(jets: [Jet; W]) -> Self {
        LaneJet([
            Lanes::from_fn(|i| jets[i].rate),
            Lanes::from_fn(|i| jets[i].value),
            Lanes::from_fn(|i| jets[i].integral),
            Lanes::from_fn(|i| jets[i].double_integral),
        ])
    }
}

/// The signals of several trajectories, each at its own time.
pub(crate) struct LaneSignals<const W: usize> {
    level: LaneLevel<W>,
    /// Times that the signals are set for, s; NaN: none.
    t: Lanes<W>,
    /// Of each channel.
    jets: Box<[LaneJet<W>]>,
}

impl<const W: usize> LaneSignals<W> {
    /// Not set for any time yet.
    pub fn new(level: LaneLevel<W>, signals: &Signals) -> Self {
        let zero = LaneJet([Lanes::of(0.0); 4]);
        LaneSignals {
            level,
            t: Lanes::of(f64::NAN),
            jets: vec![zero; signals.channels.len()].into(),
        }
    }

    /// Fills `u` with the signals right after the times `t` (s), unless it was for the same times
    /// before.
    #[inline]
    pub fn set(&mut self, signals: &Signals, t: &Lanes<W>, u: &mut [Lanes<W>]) {
        let same = |known: bool, lane: usize| known & (self.t.0[lane] == t.0[lane]);
        let known = (0..W).fold(true, same);
        if known {
            return;
        }
        self.t = *t;
        for (c, jet) in signals.channels.iter().zip(&mut self.jets) {
            c.function.at_lanes(self.level, t, jet);
            // As the lanes read them: in one piece.
            let count = match c.kind {
                InputKind::Acceleration => 3,
                _ => 1,
            };
            let (from, to) = (&jet.0[1..=count], &mut u[c.signal..][..count]);
            lane_take(self.level, LaneMask::ALL, from, to);
        }
    }

    /// What [`Signals::jets`] gives for the time of a lane.
    pub fn of_lane(&self, lane: usize, signals: &Signals, u: &mut [f64], u_dot: &mut [f64]) {
        for (c, jet) in signals.channels.iter().zip(&self.jets) {
            let [rate, value, integral, double_integral] = &jet.0;
            let jet = Jet {
                rate: rate.0[lane],
                value: value.0[lane],
                integral: integral.0[lane],
                double_integral: double_integral.0[lane],
            };
            c.set_values(&jet, u);
            c.set_rates(&jet, u_dot);
        }
    }

    /// Time that the signals of a lane are set for, s; NaN: none.
    pub fn time(&self, lane: usize) -> f64 {
        self.t.0[lane]
    }

    /// Fills `rows` with the Taylor coefficients of the signals about the times that they were set for:
    /// one row an order. As [`Signals::series`].
    #[inline]
    pub fn series(&self, signals: &Signals, wanted: &[bool], rows: &mut [Lanes<W>]) {
        let width = wanted.len();
        for (c, jet) in signals.channels.iter().zip(&self.jets) {
            let own = &mut rows[c.signal..];
            c.function
                .series_of_lanes(self.level, &self.t, jet, width, own);
            if wanted[c.antiderivatives()].contains(&true) {
                let [_, _, integral, double_integral] = jet.0;
                for (before, value) in [integral, double_integral].iter().enumerate() {
                    let rows = &mut own[before..];
                    lane_antiderivative(self.level, &INVERSES, value, rows, width);
                }
            }
        }
    }
}
