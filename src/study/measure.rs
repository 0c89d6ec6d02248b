//! What is measured of each run, and when one has failed.

use super::ending::Ending;
use crate::hybrid::{AtLimit, Problem, Record};
use crate::record::{Layout, Recorded};
use crate::run::{ColumnKind, Peak};

/// A quantity that is measured.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Measure {
    /// Its name, as the study and the tables have it.
    pub name: String,
    /// Unit of its values; `1` where there is none.
    pub unit: String,
    pub what: What,
}

/// What is measured; a quantity is named as the columns of a trajectory are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum What {
    /// Largest absolute value.
    Peak(String),
    Max(String),
    Min(String),
    /// Value at the end.
    End(String),
    /// How often a transition happens; all transitions for `None`.
    Count(Option<String>),
    /// Whether a limit state is reached.
    Reached(String),
    /// When it is first reached.
    Time(String),
}

impl What {
    /// Whether the values are whole numbers.
    pub fn counts(&self) -> bool {
        matches!(self, What::Count(_))
    }

    /// Whether the values say yes or no.
    pub fn is_flag(&self) -> bool {
        matches!(self, What::Reached(_))
    }

    /// The quantity that it is about.
    fn quantity(&self) -> Option<&str> {
        match self {
            What::Peak(name) | What::Max(name) | What::Min(name) | What::End(name) => Some(name),
            _ => None,
        }
    }
}

/// When a run has failed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Failure {
    /// A limit state is reached.
    Limit(String),
    /// A transition happens.
    Transition(String),
    /// A measure, by its index, is above or below a level.
    Measure {
        index: usize,
        above: bool,
        level: f64,
    },
}

/// What has to be recorded of a problem for some measures.
pub(crate) fn record(measures: &[Measure], problem: &Problem) -> Record {
    let about = |is: &dyn Fn(&str) -> bool| {
        let mut quantities = measures.iter().filter_map(|m| m.what.quantity());
        quantities.any(is)
    };
    let outputs = Layout::outputs_of(problem.variant(), problem.own_quantities());
    let extreme = |m: &Measure| matches!(m.what, What::Peak(_) | What::Max(_) | What::Min(_));
    let energies = about(&|name| name.starts_with("energy."));
    Record {
        every: Some(f64::INFINITY),
        columns: Recorded {
            reactions: about(&|name| name.starts_with("reaction.")),
            outputs: about(&|name| outputs.iter().any(|output| output.name == name)),
            energies,
            inputs: false,
        },
        ledger: energies,
        event_states: false,
        extremes: measures.iter().any(extreme),
    }
}

/// The values of some measures of a run; NaN where one has none.
pub(crate) fn values<'m>(
    measures: &'m [Measure],
    ending: &'m impl Ending,
) -> impl Iterator<Item = f64> {
    measures.iter().map(|measure| value(&measure.what, ending))
}

fn value(what: &What, ending: &impl Ending) -> f64 {
    let peak = |name: &str, of: fn(Peak) -> f64| ending.peak(name).map_or(f64::NAN, of);
    let mut states = ending.limit_states().iter();
    let mut reached = |name: &str| states.find(|s| s.name == *name);
    match what {
        What::Peak(name) => peak(name, |p| p.max.abs().max(p.min.abs())),
        What::Max(name) => peak(name, |p| p.max),
        What::Min(name) => peak(name, |p| p.min),
        What::End(name) => ending.end(name).unwrap_or(f64::NAN),
        What::Count(transition) => ending.count(transition.as_deref()) as f64,
        What::Reached(name) => f64::from(u8::from(reached(name).is_some())),
        What::Time(name) => reached(name).map_or(f64::NAN, |state| state.t),
    }
}

impl Failure {
    /// Whether a run with these values has failed; `None` if it does not tell.
    pub fn happened(&self, ending: &impl Ending, values: &[f64]) -> Option<bool> {
        match self {
            Failure::Limit(name) => {
                let mut states = ending.limit_states().iter();
                Some(states.any(|state| state.name == *name))
            }
            Failure::Transition(name) => Some(ending.count(Some(name)) > 0),
            Failure::Measure {
                index,
                above,
                level,
            } => {
                let value = values[*index];
                match above {
                    _ if value.is_nan() => None,
                    true => Some(value > *level),
                    false => Some(value < *level),
                }
            }
        }
    }

    /// The same of a run that stopped early: what has happened has happened, and of anything else nobody knows.
    pub fn happened_early(
        &self,
        measures: &[Measure],
        ending: &impl Ending,
        values: &[f64],
    ) -> Option<bool> {
        let lasts = match self {
            Failure::Limit(_) | Failure::Transition(_) => true,
            Failure::Measure { index, above, .. } => match measures[*index].what {
                What::Peak(_) | What::Max(_) | What::Count(_) => *above,
                What::Min(_) => !above,
                What::End(_) | What::Reached(_) | What::Time(_) => false,
            },
        };
        self.happened(ending, values)
            .filter(|failed| lasts && *failed)
    }

    /// The measure that decides, by its index.
    pub fn measure(&self) -> Option<usize> {
        match self {
            Failure::Measure { index, .. } => Some(*index),
            _ => None,
        }
    }

    /// How far the measure of a run is above the level that decides, and that level, if a measure does.
    pub fn margin(&self, values: &[f64]) -> Option<(f64, f64)> {
        match self {
            Failure::Measure { index, level, .. } => Some((values[*index] - level, *level)),
            _ => None,
        }
    }
}

/// All names of quantities that can be measured, with their units; those of the ledger at the end alone.
pub(crate) fn quantities(problem: &Problem) -> Vec<(String, String, ColumnKind)> {
    let recorded = Recorded {
        reactions: true,
        outputs: true,
        energies: true,
        inputs: false,
    };
    let layout = Layout::new(
        &problem.model,
        problem.variant(),
        recorded,
        problem.own_quantities(),
    );
    let columns = layout.columns().into_iter();
    columns.map(|c| (c.name, c.unit, c.group)).collect()
}

/// Whether a problem ignores a limit state of its model.
pub(crate) fn ignores(problem: &Problem, limit: &str) -> bool {
    (problem.limits.of_model.iter()).any(|&said| said.0 == limit && said.1 == AtLimit::Ignore)
}

/// Names of the limit states of a problem that it does not ignore: those of its model and its own.
pub(crate) fn limits(problem: &Problem) -> Vec<String> {
    let of_model = (problem.variant().limits.iter())
        .filter(|limit| !ignores(problem, limit.name))
        .map(|limit| limit.name.to_owned());
    let own = problem.limits.own.iter().map(|limit| limit.name.clone());
    let mut names: Vec<String> = of_model.chain(own).collect();
    names.dedup();
    names
}
