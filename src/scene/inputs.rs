//! The inputs of a scene as functions of time.

use std::f64::consts::TAU;
use std::path::Path;

use super::check::{Checked, Datum};
use super::error::{Errors, SceneError, SceneErrorKind};
use super::files::Files;
use super::format;
use super::interpret::{options, under};
use super::record::{self, Records};
use super::source::Span;
use super::table;
use super::wording::shown;
use crate::input::{Function, Interpolation, Outside, Signals, Sine, Table, TableError};
use crate::model::{Model, Variant};

/// Where tables are read from.
pub(crate) struct Reader<'a> {
    pub files: &'a dyn Files,
    /// The folder of the scene.
    pub folder: &'a Path,
    /// Records that were read before, where many scenes have the same.
    pub records: Option<&'a Records>,
}

/// The functions of all inputs; inputs that the scene does not name are zero.
pub(crate) fn signals(
    model: &Model,
    scene: &Checked,
    reader: &Reader,
    errors: &mut Errors,
) -> Option<Signals> {
    let inputs = scene.get("inputs");
    let functions: Vec<Option<Function>> = model
        .inputs
        .iter()
        .map(|input| match inputs.and_then(|o| o.get(input.name)) {
            Some(described) => function(described, input.unit, reader, errors),
            None => Some(Function::zero()),
        })
        .collect();
    let mut signals = Signals::new(&model.inputs, functions.into_iter().collect::<Option<_>>()?);
    for motion in model.motions.iter().filter(|motion| !motion.is_ground) {
        let said = |key: &str| Some(scene.get("initial")?.get(key)?.number());
        let rate = format::rate_of(motion.name);
        signals.start(motion.input, said(motion.name), said(&rate));
    }
    Some(signals)
}

/// Refuses what is given for inputs that the chosen options do not know.
pub(crate) fn refuse_barred(
    model: &Model,
    variant: &Variant,
    scene: &Checked,
    errors: &mut Errors,
) {
    let given = |name: &str| scene.get("inputs").and_then(|inputs| inputs.get(name));
    for &i in &variant.barred {
        let input = model.inputs[i].name;
        let Some(described) = given(input).filter(|x| !matches!(x.datum, Datum::Null)) else {
            continue;
        };
        let under = under(model, variant);
        let kind = SceneErrorKind::BarredInput { input, under };
        let allowed = model.variants.iter().filter(|v| !v.barred.contains(&i));
        let allowed = allowed.map(|v| options(model, v)).collect::<Vec<_>>();
        let help = format!("leave it out, or choose {}", allowed.join("; or "));
        errors.push(SceneError::new(kind, &described.place).help(help));
    }
}

fn function(input: &Checked, unit: &str, reader: &Reader, errors: &mut Errors) -> Option<Function> {
    if matches!(input.datum, Datum::Null) {
        return Some(Function::zero());
    }
    if let Some(terms) = input.get("sum") {
        let terms: Vec<_> = terms
            .list()
            .iter()
            .map(|t| function(t, unit, reader, errors))
            .collect();
        return terms
            .into_iter()
            .collect::<Option<Vec<_>>>()
            .map(Function::sum);
    }
    if let Some(constant) = input.get("constant") {
        return Some(Function::constant(constant.number()));
    }
    if let Some(described) = input.get("sine") {
        return errors.note(sine(described)).map(Function::from);
    }
    if let Some(described) = input.get("table") {
        return errors
            .note(table_from_file(described, reader))
            .map(Function::from);
    }
    if input.get("record").is_some() {
        return errors
            .note(record::table(input, unit, reader))
            .map(Function::from);
    }
    let Some(rows) = input.get("knots") else {
        unreachable!("checked to be an input: {input:?}")
    };
    errors
        .note(table_from_knots(rows, input))
        .map(Function::from)
}

