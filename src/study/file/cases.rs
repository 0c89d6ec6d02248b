//! Cases that a study lists, and levels of what varies alone.

use std::path::Path;
use std::sync::Arc;

use super::{Names, factor_of, inside};
use crate::scene::check::Checked;
use crate::scene::error::{SceneError, SceneErrorKind, SceneErrors};
use crate::scene::number::quantity;
use crate::scene::source::{Source, Span};
use crate::scene::tree::{Node, Value};
use crate::scene::{Disk, Files, decode};
use crate::study::design::{Block, Factor, Values};

/// Most values of a range: more than a table can have rows, and a slip of the pen.
const MOST: f64 = 1e9;

/// A CSV file of cases: paths, and rows of values.
pub(super) struct Table {
    pub columns: Vec<Span>,
    rows: Vec<Vec<Span>>,
}

/// The table of cases, where the study names one.
pub(super) fn from_file(root: &Node, folder: &Path) -> Result<Option<Table>, SceneErrors> {
    let Some(node) = root.get("cases") else {
        return Ok(None);
    };
    let Value::Text(file) = &node.value else {
        return Ok(None);
    };
    let path = folder.join(file);
    let bytes = Disk.read(&path).map_err(|error| {
        let kind = SceneErrorKind::Unreadable {
            path: path.clone(),
            reason: error.to_string(),
        };
        let error = SceneError::new(kind, &node.place());
        error.help("the path is relative to the folder of the study")
    })?;
    Ok(Some(Table::read(&decode(&bytes, &path)?)?))
}

impl Table {
    /// Lines of values between commas; empty ones and those that begin with `#` are passed over, the first is that of the paths.
    fn read(source: &Arc<Source>) -> Result<Table, SceneError> {
        let mut lines = Vec::new();
        let mut start = 0;
        for line in source.text.split_inclusive('\n') {
            let text = line.trim();
            if !text.is_empty() && !text.starts_with('#') {
                lines.push(fields(source, start, line));
            }
            start += line.len();
        }
        let whole = Span::new(source, 0..source.text.len());
        let row = |message: String, at: &Span| {
            SceneError::new(SceneErrorKind::Row { message }, at)
                .help("the first line has paths in the scene, each further one values")
        };
        let mut lines = lines.into_iter();
        let columns = lines
            .next()
            .ok_or_else(|| row("the table is empty".into(), &whole.start()))?;
        let rows: Vec<Vec<Span>> = lines.collect();
        for fields in &rows {
            if fields.len() != columns.len() {
                let message = format!("expected {} values, found {}", columns.len(), fields.len());
                return Err(row(message, &fields[0]));
            }
        }
        if rows.is_empty() {
            return Err(row("the table has no rows".into(), &columns[0]));
        }
        Ok(Table { columns, rows })
    }

    /// The factors of its columns, which vary together.
    pub fn block(&self, names: &Names) -> Result<Block, SceneError> {
        let factor = |i: usize| {
            let path = self.columns[i].text();
            let nodes = self.rows.iter().map(|row| node(&row[i]));
            of_nodes(path, nodes.collect(), names)
        };
        Ok(Block {
            factors: (0..self.columns.len())
                .map(factor)
                .collect::<Result<_, _>>()?,
            count: self.rows.len(),
            is_sample: true,
        })
    }
}

/// The fields of a line that begins at a byte.
fn fields(source: &Arc<Source>, start: usize, line: &str) -> Vec<Span> {
    let mut at = start;
    let line = line.trim_end_matches(['\r', '\n']);
    line.split(',')
        .map(|field| {
            let from = at + (field.len() - field.trim_start().len());
            at += field.len() + 1;
            Span::new(source, from..from + field.trim().len())
        })
        .map(|span| inside(&span))
        .collect()
}

/// A value of a table: a number, or a text.
fn node(span: &Span) -> Node {
    let text = span.text().to_owned();
    let value = match text.parse::<f64>() {
        Ok(x) if x.is_finite() => Value::Number(format!("{x:?}")),
        _ => Value::Text(text),
    };
    Node {
        span: span.clone(),
        value,
    }
}

/// A factor with values as they were written.
fn of_nodes(path: &str, nodes: Vec<Node>, names: &Names) -> Result<Factor, SceneError> {
    let factor = names.factor(path);
    let numbers = |nodes: &[Node]| match names.quantity(path) {
        Some(q) => nodes
            .iter()
            .map(|node| match node.value {
                Value::Number(_) | Value::Text(_) => quantity(node, q).map(Some),
                _ => Ok(None),
            })
            .collect::<Result<Option<Vec<f64>>, _>>(),
        None => Ok(nodes
            .iter()
            .map(|node| match &node.value {
                Value::Number(text) => text.parse().ok(),
                _ => None,
            })
            .collect()),
    };
    let values = match numbers(&nodes)? {
        Some(numbers) => Values::Numbers(numbers, nodes.iter().map(|n| n.span.clone()).collect()),
        None => Values::Others(
            nodes
                .into_iter()
                .map(|node| (super::print::label(&node), node))
                .collect(),
        ),
    };
    Ok(Factor { values, ..factor })
}

