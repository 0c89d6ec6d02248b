//! Order and length of a step.

/// What a step costs besides its series (search for events, ledger, …), in units of the work of one
/// order squared; as measured on the rocking block.
const OVERHEAD: f64 = 100.0;

/// Order at which a unit of time is cheapest for a relative tolerance ε.
///
/// A series of order p with radius of convergence ρ meets ε with h = ρ ε^(1/p). Its work grows like
/// p², so that (overhead + p²)/h is least where 2p³ = −ln ε (overhead + p²). Without overhead that
/// is p = −½ ln ε (Jorba and Zou 2005, section 3.2).
pub(super) fn order(tolerance: f64) -> usize {
    let digits = -natural_logarithm(tolerance);
    let falls = |p: &usize| {
        let p = *p as f64;
        2.0 * p * p * p < digits * (OVERHEAD + p * p)
    };
    (1..)
        .find(|p| !falls(p))
        .expect("a cubic ends above a parabola")
}

/// ln x to 1 %, by the same bits on every processor.
fn natural_logarithm(x: f64) -> f64 {
    binary_logarithm(x) * std::f64::consts::LN_2
}

/// log₂ x to 0.01, for normal x > 0.
fn binary_logarithm(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = (bits >> 52) as f64 - 1023.0;
    let fraction = f64::from_bits(bits & ((1 << 52) - 1) | 1f64.to_bits()) - 1.0;
    // The parabola through the ends of [1, 2) that is right at √2 too.
    exponent + fraction * (1.0 + 0.347 * (1.0 - fraction))
}

/// 2^x to 1 %, for |x| < 1000.
fn binary_power(x: f64) -> f64 {
    let whole = x.floor();
    let fraction = x - whole;
    f64::from_bits(((whole + 1023.0) as u64) << 52)
        * (1.0 + fraction * (1.0 - 0.343 * (1.0 - fraction)))
}

/// x^(−1/n) to 2 %: the length with which the term x hⁿ is one. Infinite for x = 0.
pub(super) fn root(x: f64, n: usize) -> f64 {
    if x < f64::MIN_POSITIVE {
        return f64::INFINITY;
    }
    binary_power(-binary_logarithm(x) / n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_good_enough_for_step_lengths() {
        for n in 1..=25 {
            for i in 0..2000 {
                let x = 10f64.powf(f64::from(i) * 0.3 - 300.0);
                let exact = x.powf(-1.0 / n as f64);
                if exact < 1e300 {
                    assert!((root(x, n) / exact - 1.0).abs() < 0.02, "{x:e} {n}");
                }
            }
        }
        assert_eq!(root(0.0, 7), f64::INFINITY);
    }

    #[test]
    fn the_order_follows_the_tolerance() {
        for (tolerance, expected) in [(1e-3, 9), (1e-6, 12), (1e-9, 15), (1e-12, 19), (1e-14, 21)] {
            assert_eq!(order(tolerance), expected, "{tolerance:e}");
        }
    }
}
