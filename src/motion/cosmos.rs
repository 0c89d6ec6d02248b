//! COSMOS V1.20: for each channel text lines, integer and real headers, comments, values in columns.

use super::channel::{Stated, two_at_least};
use super::number::{Columns, count, number, rounding};
use super::text::{Line, Page};
use super::unit::{Measure, measure};
use super::{Channel, Fault, Format, Given, Motion, Note, Samples};

/// Places in the headers, from 0: quantity, code of the unit; step (ms), length (s), peak and its time.
const QUANTITY: usize = 1;
const STEP: usize = 61;
const LENGTH: usize = 62;
const PEAK: usize = 63;
const PEAK_TIME: usize = 64;
/// What stands for unknown if the header does not say.
const UNKNOWN: &str = "-999.0";

pub(super) fn detect(page: &Page) -> bool {
    page.line(0).has("(Format v")
}

pub(super) fn read(page: &Page, given: &Given) -> Result<Motion, Fault> {
    let mut motion = Motion {
        format: Format::Cosmos,
        details: Vec::new(),
        channels: Vec::new(),
        notes: Vec::new(),
    };
    let mut at = 0;
    let mut other = None;
    loop {
        while at < page.lines.len() && page.line(at).is_blank() {
            at += 1;
        }
        if at == page.lines.len() {
            break;
        }
        at = section(page, at, given, &mut motion, &mut other)?;
    }
    match (motion.channels.is_empty(), other) {
        (true, Some(fault)) => Err(fault),
        _ => Ok(motion),
    }
}

/// One channel from its first text line on; gives the line after it.
fn section(
    page: &Page,
    start: usize,
    given: &Given,
    motion: &mut Motion,
    other: &mut Option<Fault>,
) -> Result<usize, Fault> {
    let first = page.line(start);
    let Some(format) = first.after("(Format v") else {
        let message = "neither the end nor the first line of a channel";
        let help = "a channel begins with a line that ends in `(Format v01.20 with 13 text lines)`";
        return Err(Fault::new(message, first.range(), help));
    };
    let version = format.split_whitespace().next().unwrap_or("");
    if version != "01.20" {
        let message = format!("version {version} of the format, not 01.20");
        motion.notes.push(Note::doubt(message, first.range()));
    }
    let lines = first
        .after("with")
        .and_then(|t| count(t.split_whitespace().next()?))
        .unwrap_or(13);
    let text = start..start + lines;
    let unknown = page
        .find(text.clone(), "Values used when parameter")
        .and_then(|(_, line)| line.text.rsplit(',').next())
        .and_then(number)
        .or(number(UNKNOWN));

    let (integers, at) = header(page, text.end, "Integer-header")?;
    let (reals, at) = header(page, at, "Real-header")?;
    let comments = page.line(at);
    let Some(number_of_comments) = comments
        .has("Comment")
        .then(|| count(comments.text.split_whitespace().next()?))
        .flatten()
    else {
        let message = "the line that counts the comments is missing";
        return Err(Fault::new(
            message,
            comments.range(),
            "it is such as `  2 Comment line(s) follow, …`",
        ));
    };
    let at = at + 1 + number_of_comments;
    let line = page.line(at);
    let data = announced(&line)?;
    let (values, after) = data.columns.block(page, at + 1, data.count, "values")?;

    // The end of the data may be missing at the end of a file only.
    let end = page.line(after);
    let ended =
        end.text.trim_start().starts_with("/&") || end.has("End-of-data") || end.has("End of data");
    let next = after + usize::from(ended);
    if !ended {
        if page
            .lines
            .get(after..)
            .is_some_and(|rest| rest.iter().any(|l| !l.is_blank()))
        {
            let message = format!(
                "after {} values the end of the data is expected",
                data.count
            );
            return Err(Fault::new(
                message,
                end.range(),
                "it is a line such as `/&  ---- End of data for channel  1`",
            ));
        }
        motion.notes.push(Note::remark(
            "the line at the end of the data is missing",
            page.end(),
        ));
    }

    let named = || {
        let line = page.line(start + 8).text.trim();
        let chan = line.split("(Rcrdr").next().unwrap_or(line);
        let words: Vec<_> = chan.trim_start_matches("Sta").split_whitespace().collect();
        words
            .join(" ")
            .trim_start_matches("Chan")
            .trim_start_matches("Cha:")
            .trim()
            .to_owned()
    };
    let quantity = integers.get(QUANTITY).and_then(|(_, t)| number(t));
    // The code is 1 for accelerations and negative where it is unknown.
    let by_code = quantity.is_none_or(|code| code == 1.0 || code < 0.0);
    let is_acceleration =
        by_code && line.has("accel") && matches!(data.measure, Measure::Acceleration(_));
    if !is_acceleration {
        let what = line.text.trim();
        let message = format!(
            "`{}` is not accelerations in a unit of acceleration: `{what}`",
            named()
        );
        let help = match data.measure {
            Measure::Counts => {
                "counts need the sensitivity of the instrument; get the processed record (V1 or V2)"
            }
            _ => "read a file of accelerations",
        };
        other.get_or_insert(Fault::new(&message, line.range(), help));
        motion
            .notes
            .push(Note::remark(format!("not read: {message}"), line.range()));
        return Ok(next);
    }
    let stated = match data.measure {
        Measure::Acceleration(unit) => Some(unit),
        _ => None,
    };
    let unit = given.unit(stated, line.range())?;

    let real = |i: usize| {
        let (line, text) = reals.get(i)?;
        (number(text) != unknown).then_some((*line, *text))
    };
    let step = real(STEP);
    let place = step.map_or(
        reals.get(STEP).map_or(line.range(), |(l, t)| l.place(t)),
        |(l, t)| l.place(t),
    );
    let seconds = step.and_then(|(_, t)| number(t)).map(|ms| ms / 1000.0);
    let exactness = step.map_or(0.0, |(_, t)| rounding(t) * 1e-3);
    let dt = given.dt(seconds, exactness, place)?;
    two_at_least(values.len(), line.range())?;
    let peak = real(PEAK);
    let stated = Stated {
        peak: peak.map(|(_, t)| t),
        time: real(PEAK_TIME).map(|(_, t)| t),
        length: real(LENGTH).map(|(_, t)| t),
        place: peak.map_or(line.range(), |(l, t)| l.place(t)),
    };
    stated.check(&values, dt, &mut motion.notes);
    if motion.channels.is_empty() {
        motion.details = vec![
            ("event", page.line(start + 1).text.trim().to_owned()),
            ("station", page.line(start + 4).text.trim().to_owned()),
        ];
    }
    motion.channels.push(Channel {
        name: named(),
        unit,
        samples: Samples::every(dt, values.iter().map(|a| a * unit.factor).collect()),
        place: line.range(),
    });
    Ok(next)
}

