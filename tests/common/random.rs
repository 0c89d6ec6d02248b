//! Numbers for random scenes and models.
#![allow(dead_code)] // each test program uses some of them

/// Numbers that look random (Steele, Lea and Flood 2014: SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 * 2f64.powi(-53)
    }

    pub fn one_of<'t, T>(&mut self, all: &'t [T]) -> &'t T {
        &all[self.next() as usize % all.len()]
    }

    /// A number, or one within a range.
    pub fn either(&mut self, one: f64, (low, high): (f64, f64)) -> f64 {
        let other = self.within(low, high);
        *self.one_of(&[one, other])
    }
}
