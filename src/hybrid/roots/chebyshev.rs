//! Interpolation at Chebyshev points of a window, and the expansion it gives.

use super::extrema::{Count, Expansion};

/// Highest degree of an interpolant.
pub(super) const DEGREE: usize = 16;
/// Nodes at that degree. Those of degree 8 and 4 are every second and fourth.
pub(super) const NODES: usize = DEGREE + 1;
/// The nodes and one more place, between the middle ones, that tests the highest degree.
pub(super) const SAMPLES: usize = NODES + 1;

/// sin²(jπ/32), j = 0 to 8: the nodes' places in a window of length 1 are these and their mirror
/// images.
const HALF: [f64; 9] = [
    0.0,
    0.009607359798384776,
    0.038060233744356624,
    0.08426519384872738,
    0.14644660940672624,
    0.22221488349019888,
    0.30865828381745514,
    0.40245483899193585,
    0.5,
];

/// Abscissa of a sample in a window of length 1, exact relative to its distance from the left end.
pub(super) const fn point(node: usize) -> f64 {
    if node == NODES {
        // sin²(15π/64)
        0.4509914298352197
    } else if node <= 8 {
        HALF[node]
    } else {
        1.0 - HALF[DEGREE - node]
    }
}

/// Where a search on a window of length 1 looks first: at the samples of degree 4, and at two more of
/// those of degree 8.
pub const FIRST_POINTS: [f64; 8] = [
    point(0),
    point(DEGREE / 4),
    point(DEGREE / 2),
    point(3 * DEGREE / 4),
    point(DEGREE),
    point(Interpolant::test_sample(4)),
    point(DEGREE / 8),
    point(5 * DEGREE / 8),
];

/// cos(jπ/16).
const fn cosine(j: usize) -> f64 {
    let j = j % 32;
    // cos 2φ = 1 − 2 sin² φ
    1.0 - 2.0 * point(if j <= 16 { j } else { 32 - j })
}

const COSINES: [f64; 32] = {
    let mut cosines = [0.0; 32];
    let mut j = 0;
    while j < 32 {
        cosines[j] = cosine(j);
        j += 1;
    }
    cosines
};

/// Σ cₖ Tₖ(2s − 1) on s ∈ \[0, 1\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Chebyshev {
    coefficients: [f64; NODES],
    degree: usize,
}

/// An interpolant and how well it represents the function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interpolant {
    pub(super) expansion: Chebyshev,
    degree: usize,
    /// Sum of the coefficients' magnitudes from 1 to half the degree, and from there on.
    halves: [f64; 2],
    /// Bound of the rounding errors of interpolation and evaluation.
    rounding: f64,
    /// Largest magnitude of the function at the nodes.
    pub(super) magnitude: f64,
}

impl Interpolant {
    /// Through `values` at every `DEGREE / degree`-th node; `degree` is 4, 8 or 16.
    pub(super) fn through(values: &[f64; SAMPLES], degree: usize) -> Self {
        match degree {
            4 => Self::of_degree::<4>(values),
            8 => Self::of_degree::<8>(values),
            _ => Self::of_degree::<DEGREE>(values),
        }
    }

