//! The likelihood of what was observed under a lognormal fragility, and where it is largest.
//!
//! With a = −ln θ/β and b = 1/β the probability of failure is Φ(a + b ln x), and the logarithm of the likelihood is concave
//! in (a, b) for counts (Pratt 1981) as for capacities, censored ones too (Olsen 1978). So Newton's method with shorter
//! steps where a step is too long finds its only maximum, and sets of likely (a, b) are convex.

use crate::study::normal::{hazard, ln_density, ln_probability};

/// What was observed at an intensity; u is its logarithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Observation {
    /// Of n runs k failed.
    Count { u: f64, n: f64, k: f64 },
    /// A run failed at this intensity and not below it.
    Capacity { u: f64 },
    /// A run failed nowhere up to this intensity.
    Beyond { u: f64 },
}

/// A value with its derivatives by (a, b), or along a line by its coordinate.
#[derive(Debug, Clone, Copy, Default)]
struct Expansion {
    value: f64,
    gradient: [f64; 2],
    /// The second derivatives by aa, ab and bb.
    curvature: [f64; 3],
}

/// The observations, with logarithms of intensities counted from `centre`.
#[derive(Debug)]
pub(super) struct Likelihood {
    observations: Vec<Observation>,
    pub centre: f64,
}

impl Likelihood {
    pub fn new(observations: Vec<Observation>) -> Self {
        let logarithm = |o: &Observation| match *o {
            Observation::Count { u, .. }
            | Observation::Capacity { u }
            | Observation::Beyond { u } => u,
        };
        let centre = observations.iter().map(logarithm).sum::<f64>() / observations.len() as f64;
        Likelihood {
            observations,
            centre,
        }
    }

    fn at(&self, [a, b]: [f64; 2]) -> Expansion {
        let mut sum = Expansion::default();
        for observation in &self.observations {
            let (u, value, slope, bend) = match *observation {
                Observation::Count { u, n, k } => {
                    let u = u - self.centre;
                    let (value, slope, bend) = count(a + b * u, n, k);
                    (u, value, slope, bend)
                }
                Observation::Beyond { u } => {
                    let u = u - self.centre;
                    let (value, slope, bend) = count(a + b * u, 1.0, 0.0);
                    (u, value, slope, bend)
                }
                Observation::Capacity { u } => {
                    let v = u - self.centre;
                    let z = a + b * v;
                    // The density of x is φ(z) b/x.
                    sum.gradient[1] += 1.0 / b;
                    sum.curvature[2] -= 1.0 / (b * b);
                    (v, ln_density(z) + libm::log(b) - u, -z, -1.0)
                }
            };
            sum.value += value;
            sum.gradient[0] += slope;
            sum.gradient[1] += slope * u;
            sum.curvature[0] += bend;
            sum.curvature[1] += bend * u;
            sum.curvature[2] += bend * u * u;
        }
        sum
    }

    /// Its logarithm, without the binomial coefficients.
    pub fn value(&self, point: [f64; 2]) -> f64 {
        // NaN below b = 0, where capacities have no density.
        self.at(point).value
    }

    /// The (a, b) at which it is largest: there is one.
    pub fn maximum(&self, start: [f64; 2]) -> [f64; 2] {
        climb(
            start,
            |p| self.at(p),
            |p, step, t| [p[0] + t * step[0], p[1] + t * step[1]],
        )
    }

    /// Where it is largest along a line, by the line's coordinate.
    pub fn maximum_along(&self, origin: [f64; 2], direction: [f64; 2], start: f64) -> f64 {
        let point = |t: f64| [origin[0] + t * direction[0], origin[1] + t * direction[1]];
        let along = |[t, _]: [f64; 2]| {
            let e = self.at(point(t));
            let [da, db] = direction;
            let [aa, ab, bb] = e.curvature;
            Expansion {
                value: e.value,
                gradient: [e.gradient[0] * da + e.gradient[1] * db, 0.0],
                curvature: [aa * da * da + 2.0 * ab * da * db + bb * db * db, 0.0, -1.0],
            }
        };
        climb([start, 0.0], along, |p, step, t| [p[0] + t * step[0], 0.0])[0]
    }
}

/// ln of the probability of k failures in n, each with the probability Φ(z), and its derivatives by z.
fn count(z: f64, n: f64, k: f64) -> (f64, f64, f64) {
    let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
    // Terms that do not occur are left out: 0 times an infinity is none.
    if k > 0.0 {
        let h = hazard(z);
        value += k * ln_probability(z);
        slope += k * h;
        bend -= k * h * (z + h);
    }
    if k < n {
        let h = hazard(-z);
        value += (n - k) * ln_probability(-z);
        slope -= (n - k) * h;
        bend -= (n - k) * h * (h - z);
    }
    (value, slope, bend)
}

/// Newton's method towards the maximum of a concave function.
fn climb(
    start: [f64; 2],
    f: impl Fn([f64; 2]) -> Expansion,
    moved: impl Fn([f64; 2], [f64; 2], f64) -> [f64; 2],
) -> [f64; 2] {
    let mut p = start;
    let mut here = f(p);
    let mut gain = f64::INFINITY;
    loop {
        let [ga, gb] = here.gradient;
        let [aa, ab, bb] = here.curvature;
        let determinant = aa * bb - ab * ab;
        let step = [
            (ab * gb - bb * ga) / determinant,
            (ab * ga - aa * gb) / determinant,
        ];
        // What the quadratic model gains, twice. Near the maximum it falls quadratically until it is nothing but rounding.
        let expected = ga * step[0] + gb * step[1];
        // Below a millionth a step is right to its square; a likelihood of many runs has no digits left to judge it by.
        let is_near = expected < 1e-6;
        if is_near && expected >= gain || expected.is_nan() || expected <= 0.0 {
            return p;
        }
        gain = if is_near { expected } else { f64::INFINITY };
        let mut length = 1.0;
        let next = loop {
            let point = moved(p, step, length);
            let there = f(point);
            // A quarter of the gain that the slope promises (Armijo); rounding hides it near the maximum, where a step is right.
            if is_near || there.value >= here.value + 0.25 * length * expected {
                break Some((point, there));
            }
            length *= 0.5;
            if moved(p, step, length) == p {
                break None;
            }
        };
        match next {
            Some((point, there)) if point != p => (p, here) = (point, there),
            _ => return p,
        }
    }
}
