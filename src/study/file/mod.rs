//! Study files: JSON in, a checked [`Study`] or errors with line and column out.

mod analysis;
mod cases;
mod format;
mod measures;
mod print;
mod random;

use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::design::{Design, Factor, Values};
use super::measure::{Failure, Measure};
use super::procedure::Procedure;
use crate::hybrid::Problem;
use crate::model::Models;
use crate::run::hexadecimal;
use crate::scene::check::{Checked, check};
use crate::scene::error::{Errors, SceneError, SceneErrorKind, SceneErrors};
use crate::scene::shape::{Quantity, Shape};
use crate::scene::source::Span;
use crate::scene::template::{Change, Template};
use crate::scene::tree::{self, Node, Value};
use crate::scene::{Disk, Files, decode, set};
use format::Quantities;

/// A study that was checked: which cases it has, what is run for each, what is measured.
pub(crate) struct Study {
    pub title: Option<String>,
    /// The scene, as a path that the caller can open.
    pub scene: PathBuf,
    pub template: Template,
    pub design: Design,
    pub procedure: Procedure,
    pub measures: Vec<Measure>,
    pub failure: Option<Failure>,
    pub second_runs: SecondRuns,
    /// The factor for each value of which a fragility is fitted.
    pub group: Option<usize>,
    /// The study as it is run, as JSON.
    pub text: String,
    /// A digest of all that decides its results: model, scene, design, version of the engine.
    pub key: String,
}

/// Which runs are made again at a tighter tolerance, to tell those that are not decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SecondRuns {
    /// Those near what decides.
    Near,
    All,
    None,
}

/// What paths of a study lead to.
struct Names<'t> {
    /// Every path with the span that names it first, and the names on it.
    paths: Vec<(Span, Vec<Span>)>,
    places: Quantities,
    template: &'t Template,
}

