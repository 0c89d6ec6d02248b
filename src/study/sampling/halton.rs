//! Halton's sequence.

/// Point `index` of Halton's sequence in the cube [0, 1)ᵈ: in each coordinate the digits of the index in the base of a prime,
/// mirrored at the point. The first point, of index 0, is the origin.
pub fn halton(index: u64, dimensions: usize) -> Vec<f64> {
    primes()
        .take(dimensions)
        .map(|base| mirrored(index, base))
        .collect()
}

fn primes() -> impl Iterator<Item = u64> {
    (2..).filter(|n: &u64| {
        (2..*n)
            .take_while(|d| d * d <= *n)
            .all(|d| !n.is_multiple_of(d))
    })
}

/// As a quotient of whole numbers, which is rounded once where both are below 2⁵³.
fn mirrored(mut index: u64, base: u64) -> f64 {
    let (mut above, mut below) = (0_u128, 1_u128);
    while index > 0 {
        above = above * u128::from(base) + u128::from(index % base);
        below *= u128::from(base);
        index /= base;
    }
    // Rounding must not make a number below 1 of it: the largest one then.
    (above as f64 / below as f64).min(1.0 - 0.5 * f64::EPSILON)
}
