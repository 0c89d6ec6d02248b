//! A study of precision on the terminal and in files.

use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

use super::Precision;
use crate::cli::table::Table;
use crate::precision::{Bound, GIVEN_UP, Measured, Reference, Row, Verdict, method_name};
use crate::record::plot::{Chart, Curve, Dimension};
use crate::record::{FolderError, OutputFolder, Units, exact, rounded};

/// File name of the table, and that of the plot without the format.
const TABLE: &str = "precision.csv";
const PLOT: &str = "precision";
/// Size of the plot, in pixels.
const SIZE: (f64, f64) = (640.0, 420.0);

impl Precision {
    /// Writes the table and the plot.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), FolderError> {
        folder.replace(|files| {
            files.file(TABLE, |out| self.table(out))?;
            let picture = self.chart().picture(SIZE, &self.appearance);
            files.picture(PLOT, &picture, self.appearance.formats())
        })
    }

    fn bound(&self) -> Option<Bound> {
        self.study.reference.as_ref().map(|r| r.bound)
    }

    /// One row a run, numbers with the digits that read back to the same.
    fn table(&self, out: impl Write) -> io::Result<()> {
        let bound = self.bound();
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
            "events in tails",
            "uncertain",
            "energy imbalance [J]",
            "steps",
            "evaluations",
            "time [s]",
        ])?;
        for row in &self.study.rows {
            let found = row.measured();
            let number = |x: Option<f64>| x.map_or(String::new(), exact);
            let count =
                |of: fn(&Measured) -> u64| found.map_or(String::new(), |m| of(m).to_string());
            csv.write_record([
                method_name(row.method).to_owned(),
                found.map_or(String::new(), |m| m.used.clone()),
                exact(row.tolerance),
                outcome(&row.verdict),
                number(found.map(|m| m.error.end)),
                number(bound.map(|b| b.end)),
                number(found.map(|m| m.error.events.time)),
                number(bound.map(|b| b.event_time)),
                count(|m| m.error.events.missed as u64),
                count(|m| m.error.events.extra as u64),
                count(|m| m.error.events.in_tails as u64),
                count(|m| m.uncertain),
                number(found.and_then(|m| m.imbalance)),
                count(|m| m.steps),
                count(|m| m.evaluations),
                number(found.map(|m| m.seconds)),
            ])?;
        }
        csv.flush()
    }

    /// Time over error, a curve a method, and the bound. Errors below the bound are drawn at the bound.
    pub(super) fn chart(&self) -> Chart {
        let bound = self.bound().map_or(0.0, |b| b.end);
        let mut curves: Vec<Curve> = Vec::new();
        for row in &self.study.rows {
            let Some(found) = row.measured() else {
                continue;
            };
            let point = (found.error.end.max(bound), found.seconds);
            let label = method_name(row.method);
            match curves.iter_mut().find(|c| c.label == label) {
                Some(curve) => curve.points.push(point),
                None => curves.push(Curve {
                    label: label.to_owned(),
                    points: vec![point],
                    ..Curve::default()
                }),
            }
        }
        let times = curves.iter().flat_map(|c| &c.points).map(|p| p.1);
        let (low, high) = times.fold((f64::INFINITY, 0.0_f64), |(low, high), t| {
            (low.min(t), high.max(t))
        });
        curves.push(Curve {
            label: "bound of the reference".into(),
            points: vec![(bound, low), (bound, high)],
            ..Curve::default()
        });
        Chart {
            title: self.title.clone(),
            x: Dimension::log("error of the end, relative", "1"),
            y: Dimension::log("time", "s"),
            curves,
            marks: true,
        }
    }
}

/// How a run ended, in words.
pub(super) fn outcome(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Complete(_) => "complete".into(),
        Verdict::Stopped { at, reason } => {
            format!("stopped early at t = {} s: {reason}", rounded(*at, 6))
        }
        Verdict::GivenUp { .. } => format!("given up: takes {GIVEN_UP} times as long as radau"),
        Verdict::Interrupted => "interrupted".into(),
    }
}

