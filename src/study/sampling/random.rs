//! Random numbers, the same bits everywhere.

/// SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// The numbers of a seed; all seeds are good ones.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number below n > 0, each as likely as the others.
    pub fn below(&mut self, n: u64) -> u64 {
        // Numbers of the last, incomplete run of n are drawn again.
        let whole = u64::MAX - u64::MAX % n;
        loop {
            let bits = self.bits();
            if bits < whole {
                return bits % n;
            }
        }
    }
}
