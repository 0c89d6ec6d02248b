//! What is done to a record before it moves the ground.

use std::f64::consts::PI;

use super::oscillator::Oscillator;
use super::{Samples, Times, ordinate};

/// How large a record is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// Every value times a factor.
    Factor(f64),
    /// The largest magnitude becomes this, m/s².
    Pga(f64),
    /// The ordinate of the spectrum of pseudo-acceleration becomes this.
    Sa {
        /// s
        period: f64,
        /// Ratio, below 1.
        damping: f64,
        /// m/s²
        value: f64,
    },
}

/// Corrections without which velocity and displacement drift.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Baseline {
    /// Degree of a polynomial that is subtracted: the one whose velocity comes nearest to that of
    /// the record, in the mean of squares.
    pub polynomial: Option<usize>,
    /// Frequency (Hz) and even order of a Butterworth high-pass filter that runs forwards and
    /// backwards, so that it shifts no phase.
    pub high_pass: Option<(f64, usize)>,
}

/// Steps of treatment, in the order in which they are done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Treatment {
    /// Only what comes after, s.
    pub from: Option<f64>,
    /// Only what comes before, s.
    pub to: Option<f64>,
    /// Whether the mean of the samples is subtracted.
    pub remove_mean: bool,
    /// Corrections of the baseline.
    pub baseline: Baseline,
    /// Lengths over which the record rises from zero and falls to it by half a cosine wave, s.
    pub taper: [f64; 2],
    /// Its size.
    pub size: Size,
    /// Time of its first sample in the end, s.
    pub delay: f64,
}

impl Default for Treatment {
    fn default() -> Self {
        Treatment {
            from: None,
            to: None,
            remove_mean: false,
            baseline: Baseline::default(),
            taper: [0.0; 2],
            size: Size::Factor(1.0),
            delay: 0.0,
        }
    }
}

/// Why a record cannot be treated as asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// The step, as scenes call it: `from`, `to`, `taper`, `pga`, `Sa`, `baseline`.
    pub step: &'static str,
    /// What is wrong.
    pub message: String,
}

impl Treatment {
    /// The record as it moves the ground.
    pub fn apply(&self, samples: &Samples) -> Result<Samples, Refusal> {
        let mut samples = self.cut(samples)?;
        if self.remove_mean {
            samples = samples.without_mean();
        }
        if let Some(degree) = self.baseline.polynomial {
            subtract_polynomial(&mut samples, degree)?;
        }
        if let Some((frequency, order)) = self.baseline.high_pass {
            samples = high_pass(&samples, frequency, order);
        }
        self.taper(&mut samples)?;
        let factor = self.factor(&samples)?;
        samples.values.iter_mut().for_each(|a| *a *= factor);
        samples.times = match samples.times {
            Times::Every { dt, .. } => Times::Every {
                start: self.delay,
                dt,
            },
            Times::At(times) => {
                let shift = self.delay - times[0];
                Times::At(times.iter().map(|t| t + shift).collect())
            }
        };
        Ok(samples)
    }

