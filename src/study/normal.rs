//! The normal distribution, to the last digits in its tails too, by the same bits on every processor.

use std::f64::consts::{LN_2, PI, SQRT_2};

/// Below it Φ leaves the range of doubles, and its asymptotic series is exact to double precision.
const FAR: f64 = -37.0;

/// The density φ(z).
pub fn density(z: f64) -> f64 {
    libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt()
}

/// ln φ(z).
pub fn ln_density(z: f64) -> f64 {
    -0.5 * z * z - 0.5 * (LN_2 + libm::log(PI))
}

/// The probability Φ(z) of values up to z.
pub fn probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// ln Φ(z).
pub fn ln_probability(z: f64) -> f64 {
    if z > 0.0 {
        libm::log1p(-probability(-z))
    } else if z > FAR {
        libm::log(probability(z))
    } else {
        ln_density(z) + libm::log(mills(z))
    }
}

/// The derivative φ(z)/Φ(z) of ln Φ.
pub fn hazard(z: f64) -> f64 {
    if z > FAR {
        density(z) / probability(z)
    } else {
        1.0 / mills(z)
    }
}

/// Φ(z)/φ(z) for z ≤ [`FAR`]: what the series leaves out is below 135135/z¹⁴ < 2e-17.
fn mills(z: f64) -> f64 {
    let s = 1.0 / (z * z);
    -(1.0 - s * (1.0 - s * (3.0 - s * (15.0 - s * (105.0 - s * (945.0 - s * 10395.0)))))) / z
}

/// The z with Φ(z) = p, by Wichura's algorithm AS 241 (1988); infinite for p = 0 and p = 1.
///
/// # Panics
/// For a p outside [0, 1].
pub fn quantile(p: f64) -> f64 {
    assert!((0.0..=1.0).contains(&p), "a probability");
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.425 * 0.425 - q * q;
        return q * ratio(r, &CENTRE);
    }
    let tail = p.min(1.0 - p);
    if tail == 0.0 {
        return f64::INFINITY.copysign(q);
    }
    let r = (-libm::log(tail)).sqrt();
    let z = match r <= 5.0 {
        true => ratio(r - 1.6, &MIDDLE),
        false => ratio(r - 5.0, &TAIL),
    };
    z.copysign(q)
}

/// A quotient of polynomials, lowest coefficients first.
fn ratio(x: f64, [above, below]: &[[f64; 8]; 2]) -> f64 {
    let value = |c: &[f64; 8]| c.iter().rev().fold(0.0, |sum, c| sum * x + c);
    value(above) / value(below)
}

/// Wichura's coefficients: |p − ½| ≤ 0.425.
#[rustfmt::skip]
const CENTRE: [[f64; 8]; 2] = [
    [3.387_132_872_796_366_5, 1.331_416_678_917_843_8e2, 1.971_590_950_306_551_3e3, 1.373_169_376_550_946e4,
     4.592_195_393_154_987e4, 6.726_577_092_700_87e4, 3.343_057_558_358_813e4, 2.509_080_928_730_122_7e3],
    [1.0, 4.231_333_070_160_091e1, 6.871_870_074_920_579e2, 5.394_196_021_424_751e3,
     2.121_379_430_158_659_7e4, 3.930_789_580_009_271e4, 2.872_908_573_572_194_3e4, 5.226_495_278_852_854e3],
];
/// Further out, down to a tail of e⁻²⁵.
#[rustfmt::skip]
const MIDDLE: [[f64; 8]; 2] = [
    [1.423_437_110_749_683_5, 4.630_337_846_156_546, 5.769_497_221_460_691, 3.647_848_324_763_204_5,
     1.270_458_252_452_368_4, 2.417_807_251_774_506e-1, 2.272_384_498_926_918_4e-2, 7.745_450_142_783_414e-4],
    [1.0, 2.053_191_626_637_759, 1.676_384_830_183_803_8, 6.897_673_349_851e-1,
     1.481_039_764_274_800_8e-1, 1.519_866_656_361_645_7e-2, 5.475_938_084_995_345e-4, 1.050_750_071_644_416_9e-9],
];
/// Down to the smallest doubles.
#[rustfmt::skip]
const TAIL: [[f64; 8]; 2] = [
    [6.657_904_643_501_104, 5.463_784_911_164_114, 1.784_826_539_917_291_3, 2.965_605_718_285_048_7e-1,
     2.653_218_952_657_612_4e-2, 1.242_660_947_388_078_4e-3, 2.711_555_568_743_487_6e-5, 2.010_334_399_292_288_1e-7],
    [1.0, 5.998_322_065_558_879e-1, 1.369_298_809_227_358e-1, 1.487_536_129_085_061_5e-2,
     7.868_691_311_456_133e-4, 1.846_318_317_510_054_8e-5, 1.421_511_758_316_446e-7, 2.044_263_103_389_939_8e-15],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_references() {
        let references: serde_json::Value =
            serde_json::from_str(include_str!("../../tests/data/21_sampling.json")).unwrap();
        for (p, z) in references["normal_quantile"].as_object().unwrap() {
            let p: f64 = p.parse().unwrap();
            let exact: f64 = z.as_str().unwrap().parse().unwrap();
            let error = (quantile(p) - exact).abs();
            // An upper tail is known as well as p is.
            let rounding = f64::EPSILON * p / density(exact).max(f64::MIN_POSITIVE);
            let bound = 4.0 * f64::EPSILON * exact.abs() + if p > 0.5 { rounding } else { 0.0 };
            assert!(error <= bound, "{p:e}: {error:e} > {bound:e}");
        }
        assert_eq!(quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(quantile(1.0), f64::INFINITY);
    }

    #[test]
    fn probabilities_are_the_inverse_of_quantiles() {
        for p in [1e-300, 1e-100, 1e-10, 1e-3, 0.2, 0.5, 0.7, 0.975, 0.9999] {
            let back = probability(quantile(p));
            // A relative error of z changes Φ by z times as much, squared.
            let z = quantile(p);
            assert!(
                (back / p - 1.0).abs() < 1e-15 * (4.0 + z * z),
                "{p:e} {back:e}"
            );
        }
    }

    #[test]
    fn logarithms_and_hazards_have_no_seam_far_out() {
        for step in 0..100 {
            let z = FAR + f64::from(step - 50) * 1e-3;
            let exact = ln_density(z) + libm::log(mills(z));
            assert!((ln_probability(z) / exact - 1.0).abs() < 1e-14, "{z}");
            assert!((hazard(z) * mills(z) - 1.0).abs() < 1e-12, "{z}");
        }
        assert!(ln_probability(-1e9).is_finite());
        assert_eq!(ln_probability(40.0), 0.0);
    }
}
