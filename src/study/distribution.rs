//! Distributions of random variables, by their quantiles.

use super::fragility::fractile;
use super::normal;

/// The distribution of a number.
#[derive(Debug, Clone, PartialEq)]
pub enum Distribution {
    /// Equally likely between two values.
    Uniform {
        from: f64,
        to: f64,
    },
    Normal {
        mean: f64,
        sd: f64,
    },
    /// The logarithm is normal, with standard deviation `beta`.
    Lognormal {
        median: f64,
        beta: f64,
    },
    /// A density that rises linearly up to `mode` and falls linearly to `to`.
    Triangular {
        from: f64,
        mode: f64,
        to: f64,
    },
    /// One of as many values as there are sums of shares, by its index; the last sum is 1.
    Discrete {
        sums: Vec<f64>,
    },
    /// A sorted sample, between whose values the quantile is linear.
    Empirical {
        sorted: Vec<f64>,
    },
    /// Another distribution of which only values above and below some occur: the probabilities that it has of values up to
    /// these, and of values beyond them.
    Truncated {
        of: Box<Distribution>,
        lower: [f64; 2],
        upper: [f64; 2],
    },
}

impl Distribution {
    /// Another distribution with values between two alone, either of which may be infinite. `None` if there are next to none.
    pub fn truncated(self, above: f64, below: f64) -> Option<Distribution> {
        let [lower, upper] = [above, below].map(|x| [self.up_to(x), self.beyond(x)]);
        // The probability of what is left, from whichever end has the digits.
        let left = match lower[0] < 0.5 {
            true => upper[0] - lower[0],
            false => lower[1] - upper[1],
        };
        (above < below && left > f64::MIN_POSITIVE).then(|| Distribution::Truncated {
            of: Box::new(self),
            lower,
            upper,
        })
    }

    /// The probability of values up to x.
    fn up_to(&self, x: f64) -> f64 {
        match self {
            Distribution::Uniform { from, to } => ((x - from) / (to - from)).clamp(0.0, 1.0),
            Distribution::Normal { mean, sd } => normal::probability((x - mean) / sd),
            Distribution::Lognormal { median, beta } => match x > 0.0 {
                true => normal::probability(libm::log(x / median) / beta),
                false => 0.0,
            },
            Distribution::Triangular { from, mode, to } => {
                let width = to - from;
                if x <= *from {
                    0.0
                } else if x < *mode {
                    (x - from) * (x - from) / (width * (mode - from))
                } else if x < *to {
                    1.0 - (to - x) * (to - x) / (width * (to - mode))
                } else {
                    1.0
                }
            }
            Distribution::Discrete { .. }
            | Distribution::Empirical { .. }
            | Distribution::Truncated { .. } => {
                unreachable!("these are not truncated")
            }
        }
    }

    /// The probability of values beyond x, with all its digits where it is small.
    fn beyond(&self, x: f64) -> f64 {
        match self {
            Distribution::Normal { mean, sd } => normal::probability((mean - x) / sd),
            Distribution::Lognormal { median, beta } if x > 0.0 => {
                normal::probability(libm::log(median / x) / beta)
            }
            _ => 1.0 - self.up_to(x),
        }
    }

    /// The value that a part p of all values is below and a part q = 1 − p beyond: of the smaller of both the digits count. Of
    /// a discrete distribution the index of the value.
    pub fn quantile(&self, [p, q]: [f64; 2]) -> f64 {
        let z = || match p < q {
            true => normal::quantile(p),
            false => -normal::quantile(q),
        };
        match self {
            Distribution::Uniform { from, to } => match p < q {
                true => from + p * (to - from),
                false => to - q * (to - from),
            },
            Distribution::Normal { mean, sd } => mean + sd * z(),
            Distribution::Lognormal { median, beta } => median * libm::exp(beta * z()),
            Distribution::Triangular { from, mode, to } => {
                let width = to - from;
                match p * width < mode - from {
                    true => from + (p * width * (mode - from)).sqrt(),
                    false => to - (q * width * (to - mode)).sqrt(),
                }
            }
            Distribution::Discrete { sums } => {
                // A p below 1 may be rounded to 1.
                sums.partition_point(|sum| *sum <= p).min(sums.len() - 1) as f64
            }
            Distribution::Empirical { sorted } => fractile(sorted, p),
            Distribution::Truncated { of, lower, upper } => {
                of.quantile([q * lower[0] + p * upper[0], q * lower[1] + p * upper[1]])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantile(of: &Distribution, p: f64) -> f64 {
        of.quantile([p, 1.0 - p])
    }

    #[test]
    fn quantiles_invert_the_probability() {
        let all = [
            Distribution::Uniform {
                from: -1.0,
                to: 3.0,
            },
            Distribution::Normal { mean: 2.0, sd: 0.5 },
            Distribution::Lognormal {
                median: 0.3,
                beta: 0.6,
            },
            Distribution::Triangular {
                from: 0.0,
                mode: 0.2,
                to: 2.0,
            },
            Distribution::Triangular {
                from: 0.0,
                mode: 0.0,
                to: 2.0,
            },
        ];
        for of in all {
            for p in [1e-9, 0.01, 0.3, 0.5, 0.77, 0.999] {
                let back = of.up_to(quantile(&of, p));
                // The quantile is rounded, as a number of the size of the parameters.
                assert!((back - p).abs() < 1e-15 + 1e-12 * p, "{of:?} {p} {back}");
            }
        }
    }

    #[test]
    fn what_is_cut_off_does_not_occur_and_the_rest_keeps_its_proportions() {
        let normal = Distribution::Normal { mean: 0.0, sd: 1.0 };
        let cut = normal.clone().truncated(-1.0, 2.0).unwrap();
        let (a, b) = (normal.up_to(-1.0), normal.up_to(2.0));
        for p in [1e-12, 0.1, 0.5, 0.9, 1.0 - 1e-12] {
            let x = quantile(&cut, p);
            assert!((-1.0..=2.0).contains(&x), "{x}");
            assert!(((normal.up_to(x) - a) / (b - a) - p).abs() < 1e-15);
        }
        // Far in the upper tail, where 1 − p has no digits left: beyond 10 the excess is nearly exponential, of mean 0.0981.
        let tail = normal.clone().truncated(10.0, f64::INFINITY).unwrap();
        let median = quantile(&tail, 0.5);
        assert!(
            (normal.beyond(median) / normal.beyond(10.0) - 0.5).abs() < 1e-12,
            "{median}"
        );
        assert_eq!(normal.truncated(40.0, f64::INFINITY), None);
    }

    #[test]
    fn a_discrete_variable_takes_each_value_as_often_as_its_weight() {
        let of = Distribution::Discrete {
            sums: vec![0.25, 0.75, 1.0],
        };
        let taken = [0.0, 0.2, 0.25, 0.74, 0.75, 0.999].map(|p| quantile(&of, p));
        assert_eq!(taken, [0.0, 0.0, 1.0, 1.0, 2.0, 2.0]);
    }
}
