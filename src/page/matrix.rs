//! Every run of a study as a point in plots of its columns against each other: what is marked in one is marked in all, and a
//! click shows the command that makes a run again.

use serde::Serialize;

use super::Page;

/// The script that draws it (`data.matrix`).
pub(super) const SCRIPT: &str = include_str!("assets/matrix.js");

/// Where the script puts its parts.
const PLACE: &str = "<div class=\"bar\" id=\"columns\"></div>\n<div id=\"matrix\"></div>\n\
<p id=\"told\" class=\"faint\">&nbsp;</p>\n<pre id=\"command\" hidden></pre>\n";

/// The points.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Matrix {
    /// What can be plotted.
    pub columns: Vec<MatrixColumn>,
    /// Which columns are plotted first.
    pub shown: Vec<usize>,
    /// Whether each run failed; `None` where it does not tell. Empty where the study has no failure.
    pub failed: Vec<Option<bool>>,
    /// What is said about each run, and the command that makes it again.
    pub told: Vec<String>,
    pub commands: Vec<String>,
}

/// A column of numbers.
#[derive(Debug, Serialize)]
pub(crate) struct MatrixColumn {
    pub name: String,
    pub unit: String,
    /// NaN, which JSON has as `null`, where there is none.
    pub values: Vec<f64>,
}

impl Page {
    /// Adds the points of a study; a page has them once.
    pub(super) fn matrix(&mut self, matrix: Matrix) {
        self.body.push_str(PLACE);
        self.data.matrix = Some(matrix);
    }
}
