//! Pictures of a study: fragility curves, the fan of an incremental dynamic analysis, capacities over what varies, a cloud with its
//! regression, and all runs in plots of its columns against each other.

use super::capacities::{curve, fractiles};
use super::command::command;
use super::design::Level;
use super::fragility::Data;
use super::procedure::Procedure;
use super::rows::Row;
use super::summary::{Outcome, shown};
use super::table::{Cells, Column};
use crate::record::plot::{Chart, Curve, Dimension, Style, scatter_matrix};

/// A picture, with what a click on its points tells.
pub(crate) struct Picture {
    /// File name.
    pub name: &'static str,
    pub chart: Chart,
    /// Of the points, curve by curve, the commands that make them again; empty where there is none.
    pub notes: Vec<Vec<String>>,
}

/// File name of the plots of columns against each other.
const RUNS: &str = "runs.svg";

/// Size of a picture, in pixels.
const SIZE: (f64, f64) = (900.0, 420.0);

/// Points of a fitted curve.
const POINTS: usize = 200;

/// Most cases whose curves are drawn, and most runs that are points: more are a surface.
const MOST_CURVES: usize = 100;
const MOST_POINTS: usize = 2_000;

/// Number of columns that are first plotted against each other.
const COLUMNS: usize = 4;

/// All pictures of a study but that of its columns.
pub(crate) fn pictures(outcome: &Outcome) -> Vec<Picture> {
    let all = [
        fragility(outcome),
        fan(outcome),
        capacities(outcome),
        cloud(outcome),
    ];
    all.into_iter().flatten().collect()
}

/// All pictures as files: their names and contents.
pub(crate) fn files(outcome: &Outcome, columns: &[Column]) -> Vec<(&'static str, String)> {
    let picture = |picture: Picture| {
        let chart = Chart {
            title: title(outcome, &picture.chart.title),
            ..picture.chart
        };
        (picture.name, chart.svg(SIZE))
    };
    let mut files: Vec<_> = pictures(outcome).into_iter().map(picture).collect();
    files.extend(runs(outcome, columns).map(|picture| (RUNS, picture)));
    files
}

