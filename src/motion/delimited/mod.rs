//! Separated columns: one of values and a step, or times and values; any separator, decimal point or
//! decimal comma.

mod names;
mod times;

use names::{Column, columns, quantity, step};

use super::channel::two_at_least;
use super::number::number;
use super::text::{Line, Page};
use super::unit::Measure;
use super::{Channel, Fault, Format, Given, Motion, Note, Samples, Times, Unit};

/// Lines of names before the values: names, and units below them.
const HEADER: usize = 2;

/// How fields are separated.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Separator {
    Blanks,
    Sign(char),
}

/// The file in its parts.
#[derive(Debug)]
struct Parts<'a> {
    comments: Vec<Line<'a>>,
    header: Vec<Line<'a>>,
    rows: Vec<Line<'a>>,
}

fn is_comment(line: &Line) -> bool {
    let text = line.text.trim_start();
    ["#", "%", "!", "//"]
        .iter()
        .any(|mark| text.starts_with(mark))
}

/// Whether a line can hold nothing but numbers.
fn is_numeric(line: &Line) -> bool {
    let numeric = |c: char| c.is_ascii_digit() || "+-.,;|\"eEdD".contains(c) || c.is_whitespace();
    let text = line.text.trim();
    text.chars().all(numeric) && text.contains(|c: char| c.is_ascii_digit())
}

impl<'a> Parts<'a> {
    fn of(page: &Page<'a>) -> Self {
        let lines = page.lines.iter().copied().filter(|line| !line.is_blank());
        let (comments, lines): (Vec<_>, Vec<_>) = lines.partition(is_comment);
        let header = lines.iter().take_while(|line| !is_numeric(line)).count();
        Parts {
            comments,
            header: lines[..header].to_vec(),
            rows: lines[header..].to_vec(),
        }
    }
}

pub(super) fn detect(page: &Page) -> bool {
    let parts = Parts::of(page);
    parts.header.len() <= HEADER && !parts.rows.is_empty()
}

/// The fields of a line without quotes and blanks around them.
fn fields<'a>(text: &'a str, separator: Separator) -> Vec<&'a str> {
    let bare = |field: &'a str| {
        let field = field.trim();
        let inner = field.strip_prefix('"').and_then(|f| f.strip_suffix('"'));
        inner.unwrap_or(field).trim()
    };
    match separator {
        Separator::Blanks => text.split_whitespace().map(bare).collect(),
        Separator::Sign(sign) => {
            let mut quoted = false;
            let split = |c: char| {
                quoted ^= c == '"';
                c == sign && !quoted
            };
            text.split(split).map(bare).collect()
        }
    }
}

/// Separator of the rows, and whether decimals have a comma.
fn separator(parts: &Parts) -> Result<(Separator, bool), Fault> {
    let any = |c: char| {
        parts
            .rows
            .iter()
            .any(|line| is_numeric(line) && line.text.contains(c))
    };
    let first = parts.rows[0];
    for sign in [';', '\t', '|'] {
        if any(sign) {
            return Ok((Separator::Sign(sign), any(',')));
        }
    }
    if !any(',') {
        return Ok((Separator::Blanks, false));
    }
    if any('.') || first.text.contains('"') {
        return Ok((Separator::Sign(','), false));
    }
    // Commas and no points: decimals, or whole numbers separated by commas.
    let text = first.text.trim();
    if text.split_whitespace().count() > 1 && !text.contains(", ") {
        return Ok((Separator::Blanks, true));
    }
    let commas = |text: &str| text.matches(',').count();
    match parts.header.last() {
        Some(names) if commas(names.text) == commas(text) => Ok((Separator::Sign(','), false)),
        Some(names) if commas(names.text) == 0 && commas(text) == 1 => {
            Ok((Separator::Blanks, true))
        }
        _ => Err(Fault::new(
            "the comma may separate columns or decimals here",
            first.range(),
            "name the columns in a first line, or separate them by semicolons",
        )),
    }
}

