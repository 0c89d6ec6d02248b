//! The first simple fall of a polynomial: the common case, fast.
//!
//! The Bernstein coefficients have no sign change where there is no root, and one where there is one
//! root (Descartes' rule): then Halley's iteration leads to it. Where they have more, the
//! polynomial is cut in two by de Casteljau's rule, and the first part is looked at first (Lane, J. M. and
//! Riesenfeld, R. F. (1981), BIT 21, 112–117). Whatever does not fit, such as a touch, is left to the
//! general search. A parabola has its root in closed form.

use super::bracket::{Point, close};
use super::doubles::{above, below};
use super::polynomial::{Polynomial, sum_of};
use super::{Isolation, Kind, Search, Watch, quadratic};

/// Cuts into halves of halves before the general search is cheaper: what has not become one root or none by
/// then is a touch or nearly one.
const MOST_CUTS: usize = 8;

/// Steps to a root on a falling piece: the third order mostly needs two, and three from half a window away.
const MOST_ITERATIONS: usize = 8;

/// A relative step after which the iteration has ended, since it leaves the cube of its last step: the
/// cube root of the unit roundoff.
const LAST_STEP: f64 = 4.8e-6;

/// How far a place may be from a root, in its own unit: a landing goes on from there by the motion's Taylor polynomial of
/// second order, which is exact to rounding over fifteen times as much of a step.
const NEAR: f64 = 1.0e-9;

/// Writes the first event of an armed guard in `from` < s ≤ `to`, or that there is none; false where this
/// search cannot tell.
pub(super) fn first_crossing<const N: usize>(
    polynomial: &Polynomial<N>,
    (from, to): (f64, f64),
    isolation: Isolation,
    found: &mut Search,
) -> bool {
    if N == quadratic::ROOM {
        return quadratic::first_crossing(polynomial, (from, to), isolation, found);
    }
    let size = sum_of(&polynomial.coefficients, f64::abs);
    let guard = Armed {
        polynomial,
        from,
        to,
        rounding: Polynomial::<N>::ROUNDING * size,
        isolation,
    };
    let mut bernstein = [0.0; N];
    polynomial.bernstein(&mut bernstein);
    if from > 0.0 {
        // Before the window it may be zero, as where a guard has just risen from it: halves would close in on that.
        let (_, within) = cut(&bernstein, from);
        return guard.first_crossing(&within, (from, 1.0), 1, found);
    }
    guard.first_crossing(&bernstein, (0.0, 1.0), 0, found)
}

/// An armed guard on a window.
struct Armed<'p, const N: usize> {
    polynomial: &'p Polynomial<N>,
    from: f64,
    to: f64,
    /// Bound of the rounding errors of Bernstein coefficients on [0, 1], and of those that a cut adds: a cut
    /// takes N − 1 means of two, each in between.
    rounding: f64,
    isolation: Isolation,
}

