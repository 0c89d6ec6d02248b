//! From the description and the functions of a compiled model to a [`Model`]: codegen/description.py wrote it, and every
//! field and index of it is checked here.

mod contacts;
mod functions;
mod tapes;

use crate::numerics::Dynamic;
use functions::Counts;

use super::name::intern;
use super::reader::{At, count, number, text, truth};
use super::{
    Choice, Coordinate, Discrete, Guard, GuardShape, HeldAt, Impulse, Input, InputKind, Limit,
    Mode, Model, Motion, Output, Parameter, ParameterSet, ParametricBound, Requirement, Rest,
    TiedFriction, Transition, Validity, Variant,
};
use crate::kernel::{
    ContractError, Dimensions, Functions, GuardKernel, Library, Parts, TransitionKernel,
};
use std::sync::Arc;

type Read<T> = Result<T, ContractError>;

/// Makes a model of its parts. `dynamic`: what serves any number of free coordinates serves the small ones, too.
pub(super) fn model(parts: &Parts, library: Option<Library>, dynamic: bool) -> Read<Model> {
    let value =
        serde_json::from_str(&parts.description).map_err(|error| ContractError::Description {
            place: format!("line {}, column {}", error.line(), error.column()),
            found: error.to_string(),
            expected: "JSON".to_owned(),
        })?;
    let length = |of: &Functions| (of.values.len(), of.series.len());
    if let Some(other) = parts
        .lanes
        .iter()
        .find(|of| length(of) != length(&parts.functions))
    {
        let text = |of: (usize, usize)| format!("tables of {} functions and {} series", of.0, of.1);
        return Err(ContractError::Description {
            place: "the functions for lanes".to_owned(),
            found: text(length(other)),
            expected: text(length(&parts.functions)),
        });
    }
    let root = At::root(&value);
    let dimensions = Arc::new(root.get("dimensions", dimensions)?);
    let reader = Reader {
        functions: &parts.functions,
        lanes: &parts.lanes,
        dimensions,
        dynamic,
    };
    reader.model(&root, intern(&parts.digest), library)
}

fn dimensions(at: &At) -> Read<Dimensions> {
    let signals = at.get("signals", count)?;
    Ok(Dimensions {
        coordinates: at.get("coordinates", count)?,
        motions: at.get("motions", |at| at.list(|at| at.index(signals)))?,
        signals,
        discretes: at.get("discretes", count)?,
        parameters: at.get("parameters", count)?,
        constants: at.get("constants", count)?,
        angles: at.get("angles", count)?,
        expanded: at.get("expanded", |at| at.list_of(signals, truth))?,
        required: at.get("required", |at| at.list(|at| at.index(signals)))?,
    })
}

/// What indices refer to.
struct Reader<'p> {
    functions: &'p Functions,
    lanes: &'p [Functions],
    dimensions: Arc<Dimensions>,
    /// What serves any number of free coordinates serves the small ones, too.
    dynamic: bool,
}

/// What indices of a variant refer to.
#[derive(Clone, Copy)]
struct Modes<'f> {
    /// Number of free coordinates of each.
    free: &'f [usize],
    /// Limits, and conditions on the motion under which the model is meant.
    margins: usize,
    outputs: usize,
    impulses: usize,
}

