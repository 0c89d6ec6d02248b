//! Holds a JSON tree against its shape, and converts its numbers to the units of the model.

use super::error::{Errors, SceneError, SceneErrorKind};
use super::number;
use super::shape::{Object, Shape};
use super::source::Span;
use super::tree::{Entry, Node, Value};
use super::wording::{listing, nearest};

/// A value that has its shape. Numbers are in the units of the model.
#[derive(Debug, Clone)]
pub(crate) struct Checked {
    /// What errors about the value point at.
    pub place: Span,
    pub datum: Datum,
}

/// The value itself.
#[derive(Debug, Clone)]
pub(crate) enum Datum {
    Null,
    Flag(bool),
    Number(f64),
    Text(String),
    List(Vec<Checked>),
    Object(Vec<(String, Checked)>),
    /// Of a place where any value may be.
    #[cfg_attr(
        not(feature = "cli"),
        allow(dead_code, reason = "only study files have such values")
    )]
    Any(Node),
}

/// The accessors are for places whose shape has been checked; at another place they panic, as that
/// would be a mistake of this crate and not of the scene.
impl Checked {
    pub fn number(&self) -> f64 {
        match self.datum {
            Datum::Number(x) => x,
            _ => unreachable!("checked to be a number: {self:?}"),
        }
    }

    pub fn flag(&self) -> bool {
        match self.datum {
            Datum::Flag(flag) => flag,
            _ => unreachable!("checked to be a flag: {self:?}"),
        }
    }

    pub fn text(&self) -> &str {
        match &self.datum {
            Datum::Text(text) => text,
            _ => unreachable!("checked to be a text: {self:?}"),
        }
    }

    /// The text, if it is one.
    pub fn as_text(&self) -> Option<&str> {
        match &self.datum {
            Datum::Text(text) => Some(text),
            _ => None,
        }
    }

    pub fn is_list(&self) -> bool {
        matches!(self.datum, Datum::List(_))
    }

    pub fn list(&self) -> &[Checked] {
        match &self.datum {
            Datum::List(items) => items,
            _ => unreachable!("checked to be a list: {self:?}"),
        }
    }

    pub fn entries(&self) -> &[(String, Checked)] {
        match &self.datum {
            Datum::Object(entries) => entries,
            _ => unreachable!("checked to be an object: {self:?}"),
        }
    }

    pub fn is_object(&self) -> bool {
        matches!(self.datum, Datum::Object(_))
    }

    #[cfg_attr(
        not(feature = "cli"),
        allow(dead_code, reason = "only study files have such values")
    )]
    /// The value as it was written, where any may be.
    pub fn any(&self) -> &Node {
        match &self.datum {
            Datum::Any(node) => node,
            _ => unreachable!("checked to be any value: {self:?}"),
        }
    }

    #[cfg_attr(
        not(feature = "cli"),
        allow(dead_code, reason = "only study files have such values")
    )]
    /// The number, if it is one.
    pub fn as_number(&self) -> Option<f64> {
        match self.datum {
            Datum::Number(x) => Some(x),
            _ => None,
        }
    }

    /// The value of a key; `None` if it is absent, or if this is not an object.
    pub fn get(&self, key: &str) -> Option<&Checked> {
        match &self.datum {
            Datum::Object(entries) => entries.iter().find(|(k, _)| k == key).map(|(_, v)| v),
            _ => None,
        }
    }
}

