//! Numbers of several trajectories side by side.
//!
//! What is worth vector instructions is C (codegen/lanes.c): here are the few operations between.

use std::ops::{Add, Div, Mul, Sub};

/// A number a lane. The operations are those of each lane by itself, rounding included.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(16))]
pub struct Lanes<const W: usize>(pub [f64; W]);

/// Yes (a word of ones) or no (zero) for each lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C, align(16))]
pub struct LaneMask<const W: usize>(pub [u64; W]);

impl<const W: usize> LaneMask<W> {
    /// No for all lanes.
    pub fn none() -> Self {
        LaneMask([0; W])
    }

    /// Sets the answer of a lane.
    pub fn set(&mut self, lane: usize, yes: bool) {
        self.0[lane] = if yes { u64::MAX } else { 0 };
    }

    /// Whether it is yes for a lane.
    pub fn is(&self, lane: usize) -> bool {
        self.0[lane] != 0
    }
}

impl<const W: usize> Lanes<W> {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn of(x: f64) -> Self {
        Lanes([x; W])
    }

    /// What `f` gives for each lane.
    #[inline(always)]
    pub fn from_fn(f: impl FnMut(usize) -> f64) -> Self {
        Lanes(std::array::from_fn(f))
    }

    /// `f` of each number.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut out = self;
        for i in 0..W {
            out.0[i] = f(self.0[i]);
        }
        out
    }

    /// `f` of each pair of numbers.
    #[inline(always)]
    pub fn with(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self;
        for i in 0..W {
            out.0[i] = f(self.0[i], other.0[i]);
        }
        out
    }
}

macro_rules! by_lane {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl<const W: usize> $trait for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(other, |x, y| x $operator y)
            }
        }
        impl<const W: usize> $trait<f64> for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|x| x $operator other)
            }
        }
    };
}

by_lane!(Add, add, +);
by_lane!(Sub, sub, -);
by_lane!(Mul, mul, *);
by_lane!(Div, div, /);
