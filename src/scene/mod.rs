//! Scenes: JSON files that say what to simulate, read into checked values.
//!
//! `docs/scene.md` describes the format. Reading is pure: a text, overrides and a source of further
//! files in; a [`Scene`] or all [`SceneErrors`] out. Each error knows its file, line and column and
//! what would be right.

mod check;
mod error;
mod files;
mod format;
mod inputs;
mod interpret;
mod number;
mod schema;
mod set;
mod shape;
mod source;
mod state;
mod table;
mod tree;
mod unit;
mod wording;

use std::path::Path;
use std::sync::Arc;

pub use error::{SceneError, SceneErrorKind, SceneErrors};
pub use files::{Disk, Files};
pub use schema::schema;
pub use source::Position;

use crate::input::Signals;
use crate::model::{Model, Variant};
use source::{Source, Span};
use tree::{Node, Value};

/// What to simulate: a scene whose every part has been checked, in the units of its model.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The model.
    pub model: &'static Model,
    /// The hybrid automaton that the scene's choices select.
    pub variant: &'static Variant,
    /// What the scene shows.
    pub title: Option<String>,
    /// Values in the order of [`Model::parameters`].
    pub parameters: Vec<f64>,
    /// The inputs, as functions of time.
    pub signals: Signals,
    /// The state at t = 0.
    pub initial: Initial,
    /// Indices of coordinates that are held still throughout, increasing.
    pub freeze: Vec<usize>,
    /// When the run ends.
    pub end: End,
    /// Error tolerances.
    pub accuracy: Accuracy,
    /// What is recorded.
    pub record: Record,
    /// The text behind the scene, for errors that only the model's functions can find.
    pub source: SceneSource,
}

/// The state at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// Coordinates, in the order of [`Model::coordinates`].
    pub q: Vec<f64>,
    /// Velocities, in the same order.
    pub v: Vec<f64>,
    /// Discrete states, in the order of [`Model::discretes`].
    pub discrete: Vec<f64>,
    /// Index of the mode among [`Variant::modes`], if the scene names it.
    pub mode: Option<usize>,
}

/// When a run ends: at the time, or after the given number of a transition, whichever is first.
#[derive(Debug, Clone, PartialEq)]
pub struct End {
    /// Time, in s.
    pub time: f64,
    /// Name of a transition and how many of it, one at least.
    pub after: Option<(&'static str, u64)>,
}

/// Error tolerances of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Accuracy {
    /// Relative tolerance.
    pub relative: f64,
    /// Absolute tolerance of each coordinate, in its unit.
    pub q_absolute: Vec<f64>,
    /// Absolute tolerance of each velocity, in its unit.
    pub v_absolute: Vec<f64>,
}

/// What is recorded of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Time between rows of the trajectory, in s; `None`: a row for each step.
    pub every: Option<f64>,
    /// Whether reactions are computed and written.
    pub reactions: bool,
    /// Whether the energy ledger is kept.
    pub energies: bool,
    /// Whether the inputs are written.
    pub inputs: bool,
}

impl Scene {
    /// Reads a scene file, applies the overrides (`path=value`) and checks the result. Tables are
    /// found relative to the folder of the scene.
    pub fn load(
        path: &Path,
        overrides: &[String],
        models: &[&'static Model],
    ) -> Result<Scene, SceneErrors> {
        let bytes = Disk
            .read(path)
            .map_err(|e| SceneError::unreadable(path.to_owned(), &e))?;
        Scene::parse(&bytes, path, overrides, models, &Disk)
    }

    /// As [`Scene::load`], with the contents of the scene file at hand; `path` names it in errors
    /// and is what tables are relative to.
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        overrides: &[String],
        models: &[&'static Model],
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

/// The text of a file, which must be UTF-8.
fn decode(bytes: &[u8], path: &Path) -> Result<Arc<Source>, SceneError> {
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

impl Scene {
    /// The problem to be simulated.
    pub fn problem(&self) -> crate::hybrid::Problem {
        use crate::hybrid as h;
        h::Problem {
            model: self.model,
            variant: self.variant,
            title: self.title.clone(),
            parameters: self.parameters.clone(),
            signals: self.signals.clone(),
            initial: h::Initial {
                q: self.initial.q.clone(),
                v: self.initial.v.clone(),
                discrete: self.initial.discrete.clone(),
                mode: self.initial.mode,
            },
            freeze: self.freeze.clone(),
            end: h::End {
                time: self.end.time,
                after: self.end.after,
            },
            accuracy: h::Accuracy {
                relative: self.accuracy.relative,
                q_absolute: self.accuracy.q_absolute.clone(),
                v_absolute: self.accuracy.v_absolute.clone(),
            },
            record: h::Record {
                every: self.record.every,
                columns: crate::record::Recorded {
                    reactions: self.record.reactions,
                    energies: self.record.energies,
                    inputs: self.record.inputs,
                },
            },
        }
    }
}