impl<const N: usize> Armed<'_, N> {
    /// The same within a piece, given the Bernstein coefficients there, after so many cuts.
    #[inline]
    fn first_crossing(
        &self,
        bernstein: &[f64; N],
        piece: (f64, f64),
        cuts: usize,
        found: &mut Search,
    ) -> bool {
        let (start, end) = piece;
        if end <= self.from || self.to <= start {
            *found = Search::nothing(Watch::Armed);
            return true;
        }
        match Changes::of(bernstein, (1 + cuts) as f64 * self.rounding) {
            Changes::None => {
                *found = Search::above(least_after_start(bernstein));
                true
            }
            Changes::One(index) => self.only_crossing((bernstein, index), piece, found),
            Changes::Other => {
                cuts < MOST_CUTS && self.first_crossing_of_parts(bernstein, piece, cuts, found)
            }
        }
    }

    /// The same, of two parts in turn.
    #[inline(never)]
    fn first_crossing_of_parts(
        &self,
        bernstein: &[f64; N],
        (start, end): (f64, f64),
        cuts: usize,
        found: &mut Search,
    ) -> bool {
        let part = part_before_rise(bernstein);
        let middle = start + part * (end - start);
        // At the start the powers lead there at less cost, and what is behind may not be needed.
        let mut left = [0.0; N];
        let right = match start == 0.0 {
            true => {
                self.polynomial.on(middle).bernstein(&mut left);
                None
            }
            false => {
                let (own, right) = cut(bernstein, part);
                left = own;
                Some(right)
            }
        };
        if !self.first_crossing(&left, (start, middle), cuts + 1, found) {
            return false;
        }
        if found.crossing.is_some() {
            return true;
        }
        let turn = found.turn;
        let right = right.unwrap_or_else(|| cut(bernstein, part).1);
        if !self.first_crossing(&right, (middle, end), cuts + 1, found) {
            return false;
        }
        if found.crossing.is_none() {
            found.turn = found.turn.min(turn);
        }
        true
    }

    /// The event in a piece where the Bernstein coefficients change their sign once, at the one of index
    /// `falls`: there is one root.
    #[inline(always)]
    fn only_crossing(
        &self,
        (bernstein, falls): (&[f64; N], usize),
        (start, end): (f64, f64),
        found: &mut Search,
    ) -> bool {
        let (from, to) = (self.from.max(start), self.to.min(end));
        // At the end of the piece it is certainly negative: the last coefficient but for rounding.
        let at_end = match to == end {
            true => bernstein[N - 1],
            false => self.polynomial.value(to),
        };
        if at_end >= 0.0 {
            // What it falls to behind the window tells nothing.
            let mut within = [0.0; N];
            self.polynomial.on(to).bernstein(&mut within);
            *found = Search::above(least_after_start(&within));
            return true;
        }
        let near = start + first_guess(bernstein, falls) * (end - start);
        let s = if from < near && near < to { near } else { from };
        let at_start = match from == 0.0 {
            true => self.polynomial.coefficients[0],
            false => self.polynomial.value(from),
        };
        let (left, right) = ((from, at_start), (to, at_end));
        let is_bracket = left.1 > 0.0;
        if is_bracket {
            *found = root(self, left, right, s);
        }
        is_bracket
    }
}

/// Where in a piece the root may be, given the index of the first negative Bernstein coefficient: beside an end of it
/// by a step from there, else where the polygon of the coefficients falls through zero.
#[inline(always)]
fn first_guess<const N: usize>(bernstein: &[f64; N], falls: usize) -> f64 {
    // One by one: `map` of an array is a call.
    let guess = match (bernstein.first_chunk(), bernstein.last_chunk()) {
        (Some(first), _) if falls <= 2 => step_from_end(*first, N - 1),
        (_, Some(&[b3, b2, b1, b0])) if falls + 2 >= N => {
            1.0 - step_from_end([b0, b1, b2, b3], N - 1)
        }
        _ => f64::NAN,
    };
    match 0.0 < guess && guess < 1.0 {
        true => guess,
        false => root_of_polygon(bernstein, falls),
    }
}

/// The step into a piece from an end of it to a root, given the Bernstein coefficients from there on, which tell value
/// and three derivatives: Householder's of fourth order (Householder 1970, section 4.4).
#[inline(always)]
fn step_from_end([b0, b1, b2, b3]: [f64; 4], degree: usize) -> f64 {
    let n = degree as f64;
    let first = [b1 - b0, b2 - b1, b3 - b2];
    let second = [first[1] - first[0], first[2] - first[1]];
    let slope = n * first[0];
    let curvature = n * (n - 1.0) * second[0];
    let third = n * (n - 1.0) * (n - 2.0) * (second[1] - second[0]);
    let (slope2, product) = (slope * slope, b0 * curvature);
    -b0 * (slope2 - 0.5 * product) / (slope * (slope2 - product) + b0 * b0 * third / 6.0)
}

