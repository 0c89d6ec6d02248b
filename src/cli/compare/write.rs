//! A comparison on the terminal and in files.

use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

use super::{Case, Comparison};
use crate::cli::table::Table;
use crate::record::plot::{Chart, Curve, comparison};
use crate::record::{ColumnKind, Failure, FolderError, OutputFolder, Run, exact, rounded};

/// File name of the table.
const TABLE: &str = "comparison.csv";
/// Size of a plot, in pixels.
const PLOT: (f64, f64) = (960.0, 420.0);
/// Digits on the terminal: enough to compare by eye. The exact numbers are in the table.
const DIGITS: usize = 6;

impl Case {
    /// How it ended, in a word.
    pub(super) fn outcome(&self) -> &'static str {
        match &self.run {
            Ok((run, _)) if run.failure.is_none() => "reached end",
            Ok(_) => "stopped early",
            Err(_) => "refused",
        }
    }

    /// Why there is no complete run.
    pub(super) fn reason(&self) -> Option<String> {
        match &self.run {
            Ok((run, _)) => run.failure.as_ref().map(|failure| stopped(run, failure)),
            Err(refusal) => Some(refusal.clone()),
        }
    }
}

/// Why and where a run stopped early.
fn stopped(run: &Run, failure: &Failure) -> String {
    let layout = &run.layout;
    let state = &failure.at.state;
    let names = (layout.coordinates.iter())
        .chain(&layout.velocities)
        .chain(&layout.discretes);
    let values = state.q.iter().chain(&state.v).chain(&state.discrete);
    let state: Vec<String> = names
        .zip(values)
        .map(|(quantity, &value)| format!("{} = {}", quantity.name, rounded(value, DIGITS)))
        .collect();
    format!(
        "{}\nat t = {} s, after {} transitions, in mode {}, {}",
        failure.reason,
        rounded(failure.at.t, DIGITS),
        failure.at.j,
        layout.modes.name(failure.at.mode),
        state.join(", ")
    )
}

impl Display for Comparison<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let cases = &self.cases;
        let numbers = (1..=cases.len()).map(|i| i.to_string());
        let heads = ["".to_owned(), "unit".to_owned()]
            .into_iter()
            .chain(numbers);
        let mut table = Table::new(heads).right(2..2 + cases.len());
        for (i, choice) in self.choices.iter().enumerate() {
            let options = cases.iter().map(|case| case.options[i]);
            table.row([choice, ""].into_iter().chain(options));
        }
        table.row(
            ["outcome", ""]
                .into_iter()
                .chain(cases.iter().map(Case::outcome)),
        );
        for measure in self.measures() {
            let (factor, unit) = self.appearance.units.show(1.0, &measure.unit);
            let value =
                |x: &Option<f64>| x.map_or("–".to_owned(), |x| rounded(x * factor, DIGITS));
            let values = measure.values.iter().map(value);
            table.row([measure.name, unit].into_iter().chain(values));
        }
        write!(f, "{table}")?;
        for (i, case) in cases.iter().enumerate() {
            if let Some(reason) = case.reason() {
                let reason = reason.replace('\n', "\n    ");
                write!(
                    f,
                    "\n\n{}  {}, {}:\n    {reason}",
                    i + 1,
                    case.label(),
                    case.outcome()
                )?;
            }
        }
        Ok(())
    }
}

impl Comparison<'_> {
    /// Writes the table and the plots.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), FolderError> {
        folder.replace(|files| {
            files.file(TABLE, |out| self.table(out))?;
            for i in self.coordinates() {
                let name = self.model.coordinates[i].name;
                let chart = self.chart(i, ColumnKind::Coordinate);
                let picture = chart.picture(PLOT, &self.appearance);
                files.picture(name, &picture, self.appearance.formats())?;
            }
            Ok(())
        })
    }

    /// One row a variant, numbers with the digits that read back to the same.
    fn table(&self, out: impl Write) -> io::Result<()> {
        let measures = self.measures();
        let mut csv = csv::Writer::from_writer(out);
        let names = measures.iter().map(|m| match m.unit.as_str() {
            "1" => m.name.clone(),
            unit => format!("{} [{unit}]", m.name),
        });
        let heads = self.choices.iter().map(|choice| choice.to_string());
        let heads = heads
            .chain(["outcome".to_owned()])
            .chain(names)
            .chain(["reason".to_owned()]);
        csv.write_record(heads)?;
        for (i, case) in self.cases.iter().enumerate() {
            let options = case.options.iter().map(|option| option.to_string());
            let values = measures
                .iter()
                .map(|m| m.values[i].map_or(String::new(), exact));
            let row = options.chain([case.outcome().to_owned()]).chain(values);
            csv.write_record(row.chain([case.reason().unwrap_or_default()]))?;
        }
        csv.flush()
    }

    /// A coordinate or its rate over time, one curve a run.
    pub(super) fn chart(&self, coordinate: usize, group: ColumnKind) -> Chart {
        let curve = |case: &Case| {
            let (run, sketch) = case.run.as_ref().ok()?;
            let column = run.layout.range(group).start + coordinate;
            Some(Curve {
                label: case.label(),
                points: sketch.curve(column).collect(),
                ..Curve::default()
            })
        };
        let curves: Vec<Curve> = self.cases.iter().filter_map(curve).collect();
        let (_, run) = self
            .runs()
            .next()
            .expect("a coordinate is plotted where there is a run");
        let quantities = match group {
            ColumnKind::Velocity => &run.layout.velocities,
            _ => &run.layout.coordinates,
        };
        comparison(&quantities[coordinate], curves)
    }
}
