//! What a variant of a model offers, as data: printed as JSON as it is, and as tables.

use serde::Serialize;

use crate::model::{self, Model, Variant};
use crate::record::{Layout, Recorded};

/// A model under the chosen options.
#[derive(Debug, Serialize)]
pub struct Description {
    pub name: &'static str,
    pub title: &'static str,
    pub source: &'static str,
    pub choices: Vec<Choice>,
    pub coordinates: Vec<Coordinate>,
    pub discrete: Vec<Discrete>,
    pub inputs: Vec<Input>,
    pub parameters: Vec<Parameter>,
    pub parameter_sets: Vec<ParameterSet>,
    pub reactions: Vec<Reaction>,
    pub outputs: Vec<Output>,
    pub contacts: Vec<Contact>,
    pub modes: Vec<Mode>,
    pub limits: Vec<Limit>,
    pub validity: Vec<Validity>,
}

/// A modelling choice, and the option that is described.
#[derive(Debug, Serialize)]
pub struct Choice {
    pub name: &'static str,
    pub options: Box<[&'static str]>,
    pub chosen: &'static str,
    pub meaning: &'static str,
}

#[derive(Debug, Serialize)]
pub struct Coordinate {
    pub name: &'static str,
    pub unit: &'static str,
    /// Bounds of every admissible state; `None` where there is none, or it depends on parameters.
    pub minimum: Option<f64>,
    pub maximum: Option<f64>,
    /// Bounds that depend on parameters, such as `<= stop`.
    pub bounds: Vec<String>,
    /// Typical magnitudes, of the coordinate and of its velocity.
    pub scale: f64,
    pub rate_scale: f64,
    pub meaning: &'static str,
}

#[derive(Debug, Serialize)]
pub struct Discrete {
    pub name: &'static str,
    pub values: Box<[f64]>,
    pub meaning: &'static str,
}

#[derive(Debug, Serialize)]
pub struct Input {
    pub name: &'static str,
    pub unit: &'static str,
    pub meaning: &'static str,
}

#[derive(Debug, Serialize)]
pub struct Parameter {
    pub name: &'static str,
    pub unit: &'static str,
    pub default: f64,
    /// Bounds; `None` where there is none.
    pub minimum: Option<f64>,
    pub minimum_exclusive: bool,
    pub maximum: Option<f64>,
    /// Parameter that this one must not exceed.
    pub at_most: Option<&'static str>,
    pub meaning: &'static str,
}

#[derive(Debug, Serialize)]
pub struct ParameterSet {
    pub name: &'static str,
    pub meaning: &'static str,
    /// Parameters that differ from their defaults.
    pub values: Vec<Value>,
}

#[derive(Debug, Serialize)]
pub struct Value {
    pub parameter: &'static str,
    pub value: f64,
}

/// A reaction, as the trajectory names it.
#[derive(Debug, Serialize)]
pub struct Reaction {
    pub name: String,
    pub unit: String,
    pub meaning: String,
}

/// A contact, a friction element or one equation of a constraint.
#[derive(Debug, Serialize)]
pub struct Contact {
    pub name: &'static str,
    pub kind: &'static str,
    /// Its gap, or what a constraint holds at zero.
    pub gap: Option<&'static str>,
    pub slip: Option<&'static str>,
    /// The normal force of friction without a gap.
    pub normal: Option<&'static str>,
    #[serde(rename = "static")]
    pub static_friction: Option<&'static str>,
    pub kinetic: Option<&'static str>,
    pub restitution: Option<&'static str>,
    /// What it can do.
    pub states: Box<[&'static str]>,
}

/// An output.
#[derive(Debug, Serialize)]
pub struct Output {
    pub name: &'static str,
    pub unit: &'static str,
    /// What it is.
    pub expression: &'static str,
    pub meaning: &'static str,
}

#[derive(Debug, Serialize)]
pub struct Mode {
    pub name: &'static str,
    pub meaning: &'static str,
    /// The coordinates that are integrated.
    pub free: Vec<&'static str>,
    pub held: Vec<Held>,
    pub guards: Vec<Guard>,
    pub requirements: Vec<Requirement>,
    /// Modes at the limit of accumulations with events that lead to this mode.
    pub rests: Vec<&'static str>,
    pub operations: Vec<Operations>,
}

/// A coordinate that is not integrated.
#[derive(Debug, Serialize)]
pub struct Held {
    pub coordinate: &'static str,
    /// Where, a number or an expression in the parameters, and in free coordinates if it depends on these; `None`: wherever it was.
    pub at: Option<At>,
    /// Whether it moves at a given rate.
    pub drifts: bool,
    /// Whether it depends on free coordinates.
    pub depends: bool,
}

/// Where a coordinate is held.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(untagged)]
pub enum At {
    Number(f64),
    Expression(&'static str),
}

/// What makes the mode inadmissible where it falls through zero.
#[derive(Debug, Serialize)]
pub struct Guard {
    pub name: &'static str,
    pub text: &'static str,
    pub unit: &'static str,
    /// Tried in order.
    pub transitions: Vec<Transition>,
}

#[derive(Debug, Serialize)]
pub struct Transition {
    pub name: &'static str,
    pub to: &'static str,
    /// Whether it is taken only where its condition, evaluated in the next mode, holds.
    pub conditional: bool,
    /// Whether velocities jump and energy may be lost.
    pub impact: bool,
    /// What the reset may change.
    pub changes: Box<[&'static str]>,
}

#[derive(Debug, Serialize)]
pub struct Requirement {
    pub text: &'static str,
    pub unit: &'static str,
    pub failure: &'static str,
}

/// A limit state.
#[derive(Debug, Serialize)]
pub struct Limit {
    pub name: &'static str,
    /// When it is reached.
    pub when: &'static str,
    /// Whether a run ends there, unless its scene says otherwise.
    pub ends: bool,
    pub message: &'static str,
}

/// A condition under which the model is meant.
#[derive(Debug, Serialize)]
pub struct Validity {
    pub condition: &'static str,
    /// Whether it is about the parameters, else about the motion.
    pub of_parameters: bool,
    pub message: &'static str,
}

/// Operations of a generated function.
#[derive(Debug, Serialize)]
pub struct Operations {
    pub function: &'static str,
    pub count: usize,
}

impl Description {
    pub fn new(model: &Model, variant: &Variant) -> Description {
        let choices = model.choices.iter().zip(&variant.options);
        let coordinates = model.own_coordinates().iter();
        let parameter_sets = model.parameter_sets.iter();
        Description {
            name: model.name,
            title: model.title,
            source: model.source,
            choices: choices
                .map(|(choice, chosen)| Choice {
                    name: choice.name,
                    options: choice.options.clone(),
                    chosen,
                    meaning: choice.meaning,
                })
                .collect(),
            coordinates: coordinates
                .enumerate()
                .map(|(i, c)| Coordinate {
                    bounds: (variant.bounds.iter())
                        .filter(|bound| bound.coordinate == i)
                        .map(|bound| match bound.upper {
                            true => format!("<= {}", bound.text),
                            false => format!(">= {}", bound.text),
                        })
                        .collect(),
                    maximum: c.maximum,
                    name: c.name,
                    unit: c.unit,
                    minimum: c.minimum,
                    scale: c.scale,
                    rate_scale: c.rate_scale,
                    meaning: c.meaning,
                })
                .collect(),
            discrete: (model.seen_discretes(variant))
                .map(|d| Discrete {
                    name: d.name,
                    values: d.values.clone(),
                    meaning: d.meaning,
                })
                .collect(),
            inputs: (model.inputs.iter())
                .map(|i| Input {
                    name: i.name,
                    unit: i.unit,
                    meaning: i.meaning,
                })
                .collect(),
            parameters: model.parameters.iter().map(Parameter::new).collect(),
            parameter_sets: parameter_sets
                .map(|set| ParameterSet {
                    name: set.name,
                    meaning: set.meaning,
                    values: (set.values.iter())
                        .map(|&(parameter, value)| Value { parameter, value })
                        .collect(),
                })
                .collect(),
            reactions: reactions(model, variant),
            outputs: (variant.outputs.iter())
                .map(|o| Output {
                    name: o.name,
                    unit: o.unit,
                    expression: o.text,
                    meaning: o.meaning,
                })
                .collect(),
            contacts: (variant.contacts.iter())
                .map(|c| Contact {
                    name: c.name,
                    kind: c.kind,
                    gap: c.gap,
                    slip: c.slip,
                    normal: c.normal,
                    static_friction: c.friction[0],
                    kinetic: c.friction[1],
                    restitution: c.restitution,
                    states: c.states.clone(),
                })
                .collect(),
            modes: variant
                .modes
                .iter()
                .enumerate()
                .map(|(index, mode)| Mode::new(model, variant, (index, mode)))
                .collect(),
            limits: (variant.limits.iter())
                .map(|limit| Limit {
                    name: limit.name,
                    when: limit.text,
                    ends: limit.ends,
                    message: limit.message,
                })
                .collect(),
            validity: [
                (&variant.valid_parameters, true),
                (&variant.valid_motion, false),
            ]
            .into_iter()
            .flat_map(|(all, of_parameters)| {
                all.iter().map(move |validity| Validity {
                    condition: validity.condition,
                    of_parameters,
                    message: validity.sentence,
                })
            })
            .collect(),
        }
    }
}

impl Parameter {
    fn new(p: &model::Parameter) -> Parameter {
        Parameter {
            name: p.name,
            unit: p.unit,
            default: p.default,
            minimum: Some(p.minimum).filter(|x| x.is_finite()),
            minimum_exclusive: p.minimum_exclusive,
            maximum: Some(p.maximum).filter(|x| x.is_finite()),
            at_most: p.at_most,
            meaning: p.meaning,
        }
    }
}

impl Mode {
    fn new(model: &Model, variant: &Variant, (index, mode): (usize, &model::Mode)) -> Mode {
        let own = model.own_coordinates().len();
        let name = |i: usize| model.coordinates[i].name;
        let is_held = |i: &usize| !mode.free.contains(i);
        let to = |target: usize| variant.modes[target].name;
        let transition = |t: &model::Transition| Transition {
            name: t.name,
            to: to(t.target),
            conditional: t.conditional,
            impact: t.impact,
            changes: t.changes.clone(),
        };
        let guard = |g: &model::Guard| Guard {
            name: g.name,
            text: g.text,
            unit: g.unit,
            transitions: g.transitions.iter().map(transition).collect(),
        };
        let held = |i: usize| Held {
            coordinate: name(i),
            at: mode.held_at[i].map(|at| match at {
                model::HeldAt::Number(value) => At::Number(value),
                model::HeldAt::Expression(text) => At::Expression(text),
            }),
            drifts: mode.drifts[i],
            depends: mode.depends[i],
        };
        Mode {
            name: mode.name,
            meaning: mode.meaning,
            free: (mode.free.iter().copied())
                .filter(|&i| i < own)
                .map(name)
                .collect(),
            held: (0..own).filter(is_held).map(held).collect(),
            guards: mode.guards.iter().map(guard).collect(),
            requirements: (mode.requirements.iter())
                .map(|r| Requirement {
                    text: r.text,
                    unit: r.unit,
                    failure: r.failure,
                })
                .collect(),
            rests: (variant.rests.iter())
                .filter(|rest| rest.source == index)
                .map(|rest| to(rest.target))
                .collect(),
            operations: (mode.operations.iter())
                .map(|&(function, count)| Operations { function, count })
                .collect(),
        }
    }
}

/// The reactions, under the names that the trajectory gives them.
fn reactions(model: &Model, variant: &Variant) -> Vec<Reaction> {
    let recorded = Recorded {
        reactions: true,
        ..Recorded::default()
    };
    let layout = Layout::new(model, variant, recorded, []);
    let quantities = layout.reactions.into_iter();
    quantities
        .map(|q| Reaction {
            name: q.name,
            unit: q.unit,
            meaning: q.meaning,
        })
        .collect()
}
