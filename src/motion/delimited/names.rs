//! What names of columns and comments state: units and steps.

use super::super::number::first_number;
use super::super::unit::{Measure, measure};

/// What a column's name says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    /// The name without its unit.
    pub label: String,
    pub measure: Option<Measure>,
    /// What stands in brackets and is no unit that is known.
    pub unknown: Option<String>,
}

impl Column {
    /// Reads `acc_m_s2`, `a [m/s2]`, `Acceleration (g)`, `acc in g`, `time, s`, `cm/s^2`.
    pub fn parse(name: &str) -> Column {
        let name = name.trim();
        let column = |label: &str, measure| Column {
            label: label.trim().to_owned(),
            measure: Some(measure),
            unknown: None,
        };
        if let Some((label, rest)) = name.split_once(['[', '(']) {
            let end = rest.rfind([']', ')']).unwrap_or(rest.len());
            return match measure(&rest[..end]) {
                Some(measure) => column(label, measure),
                None => Column {
                    label: label.trim().to_owned(),
                    measure: None,
                    unknown: Some(rest[..end].trim().to_owned()),
                },
            };
        }
        // The unit is what follows the first of these after which one stands.
        for (at, separator) in name.match_indices([' ', '_', ',']) {
            let unit = name[at + separator.len()..].trim();
            let unit = unit.strip_prefix("in ").unwrap_or(unit);
            if let Some(measure) = measure(unit) {
                return column(name[..at].trim_end_matches(" in"), measure);
            }
        }
        match measure(name) {
            // `m` is as likely a name.
            Some(measure) if name.len() > 1 || name.eq_ignore_ascii_case("g") => {
                column("", measure)
            }
            _ => Column {
                label: name.to_owned(),
                measure: None,
                unknown: None,
            },
        }
    }

    /// Whether it holds times.
    pub fn is_time(&self) -> bool {
        let names = [
            "t", "s", "sec", "seconds", "time", "times", "zeit", "temps", "tiempo", "tempo",
        ];
        matches!(self.measure, Some(Measure::Time(_)))
            || self.measure.is_none() && names.contains(&&*self.label.to_lowercase())
    }
}

/// The rest of a comment after a word of its own, whatever its case.
fn after<'a>(comment: &'a str, word: &str) -> impl Iterator<Item = &'a str> {
    let lower = comment.to_ascii_lowercase();
    let places: Vec<usize> = lower.match_indices(word).map(|(at, _)| at).collect();
    let whole = move |&at: &usize| {
        let before = lower[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '_')
    };
    let length = word.len();
    places
        .into_iter()
        .filter(whole)
        .map(move |at| &comment[at + length..])
}

/// The step that a comment states, s: `dt = 0.005 s`, `time step 5 ms`, `sampling rate: 200 Hz`.
pub(super) fn step(comment: &str) -> Option<f64> {
    // A number and the word behind it; the sign between may be left out.
    let value = |text: &str| {
        let text = text.trim_start();
        let openings = ["=", ":", "of ", "is "];
        let text = openings
            .iter()
            .find_map(|o| text.strip_prefix(o))
            .unwrap_or(text);
        let (number, rest) = first_number(text)?;
        let rest = rest.trim_start();
        let end = rest.find([',', ';', ' ', ')']).unwrap_or(rest.len());
        Some((number, rest[..end].to_ascii_lowercase()))
    };
    let steps = [
        "dt",
        "delta t",
        "time step",
        "timestep",
        "time increment",
        "sampling interval",
        "step",
    ];
    for word in steps {
        for (dt, unit) in after(comment, word).filter_map(value) {
            match measure(&unit) {
                Some(Measure::Time(factor)) => return Some(dt * factor),
                // Many things are steps.
                _ if unit.is_empty() && word != "step" => return Some(dt),
                _ => {}
            }
        }
    }
    let rates = [
        "sampling rate",
        "sampling frequency",
        "sample rate",
        "sampling freq",
        "fs",
    ];
    rates
        .iter()
        .flat_map(|word| after(comment, word))
        .filter_map(value)
        .find_map(|(rate, unit)| matches!(&*unit, "hz" | "" | "sps").then_some(1.0 / rate))
}

/// What a comment says the values are: `acceleration in g`, `units: cm/s^2`, `values [m/s2]`, or `[m/s2]` alone.
pub(super) fn quantity(comment: &str) -> Option<Measure> {
    let words = [
        "accelerations",
        "acceleration",
        "accel",
        "acc",
        "values",
        "units",
        "unit",
        "data",
    ];
    let stated = |word: &str, rest: &str| {
        let rest = rest.trim_start();
        let openings = ["in units of ", "in ", "of ", "are ", "=", ":", "[", "("];
        let opened = openings.iter().find_map(|opening| {
            let head = rest.get(..opening.len())?;
            head.eq_ignore_ascii_case(opening)
                .then(|| &rest[opening.len()..])
        });
        let text = opened.or(word.starts_with("unit").then_some(rest))?;
        let text = text.trim_start().trim_start_matches(['(', '[', '=']);
        text.split([',', ';', ')', ']']).find_map(|part| {
            let part = part.trim().trim_end_matches('.');
            let unit = measure(part).or_else(|| measure(part.split_whitespace().next()?));
            unit.filter(|m| !matches!(m, Measure::Time(_)))
        })
    };
    words
        .into_iter()
        .find_map(|word| after(comment, word).find_map(|rest| stated(word, rest)))
        .or_else(|| bracketed(comment))
}

/// The only unit but those of times that stands in square brackets.
fn bracketed(comment: &str) -> Option<Measure> {
    let inside = comment.split('[').skip(1);
    let inside = inside.filter_map(|rest| measure(rest.split_once(']')?.0));
    let mut units = inside.filter(|m| !matches!(m, Measure::Time(_)));
    let unit = units.next()?;
    units.all(|other| other == unit).then_some(unit)
}

/// The names that a comment lists: `columns: time_s, acc_m_s2; …`.
pub(super) fn columns(comment: &str) -> Option<Vec<String>> {
    let rest = after(comment, "columns")
        .next()?
        .trim_start()
        .strip_prefix([':', '='])?;
    let list = rest.split(';').next()?;
    Some(list.split(',').map(|name| name.trim().to_owned()).collect())
}
