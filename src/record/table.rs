//! `trajectory.csv`, `events.csv`, and `csv-metadata.json`, which says units and meanings.
//!
//! A CSV file has one header line, so that every reader of tables takes it as it is. The units are
//! in `csv-metadata.json`, the file that the W3C recommendation "Metadata Vocabulary for Tabular
//! Data" (2015) names for tables in the same folder; the unit is an annotation `schema:unitText`.

use std::io::{self, Write};

use serde::Serialize;

use super::number::push_exact;
use crate::hybrid::Run;
use crate::run::Layout;
use crate::run::ModeNames;
use crate::run::{Column, ColumnKind, EnergyJump, Jump};

/// File name of the samples.
pub const TRAJECTORY: &str = "trajectory.csv";
/// File name of the transitions.
pub const EVENTS: &str = "events.csv";
/// File name of the description of both tables.
pub const METADATA: &str = "csv-metadata.json";

/// Names of the columns of the table of samples.
pub(super) fn trajectory_header(columns: &[Column]) -> Vec<&str> {
    let names = columns.iter().map(|column| column.name.as_str());
    ["t"].into_iter().chain(names).chain(["mode"]).collect()
}

/// Names of the columns of the table of transitions.
pub(super) fn events_header(layout: &Layout) -> Vec<String> {
    let columns = event_columns(layout).into_iter();
    columns.map(|column| column.name).collect()
}

/// The table of samples on its way: `t`, every column of the trajectory by name, `mode` by name.
pub(super) struct TrajectoryTable<W: Write> {
    rows: Rows<W>,
    modes: Named,
}

impl<W: Write> TrajectoryTable<W> {
    pub fn new(out: W, layout: &Layout) -> io::Result<Self> {
        let mut rows = Rows::new(out);
        for name in trajectory_header(&layout.columns()) {
            rows.text(name)?;
        }
        rows.end()?;
        let modes = Named::new(&layout.modes);
        Ok(TrajectoryTable { rows, modes })
    }

    pub fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> io::Result<()> {
        self.rows.number(t)?;
        for &value in values {
            self.rows.number(value)?;
        }
        self.rows.text(self.modes.name(mode))?;
        self.rows.end()
    }

    pub fn finish(self) -> io::Result<W> {
        self.rows.finish()
    }
}

/// Names of modes; that of the last one, which is often asked for again, is kept.
struct Named {
    names: ModeNames,
    last: Option<(usize, String)>,
}

impl Named {
    fn new(names: &ModeNames) -> Self {
        let names = names.clone();
        Named { names, last: None }
    }

    fn name(&mut self, mode: usize) -> &str {
        let names = &self.names;
        let last = self.last.take().filter(|(known, _)| *known == mode);
        let last = last.unwrap_or_else(|| (mode, names.name(mode).into_owned()));
        &self.last.insert(last).1
    }
}

/// The table of transitions on its way: `t,j,transition,from,to`, the state before (`theta.before`, …) and
/// after, reactions and discrete states included, the impulses of contacts and constraints (`left.normal_impulse`), and the jump of
/// the energy: `lost`, `ground_work`, 0 where the transition is no impact.
pub(super) struct EventsTable<W: Write> {
    rows: Rows<W>,
    modes: Named,
}

impl<W: Write> EventsTable<W> {
    pub fn new(out: W, layout: &Layout) -> io::Result<Self> {
        let mut rows = Rows::new(out);
        for name in events_header(layout) {
            rows.text(&name)?;
        }
        rows.end()?;
        let modes = Named::new(&layout.modes);
        Ok(EventsTable { rows, modes })
    }

    /// `values` are those before the transition, those after it, and its impulses.
    pub fn row(&mut self, jump: &Jump, values: &[f64]) -> io::Result<()> {
        let rows = &mut self.rows;
        rows.number(jump.t)?;
        rows.text(&jump.j.to_string())?;
        rows.text(jump.transition)?;
        rows.text(self.modes.name(jump.from))?;
        rows.text(self.modes.name(jump.to))?;
        for &value in values {
            rows.number(value)?;
        }
        let EnergyJump { lost, ground_work } = jump.energy.unwrap_or_default();
        rows.number(lost)?;
        rows.number(ground_work)?;
        rows.end()
    }

    pub fn finish(self) -> io::Result<W> {
        self.rows.finish()
    }
}

/// Writes the samples of a run that is in memory.
pub fn write_trajectory(run: &Run, out: impl Write) -> io::Result<()> {
    let mut table = TrajectoryTable::new(out, &run.layout)?;
    for (i, &t) in run.trajectory.t.iter().enumerate() {
        let mode = run.trajectory.mode[i];
        table.row(t, mode, run.trajectory.row(i))?;
    }
    table.finish().map(drop)
}

