//! Functions of time on a window, side by side, as the polynomials through their values at Chebyshev
//! points.
//!
//! The nodes of degree 8 are among those of 16, and those among those of 32, so that a higher degree
//! keeps the values of the lower one. With x = 2s − 1 = −cos φ a polynomial Σ cₖ Tₖ(x) is a sum of
//! cosines of φ, and its nodes are equally spaced in φ: between two of them it exceeds the larger
//! value by no more than (π/n)²/8 Σ k²|cₖ|.

use super::summit::SummitSearch;
use crate::numerics::{Memory, Persist};
use std::f64::consts::PI;

/// Highest degree.
pub const MOST: usize = 32;
/// The degrees that are tried, in this order.
pub const DEGREES: [usize; 3] = [8, 16, MOST];

/// sin²(jπ/64), j = 0 to 16: the places of the nodes in a window of length 1 are these and their
/// mirror images.
const HALF: [f64; 17] = [
    0.0,
    0.002407636663901557,
    0.009607359798384776,
    0.021529832133895567,
    0.038060233744356624,
    0.05903936782582248,
    0.08426519384872738,
    0.11349477331863152,
    0.14644660940672624,
    0.18280335791817726,
    0.22221488349019888,
    0.26430163158700115,
    0.30865828381745514,
    0.3548576613727688,
    0.40245483899193585,
    0.4509914298352197,
    0.5,
];

/// Abscissa of a node of the highest degree in a window of length 1.
pub const fn point(node: usize) -> f64 {
    match node {
        0..=16 => HALF[node],
        _ => 1.0 - HALF[MOST - node],
    }
}

/// cos(jπ/32).
const COSINES: [f64; 2 * MOST] = {
    let mut cosines = [0.0; 2 * MOST];
    let mut j = 0;
    while j < 2 * MOST {
        // cos 2φ = 1 − 2 sin² φ
        cosines[j] = 1.0 - 2.0 * point(if j <= MOST { j } else { 2 * MOST - j });
        j += 1;
    }
    cosines
};

/// Four functions: what a processor works on side by side.
type Four = [f64; 4];

/// What is known of each of four functions from its values and coefficients.
#[derive(Debug, Clone, Copy, Default)]
struct Shape {
    highest: Four,
    lowest: Four,
    /// |c₀|.
    constant: Four,
    /// Sums of |cₖ| from 1 to half the degree, and from there on.
    lower: Four,
    upper: Four,
    /// Σ k²|cₖ|, a bound of the second derivative with respect to φ.
    bend: Four,
}

/// Polynomials of up to [`MOST`] degrees on one window, s from 0 to 1.
#[derive(Debug)]
pub struct Interpolants {
    /// Number of functions, and of fours of them.
    count: usize,
    fours: usize,
    degree: usize,
    /// A row a node of the highest degree.
    values: Box<[Four]>,
    /// A row an order.
    coefficients: Box<[Four]>,
    shapes: Box<[Shape]>,
}

/// The values at the first node, where a step begins.
impl Persist for Interpolants {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.count.persist(memory)?;
        self.fours = self.count.div_ceil(4);
        memory.slice(self.values.get_mut(..self.fours)?)
    }
}

impl Interpolants {
    /// A row of values that belongs to no node.
    pub const SPARE: usize = MOST + 1;

    /// How closely the place of an extremum is sought: its value is then off by rounding.
    pub const CLOSE: f64 = 1e-9;

    /// Room for so many functions.
    pub fn new(most: usize) -> Self {
        let fours = most.div_ceil(4);
        Interpolants {
            count: 0,
            fours: 0,
            degree: 0,
            values: vec![[0.0; 4]; (Self::SPARE + 1) * fours].into(),
            coefficients: vec![[0.0; 4]; (MOST + 1) * fours].into(),
            shapes: vec![Shape::default(); fours].into(),
        }
    }

    /// Sets the number of functions; false where it changes, and values of before are lost.
    pub fn set_count(&mut self, count: usize) -> bool {
        let stays = self.count == count;
        self.count = count;
        self.fours = count.div_ceil(4);
        stays
    }