pub(super) fn read(page: &Page, given: &Given) -> Result<Motion, Fault> {
    let parts = Parts::of(page);
    if parts.rows.is_empty() || parts.header.len() > HEADER {
        return Err(unknown(page, &parts));
    }
    let (separator, comma) = separator(&parts)?;
    let mut motion = Motion {
        format: Format::Csv,
        details: Vec::new(),
        channels: Vec::new(),
        notes: Vec::new(),
    };
    let table = table(&parts, separator, comma)?;
    let names = names(&parts, separator, table.len())?;
    let stated_step = agreed(&parts, step, "steps")?;
    let stated_quantity = agreed(&parts, quantity, "units")?;

    let first = parts.rows[0];
    let named = names.is_some();
    let names = names.unwrap_or_else(|| vec![Column::parse(""); table.len()]);
    let time = match names.iter().position(Column::is_time) {
        // Without names a first column that increases is the time, as in tables of scenes.
        None if !named && table.len() > 1 => Some(0),
        found => found,
    };
    let times = match time {
        Some(column) => {
            let factor = match names[column].measure {
                Some(Measure::Time(factor)) => factor,
                _ => {
                    let message = "the column of times states no unit; it is read in seconds";
                    motion.notes.push(Note::doubt(
                        message,
                        parts.header.last().unwrap_or(&first).range(),
                    ));
                    1.0
                }
            };
            times::times(
                &table[column],
                factor,
                given.dt.or(stated_step),
                &parts,
                &mut motion.notes,
            )?
        }
        None => {
            let dt = given.dt(stated_step, 0.0, first.range())?;
            Times::Every { start: 0.0, dt }
        }
    };
    two_at_least(parts.rows.len(), first.range())?;

    let comment_unit = match stated_quantity {
        Some(Measure::Acceleration(unit)) => Some(unit),
        _ => None,
    };
    let place = parts.header.first().unwrap_or(&first).range();
    let states_unit = |c: &Column| matches!(c.measure, Some(Measure::Acceleration(_)));
    let some_state = names.iter().any(states_unit);
    for (i, name) in names.iter().enumerate().filter(|(i, _)| Some(*i) != time) {
        let label = if name.label.is_empty() {
            (i + 1).to_string()
        } else {
            name.label.clone()
        };
        let unit: Option<Unit> = match (&name.unknown, name.measure) {
            (Some(unknown), _) if !some_state => {
                let known: Vec<_> = Unit::names().collect();
                let help = format!("known: {}", known.join(", "));
                return Err(Fault::new(
                    format!("`{unknown}` is not a unit of acceleration"),
                    place,
                    help,
                ));
            }
            (_, Some(Measure::Acceleration(unit))) => {
                if comment_unit.is_some_and(|other| other != unit) {
                    let message = format!("the comments state another unit than {}", unit.name);
                    motion.notes.push(Note::doubt(message, place.clone()));
                }
                Some(unit)
            }
            (_, None) if !some_state => comment_unit,
            _ => {
                let message = format!(
                    "the column `{label}` is not read: its unit is not one of acceleration"
                );
                motion.notes.push(Note::remark(message, place.clone()));
                continue;
            }
        };
        if unit.is_none()
            && matches!(
                stated_quantity,
                Some(Measure::Velocity | Measure::Displacement | Measure::Counts)
            )
        {
            let message = "the values are not accelerations";
            return Err(Fault::new(
                message,
                parts.comments[0].range(),
                "a record is of accelerations",
            ));
        }
        let unit = given.unit(unit, place.clone())?;
        let values = table[i]
            .iter()
            .map(|(value, _)| value * unit.factor)
            .collect();
        motion.channels.push(Channel {
            name: label,
            unit,
            samples: Samples {
                times: times.clone(),
                values,
            },
            place: first.range(),
        });
    }
    if motion.channels.is_empty() {
        let message = "no column has accelerations";
        return Err(Fault::new(
            message,
            place,
            "name it with its unit, such as `acc_m_s2`",
        ));
    }
    Ok(motion)
}

/// Why a file of no known format is not a table either.
fn unknown(page: &Page, parts: &Parts) -> Fault {
    let first = page.lines.iter().find(|line| !line.is_blank());
    let place = first.map_or(0..0, Line::range);
    if parts.rows.is_empty() && parts.header.len() <= HEADER {
        let message = "the file has no values";
        return Fault::new(message, place, "values follow the names of the columns");
    }
    Fault::new(
        "this is not a record of a known format",
        place,
        "known are PEER AT2, K-NET, KiK-net, ESM, COSMOS V1.20, SMC, CESMD V2, and columns of numbers \
         with names above them; lines that begin with # are comments",
    )
}

