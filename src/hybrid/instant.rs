//! Time to twice the precision of a double.
//!
//! Hops of an accumulation become shorter than one unit in the last place of t, and their ratio
//! decides where they end: so an instant is an unevaluated sum of two doubles (Dekker 1971).

use crate::numerics::persist;

/// An instant of time, s, as `hi + lo` with |lo| ≤ ulp(hi)/2.
#[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd)]
pub struct Instant {
    hi: f64,
    lo: f64,
}

persist!(Instant { hi, lo });

impl Instant {
    /// An instant that is a double.
    pub fn new(t: f64) -> Self {
        Instant { hi: t, lo: 0.0 }
    }

    /// The sum of two doubles, as [`Instant::parts`] gives them.
    pub fn of_parts([hi, lo]: [f64; 2]) -> Self {
        Instant { hi, lo }
    }

    /// The nearest double and the rest.
    pub fn parts(self) -> [f64; 2] {
        [self.hi, self.lo]
    }

    /// The nearest double.
    pub fn seconds(self) -> f64 {
        self.hi
    }

    /// The instant `duration` later.
    pub fn plus(self, duration: f64) -> Self {
        let (sum, error) = two_sum(self.hi, duration);
        let (hi, lo) = two_sum(sum, error + self.lo);
        Instant { hi, lo }
    }

    /// Duration from `earlier` to here, s.
    pub fn since(self, earlier: Instant) -> f64 {
        let (difference, error) = two_sum(self.hi, -earlier.hi);
        difference + (error + (self.lo - earlier.lo))
    }
}

/// a + b as its rounded value and the exact rounding error (Knuth 1969).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_virtual = sum - a;
    let a_virtual = sum - b_virtual;
    (sum, (a - a_virtual) + (b - b_virtual))
}

#[cfg(test)]
mod tests {
    use super::Instant;

    #[test]
    fn durations_far_below_the_last_place_of_t_add_up() {
        let mut t = Instant::new(10.0);
        let mut hop = 1e-3;
        for _ in 0..60 {
            let next = t.plus(hop);
            // Two doubles hold 10 s to 2⁻¹⁰⁵ of it.
            assert!((next.since(t) - hop).abs() < 3e-31, "hop {hop:e}");
            t = next;
            hop /= 2.0;
        }
        assert!((t.since(Instant::new(10.0)) - 2e-3 * (1.0 - 0.5f64.powi(60))).abs() < 1e-18);
    }
}