    /// The values of all functions at a node of the highest degree.
    pub fn values_mut(&mut self, node: usize) -> &mut [f64] {
        let row = &mut self.values[node * self.fours..][..self.fours];
        &mut row.as_flattened_mut()[..self.count]
    }

    /// Copies the values at one node to another.
    pub fn copy_values(&mut self, from: usize, to: usize) {
        let from = from * self.fours;
        self.values
            .copy_within(from..from + self.fours, to * self.fours);
    }

    /// Value of a function at a node of the highest degree.
    pub fn value_at(&self, node: usize, function: usize) -> f64 {
        self.values[node * self.fours + function / 4][function % 4]
    }

    /// Finds the polynomials through the values at every `MOST / degree`-th node.
    pub fn fit(&mut self, degree: usize) {
        self.degree = degree;
        match degree {
            8 => self.fit_degree::<8>(),
            16 => self.fit_degree::<16>(),
            _ => self.fit_degree::<MOST>(),
        }
    }

    /// The discrete cosine transform, of the sums and of the differences of values at mirrored nodes.
    fn fit_degree<const N: usize>(&mut self) {
        let (stride, half) = (MOST / N, N / 2);
        for four in 0..self.fours {
            let value = |node: usize| self.values[node * stride * self.fours + four];
            let mut shape = Shape {
                highest: value(half),
                lowest: value(half),
                ..Shape::default()
            };
            // Of even orders, and of odd ones. The ends count half.
            let mut folded = [[[0.0; 4]; MOST / 2 + 1]; 2];
            for j in 0..half {
                let (left, right) = (value(j), value(N - j));
                let weight = if j == 0 { 0.5 } else { 1.0 };
                for i in 0..4 {
                    folded[0][j][i] = weight * (left[i] + right[i]);
                    // The nodes ascend, Chebyshev's own descend: Tₖ(−x) = (−1)ᵏ Tₖ(x).
                    folded[1][j][i] = weight * (right[i] - left[i]);
                    shape.highest[i] = shape.highest[i].max(left[i]).max(right[i]);
                    shape.lowest[i] = shape.lowest[i].min(left[i]).min(right[i]);
                }
            }
            folded[0][half] = value(half);
            for k in 0..=N {
                let mut sum = [0.0; 4];
                for (j, folded) in folded[k % 2][..=half].iter().enumerate() {
                    let cosine = COSINES[k * j * stride % (2 * MOST)];
                    for i in 0..4 {
                        sum[i] += cosine * folded[i];
                    }
                }
                let weight = if k == 0 || k == N { 1.0 } else { 2.0 } / N as f64;
                for i in 0..4 {
                    let c = weight * sum[i];
                    sum[i] = c;
                    match k {
                        0 => shape.constant[i] = c.abs(),
                        _ if k <= half => shape.lower[i] += c.abs(),
                        _ => shape.upper[i] += c.abs(),
                    }
                    shape.bend[i] += (k * k) as f64 * c.abs();
                }
                self.coefficients[k * self.fours + four] = sum;
            }
            self.shapes[four] = shape;
        }
    }

    fn coefficient(&self, k: usize, function: usize) -> f64 {
        self.coefficients[k * self.fours + function / 4][function % 4]
    }

    /// A bound of the magnitude of a function.
    pub fn size(&self, function: usize) -> f64 {
        let (shape, i) = (&self.shapes[function / 4], function % 4);
        shape.constant[i] + shape.lower[i] + shape.upper[i]
    }

    /// What a polynomial may differ from its function. If the sums of the halves of its coefficients shrink by a
    /// ratio r from each to the next, what follows sums to r/(1 − r) of the upper half, and acts twice, as left out and
    /// as aliased; without such a decay only the size of the variation is known. Nothing where the upper half is rounding.
    pub fn error(&self, function: usize) -> f64 {
        let (shape, i) = (&self.shapes[function / 4], function % 4);
        let (lower, upper) = (shape.lower[i], shape.upper[i]);
        match upper {
            _ if upper <= self.rounding(function) => 0.0,
            _ if 3.0 * upper < lower => 2.0 * upper * upper / (lower - upper),
            _ => lower + upper,
        }
    }

    /// The largest and the smallest value of a function at the nodes.
    pub fn range(&self, function: usize) -> [f64; 2] {
        let (shape, i) = (&self.shapes[function / 4], function % 4);
        [shape.highest[i], shape.lowest[i]]
    }