/// The columns of numbers, each with its text.
#[allow(clippy::type_complexity)]
fn table<'a>(
    parts: &Parts<'a>,
    separator: Separator,
    comma: bool,
) -> Result<Vec<Vec<(f64, &'a str)>>, Fault> {
    let first = fields(parts.rows[0].text, separator);
    // A separator may end every line.
    let trailing = first.len() > 1 && first.last() == Some(&"");
    let width = first.len() - usize::from(trailing);
    let mut table = vec![Vec::with_capacity(parts.rows.len()); width];
    for line in &parts.rows {
        let mut row = fields(line.text, separator);
        if trailing && row.len() == width + 1 && row.last() == Some(&"") {
            row.pop();
        }
        if row.len() != width {
            let message = format!("{} fields, the lines before have {width}", row.len());
            return Err(Fault::new(
                message,
                line.range(),
                "every line has the same columns",
            ));
        }
        for (column, field) in table.iter_mut().zip(row) {
            if field.is_empty() {
                let message = "a field is empty";
                return Err(Fault::new(
                    message,
                    line.range(),
                    "a record has no gaps; fill them or cut the record",
                ));
            }
            let point;
            let text = if comma && !field.contains('.') {
                point = field.replacen(',', ".", 1);
                &point
            } else {
                field
            };
            let value = number(text).ok_or_else(|| {
                let message = format!("`{field}` is not a finite number");
                Fault::new(message, line.place(field), "every field is a finite number")
            })?;
            column.push((value, field));
        }
    }
    Ok(table)
}

/// What the names of the columns say, if they have names.
fn names(parts: &Parts, separator: Separator, width: usize) -> Result<Option<Vec<Column>>, Fault> {
    let split = |text: &str| {
        let mut names: Vec<String> = Vec::new();
        for field in fields(text, separator) {
            // A unit in brackets belongs to the name before it.
            match names.last_mut() {
                Some(last) if separator == Separator::Blanks && field.starts_with(['[', '(']) => {
                    last.push_str(field);
                }
                _ => names.push(field.to_owned()),
            }
        }
        if names.len() == width + 1 && names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        if width == 1 {
            names = vec![text.trim().trim_matches(['"', ',', ';']).to_owned()];
        }
        names
    };
    let mut lists = Vec::new();
    for line in &parts.header {
        let names = split(line.text);
        if let Some(number) = names.iter().find(|name| number(name).is_some()) {
            let other = names.iter().find(|n| *n != number).map_or("", |n| n);
            let message = format!("`{other}` is not a finite number");
            return Err(Fault::new(
                message,
                line.range(),
                "the line of names has no numbers",
            ));
        }
        if names.len() != width {
            let message = format!(
                "{} names, the lines below have {width} columns",
                names.len()
            );
            return Err(Fault::new(
                message,
                line.range(),
                "every column has one name",
            ));
        }
        lists.push(names);
    }
    let names = match &lists[..] {
        [names] => names.clone(),
        [names, units] => names
            .iter()
            .zip(units)
            .map(|(n, u)| format!("{n} [{u}]"))
            .collect(),
        _ => {
            let listed = parts.comments.iter().find_map(|c| columns(c.text));
            let above = parts.comments.last().map(|line| {
                split(
                    line.text
                        .trim_start()
                        .trim_start_matches(['#', '%', '!', '/']),
                )
            });
            let fits = |names: &Vec<String>| {
                names.len() == width
                    && width > 1
                    && names.iter().any(|n| Column::parse(n).measure.is_some())
            };
            match listed.into_iter().chain(above).find(fits) {
                Some(names) => names,
                None => return Ok(None),
            }
        }
    };
    Ok(Some(names.iter().map(|name| Column::parse(name)).collect()))
}

/// What the comments state, which must be the same everywhere.
fn agreed<T: PartialEq + Copy>(
    parts: &Parts,
    stated: impl Fn(&str) -> Option<T>,
    what: &str,
) -> Result<Option<T>, Fault> {
    let mut found: Option<T> = None;
    for line in &parts.comments {
        match (found, stated(line.text)) {
            (Some(a), Some(b)) if a != b => {
                let message = format!("the comments state different {what}");
                return Err(Fault::new(message, line.range(), "keep the right one"));
            }
            (_, Some(value)) => found = Some(value),
            _ => {}
        }
    }
    Ok(found)
}
