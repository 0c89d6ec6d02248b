//! Reading the description of a model: every value with its place, every index against what it counts.

use crate::kernel::ContractError;
use crate::model::name::intern;
use serde_json::Value;
use std::fmt::Write;

/// A value of a description, and where it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct At<'a> {
    value: &'a Value,
    parent: Option<(&'a At<'a>, Step<'a>)>,
}

/// How a value is reached from the one that holds it.
#[derive(Debug, Clone, Copy)]
enum Step<'a> {
    Key(&'a str),
    Entry(usize),
}

type Read<T> = Result<T, ContractError>;

impl<'a> At<'a> {
    pub fn root(value: &'a Value) -> Self {
        At {
            value,
            parent: None,
        }
    }

    /// That another value is meant here.
    pub fn wrong(&self, expected: impl Into<String>) -> ContractError {
        let mut found = self.value.to_string();
        if found.chars().count() > 60 {
            found = found.chars().take(60).chain(['…']).collect();
        }
        ContractError::Description {
            place: self.place(),
            found,
            expected: expected.into(),
        }
    }

    fn place(&self) -> String {
        let Some((parent, step)) = self.parent else {
            return String::new();
        };
        let mut place = parent.place();
        // Writing to a string cannot fail.
        let _ = match step {
            Step::Key(key) if place.is_empty() => write!(place, "{key}"),
            Step::Key(key) => write!(place, ".{key}"),
            Step::Entry(index) => write!(place, "[{index}]"),
        };
        place
    }

    /// Reads the value of a key.
    pub fn get<T>(&self, key: &str, read: impl FnOnce(&At) -> Read<T>) -> Read<T> {
        let Value::Object(entries) = self.value else {
            return Err(self.wrong("an object"));
        };
        let Some(value) = entries.get(key) else {
            return Err(self.wrong(format!("an object with the key `{key}`")));
        };
        let parent = Some((self, Step::Key(key)));
        read(&At { value, parent })
    }

    /// The only key of an object, and what `read` makes of its value.
    pub fn tagged<T>(&self, read: impl FnOnce(&str, &At) -> Read<T>) -> Read<T> {
        let entries = self.value.as_object().filter(|entries| entries.len() == 1);
        let Some((key, value)) = entries.and_then(|entries| entries.iter().next()) else {
            return Err(self.wrong("an object of one key"));
        };
        let parent = Some((self, Step::Key(key)));
        read(key, &At { value, parent })
    }

    pub fn list<T>(&self, mut read: impl FnMut(&At) -> Read<T>) -> Read<Box<[T]>> {
        let Value::Array(entries) = self.value else {
            return Err(self.wrong("a list"));
        };
        let each = entries.iter().enumerate().map(|(i, value)| {
            read(&At {
                value,
                parent: Some((self, Step::Entry(i))),
            })
        });
        each.collect()
    }

    /// A list of as many entries.
    pub fn list_of<T>(&self, count: usize, read: impl FnMut(&At) -> Read<T>) -> Read<Box<[T]>> {
        match self.value.as_array().map(Vec::len) {
            Some(found) if found != count => Err(ContractError::Description {
                place: self.place(),
                found: entries(found),
                expected: entries(count),
            }),
            _ => self.list(read),
        }
    }

    /// An entry of a list that has `count`.
    pub fn entry<T>(
        &self,
        index: usize,
        count: usize,
        read: impl FnOnce(&At) -> Read<T>,
    ) -> Read<T> {
        let list = self.value.as_array().filter(|list| list.len() == count);
        let Some(list) = list else {
            return Err(self.wrong(format!("a list of {}", entries(count))));
        };
        let parent = Some((self, Step::Entry(index)));
        read(&At {
            value: &list[index],
            parent,
        })
    }

    /// `None` where there is null.
    pub fn option<T>(&self, read: impl FnOnce(&At) -> Read<T>) -> Read<Option<T>> {
        match self.value {
            Value::Null => Ok(None),
            _ => read(self).map(Some),
        }
    }

    /// An index below a number.
    pub fn index(&self, below: usize) -> Read<usize> {
        match count(self) {
            Ok(index) if index < below => Ok(index),
            _ => Err(self.wrong(format!("an index below {below}"))),
        }
    }
}

/// A text, interned.
pub(super) fn text(at: &At) -> Read<&'static str> {
    let text = at.value.as_str().ok_or_else(|| at.wrong("a text"))?;
    Ok(intern(text))
}

/// Whether something is so.
pub(super) fn truth(at: &At) -> Read<bool> {
    at.value.as_bool().ok_or_else(|| at.wrong("true or false"))
}

/// A number; infinities and what is no number are texts.
pub(super) fn number(at: &At) -> Read<f64> {
    match at.value.as_str() {
        Some("inf") => Ok(f64::INFINITY),
        Some("-inf") => Ok(f64::NEG_INFINITY),
        Some("nan") => Ok(f64::NAN),
        _ => at.value.as_f64().ok_or_else(|| at.wrong("a number")),
    }
}

/// A whole number.
pub(super) fn count(at: &At) -> Read<usize> {
    let number = at.value.as_u64().and_then(|n| usize::try_from(n).ok());
    number.ok_or_else(|| at.wrong("a count"))
}

fn entries(count: usize) -> String {
    match count {
        1 => "1 entry".to_owned(),
        _ => format!("{count} entries"),
    }
}