    /// By how much a polynomial at most exceeds the larger of its values at two neighbouring nodes; nothing where
    /// that is rounding.
    pub fn overshoot(&self, function: usize) -> f64 {
        let width = PI / self.degree as f64;
        let most = 0.125 * width * width * self.shapes[function / 4].bend[function % 4];
        match most <= self.rounding(function) {
            true => 0.0,
            false => most,
        }
    }

    /// Rounding error of a polynomial: of a sum of as many terms as it has coefficients, each of them such a sum.
    fn rounding(&self, function: usize) -> f64 {
        self.degree as f64 * f64::EPSILON * self.size(function)
    }

    /// The first node at which a function has a value.
    pub fn node_of(&self, function: usize, value: f64) -> usize {
        let stride = MOST / self.degree;
        let mut nodes = (0..=MOST).step_by(stride);
        let found = nodes.find(|&node| self.value_at(node, function) == value);
        found.unwrap_or(MOST)
    }

    /// The polynomial of a function.
    pub fn polynomial(&self, function: usize) -> Polynomial {
        let mut coefficients = [0.0; MOST + 2];
        for (k, c) in coefficients[..=self.degree].iter_mut().enumerate() {
            *c = self.coefficient(k, function);
        }
        Polynomial {
            coefficients,
            degree: self.degree,
        }
    }

    /// The integral of a function over its window of length 1: ∫ Tₖ dx = 2/(1 − k²) for even k.
    pub fn whole_integral(&self, function: usize) -> f64 {
        let even = (0..=self.degree / 2).rev().map(|half| 2 * half);
        let term = |k: usize| self.coefficient(k, function) / (1.0 - (k * k) as f64);
        even.map(term).sum()
    }

    /// Whether a function has one sign throughout.
    pub fn keeps_sign(&self, function: usize) -> bool {
        let [highest, lowest] = self.range(function);
        let room = self.overshoot(function) + self.error(function);
        lowest - room > 0.0 || highest + room < 0.0
    }

    /// Whether a function has values of both signs at the nodes.
    pub fn changes_sign(&self, function: usize) -> bool {
        let [highest, lowest] = self.range(function);
        lowest < 0.0 && highest > 0.0
    }

    /// Gives the places between nodes at which the polynomial of a function changes its sign, as the nodes tell.
    pub fn sign_changes(&self, function: usize, found: &mut impl FnMut(f64)) {
        let polynomial = self.polynomial(function);
        let point = |node: usize| (point(node), self.value_at(node, function));
        let stride = MOST / self.degree;
        for node in (stride..=MOST).step_by(stride) {
            let (left, right) = (point(node - stride), point(node));
            if left.1 > 0.0 && right.1 < 0.0 {
                found(polynomial.crossing(left, right, f64::EPSILON));
            } else if left.1 < 0.0 && right.1 > 0.0 {
                let flipped = |point: (f64, f64)| (point.0, -point.1);
                found(
                    polynomial
                        .times(-1.0)
                        .crossing(flipped(left), flipped(right), f64::EPSILON),
                );
            } else if right.1 == 0.0 {
                found(right.0);
            }
        }
    }

    /// Where the polynomial of a function times `sign` is largest, if that is more than `best` and between two
    /// nodes. Of crests that are closer to each other than a thousandth of the window some may be left out.
    pub fn summit(&self, function: usize, sign: f64, best: f64) -> Option<f64> {
        let room = self.overshoot(function);
        let value = |node: usize| sign * self.value_at(node, function);
        let stride = MOST / self.degree;
        let mut search: Option<SummitSearch> = None;
        for node in (stride..=MOST).step_by(stride) {
            let most = value(node - stride).max(value(node)) + room;
            let best = search.as_ref().map_or(best, |search| search.best);
            // A bound that is not a number tells nothing.
            if most.is_nan() || most <= best {
                continue;
            }
            let search = search.get_or_insert_with(|| {
                let of = self.polynomial(function).times(sign);
                let least = self.rounding(function).max(self.error(function));
                SummitSearch::new(of, least, best)
            });
            search.climb([node - stride, node], PI / self.degree as f64);
        }
        search.and_then(|search| search.summit)
    }
}

