//! What is not as the contract says is refused, with its place and both values.

use super::description;
use super::load::linked;
use super::registry::Models;
use crate::kernel::{
    CONTRACT_VERSION, ContractError, Parts, RawModel, linked_models, name_of_linked,
    parts_of_linked,
};
use serde_json::{Value, json};

fn raw(name: &str) -> &'static RawModel {
    let mut all = linked_models().iter();
    all.find(|raw| name_of_linked(raw) == Ok(name)).unwrap()
}

fn parts(name: &str) -> Parts {
    parts_of_linked(raw(name)).unwrap()
}

/// A model as it is, but for its first fields.
fn changed(change: impl FnOnce(&mut RawModel)) -> ContractError {
    let mut model = *raw("hand_ball");
    change(&mut model);
    linked(Box::leak(Box::new(model)), false).expect_err("it was changed")
}

#[test]
fn every_linked_model_is_as_the_contract_says() {
    for raw in linked_models() {
        let model = linked(raw, false).unwrap();
        assert_eq!(Ok(model.name), name_of_linked(raw));
        assert_eq!(model.digest.len(), 16, "{}", model.digest);
    }
}

#[test]
fn two_models_of_one_name_are_refused() {
    let both = Models::linked().and(Models::linked());
    let error = both.unwrap_err().to_string();
    assert!(error.contains("a model `bead_on_hoop`"), "{error}");
}

#[test]
fn the_head_is_compared() {
    let error = changed(|model| model.mark = *b"\x7fELF\x02\x01\x01\0");
    assert!(matches!(&error, ContractError::Mark { expected, .. } if expected == "dalembrt"));
    assert!(error.to_string().contains("ELF"), "{error}");

    let version = CONTRACT_VERSION + 1;
    let error = changed(|model| model.version = version);
    let expected = CONTRACT_VERSION;
    let found = version;
    assert_eq!(error, ContractError::Version { found, expected });
    let text = error.to_string();
    assert!(text.contains(&found.to_string()) && text.contains(&expected.to_string()));

    let expected = size_of::<RawModel>() as u32;
    let error = changed(|model| model.size = 8);
    assert_eq!(error, ContractError::Size { found: 8, expected });
    assert!(error.to_string().contains("8 bytes"));
}

/// The model `bouncing_ball` with a description that was changed.
fn with(value: &Value) -> Result<(), ContractError> {
    let parts = Parts {
        description: value.to_string(),
        ..parts("hand_ball")
    };
    description::model(&parts, None, false).map(|_| ())
}

/// All places in a value, as JSON pointers.
fn places(value: &Value, place: &str, all: &mut Vec<String>) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                places(value, &format!("{place}/{key}"), all);
            }
        }
        Value::Array(entries) => {
            for (i, value) in entries.iter().enumerate() {
                places(value, &format!("{place}/{i}"), all);
            }
        }
        _ => {}
    }
    all.push(place.to_owned());
}

/// A JSON pointer as messages write it: `/variants/0/modes/1/name` is `variants[0].modes[1].name`.
fn written(pointer: &str) -> String {
    let steps = pointer.split('/').skip(1);
    steps.fold(String::new(), |text, step| {
        match (step.parse::<usize>().is_ok(), text.is_empty()) {
            (true, _) => format!("{text}[{step}]"),
            (false, true) => step.to_owned(),
            (false, false) => format!("{text}.{step}"),
        }
    })
}

#[test]
fn every_field_is_checked() {
    let whole: Value = serde_json::from_str(&parts("hand_ball").description).unwrap();
    assert_eq!(with(&whole), Ok(()));
    let mut all = Vec::new();
    places(&whole, "", &mut all);
    assert!(all.len() > 300);
    for place in &all {
        let mut value = whole.clone();
        // Of no type that is meant anywhere.
        *value.pointer_mut(place).unwrap() = json!({ "neither": 0, "nor": 0 });
        let Err(ContractError::Description { place: told, .. }) = with(&value) else {
            panic!("{place} is not checked");
        };
        assert_eq!(told, written(place));

        let (parent, key) = place.rsplit_once('/').unwrap_or_default();
        let mut value = whole.clone();
        if let Some(Value::Object(entries)) = value.pointer_mut(parent)
            && entries.remove(key).is_some()
        {
            let error = with(&value).expect_err(place);
            // The key of a kind of value has no other name.
            let named = [key, "an object of one key"];
            let error = error.to_string();
            assert!(named.iter().any(|n| error.contains(n)), "{place}: {error}");
        }
    }
}

#[test]
fn every_index_is_checked() {
    let whole: Value = serde_json::from_str(&parts("hand_ball").description).unwrap();
    let mut all = Vec::new();
    places(&whole, "", &mut all);
    let mut seen = 0;
    // Numbers of a model's own, and room that may be as large as it wants.
    let free = [
        "scale",
        "rate_scale",
        "minimum",
        "maximum",
        "default",
        "values",
        "number",
        "factor",
        "Constant",
        "operations",
        "lead",
        "row",
        "beside_guards",
        "convolutions",
        "angles",
    ];
    for place in &all {
        let value = whole.pointer(place).unwrap();
        let is_free = place.split('/').any(|step| free.contains(&step));
        if value.is_u64() && !is_free {
            let mut value = whole.clone();
            *value.pointer_mut(place).unwrap() = json!(987_654);
            let error = with(&value).expect_err(place).to_string();
            assert!(
                error.contains("987654") || error.contains("dimensions"),
                "{error}"
            );
            seen += 1;
        }
    }
    assert!(seen > 60, "{seen}");
}

#[test]
fn what_is_no_json_is_refused_with_its_place() {
    let parts = Parts {
        description: "{\n  \"name\": }".to_owned(),
        ..parts("hand_ball")
    };
    let error = description::model(&parts, None, false)
        .unwrap_err()
        .to_string();
    assert!(error.contains("line 2, column 11"), "{error}");
}
