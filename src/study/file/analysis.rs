//! What is run for each case: which analysis, along which path.

use super::{Names, cases, number};
use crate::scene::check::{Checked, unknown_name};
use crate::scene::error::{SceneError, SceneErrorKind, SceneErrors};
use crate::study::design::Design;
use crate::study::measure::{Failure, Measure};
use crate::study::procedure::{Along, Critical, Ida, Kind, Procedure};

/// Where analyses name the path of what they vary.
pub(super) const PATHS: [(&str, &str); 4] = [
    ("stripes", "intensity"),
    ("cloud", "intensity"),
    ("ida", "intensity"),
    ("critical", "value"),
];

/// The analysis of a study; the intensities of stripes are the last block of the design.
pub(super) fn procedure(
    checked: &Checked,
    names: &Names,
    design: &mut Design,
) -> Result<Procedure, SceneErrors> {
    if let Some(stripes) = checked.get("stripes") {
        let path = text(stripes, "intensity");
        let levels = stripes.get("levels").expect("a required key");
        let block = cases::levels(path, levels, names)?;
        twice(design, path, stripes)?;
        design.blocks.push(block);
        return Ok(Procedure::Once {
            kind: Kind::Stripes,
            intensity: design.factor(path),
        });
    }
    if let Some(cloud) = checked.get("cloud") {
        let path = text(cloud, "intensity");
        let Some(intensity) = design.factor(path) else {
            let known: Vec<&str> = design.factors().map(|f| f.path.as_str()).collect();
            let place = &cloud.get("intensity").expect("a required key").place;
            return Err(unknown_name("path that varies", path, &known, place).into());
        };
        return Ok(Procedure::Once {
            kind: Kind::Cloud,
            intensity: Some(intensity),
        });
    }
    if let Some(ida) = checked.get("ida") {
        let along = along(ida, "intensity", names)?;
        twice(design, &along.path, ida)?;
        return Ok(Procedure::Ida(Ida {
            along,
            first: number(ida, "first"),
            step: number(ida, "step"),
            increment: ida.get("increment").map_or(0.0, Checked::number),
            runs: ida
                .get("runs")
                .map_or(super::format::IDA_RUNS, Checked::number) as usize,
            resolution: ida
                .get("resolution")
                .map_or(super::format::IDA_RESOLUTION, Checked::number),
            curve: None,
        }));
    }
    if let Some(critical) = checked.get("critical") {
        let along = along(critical, "value", names)?;
        twice(design, &along.path, critical)?;
        let [from, to] = ["from", "to"].map(|key| number(critical, key));
        if from == to {
            let kind = SceneErrorKind::OutOfRange {
                value: to,
                range: format!("different from {from}, where the search begins"),
            };
            let place = &critical.get("to").expect("a required key").place;
            return Err(SceneError::new(kind, place).into());
        }
        return Ok(Procedure::Critical(Critical {
            along,
            from,
            to,
            scan: critical.get("scan").map_or(1.0, Checked::number) as u64,
            resolution: critical
                .get("resolution")
                .map_or(super::format::CRITICAL_RESOLUTION, Checked::number),
        }));
    }
    let kind = match checked.get("random") {
        Some(_) => Kind::MonteCarlo,
        None => Kind::Sweep,
    };
    if design.blocks.is_empty() {
        let keys = vec!["vary, cases, random, stripes, ida or critical".to_owned()];
        let error = SceneError::new(SceneErrorKind::MissingKey { keys }, &checked.place);
        return Err(error.help("a study says what varies").into());
    }
    Ok(Procedure::Once {
        kind,
        intensity: None,
    })
}

fn text<'c>(object: &'c Checked, key: &str) -> &'c str {
    object.get(key).map_or("", Checked::text)
}

/// The path that an analysis goes along, where a number must stand.
fn along(object: &Checked, key: &str, names: &Names) -> Result<Along, SceneError> {
    let path = text(object, key);
    let factor = names.factor(path);
    let place = object.get(key).map_or(&object.place, |v| &v.place);
    if factor.unit.is_none() {
        let message = format!("`{path}` is not a number in a scene");
        return Err(SceneError::new(SceneErrorKind::State { message }, place));
    }
    Ok(Along {
        path: path.to_owned(),
        names: factor.names,
        unit: factor.unit,
        place: place.clone(),
    })
}

/// What an analysis varies must not vary otherwise.
fn twice(design: &Design, path: &str, object: &Checked) -> Result<(), SceneError> {
    if design.factor(path).is_none() {
        return Ok(());
    }
    let place = PATHS.iter().find_map(|(_, key)| object.get(key));
    let message = format!("`{path}` varies twice");
    let place = &place.unwrap_or(object).place;
    Err(SceneError::new(SceneErrorKind::State { message }, place).help("name it in one place"))
}

/// The factor that groups are made of.
pub(super) fn group(checked: &Checked, design: &Design) -> Result<Option<usize>, SceneError> {
    let Some(group) = checked.get("group") else {
        return Ok(None);
    };
    let factor = design.factor(group.text());
    factor.map(Some).ok_or_else(|| {
        let known: Vec<&str> = design.factors().map(|f| f.path.as_str()).collect();
        unknown_name("path that varies", group.text(), &known, &group.place)
    })
}

impl Procedure {
    /// The analysis with what it needs of the measures.
    pub(super) fn measured(
        self,
        checked: &Checked,
        measures: &[Measure],
        failure: Option<&Failure>,
    ) -> Result<Procedure, SceneError> {
        if matches!(self, Procedure::Once { .. }) {
            return Ok(self);
        }
        if failure.is_none() {
            let keys = vec!["failure".to_owned()];
            let error = SceneError::new(SceneErrorKind::MissingKey { keys }, &checked.place);
            return Err(error.help("say when a run has failed: \"failure\": { \"limit\": … }"));
        }
        let Procedure::Ida(ida) = self else {
            return Ok(self);
        };
        let is_number = |m: &Measure| !m.what.is_flag() && !m.what.counts();
        let said = checked.get("ida").and_then(|ida| ida.get("measure"));
        let curve = match said {
            None => measures.iter().position(is_number),
            Some(name) => {
                let found = measures.iter().position(|m| m.name == name.text());
                Some(found.ok_or_else(|| {
                    let known: Vec<&str> = measures.iter().map(|m| m.name.as_str()).collect();
                    unknown_name("measure of the study", name.text(), &known, &name.place)
                })?)
            }
        };
        Ok(Procedure::Ida(Ida { curve, ..ida }))
    }
}
