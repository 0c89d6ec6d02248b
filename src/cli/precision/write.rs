//! A study of precision on the terminal and in files.

use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

use super::Precision;
use crate::cli::table::Table;
use crate::precision::{Reference, Row, Verdict, method_name};
use crate::record::plot::{Chart, Curve, Dimension};
use crate::record::{FolderError, OutputFolder, exact, rounded};

/// File names of the table and of the plot.
const TABLE: &str = "precision.csv";
const PLOT: &str = "precision.svg";
/// Size of the plot, in pixels.
const SIZE: (f64, f64) = (640.0, 420.0);

impl Precision {
    fn reference(&self) -> &Reference {
        let reference = self.study.reference.as_ref();
        reference.expect("a study is shown once it has its reference")
    }

    /// Writes the table and the plot.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), FolderError> {
        folder.replace(|files| {
            files.file(TABLE, |out| self.table(out))?;
            files.file(PLOT, |out| out.write_all(self.chart().svg(SIZE).as_bytes()))
        })
    }

    /// One row a run, numbers with 17 significant digits.
    fn table(&self, out: impl Write) -> io::Result<()> {
        let bound = &self.reference().bound;
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record([
            "method",
            "used",
            "tolerance",
            "outcome",
            "end error",
            "bound of the end error",
            "event time error [s]",
            "bound of the event time error [s]",
            "missed events",
            "extra events",
            "energy imbalance [J]",
            "steps",
            "evaluations",
            "time [s]",
        ])?;
        for row in &self.study.rows {
            let number = |x: Option<f64>| x.map_or(String::new(), exact);
            let count = |x: Option<usize>| x.map_or(String::new(), |n| n.to_string());
            let error = row.error.as_ref();
            let complete = error.is_some();
            csv.write_record([
                method_name(row.method).to_owned(),
                row.used.clone(),
                exact(row.tolerance),
                outcome(row),
                number(error.map(|e| e.end)),
                exact(bound.end),
                number(error.map(|e| e.events.time)),
                exact(bound.events.time),
                count(error.map(|e| e.events.missed)),
                count(error.map(|e| e.events.extra)),
                number(row.imbalance),
                row.steps.to_string(),
                row.evaluations.to_string(),
                number(complete.then_some(row.seconds)),
            ])?;
        }
        csv.flush()
    }

    /// Time over error, a curve a method. Errors below the bound are drawn at the bound.
    fn chart(&self) -> Chart {
        let bound = self.reference().bound.end;
        let mut curves: Vec<Curve> = Vec::new();
        for row in &self.study.rows {
            let Some(error) = &row.error else { continue };
            let label = method_name(row.method);
            let curve = match curves.iter_mut().position(|c| c.label == label) {
                Some(i) => &mut curves[i],
                None => {
                    curves.push(Curve {
                        label: label.to_owned(),
                        points: Vec::new(),
                    });
                    curves.last_mut().expect("it was pushed")
                }
            };
            curve.points.push((error.end.max(bound), row.seconds));
        }
        Chart {
            title: self.title.clone(),
            x: Dimension::log("error of the end over typical sizes", "1"),
            y: Dimension::log("time", "s"),
            curves,
            marks: true,
        }
    }
}

/// How a row ended, in words.
fn outcome(row: &Row) -> String {
    match &row.verdict {
        Verdict::Complete => "complete".into(),
        Verdict::Stopped(reason) => format!("stopped early: {reason}"),
        Verdict::GivenUp => "given up: takes many times as long as radau".into(),
    }
}

/// An error, or that it is below what the reference tells.
fn shown(error: f64, bound: f64) -> String {
    match error <= bound {
        _ if error == 0.0 => "0".into(),
        true => format!("≤ {bound:.0e}"),
        false => format!("{error:.1e}"),
    }
}

/// A duration with a unit that suits it.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{} µs", rounded(s * 1e6, 3)),
        s if s < 1.0 => format!("{} ms", rounded(s * 1e3, 3)),
        s => format!("{} s", rounded(s, 3)),
    }
}

impl Display for Precision {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let (study, reference) = (&self.study, self.reference());
        let bound = &reference.bound;
        let heads = [
            "method",
            "tolerance",
            "end error",
            "event time/s",
            "missed",
            "extra",
            "imbalance/J",
            "steps",
            "evaluations",
            "time",
        ];
        let mut table = Table::new(heads).right(1..heads.len());
        let mut rows: Vec<&Row> = study.rows.iter().collect();
        rows.sort_by_key(|row| method_name(row.method));
        for row in rows {
            let method = method_name(row.method).to_owned();
            let tolerance = format!("{:.0e}", row.tolerance);
            let Some(error) = &row.error else {
                let none = String::new;
                let word = match row.verdict {
                    Verdict::GivenUp => "given up",
                    _ => "stopped early",
                };
                let rest = [
                    none(),
                    none(),
                    none(),
                    none(),
                    row.steps.to_string(),
                    none(),
                ];
                let cells = [method, tolerance, word.to_owned()].into_iter().chain(rest);
                table.row(cells.chain([format!("> {}", duration(row.seconds))]));
                continue;
            };
            table.row([
                method,
                tolerance,
                shown(error.end, bound.end),
                match error.events.matched {
                    0 => "–".to_owned(),
                    _ => shown(error.events.time, bound.events.time),
                },
                error.events.missed.to_string(),
                error.events.extra.to_string(),
                row.imbalance.map_or("–".to_owned(), |x| format!("{x:.1e}")),
                row.steps.to_string(),
                row.evaluations.to_string(),
                duration(row.seconds),
            ]);
        }
        writeln!(f, "{table}\n")?;
        if !study.complete {
            writeln!(f, "interrupted: {} runs are there\n", study.rows.len())?;
        }
        let by = match reference.independent {
            true => "taylor and radau at a tolerance of 1e-14",
            false => {
                "radau at tolerances of 1e-14 and 1e-13 (there is no other method for this scene)"
            }
        };
        writeln!(
            f,
            "reference: {by}, {} events; the two differ by {:.0e} at the end and {:.0e} s in an event's time",
            reference.events(),
            bound.end,
            bound.events.time,
        )?;
        if bound.events.until.is_finite() {
            writeln!(
                f,
                "They have the same events up to t = {} s only: after that the scene does not determine its \
                 events to double precision, and no row is right or wrong.",
                rounded(bound.events.until, 6)
            )?;
        }
        if let Some(failure) = reference.failure() {
            writeln!(
                f,
                "It stopped early at t = {} s: {}",
                rounded(failure.at.t, 6),
                failure.reason
            )?;
        }
        for &wanted in &self.errors {
            match study.advice(wanted).row.map(|i| &study.rows[i]) {
                Some(row) => write!(
                    f,
                    "\nfor an error of {wanted:.0e}: method {}, tolerance {:.0e}, {}",
                    method_name(row.method),
                    row.tolerance,
                    duration(row.seconds)
                )?,
                None => write!(f, "\nfor an error of {wanted:.0e}: no run reaches it")?,
            }
        }
        Ok(())
    }
}