/// The root of the polygon of the Bernstein coefficients, whose sign changes before the one of index `falls`, moved by
/// how far its curvature takes it from the polynomial: B f − f = s (1 − s) f″/2n for the Bernstein polynomial B f of a
/// function f (Voronovskaya 1932), and f is no polygon either, but has the coefficients as values.
#[inline(always)]
fn root_of_polygon<const N: usize>(bernstein: &[f64; N], falls: usize) -> f64 {
    let n = (N - 1) as f64;
    let (before, after) = (bernstein[falls - 1], bernstein[falls]);
    let part = before / (before - after);
    let s = ((falls - 1) as f64 + part) / n;
    // f″/n², about the nearer of the two.
    let second = match part < 0.5 {
        true if falls > 1 => bernstein[falls - 2] + after - 2.0 * before,
        false if falls + 1 < N => before + bernstein[falls + 1] - 2.0 * after,
        _ => 0.0,
    };
    let off = 0.5 * second * (n * s * (1.0 - s) - part * (1.0 - part));
    let moved = s + off / (n * (before - after));
    match 0.0 < moved && moved < 1.0 {
        true => moved,
        false => s,
    }
}

/// The step to a root from where a function has this value, slope and curvature: Halley's, of third order, or Newton's.
#[inline(always)]
fn step(value: f64, slope: f64, curvature: f64) -> f64 {
    let denominator = slope * slope - 0.5 * curvature * value;
    match denominator > 0.0 {
        true => -value * slope / denominator,
        false => -value / slope,
    }
}

/// The part of a piece before its least Bernstein coefficient, which divides a fall from the rise that
/// follows; half of it where that is at an end.
fn part_before_rise<const N: usize>(bernstein: &[f64; N]) -> f64 {
    let lowest = (1..N).fold(0, |lowest, i| match bernstein[i] < bernstein[lowest] {
        true => i,
        false => lowest,
    });
    match lowest == 0 || lowest == N - 1 {
        true => 0.5,
        false => lowest as f64 / (N - 1) as f64,
    }
}

/// Bernstein coefficients before and behind a part of the piece.
fn cut<const N: usize>(bernstein: &[f64; N], part: f64) -> ([f64; N], [f64; N]) {
    let (mut left, mut right) = (*bernstein, *bernstein);
    for (count, left) in (1..N).rev().zip(&mut left[1..]) {
        for i in 0..count {
            right[i] = (1.0 - part) * right[i] + part * right[i + 1];
        }
        *left = right[0];
    }
    (left, right)
}

