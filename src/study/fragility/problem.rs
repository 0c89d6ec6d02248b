//! What data cannot determine, and why.

use std::fmt::{self, Display, Formatter};

use super::{Capacity, Stripe};

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq)]
pub enum Problem {
    /// No run at an intensity above zero has a result.
    NoRuns,
    /// No run failed: the median is beyond what was tried.
    NoFailures {
        /// The largest intensity.
        intensity: f64,
        /// How many runs there are at it.
        runs: u64,
    },
    /// Every run failed: the median is below what was tried.
    AllFail {
        /// The smallest intensity.
        intensity: f64,
        /// How many runs there are at it.
        runs: u64,
    },
    /// All runs have the same intensity.
    OneIntensity {
        /// It.
        intensity: f64,
    },
    /// No run fails below an intensity, and every run fails above another one that is not smaller.
    Separated {
        /// The largest intensity at which a run did not fail.
        survived: f64,
        /// The smallest one at which a run failed.
        failed: f64,
    },
    /// The share of failures does not grow with the intensity.
    Falls {
        /// Runs and failures in all.
        share: (f64, f64),
    },
    /// A single capacity has no dispersion.
    OneCapacity {
        /// It: the median.
        intensity: f64,
    },
    /// All capacities that are known are the same, and no run survived beyond them.
    NoDispersion {
        /// The capacity: the median.
        intensity: f64,
    },
}

impl Problem {
    /// The median, where the data determine that at least.
    pub fn theta(&self) -> Option<f64> {
        match *self {
            Problem::OneCapacity { intensity } | Problem::NoDispersion { intensity } => {
                Some(intensity)
            }
            _ => None,
        }
    }
}

/// Up to which probability, with 95 % confidence, n runs of which none did have it.
fn none_of(n: u64) -> f64 {
    -libm::expm1(libm::log(0.05) / n as f64)
}

impl Display for Problem {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match *self {
            Problem::NoRuns => f.write_str(
                "no run at an intensity above zero has a result: there is nothing to fit",
            ),
            Problem::NoFailures { intensity, runs } => write!(
                f,
                "no failure was observed: median and dispersion are not determined, the likelihood grows as the median goes \
                 to infinity; at the largest intensity, {intensity}, the probability of failure is at most {:.4} with 95 % \
                 confidence ({runs} runs); run at larger intensities",
                none_of(runs)
            ),
            Problem::AllFail { intensity, runs } => write!(
                f,
                "every run failed: median and dispersion are not determined, the likelihood grows as the median goes to \
                 zero; at the smallest intensity, {intensity}, the probability of failure is at least {:.4} with 95 % \
                 confidence ({runs} runs); run at smaller intensities",
                1.0 - none_of(runs)
            ),
            Problem::OneIntensity { intensity } => write!(
                f,
                "all runs have the intensity {intensity}: median and dispersion are not determined; run at two intensities \
                 at least"
            ),
            Problem::Separated { survived, failed } if survived < failed => write!(
                f,
                "perfect separation: no run fails up to {survived} and every run from {failed}: the median is between them, \
                 and the dispersion is not determined, the likelihood grows as it goes to zero; run at intensities between \
                 {survived} and {failed}"
            ),
            Problem::Separated { failed, .. } => write!(
                f,
                "quasi-perfect separation: at {failed} some runs fail, below it none, above it all: the likelihood grows as \
                 the median goes to {failed} and the dispersion to zero, which is not determined; run at intensities near \
                 {failed}"
            ),
            Problem::Falls { share: (n, k) } => write!(
                f,
                "the share of failures does not grow with the intensity: no lognormal fragility describes it, the \
                 likelihood grows as the dispersion goes to infinity, towards the same probability {:.4} ({k} of {n}) at \
                 every intensity",
                k / n
            ),
            Problem::OneCapacity { intensity } => write!(
                f,
                "one capacity, {intensity}, is the median; the dispersion is not determined by fewer than two"
            ),
            Problem::NoDispersion { intensity } => write!(
                f,
                "all capacities are {intensity}, which is the median; the dispersion is not determined, the likelihood grows \
                 as it goes to zero"
            ),
        }
    }
}

impl std::error::Error for Problem {}

/// Runs and failures in all.
pub(super) fn share(stripes: &[Stripe]) -> (f64, f64) {
    let sum = |count: fn(&Stripe) -> u64| stripes.iter().map(count).sum::<u64>() as f64;
    (sum(|s| s.runs), sum(|s| s.failures))
}

/// Whether the likelihood has a maximum: failures and survivals overlap (Albert and Anderson 1984). All stripes have runs.
pub(super) fn of_stripes(stripes: &[Stripe]) -> Result<(), Problem> {
    let by_intensity = |a: &&Stripe, b: &&Stripe| a.intensity.total_cmp(&b.intensity);
    let Some((first, last)) = stripes
        .iter()
        .min_by(by_intensity)
        .zip(stripes.iter().max_by(by_intensity))
    else {
        return Err(Problem::NoRuns);
    };
    let at = |intensity: f64| {
        stripes
            .iter()
            .filter(|s| s.intensity == intensity)
            .map(|s| s.runs)
            .sum()
    };
    let range = |told: fn(&Stripe) -> bool| {
        let told = stripes.iter().filter(|s| told(s)).map(|s| s.intensity);
        told.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], x| {
            [least.min(x), most.max(x)]
        })
    };
    let failed = range(|s| s.failures > 0);
    let survived = range(|s| s.failures < s.runs);
    if failed[0] > failed[1] {
        let intensity = last.intensity;
        return Err(Problem::NoFailures {
            intensity,
            runs: at(intensity),
        });
    }
    if survived[0] > survived[1] {
        let intensity = first.intensity;
        return Err(Problem::AllFail {
            intensity,
            runs: at(intensity),
        });
    }
    if first.intensity == last.intensity {
        return Err(Problem::OneIntensity {
            intensity: first.intensity,
        });
    }
    if survived[1] <= failed[0] {
        return Err(Problem::Separated {
            survived: survived[1],
            failed: failed[0],
        });
    }
    if failed[1] <= survived[0] {
        return Err(Problem::Falls {
            share: share(stripes),
        });
    }
    Ok(())
}

/// Whether the likelihood of capacities has a maximum.
pub(super) fn of_capacities(capacities: &[Capacity]) -> Result<(), Problem> {
    let all = |censored: bool| {
        let of = capacities.iter().filter(move |c| c.censored == censored);
        of.map(|c| c.intensity)
    };
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let Some(known) = all(false).next() else {
        if capacities.is_empty() {
            return Err(Problem::NoRuns);
        }
        let intensity = largest(&mut all(true));
        let runs = all(true).filter(|x| *x == intensity).count() as u64;
        return Err(Problem::NoFailures { intensity, runs });
    };
    if capacities.len() == 1 {
        return Err(Problem::OneCapacity { intensity: known });
    }
    if all(false).all(|x| x == known) && largest(&mut all(true)) <= known {
        return Err(Problem::NoDispersion { intensity: known });
    }
    Ok(())
}
