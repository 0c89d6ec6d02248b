//! Scenes: JSON files that say what to simulate, read into checked values.
//!
//! `docs/scene.md` describes the format. Reading is pure: a text, overrides and a source of further
//! files in; a [`Scene`] or all [`SceneErrors`] out. Each error knows its file, line and column and
//! what would be right.

pub(crate) mod check;
pub(crate) mod error;
mod files;
pub(crate) mod format;
mod inputs;
mod interpret;
mod limits;
pub(crate) mod number;
mod outputs;
mod record;
mod schema;
pub(crate) mod set;
pub(crate) mod shape;
pub(crate) mod source;
mod state;
mod table;
#[cfg(feature = "cli")]
pub(crate) mod template;
pub(crate) mod tree;
pub(crate) mod wording;

use std::path::Path;
use std::sync::Arc;

pub(crate) use format::METHODS;

#[cfg(feature = "cli")]
pub(crate) use error::rendered;
pub use error::{SceneError, SceneErrorKind, SceneErrors};
pub use files::{Disk, Files};
#[cfg(feature = "cli")]
pub(crate) use record::Record;
pub use schema::schema;
#[cfg(feature = "cli")]
pub(crate) use schema::schema_of;
pub use source::Position;
#[cfg(feature = "cli")]
pub(crate) use wording::nearest;

use crate::hybrid::Problem;
use crate::model::Models;
use source::{Source, Span};
use tree::{Node, Value};

/// A scene whose every part that does not need the model's functions has been checked.
#[derive(Debug, Clone)]
pub struct Scene {
    /// What to simulate, in the units of the model.
    pub problem: Problem,
    /// The text behind it, for errors that only the model's functions can find.
    pub source: SceneSource,
}

impl Scene {
    /// Reads a scene file, applies the overrides (`path=value`) and checks the result. Tables are
    /// found relative to the folder of the scene.
    pub fn load(path: &Path, overrides: &[String], models: &Models) -> Result<Scene, SceneErrors> {
        Scene::load_from(&Disk, path, overrides, models)
    }

    /// As [`Scene::load`], with files from elsewhere.
    pub fn load_from(
        files: &dyn Files,
        path: &Path,
        overrides: &[String],
        models: &Models,
    ) -> Result<Scene, SceneErrors> {
        let bytes = files
            .read(path)
            .map_err(|e| SceneError::unreadable(path.to_owned(), &e))?;
        Scene::parse(&bytes, path, overrides, models, files)
    }

    /// As [`Scene::load`], with the contents of the scene file at hand; `path` names it in errors
    /// and is what tables are relative to.
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        overrides: &[String],
        models: &Models,
        files: &dyn Files,
    ) -> Result<Scene, SceneErrors> {
        let source = decode(bytes, path)?;
        let mut root = tree::parse(&source)?;
        for argument in overrides {
            set::apply(&mut root, argument)?;
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        interpret::scene(root, models, files, folder)
    }
}

/// The text of a file, which must be UTF-8. A byte-order mark, which some editors put in front of it, says only that.
pub(crate) fn decode(bytes: &[u8], path: &Path) -> Result<Arc<Source>, SceneError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let name = path.display().to_string();
    let text = String::from_utf8_lossy(bytes).into_owned();
    let source = Arc::new(Source { name, text });
    match std::str::from_utf8(bytes) {
        Ok(_) => Ok(source),
        Err(error) => {
            // Up to there both texts are the same; then the lossy one has a replacement character.
            let place = Span::new(&source, error.valid_up_to()..source.text.len()).start();
            let kind = SceneErrorKind::Syntax {
                message: "the text is not UTF-8".into(),
            };
            Err(SceneError::new(kind, &place).help("save the file as UTF-8"))
        }
    }
}

/// The text behind a scene.
#[derive(Debug, Clone)]
pub struct SceneSource {
    root: Node,
}

impl SceneSource {
    /// The scene as it is run, with what `--set` has put into it, as JSON.
    pub fn json(&self) -> String {
        self.root.json()
    }

    /// An error that points at `path` in the scene (`initial.theta.rate`), or, if the scene says
    /// nothing there, at what is nearest to it on the way. For what only the model's functions can
    /// find out: an initial state that violates its mode.
    pub fn error_at(
        &self,
        path: &str,
        message: impl Into<String>,
        help: Option<&str>,
    ) -> SceneError {
        let path = Arc::new(Source {
            name: String::new(),
            text: path.to_owned(),
        });
        let mut node = &self.root;
        let mut place = node.place();
        for segment in set::segments(&Span::new(&path, 0..path.text.len())) {
            let Value::Object(entries) = &node.value else {
                break;
            };
            let Some(entry) = entries.iter().find(|e| e.key == segment.text()) else {
                break;
            };
            node = &entry.node;
            place = match node.value {
                Value::Object(_) | Value::List(_) => entry.key_span.clone(),
                _ => node.place(),
            };
        }
        let error = SceneError::new(
            SceneErrorKind::State {
                message: message.into(),
            },
            &place,
        );
        match help {
            Some(help) => error.help(help),
            None => error,
        }
    }
}

#[cfg(test)]
mod tests;
