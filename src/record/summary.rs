//! `summary.json`: the result of a run on one page.

use std::collections::BTreeMap;
use std::io::{self, Write};

use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::ser::{Formatter, PrettyFormatter};

use super::number::push_exact;
use crate::hybrid::Run;
use crate::run::HybridState;
use crate::run::Quantity;
use crate::run::{Gain, Impacts};

/// File name of the summary.
pub const SUMMARY: &str = "summary.json";

/// Version of the format of summaries, raised when a key changes its meaning or goes. Those that say nothing are of the first.
pub const FORMAT: u32 = 1;

/// What `summary.json` holds. Names map to values in the order of the model. All bytes follow
/// from the run, `wall_seconds` alone differs from one execution to the next.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Summary {
    /// Version of this format: [`FORMAT`].
    pub format: u32,
    /// Name of the model.
    pub model: String,
    /// Title of the scene.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Chosen option of each choice of the model.
    pub choices: Named<String>,
    /// Value of each parameter.
    pub parameters: Named<f64>,
    /// Digests of the model and of the parts of the scene that decide the motion: a run is continued with the same.
    pub digests: Named<String>,
    /// By how much a projection has changed the initial state.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub projected: Named<f64>,
    /// Where the run ended.
    pub end: Point,
    /// Why and where the run stopped early; `null` when it reached its end.
    pub failure: Option<Stopped>,
    /// Extremes of every coordinate, velocity, reaction, output and energy.
    pub peaks: Named<Extremes>,
    /// The transitions.
    pub events: Events,
    /// What the impacts did to the energy.
    pub impacts: AllImpacts,
    /// The balance of energies.
    /// `None` where the ledger was not kept.
    pub energy: Option<Energy>,
    /// Estimate of the error of the run; only where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_estimate: Option<Estimate>,
    /// What the run cannot tell at its tolerance.
    pub uncertain: super::Uncertain,
    /// Limit states that were reached, and where the model's validity was left.
    #[serde(flatten)]
    pub reached: super::Reached,
    /// Work done by the integrator.
    pub solver: super::Solver,
    /// Time the simulation took on the wall clock (s).
    pub wall_seconds: f64,
}

/// A point in hybrid time.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Point {
    /// Time (s).
    pub t: f64,
    /// Number of transitions so far.
    pub j: u64,
    /// Name of the mode.
    pub mode: String,
    /// Coordinates.
    pub q: Named<f64>,
    /// Velocities.
    pub v: Named<f64>,
    /// Discrete states.
    pub discrete: Named<f64>,
    /// Reactions; none where they are not recorded.
    pub reactions: Named<f64>,
    /// Outputs; none where they are not recorded.
    pub outputs: Named<f64>,
}

/// Why and where a run stopped early.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Stopped {
    /// What went wrong.
    pub reason: String,
    /// Where.
    #[serde(flatten)]
    pub at: Point,
}

/// Extremes of a quantity over the motion and both sides of every transition.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Extremes {
    /// Largest value.
    pub max: f64,
    /// First time of the largest value (s).
    pub t_max: f64,
    /// Smallest value.
    pub min: f64,
    /// First time of the smallest value (s).
    pub t_min: f64,
    /// Unit of the values.
    pub unit: String,
}

/// Number of transitions.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Events {
    /// All of them.
    pub total: usize,
    /// By name.
    pub by_transition: BTreeMap<&'static str, usize>,
}

/// What the impacts did to the energy.
#[derive(Debug, Clone, serde::Serialize)]
pub struct AllImpacts {
    /// By transition.
    #[serde(flatten)]
    pub by_transition: Named<Impacts>,
    /// The first that gained energy; all are counted by transition.
    pub gains: Vec<Gain>,
}

/// Estimate of the error: the difference to a run by another method at a tighter tolerance, and the
/// rounding of their steps.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Estimate {
    /// The methods of the better run.
    pub method: String,
    /// Its relative tolerance.
    pub tolerance: f64,
    /// Of the coordinates at the end.
    pub q: Named<f64>,
    /// Of the velocities at the end.
    pub v: Named<f64>,
    /// Largest of these, each divided by what a relative tolerance of 1 would allow: its typical size
    /// (absolute ÷ relative tolerance) and its magnitude.
    pub relative: f64,
    /// Largest difference of the times of a transition (s).
    pub event_time: f64,
    /// Transitions that the better run alone has.
    pub missed_events: usize,
    /// Transitions that the run alone has.
    pub extra_events: usize,
    /// Transitions that one of the two alone has, in the tails of accumulations: no errors.
    pub events_in_tails: usize,
}

/// The balance `initial + input_work − dissipated − lost_at_impacts − final = imbalance`.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Energy {
    /// Kinetic and potential energy at the start (J).
    pub initial: f64,
    /// Kinetic and potential energy at the end (J).
    #[serde(rename = "final")]
    pub final_: f64,
    /// Energy dissipated (J).
    pub dissipated: f64,
    /// Work of the inputs (J).
    pub input_work: f64,
    /// Energy lost at impacts (J).
    pub lost_at_impacts: f64,
    /// What the balance is off by (J).
    pub imbalance: f64,
    /// In which frame the balance is kept.
    pub frame: String,
}

