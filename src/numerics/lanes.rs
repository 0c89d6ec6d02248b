//! Numbers of several trajectories side by side.
//!
//! What is done with them is C (codegen/lanes.c), compiled for each level of the processor.

use std::ops::{BitAnd, BitOr, Not};

/// A number a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(16))]
pub(crate) struct Lanes<const W: usize>(pub [f64; W]);

/// Yes or no for each lane: a bit a lane, the first the lowest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct LaneMask(pub u32);

impl LaneMask {
    /// No for all lanes.
    pub const NONE: LaneMask = LaneMask(0);
    /// Yes for all lanes.
    pub const ALL: LaneMask = LaneMask(u32::MAX);

    /// Whether it is yes for some lane.
    #[inline]
    pub fn any(self) -> bool {
        self != Self::NONE
    }

    /// Sets the answer of a lane.
    #[inline]
    pub fn set(&mut self, lane: usize, yes: bool) {
        self.0 = self.0 & !(1 << lane) | u32::from(yes) << lane;
    }

    /// Whether it is yes for a lane.
    #[inline]
    pub fn is(self, lane: usize) -> bool {
        self.0 >> lane & 1 != 0
    }

    /// The lanes for which it is yes.
    #[inline]
    pub fn lanes(self) -> impl Iterator<Item = usize> {
        let mut left = self.0;
        std::iter::from_fn(move || {
            let lane = left.trailing_zeros();
            left &= left.wrapping_sub(1);
            (lane < u32::BITS).then_some(lane as usize)
        })
    }
}

impl BitAnd for LaneMask {
    type Output = LaneMask;
    #[inline]
    fn bitand(self, other: LaneMask) -> LaneMask {
        LaneMask(self.0 & other.0)
    }
}

impl BitOr for LaneMask {
    type Output = LaneMask;
    #[inline]
    fn bitor(self, other: LaneMask) -> LaneMask {
        LaneMask(self.0 | other.0)
    }
}

impl Not for LaneMask {
    type Output = LaneMask;
    #[inline]
    fn not(self) -> LaneMask {
        LaneMask(!self.0)
    }
}

impl<const W: usize> Lanes<W> {
    /// The same number in all lanes.
    #[inline]
    pub fn of(x: f64) -> Self {
        Lanes([x; W])
    }

    /// What `f` gives for each lane.
    #[inline]
    pub fn from_fn(f: impl FnMut(usize) -> f64) -> Self {
        Lanes(std::array::from_fn(f))
    }
}
