//! The page of a study: what it found, its pictures, and every run as a point with the command that makes it again.

use serde_json::Value;

use super::matrix::{Matrix, MatrixColumn};
use super::table::number;
use super::{Cell, Page, Table};
use crate::study::{Column, Outcome, command, default_columns, numbers, pictures};

/// Most runs that are points of the page: more are a surface, and a page of many megabytes.
const MOST: usize = 5_000;

/// The page of a study whose table has these columns; `made_by` is the command that made it.
pub fn study_page(outcome: &Outcome, columns: &[Column], summary: &Value, made_by: &str) -> String {
    let study = outcome.study;
    let mut page = Page::new(study.title.as_deref().unwrap_or("Study"));
    counted(&mut page, summary);
    fits(&mut page, summary);
    for picture in pictures(outcome) {
        page.chart_with_notes(&picture.chart, &picture.notes);
    }
    page.heading("All runs");
    runs(&mut page, outcome, columns);
    measures(&mut page, outcome, summary);
    page.source("The study", made_by, &study.text);
    page.finish()
}

/// How many runs there were, how they ended and what is not known of them.
fn counted(page: &mut Page, summary: &Value) {
    let runs = &summary["runs"];
    page.paragraph(&format!(
        "{} cases, {} runs of the model {}: {} ok, {} stopped early, {} refused.",
        summary["cases"],
        runs["total"],
        summary["model"].as_str().unwrap_or_default(),
        runs["ok"],
        runs["stopped"],
        runs["refused"]
    ));
    for (reason, count) in runs["reasons"].as_object().into_iter().flatten() {
        page.note(&format!("{count} × {reason}"));
    }
    let failures = &summary["failures"];
    if failures.is_object() {
        page.paragraph(&format!(
            "{} failed, {} did not, {} do not tell; {} undecided at this tolerance.",
            failures["failed"], failures["survived"], failures["untold"], failures["undecided"]
        ));
    }
    let capacities = &summary["capacities"];
    if capacities.is_object() {
        page.paragraph(&format!(
            "Capacities: {} known, {} censored, {} do not tell, {} undecided.",
            capacities["known"],
            capacities["censored"],
            capacities["untold"],
            capacities["undecided"]
        ));
    }
}

/// Fragilities and the regression of a cloud, as numbers.
fn fits(page: &mut Page, summary: &Value) {
    let groups = summary["fragility_by_group"]
        .as_array()
        .into_iter()
        .flatten();
    let all = Some(&summary["fragility"]).filter(|all| all.is_object());
    let mut table = Table::new(["fragility", "", "value", "95 %, profile", "95 %, bootstrap"]);
    let mut any = false;
    for fragility in all.into_iter().chain(groups) {
        let group = fragility["group"].as_str().unwrap_or("all cases");
        if let Some(problem) = fragility["problem"].as_str() {
            page.note(&format!("No fragility is fitted to {group}: {problem}."));
            continue;
        }
        for (key, words) in [("theta", "median θ"), ("beta", "dispersion β")] {
            let interval = |of: &str| between(&fragility[&format!("{key}_{of}")]);
            table.row([
                Cell::from(group),
                Cell::from(words),
                Cell::plain(fragility[key].as_f64().unwrap_or(f64::NAN)),
                Cell::from(interval("interval")),
                Cell::from(interval("bootstrap")),
            ]);
            any = true;
        }
    }
    if any {
        page.table(&table);
    }
    let cloud = &summary["cloud"];
    let shown = |key: &str| cloud[key].as_f64().map_or("–".to_owned(), number);
    if let Some(problem) = cloud["problem"].as_str() {
        page.note(&format!("No line is fitted to the cloud: {problem}."));
    } else if let Some(measure) = cloud["measure"].as_str() {
        page.paragraph(&format!(
            "Cloud: {measure} = {} · intensity^{}, dispersion {} of its logarithm, from {} runs; {} are left out.",
            shown("a"),
            shown("b"),
            shown("dispersion"),
            cloud["runs"],
            cloud["left_out"]
        ));
        if cloud["theta"].is_number() {
            page.paragraph(&format!(
                "Fragility by the regression: median {}, dispersion {}.",
                shown("theta"),
                shown("beta")
            ));
        }
    }
}

/// An interval in words.
fn between(limits: &Value) -> String {
    let shown = |i: usize| limits[i].as_f64().map_or("no limit".to_owned(), number);
    match limits.is_array() {
        true => format!("{} to {}", shown(0), shown(1)),
        false => "–".to_owned(),
    }
}

/// All runs as points.
fn runs(page: &mut Page, outcome: &Outcome, columns: &[Column]) {
    let study = outcome.study;
    let rows: Vec<_> = outcome
        .finished
        .values()
        .flat_map(|rows| rows.iter().enumerate())
        .collect();
    let stride = rows.len().div_ceil(MOST).max(1);
    let mut words =
        "Drag in a plot to mark runs in all of them, click a point for its command.".to_owned();
    if study.failure.is_some() {
        words += " Runs that failed are red, those that do not tell grey.";
    }
    if stride > 1 {
        words += &format!(" Of {} runs every {stride}th is shown.", rows.len());
    }
    page.note(&words);
    let mut matrix = Matrix::default();
    let first = default_columns(outcome, columns);
    for (i, column) in columns.iter().enumerate() {
        let Some(values) = numbers(column) else {
            continue;
        };
        if first.contains(&i) {
            matrix.shown.push(matrix.columns.len());
        }
        matrix.columns.push(MatrixColumn {
            name: column.name.clone(),
            unit: column.unit.clone(),
            values: values.into_iter().step_by(stride).collect(),
        });
    }
    for &(run, row) in rows.iter().step_by(stride) {
        if study.failure.is_some() {
            matrix.failed.push(row.failed);
        }
        let run = match study.procedure.along() {
            Some(_) => format!(", run {run}"),
            None => String::new(),
        };
        let reason = row.reason.as_deref().map(|reason| format!(", {reason}"));
        let undecided = if row.undecided {
            ", undecided at this tolerance"
        } else {
            ""
        };
        matrix.told.push(format!(
            "case {}{run}: {}{}{undecided}",
            row.case,
            row.status.word(),
            reason.unwrap_or_default()
        ));
        matrix.commands.push(command(study, row));
    }
    page.matrix(matrix);
}

/// Statistics of the measures over the runs that came to their end.
fn measures(page: &mut Page, outcome: &Outcome, summary: &Value) {
    page.heading("Measures of runs that came to their end");
    let keys = ["count", "mean", "sd", "min", "p16", "median", "p84", "max"];
    let heads = [
        "count", "mean", "sd", "least", "16 %", "50 %", "84 %", "largest", "unit",
    ];
    let mut table = Table::new(std::iter::once("measure").chain(heads));
    for measure in &outcome.study.measures {
        let of = &summary["measures"][&measure.name];
        let mut row = vec![Cell::from(measure.name.as_str())];
        row.extend(keys.iter().enumerate().map(|(i, key)| {
            let unit = if i == 0 { "1" } else { measure.unit.as_str() };
            Cell::Number(of[key].as_f64().unwrap_or(f64::NAN), unit.to_owned())
        }));
        row.push(Cell::Unit(measure.unit.clone()));
        table.row(row);
    }
    page.table(&table);
}
