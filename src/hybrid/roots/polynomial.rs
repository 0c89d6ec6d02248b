//! A guard that is a polynomial, such as a coordinate on the dense output of a step.

use super::bracket::{close, departure};
use super::extrema::{Count, Expansion, Extrema, extrema};
use super::first_crossing::first_crossing;
use super::walk::{Pieces, walk};
use super::{Isolation, Kind, Search, Watch};
use crate::integrate::stretch;
use crate::kernel::triangular_sums;

/// Polynomial on s ∈ \[0, 1\] in powers of s: value Σₖ `coefficients[k]` sᵏ, of degree `N` − 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial<const N: usize> {
    /// In ascending powers of s, in the guard's unit.
    pub coefficients: [f64; N],
}

/// What begins with a line of the cache: vectors of it are read at once.
#[repr(align(64))]
struct Lined<T>(T);

impl<const N: usize> Polynomial<N> {
    /// (j over k) / (N − 1 over k) in column k, row j: from powers to Bernstein coefficients.
    const TO_BERNSTEIN: &'static Lined<[[f64; N]; N]> = &Lined({
        let mut table = [[0.0; N]; N];
        let mut k = 0;
        // Exact: a product of a binomial coefficient and N − k is below 2⁵³ for N ≤ 50.
        let mut last = 1.0;
        while k < N {
            let (mut j, mut binomial) = (k, 1.0);
            while j < N {
                table[k][j] = binomial / last;
                j += 1;
                binomial = binomial * j as f64 / (j - k) as f64;
            }
            k += 1;
            last = last * (N - k) as f64 / k as f64;
        }
        table
    });

    const ZERO: Self = Self {
        coefficients: [0.0; N],
    };

    /// Relative error of a sum of N terms whose factors carry as many roundings: γ ≈ 2Nu.
    pub(super) const ROUNDING: f64 = N as f64 * f64::EPSILON;

    /// The value at s. These values decide about events.
    ///
    /// By Horner's rule, from six coefficients on in powers of s⁴ for every fourth coefficient
    /// (Estrin 1960: a processor works on the four sums side by side). Leading zeros are factors s
    /// of their own, so that dividing them out changes no sign.
    #[inline]
    pub fn value(&self, s: f64) -> f64 {
        if N > 0 && self.coefficients[0] == 0.0 {
            return self.value_of_multiple(s);
        }
        self.sum(s)
    }

    #[inline(always)]
    pub(super) fn sum(&self, s: f64) -> f64 {
        if N < 6 {
            let mut value = 0.0;
            for &coefficient in self.coefficients.iter().rev() {
                value = value * s + coefficient;
            }
            return value;
        }
        let (fours, rest) = self.coefficients.as_chunks::<4>();
        let mut fours = fours.iter().rev();
        let mut sums = match rest.is_empty() {
            true => *fours.next().expect("there are six coefficients"),
            false => std::array::from_fn(|k| rest.get(k).copied().unwrap_or(0.0)),
        };
        let s2 = s * s;
        let s4 = s2 * s2;
        for four in fours {
            for (sum, coefficient) in sums.iter_mut().zip(four) {
                *sum = *sum * s4 + coefficient;
            }
        }
        (sums[0] + s * sums[1]) + s2 * (sums[2] + s * sums[3])
    }

    /// First and second derivative.
    pub(super) fn derivatives(&self) -> [Self; 2] {
        let (mut slope, mut curvature) = ([0.0; N], [0.0; N]);
        for k in 1..N {
            slope[k - 1] = k as f64 * self.coefficients[k];
        }
        for k in 1..N {
            curvature[k - 1] = k as f64 * slope[k];
        }
        // Each by itself: `map` of an array is a call, and a copy.
        let slope = Self {
            coefficients: slope,
        };
        let curvature = Self {
            coefficients: curvature,
        };
        [slope, curvature]
    }

    /// Gives places and values of all extrema in (0, 1), in ascending order of the places.
    pub(in crate::hybrid) fn each_extremum(&self, mut found: impl FnMut(f64, f64)) {
        // Bent one way it has one at most, where its slope changes its sign.
        let [slope, curvature] = self.derivatives();
        let rest: f64 = curvature.coefficients[1..].iter().map(|c| c.abs()).sum();
        if curvature.coefficients[0].abs() > rest {
            let sign = -curvature.coefficients[0].signum();
            let [left, right] = [0.0, 1.0].map(|s| (s, sign * slope.sum(s)));
            if left.1 > 0.0 && right.1 < 0.0 {
                let s = close(&mut |s| sign * slope.sum(s), left, right).0.0;
                found(s, self.value(s));
            }
            return;
        }
        for &s in extrema::<N>(self).as_slice() {
            found(s, self.value(s));
        }
    }

    /// The value where the polynomial is a multiple of s.
    fn value_of_multiple(&self, s: f64) -> f64 {
        let (order, mut quotient) = (self.leading_zeros(), Self::ZERO);
        self.divide(order, &mut quotient);
        (0..order).fold(quotient.sum(s), |value, _| value * s)
    }

    /// The highest power of s that is a factor.
    #[inline(always)]
    fn leading_zeros(&self) -> usize {
        let order = self.coefficients.iter().position(|&c| c != 0.0);
        order.unwrap_or(0)
    }

    /// Divides a power of s out that is a factor; `quotient` is zero before.
    fn divide(&self, order: usize, quotient: &mut Self) {
        quotient.coefficients[..N - order].copy_from_slice(&self.coefficients[order..]);
    }

    /// The earliest event in `from` < s ≤ `to`, where 0 ≤ `from` ≤ `to` ≤ 1.
    ///
    /// `watch` is the sign remembered from before `from`; `noise` is a bound of what a dormant
    /// guard may differ from zero while it is zero, in the guard's unit (0: nothing). With
    /// `noise` = 0 the leading zero coefficients of a polynomial that is dormant at `from` = 0 are
    /// divided out exactly; one that is dormant elsewhere is asleep until it exceeds the rounding
    /// error of its value, so expand a segment's polynomials about its start.
    pub fn search(&self, from: f64, to: f64, watch: Watch, noise: f64) -> Search {
        let mut search = Search::nothing(watch);
        if watch == Watch::Armed {
            self.search_armed((from, to), noise, Isolation::Bracket, &mut search);
            self.close_in(&mut search);
            return search;
        }
        // c₀ + Σ max(cₖ, 0) bounds the polynomial on [0, 1] from above; c₀ itself is on the right side of 0,
        // or this bound tells nothing.
        if watch == Watch::Violated {
            let rises = sum_of(&self.coefficients, |c| c.max(0.0));
            if -self.coefficients[0] > rises * (1.0 + Self::ROUNDING) {
                return Search::nothing(Watch::Violated);
            }
        }
        if from >= to {
            Search::nothing(watch)
        } else if watch == Watch::Dormant && noise == 0.0 && from == 0.0 {
            self.leave_zero(to)
        } else {
            self.search_pieces(from, to, watch, noise)
        }
    }

    /// The same for a guard that is armed, but that a fall is isolated as is asked for: closer the guard's own values
    /// tell, at the state itself. What is found is written where the caller reads it, since a copy right after it would
    /// wait for what is on its way to memory.
    #[inline(always)]
    pub(in crate::hybrid) fn search_armed(
        &self,
        (from, to): (f64, f64),
        noise: f64,
        isolation: Isolation,
        found: &mut Search,
    ) {
        // As c₀ + Σ min(cₖ, 0) does from below.
        let falls = sum_of(&self.coefficients, |c| (-c).max(0.0)) * (1.0 + Self::ROUNDING);
        if self.coefficients[0] > falls {
            // Where it rises from near zero it does not turn: a bound of all Bernstein coefficients but the first.
            let rise = self
                .coefficients
                .get(1)
                .map_or(0.0, |c| c.max(0.0) / (N - 1) as f64);
            *found = Search::above(self.coefficients[0] + rise - falls);
        } else if from >= to {
            *found = Search::nothing(Watch::Armed);
        } else if !first_crossing(self, (from, to), isolation, found) {
            *found = self.search_pieces(from, to, Watch::Armed, noise);
        }
    }

    /// Closes in on neighbouring doubles.
    fn close_in(&self, found: &mut Search) {
        if let Some(crossing) = &mut found.crossing
            && crossing.kind == Kind::Crossing
        {
            let [left, right] = [crossing.inside, crossing.outside].map(|s| (s, self.value(s)));
            let (left, right) = close(&mut |s| self.value(s), left, right);
            (crossing.inside, crossing.outside) = (left.0, right.0);
        }
    }

    /// The search, on 0 < s ≤ `to`, of sᵏ times this polynomial, k = `order`, which is positive at s = 0: of a
    /// guard that leaves zero upwards.
    pub(in crate::hybrid) fn search_of_multiple(
        &self,
        order: usize,
        to: f64,
        isolation: Isolation,
        found: &mut Search,
    ) {
        self.search_armed((0.0, to), 0.0, isolation, found);
        let slope = |(k, c): (usize, &f64)| k as f64 * c.abs();
        let steepest = self.coefficients.iter().enumerate().map(slope).sum();
        let place = found.crossing.map_or(to, |crossing| crossing.outside);
        found.of_quotient(order, (self.coefficients[0], steepest), place);
    }

    #[inline(never)]
    fn search_pieces(&self, from: f64, to: f64, watch: Watch, noise: f64) -> Search {
        if watch == Watch::Violated {
            let margin = Self::ROUNDING * sum_of(&self.coefficients, f64::abs);
            let mut bernstein = [0.0; N];
            self.bernstein(&mut bernstein);
            if bernstein.iter().all(|&b| b < -margin) {
                return Search::nothing(watch);
            }
        }
        let mut pieces = Monotone::new(self, from, to, noise);
        walk(&mut pieces, watch).expect("a polynomial has a value everywhere")
    }

    /// Divides the zero at s = 0 out; the sign beside it is that of the first coefficient left.
    fn leave_zero(&self, to: f64) -> Search {
        let (order, mut quotient) = (self.leading_zeros(), Self::ZERO);
        self.divide(order, &mut quotient);
        let coefficients = &quotient.coefficients;
        if coefficients[0] == 0.0 {
            return Search::nothing(Watch::Dormant);
        }
        if coefficients[0] > 0.0 {
            let mut found = Search::nothing(Watch::Armed);
            quotient.search_of_multiple(order, to, Isolation::Bracket, &mut found);
            quotient.close_in(&mut found);
            return found;
        }
        // Cauchy: the quotient has no root nearer to 0 than this.
        let largest = coefficients[1..]
            .iter()
            .fold(0.0, |m: f64, c| m.max(c.abs()));
        let right = to.min(-coefficients[0] / (largest - coefficients[0]));
        let right = (right, self.value(right));
        let (l, r) = departure(&mut |s| self.value(s), 0.0, right).0;
        Search::found(l.0, r.0, Kind::LeavesNegative, Watch::Violated)
    }

    /// Bound of the rounding error of [`Self::value`]: 2n·u·Σ|cₖ|sᵏ (Higham, Accuracy and Stability
    /// of Numerical Algorithms, 2nd ed., section 5.1).
    fn error(&self, s: f64) -> f64 {
        let mut sum = 0.0;
        for &coefficient in self.coefficients.iter().rev() {
            sum = sum * s + coefficient.abs();
        }
        Self::ROUNDING * sum
    }

    /// Writes the Bernstein coefficients on \[0, 1\]: the polynomial lies between the least and the greatest.
    #[inline]
    pub(super) fn bernstein(&self, out: &mut [f64; N]) {
        triangular_sums(&self.coefficients, &Self::TO_BERNSTEIN.0, out);
    }

    /// The polynomial on [0, `end`], in powers of s/`end`.
    pub(super) fn on(&self, end: f64) -> Self {
        let mut coefficients = [0.0; N];
        stretch(
            &self.coefficients,
            |own| *own,
            (1.0, end, 0),
            &mut coefficients,
        );
        Self { coefficients }
    }
}

