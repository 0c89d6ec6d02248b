//! `dalembert check`: what is wrong with a model folder, or what the model is; nothing is compiled.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use std::io::IsTerminal;

use super::outcome::{Failure, Outcome, Result};
use super::{folders, print};

#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Runs the folder's model.py, derives the equations of all its variants and looks for everything that the language of \
models can find wrong; errors that are independent of each other are all told. Exit status 2 if there are any.")]
pub struct CheckArguments {
    /// Folder of the model
    folder: PathBuf,
    /// Print JSON: model, ok, errors, modes with what is free in them, guards and operation counts
    #[arg(long)]
    json: bool,
}

pub fn check(arguments: &CheckArguments) -> Result {
    let judgement = dalembert_build::check(&arguments.folder, &folders::progress);
    let judgement = match judgement {
        Ok(judgement) => judgement,
        Err(error) => {
            let failure = Failure::from(error);
            // A folder that is none has an answer in JSON too; a machine without Python has not.
            if let (true, Failure::WrongInput(message)) = (arguments.json, &failure) {
                print::output(format_args!("{:#}", no_model(&arguments.folder, message)))?;
                return Err(Failure::Reported { wrong_input: true });
            }
            return Err(failure);
        }
    };
    let is_good = judgement["ok"] == json!(true);
    if arguments.json {
        print::output(format_args!("{judgement:#}"))?;
    } else if is_good {
        print::output(text(&judgement))?;
    } else {
        for error in list(&judgement["errors"]) {
            print::error(rendered(error, std::io::stderr().is_terminal()));
        }
    }
    if is_good {
        Ok(Outcome::Done)
    } else {
        Err(Failure::Reported { wrong_input: true })
    }
}

/// The judgement on a folder that has no model.
fn no_model(folder: &Path, message: &str) -> Value {
    let message = message.trim_start_matches("error: ");
    let (message, help) = message.split_once("\nto do: ").unwrap_or((message, ""));
    json!({
        "model": folder.file_name().map(|name| name.to_string_lossy()),
        "ok": false,
        "errors": [{
            "file": folder.join("model.py"), "line": null, "column": null, "end_column": null,
            "message": message, "help": help,
        }],
        "modes": [],
        "contacts": [],
        "variants": [],
    })
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn words(value: &Value) -> String {
    let words: Vec<&str> = list(value).filter_map(Value::as_str).collect();
    match words[..] {
        [] => "none".to_owned(),
        _ => words.join(", "),
    }
}

/// An error as the terminal shows it: with its line and a caret.
fn rendered(error: &Value, styled: bool) -> String {
    let message = error["message"].as_str().unwrap_or_default();
    let file = error["file"].as_str().unwrap_or_default();
    let source = fs::read_to_string(file).unwrap_or_default();
    let place = range(&source, error);
    let about = (!file.is_empty()).then_some((file, &*source, place));
    let help = error["help"].as_str().filter(|help| !help.is_empty());
    crate::scene::rendered(message, about, help, styled)
}

/// The bytes of a source that an error is about: its columns, or its whole line.
fn range(source: &str, error: &Value) -> Option<std::ops::Range<usize>> {
    let number = |key: &str| error[key].as_u64().and_then(|n| usize::try_from(n).ok());
    let line = number("line")?.checked_sub(1)?;
    let text = source.split_inclusive('\n').nth(line)?;
    let start: usize = source.split_inclusive('\n').take(line).map(str::len).sum();
    let text = text.trim_end();
    let at = |column: usize| {
        let mut places = text.char_indices().map(|(place, _)| place);
        places.nth(column - 1).unwrap_or(text.len())
    };
    let first = number("column").filter(|&column| column > 0);
    let from = first.map_or(text.len() - text.trim_start().len(), at);
    let to = first.and(number("end_column")).map_or(text.len(), at);
    Some(start + from..start + to.max(from))
}

/// A good model in a few lines.
fn text(judgement: &Value) -> String {
    let mut text = format!(
        "{}: no errors",
        judgement["model"].as_str().unwrap_or_default()
    );
    for variant in list(&judgement["variants"]) {
        let options = variant["options"].as_object();
        let options = options.into_iter().flatten();
        let options: Vec<String> = options
            .map(|(choice, option)| format!("{choice} = {}", option.as_str().unwrap_or_default()))
            .collect();
        if !options.is_empty() {
            text += &format!("\n\n{}", options.join(", "));
        }
        for contact in list(&variant["contacts"]) {
            let of = |key: &str| contact[key].as_str().unwrap_or_default();
            text += &format!(
                "\n  {} {}: {}",
                of("kind"),
                of("name"),
                words(&contact["states"])
            );
        }
        for mode in list(&variant["modes"]) {
            text += &format!(
                "\n  mode {}: free: {}; guards: {}",
                mode["name"].as_str().unwrap_or_default(),
                words(&mode["free"]),
                words(&mode["guards"]),
            );
            // They are counted of the default options alone, since that takes longer than all the rest.
            if let Some(counts) = mode["operations"].as_object() {
                let sum: u64 = counts.values().filter_map(|n| n.as_u64()).sum();
                text += &format!("; {sum} operations in all its functions");
            }
        }
    }
    text
}
