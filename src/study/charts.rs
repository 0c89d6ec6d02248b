//! Pictures of a study: fragility curves, and the fan of an incremental dynamic analysis.

use super::capacities::{curve, fractiles};
use super::fragility::Data;
use super::procedure::Procedure;
use super::summary::Outcome;
use crate::record::plot::{Chart, Curve, Dimension};

/// File names.
pub(crate) const FRAGILITY: &str = "fragility.svg";
pub(crate) const FAN: &str = "ida.svg";

/// Size of a picture, in pixels.
const SIZE: (f64, f64) = (900.0, 420.0);

/// Points of a fitted curve.
const POINTS: usize = 200;

/// Most cases whose curves are drawn: more are a surface.
const MOST: usize = 100;

/// The pictures of a study that has any, with their names.
pub(crate) fn pictures(outcome: &Outcome) -> Vec<(&'static str, String)> {
    let fragility = fragility(outcome).map(|chart| (FRAGILITY, chart.svg(SIZE)));
    let fan = fan(outcome).map(|chart| (FAN, chart.svg(SIZE)));
    fragility.into_iter().chain(fan).collect()
}

/// Shares of failures, as they were counted: of stripes at each, of capacities below each.
pub(crate) fn shares(data: &Data) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = match data {
        Data::Stripes(stripes) => stripes
            .iter()
            .filter(|s| s.runs > 0)
            .map(|s| (s.intensity, s.failures as f64 / s.runs as f64))
            .collect(),
        Data::Capacities(capacities) => {
            let mut known: Vec<f64> = capacities
                .iter()
                .filter(|c| !c.censored)
                .map(|c| c.intensity)
                .collect();
            known.sort_by(f64::total_cmp);
            let all = capacities.len() as f64;
            let share = |(i, x): (usize, f64)| (x, (i as f64 + 0.5) / all);
            known.into_iter().enumerate().map(share).collect()
        }
    };
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// The largest intensity of all data, up to which curves are drawn.
pub(crate) fn largest(outcome: &Outcome) -> f64 {
    let points = outcome.fragilities.iter().flat_map(|f| shares(&f.data));
    points.map(|point| point.0).fold(0.0, f64::max)
}

fn fragility(outcome: &Outcome) -> Option<Chart> {
    let largest = largest(outcome);
    let all = outcome.fragilities.first()?;
    let mut curves: Vec<Curve> = outcome
        .fragilities
        .iter()
        .filter_map(|fragility| {
            let fit = fragility.fit.as_ref().ok()?;
            let at = |i: usize| largest * i as f64 / POINTS as f64;
            let point = |x: f64| (x, if x > 0.0 { fit.probability(x) } else { 0.0 });
            Some(Curve {
                label: fragility.group.clone().unwrap_or("lognormal fit".into()),
                points: (0..=POINTS).map(at).map(point).collect(),
            })
        })
        .collect();
    let counted = shares(&all.data);
    // Every run of a cloud has an intensity of its own, and its share is no curve.
    let is_cloud = match &all.data {
        Data::Stripes(stripes) => stripes.iter().all(|s| s.runs < 2),
        Data::Capacities(_) => false,
    };
    if !is_cloud && !counted.is_empty() {
        curves.push(Curve {
            label: "share of failures, counted".into(),
            points: counted,
        });
    }
    (!curves.is_empty()).then(|| Chart {
        title: outcome.study.title.clone().unwrap_or_default(),
        x: intensity(outcome),
        y: Dimension::linear("probability of failure", "1"),
        curves,
        marks: false,
    })
}

/// The axis of intensities.
fn intensity(outcome: &Outcome) -> Dimension {
    let study = outcome.study;
    let (path, unit) = match &study.procedure {
        Procedure::Once { intensity, .. } => intensity
            .and_then(|k| study.design.factors().nth(k))
            .map_or(("", None), |f| (&*f.path, f.unit.as_deref())),
        _ => study
            .procedure
            .along()
            .map_or(("", None), |a| (&*a.path, a.unit.as_deref())),
    };
    Dimension::linear(path, unit.unwrap_or("1"))
}

fn fan(outcome: &Outcome) -> Option<Chart> {
    let study = outcome.study;
    let Procedure::Ida(ida) = &study.procedure else {
        return None;
    };
    let measure = ida.curve?;
    // One line, so that all cases have one colour: along each curve and back to rest, where all of them begin.
    let mut fan = Vec::new();
    for capacity in outcome.capacities.iter().take(MOST) {
        let above = capacity.bracket.map_or(f64::INFINITY, |bracket| bracket[1]);
        let rows = outcome.finished.get(&capacity.case).into_iter();
        let points: Vec<(f64, f64)> = rows
            .flat_map(|rows| curve(rows, measure, above))
            .map(|(intensity, value)| (value, intensity))
            .collect();
        fan.extend(points.iter().chain(points.iter().rev()));
    }
    let mut curves = vec![Curve {
        label: "cases".into(),
        points: fan,
    }];
    let fractiles = fractiles(outcome.finished, &outcome.capacities, measure);
    for (i, label) in ["16 %", "50 %", "84 %"].into_iter().enumerate() {
        let points = fractiles
            .iter()
            .filter_map(|(value, f)| Some((*value, f[i]?)));
        curves.push(Curve {
            label: label.into(),
            points: points.collect(),
        });
    }
    let measure = &study.measures[measure];
    let along = intensity(outcome);
    (!curves.is_empty()).then(|| Chart {
        title: study.title.clone().unwrap_or_default(),
        x: Dimension::linear(&measure.name, &measure.unit),
        y: along,
        curves,
        marks: false,
    })
}
