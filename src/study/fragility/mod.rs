//! Fragility curves: the lognormal probability of failure Φ(ln(x/θ)/β) at an intensity x, by maximum likelihood.

mod bootstrap;
mod likelihood;
mod limits;
mod problem;
mod table;

pub use bootstrap::{Bootstrap, Units};
pub use problem::Problem;
pub use table::Table;

use likelihood::{Likelihood, Observation};

/// Runs at one intensity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stripe {
    /// The intensity, in any unit.
    pub intensity: f64,
    /// How many runs have a result.
    pub runs: u64,
    /// How many of them failed.
    pub failures: u64,
}

/// The intensity at which a run fails first, or up to which it does not fail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capacity {
    /// The intensity, in any unit.
    pub intensity: f64,
    /// Whether the run did not fail: its capacity is beyond the intensity.
    pub censored: bool,
}

/// What a fragility is fitted to.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// Failures among runs at given intensities.
    Stripes(Vec<Stripe>),
    /// Capacities, as of incremental dynamic analysis.
    Capacities(Vec<Capacity>),
}

/// Between which values a parameter is with 95 % confidence; `None` where there is no limit.
pub type Interval = [Option<f64>; 2];

/// A lognormal fragility.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// The median: the intensity at which half fail.
    pub theta: f64,
    /// The standard deviation of the logarithm of capacities. Of capacities without censored ones it is that of the sample
    /// (with n − 1: Baker 2015, equation 4).
    pub beta: f64,
    /// The standard deviation at which the likelihood is largest; of stripes and censored capacities the same as `beta`.
    pub beta_likely: f64,
    /// Of the median, by the profile of the likelihood.
    pub theta_interval: Interval,
    /// Of the standard deviation, by the profile of the likelihood.
    pub beta_interval: Interval,
    /// ln of the likelihood where it is largest, without binomial coefficients.
    pub log_likelihood: f64,
}

impl Fit {
    /// The probability of failure at an intensity of at least 0.
    pub fn probability(&self, intensity: f64) -> f64 {
        super::normal::probability(libm::log(intensity / self.theta) / self.beta)
    }
}

/// Fits a lognormal fragility, or says why the data do not determine one.
///
/// A stripe without runs says nothing; neither does one at the intensity 0 without failures, where no lognormal fragility
/// has any.
///
/// # Panics
/// For intensities that are negative or not finite, or zero with a failure; for more failures than runs.
pub fn fit(data: &Data) -> Result<Fit, Problem> {
    match data {
        Data::Stripes(stripes) => stripes_fit(stripes),
        Data::Capacities(capacities) => capacities_fit(capacities),
    }
}

fn stripes_fit(stripes: &[Stripe]) -> Result<Fit, Problem> {
    let (likelihood, point, share) = stripes_maximum(stripes)?;
    Ok(limits::fit(&likelihood, point, Some(share)))
}

/// A likelihood, where it is largest, and how many runs and failures there are in all.
type Maximum = (Likelihood, [f64; 2], (f64, f64));

fn stripes_maximum(stripes: &[Stripe]) -> Result<Maximum, Problem> {
    for stripe in stripes {
        let Stripe {
            intensity,
            runs,
            failures,
        } = *stripe;
        assert!(intensity >= 0.0 && intensity.is_finite(), "an intensity");
        assert!(failures <= runs, "no more failures than runs");
        assert!(intensity > 0.0 || failures == 0, "no failure at rest");
    }
    let told = |s: &&Stripe| s.runs > 0 && s.intensity > 0.0;
    let stripes: Vec<Stripe> = stripes.iter().filter(told).copied().collect();
    problem::of_stripes(&stripes)?;
    let observation = |s: &Stripe| Observation::Count {
        u: libm::log(s.intensity),
        n: s.runs as f64,
        k: s.failures as f64,
    };
    let likelihood = Likelihood::new(stripes.iter().map(observation).collect());
    // No slope at all is no bad beginning: the function is concave.
    let (a, b) = (0.0, 0.0);
    let [a, b] = likelihood.maximum([a, b]);
    let share = problem::share(&stripes);
    match b <= 0.0 {
        true => Err(Problem::Falls { share }),
        false => Ok((likelihood, [a, b], share)),
    }
}

fn capacities_fit(capacities: &[Capacity]) -> Result<Fit, Problem> {
    let (likelihood, point) = capacities_maximum(capacities)?;
    let mut fit = limits::fit(&likelihood, point, None);
    if capacities.iter().all(|c| !c.censored) {
        // Both are known in closed form.
        (fit.theta, fit.beta) = known(capacities);
    }
    Ok(fit)
}

/// Median and dispersion of capacities that are all known.
fn known(capacities: &[Capacity]) -> (f64, f64) {
    let logarithms: Vec<f64> = capacities.iter().map(|c| libm::log(c.intensity)).collect();
    let (mean, deviation) = moments(&logarithms);
    (libm::exp(mean), deviation)
}

/// The likelihood of capacities, and where it is largest.
fn capacities_maximum(capacities: &[Capacity]) -> Result<(Likelihood, [f64; 2]), Problem> {
    for capacity in capacities {
        let positive = capacity.intensity > 0.0 && capacity.intensity.is_finite();
        assert!(positive, "a capacity is positive");
    }
    problem::of_capacities(capacities)?;
    let observation = |c: &Capacity| {
        let u = libm::log(c.intensity);
        match c.censored {
            true => Observation::Beyond { u },
            false => Observation::Capacity { u },
        }
    };
    let observations: Vec<_> = capacities.iter().map(observation).collect();
    let logarithms: Vec<f64> = capacities.iter().map(|c| libm::log(c.intensity)).collect();
    let (mean, deviation) = moments(&logarithms);
    let likelihood = Likelihood::new(observations);
    let b = 1.0 / deviation;
    let point = likelihood.maximum([-(mean - likelihood.centre) * b, b]);
    Ok((likelihood, point))
}

/// Median and dispersion alone, without intervals; `None` where the data do not determine them.
fn median_and_dispersion(data: &Data) -> Option<(f64, f64)> {
    let (likelihood, [a, b]) = match data {
        Data::Stripes(stripes) => {
            let (likelihood, point, _) = stripes_maximum(stripes).ok()?;
            (likelihood, point)
        }
        Data::Capacities(capacities) => {
            let maximum = capacities_maximum(capacities).ok()?;
            if capacities.iter().all(|c| !c.censored) {
                return Some(known(capacities));
            }
            maximum
        }
    };
    Some((libm::exp(-a / b + likelihood.centre), 1.0 / b))
}

/// Mean and standard deviation of a sample (with n − 1).
fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (mean, (squares / (n - 1.0)).sqrt())
}

/// The value below which a part p of a sorted sample is, linear between its members (type 7 of Hyndman and Fan).
///
/// # Panics
/// For an empty sample, or a p outside [0, 1].
pub fn fractile(sorted: &[f64], p: f64) -> f64 {
    assert!((0.0..=1.0).contains(&p), "a part");
    let place = p * (sorted.len() - 1) as f64;
    let below = sorted[place as usize];
    let above = sorted[(place as usize + 1).min(sorted.len() - 1)];
    match place - place.floor() {
        // Whatever is above, be it infinite.
        0.0 => below,
        part => below + part * (above - below),
    }
}

#[cfg(test)]
mod tests;
