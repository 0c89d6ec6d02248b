//! A run at its end, as far as a study looks at it: one that was made alone, or in an ensemble.

use crate::hybrid::Finished;
use crate::hybrid::Run;
use crate::record::Layout;
use crate::run::{Ledger, LimitState, Peak, Snapshot, Solver};

/// What a study looks at.
pub(crate) trait Ending {
    /// The extremes of a quantity, if they were looked for.
    fn peak(&self, name: &str) -> Option<Peak>;
    /// The value of a quantity at the end.
    fn end(&self, name: &str) -> Option<f64>;
    /// How often a transition happened; all transitions for `None`.
    fn count(&self, transition: Option<&str>) -> usize;
    /// The limit states that were reached.
    fn limit_states(&self) -> &[LimitState];
    /// Time reached, s.
    fn time(&self) -> f64;
    /// Why it stopped before its end, if it did.
    fn failure(&self) -> Option<String>;
    /// Number of places where it cannot tell whether a guard falls; `None` where nobody looked.
    fn uncertain(&self) -> Option<u64>;
    fn solver(&self) -> &Solver;
}

impl Ending for Run {
    fn peak(&self, name: &str) -> Option<Peak> {
        let column = self.trajectory.column(name)?;
        let found = self.peaks.iter().find(|(index, _)| *index == column);
        found.map(|(_, peak)| *peak)
    }

    fn end(&self, name: &str) -> Option<f64> {
        let of_ledger = |ledger| of_ledger(ledger, name);
        of_state(&self.layout, &self.end.state, name)
            .or_else(|| self.energy.as_ref().and_then(of_ledger))
    }

    fn count(&self, transition: Option<&str>) -> usize {
        match transition {
            None => self.tally.total(),
            Some(name) => self.tally.count(name),
        }
    }

    fn limit_states(&self) -> &[LimitState] {
        &self.reached.limit_states
    }

    fn time(&self) -> f64 {
        self.end.t
    }

    fn failure(&self) -> Option<String> {
        self.failure
            .as_ref()
            .map(|failure| failure.reason.to_string())
    }

    fn uncertain(&self) -> Option<u64> {
        Some(self.uncertain.total)
    }

    fn solver(&self) -> &Solver {
        &self.solver
    }
}

/// A member of an ensemble.
pub(super) struct OfEnsemble<'f, 'a, 'p> {
    finished: &'f Finished<'a, 'p>,
    state: Snapshot,
    limit_states: Vec<LimitState>,
}

impl<'f, 'a, 'p> OfEnsemble<'f, 'a, 'p> {
    pub fn new(finished: &'f mut Finished<'a, 'p>) -> Self {
        OfEnsemble {
            state: finished.state(),
            limit_states: finished.reached().limit_states,
            finished,
        }
    }
}

impl Ending for OfEnsemble<'_, '_, '_> {
    fn peak(&self, name: &str) -> Option<Peak> {
        let layout = self.finished.layout();
        let mut columns = layout.coordinates.iter().chain(&layout.velocities);
        self.finished.peak(columns.position(|c| c.name == name)?)
    }

    fn end(&self, name: &str) -> Option<f64> {
        of_state(self.finished.layout(), &self.state, name)
    }

    fn count(&self, transition: Option<&str>) -> usize {
        let events = self.finished.events();
        match transition {
            None => events.len(),
            Some(name) => events.iter().filter(|e| e.transition == name).count(),
        }
    }

    fn limit_states(&self) -> &[LimitState] {
        &self.limit_states
    }

    fn time(&self) -> f64 {
        self.finished.time()
    }

    fn failure(&self) -> Option<String> {
        self.finished.failure.as_ref().map(ToString::to_string)
    }

    fn uncertain(&self) -> Option<u64> {
        None
    }

    fn solver(&self) -> &Solver {
        self.finished.solver()
    }
}

fn of_state(layout: &Layout, state: &Snapshot, name: &str) -> Option<f64> {
    let groups = [
        (&layout.coordinates, &state.q),
        (&layout.velocities, &state.v),
        (&layout.reactions, &state.reactions),
        (&layout.discretes, &state.discrete),
        (&layout.outputs, &state.outputs),
    ];
    groups.into_iter().find_map(|(quantities, values)| {
        let index = quantities.iter().position(|q| q.name == name)?;
        values.get(index).copied()
    })
}

fn of_ledger(ledger: &Ledger, name: &str) -> Option<f64> {
    match name {
        "energy.stored" => Some(ledger.final_),
        "energy.input_work" => Some(ledger.input_work),
        "energy.dissipated" => Some(ledger.dissipated),
        "energy.lost_at_impacts" => Some(ledger.lost_at_impacts),
        _ => None,
    }
}
