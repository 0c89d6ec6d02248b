//! Closing in on one sign change, and on one minimum, by the function's own values.

use super::doubles::{above, below, middle, moved, steps};

/// An argument and the function's value there.
pub(super) type Point = (f64, f64);

/// Shrinks `left` (value ≥ 0) and `right` (value < 0) to neighbouring doubles with those signs.
///
/// The secant with the weights of Anderson and Björck (BIT 13, 1973, 253–264); it is safeguarded: a
/// step follows in which the number of doubles is halved whenever two steps did not quarter it, so
/// three evaluations halve it at least, and 3 · 64 are the worst case. A value that is not a number
/// counts as not negative. The signs of the ends are the caller's word, so a start at which the
/// function is exactly zero, or a pole, may be an end.
pub(super) fn close(f: &mut impl FnMut(f64) -> f64, left: Point, right: Point) -> (Point, Point) {
    let (mut l, mut r) = (left, right);
    // Values used by the secant; the weights of an end that stays are reduced.
    let (mut wl, mut wr) = (l.1, r.1);
    let mut last_side = None;
    // Number of doubles before the last step and the one before it.
    let mut earlier = [u64::MAX; 2];
    loop {
        let count = steps(l.0, r.0);
        if count <= 1 {
            return (l, r);
        }
        let halve = count > earlier[0] / 4;
        let x = if halve {
            earlier = [u64::MAX; 2];
            middle(l.0, r.0)
        } else {
            earlier = [earlier[1], count];
            // Written from the end with the smaller weight, so that rounding moves it least.
            let secant = if wl < -wr {
                l.0 + (r.0 - l.0) * (wl / (wl - wr))
            } else {
                r.0 + (r.0 - l.0) * (wr / (wl - wr))
            };
            if secant.is_nan() {
                middle(l.0, r.0)
            } else {
                secant.clamp(above(l.0), below(r.0))
            }
        };
        let value = f(x);
        let negative = value < 0.0;
        if last_side == Some(negative) {
            // Anderson–Björck: the end that stayed is weighted by 1 − (new value)/(replaced value),
            // or by one half where that is not positive.
            let replaced = if negative { wr } else { wl };
            let ratio = 1.0 - value / replaced;
            let weight = if ratio > 0.0 { ratio } else { 0.5 };
            if negative { wl *= weight } else { wr *= weight }
        }
        last_side = Some(negative);
        if negative {
            r = (x, value);
            wr = value;
        } else {
            l = (x, value);
            wl = value;
        }
    }
}

/// Shrinks a window at whose left end a dormant guard is zero and at whose right end it is negative
/// to neighbouring doubles, the right one negative. Halves by count, so a short flight near the
/// start is looked for at every magnitude; if one is met, a fall after it is closed in on, and
/// the second item is `true`.
pub(super) fn departure(
    f: &mut impl FnMut(f64) -> f64,
    start: f64,
    right: Point,
) -> ((Point, Point), bool) {
    let (mut l, mut r) = ((start, 0.0), right);
    while steps(l.0, r.0) > 1 {
        let x = middle(l.0, r.0);
        let value = f(x);
        if value > 0.0 {
            return (close(f, (x, value), r), true);
        } else if value < 0.0 {
            r = (x, value);
        } else {
            l = (x, value);
        }
    }
    ((l, r), false)
}

/// Lowest value near a minimum that is known but for its last digits: goes downhill along the
/// doubles, in strides that double while they descend and halve when they do not, until both
/// neighbours are no lower or a value is negative.
pub(super) fn lowest(f: &mut impl FnMut(f64) -> f64, near: Point, low: f64, high: f64) -> Point {
    let mut best = near;
    let mut stride = 1_i64;
    while stride > 0 && best.1 >= 0.0 {
        let lower = [-stride, stride].into_iter().find_map(|count| {
            let x = moved(best.0, count, low, high);
            let value = f(x);
            (value < best.1).then_some((x, value))
        });
        stride = if lower.is_some() {
            stride.saturating_mul(2)
        } else {
            stride / 2
        };
        best = lower.unwrap_or(best);
    }
    best
}

