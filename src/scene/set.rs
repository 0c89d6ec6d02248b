//! `--set path=value`: changes to a scene from the command line.

use std::sync::Arc;

use super::error::{SceneError, SceneErrorKind};
use super::source::{Source, Span};
use super::tree::{self, Entry, Node, Value};

/// Applies `parameters.mu_s=0.3` to a scene. The value is JSON; what is not JSON is a text. Objects
/// on the way that do not exist are made; a number selects from a list (`sum.0`).
pub(crate) fn apply(root: &mut Node, argument: &str) -> Result<(), SceneError> {
    let source = Arc::new(Source {
        name: "--set".into(),
        text: argument.into(),
    });
    let whole = Span::new(&source, 0..argument.len());
    let usage = "write --set path=value, such as --set parameters.m=2.5 or --set rules=paper";
    let Some(equals) = argument.find('=') else {
        return Err(wrong("there is no `=`".into(), &whole).help(usage));
    };
    let path = segments(&whole.part(0..equals));
    if let Some(empty) = path.iter().find(|s| s.text().is_empty()) {
        return Err(wrong("a name is missing in the path".into(), empty).help(usage));
    }
    let span = whole.part(equals + 1..argument.len());
    let value = tree::parse_part(&span).unwrap_or_else(|| Node {
        value: Value::Text(span.text().to_owned()),
        span,
    });
    put(root, &path, value)
}

/// Puts a value where the names of a path lead.
pub(crate) fn put(root: &mut Node, path: &[Span], value: Node) -> Result<(), SceneError> {
    *descend(root, path)? = value;
    Ok(())
}

/// The names of a path. A `rate` belongs to the name before it, as in `initial.theta.rate`.
pub(crate) fn segments(path: &Span) -> Vec<Span> {
    let mut segments: Vec<Span> = Vec::new();
    let mut start = 0;
    for name in path.text().split('.') {
        let end = start + name.len();
        match segments.last_mut() {
            Some(last) if name == "rate" => last.range.end = path.range.start + end,
            _ => segments.push(path.part(start..end)),
        }
        start = end + 1;
    }
    segments
}

/// The place in the tree where a path leads. A key that is itself a path, as those of studies are, is one name.
fn descend<'t>(mut node: &'t mut Node, mut path: &[Span]) -> Result<&'t mut Node, SceneError> {
    while let Some((segment, mut rest)) = path.split_first() {
        let found = node.type_name();
        if node.value == Value::Null {
            *node = new_object(segment);
        }
        node = match &mut node.value {
            Value::Object(entries) => {
                let (name, after) = longest(entries, path);
                rest = after;
                member(entries, &name)
            }
            Value::List(items) => {
                let length = items.len();
                let index = segment.text().parse().ok().filter(|&i: &usize| i < length);
                let index = index.ok_or_else(|| {
                    let message = format!(
                        "`{}` selects nothing from a list of {length}",
                        segment.text()
                    );
                    wrong(message, segment).help("entries of a list count from 0")
                })?;
                &mut items[index]
            }
            _ => {
                let message = format!("`{}` cannot be set inside {found}", segment.text());
                return Err(
                    wrong(message, segment).help("set the whole value, as JSON, one name earlier")
                );
            }
        };
        path = rest;
    }
    Ok(node)
}

/// The first name of a path: as many as make a key that is there, else one; and the names after it.
fn longest<'p>(entries: &[Entry], path: &'p [Span]) -> (Span, &'p [Span]) {
    for count in (2..=path.len()).rev() {
        let mut joined = path[0].clone();
        joined.range.end = path[count - 1].range.end;
        if entries.iter().any(|entry| entry.key == joined.text()) {
            return (joined, &path[count..]);
        }
    }
    (path[0].clone(), &path[1..])
}

fn member<'t>(entries: &'t mut Vec<Entry>, segment: &Span) -> &'t mut Node {
    let key = segment.text();
    let index = entries
        .iter()
        .position(|entry| entry.key == key)
        .unwrap_or_else(|| {
            let entry = Entry {
                key: key.to_owned(),
                key_span: segment.clone(),
                node: new_object(segment),
            };
            entries.push(entry);
            entries.len() - 1
        });
    &mut entries[index].node
}

fn new_object(at: &Span) -> Node {
    Node {
        span: at.clone(),
        value: Value::Object(Vec::new()),
    }
}

fn wrong(message: String, at: &Span) -> SceneError {
    SceneError::new(SceneErrorKind::Override { message }, at)
}
