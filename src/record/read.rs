//! Reads back what [`Run::write`] has written. Every number comes back to the bit.

use std::collections::BTreeMap;
use std::fs::read_to_string;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Duration;

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::folder::check;
use super::kept::{CHECKPOINT, Kept};
use super::summary::{FORMAT, SUMMARY};
use super::table::{EVENTS, TRAJECTORY, events_header, trajectory_header};
use crate::hybrid::Run;
use crate::model::{Model, Variant};
use crate::run::Peak;
use crate::run::Reached;
use crate::run::Recorder;
use crate::run::Tally;
use crate::run::Uncertain;
use crate::run::{
    EnergyJump, Event, HybridState, Jump, Ledger, Sides, Snapshot, Solver, Subject, Trajectory,
};
use crate::run::{Layout, Quantity};

/// Why a run cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub reason: String,
}

/// The version of a summary.
#[derive(Deserialize)]
struct Version {
    #[serde(default = "first")]
    format: u32,
}

/// What summaries have that say nothing.
fn first() -> u32 {
    1
}

/// What is read of `summary.json`; the rest of it follows from the tables.
#[derive(Deserialize)]
struct Written {
    model: String,
    #[serde(default)]
    title: String,
    choices: BTreeMap<String, String>,
    parameters: BTreeMap<String, f64>,
    digests: BTreeMap<String, String>,
    #[serde(default)]
    projected: BTreeMap<String, f64>,
    end: End,
    peaks: BTreeMap<String, Peak>,
    impacts: BTreeMap<String, IgnoredAny>,
    energy: Option<Energy>,
    #[serde(default)]
    uncertain: Uncertain,
    #[serde(flatten)]
    reached: Reached,
    solver: Solver,
    wall_seconds: f64,
}

#[derive(Deserialize)]
struct End {
    t: f64,
    j: u64,
    mode: String,
    q: BTreeMap<String, f64>,
    v: BTreeMap<String, f64>,
    discrete: BTreeMap<String, f64>,
    reactions: BTreeMap<String, f64>,
    outputs: BTreeMap<String, f64>,
}

#[derive(Deserialize)]
struct Energy {
    initial: f64,
    #[serde(rename = "final")]
    final_: f64,
    dissipated: f64,
    input_work: f64,
    lost_at_impacts: f64,
    frame: String,
}

/// A run in a folder: all but its tables, which are read row by row.
#[derive(Debug)]
pub struct Earlier {
    /// The run, without its rows and transitions. The reason why it stopped, if it did, is not read.
    pub run: Run,
    folder: PathBuf,
    /// Names of all transitions.
    transitions: Vec<&'static str>,
    /// Transitions that are impacts.
    impacts: BTreeMap<String, IgnoredAny>,
}

impl Earlier {
    /// Opens the run in a folder, which must be one of this model and variant, with this layout, and compares its
    /// files with their digests.
    pub fn open(
        folder: &Path,
        model: &Model,
        variant: &Variant,
        layout: Layout,
    ) -> Result<Earlier, ReadError> {
        let path = folder.join(SUMMARY);
        let error = |reason| ReadError {
            path: path.clone(),
            reason,
        };
        let text = read_to_string(&path);
        let text = text.map_err(|e| error(format!("cannot read the run: {e}")))?;
        let unlike = |e: serde_json::Error| error(format!("not the summary of a run: {e}"));
        // What another version wrote is not held against what this one would have written.
        if let Ok(Version { format }) = serde_json::from_str(&text)
            && format != FORMAT
        {
            return Err(error(format!(
                "the summary has format {format}, and this version of dalembert reads format {FORMAT}: go on with the version that \
                 wrote it, or run the scene from its start"
            )));
        }
        for name in [SUMMARY, TRAJECTORY, EVENTS] {
            check(folder, name).map_err(|reason| ReadError {
                path: folder.join(name),
                reason,
            })?;
        }
        let written: Written = serde_json::from_str(&text).map_err(unlike)?;
        let subject = subject(&written, model, variant).map_err(error)?;
        let end = end(&written.end, &layout).map_err(error)?;
        let columns = layout.columns();
        let named = columns.iter().enumerate();
        let peaks = named.filter_map(|(i, c)| Some((i, *written.peaks.get(&c.name)?)));
        let peaks = peaks.collect();
        let run = Run {
            subject,
            trajectory: Trajectory {
                columns,
                ..Trajectory::default()
            },
            events: Vec::new(),
            tally: Tally::default(),
            peaks,
            layout,
            end,
            solver: written.solver,
            energy: written.energy.map(|energy| Ledger {
                initial: energy.initial,
                final_: energy.final_,
                dissipated: energy.dissipated,
                input_work: energy.input_work,
                lost_at_impacts: energy.lost_at_impacts,
                frame: energy.frame,
            }),
            error: None,
            uncertain: written.uncertain,
            reached: written.reached,
            wall: Duration::try_from_secs_f64(written.wall_seconds).unwrap_or_default(),
            failure: None,
        };
        Ok(Earlier {
            run,
            folder: folder.to_owned(),
            transitions: transitions(variant),
            impacts: written.impacts,
        })
    }

