//! The tables of a run's page.

use super::escape::text;
use crate::record::{Summary, rounded};
use std::fmt::Write;

/// Digits shown; the exact numbers are in the files of the run.
const DIGITS: usize = 7;

fn number(x: f64) -> String {
    rounded(x, DIGITS).replace('-', "−")
}

/// A table: a head and rows, the first column text, all others numbers.
fn table(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut out = String::from("<div class=\"scroll\"><table><tr>");
    for (i, cell) in head.iter().enumerate() {
        let _ = write!(out, "<th{}>{}</th>", class(i), text(cell));
    }
    out.push_str("</tr>\n");
    for row in rows {
        out.push_str("<tr>");
        for (i, cell) in row.iter().enumerate() {
            let _ = write!(out, "<td{}>{}</td>", class(i), text(cell));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</table></div>\n");
    out
}

fn class(column: usize) -> &'static str {
    if column == 0 { "" } else { " class=\"n\"" }
}

/// Model, choices, and how the run ended.
pub(super) fn head(summary: &Summary) -> String {
    let choices: String = (summary.choices.0.iter())
        .map(|(choice, option)| format!(" · {choice}: {option}"))
        .collect();
    let mut out = format!("<p>{}{}</p>\n", text(&summary.model), text(&choices));
    let _ = match &summary.failure {
        None => writeln!(
            out,
            "<p>Reached t = {} s in mode {}, after {} transitions.</p>",
            number(summary.end.t),
            text(&summary.end.mode),
            summary.events.total
        ),
        Some(failure) => writeln!(
            out,
            "<p class=\"alarm\">Stopped early at t = {} s in mode {}: {}</p>",
            number(failure.at.t),
            text(&failure.at.mode),
            text(&failure.reason)
        ),
    };
    for state in &summary.reached.limit_states {
        let (name, t, message) = (text(&state.name), number(state.t), text(&state.message));
        let _ = writeln!(out, "<p>Limit state {name} at t = {t} s: {message}.</p>");
    }
    for left in &summary.reached.validity {
        let (condition, message) = (text(&left.condition), text(&left.message));
        let from = (left.t).map_or(String::new(), |t| format!(" from t = {} s on", number(t)));
        let _ = writeln!(
            out,
            "<p class=\"alarm\">Not {condition}{from}: {message}.</p>"
        );
    }
    out
}

/// Extremes, transitions, energies, parameters, work.
pub(super) fn all(summary: &Summary) -> String {
    let end = &summary.end;
    let at_end = |name: &str| {
        end.state()
            .find(|(n, _)| n == name)
            .map_or(String::new(), |(_, x)| number(*x))
    };
    let mut out = String::from("<h2>Extremes</h2>\n");
    out += &table(
        &["", "unit", "end", "min", "at t / s", "max", "at t / s"],
        summary.peaks.0.iter().map(|(name, p)| {
            let numbers = [p.min, p.t_min, p.max, p.t_max].map(number);
            [name.clone(), p.unit.clone(), at_end(name)]
                .into_iter()
                .chain(numbers)
                .collect()
        }),
    );
    if summary.events.total > 0 {
        out += "<h2>Transitions</h2>\n";
        let lost = |name: &str| {
            summary
                .impacts
                .by_transition
                .0
                .iter()
                .find(|(n, _)| n == name)
        };
        out += &table(
            &["", "count", "energy lost / J", "gained energy"],
            summary.events.by_transition.iter().map(|(name, count)| {
                let (energy, gaining) = lost(name).map_or_else(Default::default, |(_, impacts)| {
                    (number(impacts.lost), impacts.gaining.to_string())
                });
                vec![(*name).to_owned(), count.to_string(), energy, gaining]
            }),
        );
    }
    if let Some(energy) = &summary.energy {
        out += "<h2>Energies</h2>\n";
        let rows = [
            ("initial", energy.initial),
            ("+ input work", energy.input_work),
            ("− dissipated", energy.dissipated),
            ("− lost at impacts", energy.lost_at_impacts),
            ("= final", energy.final_),
            ("imbalance", energy.imbalance),
        ];
        out += &table(
            &["", "J"],
            rows.into_iter()
                .map(|(name, x)| vec![name.to_owned(), number(x)]),
        );
        let _ = writeln!(
            out,
            "<p class=\"faint\">Frame: {}.</p>",
            text(&energy.frame)
        );
    }
    out += "<h2>Parameters</h2>\n";
    out += &table(
        &["", "value"],
        (summary.parameters.0.iter()).map(|(name, x)| vec![name.clone(), number(*x)]),
    );
    let solver = &summary.solver;
    let _ = writeln!(
        out,
        "<p class=\"faint\">{}: {} steps, {} rejected; {} s.</p>",
        text(&solver.method),
        solver.steps,
        solver.rejected,
        number(summary.wall_seconds)
    );
    out
}
