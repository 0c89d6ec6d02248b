//! Sobol's sequence.

use super::Random;
use super::directions::DIRECTIONS;

/// Bits of a coordinate; so many points, as a power of two, are different.
const BITS: u32 = 32;

/// Sobol's sequence in the cube [0, 1)ᵈ, with the direction numbers of Joe and Kuo, in the order of the Gray code. The first
/// point is the origin; the first 2ᵏ points are the most even ones.
#[derive(Debug, Clone)]
pub struct Sobol {
    directions: Vec<[u32; BITS as usize]>,
    /// The digits that each coordinate is shifted by.
    shift: Vec<u32>,
    /// Half of a cell is added to shifted points, which lie in the middle of theirs.
    centre: f64,
    point: Vec<u32>,
    index: u32,
}

impl Sobol {
    /// Most dimensions that there are direction numbers for.
    pub const MOST: usize = DIRECTIONS.len() + 1;

    /// The sequence as it is.
    ///
    /// # Panics
    /// For no dimension, or more than [`Sobol::MOST`].
    pub fn new(dimensions: usize) -> Self {
        assert!(
            (1..=Self::MOST).contains(&dimensions),
            "a number of dimensions"
        );
        Sobol {
            directions: (0..dimensions).map(directions).collect(),
            shift: vec![0; dimensions],
            centre: 0.0,
            point: vec![0; dimensions],
            index: 0,
        }
    }

    /// The sequence with a random digital shift: as even, each point uniform in the open cube. 0 and 1 do not occur, so that
    /// every quantile is finite.
    ///
    /// # Panics
    /// As [`Sobol::new`].
    pub fn shifted(dimensions: usize, seed: u64) -> Self {
        let mut sobol = Sobol::new(dimensions);
        let mut random = Random::new(seed);
        sobol
            .shift
            .fill_with(|| (random.bits() >> (64 - BITS)) as u32);
        sobol.centre = 0.5;
        sobol
    }
}

impl Iterator for Sobol {
    type Item = Vec<f64>;

    /// The next point; none after 2³² − 1 of them.
    fn next(&mut self) -> Option<Vec<f64>> {
        let cells = 2f64.powi(BITS as i32);
        let digits = self
            .point
            .iter()
            .zip(&self.shift)
            .map(|(x, shift)| x ^ shift);
        let point = digits
            .map(|x| (f64::from(x) + self.centre) / cells)
            .collect();
        // The digit that changes from this number of the Gray code to the next.
        let changed = self.index.trailing_ones();
        self.index = self.index.checked_add(1)?;
        for (x, v) in self.point.iter_mut().zip(&self.directions) {
            *x ^= v[changed as usize];
        }
        Some(point)
    }
}

/// The direction numbers of a dimension, as fractions of [`BITS`] digits.
fn directions(dimension: usize) -> [u32; BITS as usize] {
    let mut v = [0; BITS as usize];
    let Some((polynomial, first)) = dimension.checked_sub(1).map(|i| DIRECTIONS[i]) else {
        return std::array::from_fn(|i| 1 << (BITS as usize - 1 - i));
    };
    let degree = first.len();
    for i in 0..v.len() {
        v[i] = match first.get(i) {
            Some(m) => m << (BITS as usize - 1 - i),
            None => {
                let earlier = v[i - degree];
                let inner = (1..degree).filter(|k| polynomial >> (degree - k) & 1 == 1);
                inner.fold(earlier ^ (earlier >> degree), |sum, k| sum ^ v[i - k])
            }
        };
    }
    v
}
