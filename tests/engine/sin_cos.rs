//! Sine and cosine against golden values: `tests/data/sin_cos.csv`, made with mpmath by
//! `tools/elementary.py`.

use dalembert::kernel::sin_cos;

/// Distance from `value` to the exact number `near` + `rest` units in the last place of `near`, in such
/// units.
fn error(value: f64, near: f64, rest: f64) -> f64 {
    let unit = near.abs().next_up() - near.abs();
    ((value - near) / unit - rest).abs()
}

#[test]
fn golden_values_are_met_to_less_than_a_unit_in_the_last_place() {
    let text = include_str!("../data/sin_cos.csv");
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    let mut worst = 0.0_f64;
    let mut count = 0;
    for row in rows.records() {
        let row = row.unwrap();
        let bits = |i: usize| f64::from_bits(u64::from_str_radix(&row[i], 16).unwrap());
        let rest = |i: usize| row[i].parse::<f64>().unwrap();
        let (sin, cos) = sin_cos(bits(0));
        let of_sin = error(sin, bits(1), rest(2));
        let of_cos = error(cos, bits(3), rest(4));
        assert!(
            of_sin < 0.75 && of_cos < 0.75,
            "{:e}: {of_sin} {of_cos}",
            bits(0)
        );
        worst = worst.max(of_sin).max(of_cos);
        count += 1;
    }
    assert!(count > 900 && worst > 0.5, "{count} rows, at worst {worst}");
}

#[test]
fn symmetries_are_exact() {
    for i in 0..100_000_u32 {
        let x = f64::from(i) * 1.234e-3;
        let ((sin, cos), (minus, same)) = (sin_cos(x), sin_cos(-x));
        assert_eq!(
            (sin.to_bits(), cos.to_bits()),
            ((-minus).to_bits(), same.to_bits())
        );
    }
    assert_eq!(sin_cos(-0.0).0.to_bits(), (-0.0_f64).to_bits());
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (sin, cos) = sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan());
    }
}

/// Generated code takes this shorter way to the same bits.
#[test]
fn small_angles_are_their_own_sines() {
    let smallest = f64::from_bits(1);
    let mut x = 2.0_f64.powi(-27).next_down();
    while x > smallest {
        for x in [x, -x] {
            let (sin, cos) = sin_cos(x);
            assert_eq!((sin.to_bits(), cos), (x.to_bits(), 1.0), "{x:e}");
        }
        x = (0.99 * x).min(x.next_down());
    }
    assert_ne!(sin_cos(2.0_f64.powi(-25)), (2.0_f64.powi(-25), 1.0));
}

/// Fingerprint of the results for many arguments: the same on every machine.
#[test]
fn bits_are_the_same_everywhere() {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut x = 1e-3;
    while x < 1e300 {
        let (sin, cos) = sin_cos(x);
        for bits in [sin.to_bits(), cos.to_bits()] {
            hash = (hash ^ bits).wrapping_mul(0x0000_0100_0000_01b3);
        }
        x *= 1.001;
    }
    assert_eq!(hash, 0xb512_c99e_06ac_0f60, "{hash:#x}");
}