/// Σ cₖ Tₖ(2s − 1).
#[derive(Debug, Clone, Copy)]
pub struct Polynomial {
    coefficients: [f64; MOST + 2],
    degree: usize,
}

impl Polynomial {
    /// Value at s, by Clenshaw's recurrence.
    #[inline]
    pub fn value(&self, s: f64) -> f64 {
        let twice_x = 2.0 * (2.0 * s - 1.0);
        let (mut b1, mut b2) = (0.0, 0.0);
        for &c in self.coefficients[1..=self.degree].iter().rev() {
            (b1, b2) = (c + twice_x * b1 - b2, b1);
        }
        self.coefficients[0] + 0.5 * twice_x * b1 - b2
    }

    /// Σ kⁿ|cₖ|: a bound of the nth derivative with respect to φ.
    pub fn bound_of_derivative(&self, n: i32) -> f64 {
        let coefficients = self.coefficients[..=self.degree].iter().enumerate();
        coefficients
            .map(|(k, c)| (k as f64).powi(n) * c.abs())
            .sum()
    }

    fn times(mut self, factor: f64) -> Polynomial {
        self.coefficients.iter_mut().for_each(|c| *c *= factor);
        self
    }

    /// Half of the derivative with respect to s.
    pub fn derivative(&self) -> Polynomial {
        let mut derivative = [0.0; MOST + 2];
        // d_(k−1) = d_(k+1) + 2k cₖ, and half of that for d₀.
        for k in (1..=self.degree).rev() {
            let above = if k < MOST + 1 { derivative[k + 1] } else { 0.0 };
            derivative[k - 1] = above + (2 * k) as f64 * self.coefficients[k];
        }
        derivative[0] *= 0.5;
        Polynomial {
            coefficients: derivative,
            degree: self.degree.max(1) - 1,
        }
    }

    /// The integral from 0 to s times `length`.
    pub fn integral(&self, length: f64) -> Polynomial {
        let mut integral = [0.0; MOST + 2];
        let c = |k: usize| self.coefficients.get(k).copied().unwrap_or(0.0);
        for (k, b) in integral
            .iter_mut()
            .enumerate()
            .skip(1)
            .take(self.degree + 1)
        {
            let below = if k == 1 { 2.0 * c(0) } else { c(k - 1) };
            // dx = 2 ds.
            *b = 0.5 * length * (below - c(k + 1)) / (2 * k) as f64;
        }
        let mut integral = Polynomial {
            coefficients: integral,
            degree: self.degree + 1,
        };
        integral.coefficients[0] = -integral.value(0.0);
        integral
    }

