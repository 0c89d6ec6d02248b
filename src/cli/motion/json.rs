//! Motions as JSON.

use serde_json::{Value, json};

use super::{File, Report, Told};

impl Report<'_> {
    /// As `--help` describes it.
    pub fn json(&self) -> Value {
        let mut files: Vec<Value> = self.files.iter().map(|file| self.file(file)).collect();
        match files.len() {
            1 => files.remove(0),
            _ => Value::Array(files),
        }
    }

    fn file(&self, file: &File) -> Value {
        let motion = &file.record.motion;
        let spectra: Vec<Value> = file
            .channels
            .iter()
            .map(|told| self.spectrum(told))
            .collect();
        let notes = motion.notes.iter().map(|note| {
            json!({ "line": file.record.line(note), "message": note.message, "doubt": note.doubt })
        });
        json!({
            "file": file.path.display().to_string(),
            "format": motion.format.name(),
            "details": motion.details.iter().map(|(key, value)| ((*key).to_owned(), json!(value)))
                .collect::<serde_json::Map<_, _>>(),
            "channels": file.channels.iter().map(channel).collect::<Vec<_>>(),
            "spectrum": spectra[0],
            "spectra": spectra,
            "notes": notes.collect::<Vec<_>>(),
        })
    }

    fn spectrum(&self, told: &Told) -> Value {
        json!({
            "channel": told.channel.name,
            "damping": self.damping,
            "periods": self.periods,
            "psa_samples": told.spectrum.iter().map(|o| o.samples).collect::<Vec<_>>(),
            "psa": told.spectrum.iter().map(|o| o.peak).collect::<Vec<_>>(),
        })
    }
}

fn channel(told: &Told) -> Value {
    let (m, samples) = (&told.measures, &told.channel.samples);
    json!({
        "name": told.channel.name,
        "unit": told.channel.unit.name,
        "dt": samples.dt(),
        "points": samples.values.len(),
        "duration": told.duration(),
        "pga": { "value": m.pga.value.abs(), "signed": m.pga.value, "t": m.pga.t },
        "pgv": m.pgv.value.abs(),
        "pgd": m.pgd.value.abs(),
        "arias": m.arias,
        "significant_duration": m.significant_duration(),
        "mean": m.mean,
        "end_velocity": m.end[0],
        "end_displacement": m.end[1],
    })
}
