//! How pictures look, where the reader has a choice.

use super::format::Format;
use crate::record::{Column, ColumnKind, Layout, Units};

/// Least width and height of a picture, in pixels: below that labels cover each other.
pub const LEAST: (f64, f64) = (320.0, 200.0);

/// How pictures look; by default everything, in the size and the units that suit it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Appearance {
    /// Units of axes.
    pub units: Units,
    /// What is shown of time, from and to, s; the whole run where there is none.
    pub window: Option<(f64, f64)>,
    /// Width and height in pixels. A picture of panels is higher where they would be lower than can be read.
    pub size: Option<(f64, f64)>,
    /// The panels, from top to bottom, each by a column, by columns of the same unit as `theta+x`, or by a group of
    /// columns, which is divided as it suits; everything where there is none.
    pub panels: Vec<String>,
    /// Formats of the files; SVG where there is none.
    pub formats: Vec<Format>,
}

/// Columns that are asked for in one panel, or a whole group.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Asked {
    Columns(Vec<usize>),
    Group(ColumnKind),
}

/// The groups by the words for them.
const GROUPS: [(&str, ColumnKind); 6] = [
    ("coordinates", ColumnKind::Coordinate),
    ("velocities", ColumnKind::Velocity),
    ("outputs", ColumnKind::Output),
    ("reactions", ColumnKind::Reaction),
    ("energies", ColumnKind::Energy),
    ("inputs", ColumnKind::Input),
];

impl Appearance {
    /// Formats of the files.
    pub fn formats(&self) -> &[Format] {
        match self.formats[..] {
            [] => &[Format::Svg],
            _ => &self.formats,
        }
    }

    /// The panels that are asked for, of a run with this layout.
    ///
    /// # Errors
    /// Says which column there is not, or which columns do not fit together.
    pub(crate) fn asked(&self, layout: &Layout) -> Result<Vec<Asked>, String> {
        let columns = layout.columns();
        self.panels
            .iter()
            .map(|panel| asked(panel, &columns))
            .collect()
    }

    /// Whether the panels are those of this layout.
    ///
    /// # Errors
    /// Says which column there is not, or which columns do not fit together.
    pub fn check(&self, layout: &Layout) -> Result<(), String> {
        self.asked(layout).map(|_| ())
    }
}

fn asked(panel: &str, columns: &[Column]) -> Result<Asked, String> {
    if let Some((_, group)) = GROUPS.iter().find(|(words, _)| *words == panel) {
        return Ok(Asked::Group(*group));
    }
    let mut found = Vec::new();
    for name in panel.split('+') {
        let Some(i) = columns.iter().position(|column| column.name == name) else {
            let names = columns.iter().map(|column| column.name.as_str());
            let known: Vec<&str> = GROUPS.iter().map(|g| g.0).chain(names).collect();
            return Err(format!(
                "there is no panel `{name}`; write some of {}, or what is recorded of it in the scene",
                known.join(", ")
            ));
        };
        if let Some(&first) = found.first() {
            let (a, b): (&Column, &Column) = (&columns[first], &columns[i]);
            if a.unit != b.unit {
                let (of_a, of_b) = (&a.unit, &b.unit);
                return Err(format!(
                    "`{}` in {of_a} and `{name}` in {of_b} do not fit into one panel; write `{},{name}`",
                    a.name, a.name
                ));
            }
        }
        found.push(i);
    }
    Ok(Asked::Columns(found))
}

/// What of a curve is in a window of abscissas that do not decrease, with the points of the straight line through its
/// borders.
pub(crate) fn windowed(
    points: impl Iterator<Item = (f64, f64)>,
    window: Option<(f64, f64)>,
) -> Vec<(f64, f64)> {
    let Some((from, to)) = window else {
        return points.collect();
    };
    let mut kept = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for point in points {
        for border in [from, to] {
            if let Some(before) = before
                && before.0 < border
                && border < point.0
            {
                let part = (border - before.0) / (point.0 - before.0);
                kept.push((border, before.1 + (point.1 - before.1) * part));
            }
        }
        if (from..=to).contains(&point.0) {
            kept.push(point);
        }
        before = Some(point);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Quantity;

    #[test]
    fn a_window_cuts_lines_at_its_borders() {
        let line = [(0.0, 0.0), (2.0, 2.0), (2.0, 5.0), (4.0, 7.0)];
        let cut = |window| windowed(line.into_iter(), window);
        assert_eq!(cut(None), line);
        assert_eq!(
            cut(Some((1.0, 3.0))),
            [(1.0, 1.0), (2.0, 2.0), (2.0, 5.0), (3.0, 6.0)]
        );
        assert_eq!(cut(Some((0.5, 1.5))), [(0.5, 0.5), (1.5, 1.5)]);
        assert_eq!(cut(Some((2.0, 2.0))), [(2.0, 2.0), (2.0, 5.0)]);
        assert_eq!(cut(Some((5.0, 6.0))), []);
    }

    #[test]
    fn panels_are_columns_or_groups_and_mistakes_are_named() {
        let layout = Layout {
            coordinates: vec![Quantity::new("x", "m", ""), Quantity::new("a", "rad", "")],
            ..Layout::default()
        };
        let appearance = |panels: &[&str]| Appearance {
            panels: panels.iter().map(|p| (*p).to_owned()).collect(),
            ..Appearance::default()
        };
        let asked = appearance(&["energies", "x"]).asked(&layout).unwrap();
        assert_eq!(
            asked,
            [Asked::Group(ColumnKind::Energy), Asked::Columns(vec![0])]
        );
        let error = appearance(&["z"]).check(&layout).unwrap_err();
        assert!(
            error.contains("`z`") && error.contains("coordinates"),
            "{error}"
        );
        let error = appearance(&["x+a"]).check(&layout).unwrap_err();
        assert!(error.contains("`x,a`"), "{error}");
    }
}
