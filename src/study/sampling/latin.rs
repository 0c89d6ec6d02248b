//! Latin hypercubes.

use super::Random;

/// A Latin hypercube of `count` points in the open cube (0, 1)ᵈ: of each coordinate's `count` equal strata each holds one
/// point. At a random place in its stratum, or in its `centred` middle.
///
/// # Panics
/// For 2²⁰ points or more, whose places in a stratum doubles would not tell apart safely.
pub fn latin_hypercube(count: usize, dimensions: usize, seed: u64, centred: bool) -> Vec<Vec<f64>> {
    assert!(count < 1 << 20, "a count of points below 2^20");
    let mut random = Random::new(seed);
    let mut points = vec![vec![0.0; dimensions]; count];
    for coordinate in 0..dimensions {
        let mut strata: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            strata.swap(i, random.below(i as u64 + 1) as usize);
        }
        for (point, stratum) in points.iter_mut().zip(strata) {
            // The middle of one of 2³² cells: with below 2²⁰ strata the sum is exact, and the quotient is rounded by less
            // than half a cell, so that it stays in its stratum.
            let cell = (random.bits() >> 32) as f64;
            let within = if centred {
                0.5
            } else {
                (cell + 0.5) / 2f64.powi(32)
            };
            point[coordinate] = (stratum as f64 + within) / count as f64;
        }
    }
    points
}
