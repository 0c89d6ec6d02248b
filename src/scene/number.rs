//! The numbers of a scene.

use super::error::{SceneError, SceneErrorKind};
use super::shape::{Quantity, Shape};
use super::tree::{Node, Value};
use crate::formula::unit::{self, QuantityError};

/// The double that a JSON number stands for.
fn parse_finite(node: &Node, text: &str) -> Result<f64, SceneError> {
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite())
        .ok_or_else(|| not_finite(node, text))
}

fn not_finite(node: &Node, text: &str) -> SceneError {
    SceneError::new(
        SceneErrorKind::NotFinite {
            text: text.to_owned(),
        },
        &node.place(),
    )
    .help(format!("the largest number is {:e}", f64::MAX))
}

/// A whole number from 1 on.
pub(crate) fn count(node: &Node, text: &str) -> Result<f64, SceneError> {
    let value = parse_finite(node, text)?;
    // Above 2⁵³ doubles do not count by ones any more.
    if value.fract() == 0.0 && (1.0..=2f64.powi(53)).contains(&value) {
        return Ok(value);
    }
    let range = "a whole number from 1 on".to_owned();
    Err(SceneError::new(
        SceneErrorKind::OutOfRange { value, range },
        &node.place(),
    ))
}

/// One of some numbers.
pub(crate) fn one_of(node: &Node, values: &[f64], text: &str) -> Result<f64, SceneError> {
    let value = parse_finite(node, text)?;
    if values.contains(&value) {
        return Ok(value);
    }
    let range = Shape::Values(values.into()).describe();
    Err(SceneError::new(
        SceneErrorKind::OutOfRange { value, range },
        &node.place(),
    ))
}

/// A number in its unit and its range.
pub(crate) fn quantity(node: &Node, quantity: &Quantity) -> Result<f64, SceneError> {
    let value = match &node.value {
        Value::Text(text) => from_text(node, text, quantity)?,
        Value::Number(text) => parse_finite(node, text)?,
        _ => unreachable!("the caller has seen a number or a text"),
    };
    if quantity.bounds.admit(value) {
        return Ok(value);
    }
    let kind = SceneErrorKind::OutOfRange {
        value,
        range: quantity.bounds.describe(&quantity.unit),
    };
    Err(SceneError::new(kind, &node.place()))
}

fn from_text(node: &Node, text: &str, quantity: &Quantity) -> Result<f64, SceneError> {
    let unit = &quantity.unit;
    let converted = match unit::convert(text, unit) {
        Err(QuantityError::WrongUnit(_))
            if quantity.or_factor && unit::convert(text, "1").is_ok() =>
        {
            unit::convert(text, "1")
        }
        converted => converted,
    };
    converted.map_err(|error| match error {
        QuantityError::NotFinite => not_finite(node, text),
        QuantityError::Unreadable(reason) => {
            let kind = SceneErrorKind::NotAQuantity {
                text: text.to_owned(),
                reason,
            };
            let example = if unit == "1" {
                "0.5".into()
            } else {
                format!("0.5 or \"0.5 {unit}\"")
            };
            let help = match text.contains(',') {
                true => "the decimal sign is a point".to_owned(),
                false => format!("write it as {example}"),
            };
            SceneError::new(kind, &node.place()).help(help)
        }
        QuantityError::WrongUnit(given) => {
            let help = match given.as_str() {
                "g" if unit == "m/s^2" => "`g` is the gram; standard gravity is `g_n`".into(),
                "1" => {
                    format!("add the unit, or leave the quotes out: a plain number is in {unit}")
                }
                _ => format!("a plain number is in {unit}"),
            };
            let kind = SceneErrorKind::WrongUnit {
                given,
                expected: unit.clone(),
            };
            SceneError::new(kind, &node.place()).help(help)
        }
    })
}
