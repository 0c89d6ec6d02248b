//! ESM, DYNA 1.2: lines `KEY: value`, then one value a line.

use super::channel::{Stated, two_at_least};
use super::number::{count, number, rounding, too_many};
use super::text::{Line, Page};
use super::unit::{Measure, measure};
use super::{Channel, Fault, Format, Given, Motion, Note, Samples};

/// Lines of the header of DYNA 1.2, and some more.
const HEADER: usize = 80;

pub(super) fn detect(page: &Page) -> bool {
    let first = page.line(0).text;
    first.starts_with("EVENT_NAME:") || page.find(0..HEADER, "HEADER_FORMAT: DYNA").is_some()
}

/// Key and value of a header line.
fn entry<'a>(line: &Line<'a>) -> Option<(&'a str, &'a str)> {
    let (key, value) = line.text.split_once(':')?;
    let is_key = key.starts_with(|c: char| c.is_ascii_uppercase())
        && key
            .chars()
            .all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || "_/^ ".contains(c));
    is_key.then(|| (key.trim(), value.trim()))
}

pub(super) fn read(page: &Page, given: &Given) -> Result<Motion, Fault> {
    let header = page
        .lines
        .iter()
        .take_while(|line| entry(line).is_some())
        .count();
    let find = |key: &str| {
        page.lines[..header].iter().find_map(|line| {
            entry(line)
                .filter(|(k, _)| *k == key)
                .map(|(_, v)| (*line, v))
        })
    };
    let needed = |key: &str| {
        find(key).filter(|(_, v)| !v.is_empty()).ok_or_else(|| {
            let place = find(key).map_or(page.line(0).range(), |(line, _)| line.range());
            Fault::new(
                format!("the header does not state {key}"),
                place,
                format!("it has a line `{key}: …`"),
            )
        })
    };
    let mut notes = Vec::new();
    if let Some((line, version)) = find("HEADER_FORMAT")
        && version != "DYNA 1.2"
    {
        notes.push(Note::doubt(
            format!("the header is of `{version}`, not of DYNA 1.2"),
            line.range(),
        ));
    }
    let (line, kind) = needed("DATA_TYPE")?;
    if kind != "ACCELERATION" {
        let message = format!("the values are not accelerations: DATA_TYPE is {kind}");
        return Err(Fault::new(
            message,
            line.range(),
            "read the file of accelerations",
        ));
    }
    let (line, text) = needed("UNITS")?;
    let Some(Measure::Acceleration(stated)) = measure(text) else {
        let message = format!("`{text}` is not a unit of acceleration");
        return Err(Fault::new(message, line.range(), "UNITS is cm/s^2"));
    };
    let unit = given.unit(Some(stated), line.range())?;
    let (line, text) = needed("SAMPLING_INTERVAL_S")?;
    let dt = number(text).ok_or_else(|| {
        Fault::new(
            format!("`{text}` is not a step"),
            line.range(),
            "it is a number in s",
        )
    })?;
    let dt = given.dt(Some(dt), rounding(text), line.range())?;
    let (line, text) = needed("NDATA")?;
    let wanted = count(text).ok_or_else(|| {
        Fault::new(
            format!("NDATA is `{text}`, not a count"),
            line.range(),
            "it is the number of values",
        )
    })?;

    let mut values = Vec::new();
    for line in page.lines[header..].iter().filter(|line| !line.is_blank()) {
        let text = line.text.trim();
        values.push(number(text).ok_or_else(|| {
            Fault::new(
                format!("`{text}` is not a finite number"),
                line.range(),
                "each line has one value",
            )
        })?);
    }
    if values.len() < wanted {
        let message = format!(
            "the header has NDATA = {wanted}, {} values are there",
            values.len()
        );
        let help = "the file is cut or its header is wrong; get the record anew";
        return Err(Fault::new(message, page.end(), help));
    }
    if values.len() > wanted {
        return Err(too_many(&page.line(header + wanted), wanted, values.len()));
    }
    two_at_least(wanted, line.range())?;
    let peak = find("PGA_CM/S^2");
    let stated = Stated {
        peak: peak.map(|(_, v)| v),
        time: find("TIME_PGA_S").map(|(_, v)| v),
        length: find("DURATION_S").map(|(_, v)| v),
        place: peak.map_or(line.range(), |(line, _)| line.range()),
    };
    let in_cm: Vec<f64> = values.iter().map(|a| a * (unit.factor / 0.01)).collect();
    stated.check(&in_cm, dt, &mut notes);

    let detail = |name, key| Some((name, find(key)?.1.to_owned())).filter(|(_, v)| !v.is_empty());
    let stream = find("STREAM").map_or("", |(_, v)| v);
    Ok(Motion {
        format: Format::Esm,
        details: [
            detail("event", "EVENT_NAME"),
            detail("station", "STATION_CODE"),
            detail("processing", "PROCESSING"),
        ]
        .into_iter()
        .flatten()
        .collect(),
        channels: vec![Channel {
            name: if stream.is_empty() {
                "1".into()
            } else {
                stream.into()
            },
            unit,
            samples: Samples::every(dt, values.iter().map(|a| a * unit.factor).collect()),
            place: page.line(header).range(),
        }],
        notes,
    })
}