    fn of_degree<const N: usize>(values: &[f64; SAMPLES]) -> Self {
        let (degree, stride) = (N, DEGREE / N);
        let mut coefficients = [0.0; NODES];
        // Discrete cosine transform; the ends, and the first and last coefficient, count half.
        let [first, last] = [values[0], values[DEGREE]];
        for (k, coefficient) in coefficients[..=N].iter_mut().enumerate() {
            let end = if k % 2 == 0 { last } else { -last };
            *coefficient = 0.5 * (first + end);
        }
        for j in 1..N {
            let value = values[j * stride];
            for (k, coefficient) in coefficients[..=N].iter_mut().enumerate() {
                *coefficient += COSINES[k * j * stride % 32] * value;
            }
        }
        for (k, coefficient) in coefficients[..=N].iter_mut().enumerate() {
            // The nodes ascend, Chebyshev's own descend: Tₖ(−x) = (−1)ᵏ Tₖ(x).
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let weight = if k == 0 || k == N { 1.0 } else { 2.0 };
            *coefficient = sign * weight * *coefficient / N as f64;
        }
        let magnitude = values[..NODES]
            .iter()
            .step_by(stride)
            .fold(0.0, |m: f64, v| m.max(v.abs()));
        // Two sums, over the nodes and over the coefficients, of degree + 1 terms each: γ ≈ 2nu.
        let rounding = degree as f64 * f64::EPSILON * magnitude;
        let sum = |range: &[f64]| range.iter().map(|c| c.abs()).sum();
        let half = degree / 2;
        let halves = [
            sum(&coefficients[1..=half]),
            sum(&coefficients[half + 1..=degree]),
        ];
        // Trailing coefficients that no bit of the sum depends on only cost time.
        let largest = coefficients.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let mut used = degree;
        while used > 0 && coefficients[used].abs() <= f64::EPSILON * largest {
            used -= 1;
        }
        let expansion = Chebyshev {
            coefficients,
            degree: used,
        };
        Self {
            expansion,
            degree,
            halves,
            rounding,
            magnitude,
        }
    }

    /// Divides a zero of order `order` at the left end out of `values`: at the other nodes by the
    /// power of their distance, at the end itself by the interpolant through the others, which is
    /// the condition that the last coefficient is zero. Returns the quotients as well.
    pub(super) fn deflated(
        values: &[f64; SAMPLES],
        distances: &[f64; SAMPLES],
        order: usize,
        degree: usize,
    ) -> (Self, [f64; SAMPLES]) {
        let mut quotients = *values;
        for (quotient, distance) in quotients.iter_mut().zip(distances).skip(1) {
            for _ in 0..order {
                *quotient /= distance;
            }
        }
        quotients[0] = 0.0;
        let others = quotients;
        for (j, &quotient) in others[..NODES]
            .iter()
            .step_by(DEGREE / degree)
            .enumerate()
            .skip(1)
        {
            let sign = if j % 2 == 0 { -1.0 } else { 1.0 };
            quotients[0] += sign
                * if j == degree {
                    quotient
                } else {
                    2.0 * quotient
                };
        }
        let mut interpolant = Self::through(&quotients, degree);
        // The value at the end carries the errors of all the others, up to twice each.
        interpolant.rounding *= 2.0;
        (interpolant, quotients)
    }

    /// The sample that tests a degree: half-way in angle between its nodes next to the middle of
    /// the window. The error is close to a multiple of sin θ sin nθ, which is largest there.
    pub(super) const fn test_sample(degree: usize) -> usize {
        if degree == DEGREE {
            NODES
        } else {
            DEGREE / 2 - DEGREE / (2 * degree)
        }
    }

    /// Whether the function is represented as well as doubles, and a rounding error of `noise` in
    /// each value, allow: such an error enters each of the n/2 coefficients of the upper half by
    /// twice its size at most.
    pub(super) fn is_resolved(&self, noise: f64) -> bool {
        self.halves[1] <= self.degree as f64 * noise + self.rounding
    }

    /// Whether the coefficients decay fast enough to judge the function by.
    ///
    /// If the sums of the halves shrink by a ratio r from each to the next, what follows sums to
    /// r/(1 − r) of the upper half; it acts twice, as truncated and as aliased. That is no more
    /// than the upper half for r ≤ 1/3. The two coefficients of each half at degree 4 may do so by
    /// chance: there the upper half must vanish.
    pub(super) fn decays(&self) -> bool {
        let [lower, upper] = self.halves;
        self.degree > 4 && 3.0 * upper <= lower || upper <= self.rounding
    }

    /// What the interpolant may differ from the function: the upper half of the coefficients if
    /// they decay; otherwise only the size of the variation is known.
    pub(super) fn error(&self) -> f64 {
        let [lower, upper] = self.halves;
        self.rounding + if self.decays() { upper } else { lower + upper }
    }