/// The least Bernstein coefficient but the first, which is the value at the start of the piece: where it rises from
/// near zero it does not turn there. Four side by side, since each comparison waits for the one before.
#[inline(always)]
fn least_after_start<const N: usize>(bernstein: &[f64; N]) -> f64 {
    let lower = |a: f64, b: f64| if b < a { b } else { a };
    let (fours, rest) = bernstein[1..].as_chunks::<4>();
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

/// Moves the end of a bracket whose value has the sign of a point's there.
#[inline(always)]
fn narrow((left, right): (&mut Point, &mut Point), point: Point) {
    if point.1 < 0.0 {
        *right = point
    } else {
        *left = point
    }
}

/// The fall in a bracket, next to a point within it that is off by rounding only. That may have left one end of the
/// bracket far away: its neighbour is looked at first.
#[inline(always)]
pub(super) fn crossing_beside(
    value: &mut impl FnMut(f64) -> f64,
    (mut l, mut r): (Point, Point),
    point: Point,
) -> Search {
    let (s, here) = point;
    // Both, since which of them is looked for is known only after the value at the point.
    let [before, after] = [below(s), above(s)].map(|s| (s, value(s)));
    narrow((&mut l, &mut r), point);
    narrow((&mut l, &mut r), if here < 0.0 { before } else { after });
    let (l, r) = close(value, l, r);
    Search::found(l.0, r.0, Kind::Crossing, Watch::Violated)
}

/// The fall about a place `s` that is off by rounding only, in a bracket that is as wide as leaves no doubt about the
/// signs at its ends, given slope and curvature: a value that is off by the rounding has its root so far away. None
/// where that leaves the window, or is so far that Newton's method does not lead from the ends to the root, to the last
/// place of s, in one step.
///
/// Values next to a root are equal over many doubles, or have random signs: which of them are neighbours of different
/// signs takes up to ten values, and tells nothing about where the root is.
#[inline(always)]
pub(super) fn certain_crossing<const N: usize>(
    polynomial: &Polynomial<N>,
    (from, to): (f64, f64),
    s: f64,
    rounding: f64,
    [slope, curvature]: [f64; 2],
) -> Option<Search> {
    // Of all terms but the first no more than the part s is left there.
    let first = Polynomial::<N>::ROUNDING * polynomial.coefficients[0].abs();
    let margin = (first + s * (rounding - first)) / slope.abs();
    let (before, after) = (below(s).min(s - margin), above(s).max(s + margin));
    let (at_before, at_after) = (polynomial.value(before), polynomial.value(after));
    // Newton's method leaves the square of the distance times half of curvature ÷ slope, which are those of the
    // polynomial, or of s times it: that adds 2/s.
    let bend = curvature.abs() * s + 2.0 * slope.abs();
    let is_straight = 0.5 * bend * margin * margin <= f64::EPSILON * s * s * slope.abs();
    let is_within = from <= before && after <= to;
    (is_straight && is_within && at_before > 0.0 && at_after < 0.0)
        .then(|| Search::found(before, after, Kind::Crossing, Watch::Violated))
}

/// Whether a step of [`step`] to a place s leaves no more than [`NEAR`] to the root: it leaves about its cube times the
/// square of half of curvature ÷ slope, which are those of the polynomial, or of s times it: that adds 1/s.
#[inline(always)]
fn is_near(step: f64, s: f64, [slope, curvature]: [f64; 2]) -> bool {
    let bend = curvature.abs() * s + 2.0 * slope.abs();
    let step = step.abs();
    bend * bend * (step * step * step) <= 4.0 * NEAR * (s * slope) * (s * slope) * s
}

/// The only root of a guard between two places at which it has different signs, sought from a place on.
#[inline(always)]
fn root<const N: usize>(guard: &Armed<N>, left: Point, right: Point, s: f64) -> Search {
    let &Armed {
        polynomial,
        rounding,
        isolation,
        ..
    } = guard;
    let (mut l, mut r) = (left, right);
    let derivatives = polynomial.derivatives();
    let mut point = (s, polynomial.value(s));
    let mut parabola = (point.1, 0.0, 0.0);
    let mut isolated = None;
    for _ in 0..MOST_ITERATIONS {
        let (s, value) = point;
        narrow((&mut l, &mut r), point);
        let (slope, curvature) = (derivatives[0].sum(s), derivatives[1].sum(s));
        parabola = (value, slope, curvature);
        let step = step(value, slope, curvature);
        let next = s + step;
        let is_within = l.0 < next && next < r.0;
        let is_last = step.abs() <= LAST_STEP * s;
        let bend = [slope, curvature];
        if isolation == Isolation::Root {
            if is_within && is_near(step, next, bend) {
                isolated = Some(Search::found(next, next, Kind::Crossing, Watch::Violated));
            }
        } else if is_last {
            let window = (left.0, right.0);
            isolated = certain_crossing(polynomial, window, next, rounding, bend);
        }
        if isolated.is_some() || !is_within {
            break;
        }
        point = (next, polynomial.value(next));
        if is_last {
            break;
        }
    }
    let event = match isolated {
        Some(event) => event,
        None => crossing_beside(&mut |s| polynomial.value(s), (l, r), point),
    };
    match parabola {
        // The bottom of the parabola where the iteration has ended.
        (value, slope, curvature) if curvature > 0.0 => {
            event.turning(value - slope * slope / (2.0 * curvature))
        }
        _ => event,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hybrid::roots::Crossing;

    /// (root − s) times a polynomial that is positive on [0, 1], of degree 11 in all.
    fn with_root(root: f64, others: &[f64; 5]) -> Polynomial<12> {
        let mut coefficients = [0.0; 12];
        (coefficients[0], coefficients[1]) = (root, -1.0);
        for (k, &other) in others.iter().enumerate() {
            // (s − other)² + (1 + k)/40
            let own = [other * other + (1 + k) as f64 / 40.0, -2.0 * other, 1.0];
            let before = coefficients;
            for (i, out) in coefficients.iter_mut().enumerate() {
                *out = (0..3.min(i + 1)).map(|j| own[j] * before[i - j]).sum();
            }
        }
        Polynomial { coefficients }
    }

    fn crossing(polynomial: &Polynomial<12>, isolation: Isolation) -> Crossing {
        let mut found = Search::nothing(Watch::Armed);
        polynomial.search_armed((0.0, 1.0), 0.0, isolation, &mut found);
        found.crossing.expect("it has a root")
    }

    #[test]
    fn a_place_is_so_near_the_root_that_a_landing_finds_it() {
        let place = |i: usize| (i as f64 * 0.618_033_988_749_894_9).fract();
        for i in 0..4000 {
            let root = 0.02 + 0.96 * place(i);
            let others = std::array::from_fn(|k| place(7 * i + 1009 * k + 3));
            let polynomial = with_root(root, &others);
            let [near, bracket] =
                [Isolation::Root, Isolation::Bracket].map(|how| crossing(&polynomial, how));
            let width = bracket.outside - bracket.inside;
            assert_eq!(near.inside, near.outside);
            let off = f64::max(
                bracket.inside - near.outside,
                near.outside - bracket.outside,
            );
            assert!(off <= 10.0 * NEAR * root + width, "{i}: {off:e}");
        }
    }

    #[test]
    fn a_bracket_of_the_engine_is_certain_and_as_narrow_as_rounding() {
        // Places of the golden ratio's multiples: spread evenly.
        let place = |i: usize| (i as f64 * 0.618_033_988_749_894_9).fract();
        let mut equal = 0;
        for i in 0..4000 {
            let root = 0.02 + 0.96 * place(i);
            let others = std::array::from_fn(|k| place(7 * i + 1009 * k + 3));
            let polynomial = with_root(root, &others);
            let Crossing {
                inside, outside, ..
            } = crossing(&polynomial, Isolation::Bracket);
            let value = |s| polynomial.value(s);
            assert!(value(inside) >= 0.0 && value(outside) < 0.0, "{i}");
            let own = &polynomial.coefficients;
            let size = own[0].abs() + root * sum_of(&own[1..], f64::abs);
            let rounding = Polynomial::<12>::ROUNDING * size;
            let slope = polynomial.derivatives()[0].value(root).abs();
            let width = outside - inside;
            assert!(
                width <= 2.001 * rounding / slope + 4.0 * f64::EPSILON,
                "{i}: {width:e}"
            );
            // The root is in it, but for what the coefficients are off by.
            let off = f64::max(inside - root, root - outside);
            assert!(off <= rounding / slope, "{i}: {off:e}");
            // The public search closes in on neighbours within it.
            let closed = polynomial.search(0.0, 1.0, Watch::Armed, 0.0).crossing;
            let closed = closed.expect("it has a root");
            assert!(inside <= closed.inside && closed.outside <= outside, "{i}");
            assert_eq!(above(closed.inside), closed.outside);
            assert!(value(closed.inside) >= 0.0 && value(closed.outside) < 0.0);
            equal += usize::from(closed.inside == inside);
        }
        // Not one that was closed in on already.
        assert!(equal < 400, "{equal} of 4000 begin where neighbours do");
    }
}
