//! Confidence by the profile of the likelihood: the values of a parameter for which the other can be chosen so that the
//! likelihood is not much below its largest.

use std::f64::consts::LN_2;

use super::Fit;
use super::likelihood::Likelihood;

/// Half of the 95 % quantile of χ² with one degree of freedom: what ln of the likelihood may fall by.
const FALL: f64 = 0.5 * 3.841_458_820_694_126;

/// The fit at the maximum (a, b). `share`: the share of failures in all counts; none where there are capacities.
pub(super) fn fit(likelihood: &Likelihood, [a, b]: [f64; 2], share: Option<(f64, f64)>) -> Fit {
    let largest = likelihood.value([a, b]);
    let least = largest - FALL;
    let beta = 1.0 / b;
    let middle = -a / b;
    // Lines b = const and a + b u = 0 in the plane of (a, b).
    let of_slope = |b: f64| {
        let a = likelihood.maximum_along([0.0, b], [1.0, 0.0], a);
        likelihood.value([a, b])
    };
    let of_median = |u: f64| {
        let along = |t: f64| [-u * t, t];
        // Slopes that fall are no fragility: where they would be best, none at all is.
        let t = likelihood.maximum_along([0.0, 0.0], [-u, 1.0], b).max(0.0);
        likelihood.value(along(t))
    };
    // As the median goes to infinity or zero the slope goes to none: the same probability at every intensity, on one side of
    // a half. The profile ends there, and if that is likely enough, there is no limit. Capacities always have a slope.
    let even = |p: f64| share.map(|(n, k)| constant(n, k, p));
    let overall = share.map_or(0.5, |(n, k)| k / n);
    let none = |end: Option<f64>| end.is_some_and(|value| value >= least);
    let finite = |value: f64| Some(value).filter(|v| v.is_finite() && *v > 0.0);
    let median = |sign: f64, end: Option<f64>| {
        let limit = || limit(middle, sign * beta, &of_median, least);
        match none(end) {
            true => None,
            false => finite(libm::exp(limit() + likelihood.centre)),
        }
    };
    let theta_interval = [
        median(-1.0, even(overall.max(0.5))),
        median(1.0, even(overall.min(0.5))),
    ];
    // In ln b, in which every slope is positive.
    let of_logarithm = |s: f64| of_slope(libm::exp(s));
    let slope = libm::log(b);
    let narrow = finite(libm::exp(-limit(slope, 1.0, &of_logarithm, least)));
    let wide = match none(even(overall)) {
        true => None,
        false => finite(libm::exp(-limit(slope, -1.0, &of_logarithm, least))),
    };
    Fit {
        theta: libm::exp(middle + likelihood.centre),
        beta,
        beta_likely: beta,
        theta_interval,
        beta_interval: [narrow, wide],
        log_likelihood: largest,
    }
}

/// ln of the likelihood of k failures in n runs that all have the probability p.
fn constant(n: f64, k: f64, p: f64) -> f64 {
    match p == 0.5 {
        true => -n * LN_2,
        false => k * libm::log(p) + (n - k) * libm::log1p(-p),
    }
}

/// Where a function that falls on the way from `inside`, in steps that grow from `step`, is `least`; infinite if it is
/// nowhere.
fn limit(inside: f64, step: f64, f: &impl Fn(f64) -> f64, least: f64) -> f64 {
    let (mut inside, mut step) = (inside, step);
    let mut outside = inside + step;
    while f(outside) >= least {
        (inside, step) = (outside, 2.0 * step);
        outside = inside + step;
        if !outside.is_finite() {
            return outside;
        }
    }
    loop {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            return middle;
        }
        match f(middle) >= least {
            true => inside = middle,
            false => outside = middle,
        }
    }
}