impl Study {
    /// Reads a study file with changes to it (`path=value`), and the scene that it names.
    ///
    /// # Errors
    /// All that is wrong with either, at its place.
    ///
    /// `room` gets the number of cases before they are drawn, and says what there is no room for.
    pub fn load(
        path: &Path,
        overrides: &[String],
        models: &Models,
        room: &Room,
    ) -> Result<Study, SceneErrors> {
        let bytes = Disk
            .read(path)
            .map_err(|e| SceneError::unreadable(path.to_owned(), &e))?;
        let mut root = tree::parse(&decode(&bytes, path)?)?;
        for argument in overrides {
            set::apply(&mut root, argument)?;
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        study(root, folder, models, room)
    }
}

impl Study {
    /// Number of cases.
    pub fn cases(&self) -> u64 {
        self.design
            .cases()
            .expect("it was checked when the study was read")
    }
}

/// Says what there is no room for, of a study with so many cases.
pub(crate) type Room<'r> = dyn Fn(f64) -> Result<(), String> + 'r;

/// JSON Schema of study files.
pub fn schema() -> serde_json::Value {
    let shape = format::study(&Quantities::default());
    crate::scene::schema_of(&shape, "dalembert study")
}

fn study(root: Node, folder: &Path, models: &Models, room: &Room) -> Result<Study, SceneErrors> {
    let mut errors = Errors::default();
    let Some(Value::Text(scene)) = root.get("scene").map(|node| &node.value) else {
        check(
            &root,
            &format::study(&Quantities::default()).into(),
            &mut errors,
        );
        errors.check()?;
        unreachable!("a study without a scene passed its check: {root:?}")
    };
    let scene = folder.join(scene);
    let template = Template::load(&scene, models).map_err(|errors| named_by(errors, &root))?;
    let table = cases::from_file(&root, folder)?;
    let names = Names::new(&root, table.as_ref(), &template);
    names.check()?;
    let shape = Shape::Object(format::study(&names.places));
    let checked = check(&root, &shape, &mut errors);
    errors.check()?;
    let Some(checked) = checked else {
        unreachable!("{root:?} failed its check without an error")
    };
    let design = design(&checked, table.as_ref(), &names, room, &mut errors);
    errors.check()?;
    let Some(mut design) = design else {
        unreachable!("a design is absent without an error")
    };
    let procedure = analysis::procedure(&checked, &names, &mut design)?;
    let Some(cases) = design.cases() else {
        let message = "the study has more than 2^53 cases".to_owned();
        let place = checked.get("vary").unwrap_or(&checked);
        let kind = SceneErrorKind::State { message };
        return Err(SceneError::new(kind, &place.place).into());
    };
    debug_assert!(cases > 0);
    let first = validate(&template, &design, &procedure)?;
    let mut measures = measures::measures(&checked, &first, &template)?;
    let failure = measures::failure(&checked, &first, &template, &mut measures)?;
    let procedure = procedure.measured(&checked, &measures, failure.as_ref())?;
    let group = analysis::group(&checked, &design)?;
    let second_runs = match checked.get("second_runs").map(Checked::text) {
        Some("all") => SecondRuns::All,
        Some("none") => SecondRuns::None,
        _ => SecondRuns::Near,
    };
    let text = print::pretty(&root);
    let key = key(&template, &root);
    Ok(Study {
        title: checked.get("title").map(|title| title.text().to_owned()),
        scene,
        design,
        procedure,
        measures,
        failure,
        second_runs,
        group,
        text,
        key,
        template,
    })
}

/// A scene that cannot be read is an error of the study that names it.
fn named_by(errors: SceneErrors, root: &Node) -> SceneErrors {
    let Some(node) = root.get("scene") else {
        return errors;
    };
    match errors.iter().next().map(SceneError::kind) {
        Some(kind @ SceneErrorKind::Unreadable { .. }) => {
            let error = SceneError::new(kind.clone(), &node.place());
            error
                .help("the path is relative to the folder of the study")
                .into()
        }
        _ => errors,
    }
}

/// A digest of what decides the results: the version of the program, the model, the study without its title, the scene and
/// the files that it reads.
fn key(template: &Template, root: &Node) -> String {
    let mut hash = Sha256::new();
    let mut put = |bytes: &[u8]| {
        hash.update((bytes.len() as u64).to_le_bytes());
        hash.update(bytes);
    };
    put(env!("CARGO_PKG_VERSION").as_bytes());
    put(template.model.digest.as_bytes());
    let mut root = root.clone();
    if let Value::Object(entries) = &mut root.value {
        entries.retain(|entry| entry.key != "title" && entry.key != "$schema");
    }
    put(print::pretty(&root).as_bytes());
    for (name, contents) in template.contents() {
        put(name.as_bytes());
        put(&contents);
    }
    hexadecimal(&hash.finalize())
}

/// Every value of every factor must make a scene, in a case that has it: of numbers the smallest and the largest, of anything
/// else each. Gives the scene of the first case.
fn validate(
    template: &Template,
    design: &Design,
    procedure: &Procedure,
) -> Result<Problem, SceneErrors> {
    let scene = |case: u64, at: Option<(&[Span], Node)>| {
        let mut changes = design.changes(case);
        changes.extend(at.map(|(path, value)| Change { path, value }));
        template.scene(&changes)
    };
    let problem = scene(0, procedure.first())?.problem;
    for (b, block) in design.blocks.iter().enumerate() {
        for factor in &block.factors {
            for row in extremes(factor)? {
                scene(design.case_with(b, row), procedure.first())?;
            }
        }
    }
    if let Some(last) = procedure.extremes() {
        scene(0, Some(last))?;
    }
    Ok(problem)
}

/// Which values of a factor show whether all of them are admissible.
fn extremes(factor: &Factor) -> Result<Vec<usize>, SceneError> {
    Ok(match &factor.values {
        Values::Numbers(numbers, _) => {
            if let Some(i) = numbers.iter().position(|x| !x.is_finite()) {
                let message = format!("value {i} of `{}` is not finite", factor.path);
                return Err(factor.error(message));
            }
            let order = |a: &usize, b: &usize| numbers[*a].total_cmp(&numbers[*b]);
            let all = 0..numbers.len();
            let ends = [all.clone().min_by(order), all.max_by(order)];
            ends.into_iter().flatten().collect()
        }
        Values::Others(others) => {
            let mut known = std::collections::BTreeSet::new();
            let new = |i: &usize| known.insert(&others[*i].0);
            (0..others.len()).filter(new).collect()
        }
    })
}

impl Factor {
    /// An error about its values as a whole.
    fn error(&self, message: String) -> SceneError {
        let place = match &self.values {
            Values::Numbers(_, places) => places[0].clone(),
            Values::Others(others) => others[0].1.place(),
        };
        SceneError::new(SceneErrorKind::State { message }, &place)
    }
}

impl<'t> Names<'t> {
    /// All paths that a study names.
    fn new(root: &Node, table: Option<&cases::Table>, template: &'t Template) -> Self {
        let mut spans: Vec<Span> = Vec::new();
        let mut keys = |node: Option<&Node>| {
            if let Some(Value::Object(entries)) = node.map(|node| &node.value) {
                // In quotes.
                spans.extend(entries.iter().map(|e| inside(&e.key_span)));
            }
        };
        keys(root.get("vary"));
        keys(
            root.get("random")
                .and_then(|random| random.get("variables")),
        );
        if let Some(Value::List(rows)) = root.get("cases").map(|node| &node.value) {
            rows.iter().for_each(|row| keys(Some(row)));
        }
        if let Some(table) = table {
            spans.extend(table.columns.iter().cloned());
        }
        let mut intensity = String::new();
        for (kind, key) in analysis::PATHS {
            if let Some(node) = root.get(kind).and_then(|node| node.get(key))
                && let Value::Text(text) = &node.value
            {
                spans.push(inside(&node.span));
                intensity = text.clone();
            }
        }
        let mut paths: Vec<(Span, Vec<Span>)> = Vec::new();
        let mut places = Quantities {
            intensity,
            ..Quantities::default()
        };
        for span in spans {
            if paths.iter().any(|(known, _)| known.text() == span.text()) {
                continue;
            }
            let names = set::segments(&span);
            let quantity = match template.shape_at(&names) {
                Some(Shape::Quantity(quantity)) => Some(quantity.clone()),
                _ => None,
            };
            places.known.push((span.text().to_owned(), quantity));
            paths.push((span, names));
        }
        Names {
            paths,
            places,
            template,
        }
    }