    /// The last checkpoint of the run, if it took so long that it has one; compared with its digest.
    pub fn checkpoint(&self) -> Result<Option<Kept>, ReadError> {
        let path = self.folder.join(CHECKPOINT);
        if !path.exists() {
            return Ok(None);
        }
        let error = |reason| ReadError {
            path: path.clone(),
            reason,
        };
        check(&self.folder, CHECKPOINT).map_err(error)?;
        let text = read_to_string(&path).map_err(|e| error(e.to_string()))?;
        let kept = serde_json::from_str(&text);
        kept.map(Some)
            .map_err(|e| error(format!("not a checkpoint of a run: {e}")))
    }

    /// Hands on the rows of the trajectory: time, mode, values.
    pub fn rows(
        &self,
        mut take: impl FnMut(f64, usize, &[f64]) -> Result<(), String>,
    ) -> Result<(), ReadError> {
        let layout = &self.run.layout;
        let columns = layout.columns();
        let mut values = vec![0.0; columns.len()];
        let header = trajectory_header(&columns);
        rows(&self.folder.join(TRAJECTORY), &header, |row| {
            let t = row.number()?;
            for value in &mut values {
                *value = row.number()?;
            }
            take(t, mode(layout, row.text()?)?, &values)
        })
    }

    /// Hands on the transitions, with the states before and after them and their impulses, and counts them in the run.
    pub fn events(&mut self, mut take: impl FnMut(&Jump, &Sides)) -> Result<(), ReadError> {
        let (layout, impacts) = (&self.run.layout, &self.impacts);
        let tally = &mut self.run.tally;
        *tally = Tally::default();
        rows(&self.folder.join(EVENTS), &events_header(layout), |row| {
            let (t, j) = (row.number()?, row.parse()?);
            let transition = transition(&self.transitions, row.text()?)?;
            let (from, to) = (mode(layout, row.text()?)?, mode(layout, row.text()?)?);
            let sides = Sides {
                before: snapshot(layout, row)?,
                after: snapshot(layout, row)?,
                impulses: numbers(&layout.impulses, row)?,
            };
            let energy = EnergyJump {
                lost: row.number()?,
                ground_work: row.number()?,
            };
            let jump = Jump {
                t,
                j,
                transition,
                from,
                to,
                energy: impacts.contains_key(transition).then_some(energy),
            };
            tally.note(&jump);
            take(&jump, &sides);
            Ok(())
        })
    }
}

impl Run {
    /// Reads the run in a folder into memory, as [`Earlier::open`] does.
    pub fn read(
        folder: &Path,
        model: &Model,
        variant: &Variant,
        layout: Layout,
    ) -> Result<Run, ReadError> {
        let mut earlier = Earlier::open(folder, model, variant, layout)?;
        let mut recorder = Recorder::new(&earlier.run.layout, 0);
        earlier.rows(|t, mode, values| {
            recorder.push_row(t, mode, |row| row.copy_from_slice(values));
            Ok(())
        })?;
        let mut events = Vec::new();
        earlier.events(|jump, sides| events.push(Event::new(jump, sides.clone())))?;
        Ok(Run {
            trajectory: recorder.finish(),
            events,
            ..earlier.run
        })
    }
}

/// What the run was of: the model and variant that it must be of.
fn subject(written: &Written, model: &Model, variant: &Variant) -> Result<Subject, String> {
    if written.model != model.name {
        return Err(format!(
            "a run of the model `{}`, not `{}`",
            written.model, model.name
        ));
    }
    let mut choices = Vec::new();
    for (choice, option) in model.choices.iter().zip(&variant.options) {
        match written.choices.get(choice.name) {
            Some(was) if was == option => choices.push((choice.name.into(), was.clone())),
            was => {
                let was = was.map_or("not stated", String::as_str);
                return Err(format!("`{}` was {was} and is {option} now", choice.name));
            }
        }
    }
    let names = model.parameters.iter().map(|p| p.name);
    let parameters = names.clone().zip(values(names, &written.parameters)?);
    Ok(Subject {
        model: written.model.clone(),
        title: written.title.clone(),
        choices,
        parameters: parameters
            .map(|(name, value)| (name.into(), value))
            .collect(),
        digests: (written.digests.iter())
            .map(|(part, digest)| (part.clone(), digest.clone()))
            .collect(),
        projected: (written.projected.iter())
            .map(|(name, change)| (name.clone(), *change))
            .collect(),
    })
}

