//! Tables for the terminal.

use std::fmt::{self, Display, Formatter};
use std::io;

use comfy_table::{CellAlignment, ContentArrangement, presets};

/// Spaces between columns.
const GAP: u16 = 2;

/// Columns of text, the longest ones wrapped where the terminal is too narrow. Somewhere else than
/// on a terminal a row is a line.
#[derive(Debug)]
pub struct Table {
    table: comfy_table::Table,
    right: Vec<usize>,
}

impl Table {
    /// A table with these heads of columns.
    pub fn new<T: Display>(heads: impl IntoIterator<Item = T>) -> Table {
        let mut table = comfy_table::Table::new();
        table.load_style(presets::NOTHING);
        table.set_header(
            heads
                .into_iter()
                .map(|head| head.to_string())
                .collect::<Vec<_>>(),
        );
        if let Some((terminal_size::Width(width), _)) =
            terminal_size::terminal_size_of(io::stdout())
        {
            table.set_content_arrangement(ContentArrangement::Dynamic);
            table.set_width(width);
        }
        Table {
            table,
            right: Vec::new(),
        }
    }

    /// Sets these columns to the right: numbers.
    pub fn right(mut self, columns: impl IntoIterator<Item = usize>) -> Table {
        self.right.extend(columns);
        self
    }

    /// Appends a row.
    pub fn row<T: Display>(&mut self, cells: impl IntoIterator<Item = T>) {
        let cells: Vec<String> = cells.into_iter().map(|cell| cell.to_string()).collect();
        self.table.add_row(cells);
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let mut table = self.table.clone();
        for (i, column) in table.column_iter_mut().enumerate() {
            column.set_padding((0, GAP));
            if self.right.contains(&i) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        f.write_str(&table.trim_fmt())
    }
}
