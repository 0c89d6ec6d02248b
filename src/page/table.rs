//! Tables of a page.

use super::escape::text;
use crate::record::rounded;
use std::fmt::Write;

/// Digits shown; exact numbers are in the files that a command writes.
const DIGITS: usize = 7;

/// What stands in a cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number with its unit, as models write units: `m/s`, or `1`. What is not finite is shown as a dash.
    Number(f64, String),
    /// A unit, for the numbers beside it.
    Unit(String),
}

impl Cell {
    /// A number without a unit.
    pub fn plain(number: f64) -> Cell {
        Cell::Number(number, "1".into())
    }
}

impl From<&str> for Cell {
    fn from(words: &str) -> Cell {
        Cell::Text(words.to_owned())
    }
}

impl From<String> for Cell {
    fn from(words: String) -> Cell {
        Cell::Text(words)
    }
}

/// A table with a head.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// Words over each column, and the unit of its numbers if it has one.
    heads: Vec<(String, Option<String>)>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table with these words over its columns.
    pub fn new<T: Into<String>>(heads: impl IntoIterator<Item = T>) -> Table {
        Table {
            heads: heads.into_iter().map(|head| (head.into(), None)).collect(),
            rows: Vec::new(),
        }
    }

    /// Says beside the head of a column which unit its numbers have.
    pub fn unit(mut self, column: usize, unit: &str) -> Table {
        self.heads[column].1 = Some(unit.to_owned());
        self
    }

    /// Appends a row.
    pub fn row<T: Into<Cell>>(&mut self, cells: impl IntoIterator<Item = T>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Whether a column has numbers.
    fn is_of_numbers(&self, column: usize) -> bool {
        let mut cells = self.rows.iter().filter_map(|row| row.get(column));
        cells.any(|cell| matches!(cell, Cell::Number(..)))
    }

    pub(super) fn html(&self) -> String {
        let class = |column| match self.is_of_numbers(column) {
            true => " class=\"n\"",
            false => "",
        };
        let mut out = String::from("<div class=\"scroll\"><table><thead><tr>");
        for (i, (words, unit)) in self.heads.iter().enumerate() {
            let _ = match unit {
                None => write!(out, "<th{}>{}</th>", class(i), text(words)),
                Some(unit) => {
                    let (words, unit) = (text(words), text(unit));
                    let label = format!("data-label=\"{words}\" data-unit=\"{unit}\"");
                    write!(out, "<th{} {label}>{words} / {unit}</th>", class(i))
                }
            };
        }
        out.push_str("</tr></thead><tbody>\n");
        for row in &self.rows {
            out.push_str("<tr>");
            for (i, cell) in row.iter().enumerate() {
                let class = class(i);
                let _ = match cell {
                    Cell::Text(words) => write!(out, "<td{class}>{}</td>", text(words)),
                    Cell::Unit(unit) => {
                        let unit = text(unit);
                        write!(out, "<td{class} data-unit=\"{unit}\">{unit}</td>")
                    }
                    Cell::Number(x, _) if !x.is_finite() => write!(out, "<td{class}>–</td>"),
                    Cell::Number(x, unit) => {
                        let (unit, shown) = (text(unit), number(*x));
                        let value = format!("data-value=\"{x:e}\" data-unit=\"{unit}\"");
                        write!(out, "<td{class} {value}>{shown}</td>")
                    }
                };
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody></table></div>\n");
        out
    }
}

/// A number as tables and sentences show it.
pub(super) fn number(x: f64) -> String {
    rounded(x, DIGITS).replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_escaped_and_numbers_keep_all_their_digits() {
        let mut table = Table::new(["", "x<y"]).unit(1, "m/s");
        table.row([
            Cell::from("<b>"),
            Cell::Number(-0.1 - 0.2, "m\"".to_owned()),
        ]);
        table.row([Cell::Unit("&".into()), Cell::plain(f64::NAN)]);
        let html = table.html();
        assert!(
            html.contains(
                "<th class=\"n\" data-label=\"x&lt;y\" data-unit=\"m/s\">x&lt;y / m/s</th>"
            )
        );
        assert!(html.contains("<td>&lt;b&gt;</td>"));
        let value = format!(
            "data-value=\"{:e}\" data-unit=\"m&quot;\">−0.3</td>",
            -0.1 - 0.2
        );
        assert!(html.contains(&value), "{html}");
        assert!(html.contains("<td data-unit=\"&amp;\">&amp;</td><td class=\"n\">–</td>"));
    }
}
