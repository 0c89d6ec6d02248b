//! The least value that fails: a scan for the first failure, then bisection.

use super::{Along, Failed};

/// A critical value.
#[derive(Debug, Clone)]
pub(crate) struct Critical {
    pub along: Along,
    /// Where no run fails.
    pub from: f64,
    /// The last value that is tried.
    pub to: f64,
    /// Number of equal steps of the scan.
    pub scan: u64,
    /// Width of the last bracket, as a part of the value.
    pub resolution: f64,
}

impl Critical {
    /// The value of the next run after these, or `None` if the search is over: the bracket is narrow enough, the scan found no
    /// failure, or the first value fails. It ends where a run does not tell whether it failed.
    pub fn next(&self, runs: &[(f64, Failed)]) -> Option<f64> {
        if runs.is_empty() {
            return Some(self.from);
        }
        if runs.iter().any(|(_, failed)| failed.is_none()) {
            return None;
        }
        let Some([stays, fails]) = bracket(runs) else {
            let step = runs.len() as u64;
            if runs[0].1 == Some(true) || step > self.scan {
                return None;
            }
            return Some(match step == self.scan {
                // The end is exact.
                true => self.to,
                false => self.from + step as f64 / self.scan as f64 * (self.to - self.from),
            });
        };
        let middle = stays + 0.5 * (fails - stays);
        let is_between = middle != stays && middle != fails;
        let wide = (fails - stays).abs() > self.resolution * middle.abs();
        (wide && is_between).then_some(middle)
    }
}

/// The last value that did not fail and the one that did, between which the search goes on; `None` before both are found.
pub(crate) fn bracket(runs: &[(f64, Failed)]) -> Option<[f64; 2]> {
    let mut stays = None;
    let mut fails = None;
    // The scan goes on while nothing fails; from the first failure on each run lies in the bracket.
    for (value, failed) in runs {
        match failed {
            Some(true) => fails = Some(*value),
            Some(false) => stays = Some(*value),
            None => {}
        }
    }
    Some([stays?, fails?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::procedure::tests::along;

    fn search(from: f64, to: f64, scan: u64, fails: impl Fn(f64) -> bool) -> Vec<(f64, Failed)> {
        let critical = Critical {
            along: along(),
            from,
            to,
            scan,
            resolution: 1e-9,
        };
        let mut runs = Vec::new();
        while let Some(value) = critical.next(&runs) {
            runs.push((value, Some(fails(value))));
        }
        runs
    }

    #[test]
    fn the_first_failure_of_a_scan_is_found_to_the_resolution() {
        // A second region without failures lies above the first with some.
        let fails = |x: f64| (2.3..2.7).contains(&x) || x > 4.0;
        let runs = search(1.0, 5.0, 16, fails);
        let [stays, falls] = bracket(&runs).unwrap();
        assert!(stays < 2.3 && 2.3 <= falls && falls - stays <= 1e-9 * 2.3);
        // Without the scan it is passed over, as one who asks for no scan must expect.
        let [stays, falls] = bracket(&search(1.0, 5.0, 1, fails)).unwrap();
        assert!(stays <= 4.0 && falls > 4.0);
        // Downwards as well.
        let [stays, falls] = bracket(&search(5.0, 1.0, 1, |x| x < 2.0)).unwrap();
        assert!(stays >= 2.0 && falls < 2.0 && stays - falls <= 2e-9);
    }

    #[test]
    fn a_search_without_a_bracket_ends() {
        assert_eq!(search(1.0, 2.0, 4, |_| false).len(), 5);
        assert_eq!(search(1.0, 2.0, 4, |_| true).len(), 1);
    }

    #[test]
    fn a_value_of_zero_is_bracketed_by_neighbours() {
        let runs = search(-1.0, 1.0, 1, |x| x > 0.0);
        assert!(runs.len() < 1200, "{}", runs.len());
    }
}
