//! Tables of runs or capacities, as text: columns with names, separated by commas, semicolons, tabs or blanks.

use std::ops::Range;

use super::{Capacity, Data, Stripe};
use crate::motion::{Fault, Note};

/// What a table has.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What a fragility is fitted to.
    pub data: Data,
    /// What has to be known about it.
    pub notes: Vec<Note>,
}

/// What the columns are, for errors.
const COLUMNS: &str = "columns are `im`, `n` and `k` (intensity, runs, failures), or `capacity` and, where runs did not fail, \
                       `censored` (0 or 1)";

/// A line of fields with their places.
type Row<'a> = Vec<(&'a str, Range<usize>)>;

impl Table {
    /// Reads a table. Lines that begin with `#` and empty ones are passed over.
    pub fn read(text: &str) -> Result<Table, Fault> {
        let mut rows = rows(text);
        if rows.is_empty() {
            return Err(Fault::new(
                "the table is empty",
                0..text.len().min(1),
                COLUMNS,
            ));
        }
        let names = rows.remove(0);
        let line = |row: &Row| row[0].1.start..row[row.len() - 1].1.end;
        let mut table = Reader {
            names: &names,
            rows,
            notes: Vec::new(),
        };
        for (i, (name, place)) in names.iter().enumerate() {
            if names[..i].iter().any(|(other, _)| other == name) {
                return Err(Fault::new(
                    format!("the column `{name}` is there twice"),
                    place.clone(),
                    COLUMNS,
                ));
            }
        }
        let has = |name: &str| names.iter().any(|(n, _)| *n == name);
        let known: &[&str] = match (has("capacity"), has("im") || has("n") || has("k")) {
            (true, false) => &["capacity", "censored"],
            (false, true) => &["im", "n", "k"],
            (true, true) => {
                let message = "counts and capacities exclude each other";
                return Err(Fault::new(message, line(&names), COLUMNS));
            }
            (false, false) => {
                let message = "no column has a name that is known here";
                return Err(Fault::new(message, line(&names), COLUMNS));
            }
        };
        if let Some(row) = table.rows.iter().find(|row| row.len() != names.len()) {
            let message = format!(
                "{} fields, but {} columns have names",
                row.len(),
                names.len()
            );
            return Err(Fault::new(
                message,
                line(row),
                "every line has a field for each column",
            ));
        }
        for (name, place) in names.iter().filter(|(name, _)| !known.contains(name)) {
            let message = format!("the column `{name}` is not read");
            table.notes.push(Note::remark(message, place.clone()));
        }
        let data = match known.len() {
            2 => table.capacities()?,
            _ => table.stripes()?,
        };
        if table.rows.is_empty() {
            let message = "the table has names of columns and no rows";
            return Err(Fault::new(message, line(&names), COLUMNS));
        }
        Ok(Table {
            data,
            notes: table.notes,
        })
    }
}

/// The lines that have fields.
fn rows(text: &str) -> Vec<Row<'_>> {
    let start = if text.starts_with('\u{feff}') {
        '\u{feff}'.len_utf8()
    } else {
        0
    };
    let lines = text[start..].split_inclusive('\n').scan(start, |at, line| {
        let place = *at;
        *at += line.len();
        Some((place, line))
    });
    let told =
        lines.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let told: Vec<_> = told.collect();
    let separator = [';', '\t', ',']
        .into_iter()
        .find(|c| told.first().is_some_and(|(_, line)| line.contains(*c)));
    let fields = |(start, line): (usize, &str)| -> Row<'_> {
        let line = &text[start..start + line.len()];
        let pieces: Vec<&str> = match separator {
            Some(sign) => line.trim_end_matches(['\r', '\n']).split(sign).collect(),
            None => line.split_whitespace().collect(),
        };
        let place = |field: &str| {
            let from = field.as_ptr() as usize - text.as_ptr() as usize;
            from..from + field.len()
        };
        let bare = |field| {
            let field: &str = str::trim(field);
            let inner = field.strip_prefix('"').and_then(|f| f.strip_suffix('"'));
            inner.unwrap_or(field)
        };
        pieces
            .into_iter()
            .map(bare)
            .map(|field| (field, place(field)))
            .collect()
    };
    told.into_iter().map(fields).collect()
}

