//! JSON text as a tree whose every node knows where it stands.

use std::sync::Arc;

use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use jsonc_parser::errors::ParseErrorKind;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};

use super::error::{SceneError, SceneErrorKind};
use super::source::{Source, Span};

/// A JSON value and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Node {
    pub span: Span,
    pub value: Value,
}

/// A JSON value. Numbers stay as they are written, so that units can be converted exactly.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Null,
    Flag(bool),
    Number(String),
    Text(String),
    List(Vec<Node>),
    Object(Vec<Entry>),
}

/// A key of an object and its value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub key: String,
    pub key_span: Span,
    pub node: Node,
}

impl Node {
    /// What errors about the whole value point at: the value, or the bracket that opens it.
    pub fn place(&self) -> Span {
        match self.value {
            Value::List(_) | Value::Object(_) => self.span.start(),
            _ => self.span.clone(),
        }
    }

    /// The value's type as errors name it.
    pub fn type_name(&self) -> &'static str {
        match self.value {
            Value::Null => "null",
            Value::Flag(_) => "true or false",
            Value::Number(_) => "a number",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Object(_) => "an object",
        }
    }

    /// The value as JSON: on one line where that is short, else a line for each part.
    pub fn json(&self) -> String {
        self.json_at(0)
    }

    fn json_at(&self, depth: usize) -> String {
        let quoted = |text: &str| serde_json::to_string(text).expect("texts are JSON");
        let (brackets, parts) = match &self.value {
            Value::Null => return "null".into(),
            Value::Flag(flag) => return flag.to_string(),
            Value::Number(digits) => return digits.clone(),
            Value::Text(text) => return quoted(text),
            Value::List(nodes) => {
                let parts = nodes.iter().map(|node| node.json_at(depth + 1));
                (["[", "]"], parts.collect::<Vec<_>>())
            }
            Value::Object(entries) => {
                let part = |e: &Entry| format!("{}: {}", quoted(&e.key), e.node.json_at(depth + 1));
                (["{", "}"], entries.iter().map(part).collect())
            }
        };
        let [open, close] = brackets;
        let line = format!("{open} {} {close}", parts.join(", "));
        let is_short = !line.contains('\n') && 2 * depth + line.len() <= 100;
        match (parts.is_empty(), is_short && depth > 0) {
            (true, _) => format!("{open}{close}"),
            (_, true) => line,
            _ => {
                let indent = "  ".repeat(depth);
                let between = format!(",\n{indent}  ");
                let parts = parts.join(&between);
                format!("{open}\n{indent}  {parts}\n{indent}{close}")
            }
        }
    }

    /// The value of a key, if this is an object that has it.
    pub fn get(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Value::Object(entries) => entries.iter().find(|e| e.key == key).map(|e| &e.node),
            _ => None,
        }
    }
}

/// Parses strict JSON, in which no key may come twice.
pub(crate) fn parse(source: &Arc<Source>) -> Result<Node, SceneError> {
    let whole = Span::new(source, 0..source.text.len());
    let ast = parse_value(&whole)?;
    let node = convert(&ast, &whole)?;
    // The parser admits white space and control characters that JSON does not.
    serde_json::from_str::<serde::de::IgnoredAny>(&source.text)
        .map_err(|error| syntax(error_without_place(&error), &place_of(&error, &whole)))?;
    Ok(node)
}

/// Parses one JSON value that is a part of a text.
pub(crate) fn parse_part(span: &Span) -> Option<Node> {
    serde_json::from_str::<serde::de::IgnoredAny>(span.text()).ok()?;
    convert(&parse_value(span).ok()?, span).ok()
}

fn parse_value<'a>(span: &'a Span) -> Result<ast::Value<'a>, SceneError> {
    let strict = ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    let parsed =
        parse_to_ast(span.text(), &CollectOptions::default(), &strict).map_err(|error| {
            let range = error.range();
            let mut at = span.part(range.start..range.end);
            if at.text().contains('\n') {
                at = at.start();
            }
            let message = match error.kind() {
                ParseErrorKind::ExpectedComma => "expected a comma".to_owned(),
                kind => lower_first(&kind.to_string()),
            };
            match syntax_help(error.kind()) {
                Some(help) => syntax(message, &at).help(help),
                None => syntax(message, &at),
            }
        })?;
    parsed.value.ok_or_else(|| {
        syntax("there is nothing here".into(), &span.start())
            .help("a scene is a JSON object: { \"model\": … }")
    })
}

