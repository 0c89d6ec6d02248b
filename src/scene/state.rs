//! The initial state and the coordinates that a scene freezes, as far as the model's tables can
//! judge them. The engine judges the rest, with the model's functions.

use super::check::{Checked, unknown_name};
use super::error::{Errors, SceneError, SceneErrorKind};
use super::format;
use super::interpret::under;
use super::wording::{listing, shown};
use crate::hybrid::Initial;
use crate::kernel::{Context, Free, with_kernel};
use crate::model::{Discrete, HeldAt, Mode, Model, Variant};
use crate::numerics::Size;

/// The coordinates to freeze, increasing. Each must be held still by some mode, or no equations
/// without it exist.
pub(crate) fn freeze(
    model: &Model,
    variant: &Variant,
    scene: &Checked,
    errors: &mut Errors,
) -> Vec<usize> {
    let mut frozen = Vec::new();
    for name in scene.get("freeze").map_or(&[][..], Checked::list) {
        let Some(i) = model.coordinate(name.text()) else {
            unreachable!("checked to name a coordinate: {name:?}")
        };
        let coordinate = model.coordinates[i].name;
        if frozen.contains(&i) {
            let kind = SceneErrorKind::DuplicateKey {
                key: coordinate.to_owned(),
            };
            errors.push(SceneError::new(kind, &name.place));
        } else if !variant.modes.iter().any(|mode| mode.freezes(i)) {
            let kind = SceneErrorKind::NeverFrozen { coordinate };
            let held = model.own_coordinates().iter().enumerate();
            let held = held.filter(|(i, _)| variant.modes.iter().any(|m| m.freezes(*i)));
            let held: Vec<_> = held.map(|(_, c)| c.name).collect();
            let help = match held.is_empty() {
                true => String::from("leave `freeze` out: no mode holds a coordinate still"),
                false => format!("modes hold {} still", listing(held.into_iter())),
            };
            errors.push(SceneError::new(kind, &name.place).help(help));
        } else {
            frozen.push(i);
        }
    }
    frozen.sort_unstable();
    frozen
}

/// A mode, and of each coordinate where the mode holds it; `None`: wherever it was, or it is not known.
type Holding<'m> = (&'m Mode, Vec<Option<f64>>);

/// Where a mode holds the coordinates under these parameters, if they are known.
fn holding<'m>(model: &Model, mode: &'m Mode, parameters: Option<&[f64]>) -> Holding<'m> {
    let depends = |at: &Option<HeldAt>| matches!(at, Some(HeldAt::Expression(_)));
    let depends = mode.held_at.iter().any(depends);
    let values = parameters.filter(|_| depends).map(|parameters| {
        let context = Context::new(model, parameters);
        let mut values = vec![0.0; model.coordinates.len()];
        with_kernel!(&mode.kernels, k => {
            let none = k.size().zeros();
            let at = Free { q: &none, v: &none, a: &none };
            k.coordinates(&context, at, &mut values);
        });
        values
    });
    let at = mode.held_at.iter().enumerate().map(|(i, at)| match at {
        // Where free coordinates have it: the engine knows.
        _ if mode.depends[i] => None,
        Some(HeldAt::Number(value)) => Some(*value),
        Some(HeldAt::Expression(_)) => values.as_ref().map(|values| values[i]),
        None => None,
    });
    (mode, at.collect())
}

/// Whether a state that contacts and constraints do not admit is moved to one that they do.
pub(crate) fn project(scene: &Checked) -> bool {
    let project = (scene.get("initial")).and_then(|initial| initial.get("project"));
    project.is_some_and(Checked::flag)
}

/// Refuses coordinates beyond their bounds.
fn check_bounds(model: &Model, variant: &Variant, states: &[Given], errors: &mut Errors) {
    for (c, given) in model.coordinates.iter().zip(states) {
        let beyond = given.position.filter(|at| !c.bounds().admit(at.number()));
        if let Some(position) = beyond {
            let kind = SceneErrorKind::OutOfRange {
                value: position.number(),
                range: c.bounds().describe(c.unit),
            };
            let error = SceneError::new(kind, &position.place);
            errors.push(match variant.has_inadmissible() {
                true => error.help("or let it be moved there: `\"project\": true`"),
                false => error,
            });
        }
    }
}