/// Sum of what is made of each number, in four sums side by side: an addition waits for the one before.
#[inline(always)]
pub(in crate::hybrid) fn sum_of(numbers: &[f64], part: impl Fn(f64) -> f64) -> f64 {
    let (fours, rest) = numbers.as_chunks::<4>();
    let mut sums = [0.0; 4];
    // From the last on, since the first may be on its way to memory.
    for four in fours.iter().rev() {
        for (sum, &number) in sums.iter_mut().zip(four) {
            *sum += part(number);
        }
    }
    let all = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    rest.iter().fold(all, |sum, &number| sum + part(number))
}

impl<const N: usize> Expansion for Polynomial<N> {
    fn value(&self, s: f64) -> f64 {
        self.value(s)
    }

    fn derivative(&self) -> Self {
        let mut coefficients = [0.0; N];
        for k in 1..N {
            coefficients[k - 1] = k as f64 * self.coefficients[k];
        }
        Self { coefficients }
    }

    /// Descartes' rule: as many roots in (0, 1) as sign changes of the Bernstein coefficients, or
    /// fewer by an even number.
    fn count(&self) -> Count {
        if self.coefficients[1..].iter().all(|&c| c == 0.0) {
            return Count::None;
        }
        let mut b = [0.0; N];
        self.bernstein(&mut b);
        let mut changes = 0;
        let mut sign = 0.0;
        for &b in b.iter().filter(|b| **b != 0.0) {
            if sign * b < 0.0 {
                changes += 1;
            }
            sign = b.signum();
        }
        match changes {
            0 => Count::None,
            1 if b[0] != 0.0 && b[N - 1] != 0.0 => Count::One,
            _ => Count::Unknown,
        }
    }
}

