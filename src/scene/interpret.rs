//! From a checked tree to a [`Scene`]: what no table of keys can say.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::check::{Checked, check, unknown_name};
use super::error::{Errors, SceneError, SceneErrorKind, SceneErrors};
use super::files::Files;
use super::shape::Shape;
use super::tree::{Node, Value};
use super::wording::listing;
use super::{Scene, SceneSource, format, inputs, limits, outputs, state};
use crate::hybrid::{
    Accuracy, Collisions, End, Exceeds, Limits, Method, Problem, Record, check_limits_of_parameters,
};
use crate::model::{Model, Models, Variant};
use crate::record::Recorded;

/// Checks a tree and makes a scene of it. `folder` is what tables are relative to.
pub(crate) fn scene(
    root: Node,
    models: &Models,
    files: &dyn Files,
    folder: &Path,
) -> Result<Scene, SceneErrors> {
    format_of(&root)?;
    let model = model(&root, models, folder)?;
    let shape = Shape::Object(format::scene(Some(&model), Some(&outputs::named(&root))));
    let reader = inputs::Reader {
        files,
        folder,
        records: None,
    };
    scene_of(root, &model, &shape, &reader)
}

/// The same with a model that is known, and the shape of its scenes.
pub(super) fn scene_of(
    root: Node,
    owned: &Arc<Model>,
    shape: &Shape,
    reader: &inputs::Reader,
) -> Result<Scene, SceneErrors> {
    let mut errors = Errors::default();
    let model = &**owned;
    let checked = check(&root, shape, &mut errors);
    errors.check()?;
    // Without an error there is a value.
    let Some(checked) = checked else {
        unreachable!("{root:?} failed its check without an error")
    };

    let chosen = variant(model, &checked)?;
    let variant = &model.variants[chosen];
    let parameters = errors.note(parameters(model, &checked));
    let signals = inputs::signals(model, &checked, reader, &mut errors);
    inputs::refuse_barred(model, variant, &checked, &mut errors);
    refuse_without_contacts(model, variant, &checked, &mut errors);
    let freeze = state::freeze(model, variant, &checked, &mut errors);
    let parts = (&freeze[..], parameters.as_deref());
    let initial = state::initial(model, variant, &checked, parts, &mut errors);
    let end = errors.note(end(variant, &checked));
    errors.check()?;
    let (Some(parameters), Some(signals), Some(initial), Some(end)) =
        (parameters, signals, initial, end)
    else {
        unreachable!("a part of the scene is absent without an error")
    };
    let mut problem = Problem {
        model: owned.clone(),
        chosen,
        title: checked.get("title").map(|title| title.text().to_owned()),
        parameters,
        signals,
        initial,
        project: state::project(&checked),
        at_rest: state::at_rest(&checked),
        stated: state::stated(model, &checked),
        unstated: state::unstated(model, &checked),
        freeze,
        end,
        limits: Limits::default(),
        outputs: Vec::new(),
        accuracy: Accuracy::default(),
        method: method(&checked),
        collisions: collisions(&checked),
        record: record(&checked),
    };
    set_accuracy(&mut problem, &checked);
    outputs::add(&mut problem, &checked, &mut errors);
    errors.check()?;
    problem.limits = limits::limits(&problem, &checked, &mut errors);
    errors.check()?;
    let source = SceneSource { root };
    Ok(Scene { problem, source })
}

/// A scene of another format may have other keys: only that is said.
fn format_of(root: &Node) -> Result<(), SceneError> {
    let Some(node) = root.get("format") else {
        return Ok(());
    };
    match &node.value {
        // What is no number is an error of its own.
        Value::Number(found) if found.parse() != Ok(f64::from(format::FORMAT)) => {
            let found = found.clone();
            let known = format::FORMAT;
            let help = "run it with the version of dalembert that it was written for, or write it as docs/scene.md says";
            Err(SceneError::new(SceneErrorKind::Format { found, known }, &node.place()).help(help))
        }
        _ => Ok(()),
    }
}

pub(super) fn model(root: &Node, models: &Models, folder: &Path) -> Result<Arc<Model>, SceneError> {
    let known: Vec<&str> = models.names().collect();
    let wrong_type = |node: &Node, expected: &str| {
        let (expected, found) = (expected.to_owned(), node.type_name().to_owned());
        SceneError::new(SceneErrorKind::WrongType { expected, found }, &node.place())
    };
    if !matches!(root.value, Value::Object(_)) {
        return Err(wrong_type(root, "an object").help("a scene begins with { \"model\": …"));
    }
    let Some(node) = root.get("model") else {
        let kind = SceneErrorKind::MissingKey {
            keys: vec!["model".into()],
        };
        let help = format!("known models: {}", listing(known));
        return Err(SceneError::new(kind, &root.place()).help(help));
    };
    let Value::Text(name) = &node.value else {
        return Err(wrong_type(
            node,
            "the name of a model, or the path of a model folder",
        ));
    };
    if Models::is_folder(name) {
        let made = models.from_folder(&folder.join(name), &texts(root));
        return made.map_err(|refused| {
            let kind = SceneErrorKind::NoModel {
                folder: name.clone(),
                reason: refused.message,
            };
            let error = SceneError::new(kind, &node.place());
            match refused.help {
                Some(help) => error.help(help),
                None => error,
            }
        });
    }
    models.find(name).ok_or_else(|| {
        let error = unknown_name("model", name, &known, &node.place());
        match folder.join(name).join("model.py").is_file() {
            true => error.help(format!(
                "for the folder beside this scene write \"./{name}\""
            )),
            false => error,
        }
    })
}