/// The values of these names, in their order.
fn values<'a>(
    names: impl Iterator<Item = &'a str>,
    map: &BTreeMap<String, f64>,
) -> Result<Vec<f64>, String> {
    let value = |name| {
        map.get(name)
            .copied()
            .ok_or_else(|| format!("`{name}` is missing"))
    };
    names.map(value).collect()
}

fn end(end: &End, layout: &Layout) -> Result<HybridState, String> {
    let of = |quantities: &[Quantity], map| values(quantities.iter().map(|q| q.name.as_str()), map);
    Ok(HybridState {
        t: end.t,
        j: end.j,
        mode: mode(layout, &end.mode)?,
        state: Snapshot {
            q: of(&layout.coordinates, &end.q)?,
            v: of(&layout.velocities, &end.v)?,
            discrete: of(&layout.discretes, &end.discrete)?,
            reactions: of(&layout.reactions, &end.reactions)?,
            outputs: of(&layout.outputs, &end.outputs)?,
        },
    })
}

fn mode(layout: &Layout, name: &str) -> Result<usize, String> {
    let found = layout.modes.number(name);
    found.ok_or_else(|| format!("the model has no mode `{name}`"))
}

/// The transition of that name; `rest` is the one that every accumulation ends with.
fn transition(names: &[&'static str], name: &str) -> Result<&'static str, String> {
    let found = names.iter().find(|known| **known == name);
    found
        .copied()
        .ok_or_else(|| format!("the model has no transition `{name}`"))
}

/// Names of the transitions of a variant, and that of coming to rest.
fn transitions(variant: &Variant) -> Vec<&'static str> {
    let guards = variant.modes.iter().flat_map(|mode| &mode.guards);
    let names = guards.flat_map(|guard| &guard.transitions).map(|t| t.name);
    let contacts = variant
        .modes
        .iter()
        .filter_map(|mode| mode.contacts.as_ref());
    let of_contacts = contacts.flat_map(|contacts| contacts.events());
    names.chain(of_contacts).chain(["rest"]).collect()
}

fn snapshot(layout: &Layout, row: &mut Row) -> Result<Snapshot, String> {
    let mut take = |quantities| numbers(quantities, row);
    Ok(Snapshot {
        q: take(&layout.coordinates)?,
        v: take(&layout.velocities)?,
        reactions: take(&layout.reactions)?,
        discrete: take(&layout.discretes)?,
        outputs: take(&layout.outputs)?,
    })
}

/// The values of some quantities.
fn numbers(quantities: &[Quantity], row: &mut Row) -> Result<Vec<f64>, String> {
    quantities.iter().map(|_| row.number()).collect()
}

/// A row of a table, read field by field.
struct Row<'a>(csv::StringRecordIter<'a>);

impl<'a> Row<'a> {
    fn text(&mut self) -> Result<&'a str, String> {
        self.0.next().ok_or_else(|| "a field is missing".to_owned())
    }
    fn parse<T: FromStr>(&mut self) -> Result<T, String> {
        let text = self.text()?;
        text.parse()
            .map_err(|_| format!("`{text}` is not a number"))
    }
    fn number(&mut self) -> Result<f64, String> {
        self.parse()
    }
}

/// Reads the rows of a table with the given header.
fn rows<T: AsRef<str> + PartialEq>(
    path: &Path,
    header: &[T],
    mut read: impl FnMut(&mut Row) -> Result<(), String>,
) -> Result<(), ReadError> {
    let error = |reason: String| ReadError {
        path: path.to_owned(),
        reason,
    };
    let mut reader = csv::Reader::from_path(path).map_err(|e| error(e.to_string()))?;
    let found = reader.headers().map_err(|e| error(e.to_string()))?;
    if !found.iter().eq(header.iter().map(AsRef::as_ref)) {
        let why = "other columns than the scene records now; leave `record` as it was";
        return Err(error(why.to_owned()));
    }
    for (i, record) in reader.records().enumerate() {
        // The header is the first line.
        let at_line = |reason| error(format!("line {}: {reason}", i + 2));
        let record = record.map_err(|e| at_line(e.to_string()))?;
        read(&mut Row(record.iter())).map_err(at_line)?;
    }
    Ok(())
}
