//! What a simulation gives: a run, complete or stopped early, and why it stopped.

use super::failure::Reason;
use crate::run::{
    ErrorEstimate, Event, HybridState, Layout, Ledger, Peak, Reached, Solver, Subject, Tally,
    Trajectory, Uncertain,
};
use std::time::Duration;

/// The result of a simulation, complete or stopped early.
#[derive(Debug, Clone)]
pub struct Run {
    /// What was simulated.
    pub subject: Subject,
    /// Names and units of everything below.
    pub layout: Layout,
    /// The samples; of a run that an observer was told of, the columns alone.
    pub trajectory: Trajectory,
    /// The transitions, in hybrid time; of a run that an observer was told of, none.
    pub events: Vec<Event>,
    /// How often transitions happened, and what the impacts did.
    pub tally: Tally,
    /// Extremes of the motion, as (index of the column, peak), whether or not a row hits them; none where they were
    /// not looked for.
    pub peaks: Vec<(usize, Peak)>,
    /// Where the run ended; of a run that stopped early, the last admissible point.
    pub end: HybridState,
    /// Work done by the integrator.
    pub solver: Solver,
    /// Balance of energies; `None` where it was not kept.
    pub energy: Option<Ledger>,
    /// Estimate of the run's error; `None` where none was asked for.
    pub error: Option<ErrorEstimate>,
    /// What the run cannot tell at its tolerance.
    pub uncertain: Uncertain,
    /// Limit states and conditions of validity that it has reached.
    pub reached: Reached,
    /// Time the simulation took on the wall clock (without reading and writing files).
    pub wall: Duration,
    /// Why the run stopped before its end; `None` when it reached it.
    pub failure: Option<Failure>,
}

/// Why a run stopped before its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// What went wrong and what can be done about it, without the place.
    pub reason: Reason,
    /// Where it went wrong.
    pub at: HybridState,
}

impl Run {
    /// The extremes of a quantity by its name, as the trajectory names it; none where they were not looked for.
    pub fn peak(&self, name: &str) -> Option<Peak> {
        let column = self.trajectory.column(name)?;
        let found = self.peaks.iter().find(|(i, _)| *i == column);
        found.map(|(_, peak)| *peak)
    }

    /// A column over time: the samples and, for what belongs to the state, both sides of every
    /// transition, in order of time. A sample at the time of a transition comes first.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn curve(&self, column: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let of_state = self.trajectory.columns[column].group.is_of_the_state();
        let sides = self
            .events
            .iter()
            .filter(move |_| of_state)
            .flat_map(move |event| {
                let value = |values: &mut dyn Iterator<Item = f64>| {
                    values
                        .nth(column)
                        .expect("a snapshot holds every column of the state")
                };
                let before = value(&mut event.before.values());
                [
                    (event.t, before),
                    (event.t, value(&mut event.after.values())),
                ]
            });
        let samples = self
            .trajectory
            .t
            .iter()
            .enumerate()
            .map(move |(i, &t)| (t, self.trajectory.row(i)[column]));
        let (mut samples, mut sides) = (samples.peekable(), sides.peekable());
        std::iter::from_fn(move || match (samples.peek(), sides.peek()) {
            (Some(sample), Some(side)) if sample.0 <= side.0 => samples.next(),
            (_, Some(_)) => sides.next(),
            _ => samples.next(),
        })
    }
}
