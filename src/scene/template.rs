//! A scene file that is read once, and of which many scenes are made that differ in some values.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::error::{SceneError, SceneErrors};
use super::files::{Disk, Files};
use super::inputs::Reader;
use super::record::Records;
use super::shape::Shape;
use super::source::Span;
use super::tree::Node;
use super::{Scene, decode, format, interpret, outputs, set, tree};
use crate::model::{Model, Models};

/// A scene file, its model and the files that it names.
pub(crate) struct Template {
    folder: PathBuf,
    root: Node,
    /// The model of all its scenes.
    pub model: Arc<Model>,
    shape: Shape,
    files: Kept,
    records: Records,
}

/// A value in the place of that of the file.
pub(crate) struct Change<'a> {
    /// The names that lead there, as [`set::segments`] parts them.
    pub path: &'a [Span],
    pub value: Node,
}

/// Files of the disk, each read once.
#[derive(Default)]
struct Kept(Mutex<BTreeMap<PathBuf, Arc<[u8]>>>);

impl Files for Kept {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(contents) = kept().get(path) {
            return Ok(contents.to_vec());
        }
        let contents = Disk.read(path)?;
        kept().insert(path.to_owned(), contents.clone().into());
        Ok(contents)
    }
}

impl Template {
    /// Reads a scene file and finds its model; what the scene says is judged when one is made of it.
    pub fn load(path: &Path, models: &Models) -> Result<Template, SceneErrors> {
        let files = Kept::default();
        let bytes = files
            .read(path)
            .map_err(|e| SceneError::unreadable(path.to_owned(), &e))?;
        let root = tree::parse(&decode(&bytes, path)?)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let model = interpret::model(&root, models, &folder)?;
        let shape = Shape::Object(format::scene(Some(&model), Some(&outputs::named(&root))));
        Ok(Template {
            folder,
            root,
            model,
            shape,
            files,
            records: Records::default(),
        })
    }

    /// The scene with some other values.
    ///
    /// # Errors
    /// What is wrong with it; errors about a changed value point at where that was written.
    pub fn scene(&self, changes: &[Change]) -> Result<Scene, SceneErrors> {
        let mut root = self.root.clone();
        for change in changes {
            set::put(&mut root, change.path, change.value.clone())?;
        }
        let reader = Reader {
            files: &self.files,
            folder: &self.folder,
            records: Some(&self.records),
        };
        interpret::scene_of(root, &self.model, &self.shape, &reader)
    }

    /// What may stand where a path leads; of several possibilities a number with a unit, if that is one. `None` if
    /// the path leads nowhere.
    pub fn shape_at(&self, path: &[Span]) -> Option<&Shape> {
        let mut shapes = vec![&self.shape];
        for segment in path {
            shapes = shapes
                .into_iter()
                .flat_map(|shape| within(shape, segment.text()))
                .collect();
        }
        let mut leaves = Vec::new();
        shapes
            .into_iter()
            .for_each(|shape| flatten(shape, &mut leaves));
        let quantity = leaves.iter().find(|s| matches!(s, Shape::Quantity(_)));
        quantity.or(leaves.first()).copied()
    }

    /// The scene as it was read, and contents of all files that were read for it so far, by their paths as the scene names them.
    pub fn contents(&self) -> Vec<(String, Arc<[u8]>)> {
        let kept = self.files.0.lock().unwrap_or_else(PoisonError::into_inner);
        let named = |path: &PathBuf| {
            let path = path.strip_prefix(&self.folder).unwrap_or(path);
            path.display().to_string()
        };
        kept.iter()
            .map(|(path, contents)| (named(path), contents.clone()))
            .collect()
    }
}

/// The shapes that a shape without alternatives has inside, under one name.
fn within<'s>(shape: &'s Shape, name: &str) -> Vec<&'s Shape> {
    let mut leaves = Vec::new();
    flatten(shape, &mut leaves);
    let objects = leaves.into_iter().flat_map(|leaf| match leaf {
        Shape::Object(object) => vec![object],
        Shape::Tagged(_, objects) => objects.iter().collect(),
        _ => Vec::new(),
    });
    let mut inside: Vec<&Shape> = objects
        .filter_map(|object| match object.key(name) {
            Some(key) => Some(&key.shape),
            None => object.others.as_deref(),
        })
        .collect();
    if name.parse::<usize>().is_ok() {
        let mut leaves = Vec::new();
        flatten(shape, &mut leaves);
        inside.extend(leaves.into_iter().filter_map(|leaf| match leaf {
            Shape::List(item) => Some(&**item),
            Shape::Tuple(_, items) => items.get(name.parse::<usize>().ok()?),
            _ => None,
        }));
    }
    inside
}

/// All alternatives of a shape.
fn flatten<'s>(shape: &'s Shape, into: &mut Vec<&'s Shape>) {
    match shape {
        Shape::Either(shapes) => shapes.iter().for_each(|s| flatten(s, into)),
        shape => into.push(shape),
    }
}
