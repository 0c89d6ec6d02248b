//! The files of a study's result.

use super::capacities::CaseCapacity;
use super::charts;
use super::file::Study;
use super::folder::{Finished, SUMMARY, StudyFolder, StudyFolderError};
use super::summary::{Outcome, shown};
use super::table::{self, Cells, Column};

/// File names.
const STUDY: &str = "study.json";
#[cfg(feature = "parquet")]
const PARQUET: &str = "runs.parquet";
const CSV: &str = "runs.csv";
const CAPACITIES: &str = "capacities.csv";
const PAGE: &str = "study.html";

/// Makes the page of a study, of its table and its summary.
pub(crate) type MakePage<'m> = dyn Fn(&Outcome, &[Column], &serde_json::Value) -> String + 'm;

/// What the terminal shows of a finished study.
pub(crate) struct Found {
    /// The summary as it was written.
    pub summary: serde_json::Value,
    /// Names of the files, in the order in which they were written.
    pub files: Vec<&'static str>,
}

/// Writes all files into the study's folder and clears what was kept. `csv`: whether the table is written as CSV besides Parquet.
pub(crate) fn finish(
    study: &Study,
    folder: &StudyFolder,
    finished: &Finished,
    csv: bool,
    page: &MakePage,
) -> Result<Found, StudyFolderError> {
    let outcome = Outcome::new(study, finished);
    let columns = table::columns(study, finished);
    let mut files = Vec::new();
    let mut write = |name: &'static str, contents: &[u8]| {
        folder.write(name, contents)?;
        files.push(name);
        Ok::<(), StudyFolderError>(())
    };
    write(STUDY, study.text.as_bytes())?;
    #[cfg(feature = "parquet")]
    write(PARQUET, &bytes(table::parquet(&columns)))?;
    if csv || cfg!(not(feature = "parquet")) {
        write(CSV, &bytes(table::csv(&columns)))?;
    }
    if !outcome.capacities.is_empty() {
        let columns = capacity_columns(study, &outcome.capacities);
        write(CAPACITIES, &bytes(table::csv(&columns)))?;
    }
    let summary = outcome.json(&columns);
    for (name, picture) in charts::files(&outcome, &columns) {
        write(name, picture.as_bytes())?;
    }
    write(PAGE, page(&outcome, &columns, &summary).as_bytes())?;
    write(SUMMARY, format!("{summary:#}\n").as_bytes())?;
    folder.clear()?;
    Ok(Found { summary, files })
}

/// A table that was written into memory, where nothing can fail.
fn bytes<E: std::fmt::Display>(table: Result<Vec<u8>, E>) -> Vec<u8> {
    table.unwrap_or_else(|error| panic!("a table is written into memory: {error}"))
}

/// A row a case, as `dalembert fragility` reads it.
fn capacity_columns(study: &Study, capacities: &[CaseCapacity]) -> Vec<Column> {
    let column = |name: &str, cells| Column {
        name: name.to_owned(),
        unit: "1".into(),
        meaning: String::new(),
        cells,
    };
    let known: Vec<&CaseCapacity> = capacities.iter().collect();
    let numbers = |of: &dyn Fn(&CaseCapacity) -> Option<f64>| {
        Cells::Numbers(known.iter().map(|c| of(c)).collect())
    };
    let counts = |of: &dyn Fn(&CaseCapacity) -> Option<i64>| {
        Cells::Counts(known.iter().map(|c| of(c)).collect())
    };
    let mut columns = vec![column("case", counts(&|c| Some(c.case as i64)))];
    for (k, factor) in study.design.factors().enumerate() {
        let value = |c: &&CaseCapacity| Some(shown(study.design.levels(c.case)[k]));
        let cells = Cells::Texts(known.iter().map(value).collect());
        columns.push(column(&factor.path, cells));
    }
    columns.extend([
        column("capacity", numbers(&|c| c.capacity.map(|c| c.intensity))),
        column(
            "censored",
            counts(&|c| c.capacity.map(|c| i64::from(c.censored))),
        ),
        column("below", numbers(&|c| c.bracket.map(|bracket| bracket[0]))),
        column("above", numbers(&|c| c.bracket.map(|bracket| bracket[1]))),
        column("runs", counts(&|c| Some(c.runs as i64))),
        column("undecided", counts(&|c| Some(i64::from(c.undecided)))),
    ]);
    columns
}
