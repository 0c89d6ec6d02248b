//! What the terminal shows of a finished study.

use std::fmt::{self, Display, Formatter};
use std::path::Path;

use serde_json::Value;

use crate::record::rounded;
use crate::study::Found;

pub struct Report<'f> {
    pub found: &'f Found,
    pub out: &'f Path,
}

/// A number with six digits, or what there is in its place.
fn digits(value: &Value) -> String {
    match value.as_f64() {
        Some(x) => rounded(x, 6),
        None => "–".to_owned(),
    }
}

fn interval(limits: &Value) -> String {
    format!("{} to {}", digits(&limits[0]), digits(&limits[1]))
}

impl Display for Report<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let summary = &self.found.summary;
        let runs = &summary["runs"];
        writeln!(
            f,
            "{}: {} cases, {} runs: {} ok, {} stopped early, {} refused",
            summary["kind"].as_str().unwrap_or_default(),
            summary["cases"],
            runs["total"],
            runs["ok"],
            runs["stopped"],
            runs["refused"],
        )?;
        if let Some(reasons) = runs["reasons"].as_object() {
            for (reason, count) in reasons {
                writeln!(f, "  {count} × {reason}")?;
            }
        }
        if let Some(failures) = summary["failures"].as_object() {
            writeln!(
                f,
                "{} failed, {} did not, {} do not tell; {} undecided at this tolerance",
                failures["failed"], failures["survived"], failures["untold"], failures["undecided"],
            )?;
        }
        if let Some(capacities) = summary["capacities"].as_object() {
            let counted = &capacities["counted"];
            writeln!(
                f,
                "capacities: {} known, {} censored, {} do not tell; 16 % {}, 50 % {}, 84 % {}",
                capacities["known"],
                capacities["censored"],
                capacities["untold"],
                digits(&counted["p16"]),
                digits(&counted["p50"]),
                digits(&counted["p84"]),
            )?;
        }
        let all = summary.get("fragility").into_iter();
        let groups = summary.get("fragility_by_group").and_then(Value::as_array);
        for fragility in all.chain(groups.into_iter().flatten()) {
            let group = fragility["group"]
                .as_str()
                .map(|group| format!(" at {group}"));
            let group = group.unwrap_or_default();
            match fragility["problem"].as_str() {
                Some(problem) => writeln!(f, "no fragility is fitted{group}: {problem}")?,
                None => writeln!(
                    f,
                    "fragility{group}: theta {} (95 %: {}; bootstrap {}), beta {} ({}; {})",
                    digits(&fragility["theta"]),
                    interval(&fragility["theta_interval"]),
                    interval(&fragility["theta_bootstrap"]),
                    digits(&fragility["beta"]),
                    interval(&fragility["beta_interval"]),
                    interval(&fragility["beta_bootstrap"]),
                )?,
            }
        }
        write!(f, "{}: {}", self.out.display(), self.found.files.join(", "))
    }
}