/// Whether a run starts in static equilibrium.
pub(crate) fn at_rest(scene: &Checked) -> bool {
    scene.get("initial").is_some_and(|initial| {
        initial.as_text().is_some() || initial.get("at_rest").is_some_and(Checked::flag)
    })
}

/// Of each discrete state, whether the scene says what it is at first.
pub(crate) fn stated(model: &Model, scene: &Checked) -> Vec<bool> {
    let entry = |name: &str| scene.get("initial").and_then(|initial| initial.get(name));
    let stated = model.discretes.iter().map(|d| entry(d.name).is_some());
    stated.collect()
}

/// Of each coordinate, then of each rate, whether the scene says nothing of what it is at first.
pub(crate) fn unstated(model: &Model, scene: &Checked) -> Vec<bool> {
    let says_nothing = |name: &str| {
        let initial = scene.get("initial");
        initial.and_then(|initial| initial.get(name)).is_none()
    };
    let places = model.coordinates.iter().map(|c| says_nothing(c.name));
    let rates = (model.coordinates.iter()).map(|c| says_nothing(&format::rate_key(c)));
    places.chain(rates).collect()
}

/// The initial state. What the scene does not say is zero, or where every mode in which it may start holds it.
pub(crate) fn initial(
    model: &Model,
    variant: &Variant,
    scene: &Checked,
    (freeze, parameters): (&[usize], Option<&[f64]>),
    errors: &mut Errors,
) -> Option<Initial> {
    let object = scene.get("initial");
    let entry = |key: &str| object.and_then(|o| o.get(key));
    let keeps_frozen = |mode: &Mode| freeze.iter().all(|&i| mode.freezes(i));

    let mode = match entry("mode") {
        Some(name) => Some(errors.note(named_mode(model, variant, name))?),
        None => None,
    };
    let modes: Vec<&Mode> = match mode {
        Some(i) => vec![&variant.modes[i]],
        None => variant.modes.iter().filter(|m| keeps_frozen(m)).collect(),
    };
    let modes: Vec<Holding> = (modes.into_iter())
        .map(|mode| holding(model, mode, parameters))
        .collect();
    if let (Some(i), Some(at)) = (mode, entry("mode")) {
        let mode = &variant.modes[i];
        if let Some(&i) = freeze.iter().find(|&&i| !mode.freezes(i)) {
            let (name, coordinate) = (mode.name, model.coordinates[i].name);
            let message =
                format!("mode `{name}` leaves `{coordinate}` free, but the scene freezes it");
            errors.push(SceneError::new(
                SceneErrorKind::State { message },
                &at.place,
            ));
            return None;
        }
    }
    if modes.is_empty() {
        let message = "no mode holds all of these coordinates still".to_owned();
        let at = scene.get("freeze").map_or(&scene.place, |f| &f.place);
        errors.push(SceneError::new(SceneErrorKind::State { message }, at));
        return None;
    }

    let states: Vec<Given> = model
        .coordinates
        .iter()
        .map(|c| Given {
            position: entry(c.name),
            rate: entry(&format::rate_key(c)),
        })
        .collect();
    let projects = project(scene);
    if !projects {
        check_bounds(model, variant, &states, errors);
    }
    let fits = |mode: &Holding| {
        projects || (0..states.len()).all(|i| states[i].objection(model, i, mode).is_none())
    };
    if !modes.iter().any(fits) {
        let place = object.map_or(&scene.place, |o| &o.place);
        errors.push(misfit(model, &states, &modes, place));
        return None;
    }

    if at_rest(scene) {
        let rates = states.iter().filter_map(|given| given.rate);
        for rate in rates.filter(|rate| rate.number() != 0.0) {
            let message = "what starts at rest has no velocity".to_owned();
            let error = SceneError::new(SceneErrorKind::State { message }, &rate.place);
            errors.push(error.help("leave the velocity out, or `at_rest`"));
        }
    }

    let idle = |d: &Discrete| {
        model
            .seen_discretes(variant)
            .all(|seen| seen.name != d.name)
    };
    for d in model.discretes.iter().filter(|d| idle(d)) {
        if let Some(given) = entry(d.name) {
            let message = format!(
                "nothing depends on `{}` under the choices of this scene",
                d.name
            );
            let error = SceneError::new(SceneErrorKind::State { message }, &given.place);
            errors.push(error.help("leave it out"));
        }
    }
    let q = model
        .coordinates
        .iter()
        .enumerate()
        .map(|(i, c)| match states[i].position {
            Some(position) => position.number(),
            None => held_by_all(&modes, i).unwrap_or(0.0_f64.max(c.minimum.unwrap_or(0.0))),
        });
    let discrete = model.discretes.iter().map(|d| match entry(d.name) {
        Some(value) => value.number(),
        None => d.values.first().copied().unwrap_or(0.0),
    });
    Some(Initial {
        q: q.collect(),
        v: states
            .iter()
            .map(|s| s.rate.map_or(0.0, Checked::number))
            .collect(),
        discrete: discrete.collect(),
        mode,
    })
}