/// An error, or that it is below what the reference tells.
fn shown(error: f64, bound: f64) -> String {
    match error <= bound {
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

/// What the table shows of a run, after method and tolerance.
fn cells(verdict: &Verdict, bound: Bound, units: &Units) -> [String; 9] {
    let in_unit = |x: f64, unit: &str| units.show(x, unit).0;
    let only = |word: &str, time: String| {
        let mut cells: [String; 9] = Default::default();
        (cells[0], cells[8]) = (word.to_owned(), time);
        cells
    };
    let found = match verdict {
        Verdict::Complete(found) => found,
        Verdict::Stopped { .. } => return only("stopped early", String::new()),
        Verdict::GivenUp { seconds } => {
            return only("given up", format!("> {}", duration(*seconds)));
        }
        Verdict::Interrupted => return only("interrupted", String::new()),
    };
    let events = &found.error.events;
    [
        shown(found.error.end, bound.end),
        match events.matched {
            0 => "–".to_owned(),
            _ => shown(in_unit(events.time, "s"), in_unit(bound.event_time, "s")),
        },
        events.missed.to_string(),
        events.extra.to_string(),
        events.in_tails.to_string(),
        found
            .imbalance
            .map_or("–".to_owned(), |x| format!("{:.1e}", in_unit(x, "J"))),
        found.steps.to_string(),
        found.evaluations.to_string(),
        duration(found.seconds),
    ]
}

impl Display for Precision {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let study = &self.study;
        if !study.is_complete() {
            let rows = study.rows.iter();
            let there = rows
                .filter(|row| row.verdict != Verdict::Interrupted)
                .count();
            writeln!(
                f,
                "interrupted: {there} of {} runs are there\n",
                study.rows.len()
            )?;
        }
        let Some(reference) = &study.reference else {
            return write!(f, "the reference is not there, so nothing can be compared");
        };
        let heads = self.heads();
        let columns = 1..heads.len();
        let mut table = Table::new(heads).right(columns);
        for row in self.shown_rows(reference.bound) {
            table.row(row);
        }
        writeln!(f, "{table}\n")?;
        for line in self.stopped() {
            writeln!(f, "{line}")?;
        }
        write!(f, "{}", described(reference))?;
        for line in self.advice_lines(reference) {
            write!(f, "\n{line}")?;
        }
        Ok(())
    }
}

impl Precision {
    /// Heads of the table of runs, with the reader's units.
    pub(super) fn heads(&self) -> [String; 11] {
        let unit = |unit: &str| self.appearance.units.show(1.0, unit).1;
        [
            "method",
            "tolerance",
            "end error",
            &format!("event time/{}", unit("s")),
            "missed",
            "extra",
            "in tails",
            &format!("imbalance/{}", unit("J")),
            "steps",
            "evaluations",
            "time",
        ]
        .map(str::to_owned)
    }

    /// The rows, method by method.
    fn sorted(&self) -> Vec<&Row> {
        let mut rows: Vec<&Row> = self.study.rows.iter().collect();
        rows.sort_by_key(|row| method_name(row.method));
        rows
    }

    /// The rows of the table, as [`Precision::heads`] says.
    pub(super) fn shown_rows(&self, bound: Bound) -> Vec<Vec<String>> {
        let row = |row: &Row| {
            let first = [
                method_name(row.method).to_owned(),
                format!("{:.0e}", row.tolerance),
            ];
            let cells = cells(&row.verdict, bound, &self.appearance.units);
            first.into_iter().chain(cells).collect()
        };
        self.sorted().into_iter().map(row).collect()
    }

    /// Which runs stopped early, and why.
    pub(super) fn stopped(&self) -> Vec<String> {
        let is_stopped = |row: &&Row| matches!(row.verdict, Verdict::Stopped { .. });
        let line = |row: &Row| {
            let (method, how) = (method_name(row.method), outcome(&row.verdict));
            format!("{method} at {:.0e} {how}", row.tolerance)
        };
        self.sorted()
            .into_iter()
            .filter(is_stopped)
            .map(line)
            .collect()
    }

    /// What to use for each of the wanted errors.
    pub(super) fn advice_lines(&self, reference: &Reference) -> Vec<String> {
        let line = |&wanted: &f64| match self.study.advice(wanted) {
            Some(row) => format!(
                "for an error of {wanted:.0e}: method {}, tolerance {:.0e}, {}",
                method_name(row.method),
                row.tolerance,
                duration(row.measured().map_or(f64::NAN, |found| found.seconds))
            ),
            None => format!(
                "for an error of {wanted:.0e}: {}",
                no_advice(wanted, reference)
            ),
        };
        self.errors.iter().map(line).collect()
    }
}

/// Why there is no advice for an error.
pub(super) fn no_advice(wanted: f64, reference: &Reference) -> &'static str {
    match wanted <= reference.bound.end {
        true => "the reference itself is not known to that",
        false => "no run reaches it reliably",
    }
}

/// The two runs of a reference.
pub(super) fn compared_with(reference: &Reference) -> String {
    match reference.alone() {
        None => "taylor and radau at a tolerance of 1e-14".to_owned(),
        Some(why) => format!("radau at tolerances of 1e-14 and 1e-13 ({why})"),
    }
}

/// What the runs were compared with, in lines that end.
pub(super) fn described(reference: &Reference) -> String {
    let by = compared_with(reference);
    let (events, bound) = (reference.events(), reference.bound);
    let mut words = format!(
        "reference: {by}, {events} events; known to {:.0e} at the end",
        bound.end
    );
    if events > 0 {
        words += &format!(" and {:.0e} s in an event's time", bound.event_time);
    }
    words.push('\n');
    if let Some(horizon) = &reference.horizon {
        words += &format!(
            "It is not determined beyond event {events}, at t = {} s: {}.\nAll runs end at t = {} s.\n",
            rounded(horizon.until, 6),
            horizon.why,
            rounded(horizon.at, 6),
        );
    }
    words
}