fn sine(sine: &Checked) -> Result<Sine, SceneError> {
    let number = |key: &str| sine.get(key).map(Checked::number);
    let phase = number("phase").unwrap_or(0.0);
    let start = number("start").unwrap_or(0.0);
    let amplitude = number("amplitude").unwrap_or(0.0);
    let frequency = sine.get("frequency");
    let Some(given) = frequency.or(sine.get("angular_frequency")) else {
        unreachable!("checked to have a frequency: {sine:?}")
    };
    let omega = if frequency.is_some() {
        TAU * given.number()
    } else {
        given.number()
    };
    // The rate and the displacement of the ground have these amplitudes.
    if !(amplitude * omega).is_finite() || !(amplitude / (omega * omega)).is_finite() {
        let range = "such that its derivative and its antiderivatives are finite".to_owned();
        let kind = SceneErrorKind::OutOfRange {
            value: given.number(),
            range,
        };
        return Err(SceneError::new(kind, &given.place));
    }
    let end = match (sine.get("end"), sine.get("cycles")) {
        (Some(end), _) => Some((end.number(), end)),
        (None, Some(cycles)) => Some((start + cycles.number() * (TAU / omega), cycles)),
        (None, None) => None,
    };
    let function = Sine::new(amplitude, omega, phase);
    match end {
        None => Ok(function.between(start, f64::INFINITY)),
        Some((end, _)) if end > start => Ok(function.between(start, end)),
        Some((end, at)) => {
            let kind = SceneErrorKind::OutOfRange {
                value: end,
                range: format!("> {} s, its start", shown(start)),
            };
            Err(SceneError::new(kind, &at.place))
        }
    }
}

fn table_from_file(described: &Checked, reader: &Reader) -> Result<Table, SceneError> {
    let Some(file) = described.get("file") else {
        unreachable!("checked to have a file: {described:?}")
    };
    let path = reader.folder.join(file.text());
    let bytes = reader.files.read(&path).map_err(|error| {
        let kind = SceneErrorKind::Unreadable {
            path: path.clone(),
            reason: error.to_string(),
        };
        SceneError::new(kind, &file.place).help("the path is relative to the folder of the scene")
    })?;
    let rows = table::read(&super::decode(&bytes, &path)?)?;
    let scale = described.get("scale").map_or(1.0, Checked::number);
    let values: Vec<f64> = rows.values.iter().map(|y| scale * y).collect();
    let (interpolation, outside) = between_rows(described);
    Table::new(&rows.times, &values, interpolation, outside)
        .map_err(|error| table_error(error, |row, column| rows.place(row, column)))
}

fn table_from_knots(rows: &Checked, input: &Checked) -> Result<Table, SceneError> {
    let column = |i: usize| {
        rows.list()
            .iter()
            .map(|row| row.list()[i].number())
            .collect::<Vec<_>>()
    };
    let (interpolation, outside) = between_rows(input);
    let place = |row: usize, column: usize| match rows.list().get(row) {
        Some(row) => row.list()[column].place.clone(),
        None => rows.place.clone(),
    };
    Table::new(&column(0), &column(1), interpolation, outside)
        .map_err(|error| table_error(error, place))
}

fn between_rows(described: &Checked) -> (Interpolation, Outside) {
    let name = |key: &str| described.get(key).map(Checked::text);
    let interpolation = match name("interpolation") {
        Some("cubic") => Interpolation::Cubic,
        Some("previous") => Interpolation::Previous,
        _ => Interpolation::Linear,
    };
    let outside = if name("outside") == Some("hold") {
        Outside::Hold
    } else {
        Outside::Zero
    };
    (interpolation, outside)
}

/// The error of a table, at the row and column that is at fault.
fn table_error(error: TableError, place: impl Fn(usize, usize) -> Span) -> SceneError {
    const TIME: usize = 0;
    const VALUE: usize = 1;
    let (at, help) = match error {
        TableError::TooFewRows { found, .. } => {
            (place(found, TIME), "each row is a time (s) and a value")
        }
        TableError::UnsortedTime { row, .. } => {
            (place(row, TIME), "sort the rows by time, each time once")
        }
        // Rows are finite when they are read, but a scaled value may not be.
        TableError::NotFinite { row } => (place(row, VALUE), "use a smaller `scale`"),
        TableError::TooSteep { row } => (
            place(row, TIME),
            "the times here are too close to each other",
        ),
        TableError::LastValueUnused { row, .. } => (
            place(row, VALUE),
            "end the table with a value of 0, or keep the last value with \"outside\": \"hold\"",
        ),
    };
    SceneError::new(SceneErrorKind::Table(error), &at).help(help)
}
