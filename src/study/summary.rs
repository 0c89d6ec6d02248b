//! What a study says: counts, statistics of its measures, fragility, capacities.

use serde_json::{Map, Value, json};

use super::capacities::{self, CaseCapacity};
use super::cloud::Cloud;
use super::design::Level;
use super::file::Study;
use super::folder::Finished;
use super::fragility::{self, Bootstrap, Data, Interval, Units, fractile};
use super::procedure::Procedure;
use super::rows::{Row, Status};
use super::table::Column;

/// Version of the format of summaries of studies, raised when a key changes its meaning or goes.
const FORMAT: u32 = 1;

/// Seed of the bootstrap: its intervals are the same whenever the same study is counted.
const SEED: u64 = 1;

/// A fragility: its data and what was fitted to them.
#[derive(Debug, Clone)]
pub(crate) struct Fragility {
    /// The value of what groups are made of; `None` for all cases.
    pub group: Option<String>,
    pub data: Data,
    pub fit: std::result::Result<fragility::Fit, String>,
    pub bootstrap: Option<Bootstrap>,
}

/// All that is known of a finished study.
pub(crate) struct Outcome<'s> {
    pub study: &'s Study,
    pub finished: &'s Finished,
    pub capacities: Vec<CaseCapacity>,
    /// Of all cases, then of each group; none where the study has no intensity or no failure.
    pub fragilities: Vec<Fragility>,
    /// Of a cloud analysis.
    pub cloud: Option<Cloud<'s>>,
}

impl<'s> Outcome<'s> {
    /// Counts and fits.
    pub fn new(study: &'s Study, finished: &'s Finished) -> Self {
        let capacities = capacities::of(study, finished);
        let mut groups: Vec<Option<String>> = vec![None];
        if let Some(factor) = study.group {
            for case in finished.keys() {
                let value = Some(shown(study.design.levels(*case)[factor]));
                if !groups.contains(&value) {
                    groups.push(value);
                }
            }
        }
        let fragility = |group: Option<String>| {
            let belongs = |case: u64| match (study.group, &group) {
                (Some(factor), Some(value)) => shown(study.design.levels(case)[factor]) == *value,
                _ => true,
            };
            let units = units(study, finished, &capacities, &belongs)?;
            Some(fitted(group.clone(), &units))
        };
        let fragilities = groups.into_iter().filter_map(fragility).collect();
        Outcome {
            study,
            finished,
            capacities,
            fragilities,
            cloud: Cloud::new(study, finished),
        }
    }

    /// Number of rows with a property.
    fn count(&self, has: impl Fn(&Row) -> bool) -> usize {
        self.finished
            .values()
            .flatten()
            .filter(|row| has(row))
            .count()
    }

    /// The summary as JSON; nothing in it depends on the machine or the time of day.
    pub fn json(&self, columns: &[Column]) -> Value {
        let study = self.study;
        let of = |status: Status| self.count(|row| row.status == status);
        let described = |column: &Column| json!({ "name": column.name, "unit": column.unit, "meaning": column.meaning });
        let mut summary = json!({
            "format": FORMAT,
            "title": study.title,
            "kind": study.procedure.name(),
            "model": study.template.model.name,
            "key": study.key,
            "engine": env!("CARGO_PKG_VERSION"),
            "cases": self.finished.len(),
            "runs": {
                "total": self.count(|_| true),
                "ok": of(Status::Ok),
                "stopped": of(Status::Stopped),
                "refused": of(Status::Refused),
                "reasons": self.reasons(),
            },
            "measures": self.measures(),
            "columns": columns.iter().map(described).collect::<Vec<_>>(),
        });
        let Value::Object(object) = &mut summary else {
            unreachable!("it is written as an object")
        };
        if study.failure.is_some() {
            let failures = json!({
                "failed": self.count(|row| row.failed == Some(true)),
                "survived": self.count(|row| row.failed == Some(false)),
                "untold": self.count(|row| row.failed.is_none()),
                "undecided": self.count(|row| row.undecided),
            });
            object.insert("failures".into(), failures);
        }
        if let Some((all, groups)) = self.fragilities.split_first() {
            object.insert("fragility".into(), all.json());
            if !groups.is_empty() {
                let groups: Vec<Value> = groups.iter().map(Fragility::json).collect();
                object.insert("fragility_by_group".into(), json!(groups));
            }
        }
        if let Some(cloud) = &self.cloud {
            object.insert("cloud".into(), cloud.json(study));
        }
        if study.procedure.along().is_some() {
            object.insert("capacities".into(), capacities::json(&self.capacities));
        }
        if let Procedure::Ida(ida) = &study.procedure
            && let Some(curve) = ida.curve
        {
            let fractiles = capacities::fractiles(self.finished, &self.capacities, curve);
            object.insert(
                "ida".into(),
                capacities::fractiles_json(study, curve, &fractiles),
            );
        }
        summary
    }

    /// How often each reason occurs, for which a run is not ok; numbers that it ends with, in parentheses, are of one run.
    fn reasons(&self) -> Map<String, Value> {
        let mut reasons: Map<String, Value> = Map::new();
        let rows = self.finished.values().flatten();
        for reason in rows.filter_map(|row| row.reason.as_deref()) {
            let reason = match reason.strip_suffix(')').and_then(|r| r.rsplit_once(" (")) {
                Some((words, _)) => words,
                None => reason,
            };
            let count = reasons.get(reason).and_then(Value::as_u64).unwrap_or(0);
            reasons.insert(reason.to_owned(), json!(count + 1));
        }
        reasons
    }

