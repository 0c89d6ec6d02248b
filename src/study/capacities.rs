//! Capacities: the intensity at which a case fails first, and the curves of incremental dynamic analyses.

use serde_json::{Value, json};

use super::file::Study;
use super::folder::Finished;
use super::fragility::{Capacity, fractile};
use super::procedure::Failed;

/// What the analysis of a case has found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CaseCapacity {
    pub case: u64,
    /// The capacity in the middle of the last bracket; censored where nothing failed. `None` where no run tells.
    pub capacity: Option<Capacity>,
    /// The largest value without a failure below the first with one, and that one.
    pub bracket: Option<[f64; 2]>,
    /// Number of runs.
    pub runs: usize,
    /// Whether the tolerance leaves the outcome of one of the two runs about it open.
    pub undecided: bool,
}

/// The parts of the sample below which fractiles are.
pub(crate) const PARTS: [f64; 3] = [0.16, 0.5, 0.84];

/// Values of the measure at which the fractiles of curves are taken.
const POINTS: usize = 101;

/// The capacities of all cases of an analysis that searches for them; none of another study.
pub(crate) fn of(study: &Study, finished: &Finished) -> Vec<CaseCapacity> {
    if study.procedure.along().is_none() {
        return Vec::new();
    }
    let capacity = |(&case, rows): (&u64, &Vec<super::rows::Row>)| {
        let runs: Vec<(f64, Failed)> = rows.iter().map(|r| (r.intensity, r.failed)).collect();
        let bracket = study.procedure.bracket(&runs);
        let survived = runs.iter().filter(|(_, failed)| *failed == Some(false));
        let survived = survived.map(|(level, _)| *level).reduce(f64::max);
        let capacity = match bracket {
            Some([below, above]) => Some(Capacity {
                intensity: below + 0.5 * (above - below),
                censored: false,
            }),
            None => survived.map(|intensity| Capacity {
                intensity,
                censored: true,
            }),
        };
        let about = |level: f64| bracket.is_some_and(|bracket| bracket.contains(&level));
        let undecided = rows.iter().any(|row| row.undecided && about(row.intensity));
        CaseCapacity {
            case,
            capacity,
            bracket,
            runs: rows.len(),
            undecided,
        }
    };
    finished.iter().map(capacity).collect()
}

/// Counts and counted fractiles; a fractile among censored capacities is not known.
pub(crate) fn json(capacities: &[CaseCapacity]) -> Value {
    let known = || capacities.iter().filter_map(|c| c.capacity);
    // Those that are censored are beyond what is known.
    let values = known().map(|c| {
        if c.censored {
            f64::INFINITY
        } else {
            c.intensity
        }
    });
    let counted = fractiles_of(values.collect());
    json!({
        "cases": capacities.len(),
        "known": known().filter(|c| !c.censored).count(),
        "censored": known().filter(|c| c.censored).count(),
        "untold": capacities.iter().filter(|c| c.capacity.is_none()).count(),
        "undecided": capacities.iter().filter(|c| c.undecided).count(),
        "counted": { "p16": counted[0], "p50": counted[1], "p84": counted[2] },
    })
}

/// 16, 50 and 84 % of a sample; `None` where that is not finite.
fn fractiles_of(mut values: Vec<f64>) -> [Option<f64>; 3] {
    if values.is_empty() {
        return [None; 3];
    }
    values.sort_by(f64::total_cmp);
    PARTS.map(|part| Some(fractile(&values, part)).filter(|value| value.is_finite()))
}

/// The curve of a case: intensities that grow, up to the first failure, with the measure; it starts at rest.
pub(crate) fn curve(rows: &[super::rows::Row], measure: usize, up_to: f64) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| row.failed == Some(false) && row.intensity < up_to)
        .map(|row| (row.intensity, row.values[measure]))
        .filter(|(_, value)| !value.is_nan())
        .collect();
    points.push((0.0, 0.0));
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// The intensity at which a curve first has a value, linear between its points; beyond its last point the capacity, infinite
/// where that is not known.
fn intensity_at(curve: &[(f64, f64)], value: f64, capacity: f64) -> f64 {
    for pair in curve.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        if y1 >= value && y1 > y0 {
            return x0 + (x1 - x0) * ((value - y0) / (y1 - y0)).clamp(0.0, 1.0);
        }
    }
    capacity
}

/// Fractile curves of an incremental dynamic analysis: of values of the measure the intensities that 16, 50 and 84 % of the cases
/// need for them.
pub(crate) fn fractiles(
    finished: &Finished,
    capacities: &[CaseCapacity],
    measure: usize,
) -> Vec<(f64, [Option<f64>; 3])> {
    let told = capacities.iter().filter(|c| c.capacity.is_some());
    let curves: Vec<(Vec<(f64, f64)>, f64)> = told
        .filter_map(|capacity| {
            let above = capacity.bracket.map_or(f64::INFINITY, |bracket| bracket[1]);
            let beyond = match capacity.capacity {
                Some(known) if !known.censored => known.intensity,
                _ => f64::INFINITY,
            };
            let rows = finished.get(&capacity.case)?;
            Some((curve(rows, measure, above), beyond))
        })
        .collect();
    let values = curves
        .iter()
        .flat_map(|(curve, _)| curve)
        .map(|point| point.1);
    let largest = values.fold(0.0, f64::max);
    if largest <= 0.0 {
        return Vec::new();
    }
    (0..POINTS)
        .map(|i| {
            let value = largest * i as f64 / (POINTS - 1) as f64;
            let intensities = curves
                .iter()
                .map(|(c, beyond)| intensity_at(c, value, *beyond));
            (value, fractiles_of(intensities.collect()))
        })
        .collect()
}

/// The fractile curves as JSON.
pub(crate) fn fractiles_json(
    study: &Study,
    measure: usize,
    fractiles: &[(f64, [Option<f64>; 3])],
) -> Value {
    let column = |i: usize| fractiles.iter().map(|(_, f)| f[i]).collect::<Vec<_>>();
    json!({
        "measure": study.measures[measure].name,
        "value": fractiles.iter().map(|(value, _)| *value).collect::<Vec<_>>(),
        "p16": column(0),
        "p50": column(1),
        "p84": column(2),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_read_where_it_first_has_a_value() {
        let curve = [(0.0, 0.0), (0.2, 1.0), (0.4, 0.5), (0.6, 3.0)];
        assert_eq!(intensity_at(&curve, 0.0, 0.7), 0.0);
        assert_eq!(intensity_at(&curve, 0.5, 0.7), 0.1);
        assert_eq!(intensity_at(&curve, 1.75, 0.7), 0.5);
        assert_eq!(intensity_at(&curve, 3.1, 0.7), 0.7);
    }

    #[test]
    fn a_fractile_among_censored_capacities_is_not_known() {
        let values = vec![0.5, 0.7, 1.0, f64::INFINITY, f64::INFINITY];
        assert_eq!(
            fractiles_of(values),
            [Some(0.5 + 0.64 * 0.2), Some(1.0), None]
        );
    }
}
