//! The doubles as an ordered list: neighbours, distance and middle, counted in doubles.
//!
//! A bracket of an event ends where two doubles are neighbours, and halving *by count* reaches that
//! in at most 64 halvings whatever the scale: near zero it searches magnitudes before digits.

/// Ordinal of `x` in the ordered list of all doubles; both zeros have ordinal 0.
fn ordinal(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    // Sign and magnitude to two's complement: i64::MIN is the sign bit alone.
    if bits < 0 { i64::MIN - bits } else { bits }
}

/// Inverse of [`ordinal`].
fn of_ordinal(ordinal: i64) -> f64 {
    if ordinal < 0 {
        f64::from_bits((i64::MIN - ordinal) as u64)
    } else {
        f64::from_bits(ordinal as u64)
    }
}

/// Number of steps from `left` to `right` along the doubles, for `left ≤ right`.
pub(super) fn steps(left: f64, right: f64) -> u64 {
    // The difference fits u64 though not i64; two's complement wraps to it.
    ordinal(right).wrapping_sub(ordinal(left)) as u64
}

/// The double `count` steps above `x` (below, if negative), not beyond `low` or `high`.
pub(super) fn moved(x: f64, count: i64, low: f64, high: f64) -> f64 {
    let target = ordinal(x).saturating_add(count);
    if target <= ordinal(low) {
        low
    } else if target >= ordinal(high) {
        high
    } else {
        of_ordinal(target)
    }
}

/// The next double above.
pub(super) fn above(x: f64) -> f64 {
    of_ordinal(ordinal(x) + 1)
}

/// The next double below.
pub(super) fn below(x: f64) -> f64 {
    of_ordinal(ordinal(x) - 1)
}

/// The double half-way by count between `left` and `right`, rounded towards `left`.
pub(super) fn middle(left: f64, right: f64) -> f64 {
    let (l, r) = (ordinal(left), ordinal(right));
    // ⌊(l + r)/2⌋ without overflow: common bits, and half of the differing ones.
    of_ordinal((l & r) + ((l ^ r) >> 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_agree_with_the_standard_library() {
        for x in [0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, 1e300, 0.1] {
            assert_eq!(above(x), x.next_up());
            assert_eq!(below(x), x.next_down());
        }
        assert_eq!(steps(-5e-324, 5e-324), 2);
        assert_eq!(steps(-f64::MAX, f64::MAX), 2 * (f64::MAX.to_bits()));
    }

    #[test]
    fn middle_lies_between_and_halves_the_count() {
        for (l, r) in [
            (-f64::MAX, f64::MAX),
            (0.0, 1.0),
            (-1.0, 0.5),
            (3.0, 3.0f64.next_up()),
        ] {
            let m = middle(l, r);
            assert!(l <= m && m < r);
            assert!(steps(l, m).abs_diff(steps(m, r)) <= 1);
        }
    }
}