impl Reader<'_> {
    fn model(&self, at: &At, digest: &'static str, library: Option<Library>) -> Read<Model> {
        let of = &*self.dimensions;
        let choices = at.get("choices", |at| {
            at.list(|at| {
                Ok(Choice {
                    name: at.get("name", text)?,
                    options: at.get("options", |at| at.list(text))?,
                    meaning: at.get("meaning", text)?,
                })
            })
        })?;
        let parameters = at.get("parameters", |at| at.list_of(of.parameters, parameter))?;
        let inputs = at.get("inputs", |at| at.list(|at| input(at, of.signals)))?;
        let constants = at.get("constants", |at| self.of_parameters(at, of.constants))?;
        let model = Model {
            name: at.get("name", text)?,
            digest,
            title: at.get("title", text)?,
            source: at.get("source", text)?,
            coordinates: at.get("coordinates", |at| at.list_of(of.coordinates, coordinate))?,
            motions: at.get("motions", |at| {
                at.list_of(of.motions.len(), |at| motion(at, inputs.len()))
            })?,
            parameters,
            parameter_sets: at.get("parameter_sets", |at| at.list(parameter_set))?,
            discretes: at.get("discretes", |at| at.list_of(of.discretes, discrete))?,
            variants: at.get("variants", |at| {
                at.list(|at| self.variant(at, choices.len(), inputs.len()))
            })?,
            combinations: at.get("combinations", |at| {
                at.list(|at| at.list_of(choices.len(), text))
            })?,
            inputs,
            choices,
            constants,
            for_tests: at.get("for_tests", truth)?,
            library,
        };
        let signals: usize = model.inputs.iter().map(|i| i.kind.signals()).sum();
        if signals != of.signals {
            return Err(ContractError::Description {
                place: "dimensions.signals".to_owned(),
                found: of.signals.to_string(),
                expected: format!("{signals}, as many as the inputs fill"),
            });
        }
        Ok(model)
    }

    fn variant(&self, at: &At, choices: usize, inputs: usize) -> Read<Variant> {
        let free = at.get("modes", |at| {
            at.list(|at| at.get("free", |at| Ok(at.list(count)?.len())))
        })?;
        if free.is_empty() {
            return Err(at.wrong("a variant with modes"));
        }
        let index = |at: &At| at.index(free.len());
        let limits = at.get("limits", |at| at.list(limit))?;
        let outputs = at.get("outputs", |at| at.list(output))?;
        let impulses = at.get("impulses", |at| at.list(|at| self.impulse(at)))?;
        let valid_motion = at.get("valid_motion", |at| at.list(validity))?;
        let valid_parameters = at.get("valid_parameters", |at| at.list(validity))?;
        let bounds = at.get("bounds", |at| at.list(|at| self.bound(at)))?;
        let modes = Modes {
            free: &free,
            margins: limits.len() + valid_motion.len(),
            outputs: outputs.len(),
            impulses: impulses.len(),
        };
        Ok(Variant {
            options: at.get("options", |at| at.list_of(choices, text))?,
            defaults: at.get("defaults", |at| at.list_of(choices, truth))?,
            drawing: at.get("drawing", text)?,
            barred: at.get("barred", |at| at.list(|at| at.index(inputs)))?,
            discretes: at.get("discretes", |at| {
                at.list(|at| at.index(self.dimensions.discretes))
            })?,
            modes: at.get("modes", |at| at.list(|at| self.mode(at, modes)))?,
            rests: at.get("rests", |at| {
                at.list(|at| {
                    Ok(Rest {
                        source: at.get("source", index)?,
                        target: at.get("target", index)?,
                    })
                })
            })?,
            contacts: at.get("contacts", |at| at.list(contacts::declared))?,
            limits,
            outputs,
            impulses,
            valid_motion,
            declared: at.get("declared", |at| {
                self.of_parameters(at, valid_parameters.len() + bounds.len())
            })?,
            valid_parameters,
            bounds,
            lean: at.get("lean", |at| {
                at.option(|at| {
                    Ok((
                        at.get("without", |at| at.list(|at| at.index(inputs)))?,
                        Box::new(at.get("variant", |at| self.variant(at, choices, inputs))?),
                    ))
                })
            })?,
        })
    }

    fn impulse(&self, at: &At) -> Read<Impulse> {
        let coordinates = self.dimensions.coordinates;
        Ok(Impulse {
            name: at.get("name", text)?,
            unit: at.get("unit", text)?,
            meaning: at.get("meaning", text)?,
            multiplier: at.get("multiplier", |at| at.option(|at| at.index(coordinates)))?,
        })
    }

    fn bound(&self, at: &At) -> Read<ParametricBound> {
        let coordinates = self.dimensions.coordinates;
        Ok(ParametricBound {
            coordinate: at.get("coordinate", |at| at.index(coordinates))?,
            upper: at.get("upper", truth)?,
            text: at.get("text", text)?,
        })
    }

    fn mode(&self, at: &At, modes: Modes) -> Read<Mode> {
        let n = self.dimensions.coordinates;
        let free = at.get("free", |at| {
            let free = at.list(|at| at.index(n))?;
            match free.is_sorted_by(|a, b| a < b) {
                true => Ok(free),
                false => Err(at.wrong("increasing indices")),
            }
        })?;
        let guards = at.get("guards", |at| {
            at.list(|at| self.guard(at, free.len(), modes))
        })?;
        let requirements = at.get("requirements", |at| at.list(requirement))?;
        let margins = at.get("margins", |at| {
            at.list_of(modes.margins, |at| {
                at.option(|at| self.shape(at, free.len()))
            })
        })?;
        let counts = Counts {
            required: requirements.len() + margins.len(),
            outputs: modes.outputs,
        };
        Ok(Mode {
            name: at.get("name", text)?,
            meaning: at.get("meaning", text)?,
            held_at: at.get("held_at", |at| at.list_of(n, |at| at.option(held_at)))?,
            drifts: at.get("drifts", |at| at.list_of(n, truth))?,
            depends: at.get("depends", |at| at.list_of(n, truth))?,
            contacts: {
                let kernel = || {
                    let size = Dynamic(free.len());
                    at.get("kernel", |at| self.kernel(at, size, &guards, counts))
                };
                at.get("contacts", |at| {
                    at.option(|at| self.contacts(at, guards.len(), kernel()?))
                })?
            },
            system: at.get("system", |at| {
                self.tape(at, free.len() * free.len() + free.len())
            })?,
            guard_values: at.get("guard_values", |at| self.tape(at, guards.len()))?,
            kernels: at.get("kernel", |at| self.kernels(at, free.len(), &guards, counts))?,
            frictions: at.get("frictions", |at| at.list(|at| friction(at, &guards)))?,
            operations: at.get("operations", |at| {
                at.list(|at| Ok((at.entry(0, 2, text)?, at.entry(1, 2, count)?)))
            })?,
            free,
            guards,
            requirements,
            margins,
        })
    }

    fn guard(&self, at: &At, free: usize, modes: Modes) -> Read<Guard> {
        Ok(Guard {
            name: at.get("name", text)?,
            text: at.get("text", text)?,
            unit: at.get("unit", text)?,
            shape: at.get("shape", |at| self.shape(at, free))?,
            of_forces: at.get("of_forces", truth)?,
            direction: at.get("direction", |at| {
                at.option(|at| at.index(self.dimensions.discretes))
            })?,
            kernel: GuardKernel {
                dimensions: self.dimensions.clone(),
                free,
                value: at.get("guard", |at| self.value(at))?,
                rate: at.get("guard_rate", |at| self.value(at))?,
                magnitude: at.get("guard_magnitude", |at| self.value(at))?,
                rounding: at.get("guard_rounding", |at| self.value(at))?,
                in_lanes: at.get("guard", |at| self.in_lanes(at))?,
            },
            transitions: at.get("transitions", |at| {
                at.list(|at| self.transition(at, free, modes))
            })?,
        })
    }

    fn transition(&self, at: &At, source_free: usize, modes: Modes) -> Read<Transition> {
        let target = at.get("target", |at| at.index(modes.free.len()))?;
        let condition = at.get("condition", |at| {
            at.option(|at| {
                let function = at.get("function", |at| self.value(at))?;
                Ok((function, modes.free[target], at.get("count", count)?))
            })
        })?;
        let count = condition.map_or(0, |(_, _, count)| count);
        let impulses = at.get("impulses", |at| {
            at.option(|at| match self.counted(at)? {
                found if found.1 == modes.impulses => Ok(found),
                _ => Err(at.wrong(format!("{} impulses", modes.impulses))),
            })
        })?;
        let stays = at.get("stays", truth)?;
        let in_lanes = match stays {
            true => at.get("reset", |at| self.in_lanes(at))?,
            false => Box::default(),
        };
        Ok(Transition {
            name: at.get("name", text)?,
            target,
            conditional: condition.is_some(),
            changes: at.get("changes", |at| at.list(text))?,
            impact: at.get("impact", truth)?,
            is_chart: at.get("is_chart", truth)?,
            conditions: at.get("conditions", |at| self.tape(at, count))?,
            kernel: TransitionKernel {
                dimensions: self.dimensions.clone(),
                source_free,
                reset: at.get("reset", |at| self.value(at))?,
                condition,
                impulses,
                in_lanes,
            },
        })
    }

    fn shape(&self, at: &At, free: usize) -> Read<GuardShape> {
        at.tagged(|key, at| match key {
            "linear" => Ok(GuardShape::Linear {
                index: at.get("index", |at| at.index(free))?,
                rate: at.get("rate", truth)?,
                factor: at.get("factor", number)?,
                discrete: at.get("discrete", |at| {
                    at.option(|at| at.index(self.dimensions.discretes))
                })?,
                offset: at.get("offset", truth)?,
            }),
            "general" => Ok(GuardShape::General {
                accelerations: at.get("accelerations", truth)?,
                signals: at.get("signals", truth)?,
            }),
            _ => Err(at.wrong("`linear` or `general`")),
        })
    }
}

