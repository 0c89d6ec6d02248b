//! What can be wrong with a scene, where, and what would be right.

use std::fmt;
use std::path::PathBuf;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use super::source::{Position, Span};
use super::wording::shown;
use crate::hybrid::Exceeds;
use crate::input::TableError;

/// One thing that is wrong with a scene.
///
/// Its `Display` shows file, line, column, the line with a caret, and what would be right.
#[derive(Clone, PartialEq)]
pub struct SceneError(Box<Detail>);

#[derive(Clone, PartialEq)]
struct Detail {
    kind: SceneErrorKind,
    span: Option<Span>,
    help: Option<String>,
}

/// What is wrong, without where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneErrorKind {
    /// A file cannot be read.
    #[error("cannot read `{path}`: {reason}", path = .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// There is no model of a folder.
    #[error("no model from `{folder}`: {reason}")]
    NoModel {
        /// The folder, as the scene names it.
        folder: String,
        /// Why not.
        reason: String,
    },
    /// The scene has another version of the format.
    #[error("this scene has format {found}, and this version of dalembert reads format {known}")]
    Format {
        /// Its version.
        found: String,
        /// That which is read.
        known: u32,
    },
    /// The text is not JSON, or not UTF-8.
    #[error("{message}")]
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// A `--set` that is not `path=value`, or whose path leads nowhere.
    #[error("{message}")]
    Override {
        /// What is wrong with it.
        message: String,
    },
    /// An object has a key twice.
    #[error("`{key}` is already there")]
    DuplicateKey {
        /// The key.
        key: String,
    },
    /// A name that is not among the known ones: a key, a model, a mode, a coordinate, ….
    #[error("unknown {what} `{name}`")]
    UnknownName {
        /// What it should name.
        what: String,
        /// The name.
        name: String,
        /// The names that would be right.
        known: Vec<String>,
    },
    /// A key that must be there is not.
    #[error("{} missing", .keys.join(" or "))]
    MissingKey {
        /// The key, or the keys of which one must be there.
        keys: Vec<String>,
    },
    /// Two keys exclude each other.
    #[error("`{first}` and `{second}` exclude each other")]
    Conflict {
        /// One of the keys.
        first: String,
        /// The other.
        second: String,
    },
    /// A value has the wrong JSON type, or a list the wrong length.
    #[error("expected {expected}, found {found}")]
    WrongType {
        /// What would be right.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A number that double precision cannot hold.
    #[error("`{text}` is not a finite number")]
    NotFinite {
        /// The number as it is written.
        text: String,
    },
    /// A text that should be a number with a unit and is not.
    #[error("`{text}` is not a number with a unit: {reason}")]
    NotAQuantity {
        /// The text.
        text: String,
        /// What cannot be read.
        reason: String,
    },
    /// A number with a unit of the wrong dimension.
    #[error("unit `{given}` does not fit, expected `{expected}`")]
    WrongUnit {
        /// The unit in the scene.
        given: String,
        /// The unit of the quantity.
        expected: String,
    },
    /// A number outside its admissible range.
    #[error("{} is not admissible here: it must be {range}", shown(*.value))]
    OutOfRange {
        /// The number, in the unit of the quantity.
        value: f64,
        /// The range, in words.
        range: String,
    },
    /// A parameter is larger than one that it must not exceed.
    #[error(transparent)]
    Exceeds(#[from] Exceeds),
    /// Choices that the model does not offer together.
    #[error("the model does not offer {chosen} together")]
    NoVariant {
        /// The choices.
        chosen: String,
    },
    /// A coordinate to freeze that no mode holds still.
    #[error("`{coordinate}` moves in every mode, so it cannot be frozen")]
    NeverFrozen {
        /// The coordinate.
        coordinate: &'static str,
    },
    /// A text with a character that is none.
    #[error("this text holds {found}, which cannot be printed")]
    NotPrintable {
        /// Its code point, `U+001B`.
        found: String,
    },
    /// A limit state that is asked for, and that the scene ignores.
    #[error("the scene ignores the limit state `{limit}`")]
    Ignored {
        /// The limit state.
        limit: String,
    },
    /// An input that the chosen options do not know.
    #[error("input `{input}` has no effect{under}, and may not be given")]
    BarredInput {
        /// The input.
        input: &'static str,
        /// The options, ` under …`.
        under: String,
    },
    /// What is about gaps and constraints, where there are none.
    #[error(
        "`{key}` has no effect{under}, where there is neither a contact with a gap nor a constraint"
    )]
    NoContacts {
        /// The key of the scene.
        key: &'static str,
        /// The options, ` under …`.
        under: String,
    },
    /// An output whose expression cannot be read, or does not fit its unit.
    #[error("{message}")]
    Formula {
        /// What is wrong with it.
        message: String,
    },
    /// The initial state is at odds with its mode, or with what the scene freezes.
    #[error("{message}")]
    State {
        /// In what way.
        message: String,
    },
    /// The rows of a table do not make a function.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A ground-motion record that cannot be read, or not be used as asked.
    #[error("{message}")]
    Record {
        /// What is wrong with it.
        message: String,
    },
    /// A line of a table that is not two numbers.
    #[error("{message}")]
    Row {
        /// What is wrong with it.
        message: String,
    },
}

