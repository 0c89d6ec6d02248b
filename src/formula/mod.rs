//! Formulas that scenes and programs state over a model's quantities, such as `x + R * sin(theta)`: read, their names and
//! dimensions checked, and evaluated.
//!
//! A name stands for its number in the unit of the model, as in a model file; the dimension of every term is checked, an
//! angle being a number. Within a mode a formula is smooth, as all of a model is.

mod dimension;
mod expression;
mod names;
mod nearest;
mod parse;
pub(crate) mod unit;

#[cfg(test)]
mod tests;

use dimension::Dimension;
use expression::Expression;
pub use names::Names;
pub(crate) use nearest::nearest;
use std::ops::Range;
use unit::Unit;

/// What names of a formula stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Read {
    Coordinate(usize),
    Rate(usize),
    Acceleration(usize),
    Reaction(usize),
    Discrete(usize),
    Signal(usize),
    Parameter(usize),
    Output(usize),
}

/// The values that formulas are evaluated with, all in the order and the units of the model.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given<'a> {
    /// All coordinates.
    pub q: &'a [f64],
    /// All velocities.
    pub v: &'a [f64],
    /// All accelerations.
    pub a: &'a [f64],
    /// Reactions of the coordinates, then of the motions of the ground; may be empty where [`Formula::reads_reactions`] is
    /// false.
    pub reactions: &'a [f64],
    /// Discrete states.
    pub discrete: &'a [f64],
    /// Signals of the inputs.
    pub signals: &'a [f64],
    /// Parameters.
    pub parameters: &'a [f64],
    /// Outputs, as far as the formula may name them.
    pub outputs: &'a [f64],
}

/// A formula whose names and dimensions were checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    text: String,
    expression: Expression,
    /// What a value is multiplied with, and then divided by, for the unit of the result.
    to_unit: [f64; 2],
}

/// What is wrong with a formula.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}; {help}")]
pub struct FormulaError {
    /// Where, as bytes of the text; empty at its end. `None`: it is the unit, not the text.
    pub range: Option<Range<usize>>,
    /// What.
    pub message: String,
    /// What would be right.
    pub help: String,
}

impl Formula {
    /// Reads a formula whose value is wanted in a unit, such as `mm`.
    ///
    /// # Errors
    /// [`FormulaError`] where it cannot be read, names what is not there, adds what cannot be added, or has another dimension.
    pub fn new(text: &str, unit: &str, names: &Names) -> Result<Formula, FormulaError> {
        let of_unit = |message: String, help: &str| FormulaError {
            range: None,
            message,
            help: help.to_owned(),
        };
        let wanted = Unit::parse(unit).map_err(|reason| {
            of_unit(
                format!("unit `{unit}`: {reason}"),
                "write it as `mm` or `m/s^2`; `1` is none",
            )
        })?;
        if unit.contains("Hz") {
            let message = format!("unit `{unit}`: a rate may be one of angles or of cycles");
            return Err(of_unit(message, "write `1/s` or `rad/s`"));
        }
        let tree = parse::parse(text)?;
        let (expression, found) = names.resolve(&tree)?;
        let expected = Dimension::of(&wanted);
        if found.is_some_and(|found| found != expected) {
            let found = found.unwrap_or_default();
            return Err(FormulaError {
                range: Some(0..text.len()),
                message: format!(
                    "`{text}` has the dimension {found}, and its unit `{unit}` has {expected}"
                ),
                help: "change the expression or the unit".to_owned(),
            });
        }
        Ok(Formula {
            text: text.to_owned(),
            expression,
            to_unit: wanted.of_coherent(),
        })
    }

    /// The formula as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether it needs reactions.
    pub fn reads_reactions(&self) -> bool {
        let is_reaction = |read: Read| matches!(read, Read::Reaction(_));
        self.expression.reads(&is_reaction)
    }

    /// Its value, in its unit.
    ///
    /// # Panics
    /// If a value that it names is not given.
    pub fn value(&self, given: &Given) -> f64 {
        let [factor, divisor] = self.to_unit;
        self.expression.value(given) * factor / divisor
    }
}