fn syntax(message: String, at: &Span) -> SceneError {
    SceneError::new(
        SceneErrorKind::Syntax {
            message: format!("not JSON: {message}"),
        },
        at,
    )
}

fn syntax_help(kind: &ParseErrorKind) -> Option<&'static str> {
    Some(match kind {
        ParseErrorKind::CommentsNotAllowed => {
            "JSON has no comments; use `title` to describe a scene"
        }
        ParseErrorKind::TrailingCommasNotAllowed => "remove the comma after the last entry",
        ParseErrorKind::ExpectedStringObjectProperty => "write keys in double quotes",
        ParseErrorKind::SingleQuotedStringsNotAllowed => "use double quotes",
        ParseErrorKind::UnexpectedWord | ParseErrorKind::UnexpectedToken => {
            "numbers are finite, texts stand in double quotes"
        }
        ParseErrorKind::BareDecimalPointNumbersNotAllowed => {
            "write digits on both sides of the point"
        }
        ParseErrorKind::UnaryPlusNumbersNotAllowed => "leave the plus sign out",
        ParseErrorKind::NonFiniteNumbersNotAllowed => "numbers are finite",
        ParseErrorKind::UnterminatedObject => "a closing brace is missing",
        ParseErrorKind::UnterminatedArray => "a closing bracket is missing",
        _ => return None,
    })
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| {
        first.to_lowercase().chain(chars).collect()
    })
}

fn error_without_place(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or(&text).to_owned()
}

/// Where the second parser stopped; it counts columns in bytes.
fn place_of(error: &serde_json::Error, whole: &Span) -> Span {
    let text = whole.text();
    let lines = text
        .split_inclusive('\n')
        .take(error.line().saturating_sub(1));
    let line_start: usize = lines.map(str::len).sum();
    let at = line_start + error.column().saturating_sub(1);
    whole.part(at..text.len()).start()
}

fn convert(value: &ast::Value<'_>, whole: &Span) -> Result<Node, SceneError> {
    let span = |ranged: &dyn Ranged| whole.part(ranged.start()..ranged.end());
    let node = |ranged: &dyn Ranged, value| Node {
        span: span(ranged),
        value,
    };
    Ok(match value {
        ast::Value::NullKeyword(null) => node(null, Value::Null),
        ast::Value::BooleanLit(flag) => node(flag, Value::Flag(flag.value)),
        ast::Value::NumberLit(number) => node(number, Value::Number(number.value.to_owned())),
        ast::Value::StringLit(text) => node(text, Value::Text(text.value.clone().into_owned())),
        ast::Value::Array(array) => {
            let items = array.elements.iter().map(|item| convert(item, whole));
            node(array, Value::List(items.collect::<Result<_, _>>()?))
        }
        ast::Value::Object(object) => {
            let mut entries: Vec<Entry> = Vec::with_capacity(object.properties.len());
            for property in &object.properties {
                let (key, key_span) = match &property.name {
                    ast::ObjectPropName::String(name) => (name.value.as_ref(), span(name)),
                    ast::ObjectPropName::Word(name) => (name.value, span(name)),
                };
                if let Some(first) = entries.iter().find(|e| e.key == key) {
                    let line = first.key_span.position().line;
                    let kind = SceneErrorKind::DuplicateKey {
                        key: key.to_owned(),
                    };
                    return Err(SceneError::new(kind, &key_span)
                        .help(format!("the first one is in line {line}; keep one of them")));
                }
                let node = convert(&property.value, whole)?;
                entries.push(Entry {
                    key: key.to_owned(),
                    key_span,
                    node,
                });
            }
            node(object, Value::Object(entries))
        }
    })
}
