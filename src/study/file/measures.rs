//! What a study file measures, and what it calls a failure.

use crate::hybrid::Problem;
use crate::run::ColumnKind;
use crate::scene::check::{Checked, unknown_name};
use crate::scene::error::{SceneError, SceneErrorKind, SceneErrors};
use crate::scene::format::transition_names;
use crate::scene::source::Span;
use crate::scene::template::Template;
use crate::study::measure::{Failure, Measure, What, ignores, limits, quantities};

/// What can be measured of a scene.
struct Known {
    quantities: Vec<(String, String, ColumnKind)>,
    transitions: Vec<&'static str>,
    limits: Vec<String>,
    ignored: Vec<&'static str>,
}

impl Known {
    fn new(problem: &Problem, template: &Template) -> Known {
        Known {
            quantities: quantities(problem),
            transitions: transition_names(&template.model.variants),
            limits: limits(problem),
            ignored: (problem.variant().limits.iter())
                .map(|limit| limit.name)
                .filter(|limit| ignores(problem, limit))
                .collect(),
        }
    }

    /// The measure of a name.
    fn measure(&self, name: &str, place: &Span) -> Result<Measure, SceneError> {
        let kinds = ["peak", "max", "min", "end", "count", "reached", "time"];
        let (kind, of) = name.split_once('.').unwrap_or((name, ""));
        let owned = of.to_owned();
        let measure = |unit: &str, what| Measure {
            name: name.to_owned(),
            unit: unit.to_owned(),
            what,
        };
        // Discrete states have no extremes, and the inputs are known.
        let quantity = |extremes: bool| {
            let all = self.quantities.iter();
            let known = all.filter(|(_, _, group)| !(extremes && *group == ColumnKind::Discrete));
            let known: Vec<_> = known.collect();
            let found = known.iter().find(|(known, ..)| known == of);
            found.map(|(_, unit, _)| unit.clone()).ok_or_else(|| {
                let names: Vec<&str> = known.iter().map(|(name, ..)| name.as_str()).collect();
                unknown_name("quantity", of, &names, place)
            })
        };
        let limit = || match self.limits.iter().any(|limit| limit == of) {
            true => Ok(()),
            false => Err(self.no_limit(of, place)),
        };
        Ok(match kind {
            "peak" => measure(&quantity(true)?, What::Peak(owned)),
            "max" => measure(&quantity(true)?, What::Max(owned)),
            "min" => measure(&quantity(true)?, What::Min(owned)),
            "end" => measure(&quantity(false)?, What::End(owned)),
            "count" if of.is_empty() => measure("1", What::Count(None)),
            "count" => {
                self.transition(of, place)?;
                measure("1", What::Count(Some(owned)))
            }
            "reached" => {
                limit()?;
                measure("1", What::Reached(owned))
            }
            "time" => {
                limit()?;
                measure("s", What::Time(owned))
            }
            _ => {
                let error = unknown_name("kind of measure", kind, &kinds, place);
                return Err(error);
            }
        })
    }

    fn no_limit(&self, name: &str, place: &Span) -> SceneError {
        if self.ignored.contains(&name) {
            let limit = name.to_owned();
            return SceneError::new(SceneErrorKind::Ignored { limit }, place)
                .help("`end` or `continue` among the `limits` of the scene has it looked for");
        }
        let known: Vec<&str> = self.limits.iter().map(String::as_str).collect();
        unknown_name("limit state", name, &known, place)
    }

    fn transition(&self, name: &str, place: &Span) -> Result<(), SceneError> {
        match self.transitions.contains(&name) {
            true => Ok(()),
            false => Err(unknown_name("transition", name, &self.transitions, place)),
        }
    }
}

/// The measures of a study; if it names none, peaks and ends of all coordinates, the number of transitions and the limit states.
pub(super) fn measures(
    checked: &Checked,
    problem: &Problem,
    template: &Template,
) -> Result<Vec<Measure>, SceneErrors> {
    let known = Known::new(problem, template);
    if let Some(given) = checked.get("measure") {
        let mut measures: Vec<Measure> = Vec::new();
        for name in given.list() {
            let measure = known.measure(name.text(), &name.place)?;
            if !measures.contains(&measure) {
                measures.push(measure);
            }
        }
        return Ok(measures);
    }
    let coordinates = known.quantities.iter();
    let coordinates = coordinates.filter(|(_, _, group)| *group == ColumnKind::Coordinate);
    let of_coordinates = coordinates.flat_map(|(c, ..)| [format!("peak.{c}"), format!("end.{c}")]);
    let of_limits = known
        .limits
        .iter()
        .flat_map(|limit| [format!("reached.{limit}"), format!("time.{limit}")]);
    let names = of_coordinates.chain(["count".to_owned()]).chain(of_limits);
    let measures = names.map(|name| known.measure(&name, &checked.place));
    Ok(measures.collect::<Result<_, _>>()?)
}

/// When a run has failed; what decides it is measured.
pub(super) fn failure(
    checked: &Checked,
    problem: &Problem,
    template: &Template,
    measures: &mut Vec<Measure>,
) -> Result<Option<Failure>, SceneErrors> {
    let known = Known::new(problem, template);
    let Some(failure) = checked.get("failure") else {
        return Ok(None);
    };
    if let Some(limit) = failure.get("limit") {
        let name = limit.text();
        return match known.limits.iter().any(|known| known == name) {
            true => Ok(Some(Failure::Limit(name.to_owned()))),
            false => Err(known.no_limit(name, &limit.place).into()),
        };
    }
    if let Some(transition) = failure.get("transition") {
        known.transition(transition.text(), &transition.place)?;
        return Ok(Some(Failure::Transition(transition.text().to_owned())));
    }
    let Some(name) = failure.get("measure") else {
        unreachable!("checked to be a failure: {failure:?}")
    };
    let measure = known.measure(name.text(), &name.place)?;
    let index = measures.iter().position(|known| *known == measure);
    let index = index.unwrap_or_else(|| {
        measures.push(measure);
        measures.len() - 1
    });
    let above = failure.get("above");
    let bound = above.or(failure.get("below"));
    let Some(bound) = bound else {
        unreachable!("checked to have a level: {failure:?}")
    };
    let unit = &measures[index].unit;
    let level = super::bound(bound, unit)?;
    Ok(Some(Failure::Measure {
        index,
        above: above.is_some(),
        level,
    }))
}