    /// Each path must lead somewhere in a scene of the model.
    fn check(&self) -> Result<(), SceneErrors> {
        for (span, names) in &self.paths {
            if names.first().is_some_and(|name| name.text() == "model") {
                let message = "a study is about one model".to_owned();
                let error = SceneError::new(SceneErrorKind::State { message }, span);
                return Err(error.help("make a study for each model").into());
            }
            if let Some(empty) = names.iter().find(|name| name.text().is_empty()) {
                let message = "a name is missing in the path".to_owned();
                return Err(SceneError::new(SceneErrorKind::Override { message }, empty).into());
            }
            if self.template.shape_at(names).is_none() {
                let nothing = Node {
                    span: span.clone(),
                    value: Value::Null,
                };
                let path = names;
                let change = Change {
                    path,
                    value: nothing,
                };
                self.template.scene(&[change])?;
                let message = format!("`{}` leads to nothing in a scene", span.text());
                return Err(SceneError::new(SceneErrorKind::Override { message }, span).into());
            }
        }
        Ok(())
    }

    /// A factor at a path, without values yet.
    fn factor(&self, path: &str) -> Factor {
        let found = self.paths.iter().find(|(span, _)| span.text() == path);
        let Some((span, names)) = found else {
            unreachable!("all paths were collected: {path}")
        };
        Factor {
            path: path.to_owned(),
            names: names.clone(),
            unit: self.unit(path),
            values: Values::Numbers(Vec::new(), vec![span.clone()]),
        }
    }