struct Reader<'a> {
    names: &'a Row<'a>,
    rows: Vec<Row<'a>>,
    notes: Vec<Note>,
}

impl<'a> Reader<'a> {
    fn column(&self, name: &str) -> Option<Vec<(&'a str, Range<usize>)>> {
        let place = self.names.iter().position(|(n, _)| *n == name)?;
        Some(self.rows.iter().map(|row| row[place].clone()).collect())
    }

    fn needed(&self, name: &str) -> Result<Vec<(&'a str, Range<usize>)>, Fault> {
        self.column(name).ok_or_else(|| {
            let line = self.names[0].1.start..self.names[self.names.len() - 1].1.end;
            Fault::new(format!("the column `{name}` is missing"), line, COLUMNS)
        })
    }

    fn stripes(&mut self) -> Result<Data, Fault> {
        let (intensities, runs, failures) =
            (self.needed("im")?, self.needed("n")?, self.needed("k")?);
        let mut stripes = Vec::new();
        for ((im, n), k) in intensities.into_iter().zip(runs).zip(failures) {
            let intensity = finite(&im)?;
            if intensity < 0.0 {
                return Err(Fault::new(
                    format!("the intensity {} is negative", im.0),
                    im.1,
                    "an intensity is at least 0",
                ));
            }
            let (runs, failed) = (whole(&n)?, whole(&k)?);
            if failed > runs {
                let message = format!("{failed} failures among {runs} runs");
                return Err(Fault::new(message, k.1, "k is at most n"));
            }
            if intensity == 0.0 && failed > 0 {
                let message = "failures at the intensity 0, where no lognormal fragility has any";
                return Err(Fault::new(
                    message,
                    k.1,
                    "is the column `im` the right one?",
                ));
            }
            if runs == 0 || intensity == 0.0 {
                let why = if runs == 0 {
                    "without runs"
                } else {
                    "at intensity 0"
                };
                self.notes.push(Note::remark(
                    format!("a row {why} says nothing about the fragility"),
                    im.1,
                ));
            }
            stripes.push(Stripe {
                intensity,
                runs,
                failures: failed,
            });
        }
        Ok(Data::Stripes(stripes))
    }

    fn capacities(&mut self) -> Result<Data, Fault> {
        let marks = self.column("censored");
        let mut capacities = Vec::new();
        for (i, field) in self.needed("capacity")?.into_iter().enumerate() {
            let intensity = finite(&field)?;
            if intensity <= 0.0 {
                let message = format!("the capacity {} is not positive", field.0);
                return Err(Fault::new(
                    message,
                    field.1,
                    "a capacity is the intensity of the first failure, above 0",
                ));
            }
            let censored = match marks.as_ref().map(|marks| &marks[i]) {
                None => false,
                Some((mark, place)) => match mark.to_ascii_lowercase().as_str() {
                    "0" | "false" => false,
                    "1" | "true" => true,
                    _ => {
                        let message = format!("`{mark}` is neither 0 nor 1");
                        let help = "1 if the run did not fail up to this intensity, else 0";
                        return Err(Fault::new(message, place.clone(), help));
                    }
                },
            };
            capacities.push(Capacity {
                intensity,
                censored,
            });
        }
        Ok(Data::Capacities(capacities))
    }
}

fn finite((text, place): &(&str, Range<usize>)) -> Result<f64, Fault> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(Fault::new(
            format!("`{text}` is not a finite number"),
            place.clone(),
            "a run without a result is in no row; it is counted neither as a failure nor as a survival",
        )),
    }
}

/// The largest number of runs: doubles count them exactly.
const MOST: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

fn whole((text, place): &(&str, Range<usize>)) -> Result<u64, Fault> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.fract() == 0.0 && value <= MOST => Ok(value as u64),
        _ => {
            let message = format!("`{text}` is not a count");
            Err(Fault::new(
                message,
                place.clone(),
                "runs and failures are whole numbers from 0",
            ))
        }
    }
}