/// What a scene may mean for choices of its model, which is not known yet: all texts by their keys.
fn texts(root: &Node) -> BTreeMap<String, String> {
    let Value::Object(entries) = &root.value else {
        return BTreeMap::new();
    };
    let mut texts = BTreeMap::new();
    for entry in entries {
        match &entry.node.value {
            Value::Text(text) => {
                texts.insert(entry.key.clone(), text.clone());
            }
            Value::Object(switches) if entry.key == "contacts" => {
                for switch in switches {
                    if let Value::Text(text) = &switch.node.value {
                        texts.insert(format!("{}{}", format::SWITCHES, switch.key), text.clone());
                    }
                }
            }
            _ => {}
        }
    }
    texts
}

/// The variant that has the options the scene names, and the defaults for the others.
fn variant(model: &Model, scene: &Checked) -> Result<usize, SceneError> {
    let named: Vec<Option<&Checked>> = (model.choices.iter())
        .map(|c| format::chosen(scene, c.name))
        .collect();
    let fits = |variant: &Variant| {
        named.iter().enumerate().all(|(i, name)| match name {
            Some(name) => variant.options[i] == name.text(),
            None => variant.defaults[i],
        })
    };
    model.variants.iter().position(fits).ok_or_else(|| {
        let pairs = |options: &[&str]| {
            let pairs = model.choices.iter().zip(options);
            pairs
                .map(|(c, option)| format!("{} = {option}", c.name))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let chosen: Vec<String> = model
            .choices
            .iter()
            .zip(&named)
            .filter_map(|(c, name)| name.map(|name| format!("{} = {}", c.name, name.text())))
            .collect();
        let place = named
            .iter()
            .flatten()
            .last()
            .map_or(&scene.place, |name| &name.place);
        let mismatches = |options: &[&str]| {
            let differs = |(name, option): (&Option<&Checked>, &&str)| {
                name.is_some_and(|name| name.text() != *option)
            };
            named
                .iter()
                .zip(options)
                .filter(|&pair| differs(pair))
                .count()
        };
        // Of many combinations those that are nearest to what is asked for.
        let nearest = model.combinations.iter().map(|o| mismatches(o)).min();
        let offered: Vec<String> = (model.combinations.iter())
            .filter(|options| Some(mismatches(options)) == nearest)
            .map(|options| pairs(options))
            .collect();
        let kind = SceneErrorKind::NoVariant {
            chosen: chosen.join(", "),
        };
        SceneError::new(kind, place).help(format!("it offers {}", offered.join("; ")))
    })
}

/// Refuses what is said of contacts where the chosen options have none for which it has an effect.
fn refuse_without_contacts(model: &Model, variant: &Variant, scene: &Checked, errors: &mut Errors) {
    let is_concerned = |v: &Variant| v.has_multipliers() || v.has_inadmissible();
    if is_concerned(variant) {
        return;
    }
    let initial = scene.get("initial");
    let project = initial.and_then(|initial| initial.get("project"));
    for (key, given) in [("impacts", scene.get("impacts")), ("project", project)] {
        let Some(given) = given else {
            continue;
        };
        let under = under(model, variant);
        let kind = SceneErrorKind::NoContacts { key, under };
        let others = model.variants.iter().filter(|v| is_concerned(v));
        let others: Vec<_> = others.map(|v| options(model, v)).collect();
        let help = match others.is_empty() {
            false => format!("leave it out, or choose {}", others.join("; or ")),
            true => "leave it out".into(),
        };
        errors.push(SceneError::new(kind, &given.place).help(help));
    }
}

/// The variant as text, for errors: ` under rules = paper, landing = velocities`.
pub(crate) fn under(model: &Model, variant: &Variant) -> String {
    match options(model, variant) {
        options if options.is_empty() => options,
        options => format!(" under {options}"),
    }
}

/// The options of a variant as text: `rules = paper, landing = velocities`.
pub(crate) fn options(model: &Model, variant: &Variant) -> String {
    let pairs = model.choices.iter().zip(&variant.options);
    let pairs: Vec<String> = pairs
        .map(|(c, option)| format!("{} = {option}", c.name))
        .collect();
    pairs.join(", ")
}

/// Defaults, then the parameter set, then what the scene says.
fn parameters(model: &Model, scene: &Checked) -> Result<Vec<f64>, SceneError> {
    let mut values: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let object = scene.get("parameters");
    let entry = |name: &str| object.and_then(|o| o.get(name));
    let set = entry("set").and_then(|name| {
        model
            .parameter_sets
            .iter()
            .find(|set| set.name == name.text())
    });
    for (name, value) in set.map_or(&[][..], |set| &set.values) {
        if let Some(i) = model.parameter(name) {
            values[i] = *value;
        }
    }
    for (parameter, value) in model.parameters.iter().zip(&mut values) {
        if let Some(given) = entry(parameter.name) {
            *value = given.number();
        }
    }
    check_limits_of_parameters(model, &values).map_err(|exceeds| {
        let Exceeds { name, limit, .. } = exceeds;
        let place = [name, limit, "set"].into_iter().find_map(entry);
        let place = place.or(object).map_or(&scene.place, |found| &found.place);
        let help = format!("lower `{name}` or raise `{limit}`");
        SceneError::new(SceneErrorKind::Exceeds(exceeds), place).help(help)
    })?;
    Ok(values)
}

fn end(variant: &Variant, scene: &Checked) -> Result<End, SceneError> {
    let Some(end) = scene.get("end") else {
        unreachable!("`end` is a required key")
    };
    let Some(time) = end.get("time") else {
        return Ok(End {
            time: end.number(),
            after: None,
        });
    };
    let time = time.number();
    let Some(after) = end.get("after") else {
        return Ok(End { time, after: None });
    };
    let (name, count) = match after.entries() {
        [(name, count)] => (name, count),
        [] => {
            let keys = vec!["the name of a transition".into()];
            return Err(SceneError::new(
                SceneErrorKind::MissingKey { keys },
                &after.place,
            ));
        }
        [(first, _), (second, at), ..] => {
            let (first, second) = (first.clone(), second.clone());
            return Err(
                SceneError::new(SceneErrorKind::Conflict { first, second }, &at.place)
                    .help("a run ends after one kind of transition"),
            );
        }
    };
    let known = format::transition_names(std::slice::from_ref(variant));
    match known.iter().find(|k| *k == name) {
        // Checked to be a whole number that a double holds exactly.
        Some(name) => Ok(End {
            time,
            after: Some((name, count.number() as u64)),
        }),
        None => Err(unknown_name("transition", name, &known, &count.place)),
    }
}

/// Tolerances: those of the scene, and the default of what it says nothing about.
fn set_accuracy(problem: &mut Problem, scene: &Checked) {
    let accuracy = scene.get("accuracy");
    let relative = accuracy
        .and_then(|a| a.get("relative"))
        .map_or(format::DEFAULT_RELATIVE, Checked::number);
    problem.set_tolerance(relative);
    let absolute = accuracy.and_then(|a| a.get("absolute"));
    let given = |key: &str| match absolute {
        Some(map) if map.is_object() => map.get(key).map(Checked::number),
        all => all.map(Checked::number),
    };
    for (i, coordinate) in problem.model.coordinates.iter().enumerate() {
        let keys = [coordinate.name, &format::rate_key(coordinate)];
        let Accuracy {
            q_absolute,
            v_absolute,
            ..
        } = &mut problem.accuracy;
        for (tolerance, key) in [&mut q_absolute[i], &mut v_absolute[i]]
            .into_iter()
            .zip(keys)
        {
            if let Some(given) = given(key) {
                *tolerance = given;
            }
        }
    }
}

fn record(scene: &Checked) -> Record {
    let record = scene.get("record");
    let entry = |key: &str| record.and_then(|r| r.get(key));
    let flag = |key: &str| entry(key).is_none_or(Checked::flag);
    Record {
        every: entry("every").map(Checked::number),
        columns: Recorded {
            reactions: flag("reactions"),
            outputs: flag("outputs"),
            energies: flag("energies"),
            inputs: flag("inputs"),
        },
        ledger: flag("energies"),
        event_states: true,
        extremes: true,
    }
}

fn collisions(scene: &Checked) -> Collisions {
    let Some(impacts) = scene.get("impacts") else {
        return Collisions::default();
    };
    let law = impacts.get("law").map_or("newton", |law| law.text());
    let order = impacts.get("order").map_or("together", |o| o.text());
    let law = format::LAWS.iter().find(|(known, _)| *known == law);
    let order = format::ORDERS.iter().find(|(known, _)| *known == order);
    let (Some((_, law)), Some((_, order))) = (law, order) else {
        unreachable!("checked to be one of the names")
    };
    Collisions {
        law: *law,
        order: *order,
        without_collision: (impacts.get("without_collision")).is_some_and(|f| f.flag()),
    }
}

fn method(scene: &Checked) -> Method {
    let named = |name: &str| format::METHODS.iter().find(|(known, _)| *known == name);
    let chosen = scene.get("method").and_then(|method| named(method.text()));
    chosen.map_or(Method::default(), |(_, method)| *method)
}
