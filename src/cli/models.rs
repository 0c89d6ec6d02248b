//! `dalembert models`.

use super::outcome::{Failure, Outcome, Result};
use super::print;
use super::table::Table;
use crate::model::{self, Model};
use crate::scene::nearest;
use std::sync::Arc;

#[derive(Debug, clap::Args)]
pub struct ModelsArguments {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// The models that ship: those of the test suite are known by name, but not listed.
fn listed() -> impl Iterator<Item = Arc<Model>> {
    model::models().iter().filter(|m| !m.for_tests)
}

pub fn models(arguments: &ModelsArguments) -> Result {
    if arguments.json {
        let models = listed()
            .map(|m| serde_json::json!({ "name": m.name, "title": m.title, "source": m.source }));
        let models: Vec<_> = models.collect();
        print::output(format_args!("{:#}", serde_json::Value::from(models)))?;
    } else {
        let mut table = Table::new(["model", "title", "source"]);
        for model in listed() {
            table.row([model.name, model.title, model.source]);
        }
        print::output(table)?;
    }
    Ok(Outcome::Done)
}

/// A model by name.
pub fn find(name: &str) -> std::result::Result<Arc<Model>, Failure> {
    if let Some(model) = model::models().find(name) {
        return Ok(model);
    }
    let names: Vec<&str> = listed().map(|m| m.name).collect();
    Err(unknown("model", name, &names))
}

/// Where a name is among the known ones.
pub fn place(what: &str, name: &str, known: &[&str]) -> std::result::Result<usize, Failure> {
    let found = known.iter().position(|k| *k == name);
    found.ok_or_else(|| unknown(what, name, known))
}

/// The error for a name that is not known, with the nearest one, and all of them.
fn unknown(what: &str, name: &str, known: &[&str]) -> Failure {
    let guess = nearest(name, known.iter().copied());
    let guess = guess.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    let known = match known {
        [] => "there is none".to_owned(),
        _ => format!("known: {}", known.join(", ")),
    };
    Failure::wrong_input(format!("unknown {what} `{name}`: {guess}{known}"))
}