fn friction(at: &At, guards: &[Guard]) -> Read<TiedFriction> {
    let change = |at: &At| {
        let guard = at.entry(0, 2, |at| at.index(guards.len()))?;
        let transitions = guards[guard].transitions.len();
        Ok((guard, at.entry(1, 2, |at| at.index(transitions))?))
    };
    let changes = at.get("changes", |at| at.list_of(2, |at| at.option(change)))?;
    Ok(TiedFriction {
        name: at.get("name", text)?,
        sticks: at.get("sticks", truth)?,
        changes: [changes[0], changes[1]],
    })
}

fn coordinate(at: &At) -> Read<Coordinate> {
    Ok(Coordinate {
        name: at.get("name", text)?,
        unit: at.get("unit", text)?,
        meaning: at.get("meaning", text)?,
        reaction_unit: at.get("reaction_unit", text)?,
        multiplier: at.get("multiplier", truth)?,
        scale: at.get("scale", number)?,
        rate_scale: at.get("rate_scale", number)?,
        minimum: at.get("minimum", |at| at.option(number))?,
        maximum: at.get("maximum", |at| at.option(number))?,
    })
}

fn motion(at: &At, inputs: usize) -> Read<Motion> {
    Ok(Motion {
        name: at.get("name", text)?,
        unit: at.get("unit", text)?,
        reaction_unit: at.get("reaction_unit", text)?,
        is_ground: at.get("is_ground", truth)?,
        input: at.get("input", |at| at.index(inputs))?,
        meaning: at.get("meaning", text)?,
    })
}