/// Place and value of a minimum between `low` and `high`, by the golden section (Kiefer 1953). The place
/// is known to half of the digits of a double, which leaves of the value no error that counts: its error
/// is of the order of the square. In a window of few doubles it ends where none is left to divide it.
pub(in crate::hybrid) fn minimum(
    f: &mut impl FnMut(f64) -> f64,
    (mut low, mut high): (f64, f64),
) -> Point {
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    let width = (high - low) / f64::from(1_u32 << (f64::MANTISSA_DIGITS / 2));
    let (mut l, mut r) = (high - part * (high - low), low + part * (high - low));
    let (mut of_l, mut of_r) = (f(l), f(r));
    while high - low > width && low < l && l < r && r < high {
        if of_l <= of_r {
            (high, r, of_r) = (r, l, of_l);
            l = high - part * (high - low);
            of_l = f(l);
        } else {
            (low, l, of_l) = (l, r, of_r);
            r = low + part * (high - low);
            of_r = f(r);
        }
    }
    if of_l <= of_r { (l, of_l) } else { (r, of_r) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(f: impl Fn(f64) -> f64, l: f64, r: f64) -> (f64, f64, usize) {
        let mut count = 0;
        let mut g = |x| {
            count += 1;
            f(x)
        };
        let (left, right) = (g(l), g(r));
        let (left, right) = close(&mut g, (l, left), (r, right));
        assert!(left.1 >= 0.0 && right.1 < 0.0 && right.0 == above(left.0));
        (left.0, right.0, count)
    }

    #[test]
    fn simple_roots_take_few_evaluations() {
        let (x, _, n) = counted(|x| 0.5 - x * x, 0.0, 1.0);
        assert!((x - 0.5f64.sqrt()).abs() < 2e-16 && n <= 14, "{n}");
        let (x, _, n) = counted(|x| x.cos(), 0.0, 3.0);
        assert!(
            (x - std::f64::consts::FRAC_PI_2).abs() < 4e-16 && n <= 14,
            "{n}"
        );
    }

    #[test]
    fn worst_cases_stay_bounded() {
        let (x, _, n) = counted(|x| (1.0 / 3.0 - x).powi(3), 0.0, 1.0);
        assert!((x - 1.0 / 3.0).abs() < 1e-15 && n <= 192, "{n}");
        let (x, _, n) = counted(|x| if x < 0.3 { 1.0 } else { -1e-9 }, 0.0, 1.0);
        assert!(x == 0.3f64.next_down() && n <= 192, "{n}");
        let (x, _, n) = counted(|x| 1e-300 - x, 0.0, 1.0);
        assert!(x == 1e-300 && n <= 192, "{n}");
    }

    #[test]
    fn a_minimum_is_found_inside_and_at_an_end() {
        for place in [0.1, 0.5, 0.93] {
            let (x, value) = minimum(&mut |x: f64| 2.0 + (x - place).powi(2), (0.0, 1.0));
            assert!((x - place).abs() < 2e-8 && value < 2.0 + 4e-16, "{x}");
        }
        let (x, _) = minimum(&mut |x: f64| -x, (0.0, 1.0));
        assert!(1.0 - x < 2e-8);
    }

    #[test]
    fn a_minimum_is_found_in_a_window_of_few_doubles() {
        for count in 0..200_u64 {
            let low = 6.0_f64;
            let high = f64::from_bits(low.to_bits() + count);
            for least in 0..=count {
                let place = f64::from_bits(low.to_bits() + least);
                let (x, value) = minimum(&mut |x: f64| (x - place).abs(), (low, high));
                assert!(low <= x && x <= high && value == (x - place).abs());
                // The last two places have no double on one of their sides: six are left at most.
                assert!(
                    value <= 4.0 * f64::EPSILON * low,
                    "{least} of {count}: {value:e}"
                );
            }
        }
    }

    #[test]
    fn lowest_reaches_the_exact_minimum() {
        let mut f = |x: f64| (x - 0.3) * (x - 0.3);
        for ulps in [-1000, -3, 0, 1, 17, 12345] {
            let x = moved(0.3, ulps, 0.0, 1.0);
            let near = (x, f(x));
            assert_eq!(lowest(&mut f, near, 0.0, 1.0), (0.3, 0.0));
        }
    }
}
