//! Logarithms and roots to one or two percent, by the same bits on every processor: enough for lengths
//! and orders of steps, and much cheaper than exact ones.

/// ln x to 1 %, by the same bits on every processor.
pub(super) fn natural_logarithm(x: f64) -> f64 {
    binary_logarithm(x) * std::f64::consts::LN_2
}

/// log₂ x to 0.01, for normal x > 0.
pub(super) fn binary_logarithm(x: f64) -> f64 {
    let (exponent, fraction) = split(x);
    exponent as f64 + fraction
}

/// log₂ x to 0.01 as a whole number and what is left, in [0, 1), for normal x > 0.
fn split(x: f64) -> (i64, f64) {
    let bits = x.to_bits();
    let exponent = (bits >> 52) as i64 - 1023;
    let fraction = f64::from_bits(bits & ((1 << 52) - 1) | 1f64.to_bits()) - 1.0;
    // The parabola through the ends of [1, 2) that is right at √2 too.
    (exponent, fraction * (1.0 + 0.347 * (1.0 - fraction)))
}

/// 2^(−x) to 1 %, for 0 ≤ x ≤ 1.
fn inverse_power(x: f64) -> f64 {
    // 2^(−x) = ½ · 2^(1 − x)
    let fraction = 1.0 - x;
    0.5 * (1.0 + fraction * (1.0 - 0.343 * (1.0 - fraction)))
}

/// Largest n of [`root`].
const MOST: usize = crate::numerics::ORDERS - 1;

/// ⌈2³⁶/n⌉: times a number below 2¹⁸ it is 2³⁶ times the quotient by n, and less than 2³⁶/n more, so that
/// the whole part is right.
const RECIPROCALS: [u64; MOST + 1] = {
    let mut table = [0; MOST + 1];
    let mut n = 1;
    while n <= MOST {
        table[n] = (1_u64 << 36).div_ceil(n as u64);
        n += 1;
    }
    table
};

/// x^(−1/n) to 2 %: the length h with which x hⁿ is one. Infinite for x = 0. Where x is 2^(kn) times as
/// large, it is 2^(−k) times as large to the bit: a step does not depend on the unit of time.
pub(super) fn root(x: f64, n: usize) -> f64 {
    if x < f64::MIN_POSITIVE {
        return f64::INFINITY;
    }
    let (exponent, fraction) = split(x);
    // The exponent divided by n, rounded down: a multiple of n makes it positive before.
    let lift = 1024 * n as i64;
    let quotient = ((exponent + lift) as u64 * RECIPROCALS[n]) >> 36;
    let rest = exponent + lift - quotient as i64 * n as i64;
    let power = f64::from_bits((1023 + 1024 - quotient) << 52);
    power * inverse_power((rest as f64 + fraction) / n as f64)
}

/// Unit of logarithms that are whole numbers: 2⁻¹⁶.
pub(super) const PLACES: u32 = 16;

/// What is left out of a double's bits for [`places`].
const OMITTED: u32 = f64::MANTISSA_DIGITS - 1 - PLACES;

/// Exponents of doubles are stored with this bias, of as many [`PLACES`].
pub(super) const BIAS: i64 = 1023 << PLACES;

/// log₂ x for x ≥ 0 in [`PLACES`] and with their [`BIAS`], less up to 0.086: the first bits of the double. Of a number
/// that is 2ᵏ times as large it is larger by k to the bit.
#[inline(always)]
pub(super) fn places(x: f64) -> u64 {
    x.to_bits() >> OMITTED
}

/// ⌈2³⁶/n⌉, for [`part`].
pub(super) fn reciprocal(n: usize) -> u64 {
    RECIPROCALS[n]
}

/// The whole part of a number of [`places`] ÷ n, given the [`reciprocal`] of n: it is below 2²⁸ so that its product with
/// that is off by less than 2²⁸, which is 2⁻⁸ of the quotient's unit and thus less than 1/n.
#[inline(always)]
pub(super) fn part(places: u64, reciprocal: u64) -> i64 {
    ((places * reciprocal) >> 36) as i64
}

/// 2ˣ to 1 %, for x in [`PLACES`] that is no less than −1022 and less than 1024.
#[inline(always)]
pub(super) fn power_of_two(x: i64) -> f64 {
    let biased = (x + BIAS) as u64;
    let power = f64::from_bits(biased >> PLACES << (f64::MANTISSA_DIGITS - 1));
    let fraction = biased & ((1 << PLACES) - 1);
    let fraction = f64::from_bits(1f64.to_bits() | fraction << OMITTED) - 1.0;
    power * (1.0 + fraction * (1.0 - 0.343 * (1.0 - fraction)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_good_enough_for_step_lengths() {
        for n in 1..=MOST {
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
    fn logarithms_in_places_divide_exactly() {
        for n in 3..=MOST as u64 {
            for places in (0..2048 << PLACES).step_by(997) {
                let expected = (places / n) as i64;
                assert_eq!(part(places, reciprocal(n as usize)), expected);
            }
        }
        for i in -600..600 {
            let x = 2f64.powf(f64::from(i) / 7.3);
            let exact = x.log2();
            let off = exact - (places(x) as i64 - BIAS) as f64 / f64::from(1 << PLACES);
            assert!((0.0..0.087).contains(&off), "{x}: {off}");
            let power = power_of_two((exact * f64::from(1 << PLACES)) as i64);
            assert!((power / x - 1.0).abs() < 0.01, "{x}: {power}");
        }
    }

    #[test]
    fn roots_of_powers_of_two_are_exact_factors() {
        for n in 1..=MOST as i32 {
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
