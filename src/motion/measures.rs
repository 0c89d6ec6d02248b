//! Peaks, Arias intensity and significant duration of a record.

use std::f64::consts::PI;

use super::{GRAVITY, Samples};

/// A largest magnitude and its time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Peak {
    /// The value with its sign.
    pub value: f64,
    /// s.
    pub t: f64,
}

/// What is told of a record. Velocity and displacement are zero at its first sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Peak ground acceleration, m/s².
    pub pga: Peak,
    /// Peak ground velocity at samples, m/s.
    pub pgv: Peak,
    /// Peak ground displacement at samples, m.
    pub pgd: Peak,
    /// Velocity and displacement at the end, m/s and m.
    pub end: [f64; 2],
    /// Mean of the samples, m/s².
    pub mean: f64,
    /// Arias intensity π/(2 g) ∫ a² dt, m/s, with standard gravity.
    pub arias: f64,
    /// Times at which 5 and 95 % of the Arias intensity are reached, s.
    pub significant: [f64; 2],
}

impl Measures {
    /// Exact for accelerations that are linear between samples.
    pub fn of(samples: &Samples) -> Measures {
        let a = &samples.values;
        let peak = |values: &[f64]| {
            let larger = |best: usize, i: usize| {
                if values[i].abs() > values[best].abs() {
                    i
                } else {
                    best
                }
            };
            let i = (0..values.len()).fold(0, larger);
            Peak {
                value: values[i],
                t: samples.time(i),
            }
        };
        let [velocity, displacement] = samples.integrals();
        let squares = squares(samples);
        let last = a.len() - 1;
        Measures {
            pga: peak(a),
            pgv: peak(&velocity),
            pgd: peak(&displacement),
            end: [velocity[last], displacement[last]],
            mean: samples.mean(),
            arias: PI / (2.0 * GRAVITY) * squares[last],
            significant: [0.05, 0.95].map(|part| reached(samples, &squares, part * squares[last])),
        }
    }

    /// Time between 5 and 95 % of the Arias intensity, s.
    pub fn significant_duration(&self) -> f64 {
        self.significant[1] - self.significant[0]
    }
}

impl Samples {
    /// Velocity (m/s) and displacement (m) at the samples.
    pub fn integrals(&self) -> [Vec<f64>; 2] {
        let a = &self.values;
        let (mut v, mut u) = (0.0, 0.0);
        let mut rows = [vec![v], vec![u]];
        for i in 0..a.len() - 1 {
            let h = self.step(i);
            u += h * (v + h * (2.0 * a[i] + a[i + 1]) / 6.0);
            v += h * (a[i] + a[i + 1]) / 2.0;
            rows[0].push(v);
            rows[1].push(u);
        }
        rows
    }

    /// Part of the Arias intensity that is reached at each sample (Husid, 1969); zeros where there is none.
    pub fn husid(&self) -> Vec<f64> {
        let squares = squares(self);
        let whole = squares[squares.len() - 1];
        let part = |s: &f64| if whole > 0.0 { s / whole } else { 0.0 };
        squares.iter().map(part).collect()
    }
}

/// ∫ a² dt up to each sample, m²/s³.
fn squares(samples: &Samples) -> Vec<f64> {
    let a = &samples.values;
    let mut sum = 0.0;
    let mut sums = vec![sum];
    for i in 0..a.len() - 1 {
        sum += samples.step(i) * (a[i] * a[i] + a[i] * a[i + 1] + a[i + 1] * a[i + 1]) / 3.0;
        sums.push(sum);
    }
    sums
}

/// The time at which ∫ a² dt reaches a value.
fn reached(samples: &Samples, sums: &[f64], value: f64) -> f64 {
    let i = sums.partition_point(|s| *s < value);
    if i == 0 {
        return samples.time(0);
    }
    let (h, a) = (samples.step(i - 1), &samples.values[i - 1..=i]);
    // ∫ over a part x of the step; it grows with x.
    let part = |x: f64| {
        let b = a[0] + x * (a[1] - a[0]);
        sums[i - 1] + x * h * (a[0] * a[0] + a[0] * b + b * b) / 3.0
    };
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return samples.time(i - 1) + high * h;
        }
        if part(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
}
