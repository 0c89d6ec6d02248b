//! Signals of trajectories side by side.

use super::sine::LaneSines;
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
    /// The jet of a lane.
    pub fn get(&self, lane: usize) -> Jet {
        let [rate, value, integral, double_integral] = &self.0;
        Jet {
            rate: rate.0[lane],
            value: value.0[lane],
            integral: integral.0[lane],
            double_integral: double_integral.0[lane],
        }
    }

    /// Sets the jet of a lane.
    pub fn set(&mut self, lane: usize, jet: Jet) {
        let of_jet = [jet.rate, jet.value, jet.integral, jet.double_integral];
        for (row, x) in self.0.iter_mut().zip(of_jet) {
            row.0[lane] = x;
        }
    }
}

/// The signals of several trajectories, each at its own time.
pub(crate) struct LaneSignals<'s, const W: usize> {
    level: LaneLevel<W>,
    /// The functions of each lane.
    of: [&'s Signals; W],
    /// Which of them differ, and the lanes that have each.
    groups: Vec<(&'s Signals, LaneMask)>,
    /// Of each channel, the sines.
    sines: Box<[LaneSines<W>]>,
    /// Times that the signals are set for, s; NaN: none.
    t: Lanes<W>,
    /// Of each channel.
    jets: Box<[LaneJet<W>]>,
}

impl<'s, const W: usize> LaneSignals<'s, W> {
    /// The same in all lanes, not set for any time yet.
    pub fn new(level: LaneLevel<W>, signals: &'s Signals) -> Self {
        let zero = LaneJet([Lanes::of(0.0); 4]);
        LaneSignals {
            level,
            of: [signals; W],
            groups: vec![(signals, LaneMask::ALL)],
            sines: sines(&[signals; W]),
            t: Lanes::of(f64::NAN),
            jets: vec![zero; signals.channels.len()].into(),
        }
    }

    /// Gives a lane functions of its own, of the same inputs.
    pub fn load(&mut self, lane: usize, signals: &'s Signals) {
        if std::ptr::eq(self.of[lane], signals) {
            return;
        }
        self.of[lane] = signals;
        self.t.0[lane] = f64::NAN;
        self.groups.clear();
        for (lane, of) in self.of.iter().enumerate() {
            let known = (self.groups.iter_mut()).find(|(known, _)| std::ptr::eq(*known, *of));
            match known {
                Some((_, lanes)) => lanes.set(lane, true),
                None => self.groups.push((of, LaneMask(1 << lane))),
            }
        }
        if let [(_, lanes)] = &mut self.groups[..] {
            *lanes = LaneMask::ALL;
        }
        self.sines = sines(&self.of);
    }

    /// The functions of a lane.
    pub fn of(&self, lane: usize) -> &'s Signals {
        self.of[lane]
    }

    /// Fills `u` with the signals right after the times `t` (s), unless it was for the same times
    /// before.
    #[inline]
    pub fn set(&mut self, t: &Lanes<W>, u: &mut [Lanes<W>]) {
        let same = |known: bool, lane: usize| known & (self.t.0[lane] == t.0[lane]);
        let known = (0..W).fold(true, same);
        if known {
            return;
        }
        self.t = *t;
        for (sines, jet) in self.sines.iter().zip(&mut self.jets) {
            if sines.lanes.any() {
                sines.at(self.level, t, jet);
            }
        }
        for &(signals, lanes) in &self.groups {
            let channels = signals.channels.iter().zip(&mut self.jets);
            for (c, jet) in channels.filter(|(c, _)| c.function.sine().is_none()) {
                c.function.at_lanes(lanes, t, jet);
            }
        }
        for (c, jet) in self.of[0].channels.iter().zip(&self.jets) {
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
    pub fn of_lane(&self, lane: usize, u: &mut [f64], u_dot: &mut [f64]) {
        for (c, jet) in self.of[lane].channels.iter().zip(&self.jets) {
            let jet = jet.get(lane);
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
    pub fn series(&self, wanted: &[bool], rows: &mut [Lanes<W>]) {
        let width = wanted.len();
        let of_all = self.of[0].channels.iter().zip(&self.jets);
        for ((c, jet), sines) in of_all.zip(&self.sines) {
            if sines.lanes.any() {
                sines.fill_series(self.level, jet, width, &mut rows[c.signal..]);
            }
        }
        for &(signals, lanes) in &self.groups {
            let channels = signals.channels.iter().zip(&self.jets);
            for (c, jet) in channels.filter(|(c, _)| c.function.sine().is_none()) {
                let own = &mut rows[c.signal..];
                (c.function).series_of_lanes(lanes, &self.t, jet, width, own);
            }
        }
        for (c, jet) in self.of[0].channels.iter().zip(&self.jets) {
            let own = &mut rows[c.signal..];
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

/// The sines of each channel.
fn sines<const W: usize>(of: &[&Signals; W]) -> Box<[LaneSines<W>]> {
    let channels = 0..of[0].channels.len();
    channels
        .map(|c| LaneSines::new(of.map(|signals| signals.channels[c].function.sine())))
        .collect()
}