    /// Statistics of each measure over the runs that are ok and have it.
    fn measures(&self) -> Map<String, Value> {
        let all = self.study.measures.iter().enumerate();
        let statistics = all.map(|(i, measure)| {
            let rows = self.finished.values().flatten();
            let values = rows
                .filter(|row| row.status == Status::Ok)
                .map(|row| row.values[i])
                .filter(|value| !value.is_nan());
            (
                measure.name.clone(),
                statistics(values.collect(), &measure.unit),
            )
        });
        statistics.collect()
    }
}

fn statistics(mut values: Vec<f64>, unit: &str) -> Value {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    if count == 0 {
        return json!({ "unit": unit, "count": 0 });
    }
    let n = count as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    let at = |p: f64| fractile(&values, p);
    json!({
        "unit": unit,
        "count": count,
        "mean": mean,
        "sd": (count > 1).then(|| (squares / (n - 1.0)).sqrt()),
        "min": values[0],
        "p16": at(0.16),
        "median": at(0.5),
        "p84": at(0.84),
        "max": values[count - 1],
    })
}

/// A value of what varies as a text.
pub(crate) fn shown(level: Level) -> String {
    match level {
        Level::Number(x) => crate::record::exact(x),
        Level::Text(text) => text.to_owned(),
    }
}

/// What a fragility is fitted to; `None` where the study has none.
fn units(
    study: &Study,
    finished: &Finished,
    capacities: &[CaseCapacity],
    belongs: &dyn Fn(u64) -> bool,
) -> Option<Units> {
    study.failure.as_ref()?;
    let intensity = match &study.procedure {
        Procedure::Once { intensity, .. } => (*intensity)?,
        // Critical values over a grid, such as a spectrum, are no sample.
        Procedure::Critical(_) if !study.design.is_sample() => return None,
        _ => {
            let all = capacities.iter().filter(|c| belongs(c.case));
            return Some(Units::Capacities(all.filter_map(|c| c.capacity).collect()));
        }
    };
    let mut intensities: Vec<f64> = Vec::new();
    // Runs of cases that differ in the intensity alone belong together: in nested order it is the last digit of stripes.
    let stripes = match study.procedure {
        Procedure::Once {
            kind: super::procedure::Kind::Stripes,
            ..
        } => study
            .design
            .blocks
            .last()
            .map_or(1, |block| block.count as u64),
        _ => 1,
    };
    let mut units: std::collections::BTreeMap<u64, Vec<(usize, bool)>> = Default::default();
    let mut places: std::collections::BTreeMap<u64, usize> = Default::default();
    for row in finished.values().flatten().filter(|row| belongs(row.case)) {
        let Level::Number(level) = study.design.levels(row.case)[intensity] else {
            return None;
        };
        let place = *places.entry(level.to_bits()).or_insert_with(|| {
            intensities.push(level);
            intensities.len() - 1
        });
        let unit = units.entry(row.case / stripes).or_default();
        unit.extend(row.failed.map(|failed| (place, failed)));
    }
    Some(Units::Runs {
        intensities,
        units: units.into_values().collect(),
    })
}

fn fitted(group: Option<String>, units: &Units) -> Fragility {
    let data = units.data();
    let wrong = match &data {
        Data::Stripes(stripes) => stripes
            .iter()
            .find(|s| s.intensity < 0.0 || s.intensity == 0.0 && s.failures > 0)
            .map(|s| s.intensity),
        Data::Capacities(capacities) => {
            let found = capacities.iter().find(|c| c.intensity <= 0.0);
            found.map(|c| c.intensity)
        }
    };
    let fit = match wrong {
        Some(intensity) => Err(format!(
            "a lognormal fragility is about positive intensities, and there is one of {intensity} with a failure"
        )),
        None => fragility::fit(&data).map_err(|problem| problem.to_string()),
    };
    let bootstrap = fit.is_ok().then(|| units.bootstrap(SEED));
    Fragility {
        group,
        data,
        fit,
        bootstrap,
    }
}

impl Fragility {
    /// As `dalembert fragility --json` has it, with the intervals of the bootstrap.
    pub fn json(&self) -> Value {
        let fit = self.fit.as_ref().ok();
        let limits = |interval: Option<Interval>| interval.map(|limits| json!(limits));
        json!({
            "group": self.group,
            "theta": fit.map(|f| f.theta),
            "beta": fit.map(|f| f.beta),
            "theta_interval": limits(fit.map(|f| f.theta_interval)),
            "beta_interval": limits(fit.map(|f| f.beta_interval)),
            "theta_bootstrap": limits(self.bootstrap.map(|b| b.theta)),
            "beta_bootstrap": limits(self.bootstrap.map(|b| b.beta)),
            "bootstrap_samples": self.bootstrap.map(|b| b.samples),
            "bootstrap_unfitted": self.bootstrap.map(|b| b.unfitted),
            "problem": self.fit.as_ref().err(),
        })
    }
}
