//! The limit states of a scene: what becomes of those of the model, and those that the scene adds.

use super::check::{Checked, unknown_name};
use super::error::{Errors, SceneError, SceneErrorKind};
use super::format::{self, CONTINUE, END, IGNORE};
use super::interpret::under;
use super::shape::{Key, Object, Quantity, Shape};
use super::wording::shown;
use crate::hybrid::{AtLimit, Limits, Observed, OwnLimit, Problem};
use crate::model::{Model, Variant};
use crate::record::{self, Layout, Recorded};

/// A quantity that a limit may be about: its name, unit and place in the state.
struct Observable {
    name: String,
    unit: String,
    of: Observed,
}

/// Coordinates, velocities, reactions and outputs, as the trajectory names them; `own` are outputs of the scene.
fn observables(model: &Model, variant: &Variant, own: &[(String, String)]) -> Vec<Observable> {
    let recorded = Recorded {
        reactions: true,
        outputs: true,
        ..Recorded::default()
    };
    let own = own
        .iter()
        .map(|(name, unit)| record::Quantity::new(name, unit, ""));
    let own: Vec<_> = own.collect();
    let layout = Layout::new(model, variant, recorded, &own);
    type Place<'p> = &'p dyn Fn(usize) -> Observed;
    let groups: [(_, Place); 4] = [
        (layout.coordinates, &Observed::Coordinate),
        (layout.velocities, &Observed::Rate),
        (layout.reactions, &|i| Observed::Reaction(model.reaction(i))),
        (layout.outputs, &Observed::Output),
    ];
    let all = groups.into_iter().flat_map(|(quantities, place)| {
        let observable = move |(i, q): (usize, record::Quantity)| Observable {
            name: q.name,
            unit: q.unit,
            of: place(i),
        };
        quantities.into_iter().enumerate().map(observable)
    });
    all.collect()
}

/// The shape of `limits` of a scene with these outputs, by name and unit; `None`: with any.
pub(super) fn shape(model: Option<&Model>, own_outputs: Option<&[(String, String)]>) -> Object {
    let course = || Shape::Choice("course", vec![END, CONTINUE]);
    let any_course = || Shape::Choice("course", vec![END, CONTINUE, IGNORE]);
    let bounds = |unit: &str| {
        Object::new(
            "bound",
            vec![
                Key::new("above", "reached above this value", Quantity::any(unit)),
                Key::new("below", "reached below this value", Quantity::any(unit)),
            ],
        )
    };
    let mut own = vec![
        Key::new("then", "whether the run ends there", course()).default(END),
        Key::new("message", "what it means", Shape::Text),
    ];
    let Some(model) = model else {
        let own = Object::new("quantity", own).others(bounds(""));
        return Object::new("limit", Vec::new())
            .others(Shape::Either(vec![any_course(), own.into()]));
    };
    let variant = &model.variants[0];
    own.extend(
        observables(model, variant, own_outputs.unwrap_or_default())
            .into_iter()
            .map(|o| {
                let meaning = format!("where {} is a limit", o.name);
                Key::new(o.name, meaning, bounds(&o.unit))
            }),
    );
    let of_model = format::limits(&model.variants).into_iter().map(|limit| {
        let default = if limit.ends { END } else { CONTINUE };
        Key::new(limit.name, limit.message, any_course()).default(default)
    });
    // A name that is not the model's, with the course of one, is a mistake that is named later.
    let own = match own_outputs {
        Some(_) => Object::new("quantity", own),
        None => Object::new("quantity", own).others(bounds("")),
    };
    Object::new("limit", of_model.collect()).others(Shape::Either(vec![own.into(), any_course()]))
}

/// The limits of a checked scene.
pub(super) fn limits(problem: &Problem, scene: &Checked, errors: &mut Errors) -> Limits {
    let (model, variant) = (&*problem.model, problem.variant());
    let mut limits = Limits::default();
    let said = scene.get("limits").map_or(&[][..], Checked::entries);
    let observables = match said.iter().any(|(_, said)| said.is_object()) {
        true => {
            let own = problem.outputs.iter().map(|o| &o.quantity);
            let own: Vec<_> = own.map(|q| (q.name.clone(), q.unit.clone())).collect();
            observables(model, variant, &own)
        }
        false => Vec::new(),
    };
    for (name, said) in said {
        if said.is_object() {
            limits.own.extend(own(name, said, &observables, errors));
            continue;
        }
        match variant.limits.iter().find(|limit| limit.name == name) {
            Some(limit) => limits.of_model.push((limit.name, course_of(said.text()))),
            None => {
                let known: Vec<_> = variant.limits.iter().map(|limit| limit.name).collect();
                let what = format!("limit{}:", under(model, variant));
                errors.push(unknown_name(&what, name, &known, &said.place));
            }
        }
    }
    limits
}

/// What a run does at a limit of the model, by its name.
fn course_of(name: &str) -> AtLimit {
    match name {
        END => AtLimit::End,
        IGNORE => AtLimit::Ignore,
        _ => AtLimit::Continue,
    }
}

/// A limit of the scene: one for each bound, with the same name.
fn own(
    name: &str,
    said: &Checked,
    observables: &[Observable],
    errors: &mut Errors,
) -> Vec<OwnLimit> {
    let ends = said.get("then").is_none_or(|then| then.text() == END);
    let bounds = observables.iter().flat_map(|o| {
        let of = said.get(&o.name);
        [("above", true), ("below", false)]
            .map(|(key, above)| (o, key, above, of.and_then(|of| of.get(key))))
    });
    let limits: Vec<_> = bounds
        .filter_map(|(o, key, above, level)| {
            let level = level?.number();
            let message = match said.get("message") {
                Some(message) => message.text().to_owned(),
                None => format!("`{}` is {key} {} {}", o.name, shown(level), o.unit),
            };
            Some(OwnLimit {
                name: name.to_owned(),
                message,
                of: o.of,
                above,
                level,
                ends,
            })
        })
        .collect();
    if limits.is_empty() {
        let keys = vec!["`above` or `below` of a quantity".into()];
        let error = SceneError::new(SceneErrorKind::MissingKey { keys }, &said.place);
        errors.push(error.help("such as { \"x\": { \"above\": \"0.1 m\" } }"));
    }
    limits
}
