//! The first simple fall of a polynomial: the common case, fast.
//!
//! The Bernstein coefficients have no sign change where there is no root, and one where there is one
//! root (Descartes' rule): then a Newton iteration of third order leads to it.
//!
//! Where they have more, certified steps go on. Bounds of the curvature on the whole window make every step safe. From a place s with g(s) > 0
//! the parabola with the least possible curvature bounds g from below, so that there is no root
//! before its own. As far as the greatest possible curvature cannot turn a negative slope, g falls:
//! the sign at the end of that piece decides, and the only root in it is found as before. Whatever
//! does not fit is left to the general search.

use super::bracket::{Point, close};
use super::doubles::{above, below};
use super::polynomial::Polynomial;
use super::{Kind, Search, Watch};

/// Certified steps before the general search is cheaper; most windows need two or three.
const MOST_STEPS: usize = 12;

/// Steps to a root on a falling piece; the third order needs three from half a window away.
const MOST_ITERATIONS: usize = 8;

/// A relative step after which the iteration has ended, since it leaves the cube of its last step: the
/// cube root of the unit roundoff.
const LAST_STEP: f64 = 4.8e-6;

/// A polynomial with its slope, and bounds of its curvature.
struct Derivatives<const N: usize> {
    value: Polynomial<N>,
    slope: Polynomial<N>,
    /// Bounds of the curvature on [0, 1].
    least: f64,
    greatest: f64,
    /// Bounds of the rounding errors of value and slope on [0, 1].
    error: f64,
    slope_error: f64,
}

impl<const N: usize> Derivatives<N> {
    fn new(polynomial: &Polynomial<N>) -> Self {
        let c = &polynomial.coefficients;
        let mut slope = [0.0; N];
        let (mut size, mut slope_size, mut curvature_size) = (c[0].abs(), 0.0, 0.0);
        let (mut least, mut greatest) = (0.0, 0.0);
        for k in 1..N {
            let first = k as f64 * c[k];
            slope[k - 1] = first;
            size += c[k].abs();
            slope_size += first.abs();
            if k >= 2 {
                let second = (k - 1) as f64 * first;
                curvature_size += second.abs();
                if k == 2 {
                    (least, greatest) = (second, second);
                } else {
                    least += second.min(0.0);
                    greatest += second.max(0.0);
                }
            }
        }
        let rounding = Polynomial::<N>::ROUNDING;
        Derivatives {
            value: *polynomial,
            slope: Polynomial {
                coefficients: slope,
            },
            least: least - rounding * curvature_size,
            greatest: greatest + rounding * curvature_size,
            error: rounding * size,
            slope_error: rounding * slope_size,
        }
    }
}

/// The first event of an armed guard in `from` < s ≤ `to`, or that there is none; `None` where this
/// search cannot tell.
pub(super) fn first_fall<const N: usize>(
    polynomial: &Polynomial<N>,
    from: f64,
    to: f64,
) -> Option<Search> {
    let bernstein = polynomial.bernstein();
    let size: f64 = polynomial.coefficients.iter().map(|c| c.abs()).sum();
    let margin = Polynomial::<N>::ROUNDING * size;
    let changes = Changes::of(&bernstein, margin);
    let bounded = |search: Search| match search.crossing {
        None => Search::above(least(&bernstein)),
        Some(_) => search,
    };
    if matches!(changes, Changes::None) {
        return Some(bounded(Search::quiet(Watch::Armed)));
    }
    if let Changes::One(index) = changes {
        return only_fall(polynomial, (&bernstein, index), (from, to), 1.0).map(bounded);
    }
    // Where it falls and rises again, there is one root before its lowest place.
    let lowest = (1..N).fold(0, |lowest, i| match bernstein[i] < bernstein[lowest] {
        true => i,
        false => lowest,
    });
    let end = to.min(lowest as f64 / (N - 1) as f64);
    if from < end && polynomial.value(end) < -margin {
        let bernstein = polynomial.on(end).bernstein();
        if let Changes::One(index) = Changes::of(&bernstein, margin) {
            return only_fall(polynomial, (&bernstein, index), (from, end), end);
        }
    }
    by_certified_steps(polynomial, from, to).map(bounded)
}

/// The least Bernstein coefficient, which the polynomial does not fall below; four side by side, since
/// each comparison waits for the one before.
fn least<const N: usize>(bernstein: &[f64; N]) -> f64 {
    let lower = |a: f64, b: f64| if b < a { b } else { a };
    let (fours, rest) = bernstein.as_chunks::<4>();
    let mut least = [f64::INFINITY; 4];
    for four in fours {
        for (least, &b) in least.iter_mut().zip(four) {
            *least = lower(*least, b);
        }
    }
    let all = least.iter().chain(rest);
    all.fold(f64::INFINITY, |least, &b| lower(least, b))
}

/// Sign changes of Bernstein coefficients.
enum Changes {
    /// All are certainly positive.
    None,
    /// They are positive before the one of this index, and negative from it on.
    One(usize),
    /// There may be others.
    Other,
}

