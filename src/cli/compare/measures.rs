//! What is compared: a few numbers of each run.

use std::collections::BTreeSet;

use super::{Case, Comparison};
use crate::record::{ColumnKind, Ledger, Run};

/// A number of each case.
#[derive(Debug)]
pub struct Measure {
    pub name: String,
    pub unit: String,
    /// One a case; `None` where there is no run.
    pub values: Vec<Option<f64>>,
}

impl Comparison<'_> {
    /// The runs there are.
    pub fn runs(&self) -> impl Iterator<Item = (&Case, &Run)> {
        let cases = self.cases.iter();
        cases.filter_map(|case| Some((case, &case.run.as_ref().ok()?.0)))
    }

    /// The coordinates that are not zero throughout in every run.
    pub fn coordinates(&self) -> Vec<usize> {
        let moves = |i: usize| {
            let mut peaks = self.runs().filter_map(|(_, run)| extremes(run, i));
            peaks.any(|(min, max)| min != 0.0 || max != 0.0)
        };
        (0..self.model.own_coordinates().len())
            .filter(|&i| moves(i))
            .collect()
    }

    /// Where the runs ended, the extremes and last values of the coordinates, the number of each
    /// transition, and the energies.
    pub fn measures(&self) -> Vec<Measure> {
        let mut measures = vec![self.measure("end", "s", |run| Some(run.end.t))];
        for i in self.coordinates() {
            let (name, unit) = (
                self.model.coordinates[i].name,
                self.model.coordinates[i].unit,
            );
            let extreme = |run: &Run| extremes(run, i);
            let max = |run: &Run| extreme(run).map(|(_, max)| max);
            let min = |run: &Run| extreme(run).map(|(min, _)| min);
            measures.push(self.measure(&format!("{name} max"), unit, max));
            measures.push(self.measure(&format!("{name} min"), unit, min));
            let end = |run: &Run| Some(run.end.state.q[i]);
            measures.push(self.measure(&format!("{name} end"), unit, end));
        }
        let counted = self.runs().flat_map(|(_, run)| run.tally.counted());
        let transitions: BTreeSet<&str> = counted.map(|c| c.transition).collect();
        for name in transitions {
            let count = |run: &Run| Some(run.tally.count(name) as f64);
            measures.push(self.measure(&format!("{name} count"), "1", count));
        }
        type Energy = fn(&Ledger) -> f64;
        let energies: [(&str, Energy); 5] = [
            ("energy initial", |l| l.initial),
            ("input work", |l| l.input_work),
            ("dissipated", |l| l.dissipated),
            ("lost at impacts", |l| l.lost_at_impacts),
            ("energy final", |l| l.final_),
        ];
        for (name, energy) in energies {
            let measure = self.measure(name, "J", |run| run.energy.as_ref().map(energy));
            measures.push(measure);
        }
        let gaining = |run: &Run| Some(run.tally.gaining() as f64);
        measures.push(self.measure("impacts that gained energy", "1", gaining));
        measures
    }

    fn measure(&self, name: &str, unit: &str, of: impl Fn(&Run) -> Option<f64>) -> Measure {
        let value = |case: &Case| case.run.as_ref().ok().and_then(|(run, _)| of(run));
        Measure {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: self.cases.iter().map(value).collect(),
        }
    }
}

/// Smallest and largest value of a coordinate.
fn extremes(run: &Run, coordinate: usize) -> Option<(f64, f64)> {
    let column = run.layout.range(ColumnKind::Coordinate).start + coordinate;
    let peak = run.peaks.iter().find(|(i, _)| *i == column);
    peak.map(|(_, peak)| (peak.min, peak.max))
}