    /// Where it falls through zero between a place where it is positive and one where it is negative, by the
    /// method of false position (Illinois): until places are `close`.
    pub fn crossing(&self, mut left: (f64, f64), mut right: (f64, f64), close: f64) -> f64 {
        let (mut last, mut before) = (0, f64::INFINITY);
        loop {
            let place = left.0 + (right.0 - left.0) * (left.1 / (left.1 - right.1));
            if !(left.0 < place && place < right.0) {
                return if left.1 < -right.1 { left.0 } else { right.0 };
            }
            let value = self.value(place);
            if value == 0.0 || (place - before).abs() <= close {
                return place;
            }
            before = place;
            // An end that stays twice counts half, so that it does not stay for ever.
            if value > 0.0 {
                left = (place, value);
                right.1 *= if last == 1 { 0.5 } else { 1.0 };
                last = 1;
            } else {
                right = (place, value);
                left.1 *= if last == -1 { 0.5 } else { 1.0 };
                last = -1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Interpolants of some functions on [0, 1].
    fn of<const K: usize>(degree: usize, functions: [fn(f64) -> f64; K]) -> Interpolants {
        let mut interpolants = Interpolants::new(K);
        interpolants.set_count(K);
        for node in (0..=MOST).step_by(MOST / degree) {
            let values = interpolants.values_mut(node);
            for (value, f) in values.iter_mut().zip(functions) {
                *value = f(point(node));
            }
        }
        interpolants.fit(degree);
        interpolants
    }

    #[test]
    fn functions_side_by_side_and_their_integrals_are_reproduced() {
        let functions: [fn(f64) -> f64; 6] = [
            |s| s,
            |s| (2.0 * s).cos(),
            |_| 3.0,
            |s| (3.0 * s).exp(),
            |s| 1.0 / (4.0 - s),
            |s| s.powi(7) - s.powi(2),
        ];
        let integrals: [fn(f64) -> f64; 6] = [
            |s| s * s / 2.0,
            |s| (2.0 * s).sin() / 2.0,
            |s| 3.0 * s,
            |s| (3.0 * s).exp_m1() / 3.0,
            |s| (4.0 / (4.0 - s)).ln(),
            |s| s.powi(8) / 8.0 - s.powi(3) / 3.0,
        ];
        for degree in DEGREES {
            let interpolants = of(degree, functions);
            for (i, (f, integral)) in functions.iter().zip(integrals).enumerate() {
                let (p, error) = (interpolants.polynomial(i), interpolants.error(i));
                let w = p.integral(2.0);
                for k in 0..=100 {
                    let s = f64::from(k) / 100.0;
                    let rounding = 1e-14 * interpolants.size(i);
                    assert!(
                        (p.value(s) - f(s)).abs() <= error + rounding,
                        "{degree} {i} {s}"
                    );
                    let difference = (w.value(s) - 2.0 * integral(s)).abs();
                    assert!(difference <= error + rounding, "{degree} {i} {s}");
                }
                assert!(
                    error < 1e-2 && (degree == 8 || error < 1e-10),
                    "{degree} {i} {error}"
                );
            }
        }
    }

    #[test]
    fn a_summit_is_found_wherever_it_is_between_nodes() {
        // Two crests, of which the second is higher by a little, and shelves.
        let functions: [fn(f64) -> f64; 4] = [
            |s| (4.0 * PI * s - 0.3).sin() + 1e-3 * s,
            |s| -((s - 0.37) * (s - 0.37)),
            |s| s * (s - 0.05) * (s - 0.05) - 0.9 * s,
            |s| s,
        ];
        let interpolants = of(MOST, functions);
        for (i, f) in functions.iter().enumerate() {
            for sign in [1.0, -1.0] {
                let [highest, lowest] = interpolants.range(i);
                let nodes = if sign > 0.0 { highest } else { -lowest };
                let found = interpolants.summit(i, sign, nodes);
                let best = found.map_or(nodes, |s| sign * f(s));
                let samples = (0..=100_000).map(|k| sign * f(f64::from(k) * 1e-5));
                let most = samples.fold(f64::NEG_INFINITY, f64::max);
                assert!(best >= most - 1e-15, "{i} {sign}: {best} {most}");
            }
        }
    }

    #[test]
    fn of_two_crests_beside_each_other_the_higher_one_is_found() {
        // Nodes are 0.15 apart here, the crests 0.01.
        let functions: [fn(f64) -> f64; 3] = [
            |s| {
                let u = s - 0.41;
                1e-6 * u - (u * u - 2.5e-5) * (u * u - 2.5e-5)
            },
            |s| {
                let u = s - 0.41;
                -1e-6 * u - (u * u - 2.5e-5) * (u * u - 2.5e-5)
            },
            // A crest that is flat to the fourth order.
            |s| -(s - 0.41).powi(4),
        ];
        let interpolants = of(8, functions);
        for (i, f) in functions.iter().enumerate() {
            let [highest, _] = interpolants.range(i);
            let found = interpolants.summit(i, 1.0, highest).unwrap();
            let samples = (0..=100_000).map(|k| f(0.4 + f64::from(k) * 2e-7));
            let most = samples.fold(f64::NEG_INFINITY, f64::max);
            assert!(f(found) >= most - 1e-15, "{i}: {found} {} {most}", f(found));
        }
    }

    #[test]
    fn nothing_between_nodes_exceeds_the_bound() {
        let interpolants = of(8, [|s| (5.0 * s).sin()]);
        let p = interpolants.polynomial(0);
        let [highest, _] = interpolants.range(0);
        let most = highest + interpolants.overshoot(0);
        assert!((0..=1000).all(|k| p.value(f64::from(k) * 1e-3) <= most));
        assert!(most < highest + 0.5, "{most} {highest}");
    }
}
