//! The table of a study: a row a run, with what varied, what was measured, how it ended and what it took.

mod csv;
#[cfg(feature = "parquet")]
mod parquet;

pub(crate) use self::csv::csv;
#[cfg(feature = "parquet")]
pub(crate) use self::parquet::parquet;

use super::design::{Level, Values};
use super::file::Study;
use super::folder::Finished;
use super::rows::{Row, WORK};

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Column {
    pub name: String,
    /// Unit, `1` where there is none.
    pub unit: String,
    pub meaning: String,
    pub cells: Cells,
}

/// The cells of a column, one a row; `None` where there is no value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cells {
    Numbers(Vec<Option<f64>>),
    Counts(Vec<Option<i64>>),
    Flags(Vec<Option<bool>>),
    Texts(Vec<Option<String>>),
}

/// The table of finished cases, in the order of the cases and of the runs of each.
pub(crate) fn columns(study: &Study, finished: &Finished) -> Vec<Column> {
    let rows: Vec<&Row> = finished.values().flatten().collect();
    let column = |name: &str, unit: &str, meaning: &str, cells| Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        meaning: meaning.to_owned(),
        cells,
    };
    let counts = |of: &dyn Fn(&Row) -> u64| {
        Cells::Counts(rows.iter().map(|row| Some(of(row) as i64)).collect())
    };
    let numbers = |of: &dyn Fn(&Row) -> f64| {
        let present = |x: f64| (!x.is_nan()).then_some(x);
        Cells::Numbers(rows.iter().map(|row| present(of(row))).collect())
    };
    let mut columns = vec![column(
        "case",
        "1",
        "index of the case",
        counts(&|row| row.case),
    )];
    if study.procedure.along().is_some() {
        let runs = finished.values().flat_map(|rows| 0..rows.len() as i64);
        let cells = Cells::Counts(runs.map(Some).collect());
        columns.push(column("run", "1", "number of the run in its case", cells));
    }
    let levels: Vec<Vec<Level>> = rows
        .iter()
        .map(|row| study.design.levels(row.case))
        .collect();
    for (k, factor) in study.design.factors().enumerate() {
        let cells = match factor.values {
            Values::Numbers(..) => Cells::Numbers(
                levels
                    .iter()
                    .map(|levels| match levels[k] {
                        Level::Number(x) => Some(x),
                        Level::Text(_) => None,
                    })
                    .collect(),
            ),
            Values::Others(_) => Cells::Texts(
                levels
                    .iter()
                    .map(|levels| match levels[k] {
                        Level::Text(text) => Some(text.to_owned()),
                        Level::Number(_) => None,
                    })
                    .collect(),
            ),
        };
        let unit = factor.unit.as_deref().unwrap_or("1");
        columns.push(column(&factor.path, unit, "what varied", cells));
    }
    if let Some(along) = study.procedure.along() {
        let unit = along.unit.as_deref().unwrap_or("1");
        let cells = numbers(&|row| row.intensity);
        columns.push(column(
            &along.path,
            unit,
            "what was raised or searched",
            cells,
        ));
    }
    for (i, measure) in study.measures.iter().enumerate() {
        let values = || rows.iter().map(|row| row.values[i]);
        let cells = if measure.what.is_flag() {
            Cells::Flags(
                values()
                    .map(|x| (!x.is_nan()).then_some(x != 0.0))
                    .collect(),
            )
        } else if measure.what.counts() {
            Cells::Counts(
                values()
                    .map(|x| (!x.is_nan()).then_some(x as i64))
                    .collect(),
            )
        } else {
            numbers(&|row| row.values[i])
        };
        columns.push(column(&measure.name, &measure.unit, "measured", cells));
    }
    if study.failure.is_some() {
        let failed = rows.iter().map(|row| row.failed).collect();
        let meaning = "whether the run failed; empty where it does not tell";
        columns.push(column("failed", "1", meaning, Cells::Flags(failed)));
        let undecided = rows.iter().map(|row| Some(row.undecided)).collect();
        let meaning = "whether its tolerance leaves that open";
        columns.push(column("undecided", "1", meaning, Cells::Flags(undecided)));
    }
    let status = rows.iter().map(|row| Some(row.status.word().to_owned()));
    let meaning = "ok; stopped: before its end; refused: not a scene";
    columns.push(column(
        "status",
        "1",
        meaning,
        Cells::Texts(status.collect()),
    ));
    let reasons = rows.iter().map(|row| row.reason.clone()).collect();
    columns.push(column(
        "reason",
        "1",
        "why it is not ok",
        Cells::Texts(reasons),
    ));
    columns.push(column("t", "s", "time reached", numbers(&|row| row.t)));
    columns.push(column(
        "events",
        "1",
        "transitions",
        counts(&|row| row.events),
    ));
    let meaning = "places where it cannot tell whether a guard falls; empty where nobody looked, in vector lanes";
    let uncertain = rows.iter().map(|row| row.uncertain.map(|n| n as i64));
    let cells = Cells::Counts(uncertain.collect());
    columns.push(column("uncertain", "1", meaning, cells));
    for (i, name) in WORK.iter().enumerate() {
        columns.push(column(
            name,
            "1",
            "work of the method",
            counts(&|row| row.work[i]),
        ));
    }
    columns
}

impl Cells {
    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Cells::Numbers(cells) => cells.len(),
            Cells::Counts(cells) => cells.len(),
            Cells::Flags(cells) => cells.len(),
            Cells::Texts(cells) => cells.len(),
        }
    }
}