/// Writes the transitions of a run that is in memory.
pub fn write_events(run: &Run, out: impl Write) -> io::Result<()> {
    let mut table = EventsTable::new(out, &run.layout)?;
    for event in &run.events {
        let states = event.before.values().chain(event.after.values());
        let values: Vec<f64> = states.chain(event.impulses.iter().copied()).collect();
        table.row(&event.jump(), &values)?;
    }
    table.finish().map(drop)
}

/// Writes the description of both tables.
pub fn write_metadata(run: &Run, out: impl Write) -> io::Result<()> {
    let mut columns = vec![Described::time()];
    columns.extend(run.trajectory.columns.iter().map(Described::quantity));
    columns.push(Described::text("mode", "mode of the system"));
    let tables = Tables {
        context: "http://www.w3.org/ns/csvw",
        tables: [
            Table {
                url: TRAJECTORY,
                schema: Schema { columns },
            },
            Table {
                url: EVENTS,
                schema: Schema {
                    columns: event_columns(&run.layout),
                },
            },
        ],
    };
    let mut out = out;
    serde_json::to_writer_pretty(&mut out, &tables)?;
    writeln!(out)
}

/// Name and description of each column of the table of events.
fn event_columns(layout: &Layout) -> Vec<Described> {
    let mut columns = vec![
        Described::time(),
        Described {
            name: "j".into(),
            meaning: "number of transitions up to and including this one".into(),
            datatype: "integer",
            unit: None,
        },
        Described::text("transition", "name of the transition"),
        Described::text("from", "mode left"),
        Described::text("to", "mode entered"),
    ];
    for side in ["before", "after"] {
        let state = layout
            .columns()
            .into_iter()
            .filter(|c| c.group.is_of_the_state());
        columns.extend(state.map(|c| {
            let name = format!("{}.{side}", c.name);
            let meaning = format!("{}, {side} the transition", c.meaning);
            Described::quantity(&Column { name, meaning, ..c })
        }));
    }
    columns.extend(layout.impulses.iter().map(|impulse| {
        Described::quantity(&Column {
            name: impulse.name.clone(),
            unit: impulse.unit.clone(),
            meaning: format!("{} at the transition", impulse.meaning),
            group: ColumnKind::Output,
        })
    }));
    for (name, meaning) in [
        (
            "lost",
            "energy lost at the impact, in the frame of what is struck",
        ),
        (
            "ground_work",
            "work of the ground's impulse under the ground's motion, inertial frame",
        ),
    ] {
        columns.push(Described::quantity(&Column {
            name: name.into(),
            unit: "J".into(),
            meaning: meaning.into(),
            group: ColumnKind::Energy,
        }));
    }
    columns
}

#[derive(Serialize)]
struct Tables {
    #[serde(rename = "@context")]
    context: &'static str,
    tables: [Table; 2],
}

#[derive(Serialize)]
struct Table {
    url: &'static str,
    #[serde(rename = "tableSchema")]
    schema: Schema,
}

#[derive(Serialize)]
struct Schema {
    columns: Vec<Described>,
}

/// A column, as the metadata describes it.
#[derive(Serialize)]
struct Described {
    name: String,
    #[serde(rename = "dc:description")]
    meaning: String,
    datatype: &'static str,
    #[serde(rename = "schema:unitText", skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
}

impl Described {
    fn time() -> Described {
        Described {
            name: "t".into(),
            meaning: "time".into(),
            datatype: "double",
            unit: Some("s".into()),
        }
    }
    fn text(name: &str, meaning: &str) -> Described {
        Described {
            name: name.into(),
            meaning: meaning.into(),
            datatype: "string",
            unit: None,
        }
    }
    fn quantity(column: &Column) -> Described {
        Described {
            name: column.name.clone(),
            meaning: column.meaning.clone(),
            datatype: "double",
            unit: Some(column.unit.clone()),
        }
    }
}

/// A CSV writer that formats numbers into one reused buffer.
struct Rows<W: Write> {
    csv: csv::Writer<W>,
    buffer: String,
}

impl<W: Write> Rows<W> {
    fn new(out: W) -> Self {
        Rows {
            csv: csv::Writer::from_writer(out),
            buffer: String::new(),
        }
    }
    fn text(&mut self, text: &str) -> io::Result<()> {
        Ok(self.csv.write_field(text)?)
    }
    fn number(&mut self, x: f64) -> io::Result<()> {
        self.buffer.clear();
        push_exact(&mut self.buffer, x);
        Ok(self.csv.write_field(&self.buffer)?)
    }
    fn end(&mut self) -> io::Result<()> {
        Ok(self.csv.write_record(None::<&[u8]>)?)
    }
    fn finish(self) -> io::Result<W> {
        self.csv.into_inner().map_err(|error| error.into_error())
    }
}
