//! Ground-motion records as inputs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::check::{Checked, unknown_name};
use super::error::{SceneError, SceneErrorKind};
use super::inputs::Reader;
use super::shape::{Key, Object, Quantity, Shape};
use super::source::{Source, Span};
use super::wording::listing;
use crate::formula::unit::{QuantityError, convert};
use crate::input::{Interpolation, Outside, Table};
use crate::model::Bounds;
use crate::motion::{
    self, Baseline, Channel, Fault, Given, Motion, Note, Refusal, Size, Treatment, Unit,
};

/// Damping of a spectral ordinate that states none.
const DAMPING: f64 = 0.05;
/// Order of a filter that states none.
const ORDER: f64 = 4.0;

/// Records by their files and by what was said of them: unit and bits of the step.
type Known = BTreeMap<(PathBuf, Option<String>, Option<u64>), Arc<Record>>;

/// Records that were read: many scenes have the same.
#[derive(Default)]
pub(crate) struct Records(Mutex<Known>);

/// A record and its text.
pub(crate) struct Record {
    pub motion: Motion,
    source: Arc<Source>,
}

impl Record {
    /// Reads a record from the contents of its file; `path` names it in errors.
    pub fn read(bytes: &[u8], path: &Path, given: &Given) -> Result<Record, SceneError> {
        let name = path.display().to_string();
        let error = |text: &str, fault: Fault| {
            let (name, text) = (name.clone(), text.to_owned());
            let source = Arc::new(Source { name, text });
            let place = Span::new(&source, fault.range);
            let message = fault.message;
            SceneError::new(SceneErrorKind::Record { message }, &place).help(fault.help)
        };
        let text =
            motion::decode(bytes).map_err(|fault| error(&String::from_utf8_lossy(bytes), fault))?;
        let motion = motion::read(&text, given).map_err(|fault| error(&text, fault))?;
        let source = Arc::new(Source {
            name: name.clone(),
            text,
        });
        Ok(Record { motion, source })
    }

    /// The error that a note is where nobody may overlook it.
    pub fn doubt(&self, note: &Note) -> SceneError {
        let message = note.message.clone();
        let place = Span::new(&self.source, note.range.clone());
        SceneError::new(SceneErrorKind::Record { message }, &place)
    }

    /// Line of a note, from 1.
    #[cfg(feature = "cli")]
    pub fn line(&self, note: &Note) -> usize {
        Span::new(&self.source, note.range.clone()).position().line
    }

    /// The channel with this name, or else with this number from 1; the only one for `None`. An error
    /// is a sentence and the names.
    pub fn channel(&self, wanted: Option<&str>) -> Result<&Channel, (String, Vec<String>)> {
        let channels = &self.motion.channels;
        let names = || channels.iter().map(|c| c.name.clone()).collect();
        match wanted {
            None if channels.len() == 1 => Ok(&channels[0]),
            None => Err((
                format!("the record has {} channels", channels.len()),
                names(),
            )),
            Some(name) => {
                let by_name = channels.iter().find(|c| c.name == name);
                let number = || name.parse::<usize>().ok()?.checked_sub(1);
                by_name
                    .or_else(|| channels.get(number()?))
                    .ok_or_else(|| (format!("the record has no channel `{name}`"), names()))
            }
        }
    }
}

