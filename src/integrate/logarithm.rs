//! Logarithms and roots to one or two percent, by the same bits on every processor: enough for lengths
//! and orders of steps, and much cheaper than exact ones.

/// ln x to 1 %, by the same bits on every processor.
pub(super) fn natural_logarithm(x: f64) -> f64 {
    binary_logarithm(x) * std::f64::consts::LN_2
}

/// log₂ x to 0.01, for normal x > 0.
fn binary_logarithm(x: f64) -> f64 {
    let (exponent, rest) = parts(x);
    exponent + rest
}

/// log₂ x as exponent and logarithm of the significand.
fn parts(x: f64) -> (f64, f64) {
    let bits = x.to_bits();
    let exponent = (bits >> 52) as f64 - 1023.0;
    let fraction = f64::from_bits(bits & ((1 << 52) - 1) | 1f64.to_bits()) - 1.0;
    // The parabola through the ends of [1, 2) that is right at √2 too.
    (exponent, fraction * (1.0 + 0.347 * (1.0 - fraction)))
}

/// 2^x to 1 %, for |x| < 1000.
fn binary_power(x: f64) -> f64 {
    let exponent = x + 1023.0;
    let whole = exponent as i64;
    let fraction = exponent - whole as f64;
    f64::from_bits((whole as u64) << 52) * (1.0 + fraction * (1.0 - 0.343 * (1.0 - fraction)))
}

/// x^(−1/n) to 2 %: the length h with which x hⁿ is one. Infinite for x = 0.
///
/// The root of 2^(−n c) x is 2^c times that of x to the last bit, so that the steps do not depend on
/// the unit of time: multiples of n in the exponent stay apart.
pub(super) fn root(x: f64, n: usize) -> f64 {
    if x < f64::MIN_POSITIVE {
        return f64::INFINITY;
    }
    let (exponent, rest) = parts(x);
    let n = n as f64;
    // Half a unit away from the multiples of n, rounding does not decide.
    let whole = ((exponent + 0.5) / n).floor();
    binary_power(-((exponent - n * whole) + rest) / n) * binary_power(-whole)
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
    fn roots_of_powers_of_two_are_exact_factors() {
        for n in 1..=31 {
            for i in 0..200 {
                let x = 10f64.powf(f64::from(i) * 0.03 - 3.0);
                for c in [-20, -3, 1, 10, 25] {
                    let scaled = x * 2f64.powi(-c * n);
                    let expected = root(x, n as usize) * 2f64.powi(c);
                    assert_eq!(root(scaled, n as usize), expected, "{x:e} {n} {c}");
                }
            }
        }
    }
}
