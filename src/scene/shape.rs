//! What a value in a scene may look like.
//!
//! One description serves twice: [`super::check`] holds a scene against it, and [`super::schema`]
//! prints it as a JSON Schema.

use super::wording::shown;
use crate::model::Bounds;

/// The admissible values at one place of a scene.
#[derive(Debug, Clone)]
pub(crate) enum Shape {
    /// `null`.
    Null,
    /// `true` or `false`.
    Flag,
    /// Any text.
    Text,
    /// A text of printable characters.
    Line,
    /// A whole number from 1 on.
    Count,
    /// A number in a unit, or a text with a number and a unit.
    Quantity(Quantity),
    /// One of some numbers.
    Values(Box<[f64]>),
    /// One of some names; the first text says of what (`mode`).
    Choice(&'static str, Vec<&'static str>),
    /// A list of any length.
    List(Box<Shape>),
    /// A list with one entry for each shape, and what it is (`[time, value]`).
    Tuple(&'static str, Vec<Shape>),
    /// An object with known keys.
    Object(Object),
    /// An object with exactly one of some keys, each of which allows keys beside it; the text says of what they are the
    /// kinds.
    Tagged(&'static str, Vec<Object>),
    /// Values of different JSON types.
    Either(Vec<Shape>),
    /// Any value: it is judged where it is used.
    #[cfg_attr(
        not(feature = "cli"),
        allow(dead_code, reason = "only study files have such values")
    )]
    Any,
}

/// A number with a unit and a range.
#[derive(Debug, Clone)]
pub(crate) struct Quantity {
    /// Unit of a plain number; empty if the model, and with it the unit, is not known.
    pub unit: String,
    pub bounds: Bounds,
    /// Whether a text may have no unit, too: a factor of numbers that are in the unit themselves.
    pub or_factor: bool,
}

/// An object.
#[derive(Debug, Clone, Default)]
pub(crate) struct Object {
    /// What its keys name, as in "unknown parameter".
    pub names: &'static str,
    pub keys: Vec<Key>,
    /// Keys of which only one may be there; if `true`, one must.
    pub alternatives: Vec<([&'static str; 2], bool)>,
    /// The shape of keys that are not listed; `None` if there must not be any.
    pub others: Option<Box<Shape>>,
}

/// A key of an object.
#[derive(Debug, Clone)]
pub(crate) struct Key {
    pub name: String,
    pub meaning: String,
    pub required: bool,
    /// What holds if it is absent, in JSON.
    pub default: Option<serde_json::Value>,
    pub shape: Shape,
}

impl Quantity {
    /// A number within bounds.
    pub fn within(bounds: Bounds, unit: impl Into<String>) -> Self {
        let unit = unit.into();
        Quantity {
            unit,
            bounds,
            or_factor: false,
        }
    }

    /// Any number.
    pub fn any(unit: impl Into<String>) -> Self {
        Quantity::within(Bounds::NONE, unit)
    }

    /// A factor of numbers: without a unit if these are in `unit`, or in it.
    pub fn factor(unit: impl Into<String>) -> Self {
        Quantity {
            or_factor: true,
            ..Quantity::any(unit)
        }
    }

    /// A number > 0.
    pub fn positive(unit: impl Into<String>) -> Self {
        Quantity::within(Bounds::POSITIVE, unit)
    }

    /// A number from `minimum` on.
    pub fn at_least(minimum: f64, unit: impl Into<String>) -> Self {
        Quantity::within(Bounds::at_least(minimum), unit)
    }
}

impl From<Quantity> for Shape {
    fn from(quantity: Quantity) -> Self {
        Shape::Quantity(quantity)
    }
}

impl From<Object> for Shape {
    fn from(object: Object) -> Self {
        Shape::Object(object)
    }
}

impl Object {
    /// An object with these keys and no others.
    pub fn new(names: &'static str, keys: Vec<Key>) -> Self {
        Object {
            names,
            keys,
            ..Object::default()
        }
    }

    /// Allows other keys too, of one shape.
    pub fn others(mut self, shape: impl Into<Shape>) -> Self {
        self.others = Some(Box::new(shape.into()));
        self
    }

    /// Of two keys exactly one must be there.
    pub fn exactly_one(mut self, keys: [&'static str; 2]) -> Self {
        self.alternatives.push((keys, true));
        self
    }

    /// Of two keys at most one may be there.
    pub fn at_most_one(mut self, keys: [&'static str; 2]) -> Self {
        self.alternatives.push((keys, false));
        self
    }

    /// A key's description.
    pub fn key(&self, name: &str) -> Option<&Key> {
        self.keys.iter().find(|k| k.name == name)
    }
}

impl Key {
    /// A key that may be absent.
    pub fn new(
        name: impl Into<String>,
        meaning: impl Into<String>,
        shape: impl Into<Shape>,
    ) -> Self {
        Key {
            name: name.into(),
            meaning: meaning.into(),
            required: false,
            default: None,
            shape: shape.into(),
        }
    }

    /// The key must be there.
    pub fn required(mut self) -> Self {
        self.required = true;
        self
    }

    /// What holds if the key is absent.
    pub fn default(mut self, value: impl Into<serde_json::Value>) -> Self {
        self.default = Some(value.into());
        self
    }
}

impl Shape {
    /// What would be right, in words.
    pub fn describe(&self) -> String {
        match self {
            Shape::Null => "null".into(),
            Shape::Flag => "true or false".into(),
            Shape::Text | Shape::Line => "a text".into(),
            Shape::Count => "a whole number from 1 on".into(),
            Shape::Quantity(q) if q.unit.is_empty() || q.unit == "1" => "a number".into(),
            Shape::Quantity(q) => format!("a number in {}", q.unit),
            Shape::Values(values) => {
                let values: Vec<String> = values.iter().copied().map(shown).collect();
                values.join(" or ")
            }
            Shape::Choice(what, _) => format!("the name of a {what}"),
            Shape::List(_) => "a list".into(),
            Shape::Tuple(what, _) => format!("a list {what}"),
            Shape::Object(_) | Shape::Tagged(..) => "an object".into(),
            Shape::Any => "a value".into(),
            Shape::Either(shapes) => shapes
                .iter()
                .map(Shape::describe)
                .collect::<Vec<_>>()
                .join(" or "),
        }
    }
}
