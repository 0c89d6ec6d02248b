//! A table as CSV.

use std::io;

use super::{Cells, Column};
use crate::record::exact;

/// The table with a line of names, `true` and `false`, and numbers with the digits that read back to the same; what is not there
/// is empty.
pub(crate) fn csv(columns: &[Column]) -> io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|column| &column.name))?;
    let rows = columns.first().map_or(0, |column| column.cells.len());
    for row in 0..rows {
        writer.write_record(columns.iter().map(|column| cell(&column.cells, row)))?;
    }
    writer.into_inner().map_err(|error| error.into_error())
}

fn cell(cells: &Cells, row: usize) -> String {
    match cells {
        Cells::Numbers(cells) => cells[row].map(exact),
        Cells::Counts(cells) => cells[row].map(|count| count.to_string()),
        Cells::Flags(cells) => cells[row].map(|flag| flag.to_string()),
        Cells::Texts(cells) => cells[row].clone(),
    }
    .unwrap_or_default()
}
