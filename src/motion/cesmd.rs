//! CESMD V2 (CSMIP): for each channel 25 lines of text, headers of 100 integers and 100 reals, then
//! blocks of acceleration, velocity and displacement, each announced by a line of its own.

use super::channel::{Stated, two_at_least};
use super::number::{Columns, count, first_number, number, rounding};
use super::text::{Line, Page};
use super::unit::{Measure, measure};
use super::{Channel, Fault, Format, Given, Motion, Samples};

/// Lines of text before the headers; of the headers.
const TEXT: usize = 25;
const INTEGERS: (Columns, usize) = (
    Columns {
        count: 16,
        width: 5,
    },
    100,
);
const REALS: (Columns, usize) = (
    Columns {
        count: 8,
        width: 10,
    },
    100,
);
/// Places in the real header, from 0: length (s), step (s), time (s) and value of the peak.
const LENGTH: usize = 59;
const STEP: usize = 60;
const PEAK_TIME: usize = 64;
const PEAK: usize = 65;
/// Columns of a block that does not state them.
const COLUMNS: Columns = Columns {
    count: 8,
    width: 10,
};

pub(super) fn detect(page: &Page) -> bool {
    let first = page.line(0);
    first.find("CORRECTED ACCELEROGRAM") == Some(0)
        || first.find("UNCORRECTED ACCELEROGRAM DATA") == Some(0)
}

pub(super) fn read(page: &Page, given: &Given) -> Result<Motion, Fault> {
    let first = page.line(0);
    if first.find("UNCORRECTED") == Some(0) {
        let message = "the file is of uncorrected data (V1)";
        return Err(Fault::new(
            message,
            first.range(),
            "read the corrected record (V2)",
        ));
    }
    let mut motion = Motion {
        format: Format::CesmdV2,
        details: vec![
            ("event", page.line(2).text.trim().to_owned()),
            ("station", page.line(6).text.trim().to_owned()),
        ],
        channels: Vec::new(),
        notes: Vec::new(),
    };
    let mut at = 0;
    loop {
        while at < page.lines.len() && page.line(at).is_blank() {
            at += 1;
        }
        if at == page.lines.len() {
            return Ok(motion);
        }
        at = channel(page, at, given, &mut motion)?;
    }
}

/// One channel from its first line on; gives the line after it.
fn channel(page: &Page, start: usize, given: &Given, motion: &mut Motion) -> Result<usize, Fault> {
    let first = page.line(start);
    if first.find("CORRECTED ACCELEROGRAM") != Some(0) {
        let message = "neither the end nor the first line of a channel";
        return Err(Fault::new(
            message,
            first.range(),
            "a channel begins with `Corrected accelerogram`",
        ));
    }
    let integers = start + TEXT;
    let reals = integers + INTEGERS.1.div_ceil(INTEGERS.0.count);
    let data = reals + REALS.1.div_ceil(REALS.0.count);
    let field = |i: usize| -> (Line, &str) {
        let line = page.line(reals + i / REALS.0.count);
        let from = i % REALS.0.count * REALS.0.width;
        (
            line,
            line.text
                .get(from..from + REALS.0.width)
                .unwrap_or("")
                .trim(),
        )
    };

    let mut at = data;
    let mut found = false;
    loop {
        let line = page.line(at);
        if line.text.trim_start().starts_with("/&") {
            at += 1;
            break;
        }
        if line.is_blank() && found {
            break;
        }
        let block = announced(&line)?;
        let (values, after) = block.columns.block(page, at + 1, block.count, block.name)?;
        at = after;
        if block.name != "accel" {
            continue;
        }
        found = true;
        let Some(Measure::Acceleration(stated)) = block.measure else {
            let message = "the line before the values does not state a unit of acceleration";
            return Err(Fault::new(
                message,
                line.range(),
                "it is such as `… points of accel data …, in cm/sec2. (8f10.6)`",
            ));
        };
        let unit = given.unit(Some(stated), line.range())?;
        let dt = step(&block, field(STEP), given, &line)?;
        two_at_least(values.len(), line.range())?;
        let (place, peak) = field(PEAK);
        let stated = Stated {
            peak: Some(peak),
            time: Some(field(PEAK_TIME).1),
            length: Some(field(LENGTH).1),
            place: place.place(peak),
        };
        stated.check(&values, dt, &mut motion.notes);
        let chan = page.line(start + 7).text;
        let name = chan.split_once(':').map_or(chan, |(_, name)| name);
        motion.channels.push(Channel {
            name: name.split_whitespace().collect::<Vec<_>>().join(" "),
            unit,
            samples: Samples::every(dt, values.iter().map(|a| a * unit.factor).collect()),
            place: line.range(),
        });
    }
    if !found {
        let message = "the channel has no accelerations";
        return Err(Fault::new(
            message,
            first.range(),
            "they follow a line `… points of accel data …`",
        ));
    }
    Ok(at)
}

/// The step: the real header has more digits than the text, which it must agree with.
fn step(
    block: &Announced,
    (place, text): (Line, &str),
    given: &Given,
    line: &Line,
) -> Result<f64, Fault> {
    let (shown, written) = block.step;
    match number(text) {
        Some(dt) if (dt - shown).abs() <= rounding(written) * (1.0 + 1e-9) => {
            given.dt(Some(dt), rounding(text), place.place(text))
        }
        Some(dt) if dt > 0.0 => Err(Fault::new(
            format!("the header has the step {dt} s, the line before the values has {shown} s"),
            line.range(),
            "mend the one that is wrong",
        )),
        _ => given.dt(Some(shown), rounding(written), line.range()),
    }
}

struct Announced<'a> {
    count: usize,
    /// `accel`, `veloc` or `displ`.
    name: &'static str,
    /// s, and as it is written.
    step: (f64, &'a str),
    measure: Option<Measure>,
    columns: Columns,
}

/// `12000 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`, or
/// `3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)`.
fn announced<'a>(line: &Line<'a>) -> Result<Announced<'a>, Fault> {
    let help = "it is such as `12000 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`";
    let wrong = |what: &str| {
        Fault::new(
            format!("a line before values is expected here, which states {what}"),
            line.range(),
            help,
        )
    };
    let points = line
        .text
        .split_whitespace()
        .next()
        .and_then(count)
        .ok_or_else(|| wrong("their count"))?;
    let names = ["accel", "veloc", "displ"];
    let name = names
        .into_iter()
        .find(|name| line.has(name))
        .ok_or_else(|| wrong("what they are"))?;
    let after = line
        .after("spaced at")
        .ok_or_else(|| wrong("their step"))?
        .trim_start();
    let (dt, rest) = first_number(after).ok_or_else(|| wrong("their step"))?;
    let written = &after[..after.len() - rest.len()];
    let unit = ["units:", "in "].iter().find_map(|word| {
        let at = rest.to_ascii_lowercase().find(word)?;
        let text = rest[at + word.len()..].trim_start();
        let end = text.find([' ', ')', '(']).unwrap_or(text.len());
        Some(text[..end].trim_end_matches(['.', ',']))
    });
    let columns = rest
        .rsplit_once('(')
        .filter(|(_, format)| !format.to_ascii_lowercase().contains("units"))
        .and_then(|(_, format)| Columns::parse(format))
        .unwrap_or(COLUMNS);
    Ok(Announced {
        count: points,
        name,
        step: (dt, written),
        measure: unit.and_then(measure),
        columns,
    })
}
