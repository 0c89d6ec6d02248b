//! What a problem must be before it is run: for scenes and for programs, for single runs and for members of ensembles.

use super::problem::{Accuracy, Initial, Problem};
use crate::integrate::Tolerances;
use crate::model::{Bounds, Model, shown};
use crate::numerics::Const;
use nalgebra::SVector;

/// Something of a problem that is not admissible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Invalid {
    /// A name that the model does not have.
    #[error(transparent)]
    Unknown(#[from] Unknown),
    /// A number outside its bounds, or not finite.
    #[error("{what} is {}: it must be {range}", shown(*.value))]
    OutOfRange {
        /// What it is the value of.
        what: String,
        /// The value, in its unit.
        value: f64,
        /// The bounds, in words.
        range: String,
    },
    /// A parameter is larger than one that it must not exceed.
    #[error(transparent)]
    Exceeds(#[from] Exceeds),
    /// A coordinate starts beyond a bound that depends on parameters.
    #[error("the initial state is beyond a stop: `{coordinate}` is {}, it must be {range}", shown(*.value))]
    BeyondStop {
        /// The coordinate.
        coordinate: &'static str,
        /// Its value.
        value: f64,
        /// The bounds, in words.
        range: String,
    },
    /// An input is given that the chosen options do not know.
    #[error("input `{input}` has no effect under these options of the model, and may not be given")]
    Barred {
        /// The input.
        input: &'static str,
    },
    /// A member of an ensemble has an input that never acts in the scene.
    #[error(
        "input `{input}` acts in a member of the ensemble and not in its scene, which is prepared without it; give the scene the input of a member"
    )]
    NotInScene {
        /// The input.
        input: &'static str,
    },
    /// A member of an ensemble has another relative tolerance than the scene, whose methods are made for that.
    #[error(
        "a member of the ensemble has the relative tolerance {own:e}, and its scene {scene:e}: make an ensemble for each"
    )]
    OtherTolerance {
        /// That of the member.
        own: f64,
        /// That of the scene.
        scene: f64,
    },
    /// An input is commanded whose function is given for all times.
    #[error(
        "input `{input}` cannot be commanded: its function was given for all times; give it `Function::commanded`, or a sum with that, before the run"
    )]
    NotCommanded {
        /// The input.
        input: &'static str,
    },
    /// A command that is none.
    #[error("input `{input}`: {what}")]
    Command {
        /// The input.
        input: &'static str,
        /// What is wrong with it.
        what: String,
    },
    /// A list has not an entry for each thing that it is about.
    #[error("{what}: {found} values, expected {expected}")]
    Count {
        /// What it is a list of.
        what: &'static str,
        /// Its entries.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
}

/// A name that the model does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("model `{model}` has no {what} `{name}`; it has {}", known.join(", "))]
pub struct Unknown {
    /// The model.
    pub model: &'static str,
    /// What was looked for.
    pub what: &'static str,
    /// The name.
    pub name: String,
    /// What there is.
    pub known: Vec<String>,
}

/// A parameter is larger than one that it must not exceed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{name} = {} exceeds {limit} = {}", shown(*.value), shown(*.limit_value))]
pub struct Exceeds {
    /// The parameter.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// The parameter that limits it.
    pub limit: &'static str,
    /// Its value.
    pub limit_value: f64,
}

/// A number must be within bounds.
pub(super) fn within(
    bounds: Bounds,
    unit: &str,
    value: f64,
    what: impl FnOnce() -> String,
) -> Result<(), Invalid> {
    match bounds.admit(value) {
        true => Ok(()),
        false => Err(Invalid::OutOfRange {
            what: what(),
            value,
            range: bounds.describe(unit),
        }),
    }
}

/// The first parameter that exceeds one that it must not exceed.
///
/// # Errors
/// [`Exceeds`], if there is one.
pub fn check_limits_of_parameters(model: &Model, values: &[f64]) -> Result<(), Exceeds> {
    for (parameter, &value) in model.parameters.iter().zip(values) {
        let limit = parameter.at_most.and_then(|name| model.parameter(name));
        if let Some(limit) = limit
            && value > values[limit]
        {
            return Err(Exceeds {
                name: parameter.name,
                value,
                limit: model.parameters[limit].name,
                limit_value: values[limit],
            });
        }
    }
    Ok(())
}

