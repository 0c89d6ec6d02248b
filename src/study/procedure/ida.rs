//! Incremental dynamic analysis: hunt, trace and fill (Vamvatsikos and Cornell 2002).
//!
//! The hunt raises the intensity by steps that grow until a run fails. The trace halves the bracket between the largest
//! intensity without a failure and the first failure above it, until it is as narrow as the resolution asks. The fill
//! puts what is left of the runs into the middle of the widest gaps below the capacity.

use super::{Along, Failed};

/// An incremental dynamic analysis.
#[derive(Debug, Clone)]
pub(crate) struct Ida {
    pub along: Along,
    /// The first intensity.
    pub first: f64,
    /// From the first to the second.
    pub step: f64,
    /// What each step is longer by than that before.
    pub increment: f64,
    /// Most runs.
    pub runs: usize,
    /// Width of the bracket about the capacity, as a part of it.
    pub resolution: f64,
    /// The measure that the curves show.
    pub curve: Option<usize>,
}

impl Ida {
    /// The intensity of the next run after these, or `None` if the analysis is over. It ends where a run does not tell whether
    /// it failed.
    pub fn next(&self, runs: &[(f64, Failed)]) -> Option<f64> {
        let Some((last, outcome)) = runs.last() else {
            return Some(self.first);
        };
        if runs.len() >= self.runs || runs.iter().any(|(_, failed)| failed.is_none()) {
            return None;
        }
        let Some([below, above]) = bracket(runs) else {
            debug_assert!(*outcome == Some(false));
            let taken = (runs.len() - 1) as f64;
            return Some(last + self.step + taken * self.increment);
        };
        let middle = below + 0.5 * (above - below);
        if above - below > self.resolution * middle && middle > below && middle < above {
            return Some(middle);
        }
        self.gap(runs, below)
    }

    /// The middle of the widest gap up to an intensity; `None` if none is wider than what the resolution makes of it.
    fn gap(&self, runs: &[(f64, Failed)], up_to: f64) -> Option<f64> {
        let mut levels: Vec<f64> = runs.iter().map(|(level, _)| *level).collect();
        levels.push(0.0);
        levels.retain(|level| *level <= up_to);
        levels.sort_by(f64::total_cmp);
        let gaps = levels.windows(2).map(|pair| (pair[1] - pair[0], pair[0]));
        // Of gaps as wide as each other the lowest.
        let widest = gaps.reduce(|best, gap| if gap.0 > best.0 { gap } else { best });
        let (width, from) = widest?;
        (width > self.resolution * up_to).then_some(from + 0.5 * width)
    }
}

/// The first failure, and the largest intensity below it that did not fail, 0 if none was tried; `None` without a failure.
pub(crate) fn bracket(runs: &[(f64, Failed)]) -> Option<[f64; 2]> {
    let failed = runs.iter().filter(|(_, failed)| *failed == Some(true));
    let above = failed.map(|(level, _)| *level).reduce(f64::min)?;
    let below = runs.iter().map(|(level, _)| *level);
    let below = below.filter(|level| *level < above).fold(0.0, f64::max);
    Some([below, above])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::procedure::tests::along;

    fn analysis(runs: usize) -> Ida {
        Ida {
            along: along(),
            first: 0.1,
            step: 0.1,
            increment: 0.05,
            runs,
            resolution: 0.05,
            curve: None,
        }
    }

    fn levels(ida: &Ida, capacity: f64) -> Vec<(f64, Failed)> {
        let mut runs = Vec::new();
        while let Some(level) = ida.next(&runs) {
            runs.push((level, Some(level >= capacity)));
        }
        runs
    }

    #[test]
    fn the_hunt_grows_the_trace_halves_and_the_fill_takes_the_widest_gap() {
        let runs = levels(&analysis(9), 0.62);
        let levels: Vec<f64> = runs.iter().map(|(level, _)| *level).collect();
        // Steps of 0.1, 0.15, 0.2, 0.25: 0.1, 0.2, 0.35, 0.55, 0.8; then 0.675, 0.6125, 0.64375; then a gap of 0.2.
        let expected = [0.1, 0.2, 0.35, 0.55, 0.8, 0.675, 0.6125, 0.64375, 0.45];
        assert_eq!(levels.len(), expected.len(), "{levels:?}");
        for (level, expected) in levels.iter().zip(expected) {
            assert!((level - expected).abs() < 1e-12, "{levels:?}");
        }
        let [below, above] = bracket(&runs).unwrap();
        assert!(below < 0.62 && 0.62 <= above && above - below <= 0.05 * above);
    }

    #[test]
    fn a_hunt_without_a_failure_ends_with_its_runs_and_one_that_fails_at_once_goes_down() {
        let runs = levels(&analysis(6), 1e9);
        assert_eq!((runs.len(), bracket(&runs)), (6, None));
        let runs = levels(&analysis(12), 0.013);
        let [below, above] = bracket(&runs).unwrap();
        assert!(below < 0.013 && 0.013 <= above && above - below <= 0.05 * above);
    }

    #[test]
    fn a_run_that_does_not_tell_ends_the_analysis() {
        let ida = analysis(9);
        assert_eq!(ida.next(&[(0.1, Some(false)), (0.2, None)]), None);
    }
}