/// Checks a value; every error found is noted. The value is `None` if it, or a part of it, is
/// wrong.
pub(crate) fn check(node: &Node, shape: &Shape, errors: &mut Errors) -> Option<Checked> {
    let datum = match (shape, &node.value) {
        (Shape::Either(shapes), _) => match shapes.iter().find(|s| accepts_type(s, &node.value)) {
            Some(shape) => return check(node, shape, errors),
            None => wrong_type(node, shape, errors),
        },
        (Shape::Null, Value::Null) => Some(Datum::Null),
        (Shape::Flag, Value::Flag(flag)) => Some(Datum::Flag(*flag)),
        (Shape::Text, Value::Text(text)) => Some(Datum::Text(text.clone())),
        (Shape::Line, Value::Text(text)) => errors.note(line(node, text)),
        (Shape::Choice(what, names), Value::Text(text)) => {
            errors.note(choice(node, what, names, text))
        }
        (Shape::Count, Value::Number(text)) => {
            errors.note(number::count(node, text)).map(Datum::Number)
        }
        (Shape::Values(values), Value::Number(text)) => errors
            .note(number::one_of(node, values, text))
            .map(Datum::Number),
        (Shape::Quantity(quantity), Value::Number(_) | Value::Text(_)) => errors
            .note(number::quantity(node, quantity))
            .map(Datum::Number),
        (Shape::List(shape), Value::List(items)) => {
            let checked: Vec<_> = items
                .iter()
                .map(|item| check(item, shape, errors))
                .collect();
            checked.into_iter().collect::<Option<_>>().map(Datum::List)
        }
        (Shape::Tuple(_, shapes), Value::List(items)) if items.len() == shapes.len() => {
            let pairs = items.iter().zip(shapes);
            let checked: Vec<_> = pairs
                .map(|(item, shape)| check(item, shape, errors))
                .collect();
            checked.into_iter().collect::<Option<_>>().map(Datum::List)
        }
        (Shape::Object(shape), Value::Object(entries)) => object(node, shape, entries, errors),
        (Shape::Any, _) => Some(Datum::Any(node.clone())),
        (Shape::Tagged(what, shapes), Value::Object(entries)) => {
            let shape = errors.note(alternative(node, what, shapes, entries))?;
            object(node, shape, entries, errors)
        }
        _ => wrong_type(node, shape, errors),
    };
    datum.map(|datum| Checked {
        place: node.place(),
        datum,
    })
}

/// Whether a shape is the one that a value of this JSON type is meant for.
fn accepts_type(shape: &Shape, value: &Value) -> bool {
    match shape {
        Shape::Null => matches!(value, Value::Null),
        Shape::Flag => matches!(value, Value::Flag(_)),
        Shape::Text | Shape::Line | Shape::Choice(..) => matches!(value, Value::Text(_)),
        Shape::Count | Shape::Values(_) => matches!(value, Value::Number(_)),
        Shape::Quantity(_) => matches!(value, Value::Number(_) | Value::Text(_)),
        Shape::List(_) | Shape::Tuple(..) => matches!(value, Value::List(_)),
        Shape::Object(_) | Shape::Tagged(..) => matches!(value, Value::Object(_)),
        Shape::Any => true,
        Shape::Either(shapes) => shapes.iter().any(|s| accepts_type(s, value)),
    }
}

fn wrong_type(node: &Node, shape: &Shape, errors: &mut Errors) -> Option<Datum> {
    let found = match &node.value {
        Value::List(items) if matches!(shape, Shape::Tuple(..)) => {
            format!("a list of {}", items.len())
        }
        _ => node.type_name().to_owned(),
    };
    let kind = SceneErrorKind::WrongType {
        expected: shape.describe(),
        found,
    };
    let error = SceneError::new(kind, &node.place());
    errors.push(match shape {
        Shape::Choice(_, names) => error.help(one_of_these(names.iter().copied())),
        Shape::Tagged(_, shapes) => error.help(one_of_these(shapes.iter().map(tag))),
        _ => error,
    });
    None
}

fn one_of_these<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    format!("known: {}", listing(names))
}

/// An error for a name that is not known, with the nearest one, or all of them.
pub(crate) fn unknown_name(what: &str, name: &str, known: &[&str], at: &Span) -> SceneError {
    let kind = SceneErrorKind::UnknownName {
        what: what.to_owned(),
        name: name.to_owned(),
        known: known.iter().map(|k| (*k).to_owned()).collect(),
    };
    let help = match nearest(name, known.iter().copied()) {
        Some(near) => format!(
            "did you mean `{near}`? {}",
            one_of_these(known.iter().copied())
        ),
        None => one_of_these(known.iter().copied()),
    };
    SceneError::new(kind, at).help(help)
}

/// A text without control characters, which would act on a terminal, without code points for private use, and without those
/// that are no characters: no picture may hold them.
fn line(node: &Node, text: &str) -> Result<Datum, SceneError> {
    let has_no_print = |c: &char| {
        let is_private = matches!(u32::from(*c), 0xe000..=0xf8ff | 0xf0000..);
        c.is_control() || is_private || u32::from(*c) & 0xfffe == 0xfffe
    };
    match text.chars().find(has_no_print) {
        None => Ok(Datum::Text(text.to_owned())),
        Some(found) => {
            let found = format!("U+{:04X}", u32::from(found));
            let kind = SceneErrorKind::NotPrintable { found };
            Err(SceneError::new(kind, &node.place()).help("write one line of printable characters"))
        }
    }
}