/// The keys of an input that is a record.
pub(crate) fn shape() -> Object {
    let acceleration = || Quantity::positive("m/s^2");
    // Above, an oscillator hardly swings; from 1 on it does not.
    let damping = Bounds {
        maximum: 0.99,
        ..Bounds::at_least(0.0)
    };
    let damping = Quantity::within(damping, "1");
    let ordinate = Object::new(
        "key of a spectral ordinate",
        vec![
            Key::new("T", "period", Quantity::positive("s")).required(),
            Key::new("damping", "damping ratio", damping).default(DAMPING),
            Key::new("value", "pseudo-acceleration", acceleration()).required(),
        ],
    );
    let filter = Object::new(
        "key of a filter",
        vec![
            Key::new("frequency", "corner frequency", Quantity::positive("Hz")).required(),
            Key::new(
                "order",
                "order of each of both passes",
                Shape::Values([2.0, 4.0, 6.0, 8.0].into()),
            )
            .default(ORDER),
        ],
    );
    let baseline = Object::new(
        "key of a baseline correction",
        vec![
            Key::new(
                "polynomial",
                "degree of the polynomial that is subtracted: its velocity is nearest to that of the record",
                Shape::Values([0.0, 1.0, 2.0, 3.0, 4.0, 5.0].into()),
            ),
            Key::new(
                "high_pass",
                "Butterworth filter, forwards and backwards; the record grows by 1.5 order/frequency at both ends",
                filter,
            ),
        ],
    )
    .exactly_one(["polynomial", "high_pass"]);
    let length = || Shape::from(Quantity::at_least(0.0, "s"));
    let taper = Shape::Either(vec![
        length(),
        Shape::Tuple("[at the start, at the end]", vec![length(), length()]),
    ]);
    let flag = |name, meaning| Key::new(name, meaning, Shape::Flag).default(false);
    Object::new(
        "key beside a record",
        vec![
            Key::new(
                "record",
                "file of a ground-motion record; relative to the scene",
                Shape::Text,
            )
            .required(),
            Key::new(
                "channel",
                "name or number of the channel",
                Shape::Either(vec![Shape::Text, Shape::Count]),
            ),
            Key::new(
                "unit",
                "unit of the values, if the file states none",
                Shape::Text,
            ),
            Key::new(
                "dt",
                "step, if the file states none",
                Quantity::positive("s"),
            ),
            Key::new("from", "start of the part that is used", Quantity::any("s")),
            Key::new("to", "end of the part that is used", Quantity::any("s")),
            flag("remove_mean", "whether the mean is subtracted"),
            Key::new("baseline", "correction of the baseline", baseline),
            Key::new(
                "taper",
                "time over which the record rises and falls at its ends",
                taper,
            ),
            Key::new("scale", "factor", Quantity::any("1")).default(1.0),
            Key::new(
                "pga",
                "the peak acceleration that the record gets",
                acceleration(),
            ),
            Key::new("Sa", "the spectral ordinate that the record gets", ordinate),
            Key::new(
                "delay",
                "time of its first sample",
                Quantity::at_least(0.0, "s"),
            )
            .default(0.0),
            Key::new(
                "interpolation",
                "straight lines, a twice differentiable spline, or the function without frequencies above half the rate of the samples",
                Shape::Choice("interpolation", vec!["linear", "cubic", "band_limited"]),
            )
            .default("linear"),
            flag(
                "despite_doubts",
                "whether a record is used whose file contradicts itself",
            ),
        ],
    )
    .at_most_one(["scale", "pga"])
    .at_most_one(["scale", "Sa"])
    .at_most_one(["pga", "Sa"])
}

/// The function of an input that a record describes. `unit` is that of the input.
pub(crate) fn table(described: &Checked, unit: &str, reader: &Reader) -> Result<Table, SceneError> {
    let file = must(described, "record");
    // The factor from m/s² to the unit of the input.
    let factor = match convert("1 m/s^2", unit) {
        Ok(factor) => factor,
        Err(QuantityError::WrongUnit(given)) => {
            let expected = unit.to_owned();
            let kind = SceneErrorKind::WrongUnit { given, expected };
            return Err(SceneError::new(kind, &file.place).help("a record is of accelerations"));
        }
        // The unit of a model is one that can be read.
        Err(_) => 1.0,
    };
    let record = read(described, file, reader)?;
    if !described.get("despite_doubts").is_some_and(Checked::flag)
        && let Some(note) = record.motion.notes.iter().find(|note| note.doubt)
    {
        return Err(record.doubt(note).help(
            "get the record anew, or use it as it is with \"despite_doubts\": true beside the record",
        ));
    }
    let channel = channel(described, file, &record)?;
    let samples = treatment(described)
        .apply(&channel.samples)
        .map_err(|refusal| refused(described, refusal))?;
    let (samples, interpolation) = match described.get("interpolation").map(Checked::text) {
        Some("band_limited") => {
            let finer = samples.band_limited();
            let finer = finer.map_err(|refusal| refused(described, refusal))?;
            (finer, Interpolation::Cubic)
        }
        Some("cubic") => (samples, Interpolation::Cubic),
        _ => (samples, Interpolation::Linear),
    };
    let values: Vec<f64> = samples.values.iter().map(|a| factor * a).collect();
    Table::new(&samples.all_times(), &values, interpolation, Outside::Zero).map_err(|error| {
        SceneError::new(SceneErrorKind::Table(error), &file.place)
            .help("make the record smaller, or leave out its treatment")
    })
}

