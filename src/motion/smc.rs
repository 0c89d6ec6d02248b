//! SMC (USGS): text, integer and real headers, comments with a bar, values in columns that touch.

use super::channel::{Stated, two_at_least};
use super::number::{Columns, number};
use super::text::{Line, Page};
use super::{Channel, Fault, Format, Given, Motion, Samples, Unit};

/// Lines of text before the integer header.
const TEXT: usize = 11;
const INTEGERS: (Columns, usize) = (
    Columns {
        count: 8,
        width: 10,
    },
    48,
);
const REALS: (Columns, usize) = (
    Columns {
        count: 5,
        width: 15,
    },
    50,
);
const VALUES: Columns = Columns {
    count: 8,
    width: 10,
};
/// Places in the headers, from 0: lines of comment, number of values; samples a second, time and
/// value of the largest and of the smallest value.
const COMMENTS: usize = 15;
const POINTS: usize = 16;
const RATE: usize = 1;
const LARGEST: (usize, usize) = (28, 29);
const SMALLEST: (usize, usize) = (30, 31);
/// What stands for unknown.
const NO_INTEGER: f64 = -32768.0;
const NO_REAL: f64 = 1.7e38;

/// What the first line says, and whether it is an acceleration.
const KINDS: [(&str, bool); 6] = [
    ("UNCORRECTED ACCELEROGRAM", true),
    ("CORRECTED ACCELEROGRAM", true),
    ("VELOCITY", false),
    ("DISPLACEMENT", false),
    ("RESPONSE SPECTR", false),
    ("FOURIER", false),
];

fn kind(page: &Page) -> Option<(&'static str, bool)> {
    let first = page.line(0).text;
    let name = first
        .strip_prefix(|c: char| c.is_ascii_digit())?
        .strip_prefix(' ')?
        .trim_start();
    KINDS
        .into_iter()
        .find(|(kind, _)| name.to_ascii_uppercase().starts_with(kind))
}

pub(super) fn detect(page: &Page) -> bool {
    kind(page).is_some()
}

pub(super) fn read(page: &Page, given: &Given) -> Result<Motion, Fault> {
    let first = page.line(0);
    if let Some((name, false)) = kind(page) {
        let message = format!("the values are not accelerations: {name}");
        return Err(Fault::new(
            message,
            first.range(),
            "read the file of accelerations",
        ));
    }
    let (integers, at) = INTEGERS
        .0
        .block(page, TEXT, INTEGERS.1, "integers of the header")?;
    let (reals, at) = REALS.0.block(page, at, REALS.1, "numbers of the header")?;
    // Where a field of the headers is.
    let field = |first: usize, columns: Columns, i: usize| -> (Line, &str) {
        let line = page.line(first + i / columns.count);
        let from = i % columns.count * columns.width;
        (
            line,
            line.text
                .get(from..from + columns.width)
                .unwrap_or("")
                .trim(),
        )
    };
    let of_integers = |i| field(TEXT, INTEGERS.0, i);
    let of_reals = |i| field(TEXT + INTEGERS.1 / INTEGERS.0.count, REALS.0, i);
    let counted = |i: usize, what: &str| {
        let n = integers[i];
        let (line, text) = of_integers(i);
        if n == NO_INTEGER || n < 0.0 {
            let message = format!("the header does not state {what}: `{text}`");
            return Err(Fault::new(message, line.place(text), "get the record anew"));
        }
        Ok(n as usize)
    };
    let comments = counted(COMMENTS, "how many lines of comment follow")?;
    let points = counted(POINTS, "the number of values")?;
    let is_comment = |i: usize| page.line(i).text.starts_with('|');
    let found = (at..page.lines.len())
        .take_while(|&i| is_comment(i))
        .count();
    if found != comments {
        let (line, text) = of_integers(COMMENTS);
        let message = format!("the header counts {comments} lines of comment, {found} are there");
        return Err(Fault::new(
            message,
            line.place(text),
            "a comment begins with `|`; mend the count",
        ));
    }
    let (line, text) = of_reals(RATE);
    let rate = reals[RATE];
    if rate >= NO_REAL {
        let message = format!("the header does not state the sampling rate: `{text}`");
        let help =
            "such a file has times of its own or has lost its rate; get a record with equal steps";
        return Err(Fault::new(message, line.place(text), help));
    }
    if rate <= 0.0 {
        let message = format!("the sampling rate is {rate} Hz");
        return Err(Fault::new(message, line.place(text), "it is positive"));
    }
    let dt = given.dt(Some(1.0 / rate), 0.0, line.place(text))?;
    let unit = given.unit(Unit::parse("cm/s2"), first.range())?;

    let (values, after) = VALUES.block(page, at + comments, points, "values")?;
    if let Some(line) = page
        .lines
        .get(after..)
        .and_then(|rest| rest.iter().find(|l| !l.is_blank()))
    {
        let message = format!("the header counts {points} values, more are there");
        return Err(Fault::new(
            message,
            line.range(),
            "the header or the values are of another record; get the record anew",
        ));
    }
    two_at_least(points, first.range())?;
    let mut notes = Vec::new();
    let known = |i: usize| (reals[i] < NO_REAL).then(|| of_reals(i).1);
    let (time, peak) = match (known(LARGEST.1), known(SMALLEST.1)) {
        (Some(_), Some(_)) if reals[SMALLEST.1].abs() > reals[LARGEST.1].abs() => SMALLEST,
        _ => LARGEST,
    };
    let stated = Stated {
        peak: known(peak),
        time: known(time),
        length: None,
        place: of_reals(peak).0.place(of_reals(peak).1),
    };
    stated.check(&values, dt, &mut notes);
    let text = |i: usize| page.line(i).text.trim().to_owned();
    let station = text(5);
    let component = page
        .line(5)
        .after("component=")
        .map_or("", str::trim)
        .to_owned();
    Ok(Motion {
        format: Format::Smc,
        details: vec![("kind", text(0)), ("event", text(3)), ("station", station)],
        channels: vec![Channel {
            name: if component.is_empty() || number(&component).is_none() && component.len() > 20 {
                "1".into()
            } else {
                component
            },
            unit,
            samples: Samples::every(dt, values.iter().map(|a| a * unit.factor).collect()),
            place: page.line(at + comments).range(),
        }],
        notes,
    })
}
