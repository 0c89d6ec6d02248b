//! What is run for each case of a study: once, or along an intensity until it fails.

mod critical;
mod ida;

pub(crate) use critical::Critical;
pub(crate) use ida::Ida;

use super::design::number_node;
use crate::scene::source::Span;
use crate::scene::tree::Node;

/// What a study asks of each case.
#[derive(Debug, Clone)]
pub(crate) enum Procedure {
    /// A single run. `intensity`: the factor that a fragility is about.
    Once {
        kind: Kind,
        intensity: Option<usize>,
    },
    /// Incremental dynamic analysis.
    Ida(Ida),
    /// The least value that fails.
    Critical(Critical),
}

/// How the cases of single runs came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Sweep,
    MonteCarlo,
    /// All cases at the same intensities.
    Stripes,
    /// Each case at an intensity of its own.
    Cloud,
}

/// The path in the scene along which an analysis goes.
#[derive(Debug, Clone)]
pub(crate) struct Along {
    /// As the study names it.
    pub path: String,
    /// The names on it.
    pub names: Vec<Span>,
    /// Unit of its values.
    pub unit: Option<String>,
    /// Where the study names it.
    pub place: Span,
}

/// What a run of an analysis gave: whether it failed, or `None` where it does not tell.
pub(crate) type Failed = Option<bool>;

impl Procedure {
    /// Its name in summaries.
    pub fn name(&self) -> &'static str {
        match self {
            Procedure::Once { kind, .. } => match kind {
                Kind::Sweep => "sweep",
                Kind::MonteCarlo => "monte_carlo",
                Kind::Stripes => "stripes",
                Kind::Cloud => "cloud",
            },
            Procedure::Ida(_) => "ida",
            Procedure::Critical(_) => "critical",
        }
    }

    /// The path that it goes along, if it is not a single run.
    pub fn along(&self) -> Option<&Along> {
        match self {
            Procedure::Once { .. } => None,
            Procedure::Ida(ida) => Some(&ida.along),
            Procedure::Critical(critical) => Some(&critical.along),
        }
    }

    /// The value of the next run of a search after these; `None` if it is over.
    pub fn next(&self, runs: &[(f64, Failed)]) -> Option<f64> {
        match self {
            Procedure::Once { .. } => None,
            Procedure::Ida(ida) => ida.next(runs),
            Procedure::Critical(critical) => critical.next(runs),
        }
    }

    /// The value of the first run of a search.
    pub fn first_value(&self) -> Option<f64> {
        self.next(&[])
    }

    /// The largest value known not to fail below the first that does, and that one.
    pub fn bracket(&self, runs: &[(f64, Failed)]) -> Option<[f64; 2]> {
        match self {
            Procedure::Once { .. } => None,
            Procedure::Ida(_) => ida::bracket(runs),
            Procedure::Critical(_) => critical::bracket(runs),
        }
    }

    /// Where it begins.
    pub fn first(&self) -> Option<(&[Span], Node)> {
        let (along, value) = (self.along()?, self.first_value()?);
        Some((&along.names, number_node(value, &along.place)))
    }

    /// Values at which a scene must be one, besides the first.
    pub fn extremes(&self) -> Option<(&[Span], Node)> {
        match self {
            Procedure::Critical(critical) => Some((
                &critical.along.names,
                number_node(critical.to, &critical.along.place),
            )),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::Along;
    use crate::scene::source::{Source, Span};

    /// A path for tests of the searches, which do not look at it.
    pub fn along() -> Along {
        let source = Arc::new(Source {
            name: String::new(),
            text: "x".into(),
        });
        Along {
            path: "x".into(),
            names: Vec::new(),
            unit: None,
            place: Span::new(&source, 0..1),
        }
    }
}
