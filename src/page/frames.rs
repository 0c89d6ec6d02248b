//! The mechanism of a run over time: modes, transitions, and what its drawing depends on.

use super::thin::thin;
use crate::record::{ColumnKind, Run, Sketch};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Most frames of the drawing, and marks of events: more than a screen is wide, also after a zoom tenfold, and some
/// megabytes at most.
const MOST_FRAMES: usize = 20_000;
const MOST_MARKS: usize = 4_000;

/// A run over time, as the scripts of its page show it.
#[derive(Debug, Serialize)]
pub(super) struct Motion {
    /// First and last time, s.
    span: [f64; 2],
    /// Names of the modes that the run was in, by their numbers.
    modes: BTreeMap<usize, String>,
    /// From when to when the run was in which mode.
    visits: Vec<(f64, f64, usize)>,
    /// Times and names of transitions.
    events: Vec<(f64, &'static str)>,
    frames: Option<Frames>,
    /// The drawing of the model.
    drawing: Option<Value>,
    /// Names of the coordinates.
    coordinates: Vec<String>,
    parameters: BTreeMap<String, f64>,
    /// Reactions and outputs that never change, which have no curve, with their units.
    held: BTreeMap<String, (f64, String)>,
    /// What is left out.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// What the drawing depends on, over time; between two frames the script takes the cubic of positions and rates.
#[derive(Debug, Serialize)]
struct Frames {
    t: Vec<f64>,
    /// By name; of single precision, which is ample for a picture.
    columns: BTreeMap<String, Vec<f32>>,
}

impl Motion {
    /// That of a run, with the drawing of its model as `codegen/drawing.py` wrote it.
    /// `drawn` are the columns that have curves.
    pub fn new(run: &Run, sketch: &Sketch, drawing: &str, drawn: &[usize]) -> Motion {
        let mut notes = Vec::new();
        let drawing: Option<Value> = serde_json::from_str(drawing).ok();
        let times = sketch.times().chain([run.end.t]);
        let span = times.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| {
            [low.min(t), high.max(t)]
        });
        let (visits, events) = marks(run, sketch, span, &mut notes);
        Motion {
            span,
            modes: (visits.iter())
                .map(|&(.., mode)| (mode, run.layout.modes.name(mode).into_owned()))
                .collect(),
            visits,
            events,
            frames: drawing.as_ref().map(|drawing| frames(run, sketch, drawing)),
            drawing,
            coordinates: (run.layout.coordinates.iter())
                .map(|c| c.name.clone())
                .collect(),
            parameters: run.subject.parameters.iter().cloned().collect(),
            held: [ColumnKind::Reaction, ColumnKind::Output]
                .into_iter()
                .flat_map(|group| run.layout.range(group))
                .filter(|i| !drawn.contains(i))
                .filter_map(|i| {
                    let (column, first) = (&sketch.columns()[i], sketch.curve(i).next()?);
                    Some((column.name.clone(), (first.1, column.unit.clone())))
                })
                .collect(),
            notes,
        }
    }
}

/// Visits of modes and times of transitions; of many, one in each of [`MOST_MARKS`] parts of the run.
#[expect(clippy::type_complexity)]
fn marks(
    run: &Run,
    sketch: &Sketch,
    [first, last]: [f64; 2],
    notes: &mut Vec<String>,
) -> (Vec<(f64, f64, usize)>, Vec<(f64, &'static str)>) {
    let marks = sketch.marks();
    let mode = marks.visits.first().map_or(run.end.mode, |visit| visit.2);
    let mut visits = vec![(first, last, mode)];
    let mut events: Vec<(f64, &'static str)> = Vec::new();
    let part = match marks.total() > MOST_MARKS {
        true => (last - first) / MOST_MARKS as f64,
        false => 0.0,
    };
    for &(t, transition, to) in &marks.events {
        if let Some(&(before, _)) = events.last()
            && t - before < part
        {
            visits.last_mut().expect("there is one").2 = to;
            continue;
        }
        events.push((t, transition));
        let visit = visits.last_mut().expect("there is one");
        if visit.2 != to {
            visit.1 = t;
            visits.push((t, last, to));
        }
    }
    if part > 0.0 {
        notes.push(format!(
            "{} of {} transitions are marked",
            events.len(),
            marks.total()
        ));
    }
    (visits, events)
}

/// Key frames: the samples and both sides of every transition, as far as the drawing depends on them.
fn frames(run: &Run, sketch: &Sketch, drawing: &Value) -> Frames {
    let symbols = drawing["symbols"].as_array().map_or(&[][..], Vec::as_slice);
    let names = symbols.iter().filter_map(Value::as_str);
    let names: Vec<String> = names
        .flat_map(|name| [name.to_owned(), format!("{name}.rate")])
        .collect();
    let columns: Vec<(String, usize)> = (names.into_iter())
        .filter_map(|name| Some((name.clone(), sketch.column(&name)?)))
        .collect();
    let Some((_, any)) = columns.first() else {
        // A drawing of parameters alone.
        return Frames {
            t: vec![0.0, run.end.t],
            columns: BTreeMap::new(),
        };
    };
    let t: Vec<f64> = sketch.curve(*any).map(|(t, _)| t).collect();
    let values: Vec<Vec<f64>> = (columns.iter())
        .map(|(_, i)| sketch.curve(*i).map(|(_, x)| x).collect())
        .collect();
    let kept = thin(
        &values.iter().map(Vec::as_slice).collect::<Vec<_>>(),
        t.len(),
        MOST_FRAMES,
    );
    Frames {
        t: kept.iter().map(|&i| t[i]).collect(),
        columns: (columns.into_iter().zip(&values))
            .map(|((name, _), column)| (name, kept.iter().map(|&i| column[i] as f32).collect()))
            .collect(),
    }
}