impl Changes {
    /// Those of coefficients that may be off by `margin`.
    fn of<const N: usize>(bernstein: &[f64; N], margin: f64) -> Changes {
        let certain = |b: &f64| *b > margin;
        match bernstein.iter().position(|b| !certain(b)) {
            None => Changes::None,
            Some(i) if i > 0 && bernstein[i..].iter().all(|b| *b < -margin) => Changes::One(i),
            Some(_) => Changes::Other,
        }
    }
}

/// The event in `from` < s ≤ `to`, where the Bernstein coefficients on [0, `end`] change their sign once,
/// at the one of index `falls`: there is one root.
fn only_fall<const N: usize>(
    polynomial: &Polynomial<N>,
    (bernstein, falls): (&[f64; N], usize),
    (from, to): (f64, f64),
    end: f64,
) -> Option<Search> {
    let at_end = polynomial.value(to);
    if at_end >= 0.0 {
        return Some(Search::quiet(Watch::Armed));
    }
    // Where the polygon of the coefficients falls through zero.
    let (before, after) = (bernstein[falls - 1], bernstein[falls]);
    let place = (falls - 1) as f64 + before / (before - after);
    let near = end * place / (N - 1) as f64;
    let s = if from < near && near < to { near } else { from };
    let (left, right) = ((from, polynomial.value(from)), (to, at_end));
    match left.1 > 0.0 {
        true => root(polynomial, left, right, s),
        false => None,
    }
}

/// The same where more than one root is possible.
fn by_certified_steps<const N: usize>(
    polynomial: &Polynomial<N>,
    from: f64,
    to: f64,
) -> Option<Search> {
    let g = Derivatives::new(polynomial);
    let mut s = from;
    for _ in 0..MOST_STEPS {
        let (value, slope) = (g.value.value(s), g.slope.value(s));
        let positive = value - g.error;
        if positive.is_nan() || positive <= 0.0 {
            return None;
        }
        // How far there is no root for certain …
        let slope_below = slope - g.slope_error;
        let discriminant = slope_below * slope_below - 2.0 * g.least * positive;
        if discriminant < 0.0 || g.least >= 0.0 && slope_below >= 0.0 {
            return Some(Search::quiet(Watch::Armed));
        }
        let denominator = discriminant.sqrt() - slope_below;
        if denominator <= 0.0 {
            return Some(Search::quiet(Watch::Armed));
        }
        // (four roundings of the quotient: shortened by as much)
        let safe = 2.0 * positive / denominator * (1.0 - 4.0 * f64::EPSILON);
        if s + safe >= to {
            return Some(Search::quiet(Watch::Armed));
        }
        // … and how far it falls for certain.
        let steepest = slope + g.slope_error;
        let falls = match g.greatest > 0.0 {
            true => -steepest / g.greatest * (1.0 - 2.0 * f64::EPSILON),
            false => f64::INFINITY,
        };
        if steepest < 0.0 && falls > safe {
            let end = to.min(s + falls);
            let at_end = g.value.value(end);
            if at_end < 0.0 {
                return root(polynomial, (s, value), (end, at_end), s);
            }
            if end == to {
                return Some(Search::quiet(Watch::Armed));
            }
            s = end;
        } else {
            s += safe;
        }
    }
    None
}

/// The only root between two places at which the polynomial has different signs, sought from `s` on.
fn root<const N: usize>(
    polynomial: &Polynomial<N>,
    left: Point,
    right: Point,
    mut s: f64,
) -> Option<Search> {
    let (mut l, mut r) = (left, right);
    let mut value = polynomial.value(s);
    let mut parabola = (value, 0.0, 0.0);
    for _ in 0..MOST_ITERATIONS {
        if value < 0.0 {
            r = (s, value)
        } else {
            l = (s, value)
        }
        let (slope, curvature) = polynomial.slope_and_curvature(s);
        let discriminant = slope * slope - 2.0 * curvature * value;
        parabola = (value, slope, curvature);
        // The root of the parabola at s that a falling piece leads to, or Newton's.
        let step = match discriminant > 0.0 && slope < 0.0 {
            true => 2.0 * value / (discriminant.sqrt() - slope),
            false => -value / slope,
        };
        let next = s + step;
        if !(l.0 < next && next < r.0) {
            break;
        }
        let moved = (next - s).abs();
        (s, value) = (next, polynomial.value(next));
        if moved <= LAST_STEP * s {
            break;
        }
    }
    if value < 0.0 {
        r = (s, value)
    } else {
        l = (s, value)
    }
    // Rounding may have left one end of the bracket far away: look beside the other one first.
    let mut own = |s: f64| polynomial.value(s);
    if value < 0.0 {
        let s = below(r.0);
        let value = own(s);
        if value >= 0.0 {
            l = (s, value)
        } else {
            r = (s, value)
        }
    } else {
        let s = above(l.0);
        let value = own(s);
        if value < 0.0 {
            r = (s, value)
        } else {
            l = (s, value)
        }
    }
    let (l, r) = close(&mut own, l, r);
    let event = Search::found(l.0, r.0, Kind::Fall, Watch::Violated);
    Some(match parabola {
        // The bottom of the parabola where the iteration has ended.
        (value, slope, curvature) if curvature > 0.0 => {
            event.turning(value - slope * slope / (2.0 * curvature))
        }
        _ => event,
    })
}