    /// Unit of the numbers at a path.
    fn unit(&self, path: &str) -> Option<String> {
        self.places.quantity(path).map(|q| q.unit.clone())
    }

    fn quantity(&self, path: &str) -> Option<&Quantity> {
        self.places.quantity(path)
    }
}

/// What stands between the quotes of a text. A text with escapes stays as it is written: no path has any.
fn inside(span: &Span) -> Span {
    let text = span.text();
    match text.len() >= 2 && text.starts_with('"') && text.ends_with('"') {
        true => span.part(1..text.len() - 1),
        false => span.clone(),
    }
}

/// A number that the shape demands.
fn number(object: &Checked, key: &str) -> f64 {
    match object.get(key) {
        Some(value) => value.number(),
        None => unreachable!("checked to have `{key}`: {object:?}"),
    }
}

/// A number in a unit that is known only now.
fn bound(value: &Checked, unit: &str) -> Result<f64, SceneErrors> {
    let mut errors = Errors::default();
    let checked = check(value.any(), &Quantity::any(unit).into(), &mut errors);
    errors.check()?;
    match checked {
        Some(checked) => Ok(checked.number()),
        None => unreachable!("a number is absent without an error"),
    }
}

/// A factor with the values of a list: numbers where all of them are.
fn factor_of(path: &str, values: &[Checked], names: &Names) -> Factor {
    let plain = |value: &Checked| match &value.datum {
        crate::scene::check::Datum::Any(node) => match &node.value {
            Value::Number(text) => text.parse().ok(),
            _ => None,
        },
        _ => value.as_number(),
    };
    let numbers: Option<Vec<f64>> = values.iter().map(plain).collect();
    let values = match numbers {
        Some(numbers) => {
            let places = values.iter().map(|value| value.place.clone());
            Values::Numbers(numbers, places.collect())
        }
        None => Values::Others(
            values
                .iter()
                .map(|value| (print::label(value.any()), value.any().clone()))
                .collect(),
        ),
    };
    Factor {
        values,
        ..names.factor(path)
    }
}

/// All that varies.
fn design(
    checked: &Checked,
    table: Option<&cases::Table>,
    names: &Names,
    room: &Room,
    errors: &mut Errors,
) -> Option<Design> {
    let mut blocks = Vec::new();
    match (table, checked.get("cases")) {
        (Some(table), _) => blocks.push(errors.note(table.block(names))?),
        (None, Some(rows)) => blocks.push(errors.note(cases::block(rows, names))?),
        (None, None) => {}
    }
    for (path, described) in checked.get("vary").map_or(&[][..], Checked::entries) {
        blocks.push(errors.note(cases::levels(path, described, names))?);
    }
    let so_far: f64 = blocks.iter().map(|block| block.count as f64).product();
    let random = checked.get("random");
    let samples = random.map_or(1.0, |random| number(random, "count"));
    if let Err(message) = room(so_far * samples) {
        let place = random.and_then(|random| random.get("count"));
        let place = &place.or(checked.get("vary")).unwrap_or(checked).place;
        let error = SceneError::new(SceneErrorKind::State { message }, place);
        errors.push(
            error.help("make fewer cases, or each part of them by --shard where there is room"),
        );
        return None;
    }
    if let Some(random) = random {
        blocks.push(random::block(random, names, errors)?);
    }
    let design = Design { blocks };
    let mut known: Vec<&str> = Vec::new();
    for factor in design.factors() {
        if known.contains(&factor.path.as_str()) {
            let message = format!("`{}` varies twice", factor.path);
            errors.push(factor.error(message).help("name it in one place"));
        }
        known.push(&factor.path);
    }
    Some(design)
}
