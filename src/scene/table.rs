//! Tables in CSV: two columns, time and value.

use std::sync::Arc;

use super::error::{SceneError, SceneErrorKind};
use super::source::{Source, Span};

/// The rows of a file.
#[derive(Debug)]
pub(crate) struct Rows {
    pub times: Vec<f64>,
    pub values: Vec<f64>,
    source: Arc<Source>,
    /// Where each row starts, in bytes.
    starts: Vec<usize>,
}

/// Reads a file of two columns. Empty lines and lines that begin with `#` are skipped; a first
/// line without any number is a header.
pub(crate) fn read(source: &Arc<Source>) -> Result<Rows, SceneError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(source.text.as_bytes());
    let mut rows = Rows {
        times: Vec::new(),
        values: Vec::new(),
        source: Arc::clone(source),
        starts: Vec::new(),
    };
    let mut record = csv::StringRecord::new();
    let mut first = true;
    loop {
        let start = reader.position().byte() as usize;
        let more = reader.read_record(&mut record).map_err(|error| {
            let kind = SceneErrorKind::Row {
                message: format!("not CSV: {error}"),
            };
            SceneError::new(kind, &rows.field(start, 0))
        })?;
        if !more {
            return Ok(rows);
        }
        let is_header = first && record.iter().all(|field| field.parse::<f64>().is_err());
        first = false;
        if is_header {
            continue;
        }
        if record.len() != 2 {
            let message = format!("expected two columns, found {}", record.len());
            return Err(
                SceneError::new(SceneErrorKind::Row { message }, &rows.field(start, 0))
                    .help("each row is `time,value`, separated by a comma"),
            );
        }
        let number = |column: usize| {
            let text = &record[column];
            let kind = match text.parse::<f64>() {
                Ok(number) if number.is_finite() => return Ok(number),
                Ok(_) => SceneErrorKind::NotFinite {
                    text: text.to_owned(),
                },
                Err(_) => SceneErrorKind::Row {
                    message: format!("`{text}` is not a number"),
                },
            };
            Err(SceneError::new(kind, &rows.field(start, column))
                .help("each row is `time,value`, two finite numbers"))
        };
        let (time, value) = (number(0)?, number(1)?);
        rows.times.push(time);
        rows.values.push(value);
        rows.starts.push(start);
    }
}

impl Rows {
    /// Where a row has its time (column 0) or its value (column 1); behind the last row, the end
    /// of the text.
    pub fn place(&self, row: usize, column: usize) -> Span {
        self.field(
            self.starts
                .get(row)
                .copied()
                .unwrap_or(self.source.text.len()),
            column,
        )
    }

    /// A field of the record that starts at a byte, or after the lines there that are skipped.
    fn field(&self, start: usize, column: usize) -> Span {
        let text = &self.source.text;
        let mut start = start.min(text.len());
        let skipped = |line: &str| line.trim().is_empty() || line.starts_with('#');
        for line in text[start..]
            .split_inclusive('\n')
            .take_while(|line| skipped(line))
        {
            start += line.len();
        }
        let line = text[start..].lines().next().unwrap_or("");
        // A quoted field may hold anything; then the whole line is shown.
        let field = if line.contains('"') {
            None
        } else {
            line.split(',').nth(column)
        };
        let before: usize = match field {
            Some(_) => line
                .split(',')
                .take(column)
                .map(|field| field.len() + 1)
                .sum(),
            None => 0,
        };
        let field = field.unwrap_or(line);
        let offset = start + before + (field.len() - field.trim_start().len());
        Span::new(&self.source, offset..offset + field.trim().len())
    }
}
