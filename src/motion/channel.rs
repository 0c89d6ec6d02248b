//! What a record holds.

use std::ops::Range;

use super::{Fault, Format, Note, Unit};

/// A record: one or several channels of ground acceleration.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The format of its file.
    pub format: Format,
    /// What the header says in words, such as ("station", "TST001").
    pub details: Vec<(&'static str, String)>,
    /// At least one.
    pub channels: Vec<Channel>,
    /// What its reader has to tell.
    pub notes: Vec<Note>,
}

/// Acceleration over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name or direction, as the file has it.
    pub name: String,
    /// Unit of the file.
    pub unit: Unit,
    /// The samples, in m/s².
    pub samples: Samples,
    /// Where its header or its values begin, in bytes of the text.
    pub place: Range<usize>,
}

/// Times of samples.
#[derive(Debug, Clone, PartialEq)]
pub enum Times {
    /// Equal steps.
    Every {
        /// Time of the first sample, s.
        start: f64,
        /// Step, s.
        dt: f64,
    },
    /// Increasing times, s.
    At(Vec<f64>),
}

/// A function that is linear between its samples and zero outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Times of the samples.
    pub times: Times,
    /// Two values at least.
    pub values: Vec<f64>,
}

impl Samples {
    /// Equal steps from 0 on.
    pub fn every(dt: f64, values: Vec<f64>) -> Self {
        let times = Times::Every { start: 0.0, dt };
        Samples { times, values }
    }

    /// Time of sample `i`, s.
    pub fn time(&self, i: usize) -> f64 {
        match &self.times {
            Times::Every { start, dt } => {
                // Where the rate is a whole number its quotients are the nearest to the decimals.
                let rate = 1.0 / dt;
                let since = if rate == rate.round() {
                    i as f64 / rate
                } else {
                    i as f64 * dt
                };
                start + since
            }
            Times::At(times) => times[i],
        }
    }

    /// Time from sample `i` to the next, s.
    pub fn step(&self, i: usize) -> f64 {
        match &self.times {
            Times::Every { dt, .. } => *dt,
            Times::At(times) => times[i + 1] - times[i],
        }
    }

    /// Times of all samples, s.
    pub fn all_times(&self) -> Vec<f64> {
        (0..self.values.len()).map(|i| self.time(i)).collect()
    }

    /// The step if it is the same everywhere, s.
    pub fn dt(&self) -> Option<f64> {
        match self.times {
            Times::Every { dt, .. } => Some(dt),
            Times::At(_) => None,
        }
    }

    /// Arithmetic mean of the samples.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }

    /// The same with the mean removed.
    pub fn without_mean(&self) -> Self {
        let mean = self.mean();
        let values = self.values.iter().map(|a| a - mean).collect();
        Samples {
            times: self.times.clone(),
            values,
        }
    }
}

/// Unit and step that the caller knows. They stand in where the file states none; where it does,
/// they must be the same.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Given {
    /// Unit of the values.
    pub unit: Option<Unit>,
    /// Step, s.
    pub dt: Option<f64>,
}

impl Given {
    /// The unit of a file that states `stated` or none, at a place of its text.
    pub(super) fn unit(&self, stated: Option<Unit>, place: Range<usize>) -> Result<Unit, Fault> {
        match (stated, self.unit) {
            (Some(stated), Some(given)) if stated != given => Err(Fault::new(
                format!(
                    "the file states the unit {}, not {}",
                    stated.name, given.name
                ),
                place,
                "leave out `unit`, or mend the file",
            )),
            (Some(unit), _) | (None, Some(unit)) => Ok(unit),
            (None, None) => {
                let names: Vec<_> = Unit::names().collect();
                let help = format!("give `unit` (`--unit`), one of: {}", names.join(", "));
                Err(Fault::new(
                    "the file does not state the unit of its values",
                    place,
                    help,
                ))
            }
        }
    }

    /// The step of a file that states `stated` or none, written so that it is right within
    /// `rounding`.
    pub(super) fn dt(
        &self,
        stated: Option<f64>,
        rounding: f64,
        place: Range<usize>,
    ) -> Result<f64, Fault> {
        let dt = match (stated, self.dt) {
            // One is the other as it is rounded.
            (Some(stated), Some(given)) if (stated - given).abs() > rounding => {
                return Err(Fault::new(
                    format!("the file states the step {stated} s, not {given} s"),
                    place,
                    "leave out `dt`, or mend the file",
                ));
            }
            (_, Some(given)) => given,
            (Some(stated), None) => stated,
            (None, None) => {
                let help = "give `dt` (`--dt`), the time between two values in s";
                return Err(Fault::new("the file does not state its step", place, help));
            }
        };
        if dt.is_finite() && dt > 0.0 {
            Ok(dt)
        } else {
            let message = format!("the step is {dt} s");
            Err(Fault::new(message, place, "a step is a positive time"))
        }
    }
}

/// What a header says about the values, to hold them against.
#[derive(Debug, Clone, Default)]
pub(super) struct Stated<'a> {
    /// The largest value, as it is written, signed or not.
    pub peak: Option<&'a str>,
    /// Its time, as it is written.
    pub time: Option<&'a str>,
    /// The length in s, as it is written.
    pub length: Option<&'a str>,
    /// Where that is.
    pub place: Range<usize>,
}

/// Header and values are rounded separately, to at least four digits.
const PEAK: f64 = 1e-3;

impl Stated<'_> {
    /// Holds values in the unit of the header against it; `dt` is their step.
    pub fn check(&self, values: &[f64], dt: f64, notes: &mut Vec<Note>) {
        use super::number::{number, rounding};
        let largest = values.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
        let mut doubt = |message| notes.push(Note::doubt(message, self.place.clone()));
        if let Some((text, peak)) = self.peak.and_then(|t| Some((t, number(t)?))) {
            let room = (PEAK * largest).max(2.0 * rounding(text));
            if (peak.abs() - largest).abs() > room {
                doubt(format!(
                    "the header has the peak {peak}, the values have {largest}"
                ));
            } else if let Some((text, t)) = self.time.and_then(|t| Some((t, number(t)?))) {
                // Some count from the first sample and some from one step before it.
                let near = |i: usize| (i as f64 * dt - t).abs() <= 1.5 * dt + rounding(text);
                let there = values
                    .iter()
                    .enumerate()
                    .any(|(i, a)| near(i) && (a.abs() - largest).abs() <= room);
                if !there {
                    let at = values.iter().position(|a| a.abs() == largest).unwrap_or(0);
                    doubt(format!(
                        "the header has the peak at {t} s, the values have it at {} s",
                        at as f64 * dt
                    ));
                }
            }
        }
        if let Some((text, length)) = self.length.and_then(|t| Some((t, number(t)?))) {
            let found = values.len() as f64 * dt;
            if (found - length).abs() > 1.5 * dt + 2.0 * rounding(text) {
                doubt(format!(
                    "the header has a length of {length} s, count and step make {found} s"
                ));
            }
        }
    }
}

/// A record needs two samples, so that something is between them.
pub(super) fn two_at_least(count: usize, place: Range<usize>) -> Result<(), Fault> {
    if count >= 2 {
        return Ok(());
    }
    let message = match count {
        0 => "the record has no values".to_owned(),
        _ => "the record has only one value".to_owned(),
    };
    Err(Fault::new(
        message,
        place,
        "a record needs two values at least",
    ))
}