    fn cut(&self, samples: &Samples) -> Result<Samples, Refusal> {
        let last = samples.values.len() - 1;
        let (first_time, last_time) = (samples.time(0), samples.time(last));
        let (from, to) = (
            self.from.unwrap_or(first_time),
            self.to.unwrap_or(last_time),
        );
        for (step, t) in [("from", from), ("to", to)] {
            if !(first_time..=last_time).contains(&t) {
                let message = format!(
                    "{t} s is outside the record, which lasts from {first_time} to {last_time} s"
                );
                return Err(Refusal { step, message });
            }
        }
        if from >= to {
            let message = format!("nothing is left between {from} and {to} s");
            return Err(Refusal {
                step: if self.to.is_some() { "to" } else { "from" },
                message,
            });
        }
        let value = |t: f64| {
            let times = |i: &usize| samples.time(*i) < t;
            let i = (0..=last).take_while(times).count().clamp(1, last);
            let part = (t - samples.time(i - 1)) / samples.step(i - 1);
            let [a, b] = [samples.values[i - 1], samples.values[i]];
            a + part * (b - a)
        };
        // Decimal times of samples are not their doubles; nobody means a billionth of a step.
        let near = |a: f64, b: f64, step: f64| (a - b).abs() < 1e-9 * step;
        let step = (last_time - first_time) / last as f64;
        let inside: Vec<usize> = (0..=last)
            .filter(|&i| {
                let t = samples.time(i);
                let ends = near(t, from, step) || near(t, to, step);
                ends || (from < t && t < to)
            })
            .collect();
        let mut times: Vec<f64> = inside.iter().map(|&i| samples.time(i)).collect();
        let mut values: Vec<f64> = inside.iter().map(|&i| samples.values[i]).collect();
        let mut whole = true;
        if !times.first().is_some_and(|&t| near(t, from, step)) {
            times.insert(0, from);
            values.insert(0, value(from));
            whole = false;
        }
        if !times.last().is_some_and(|&t| near(t, to, step)) {
            times.push(to);
            values.push(value(to));
            whole = false;
        }
        let times = match samples.times {
            Times::Every { dt, .. } if whole => Times::Every {
                start: times[0],
                dt,
            },
            _ => Times::At(times),
        };
        if values.len() < 2 {
            let message = format!("between {from} and {to} s the record has one sample");
            return Err(Refusal {
                step: "to",
                message,
            });
        }
        Ok(Samples { times, values })
    }

    fn taper(&self, samples: &mut Samples) -> Result<(), Refusal> {
        let last = samples.values.len() - 1;
        let (first, end) = (samples.time(0), samples.time(last));
        let [rise, fall] = self.taper;
        if rise + fall > end - first {
            let message = format!(
                "the taper of {rise} and {fall} s is longer than the record, {} s",
                end - first
            );
            return Err(Refusal {
                step: "taper",
                message,
            });
        }
        for i in 0..=last {
            let t = samples.time(i);
            for (length, since) in [(rise, t - first), (fall, end - t)] {
                if since < length {
                    samples.values[i] *= 0.5 * (1.0 - (PI * since / length).cos());
                }
            }
        }
        Ok(())
    }

    fn factor(&self, samples: &Samples) -> Result<f64, Refusal> {
        let (step, found, wanted) = match self.size {
            Size::Factor(factor) => return Ok(factor),
            Size::Pga(value) => {
                let largest = samples.values.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
                ("pga", largest, value)
            }
            Size::Sa {
                period,
                damping,
                value,
            } => ("Sa", ordinate(samples, period, damping).peak, value),
        };
        let factor = wanted / found;
        if found > 0.0 && factor.is_finite() {
            Ok(factor)
        } else {
            let message = format!("a record with {found} m/s² cannot be scaled to {wanted} m/s²");
            Err(Refusal { step, message })
        }
    }
}

