//! Numbers of several trajectories side by side.
//!
//! What is done with them is C (codegen/lanes.c), compiled for each level of the processor.

/// A number a lane.
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

    /// Yes for all lanes.
    pub fn all() -> Self {
        LaneMask([u64::MAX; W])
    }

    /// Whether it is yes for some lane.
    #[inline]
    pub fn any(&self) -> bool {
        self.0.iter().fold(0, |all, lane| all | lane) != 0
    }

    /// Sets the answer of a lane.
    #[inline]
    pub fn set(&mut self, lane: usize, yes: bool) {
        self.0[lane] = if yes { u64::MAX } else { 0 };
    }

    /// Whether it is yes for a lane.
    #[inline]
    pub fn is(&self, lane: usize) -> bool {
        self.0[lane] != 0
    }

    /// Yes where it is yes here and not there.
    #[inline]
    pub fn without(&self, other: &Self) -> Self {
        LaneMask(std::array::from_fn(|lane| self.0[lane] & !other.0[lane]))
    }

    /// The lanes for which it is yes.
    #[inline]
    pub fn lanes(&self) -> impl Iterator<Item = usize> + use<W> {
        let all = self.0;
        (0..W).filter(move |&lane| all[lane] != 0)
    }

    /// Yes where it is yes here and there.
    #[inline]
    pub fn and(&self, other: &Self) -> Self {
        LaneMask(std::array::from_fn(|lane| self.0[lane] & other.0[lane]))
    }

    /// Yes where it is yes here or there.
    #[inline]
    pub fn or(&self, other: &Self) -> Self {
        LaneMask(std::array::from_fn(|lane| self.0[lane] | other.0[lane]))
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
