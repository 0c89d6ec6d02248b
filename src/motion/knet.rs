//! K-NET and KiK-net (NIED): 17 header lines, then counts.

use super::channel::{Stated, two_at_least};
use super::number::{first_number, free, number};
use super::text::{Line, Page};
use super::{Channel, Fault, Format, Given, Motion, Note, Samples, Unit};

/// Lines of the header.
const HEADER: usize = 17;

pub(super) fn detect(page: &Page) -> bool {
    page.line(0).text.starts_with("Origin Time")
}

/// The line of a key.
fn line<'a>(page: &Page<'a>, key: &str) -> Result<Line<'a>, Fault> {
    let mut lines = page.lines.iter().take(HEADER);
    lines
        .find(|line| line.text.starts_with(key))
        .copied()
        .ok_or_else(|| {
            let message = format!("the header has no line `{key}`");
            Fault::new(
                message,
                page.line(0).range(),
                "the header has 17 lines, `Origin Time` to `Memo.`",
            )
        })
}

fn value<'a>(page: &Page<'a>, key: &str) -> Result<(Line<'a>, &'a str), Fault> {
    let line = line(page, key)?;
    Ok((line, line.text[key.len()..].trim()))
}

pub(super) fn read(page: &Page, given: &Given) -> Result<Motion, Fault> {
    let (place, frequency) = value(page, "Sampling Freq(Hz)")?;
    let rate =
        first_number(frequency).filter(|(f, rest)| *f > 0.0 && matches!(rest.trim(), "" | "Hz"));
    let Some((rate, _)) = rate else {
        let message = format!("`{frequency}` is not a sampling frequency");
        return Err(Fault::new(
            message,
            place.range(),
            "it is a positive number in Hz, such as `100Hz`",
        ));
    };
    let dt = given.dt(Some(1.0 / rate), 0.0, place.range())?;
    let (place, scale) = value(page, "Scale Factor")?;
    let (numerator, denominator) = scale_factor(scale).ok_or_else(|| {
        let message = format!("`{scale}` is not a scale factor");
        Fault::new(message, place.range(), "it is such as `3920(gal)/6182761`")
    })?;
    let gal = Unit::parse("gal");
    let unit = given.unit(gal, place.range())?;

    let memo = page
        .lines
        .iter()
        .take(HEADER)
        .position(|l| l.text.starts_with("Memo"));
    let Some(memo) = memo else {
        return Err(line(page, "Memo.").expect_err("it is not there"));
    };
    let mut counts = Vec::new();
    for line in &page.lines[memo + 1..] {
        let before = counts.len();
        free(line, &mut counts)?;
        if counts[before..].iter().any(|c| c.fract() != 0.0) {
            return Err(Fault::new(
                "counts are whole numbers",
                line.range(),
                "get the record anew",
            ));
        }
    }
    two_at_least(counts.len(), page.end())?;

    let mut notes = Vec::new();
    let mean = counts.iter().sum::<f64>() / counts.len() as f64;
    let gal: Vec<f64> = counts
        .iter()
        .map(|c| (c - mean) * numerator / denominator)
        .collect();
    if let Ok((place, peak)) = value(page, "Max. Acc. (gal)") {
        let stated = Stated {
            peak: Some(peak),
            place: place.range(),
            ..Stated::default()
        };
        stated.check(&gal, dt, &mut notes);
    }
    // The count comes from the values; the duration is in whole seconds.
    if let Ok((place, text)) = value(page, "Duration Time(s)")
        && let Some(duration) = number(text)
        && (counts.len() as f64 * dt - duration).abs() > 1.0
    {
        let found = counts.len() as f64 * dt;
        let message =
            format!("the header has a duration of {duration} s, the values make {found} s");
        notes.push(Note::doubt(message, place.range()));
    }
    let offset = mean * numerator / denominator * 0.01;
    let message = format!(
        "the values keep their offset of {offset} m/s²; remove the mean before integrating"
    );
    notes.push(Note::remark(message, page.line(memo + 1).range()));

    let direction = value(page, "Dir.")?.1;
    let (format, name) = match direction {
        "1" => (Format::KikNet, "NS borehole"),
        "2" => (Format::KikNet, "EW borehole"),
        "3" => (Format::KikNet, "UD borehole"),
        "4" => (Format::KikNet, "NS surface"),
        "5" => (Format::KikNet, "EW surface"),
        "6" => (Format::KikNet, "UD surface"),
        other => (Format::KNet, other),
    };
    let detail = |name, key| Some((name, value(page, key).ok()?.1.to_owned()));
    let trigger = detail("recorded", "Record Time")
        .map(|(name, time)| (name, format!("from 15 s before {time}, Japan time")));
    let values = counts
        .iter()
        .map(|c| c * numerator / denominator * 0.01)
        .collect();
    Ok(Motion {
        format,
        details: [
            detail("station", "Station Code"),
            detail("origin", "Origin Time"),
            trigger,
        ]
        .into_iter()
        .flatten()
        .collect(),
        channels: vec![Channel {
            name: name.to_owned(),
            unit,
            samples: Samples::every(dt, values),
            place: page.line(memo + 1).range(),
        }],
        notes,
    })
}

/// Numerator and denominator of `3920(gal)/6182761`.
fn scale_factor(text: &str) -> Option<(f64, f64)> {
    let (numerator, denominator) = text.split_once('/')?;
    let numerator = number(numerator.trim().strip_suffix("(gal)")?)?;
    let denominator = number(denominator)?;
    (numerator != 0.0 && denominator != 0.0).then_some((numerator, denominator))
}
