//! The page of a study: what it found, fragility curves, the fan of an incremental dynamic analysis, and every run as a point, with
//! the command that makes it again.

use serde_json::{Value, json};

use super::escape::{script_data, text};
use super::{PLOTS_STYLE, STYLE};
use crate::study::{Cells, Column, Outcome, largest, pictures, shares};

const SCRIPT: &str = include_str!("assets/study.js");
const LOOKS: &str = include_str!("assets/study.css");

/// Most runs that are points of the page: more are a surface, and a page of many megabytes.
const MOST: usize = 5_000;

/// The page of a study whose table has these columns.
pub fn study_page(outcome: &Outcome, columns: &[Column], summary: &Value) -> String {
    let study = outcome.study;
    let title = study.title.as_deref().unwrap_or("Study");
    let rows = columns.first().map_or(0, |column| column.cells.len());
    let stride = rows.div_ceil(MOST).max(1);
    let chosen: Vec<usize> = (0..rows).step_by(stride).collect();
    let factors = study.design.factors().map(|factor| factor.path.as_str());
    let along = study.procedure.along().map(|along| along.path.as_str());
    let factors: Vec<&str> = factors.chain(along).collect();
    let shown: Vec<Value> = columns
        .iter()
        .map(|column| {
            json!({
                "name": column.name,
                "unit": column.unit,
                "values": values(&column.cells, &chosen),
            })
        })
        .collect();
    let curves: Vec<Value> = outcome
        .fragilities
        .iter()
        .map(|fragility| {
            json!({
                "group": fragility.group,
                "theta": fragility.fit.as_ref().ok().map(|f| f.theta),
                "beta": fragility.fit.as_ref().ok().map(|f| f.beta),
                "counted": shares(&fragility.data),
            })
        })
        .collect();
    let data = json!({
        "scene": study.scene.display().to_string(),
        "factors": factors,
        "columns": shown,
        "fragility": curves,
        "largest": largest(outcome),
    });
    let mut page = String::new();
    let mut put = |part: &str| page.push_str(part);
    put("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n");
    put("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    put(&format!("<title>{}</title>\n", text(title)));
    put(&format!(
        "<style>\n{PLOTS_STYLE}\n{STYLE}\n{LOOKS}</style>\n</head><body>\n"
    ));
    put(&format!("<h1>{}</h1>\n", text(title)));
    put(&format!("<p>{}</p>\n", text(&sentence(summary))));
    for (name, picture) in pictures(outcome) {
        put(&format!(
            "<figure id=\"{}\">{picture}</figure>\n",
            name.trim_end_matches(".svg")
        ));
    }
    put("<h2>All runs</h2>\n");
    put(
        "<p class=\"faint\">Drag in a plot to mark runs in all of them, click a point for its command. Runs that failed are red.",
    );
    if stride > 1 {
        put(&format!(" Of {rows} runs every {stride}th is shown."));
    }
    put("</p>\n<div id=\"columns\"></div>\n<div id=\"matrix\"></div>\n");
    put("<p id=\"told\" class=\"faint\">&nbsp;</p>\n<pre id=\"command\" hidden></pre>\n");
    put(&format!(
        "<h2>The study</h2>\n<pre>{}</pre>\n",
        text(study.text.trim_end())
    ));
    put(&format!(
        "<p class=\"faint\">dalembert {}</p>\n",
        env!("CARGO_PKG_VERSION")
    ));
    put(&format!(
        "<script type=\"application/json\" id=\"data\">{}</script>\n<script>\n{SCRIPT}</script>\n</body></html>\n",
        script_data(&data)
    ));
    page
}

/// The cells of some rows as JSON.
fn values(cells: &Cells, rows: &[usize]) -> Value {
    let rows = rows.iter().copied();
    match cells {
        Cells::Numbers(cells) => json!(rows.map(|i| cells[i]).collect::<Vec<_>>()),
        Cells::Counts(cells) => json!(rows.map(|i| cells[i]).collect::<Vec<_>>()),
        Cells::Flags(cells) => json!(rows.map(|i| cells[i]).collect::<Vec<_>>()),
        Cells::Texts(cells) => json!(rows.map(|i| cells[i].as_deref()).collect::<Vec<_>>()),
    }
}

/// What was found, in a sentence.
fn sentence(summary: &Value) -> String {
    let runs = &summary["runs"];
    let mut found = format!(
        "{} cases, {} runs of the model {}: {} ok, {} stopped early, {} refused.",
        summary["cases"],
        runs["total"],
        summary["model"].as_str().unwrap_or_default(),
        runs["ok"],
        runs["stopped"],
        runs["refused"]
    );
    let number = |value: &Value| value.as_f64().map(|x| crate::record::rounded(x, 4));
    let fragility = &summary["fragility"];
    if let (Some(theta), Some(beta)) = (number(&fragility["theta"]), number(&fragility["beta"])) {
        found += &format!(" Fragility: median {theta}, dispersion {beta}.");
    } else if let Some(problem) = fragility["problem"].as_str() {
        found += &format!(" No fragility is fitted: {problem}.");
    }
    if let Some(undecided) = summary["failures"]["undecided"].as_u64() {
        found += &format!(" {undecided} runs are undecided at their tolerance.");
    }
    found
}