fn parameter(at: &At) -> Read<Parameter> {
    Ok(Parameter {
        name: at.get("name", text)?,
        unit: at.get("unit", text)?,
        meaning: at.get("meaning", text)?,
        default: at.get("default", number)?,
        minimum: at.get("minimum", number)?,
        minimum_exclusive: at.get("minimum_exclusive", truth)?,
        maximum: at.get("maximum", number)?,
        at_most: at.get("at_most", |at| at.option(text))?,
    })
}

fn parameter_set(at: &At) -> Read<ParameterSet> {
    Ok(ParameterSet {
        name: at.get("name", text)?,
        meaning: at.get("meaning", text)?,
        values: at.get("values", |at| {
            at.list(|at| Ok((at.entry(0, 2, text)?, at.entry(1, 2, number)?)))
        })?,
    })
}

fn input(at: &At, signals: usize) -> Read<Input> {
    let kind = at.get("kind", |at| match text(at)? {
        "acceleration" => Ok(InputKind::Acceleration),
        "value" => Ok(InputKind::Value),
        _ => Err(at.wrong("`acceleration` or `value`")),
    })?;
    Ok(Input {
        name: at.get("name", text)?,
        unit: at.get("unit", text)?,
        meaning: at.get("meaning", text)?,
        kind,
        signal: at.get("signal", |at| {
            at.index((signals + 1).saturating_sub(kind.signals()))
        })?,
    })
}

fn discrete(at: &At) -> Read<Discrete> {
    Ok(Discrete {
        name: at.get("name", text)?,
        values: at.get("values", |at| match at.list(number)? {
            values if values.is_empty() => Err(at.wrong("values")),
            values => Ok(values),
        })?,
        given: at.get("given", truth)?,
        meaning: at.get("meaning", text)?,
    })
}

fn held_at(at: &At) -> Read<HeldAt> {
    at.tagged(|key, at| match key {
        "number" => number(at).map(HeldAt::Number),
        "expression" => text(at).map(HeldAt::Expression),
        _ => Err(at.wrong("`number` or `expression`")),
    })
}

fn limit(at: &At) -> Read<Limit> {
    Ok(Limit {
        name: at.get("name", text)?,
        message: at.get("message", text)?,
        text: at.get("text", text)?,
        ends: at.get("ends", truth)?,
    })
}

fn output(at: &At) -> Read<Output> {
    Ok(Output {
        name: at.get("name", text)?,
        unit: at.get("unit", text)?,
        meaning: at.get("meaning", text)?,
        text: at.get("text", text)?,
    })
}

fn validity(at: &At) -> Read<Validity> {
    Ok(Validity {
        condition: at.get("condition", text)?,
        sentence: at.get("sentence", text)?,
    })
}

fn requirement(at: &At) -> Read<Requirement> {
    Ok(Requirement {
        text: at.get("text", text)?,
        failure: at.get("failure", text)?,
        unit: at.get("unit", text)?,
        may_vanish: at.get("may_vanish", truth)?,
    })
}
