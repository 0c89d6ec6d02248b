//! How far and which way the tank walks, as the table of docs/walking.md:
//! `cargo run --release --example walk`.
//!
//! Every scene of the tank under both rule sets and both landing laws.

use dalembert::hybrid::simulate;
use dalembert::model::models;
use dalembert::record::{Run, Silent};
use dalembert::scene::Scene;
use std::fmt::Write;
use std::path::Path;

/// What a row is called, its scene, and what it changes of the scene.
const ROWS: [(&str, &str, &[&str]); 5] = [
    ("full plate", "tank_full_plate", &[]),
    ("doughnut", "tank_doughnut", &[]),
    (
        "doughnut, μ = 0.6",
        "tank_doughnut",
        &["parameters.mu_s=0.6", "parameters.mu_k=0.57"],
    ),
    ("free release", "tank_free_release", &[]),
    ("rocks and slides", "tank_rocks_and_slides", &[]),
];

/// Head of the table.
const HEAD: &str = "\
| scene | rules | landing | final slip / mm | slip from … to / mm | peak uplift / mrad | landings | energy lost at landings / J | largest gain at one / mJ |
|---|---|---|--:|--:|--:|--:|--:|--:|
";

fn main() {
    print!("{}", table());
}

/// The table in Markdown.
pub fn table() -> String {
    let mut table = HEAD.to_owned();
    for (name, scene, changes) in ROWS {
        for rules in ["reactions", "paper"] {
            for landing in ["momenta", "velocities"] {
                let run = run(scene, changes, rules, landing);
                let row = row(&run);
                writeln!(table, "| {name} | {rules} | {landing} | {row} |").expect("a text grows");
            }
        }
    }
    table
}

fn run(scene: &str, changes: &[&str], rules: &str, landing: &str) -> Run {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut overrides: Vec<String> = changes.iter().map(|&c| c.into()).collect();
    overrides.extend([format!("rules={rules}"), format!("landing={landing}")]);
    let scene = Scene::load(
        &folder.join(scene).with_extension("json"),
        &overrides,
        models(),
    )
    .unwrap_or_else(|errors| panic!("{errors}"));
    let run = simulate(&scene.problem, &mut Silent).expect("the initial state fits a mode");
    assert_eq!(run.failure, None);
    run
}

fn row(run: &Run) -> String {
    let values = |name: &str| {
        let columns = &run.trajectory.columns;
        let i = columns
            .iter()
            .position(|c| c.name == name)
            .expect("a column of the model");
        let rows = run.trajectory.values.chunks(columns.len());
        rows.map(move |row| 1e3 * row[i])
    };
    let landings: Vec<f64> = (run.events.iter())
        .filter(|e| e.transition == "landing")
        .map(|e| e.energy.expect("a landing is an impact").lost)
        .collect();
    let gain = landings
        .iter()
        .fold(0.0, |most, lost| f64::max(most, -lost));
    let peak = values("theta").fold(0.0, f64::max);
    format!(
        "{:+.3} | {:+.2} … {:+.2} | {} | {} | {:.4} | {:.3}",
        values("x").next_back().expect("a run has samples"),
        values("x").fold(0.0, f64::min),
        values("x").fold(0.0, f64::max),
        if peak == 0.0 {
            "0".into()
        } else {
            format!("{peak:.3}")
        },
        landings.len(),
        landings.iter().fold(0.0, |sum, lost| sum + lost),
        1e3 * gain,
    )
}