fn choice(
    node: &Node,
    what: &str,
    names: &[&'static str],
    text: &str,
) -> Result<Datum, SceneError> {
    if names.contains(&text) {
        Ok(Datum::Text(text.to_owned()))
    } else {
        Err(unknown_name(what, text, names, &node.place()))
    }
}

/// The key that tells an alternative from the others: its first.
fn tag(object: &Object) -> &str {
    &object.keys[0].name
}

fn alternative<'a>(
    node: &Node,
    what: &str,
    shapes: &'a [Object],
    entries: &[Entry],
) -> Result<&'a Object, SceneError> {
    let mut found = entries.iter().filter_map(|entry| {
        shapes
            .iter()
            .find(|shape| tag(shape) == entry.key)
            .map(|shape| (entry, shape))
    });
    let tags: Vec<&str> = shapes.iter().map(tag).collect();
    match (found.next(), found.next()) {
        (Some((_, shape)), None) => Ok(shape),
        (Some((first, _)), Some((second, _))) => {
            Err(conflict(first, second).help(match tags.contains(&"sum") {
                true => "keep one of them; a `sum` adds several functions",
                false => "keep one of them",
            }))
        }
        (None, _) => Err(match entries.first() {
            Some(entry) => unknown_name(
                &format!("kind of {what}"),
                &entry.key,
                &tags,
                &entry.key_span,
            ),
            None => {
                let keys = tags.iter().map(|t| (*t).to_owned()).collect();
                SceneError::new(SceneErrorKind::MissingKey { keys }, &node.place())
            }
        }),
    }
}

fn object(node: &Node, shape: &Object, entries: &[Entry], errors: &mut Errors) -> Option<Datum> {
    let mut complete = true;
    let mut checked = Vec::with_capacity(entries.len());
    for entry in entries {
        let shape = match (shape.key(&entry.key), &shape.others) {
            (Some(key), _) => &key.shape,
            (None, Some(others)) => others,
            (None, None) => {
                errors.push(unknown_key(shape, entry));
                complete = false;
                continue;
            }
        };
        match check(&entry.node, shape, errors) {
            Some(value) => checked.push((entry.key.clone(), value)),
            None => complete = false,
        }
    }
    for error in missing_and_conflicting(node, shape, entries) {
        errors.push(error);
        complete = false;
    }
    complete.then_some(Datum::Object(checked))
}

/// Required keys that are absent, and keys that exclude each other.
fn missing_and_conflicting(node: &Node, shape: &Object, entries: &[Entry]) -> Vec<SceneError> {
    let mut errors = Vec::new();
    let position = |name: &str| entries.iter().position(|entry| entry.key == name);
    let missing = |keys: Vec<String>, help: String| {
        SceneError::new(SceneErrorKind::MissingKey { keys }, &node.place()).help(help)
    };
    for key in shape
        .keys
        .iter()
        .filter(|key| key.required && position(&key.name).is_none())
    {
        let help = format!(
            "add `{}`: {} ({})",
            key.name,
            key.meaning,
            key.shape.describe()
        );
        errors.push(missing(vec![key.name.clone()], help));
    }
    for (names, one_needed) in &shape.alternatives {
        match names.map(position) {
            [None, None] if *one_needed => {
                let keys = names.iter().map(|n| (*n).to_owned()).collect();
                errors.push(missing(
                    keys,
                    format!("add {}", listing(names.iter().copied())),
                ));
            }
            [Some(one), Some(other)] => {
                let (first, second) = (&entries[one.min(other)], &entries[one.max(other)]);
                errors.push(conflict(first, second).help("keep one of them"));
            }
            _ => {}
        }
    }
    errors
}

fn conflict(first: &Entry, second: &Entry) -> SceneError {
    let (first, second, at) = (first.key.clone(), second.key.clone(), &second.key_span);
    SceneError::new(SceneErrorKind::Conflict { first, second }, at)
}

/// An error for a key that does not belong here; if it belongs into one of the objects beside it,
/// the error says so.
fn unknown_key(shape: &Object, entry: &Entry) -> SceneError {
    let elsewhere = shape.keys.iter().find(|key| match &key.shape {
        Shape::Object(inner) => inner.key(&entry.key).is_some(),
        _ => false,
    });
    let known: Vec<&str> = shape.keys.iter().map(|key| key.name.as_str()).collect();
    let error = unknown_name(shape.names, &entry.key, &known, &entry.key_span);
    match elsewhere {
        Some(key) => error.help(format!("`{}` belongs inside `{}`", entry.key, key.name)),
        None => error,
    }
}