/// Names and values that keep their order, written as a JSON object.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T> Named<T> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl Point {
    /// Coordinates, velocities, reactions and outputs, by name.
    pub(crate) fn state(&self) -> impl Iterator<Item = &(String, f64)> {
        let groups = [&self.q, &self.v, &self.reactions, &self.outputs];
        groups.into_iter().flat_map(|group| &group.0)
    }
}

impl Summary {
    /// The summary of a run.
    pub fn new(run: &Run) -> Summary {
        let counted = run.tally.counted().iter();
        let by_transition = counted.map(|c| (c.transition, c.count)).collect();
        let columns = run.layout.columns();
        let extremes = run.peaks.iter().map(|&(i, peak)| {
            let column = &columns[i];
            let extremes = Extremes {
                max: peak.max,
                t_max: peak.t_max,
                min: peak.min,
                t_min: peak.t_min,
                unit: column.unit.clone(),
            };
            (column.name.clone(), extremes)
        });
        Summary {
            format: FORMAT,
            model: run.subject.model.clone(),
            title: run.subject.title.clone(),
            choices: Named(run.subject.choices.clone()),
            parameters: Named(run.subject.parameters.clone()),
            digests: Named(run.subject.digests.clone()),
            projected: Named(run.subject.projected.clone()),
            end: point(run, &run.end),
            failure: (run.failure.as_ref()).map(|f| Stopped {
                reason: f.reason.to_string(),
                at: point(run, &f.at),
            }),
            peaks: Named(extremes.collect()),
            events: Events {
                total: run.tally.total(),
                by_transition,
            },
            impacts: AllImpacts {
                by_transition: impacts(run),
                gains: run.tally.gains.clone(),
            },
            energy: run.energy.as_ref().map(|energy| Energy {
                initial: energy.initial,
                final_: energy.final_,
                dissipated: energy.dissipated,
                input_work: energy.input_work,
                lost_at_impacts: energy.lost_at_impacts,
                imbalance: energy.imbalance(),
                frame: energy.frame.clone(),
            }),
            error_estimate: run.error.as_ref().map(|error| Estimate {
                method: error.method.clone(),
                tolerance: error.tolerance,
                q: named(&run.layout.coordinates, &error.q),
                v: named(&run.layout.velocities, &error.v),
                relative: error.relative,
                event_time: error.event_time,
                missed_events: error.missed,
                extra_events: error.extra,
                events_in_tails: error.in_tails,
            }),
            uncertain: run.uncertain.clone(),
            reached: run.reached.clone(),
            solver: run.solver.clone(),
            wall_seconds: run.wall.as_secs_f64(),
        }
    }

    /// Writes the summary as JSON, numbers with the digits that read back to the same.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut out = out;
        let formatter = ExactFormatter(PrettyFormatter::new());
        self.serialize(&mut serde_json::Serializer::with_formatter(
            &mut out, formatter,
        ))?;
        writeln!(out)
    }
}

fn named(quantities: &[Quantity], values: &[f64]) -> Named<f64> {
    let names = quantities.iter().map(|q| q.name.clone());
    Named(names.zip(values.iter().copied()).collect())
}

fn point(run: &Run, place: &HybridState) -> Point {
    Point {
        t: place.t,
        j: place.j,
        mode: run.layout.modes.name(place.mode).into_owned(),
        q: named(&run.layout.coordinates, &place.state.q),
        v: named(&run.layout.velocities, &place.state.v),
        discrete: named(&run.layout.discretes, &place.state.discrete),
        reactions: named(&run.layout.reactions, &place.state.reactions),
        outputs: named(&run.layout.outputs, &place.state.outputs),
    }
}

fn impacts(run: &Run) -> Named<Impacts> {
    let counted = run.tally.counted().iter();
    let impacts = counted.filter_map(|c| Some((c.transition.to_owned(), c.impacts.clone()?)));
    let by_name: BTreeMap<String, Impacts> = impacts.collect();
    Named(by_name.into_iter().collect())
}

/// Pretty JSON with exact numbers. (What is not finite is `null`: JSON has no other way.)
struct ExactFormatter<'a>(PrettyFormatter<'a>);

impl Formatter for ExactFormatter<'_> {
    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, x: f64) -> io::Result<()> {
        let mut text = String::new();
        push_exact(&mut text, x);
        writer.write_all(text.as_bytes())
    }
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_array(writer)
    }
    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_array(writer)
    }
    fn begin_array_value<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_array_value(w, first)
    }
    fn end_array_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_array_value(writer)
    }
    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object(writer)
    }
    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object(writer)
    }
    fn begin_object_key<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_object_key(w, first)
    }
    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object_value(writer)
    }
    fn end_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object_value(writer)
    }
}
