//! A study of precision as JSON.

use serde_json::{Value, json};

use super::Precision;
use super::write::{compared_with, no_advice, outcome};
use crate::precision::{Bound, Reference, Row, method_name};

impl Precision {
    /// The rows, the reference and the advice, as `--help` describes them.
    pub fn json(&self) -> Value {
        let study = &self.study;
        json!({
            "title": self.title,
            "complete": study.is_complete(),
            "rows": study.rows.iter().map(row).collect::<Vec<_>>(),
            "reference": study.reference.as_ref().map(reference),
            "advice": self.errors.iter().map(|&error| self.advice(error)).collect::<Vec<_>>(),
        })
    }

    fn advice(&self, wanted: f64) -> Value {
        let Some(reference) = &self.study.reference else {
            return json!({ "error": wanted, "why_none": "the reference is not there" });
        };
        match self.study.advice(wanted) {
            Some(row) => json!({
                "error": wanted,
                "method": method_name(row.method),
                "tolerance": row.tolerance,
                "seconds": row.measured().map(|found| found.seconds),
            }),
            None => json!({ "error": wanted, "why_none": no_advice(wanted, reference) }),
        }
    }
}

/// A run; null where it has no value.
fn row(row: &Row) -> Value {
    let found = row.measured();
    json!({
        "method": method_name(row.method),
        "used": found.map(|m| &m.used),
        "tolerance": row.tolerance,
        "outcome": outcome(&row.verdict),
        "end_error": found.map(|m| m.error.end),
        "event_time_error": found.map(|m| m.error.events.time),
        "missed_events": found.map(|m| m.error.events.missed),
        "extra_events": found.map(|m| m.error.events.extra),
        "events_in_tails": found.map(|m| m.error.events.in_tails),
        "uncertain": found.map(|m| m.uncertain),
        "energy_imbalance": found.and_then(|m| m.imbalance),
        "steps": found.map(|m| m.steps),
        "evaluations": found.map(|m| m.evaluations),
        "seconds": found.map(|m| m.seconds),
    })
}

fn reference(reference: &Reference) -> Value {
    let Bound { end, event_time } = reference.bound;
    json!({
        "by": compared_with(reference),
        "events": reference.events(),
        "bound": { "end_error": end, "event_time_error": event_time },
        "horizon": reference.horizon.as_ref().map(|horizon| json!({
            "at": horizon.at,
            "until": horizon.until,
            "why": horizon.why,
        })),
    })
}
