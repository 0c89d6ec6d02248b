//! PEER NGA: a few header lines, the last with NPTS and DT, then values in rows.

use super::channel::two_at_least;
use super::number::{first_number, free, number, rounding};
use super::text::{Line, Page};
use super::unit::{Measure, measure};
use super::{Channel, Fault, Format, Given, Motion, Samples};

/// Header lines of the longest variant, and some more.
const HEADER: usize = 12;

pub(super) fn detect(page: &Page) -> bool {
    let titles = ["STRONG MOTION DATABASE", "STRONG-MOTION DATA", "PEER NGA"];
    titles.iter().any(|title| page.line(0).has(title)) || counts(page).is_some()
}

/// The line with NPTS.
fn counts<'a>(page: &Page<'a>) -> Option<(usize, Line<'a>)> {
    let (i, line) = page.find(0..HEADER, "NPTS")?;
    (!line.text.trim_start().starts_with('#')).then_some((i, line))
}

pub(super) fn read(page: &Page, given: &Given) -> Result<Motion, Fault> {
    let Some((last, header)) = counts(page) else {
        let message = "no line states NPTS and DT";
        let help = "the last header line is such as `NPTS=   4000, DT=   .0050 SEC`";
        return Err(Fault::new(message, page.line(3).range(), help));
    };
    let (npts, dt) = npts_and_dt(&header, given)?;
    let unit = unit(page, last, given)?;
    let mut values = Vec::new();
    let mut behind = None;
    for (i, line) in page.lines.iter().enumerate().skip(last + 1) {
        // Some close with `*** End data ***`.
        let digits = line.text.contains(|c: char| c.is_ascii_digit());
        if line.is_blank() || values.len() == npts && line.has("END") && !digits {
            continue;
        }
        if values.len() >= npts {
            behind.get_or_insert(*line);
        }
        if let Err(fault) = free(line, &mut values) {
            // A cut file is a matter of its count, not of its last number.
            let cut = page.lines[i + 1..].iter().all(Line::is_blank);
            let at_end = fault.range.end == line.range().end;
            if cut && at_end && values.len() < npts {
                break;
            }
            return Err(fault);
        }
    }
    if values.len() != npts {
        let place = behind.map_or(page.end(), |line| line.range());
        let message = format!(
            "the header has NPTS = {npts}, {} values are there",
            values.len()
        );
        let help = "the file is cut or its header is wrong; get the record anew";
        return Err(Fault::new(message, place, help));
    }
    two_at_least(npts, header.range())?;
    let values = values.iter().map(|a| a * unit.factor).collect();
    let title = page.line(last.saturating_sub(2)).text.trim();
    let name = title.rsplit(',').next().unwrap_or(title).trim();
    Ok(Motion {
        format: Format::At2,
        details: vec![("title", title.to_owned())],
        channels: vec![Channel {
            name: if name.is_empty() {
                "1".into()
            } else {
                name.into()
            },
            unit,
            samples: Samples::every(dt, values),
            place: header.range(),
        }],
        notes: Vec::new(),
    })
}

/// `NPTS=  4000, DT=  .0050 SEC`, or as of old `4000  0.0050  NPTS, DT`.
fn npts_and_dt(line: &Line, given: &Given) -> Result<(usize, f64), Fault> {
    let value = |key: &str| {
        let text = line.after(key)?.trim_start();
        Some(text.strip_prefix(['=', ':']).unwrap_or(text).trim_start())
    };
    let word = |text: &str| {
        let end = text.find([',', ' ', '\t']).unwrap_or(text.len());
        text[..end].to_owned()
    };
    let after = value("NPTS").unwrap_or("");
    let keys_last = !after.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let (npts, dt) = if keys_last
        && line
            .text
            .trim_start()
            .starts_with(|c: char| c.is_ascii_digit())
    {
        let mut words = line.text.split([',', ' ', '\t']).filter(|w| !w.is_empty());
        (
            words.next().unwrap_or("").to_owned(),
            words.next().map(str::to_owned),
        )
    } else {
        // The unit may touch: `DT=0.005SEC`.
        let dt = value("DT").map(|text| match first_number(text) {
            Some((_, rest)) => text[..text.len() - rest.len()].to_owned(),
            None => word(text),
        });
        (word(after), dt)
    };
    let help = "the line is such as `NPTS=   4000, DT=   .0050 SEC`";
    let count = super::number::count(&npts)
        .ok_or_else(|| Fault::new(format!("NPTS is `{npts}`, not a count"), line.range(), help))?;
    let stated = match &dt {
        None => None,
        Some(text) => Some(number(text).ok_or_else(|| {
            Fault::new(format!("DT is `{text}`, not a number"), line.range(), help)
        })?),
    };
    let dt = given.dt(stated, dt.map_or(0.0, |t| rounding(&t)), line.range())?;
    Ok((count, dt))
}

/// What stands before the unit.
const STATEMENTS: [&str; 5] = [
    "UNITS OF",
    "UNITS ARE",
    "UNITS:",
    "UNITS =",
    "ACCELERATION IN",
];

/// From `ACCELERATION TIME SERIES IN UNITS OF G` or `The units are (g)`.
fn unit(page: &Page, last: usize, given: &Given) -> Result<super::Unit, Fault> {
    for i in 0..=last {
        let line = page.line(i);
        let Some(text) = STATEMENTS.iter().find_map(|w| line.after(w)) else {
            continue;
        };
        let word = text.trim_start().trim_start_matches('(');
        let end = word.find([' ', ',', ';', ')', '\t']).unwrap_or(word.len());
        let word = word[..end].trim_end_matches('.');
        let velocity = line.has("VELOCITY") || line.has("DISPLACEMENT");
        return match measure(word) {
            Some(Measure::Acceleration(unit)) if !velocity => given.unit(Some(unit), line.range()),
            _ => {
                let message = format!("the values are not accelerations: `{}`", line.text.trim());
                let help = "read the file of accelerations, which ends in .AT2";
                Err(Fault::new(message, line.range(), help))
            }
        };
    }
    given.unit(None, page.line(last.saturating_sub(1)).range())
}
