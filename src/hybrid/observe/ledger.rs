//! The running energy ledger, in the inertial frame.

use crate::numerics::persist;
use crate::run::{EnergyJump, Ledger};

/// Sentence about the frame, for the summary.
const FRAME: &str = "inertial frame in which the ground is at rest at t = 0; ground, walls and belts \
    that move do work at an impact, which is counted as input work, so that `lost_at_impacts` is the \
    loss in the frame of what is struck";

/// A sum that carries what rounding loses (Neumaier 1974).
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    total: f64,
    lost: f64,
}

persist!(Sum { total, lost });

impl Sum {
    fn add(&mut self, x: f64) {
        let sum = self.total + x;
        self.lost += if self.total.abs() >= x.abs() {
            (self.total - sum) + x
        } else {
            (x - sum) + self.total
        };
        self.total = sum;
    }

    fn value(&self) -> f64 {
        self.total + self.lost
    }
}

/// Energies since the start of the run, J.
#[derive(Debug, Clone, Default)]
pub(in crate::hybrid) struct RunningLedger {
    initial: f64,
    input_work: Sum,
    dissipated: Sum,
    lost_at_impacts: Sum,
}

persist!(RunningLedger {
    initial,
    input_work,
    dissipated,
    lost_at_impacts
});

impl RunningLedger {
    pub fn starting_with(initial: f64) -> Self {
        RunningLedger {
            initial,
            ..Self::default()
        }
    }

    /// Adds [dissipated, input] energy, J.
    #[inline]
    pub fn add_work(&mut self, [dissipated, input]: [f64; 2]) {
        self.dissipated.add(dissipated);
        self.input_work.add(input);
    }

    pub fn add_jump(&mut self, jump: EnergyJump) {
        self.lost_at_impacts.add(jump.lost);
        self.input_work.add(jump.ground_work);
    }

    /// The entries of a row: stored, input work, dissipated, lost at impacts; with [dissipated, input] energy
    /// since the ledger was brought up to date.
    pub fn row(&self, stored: f64, [dissipated, input]: [f64; 2]) -> [f64; 4] {
        [
            stored,
            self.input_work.value() + input,
            self.dissipated.value() + dissipated,
            self.lost_at_impacts.value(),
        ]
    }

    pub fn close(&self, stored: f64) -> Ledger {
        Ledger {
            initial: self.initial,
            final_: stored,
            dissipated: self.dissipated.value(),
            input_work: self.input_work.value(),
            lost_at_impacts: self.lost_at_impacts.value(),
            frame: FRAME.into(),
        }
    }
}
