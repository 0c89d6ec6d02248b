//! The scene format as a JSON Schema, for editors and for other programs.

use serde_json::{Map, Value, json};

use super::format;
use super::shape::{Object, Quantity, Shape};
use crate::model::Model;

/// JSON Schema (draft 2020-12) of the scenes of a model, or of any scene for `None`.
///
/// It is made of the same tables that scenes are checked against. What it cannot say is checked
/// when a scene is read: dimensions of units, one parameter limiting another, the order of times.
pub fn schema(model: Option<&Model>) -> Value {
    let title = match model {
        Some(model) => format!("dalembert scene of the model {}", model.name),
        None => "dalembert scene".into(),
    };
    schema_of(&format::scene(model, None), &title)
}

/// JSON Schema of files of a shape.
pub(crate) fn schema_of(shape: &Object, title: &str) -> Value {
    let mut schema = object(shape);
    schema.insert(
        "$schema".into(),
        json!("https://json-schema.org/draft/2020-12/schema"),
    );
    schema.insert("title".into(), json!(title));
    Value::Object(schema)
}

fn shape(shape: &Shape) -> Value {
    match shape {
        Shape::Null => json!({ "type": "null" }),
        Shape::Flag => json!({ "type": "boolean" }),
        Shape::Text => json!({ "type": "string" }),
        Shape::Line => {
            json!({ "type": "string", "pattern": "^[^\\u0000-\\u001f\\u007f-\\u009f]*$" })
        }
        Shape::Count => json!({ "type": "integer", "minimum": 1 }),
        Shape::Values(values) => json!({ "enum": values }),
        Shape::Choice(_, names) => json!({ "enum": names }),
        Shape::Quantity(q) => quantity(q),
        Shape::List(item) => json!({ "type": "array", "items": self::shape(item) }),
        Shape::Tuple(_, items) => {
            let items: Vec<Value> = items.iter().map(self::shape).collect();
            json!({ "type": "array", "minItems": items.len(), "prefixItems": items, "items": false })
        }
        Shape::Object(o) => Value::Object(object(o)),
        Shape::Any => json!({}),
        Shape::Tagged(_, objects) => {
            json!({ "oneOf": objects.iter().map(|o| Value::Object(object(o))).collect::<Vec<_>>() })
        }
        Shape::Either(shapes) => {
            json!({ "anyOf": shapes.iter().map(self::shape).collect::<Vec<_>>() })
        }
    }
}

fn quantity(q: &Quantity) -> Value {
    let mut number = Map::from_iter([("type".to_owned(), json!("number"))]);
    if q.bounds.minimum.is_finite() {
        let key = if q.bounds.minimum_exclusive {
            "exclusiveMinimum"
        } else {
            "minimum"
        };
        number.insert(key.into(), json!(q.bounds.minimum));
    }
    if q.bounds.maximum.is_finite() {
        number.insert("maximum".into(), json!(q.bounds.maximum));
    }
    let text = json!({ "type": "string", "pattern": "^\\s*[-+]?[0-9]", "description": "a number and its unit" });
    json!({ "anyOf": [number, text] })
}

fn object(object: &Object) -> Map<String, Value> {
    let mut properties = Map::new();
    for key in &object.keys {
        let mut value = shape(&key.shape);
        if let Value::Object(map) = &mut value {
            let unit = match &key.shape {
                Shape::Quantity(q) if !q.unit.is_empty() => format!(" [{}]", q.unit),
                _ => String::new(),
            };
            map.insert(
                "description".into(),
                json!(format!("{}{unit}", key.meaning)),
            );
            if let Some(default) = &key.default {
                map.insert("default".into(), default.clone());
            }
        }
        properties.insert(key.name.clone(), value);
    }
    let required: Vec<&str> = object
        .keys
        .iter()
        .filter(|k| k.required)
        .map(|k| k.name.as_str())
        .collect();
    let others = object
        .others
        .as_ref()
        .map_or(Value::Bool(false), |o| shape(o));
    let mut schema = Map::from_iter([
        ("type".to_owned(), json!("object")),
        ("properties".to_owned(), Value::Object(properties)),
        ("required".to_owned(), json!(required)),
        ("additionalProperties".to_owned(), others),
    ]);
    let alternatives: Vec<Value> = object
        .alternatives
        .iter()
        .map(|(keys, one_needed)| {
            let one = keys.map(|key| json!({ "required": [key] }));
            let both = json!({ "not": { "required": keys } });
            if *one_needed {
                json!({ "oneOf": one })
            } else {
                both
            }
        })
        .collect();
    if !alternatives.is_empty() {
        schema.insert("allOf".into(), json!(alternatives));
    }
    schema
}