/// Shares of failures, as they were counted: of stripes at each, of capacities below each.
fn shares(data: &Data) -> Vec<(f64, f64)> {
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

/// Fitted curves, of all cases and of each group, up to the largest intensity with data; what was counted as points.
fn fragility(outcome: &Outcome) -> Option<Picture> {
    let counted: Vec<_> = outcome
        .fragilities
        .iter()
        .map(|f| shares(&f.data))
        .collect();
    let intensities = counted.iter().flatten().map(|point| point.0);
    let largest = intensities.fold(0.0, f64::max);
    let mut curves: Vec<Curve> = Vec::new();
    for fragility in &outcome.fragilities {
        let Ok(fit) = &fragility.fit else { continue };
        let at = |i: usize| largest * i as f64 / POINTS as f64;
        let point = |x: f64| (x, if x > 0.0 { fit.probability(x) } else { 0.0 });
        curves.push(Curve {
            label: fragility.group.clone().unwrap_or("lognormal fit".into()),
            points: (0..=POINTS).map(at).map(point).collect(),
            ..Curve::default()
        });
    }
    // Every run of a cloud has an intensity of its own, and is 0 or 1.
    let all = outcome.fragilities.first()?;
    let label = match &all.data {
        Data::Stripes(stripes) if stripes.iter().all(|s| s.runs < 2) => "runs: failed or not",
        _ => "share of failures, counted",
    };
    curves.push(Curve {
        label: label.into(),
        points: counted.into_iter().next()?,
        style: Style::Points,
    });
    Some(Picture {
        name: "fragility.svg",
        chart: Chart {
            title: "Probability of failure".into(),
            x: intensity(outcome),
            y: Dimension::linear("probability of failure", "1"),
            curves,
            marks: false,
        },
        notes: Vec::new(),
    })
}

/// What a picture that stands alone shows, of which study.
fn title(outcome: &Outcome, what: &str) -> String {
    match &outcome.study.title {
        Some(title) => format!("{what}. {title}"),
        None => what.to_owned(),
    }
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

/// The curves of an incremental dynamic analysis, and their 16, 50 and 84 %.
fn fan(outcome: &Outcome) -> Option<Picture> {
    let study = outcome.study;
    let Procedure::Ida(ida) = &study.procedure else {
        return None;
    };
    let measure = ida.curve?;
    let mut cases = Vec::new();
    let mut commands = Vec::new();
    for capacity in outcome.capacities.iter().take(MOST_CURVES) {
        let above = capacity.bracket.map_or(f64::INFINITY, |bracket| bracket[1]);
        let rows = outcome.finished.get(&capacity.case)?;
        for (level, value) in curve(rows, measure, above) {
            let row = rows.iter().find(|row| row.intensity == level);
            cases.push((value, level));
            commands.push(row.map_or(String::new(), |row| command(study, row)));
        }
        // What is not a number parts the curve of a case from that of the next.
        cases.push((f64::NAN, f64::NAN));
        commands.push(String::new());
    }
    let mut curves = vec![Curve {
        label: "cases".into(),
        points: cases,
        style: Style::Background,
    }];
    let fractiles = fractiles(outcome.finished, &outcome.capacities, measure);
    for (i, label) in ["16 %", "50 %", "84 %"].into_iter().enumerate() {
        let points = fractiles
            .iter()
            .filter_map(|(value, f)| Some((*value, f[i]?)));
        curves.push(Curve {
            label: label.into(),
            points: points.collect(),
            ..Curve::default()
        });
    }
    let measure = &study.measures[measure];
    Some(Picture {
        name: "ida.svg",
        chart: Chart {
            title: "Incremental dynamic analysis".into(),
            x: Dimension::linear(&measure.name, &measure.unit),
            y: intensity(outcome),
            curves,
            marks: false,
        },
        notes: vec![commands],
    })
}

/// Capacities over the one number that varies besides, such as an overturning spectrum; a curve for each value of all else.
fn capacities(outcome: &Outcome) -> Option<Picture> {
    let study = outcome.study;
    let along = study.procedure.along()?;
    let is_number = |case: u64, k: usize| matches!(study.design.levels(case)[k], Level::Number(_));
    let first = outcome.capacities.first()?.case;
    let numbers = (0..study.design.factors().count()).filter(|&k| is_number(first, k));
    let [over] = numbers.collect::<Vec<_>>()[..] else {
        return None;
    };
    let factor = study.design.factors().nth(over)?;
    let mut curves: Vec<Curve> = Vec::new();
    let mut notes: Vec<Vec<String>> = Vec::new();
    for found in &outcome.capacities {
        let levels = study.design.levels(found.case);
        let (Level::Number(x), Some(known)) = (levels[over], found.capacity) else {
            continue;
        };
        if known.censored {
            continue;
        }
        let others = levels.iter().enumerate().filter(|(k, _)| *k != over);
        let others: Vec<String> = others.map(|(_, level)| shown(*level)).collect();
        let label = others.join(", ");
        let i = curves.iter().position(|curve| curve.label == label);
        let i = i.unwrap_or_else(|| {
            notes.push(Vec::new());
            curves.push(Curve {
                label,
                ..Curve::default()
            });
            curves.len() - 1
        });
        curves[i].points.push((x, known.intensity));
        // The run that fails at the upper end of the bracket.
        let fails = found.bracket.map(|bracket| bracket[1]);
        let mut rows = outcome.finished.get(&found.case)?.iter();
        let row = rows.find(|row| Some(row.intensity) == fails);
        notes[i].push(row.map_or(String::new(), |row| command(study, row)));
    }
    if let [curve] = &mut curves[..] {
        curve.label = "capacities".into();
    }
    (!curves.is_empty()).then(|| Picture {
        name: "capacities.svg",
        chart: Chart {
            title: "Least value that fails".into(),
            x: Dimension::linear(&factor.path, factor.unit.as_deref().unwrap_or("1")),
            y: Dimension::linear(&along.path, along.unit.as_deref().unwrap_or("1")),
            curves,
            marks: true,
        },
        notes,
    })
}

/// A cloud and its regression.
fn cloud(outcome: &Outcome) -> Option<Picture> {
    let study = outcome.study;
    let cloud = outcome.cloud.as_ref()?;
    let shown = || cloud.points.iter().take(MOST_POINTS);
    let mut curves = vec![Curve {
        label: "runs".into(),
        points: shown().map(|(_, x, demand)| (*x, *demand)).collect(),
        style: Style::Points,
    }];
    if let Ok(line) = cloud.line {
        let xs = || cloud.points.iter().map(|(_, x, _)| *x);
        let ends = [xs().fold(f64::INFINITY, f64::min), xs().fold(0.0, f64::max)];
        // One standard deviation to both sides.
        for (label, shift) in [("regression", 0.0), ("16 %", -1.0), ("84 %", 1.0)] {
            let factor = libm::exp(shift * line.dispersion);
            curves.push(Curve {
                label: label.into(),
                points: ends.map(|x| (x, factor * line.at(x))).into(),
                style: match shift == 0.0 {
                    true => Style::Line,
                    false => Style::Background,
                },
            });
        }
    }
    let measure = &study.measures[cloud.measure];
    let along = intensity(outcome);
    Some(Picture {
        name: "cloud.svg",
        chart: Chart {
            title: "Cloud".into(),
            x: Dimension::log(&along.title, &along.unit),
            y: Dimension::log(&measure.name, &measure.unit),
            curves,
            marks: false,
        },
        notes: vec![shown().map(|(row, ..)| command(study, row)).collect()],
    })
}

/// The numbers of a column that has some that differ; NaN where there is none.
pub(crate) fn numbers(column: &Column) -> Option<Vec<f64>> {
    let values: Vec<f64> = match &column.cells {
        Cells::Numbers(cells) => cells.iter().map(|x| x.unwrap_or(f64::NAN)).collect(),
        Cells::Counts(cells) => cells
            .iter()
            .map(|n| n.map_or(f64::NAN, |n| n as f64))
            .collect(),
        Cells::Flags(_) | Cells::Texts(_) => return None,
    };
    let mut known = values.iter().filter(|x| !x.is_nan());
    let first = known.next()?;
    known.any(|x| x != first).then_some(values)
}

/// The columns that say most: the intensity, what decides or is measured first, then what varies; in the order of the table.
pub(crate) fn default_columns(outcome: &Outcome, columns: &[Column]) -> Vec<usize> {
    let study = outcome.study;
    let along = intensity(outcome).title;
    let decides = study.failure.as_ref().and_then(|f| f.measure());
    let names = std::iter::once(along.as_str())
        .chain(decides.map(|i| study.measures[i].name.as_str()))
        .chain(study.measures.first().map(|m| m.name.as_str()))
        .chain(study.design.factors().map(|factor| factor.path.as_str()))
        .chain(study.measures.iter().map(|m| m.name.as_str()));
    let mut chosen: Vec<usize> = Vec::new();
    for name in names {
        let found = columns.iter().position(|column| column.name == name);
        let Some(i) = found.filter(|i| !chosen.contains(i)) else {
            continue;
        };
        if chosen.len() < COLUMNS && numbers(&columns[i]).is_some() {
            chosen.push(i);
        }
    }
    chosen.sort_unstable();
    chosen
}

/// Every run in plots of the columns that say most against each other; `None` where fewer than two do.
fn runs(outcome: &Outcome, columns: &[Column]) -> Option<String> {
    let rows: Vec<&Row> = outcome.finished.values().flatten().collect();
    let stride = rows.len().div_ceil(MOST_POINTS).max(1);
    let chosen = default_columns(outcome, columns);
    let shown: Vec<(Dimension, Vec<f64>)> = chosen
        .into_iter()
        .filter_map(|i| {
            let values = numbers(&columns[i])?.into_iter().step_by(stride);
            let dimension = Dimension::linear(&columns[i].name, &columns[i].unit);
            Some((dimension, values.collect()))
        })
        .collect();
    let groups = match outcome.study.failure.is_some() {
        true => vec!["not failed", "failed", "not told"],
        false => vec![""],
    };
    let group = |row: &&Row| match row.failed {
        _ if groups.len() == 1 => 0,
        Some(failed) => usize::from(failed),
        None => 2,
    };
    let of: Vec<usize> = rows.iter().step_by(stride).map(group).collect();
    let heading = title(outcome, "All runs");
    (shown.len() > 1).then(|| scatter_matrix(&heading, &shown, &groups, &of))
}
