//! The outputs of a scene: expressions in names of the model.

use super::check::Checked;
use super::error::{Errors, SceneError, SceneErrorKind};
use super::shape::{Key, Object, Shape};
use super::source::Span;
use super::tree::{Node, Value};
use crate::formula::FormulaError;
use crate::hybrid::Problem;

/// The shape of `outputs`.
pub(super) fn shape() -> Object {
    let keys = vec![
        Key::new(
            "expression",
            "sums, products, powers and sin, cos, tan, exp, log, sqrt, atan2 of coordinates, rates (`x.rate`), accelerations, \
             reactions (`reaction.x`), inputs, discrete states, parameters, and outputs before it",
            Shape::Text,
        )
        .required(),
        Key::new("unit", "unit of its values, such as mm; `1` is none", Shape::Line).required(),
        Key::new("meaning", "what it means, and its sign", Shape::Line),
    ];
    let output = Object::new("key of an output", keys);
    Object::new("output", Vec::new()).others(output)
}

/// Names and units of what a scene, as it is written, states as outputs: what its limits may be about.
pub(super) fn named(root: &Node) -> Vec<(String, String)> {
    let Some(Value::Object(entries)) = root.get("outputs").map(|node| &node.value) else {
        return Vec::new();
    };
    let unit = |node: &Node| match node.get("unit").map(|unit| &unit.value) {
        Some(Value::Text(unit)) => unit.clone(),
        _ => String::new(),
    };
    let named = entries.iter().map(|e| (e.key.clone(), unit(&e.node)));
    named.collect()
}

/// Adds the outputs of a checked scene.
pub(super) fn add(problem: &mut Problem, scene: &Checked, errors: &mut Errors) {
    for (name, said) in scene.get("outputs").map_or(&[][..], Checked::entries) {
        let [expression, unit] = ["expression", "unit"].map(|key| {
            let Some(value) = said.get(key) else {
                unreachable!("`{key}` is a required key");
            };
            value
        });
        let meaning = said.get("meaning").map_or(expression.text(), Checked::text);
        let added = problem.add_output(name, unit.text(), expression.text(), meaning);
        if let Err(FormulaError {
            range,
            message,
            help,
        }) = added
        {
            let place = match range {
                Some(range) => within(expression, range),
                None if message.starts_with("unit") => unit.place.clone(),
                None => said.place.clone(),
            };
            let kind = SceneErrorKind::Formula { message };
            errors.push(SceneError::new(kind, &place).help(help));
        }
    }
}

/// A stretch of a text in the scene. Where the file writes it otherwise, with escapes, it is the whole text.
fn within(said: &Checked, range: std::ops::Range<usize>) -> Span {
    let written = said.place.text();
    match written.get(1..written.len().saturating_sub(1)) == Some(said.text()) {
        true => said
            .place
            .part(range.start + 1..range.end.max(range.start + 1) + 1),
        false => said.place.clone(),
    }
}