/// Subtracts a polynomial of a degree from the acceleration, so that the velocity that is left is
/// least in the mean of squares.
fn subtract_polynomial(samples: &mut Samples, degree: usize) -> Result<(), Refusal> {
    let count = samples.values.len();
    if count < degree + 3 {
        let message = format!("{count} samples are too few for a polynomial of degree {degree}");
        return Err(Refusal {
            step: "baseline",
            message,
        });
    }
    let (first, length) = (samples.time(0), samples.time(count - 1) - samples.time(0));
    let x: Vec<f64> = (0..count)
        .map(|i| (samples.time(i) - first) / length)
        .collect();
    // Square roots of the weights of the trapezoidal rule.
    let weight: Vec<f64> = (0..count)
        .map(|i| {
            let before = if i > 0 { samples.step(i - 1) } else { 0.0 };
            let after = if i + 1 < count { samples.step(i) } else { 0.0 };
            (before + after).sqrt()
        })
        .collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let [velocity, _] = samples.integrals();
    let mut rest: Vec<f64> = velocity.iter().zip(&weight).map(|(v, w)| v * w).collect();
    // Columns x, x², …, made orthogonal one after the other.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut triangle = vec![vec![0.0; degree + 1]; degree + 1];
    let mut right = Vec::new();
    for k in 0..=degree {
        let mut column: Vec<f64> = x
            .iter()
            .zip(&weight)
            .map(|(x, w)| w * x.powi(k as i32 + 1))
            .collect();
        // Twice is enough for columns this few.
        for _ in 0..2 {
            for (j, earlier) in columns.iter().enumerate() {
                let part = dot(earlier, &column);
                triangle[j][k] += part;
                column
                    .iter_mut()
                    .zip(earlier)
                    .for_each(|(c, e)| *c -= part * e);
            }
        }
        let size = dot(&column, &column).sqrt();
        triangle[k][k] = size;
        column.iter_mut().for_each(|c| *c /= size);
        let part = dot(&column, &rest);
        rest.iter_mut()
            .zip(&column)
            .for_each(|(r, c)| *r -= part * c);
        right.push(part);
        columns.push(column);
    }
    let mut coefficients = vec![0.0; degree + 1];
    for k in (0..=degree).rev() {
        let later: f64 = (k + 1..=degree)
            .map(|j| triangle[k][j] * coefficients[j])
            .sum();
        coefficients[k] = (right[k] - later) / triangle[k][k];
    }
    for (a, x) in samples.values.iter_mut().zip(&x) {
        let slope: f64 = coefficients
            .iter()
            .enumerate()
            .map(|(k, c)| (k + 1) as f64 * c * x.powi(k as i32))
            .sum();
        *a -= slope / length;
    }
    Ok(())
}

/// Forwards and backwards through a Butterworth high-pass filter of an even order, with room for its
/// transients on both sides: 1.5 order/frequency (Converse & Brady, 1992). The room stays part of the
/// record, as displacements would drift without it (Boore, 2005).
fn high_pass(samples: &Samples, frequency: f64, order: usize) -> Samples {
    let last = samples.values.len() - 1;
    let (first, end) = (samples.time(0), samples.time(last));
    let step = samples.dt().unwrap_or((end - first) / last as f64);
    let room = (1.5 * order as f64 / frequency / step).ceil() as usize;
    let mut values = vec![0.0; room];
    values.extend(&samples.values);
    values.resize(values.len() + room, 0.0);
    let start = first - room as f64 * step;
    let times = match &samples.times {
        Times::Every { dt, .. } => Times::Every { start, dt: *dt },
        Times::At(times) => Times::At(
            (0..room)
                .map(|i| start + i as f64 * step)
                .chain(times.iter().copied())
                .chain((1..=room).map(|i| end + i as f64 * step))
                .collect(),
        ),
    };
    let mut padded = Samples { times, values };
    let mut steps: Vec<f64> = (0..padded.values.len() - 1)
        .map(|i| padded.step(i))
        .collect();
    for _ in 0..2 {
        for section in 1..=order / 2 {
            let angle = PI * (2 * section - 1) as f64 / (2 * order) as f64;
            let oscillator = Oscillator {
                omega: 2.0 * PI * frequency,
                zeta: angle.sin(),
            };
            accelerations(&oscillator, &steps, &mut padded.values);
        }
        padded.values.reverse();
        steps.reverse();
    }
    padded
}

/// Replaces a force by the acceleration of an oscillator under it: s²/(s² + 2ζω s + ω²).
fn accelerations(oscillator: &Oscillator, steps: &[f64], force: &mut [f64]) {
    let mut state = [0.0; 2];
    let mut known = (f64::NAN, oscillator.responses(0.0));
    let mut before = force[0];
    for (i, &h) in steps.iter().enumerate() {
        if known.0 != h {
            known = (h, oscillator.responses(h));
        }
        let now = force[i + 1];
        let next = known.1.after(state, before, (now - before) / h);
        force[i] = oscillator.acceleration(state, before);
        (state, before) = (next, now);
    }
    force[steps.len()] = oscillator.acceleration(state, before);
}