/// Parameters in the order of the model.
pub(super) fn check_parameters(model: &Model, values: &[f64]) -> Result<(), Invalid> {
    count("parameters", values, model.parameters.len())?;
    for (parameter, &value) in model.parameters.iter().zip(values) {
        let what = || format!("parameter `{}`", parameter.name);
        within(parameter.bounds(), parameter.unit, value, what)?;
    }
    Ok(check_limits_of_parameters(model, values)?)
}

/// A state, as far as the model's tables can judge it. One that is to be projected may be beyond the bounds of coordinates.
pub(super) fn check_initial(
    model: &Model,
    initial: &Initial,
    project: bool,
) -> Result<(), Invalid> {
    let Initial { q, v, discrete, .. } = initial;
    count("initial coordinates", q, model.coordinates.len())?;
    count("initial velocities", v, model.coordinates.len())?;
    count("initial discrete states", discrete, model.discretes.len())?;
    for ((c, &q), &v) in model.coordinates.iter().zip(q).zip(v) {
        let bounds = if project { Bounds::NONE } else { c.bounds() };
        within(bounds, c.unit, q, || format!("initial `{}`", c.name))?;
        within(Bounds::NONE, "", v, || format!("initial `{}.rate`", c.name))?;
    }
    for (d, &value) in model.discretes.iter().zip(discrete) {
        if !d.values.contains(&value) {
            let values: Vec<_> = d.values.iter().map(|&v| shown(v)).collect();
            return Err(Invalid::OutOfRange {
                what: format!("initial `{}`", d.name),
                value,
                range: values.join(" or "),
            });
        }
    }
    Ok(())
}

fn count(what: &'static str, list: &[f64], expected: usize) -> Result<(), Invalid> {
    match list.len() == expected {
        true => Ok(()),
        false => Err(Invalid::Count {
            what,
            found: list.len(),
            expected,
        }),
    }
}

impl Problem {
    /// Whether everything is admissible that can be judged without the model's functions: parameters within their
    /// bounds and limits, an initial state within its own, an end, tolerances. Runs refuse a problem that is not.
    ///
    /// # Errors
    /// [`Invalid`]: the first thing that is not.
    pub fn check(&self) -> Result<(), Invalid> {
        check_parameters(&self.model, &self.parameters)?;
        check_initial(&self.model, &self.initial, self.project)?;
        if let Some(input) = self.barred_input() {
            return Err(Invalid::Barred { input });
        }
        check_accuracy(&self.model, &self.accuracy)?;
        self.check_limits()?;
        let positive = Bounds::POSITIVE;
        within(positive, "s", self.end.time, || "the end".into())?;
        match self.record.every {
            // At the end alone.
            None | Some(f64::INFINITY) => Ok(()),
            Some(every) => within(positive, "s", every, || {
                "the interval of the samples".into()
            }),
        }
    }
}

/// Refuses tolerances that no method can keep.
pub(super) fn check_accuracy(model: &Model, accuracy: &Accuracy) -> Result<(), Invalid> {
    let n = model.coordinates.len();
    let Accuracy {
        relative,
        q_absolute,
        v_absolute,
    } = accuracy;
    count("absolute tolerances of coordinates", q_absolute, n)?;
    count("absolute tolerances of velocities", v_absolute, n)?;
    let least = Tolerances::<Const<0>>::SMALLEST_RELATIVE;
    if !(least..1.0).contains(relative) {
        return Err(Invalid::OutOfRange {
            what: "the relative tolerance".into(),
            value: *relative,
            range: format!("from {} to below 1", shown(least)),
        });
    }
    let tolerances = q_absolute.iter().zip(v_absolute);
    for (c, (&q, &v)) in model.coordinates.iter().zip(tolerances) {
        let [of_q, of_v] = [q, v].map(SVector::<f64, 1>::repeat);
        if Tolerances::<Const<1>>::new(*relative, of_q, of_v).is_err() {
            return Err(Invalid::OutOfRange {
                what: format!("an absolute tolerance of `{}`", c.name),
                value: if v > 0.0 && v.is_finite() { q } else { v },
                range: "> 0".into(),
            });
        }
    }
    Ok(())
}