/// A header of numbers: `100 Real-header values follow on  20 lines, Format= (5F15.6)`. Gives the
/// fields and the line after them.
#[allow(clippy::type_complexity)]
fn header<'a>(
    page: &Page<'a>,
    at: usize,
    name: &str,
) -> Result<(Vec<(Line<'a>, &'a str)>, usize), Fault> {
    let line = page.line(at);
    let help = format!("it is such as ` 100 {name} values follow on  10 lines, Format= (10I8)`");
    let wrong = || {
        Fault::new(
            format!("the line of the {name} is missing"),
            line.range(),
            &help,
        )
    };
    if !line.has(name) {
        return Err(wrong());
    }
    let wanted = line
        .text
        .split_whitespace()
        .next()
        .and_then(count)
        .ok_or_else(wrong)?;
    let format = line
        .after("Format")
        .and_then(|t| t.split_once('='))
        .ok_or_else(wrong)?
        .1;
    let columns = Columns::parse(format).ok_or_else(wrong)?;
    let mut fields = Vec::new();
    let mut i = at + 1;
    while fields.len() < wanted {
        let line = page.line(i);
        let here = (wanted - fields.len()).min(columns.count);
        for k in 0..here {
            let field = line
                .text
                .get(k * columns.width..((k + 1) * columns.width).min(line.text.len()));
            let field = field.map(str::trim).filter(|t| number(t).is_some());
            let Some(field) = field else {
                let message = format!(
                    "{wanted} numbers are announced for the {name}, {} are there",
                    fields.len()
                );
                return Err(Fault::new(message, line.range(), &help));
            };
            fields.push((line, field));
        }
        i += 1;
    }
    Ok((fields, i))
}

struct Announced {
    count: usize,
    measure: Measure,
    columns: Columns,
}

/// `   7000  acceleration pts, approx   70 secs, units=cm/sec2(04),Format=(8F10.5)`.
fn announced(line: &Line) -> Result<Announced, Fault> {
    let help =
        "it is such as `7000 acceleration pts, approx 70 secs, units=cm/sec2(04),Format=(8F10.5)`";
    let wrong = |what: &str| {
        Fault::new(
            format!("the line before the values does not state {what}"),
            line.range(),
            help,
        )
    };
    let number_of_values = line
        .text
        .split_whitespace()
        .next()
        .and_then(count)
        .ok_or_else(|| wrong("their count"))?;
    let format = line
        .after("Format")
        .and_then(|t| t.split_once('='))
        .ok_or_else(|| wrong("their columns"))?
        .1;
    let columns = Columns::parse(format).ok_or_else(|| wrong("their columns"))?;
    let units = line
        .after("units")
        .and_then(|t| t.split_once('='))
        .ok_or_else(|| wrong("their unit"))?
        .1;
    let unit = units.split(['(', ',']).next().unwrap_or("").trim();
    let of_code = |code: &str| match count(code)? {
        2 => measure("g"),
        4 => measure("cm/s2"),
        5 => Some(Measure::Velocity),
        6 => Some(Measure::Displacement),
        50 => Some(Measure::Counts),
        _ => None,
    };
    let code = units
        .split_once('(')
        .and_then(|(_, rest)| of_code(rest.split(')').next()?));
    let by_name = measure(unit);
    if let (Some(a), Some(b)) = (by_name, code)
        && a != b
    {
        return Err(Fault::new(
            format!("name and code of the unit disagree: `{unit}`"),
            line.range(),
            "02 is g, 04 is cm/sec2",
        ));
    }
    let measure = by_name.or(code).ok_or_else(|| wrong("a known unit"))?;
    Ok(Announced {
        count: number_of_values,
        measure,
        columns,
    })
}