    /// Whether the sample that tests the degree differs by no more than the error that the decay
    /// foretells, 2r/(1 − r) of the upper half, and errors of `noise` in each value explain. Where the
    /// coefficients do not decay the error is not foretold, and the sample must leave room: a quarter of
    /// what [`error`](Self::error) says, since by chance it is near a zero of the error.
    pub(super) fn agrees(&self, values: &[f64; SAMPLES], noise: f64) -> bool {
        let [lower, upper] = self.halves;
        let foretold = if self.decays() && upper < lower {
            2.0 * upper * upper / (lower - upper)
        } else {
            0.25 * (lower + upper)
        };
        let sample = Self::test_sample(self.degree);
        let difference = self.expansion.value(point(sample)) - values[sample];
        difference.abs() <= foretold + self.degree as f64 * noise + self.rounding
    }
}

impl Chebyshev {
    fn sum_beyond_constant(&self) -> f64 {
        self.coefficients[1..=self.degree]
            .iter()
            .map(|c| c.abs())
            .sum()
    }

    /// Bounds of the value on the window, from the coefficients alone.
    pub(super) fn bounds(&self) -> (f64, f64) {
        let rest = self.sum_beyond_constant();
        (self.coefficients[0] - rest, self.coefficients[0] + rest)
    }

    /// A bound of its slope on the window: that of Tₖ(2s − 1) is 2k² at most.
    pub(super) fn steepest(&self) -> f64 {
        let slope = |(k, c): (usize, &f64)| 2.0 * (k * k) as f64 * c.abs();
        let coefficients = self.coefficients[..=self.degree].iter();
        coefficients.enumerate().map(slope).sum()
    }
}

impl Expansion for Chebyshev {
    /// Clenshaw's recurrence.
    fn value(&self, s: f64) -> f64 {
        let twice_x = 2.0 * (2.0 * s - 1.0);
        let (mut b1, mut b2) = (0.0, 0.0);
        for &c in self.coefficients[1..=self.degree].iter().rev() {
            (b1, b2) = (c + twice_x * b1 - b2, b1);
        }
        self.coefficients[0] + 0.5 * twice_x * b1 - b2
    }

    fn derivative(&self) -> Self {
        let mut derivative = Self {
            coefficients: [0.0; NODES],
            degree: self.degree.saturating_sub(1),
        };
        // d_(k−1) = d_(k+1) + 2k cₖ, and half of that for d₀.
        for k in (1..=self.degree).rev() {
            let above = derivative.coefficients.get(k + 1).copied().unwrap_or(0.0);
            derivative.coefficients[k - 1] = above + (2 * k) as f64 * self.coefficients[k];
        }
        derivative.coefficients[0] *= 0.5;
        derivative
    }

    fn count(&self) -> Count {
        let (constant, rest) = (self.coefficients[0].abs(), self.sum_beyond_constant());
        if self.degree == 0 || constant > rest {
            Count::None
        } else if self.degree == 1 && constant < rest {
            Count::One
        } else {
            Count::Unknown
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_analytic_function_is_reproduced_with_its_derivative() {
        let f = |s: f64| (2.0 * s).exp() * (3.0 * s).cos();
        let values = std::array::from_fn(|j| f(point(j)));
        let interpolant = Interpolant::through(&values, DEGREE);
        let slope = interpolant.expansion.derivative();
        for k in 0..=100 {
            let s = f64::from(k) / 100.0;
            assert!((interpolant.expansion.value(s) - f(s)).abs() <= interpolant.error());
            let exact = (2.0 * s).exp() * (2.0 * (3.0 * s).cos() - 3.0 * (3.0 * s).sin());
            // d/ds is twice d/dx, and the derivative is a multiple: here one half.
            assert!((2.0 * slope.value(s) - exact).abs() <= 1e-11, "{s}");
        }
        assert!(interpolant.error() < 1e-5 && !interpolant.is_resolved(0.0));
    }

    #[test]
    fn a_zero_of_order_three_is_divided_out() {
        let distances = std::array::from_fn(point);
        let values = distances.map(|s| s * s * s * (1e-6 - s));
        for degree in [8, 16] {
            let (interpolant, _) = Interpolant::deflated(&values, &distances, 3, degree);
            for s in [0.0, 1e-6, 0.3, 1.0] {
                assert!((interpolant.expansion.value(s) - (1e-6 - s)).abs() <= interpolant.error());
            }
            assert!(interpolant.error() < 1e-13);
        }
    }
}