impl SceneError {
    pub(crate) fn new(kind: SceneErrorKind, at: &Span) -> Self {
        SceneError(Box::new(Detail {
            kind,
            span: Some(at.clone()),
            help: None,
        }))
    }

    /// A file could not be read and no other file names it.
    pub(crate) fn unreadable(path: PathBuf, reason: &std::io::Error) -> Self {
        let kind = SceneErrorKind::Unreadable {
            path,
            reason: reason.to_string(),
        };
        SceneError(Box::new(Detail {
            kind,
            span: None,
            help: None,
        }))
    }

    /// Adds what would be right.
    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.0.help = Some(help.into());
        self
    }

    /// What is wrong.
    pub fn kind(&self) -> &SceneErrorKind {
        &self.0.kind
    }

    /// Where it is; nowhere if the scene file itself could not be read.
    pub fn position(&self) -> Option<Position> {
        self.0.span.as_ref().map(Span::position)
    }

    /// What would be right.
    pub fn suggestion(&self) -> Option<&str> {
        self.0.help.as_deref()
    }

    /// The error as the terminal shows it, in colours if `styled`.
    pub fn render(&self, styled: bool) -> String {
        let Detail { kind, span, help } = &*self.0;
        let about = span.as_ref().map(|span| {
            let source = &span.source;
            (&*source.name, &*source.text, Some(span.range.clone()))
        });
        rendered(&kind.to_string(), about, help.as_deref(), styled)
    }
}

/// An error as the terminal shows it: what is wrong, the file that it is about with its text and the place in it, and
/// what to do.
pub(crate) fn rendered(
    message: &str,
    about: Option<(&str, &str, Option<std::ops::Range<usize>>)>,
    help: Option<&str>,
    styled: bool,
) -> String {
    let mut group = Group::with_title(Level::ERROR.primary_title(message));
    group = match about {
        Some((name, text, Some(range))) => {
            let mark = AnnotationKind::Primary.span(range);
            group.element(Snippet::source(text).path(name).annotation(mark))
        }
        Some((name, _, None)) => group.element(Origin::path(name)),
        None => group,
    };
    if let Some(help) = help {
        group = group.element(Level::HELP.message(help));
    }
    let renderer = if styled {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    renderer.render(&[group])
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl fmt::Debug for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SceneError")
            .field("kind", self.kind())
            .field("position", &self.position())
            .field("help", &self.0.help)
            .finish()
    }
}

impl std::error::Error for SceneError {}

/// Everything that was found wrong with a scene: one error at least, in the order in which they
/// were found.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneErrors(Vec<SceneError>);

impl SceneErrors {
    /// The errors.
    pub fn iter(&self) -> std::slice::Iter<'_, SceneError> {
        self.0.iter()
    }

    /// All errors as the terminal shows them, in colours if `styled`.
    pub fn render(&self, styled: bool) -> String {
        self.0
            .iter()
            .map(|e| e.render(styled))
            .collect::<Vec<_>>()
            .join("\n\n")
    }
}

impl From<SceneError> for SceneErrors {
    fn from(error: SceneError) -> Self {
        SceneErrors(vec![error])
    }
}

impl<'a> IntoIterator for &'a SceneErrors {
    type Item = &'a SceneError;
    type IntoIter = std::slice::Iter<'a, SceneError>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneErrors {}

/// Collects errors while a scene is read, so that one run reports all that are independent.
#[derive(Debug, Default)]
pub(crate) struct Errors(Vec<SceneError>);

impl Errors {
    pub fn push(&mut self, error: SceneError) {
        self.0.push(error);
    }

    /// Notes the error of a result, if it is one.
    pub fn note<T>(&mut self, result: Result<T, SceneError>) -> Option<T> {
        result.map_err(|error| self.push(error)).ok()
    }

    /// `Ok` if there is none so far.
    pub fn check(&mut self) -> Result<(), SceneErrors> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(SceneErrors(std::mem::take(&mut self.0)))
        }
    }
}