/// A polynomial on a window, cut at its extrema.
struct Monotone<'p, const N: usize> {
    polynomial: &'p Polynomial<N>,
    /// The extrema inside the window; the nodes lie at its ends and at these.
    extrema: Extrema<N>,
    from: f64,
    to: f64,
    noise: f64,
}

impl<'p, const N: usize> Monotone<'p, N> {
    /// The extrema are those on [0, 1], so they do not depend on how the window is split.
    fn new(polynomial: &'p Polynomial<N>, from: f64, to: f64, noise: f64) -> Self {
        let mut inside = Extrema::new();
        for &s in extrema::<N>(polynomial).as_slice() {
            if from < s && s < to {
                inside.push(s);
            }
        }
        Self {
            polynomial,
            extrema: inside,
            from,
            to,
            noise,
        }
    }
}

impl<const N: usize> Pieces for Monotone<'_, N> {
    fn len(&self) -> usize {
        self.extrema.as_slice().len() + 2
    }

    fn node(&self, index: usize) -> f64 {
        if index == 0 {
            self.from
        } else {
            self.extrema
                .as_slice()
                .get(index - 1)
                .copied()
                .unwrap_or(self.to)
        }
    }

    fn value(&mut self, index: usize) -> Option<(f64, bool)> {
        let s = self.node(index);
        let value = self.polynomial.value(s);
        Some((value, value.abs() <= self.rounding(index)))
    }

    fn rounding(&self, index: usize) -> f64 {
        self.polynomial.error(self.node(index)).max(self.noise)
    }

    fn own(&mut self, s: f64) -> f64 {
        self.polynomial.value(s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The least value of s·h behind its rise from zero, at a thousand places.
    fn least_of_multiple(quotient: &Polynomial<6>) -> f64 {
        let values: Vec<f64> = (0..=1000)
            .map(|k| f64::from(k) * 1e-3)
            .map(|s| s * quotient.value(s))
            .collect();
        let top = values.windows(2).position(|pair| pair[1] < pair[0]);
        top.map_or(values[1000], |top| {
            values[top..].iter().copied().fold(f64::INFINITY, f64::min)
        })
    }

    #[test]
    fn a_guard_that_rises_from_zero_does_not_come_nearer_to_it_than_is_said() {
        let place = |i: usize| (i as f64 * 0.618_033_988_749_894_9).fract();
        let mut near = 0;
        for i in 0..4000 {
            // (s − p)² + a, times a factor that is positive.
            let (p, b) = (0.1 + 1.2 * place(i), 1.0 + place(3 * i + 1));
            let a = 10f64.powf(-12.0 * place(7 * i + 5));
            let [c0, c1, c2] = [p * p + a, -2.0 * p, 1.0];
            let quotient = Polynomial {
                coefficients: [b * c0, b * c1 + c0, b * c2 + c1, c2, 0.0, 0.0],
            };
            let mut found = Search::nothing(Watch::Dormant);
            quotient.search_of_multiple(1, 1.0, Isolation::Root, &mut found);
            assert_eq!(found.crossing, None, "{i}");
            let least = least_of_multiple(&quotient);
            assert!(found.turn <= least, "{i}: {:e} {least:e}", found.turn);
            near += usize::from(found.turn < 1e-9);
        }
        // Most are far from zero, and said to be.
        assert!(near < 2000, "{near}");
    }
}