/// The factors of a list of objects, which vary together.
pub(super) fn block(rows: &Checked, names: &Names) -> Result<Block, SceneError> {
    let list = rows.list();
    let wrong = |message: String, at: &Span| {
        SceneError::new(SceneErrorKind::State { message }, at)
            .help("each case has the same paths, such as { \"parameters.m\": 1, \"initial.x\": 0 }")
    };
    let Some(first) = list.first().filter(|row| !row.entries().is_empty()) else {
        return Err(wrong("there is no case".into(), &rows.place));
    };
    let mut factors = Vec::new();
    for (path, _) in first.entries() {
        let mut values = Vec::new();
        for row in list {
            let Some(value) = row.get(path) else {
                return Err(wrong(format!("this case has no `{path}`"), &row.place));
            };
            if row.entries().len() != first.entries().len() {
                let message = "this case has other paths than the first".to_owned();
                return Err(wrong(message, &row.place));
            }
            values.push(value.clone());
        }
        factors.push(factor_of(path, &values, names));
    }
    Ok(Block {
        factors,
        count: list.len(),
        is_sample: true,
    })
}

/// What varies alone: a list, or a range.
pub(super) fn levels(path: &str, described: &Checked, names: &Names) -> Result<Block, SceneError> {
    if described.is_list() {
        let list = described.list();
        if list.is_empty() {
            let message = format!("`{path}` has no values");
            return Err(SceneError::new(
                SceneErrorKind::State { message },
                &described.place,
            ));
        }
        let factor = factor_of(path, list, names);
        return Ok(Block {
            // Records and other things that are no numbers are members of something larger.
            is_sample: matches!(factor.values, Values::Others(_)),
            factors: vec![factor],
            count: list.len(),
        });
    }
    let numbers = range(described)?;
    let factor = names.factor(path);
    let place = described.place.clone();
    Ok(Block {
        is_sample: false,
        count: numbers.len(),
        factors: vec![Factor {
            values: Values::Numbers(numbers, vec![place]),
            ..factor
        }],
    })
}

/// The numbers of a range.
fn range(described: &Checked) -> Result<Vec<f64>, SceneError> {
    let [from, to] = ["from", "to"].map(|key| super::number(described, key));
    let log = described
        .get("spacing")
        .is_some_and(|spacing| spacing.text() == "log");
    let wrong = |key: &str, value: f64, range: String| {
        let place = described.get(key).map_or(&described.place, |v| &v.place);
        Err(SceneError::new(
            SceneErrorKind::OutOfRange { value, range },
            place,
        ))
    };
    let intervals = match (described.get("count"), described.get("step")) {
        (Some(count), _) if count.number() == 1.0 && from != to => {
            return wrong("count", 1.0, "at least 2 for two ends that differ".into());
        }
        (Some(count), _) => count.number() - 1.0,
        (None, Some(step)) => {
            let step = step.number();
            if log {
                return wrong("step", step, "absent with `\"spacing\": \"log\"`".into());
            }
            let intervals = (to - from) / step;
            // What is as near to a whole number as the rounding of its parts stands for it.
            let whole = intervals.round();
            if !(intervals >= 0.0 && (intervals - whole).abs() <= 4.0 * f64::EPSILON * whole) {
                let range = format!("such that whole steps lead from {from} to {to}");
                return wrong("step", step, range);
            }
            whole
        }
        (None, None) => unreachable!("checked to have one: {described:?}"),
    };
    if intervals >= MOST {
        let key = if described.get("count").is_some() {
            "count"
        } else {
            "step"
        };
        return wrong(
            key,
            intervals + 1.0,
            format!("such that there are at most {MOST:e} values"),
        );
    }
    if log && !(from > 0.0 && to > 0.0) {
        let (key, value) = if from > 0.0 {
            ("to", to)
        } else {
            ("from", from)
        };
        return wrong(key, value, "> 0 with `\"spacing\": \"log\"`".into());
    }
    let count = intervals as usize + 1;
    let at = |i: usize| {
        let part = i as f64 / intervals.max(1.0);
        // The ends are exact.
        if i == 0 {
            from
        } else if i + 1 == count {
            to
        } else if log {
            from * libm::exp(part * libm::log(to / from))
        } else {
            from + part * (to - from)
        }
    };
    Ok((0..count).map(at).collect())
}
