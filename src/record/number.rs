//! Numbers as text.

use std::fmt::Write;

/// Most significant digits that a double needs.
const EXACT: usize = 17;

/// Appends `x` with the fewest digits that read back to the same bits (of a NaN: some NaN). Whole numbers have no decimal
/// point; the negative zero keeps one, because `-0` is read as an integer by many. Non-finite numbers become `NaN`, `inf`,
/// `-inf`.
pub(super) fn push_exact(out: &mut String, x: f64) {
    if x == 0.0 {
        out.push_str(if x.is_sign_negative() { "-0.0" } else { "0" });
    } else if x.is_finite() {
        let start = out.len();
        write!(out, "{:e}", x.abs()).expect("writing to a string succeeds");
        push_positional(out, start, x < 0.0, EXACT);
    } else {
        write!(out, "{x}").expect("writing to a string succeeds");
    }
}

/// `x` as [`push_exact`] writes it.
#[cfg(feature = "plots")]
pub(crate) fn exact(x: f64) -> String {
    let mut out = String::new();
    push_exact(&mut out, x);
    out
}

/// `x` with at most `digits` significant digits, for people.
pub(crate) fn rounded(x: f64, digits: usize) -> String {
    let mut out = String::new();
    push_general(&mut out, x, digits);
    out
}

/// As C's `%.{digits}g`, up to 17 digits: positional where the exponent is in `-4..digits`, else scientific.
fn push_general(out: &mut String, x: f64, digits: usize) {
    if !x.is_finite() {
        write!(out, "{x}").expect("writing to a string succeeds");
        return;
    }
    let start = out.len();
    write!(out, "{:.*e}", digits - 1, x.abs()).expect("writing to a string succeeds");
    push_positional(out, start, x < 0.0, digits);
}

/// Rewrites a number in scientific notation, which stands from `start` on, with its sign and without trailing zeros: positional
/// where the exponent is in `-4..digits`.
fn push_positional(out: &mut String, start: usize, negative: bool, digits: usize) {
    let (mantissa, exponent) = out[start..]
        .split_once('e')
        .expect("{:e} writes an exponent");
    let exponent: i32 = exponent.parse().expect("{:e} writes a whole exponent");
    // The figures without the point, on the stack: this runs for every number of a table.
    let mut figures = [0; EXACT];
    let mut count = 0;
    for &figure in mantissa.as_bytes().iter().filter(|&&c| c != b'.') {
        figures[count] = figure;
        count += 1;
    }
    let figures = str::from_utf8(&figures[..count]).expect("figures are ASCII");
    let figures = match figures.trim_end_matches('0') {
        "" => "0",
        trimmed => trimmed,
    };
    out.truncate(start);
    if negative {
        out.push('-');
    }
    let last = figures.len() as i32 - 1;
    if exponent < -4 || exponent >= digits as i32 {
        out.push_str(&figures[..1]);
        if last > 0 {
            out.push('.');
            out.push_str(&figures[1..]);
        }
        write!(out, "e{exponent}").expect("writing to a string succeeds");
    } else if exponent < 0 {
        out.push_str("0.");
        out.extend(std::iter::repeat_n('0', (-exponent - 1) as usize));
        out.push_str(figures);
    } else if exponent >= last {
        out.push_str(figures);
        out.extend(std::iter::repeat_n('0', (exponent - last) as usize));
    } else {
        let point = (exponent + 1) as usize;
        out.push_str(&figures[..point]);
        out.push('.');
        out.push_str(&figures[point..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn exact(x: f64) -> String {
        let mut out = String::new();
        push_exact(&mut out, x);
        out
    }

    #[test]
    fn known_numbers() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "-0.0"),
            (1.0, "1"),
            (-20.0, "-20"),
            (0.1, "0.1"),
            (0.001, "0.001"),
            (1.5e-5, "1.5e-5"),
            (1e16, "10000000000000000"),
            (1e17, "1e17"),
            (std::f64::consts::PI, "3.141592653589793"),
            (f64::MIN_POSITIVE, "2.2250738585072014e-308"),
            (5e-324, "5e-324"),
            (0.1 + 0.2, "0.30000000000000004"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(exact(x), text);
        }
    }

    #[test]
    fn rounding_carries_into_the_exponent() {
        assert_eq!(rounded(9.9999, 3), "10");
        assert_eq!(rounded(0.000_099_999, 3), "0.0001");
        assert_eq!(rounded(999_950.0, 4), "1e6");
        assert_eq!(rounded(-12.345, 3), "-12.3");
    }

    proptest! {
        #[test]
        fn every_double_is_read_back_bit_for_bit(bits: u64) {
            let x = f64::from_bits(bits);
            prop_assume!(!x.is_nan());
            let back: f64 = exact(x).parse().unwrap();
            prop_assert_eq!(back.to_bits(), x.to_bits());
        }

        #[test]
        fn agrees_with_the_standard_rounding(x in -1e6..1e6f64, digits in 1usize..17) {
            let standard: f64 = format!("{:.*e}", digits - 1, x).parse().unwrap();
            prop_assert_eq!(rounded(x, digits).parse::<f64>().unwrap(), standard);
        }
    }
}
