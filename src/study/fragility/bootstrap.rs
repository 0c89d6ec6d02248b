//! Confidence by the bootstrap (Efron 1979): fits to samples that are drawn, with replacement, from the units of the data.

use super::{Capacity, Data, Interval, Stripe, fractile, median_and_dispersion};
use crate::study::sampling::Random;

/// What data consist of, to be drawn as a whole.
#[derive(Debug, Clone, PartialEq)]
pub enum Units {
    /// The intensities of stripes, and of each unit its runs: which stripe each belongs to, and whether it failed. All runs of a
    /// ground motion are one unit where it is run at several intensities, since their results depend on each other.
    Runs {
        /// Of each stripe.
        intensities: Vec<f64>,
        /// Of each unit.
        units: Vec<Vec<(usize, bool)>>,
    },
    /// A capacity is a unit.
    Capacities(Vec<Capacity>),
}

/// Intervals of 95 % between percentiles of the fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bootstrap {
    /// Of the median; a limit is missing where so many samples have no fit that they may lie beyond it.
    pub theta: Interval,
    /// Of the dispersion.
    pub beta: Interval,
    /// Number of samples.
    pub samples: usize,
    /// How many of them determine no fit.
    pub unfitted: usize,
}

/// Number of samples: a percentile of 2.5 % lies among 25 of them.
const SAMPLES: usize = 1000;

/// The part of the samples beyond each limit.
const BEYOND: f64 = 0.025;

impl Units {
    /// The units of stripes of which no run belongs with one of another.
    pub fn of(data: &Data) -> Units {
        match data {
            Data::Stripes(stripes) => {
                let runs = |(i, stripe): (usize, &Stripe)| {
                    let failures = stripe.failures;
                    (0..stripe.runs).map(move |run| vec![(i, run < failures)])
                };
                Units::Runs {
                    intensities: stripes.iter().map(|s| s.intensity).collect(),
                    units: stripes.iter().enumerate().flat_map(runs).collect(),
                }
            }
            Data::Capacities(capacities) => Units::Capacities(capacities.clone()),
        }
    }

    /// All of the data.
    pub fn data(&self) -> Data {
        match self {
            Units::Runs { intensities, units } => Data::Stripes(stripes(intensities, units.iter())),
            Units::Capacities(capacities) => Data::Capacities(capacities.clone()),
        }
    }

    /// Intervals; the same seed gives the same.
    pub fn bootstrap(&self, seed: u64) -> Bootstrap {
        let mut random = Random::new(seed);
        let mut fits: [Vec<f64>; 2] = Default::default();
        let mut unfitted = 0;
        for _ in 0..SAMPLES {
            match median_and_dispersion(&self.drawn(&mut random)) {
                Some((theta, beta)) => {
                    fits[0].push(theta);
                    fits[1].push(beta);
                }
                None => unfitted += 1,
            }
        }
        let interval = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            // Where a fit is missing nobody knows on which side it would be.
            let known = unfitted as f64 <= BEYOND * SAMPLES as f64;
            [BEYOND, 1.0 - BEYOND].map(|part| known.then(|| fractile(&values, part)))
        };
        let [theta, beta] = fits.map(interval);
        Bootstrap {
            theta,
            beta,
            samples: SAMPLES,
            unfitted,
        }
    }

    /// As many units as there are, drawn from them.
    fn drawn(&self, random: &mut Random) -> Data {
        let mut draw = |count: usize| random.below(count as u64) as usize;
        match self {
            Units::Runs { intensities, units } => {
                let drawn = (0..units.len()).map(|_| &units[draw(units.len())]);
                Data::Stripes(stripes(intensities, drawn))
            }
            Units::Capacities(all) => {
                Data::Capacities((0..all.len()).map(|_| all[draw(all.len())]).collect())
            }
        }
    }
}

/// The counts of some units.
fn stripes<'u>(
    intensities: &[f64],
    units: impl Iterator<Item = &'u Vec<(usize, bool)>>,
) -> Vec<Stripe> {
    let stripe = |&intensity: &f64| Stripe {
        intensity,
        runs: 0,
        failures: 0,
    };
    let mut stripes: Vec<Stripe> = intensities.iter().map(stripe).collect();
    for &(stripe, failed) in units.flatten() {
        stripes[stripe].runs += 1;
        stripes[stripe].failures += u64::from(failed);
    }
    stripes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fragility::fit;
    use crate::study::normal;
    use crate::study::sampling::Random;

    /// Lognormal capacities of median 0.8 and dispersion 0.4.
    fn capacities(count: usize, seed: u64) -> Vec<Capacity> {
        let mut random = Random::new(seed);
        let mut draw = || {
            let p = ((random.bits() >> 12) as f64 + 0.5) / 2f64.powi(52);
            let intensity = 0.8 * (0.4 * normal::quantile(p)).exp();
            Capacity {
                intensity,
                censored: false,
            }
        };
        (0..count).map(|_| draw()).collect()
    }

    #[test]
    fn intervals_are_those_of_theory_for_many_capacities() {
        // Of n lognormal capacities the median has the standard error β/√n in its logarithm, the dispersion β/√(2n).
        let n = 400.0_f64;
        let all = capacities(400, 3);
        let fitted = fit(&Data::Capacities(all.clone())).unwrap();
        let bootstrap = Units::Capacities(all).bootstrap(1);
        let [low, high] = bootstrap
            .theta
            .map(|limit| (limit.unwrap() / fitted.theta).ln());
        let error = 1.96 * fitted.beta / n.sqrt();
        // A percentile of 1000 samples is known to some percent of the interval.
        assert!((high / error - 1.0).abs() < 0.15 && (low / error + 1.0).abs() < 0.15);
        let [low, high] = bootstrap
            .beta
            .map(|limit| limit.unwrap() / fitted.beta - 1.0);
        let error = 1.96 / (2.0 * n).sqrt();
        assert!((high / error - 1.0).abs() < 0.2 && (low / error + 1.0).abs() < 0.2);
        assert_eq!(bootstrap.unfitted, 0);
    }

    #[test]
    fn runs_that_belong_together_are_drawn_together() {
        // Ten motions at two intensities: five fail at both, five at none. Drawn as units the median is less certain than if
        // each run stood alone.
        let intensities = vec![0.5, 1.0];
        let joint = |i: usize| vec![(0, i < 3), (1, i < 7)];
        let joint: Vec<_> = (0..10).map(joint).collect();
        let alone: Vec<_> = joint.iter().flatten().map(|run| vec![*run]).collect();
        let width = |units: Vec<Vec<(usize, bool)>>| {
            let units = Units::Runs {
                intensities: intensities.clone(),
                units,
            };
            let data = units.data();
            assert_eq!(
                fit(&data).unwrap().beta.to_bits(),
                fit(&Units::of(&data).data()).unwrap().beta.to_bits()
            );
            units.bootstrap(5)
        };
        let (joint, alone) = (width(joint), width(alone));
        // Without a fall from the one to the other there is always a slope: joint samples fall less often.
        assert!(joint.unfitted < alone.unfitted, "{joint:?} {alone:?}");
    }

    #[test]
    fn too_many_samples_without_a_fit_leave_no_interval() {
        let stripes =
            [(0.5, 4, 0), (1.0, 4, 1), (2.0, 4, 4)].map(|(intensity, runs, failures)| Stripe {
                intensity,
                runs,
                failures,
            });
        let bootstrap = Units::of(&Data::Stripes(stripes.to_vec())).bootstrap(1);
        assert!(bootstrap.unfitted > 100);
        assert_eq!((bootstrap.theta, bootstrap.beta), ([None; 2], [None; 2]));
    }
}