fn named_mode(model: &Model, variant: &Variant, name: &Checked) -> Result<usize, SceneError> {
    variant
        .modes
        .iter()
        .position(|m| m.name == name.text())
        .ok_or_else(|| {
            // The name is a mode of the model, but of another variant.
            let known = format::mode_names(std::slice::from_ref(variant));
            let what = format!("mode{}:", under(model, variant));
            unknown_name(&what, name.text(), &known, &name.place)
        })
}

/// The value at which all modes hold a coordinate, if they agree.
fn held_by_all(modes: &[Holding], i: usize) -> Option<f64> {
    let [(_, first), others @ ..] = modes else {
        return None;
    };
    others
        .iter()
        .all(|(_, at)| at[i] == first[i])
        .then_some(first[i])?
}

/// What a scene says about a coordinate.
struct Given<'s> {
    position: Option<&'s Checked>,
    rate: Option<&'s Checked>,
}

impl<'s> Given<'s> {
    /// Why coordinate `i` cannot start like this in a mode, and the value at fault.
    fn objection(
        &self,
        model: &Model,
        i: usize,
        (mode, at): &Holding,
    ) -> Option<(String, &'s Checked)> {
        if mode.free.contains(&i) {
            return None;
        }
        let (name, unit) = (model.coordinates[i].name, model.coordinates[i].unit);
        if let Some(held) = at[i] {
            let elsewhere = self.position.filter(|position| position.number() != held);
            if let Some(position) = elsewhere {
                let held = shown(held);
                let message = format!("mode `{}` holds `{name}` at {held} {unit}", mode.name);
                return Some((message, position));
            }
        }
        // The rate at which a mode lets a coordinate drift is a function of the model.
        let moving = self
            .rate
            .filter(|rate| rate.number() != 0.0 && !mode.moves(i))?;
        Some((format!("mode `{}` holds `{name}` still", mode.name), moving))
    }
}

/// The error for a state that fits none of the modes: about a coordinate that none admits, if
/// there is one, else about the state as a whole.
fn misfit(
    model: &Model,
    states: &[Given],
    modes: &[Holding],
    place: &super::source::Span,
) -> SceneError {
    let objections = |i: usize| -> Option<Vec<_>> {
        modes
            .iter()
            .map(|mode| states[i].objection(model, i, mode))
            .collect()
    };
    let error = |message, at| SceneError::new(SceneErrorKind::State { message }, at);
    let names = |modes: &[Holding]| listing(modes.iter().map(|(m, _)| m.name));
    match (0..states.len()).find_map(objections).as_deref() {
        Some([(message, at), others @ ..]) => {
            let message = match others {
                [] => message.clone(),
                _ => format!("{message}, and so does every other mode it could start in"),
            };
            error(message, &at.place).help("change it, leave it out, or start in another mode")
        }
        _ => error("no mode admits this state".to_owned(), place).help(format!(
            "each of the modes {} holds a coordinate that is elsewhere or moves",
            names(modes)
        )),
    }
}
