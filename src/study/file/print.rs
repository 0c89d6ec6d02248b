//! JSON as text, keys in the order in which they were written.

use std::fmt::Write;

use serde_json::Value as Json;

use crate::scene::tree::{Node, Value};

/// The tree as indented JSON.
pub(super) fn pretty(node: &Node) -> String {
    let mut out = String::new();
    write(node, Some(0), &mut out);
    out.push('\n');
    out
}

/// A value as a table shows it: a text as it is, anything else as JSON in one line.
pub(super) fn label(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => text.clone(),
        _ => {
            let mut out = String::new();
            write(node, None, &mut out);
            out
        }
    }
}

/// A value, its lines indented by so many blanks; in one line for `None`.
fn write(node: &Node, indent: Option<usize>, out: &mut String) {
    let quoted = |text: &str| Json::from(text).to_string();
    match &node.value {
        Value::Null => out.push_str("null"),
        Value::Flag(flag) => {
            let _ = write!(out, "{flag}");
        }
        Value::Number(text) => out.push_str(text),
        Value::Text(text) => out.push_str(&quoted(text)),
        Value::List(items) => {
            out.push('[');
            for (i, item) in items.iter().enumerate() {
                out.push_str(if i > 0 { ", " } else { "" });
                write(item, None, out);
            }
            out.push(']');
        }
        Value::Object(entries) if entries.is_empty() => out.push_str("{}"),
        Value::Object(entries) => {
            let inner = indent.map(|indent| indent + 2);
            let line = |indent: Option<usize>, out: &mut String| match indent {
                Some(indent) => {
                    let _ = write!(out, "\n{:indent$}", "");
                }
                None => out.push(' '),
            };
            out.push('{');
            for (i, entry) in entries.iter().enumerate() {
                out.push_str(if i > 0 { "," } else { "" });
                line(inner, out);
                let _ = write!(out, "{}: ", quoted(&entry.key));
                write(&entry.node, inner, out);
            }
            line(indent, out);
            out.push('}');
        }
    }
}