/// A key that the shape demands.
fn must<'a>(described: &'a Checked, key: &str) -> &'a Checked {
    let Some(value) = described.get(key) else {
        unreachable!("checked to have `{key}`: {described:?}")
    };
    value
}

fn read(described: &Checked, file: &Checked, reader: &Reader) -> Result<Arc<Record>, SceneError> {
    let unit = match described.get("unit") {
        None => None,
        Some(name) => match Unit::parse(name.text()) {
            Some(unit) => Some(unit),
            None => {
                let known: Vec<_> = Unit::names().collect();
                return Err(unknown_name(
                    "unit of a record",
                    name.text(),
                    &known,
                    &name.place,
                ));
            }
        },
    };
    let dt = described.get("dt").map(Checked::number);
    let path = reader.folder.join(file.text());
    let said = described.get("unit").map(|unit| unit.text().to_owned());
    let key = (path.clone(), said, dt.map(f64::to_bits));
    let known = || {
        let records = reader.records?;
        Some(records.0.lock().unwrap_or_else(PoisonError::into_inner))
    };
    if let Some(record) = known().and_then(|known| known.get(&key).cloned()) {
        return Ok(record);
    }
    let bytes = reader.files.read(&path).map_err(|error| {
        let reason = error.to_string();
        let kind = SceneErrorKind::Unreadable {
            path: path.clone(),
            reason,
        };
        SceneError::new(kind, &file.place).help("the path is relative to the folder of the scene")
    })?;
    let record = Arc::new(Record::read(&bytes, &path, &Given { unit, dt })?);
    if let Some(mut known) = known() {
        known.insert(key, record.clone());
    }
    Ok(record)
}

fn channel<'a>(
    described: &Checked,
    file: &Checked,
    record: &'a Record,
) -> Result<&'a Channel, SceneError> {
    let wanted = described.get("channel");
    let name = wanted.map(|wanted| match wanted.as_text() {
        Some(name) => name.to_owned(),
        None => wanted.number().to_string(),
    });
    record.channel(name.as_deref()).map_err(|(message, names)| {
        let place = &wanted.unwrap_or(file).place;
        let known = listing(names.iter().map(String::as_str));
        let help = format!("give `channel`, by name or by number from 1: {known}");
        SceneError::new(SceneErrorKind::Record { message }, place).help(help)
    })
}

fn treatment(described: &Checked) -> Treatment {
    let number = |key: &str| described.get(key).map(Checked::number);
    let baseline = |key: &str| described.get("baseline").and_then(|b| b.get(key));
    let taper = match described.get("taper") {
        None => [0.0; 2],
        Some(taper) if taper.is_list() => [0, 1].map(|i| taper.list()[i].number()),
        Some(taper) => [taper.number(); 2],
    };
    let size = match (number("pga"), described.get("Sa")) {
        (Some(pga), _) => Size::Pga(pga),
        (None, Some(sa)) => Size::Sa {
            period: must(sa, "T").number(),
            damping: sa.get("damping").map_or(DAMPING, Checked::number),
            value: must(sa, "value").number(),
        },
        (None, None) => Size::Factor(number("scale").unwrap_or(1.0)),
    };
    Treatment {
        from: number("from"),
        to: number("to"),
        remove_mean: described.get("remove_mean").is_some_and(Checked::flag),
        baseline: Baseline {
            polynomial: baseline("polynomial").map(|degree| degree.number() as usize),
            high_pass: baseline("high_pass").map(|filter| {
                let order = filter.get("order").map_or(ORDER, Checked::number);
                (must(filter, "frequency").number(), order as usize)
            }),
        },
        taper,
        size,
        delay: number("delay").unwrap_or(0.0),
    }
}

/// A treatment that cannot be done, at the key that asks for it.
fn refused(described: &Checked, refusal: Refusal) -> SceneError {
    let place = &described.get(refusal.step).unwrap_or(described).place;
    let message = refusal.message;
    SceneError::new(SceneErrorKind::Record { message }, place)
        .help("`dalembert motion FILE` shows what is in the record")
}
