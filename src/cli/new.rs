//! `dalembert new`: a model folder to start from.

use std::fs;
use std::path::{Path, PathBuf};

use super::outcome::{Failure, Outcome, Result};
use super::print;

/// A folder that is inside the program.
struct Template {
    name: &'static str,
    /// Names and texts.
    files: &'static [(&'static str, &'static str)],
    /// What to do with it: commands, in which `{}` is the folder.
    next: &'static [&'static str],
}

macro_rules! template {
    ($name:literal, $next:expr, $($file:literal),+) => {
        Template {
            name: $name,
            files: &[$((
                $file,
                include_str!(concat!("../../templates/", $name, "/", $file)),
            )),+],
            next: $next,
        }
    };
    ($name:literal) => {
        template!($name, MODEL, "model.py", "README.md", "scene.json")
    };
}

/// What to do with a model.
const MODEL: &[&str] = &["dalembert check {}", "dalembert run {}/scene.json"];

/// What to do with a paper.
const PAPER: &[&str] = &["dalembert verify {}"];

const TEMPLATES: [Template; 6] = [
    template!("energies"),
    template!("bodies"),
    template!("stick-slip"),
    template!("impact"),
    template!("contacts"),
    template!("paper", PAPER, "paper.tex", "symbols.csv", "README.md"),
];

#[derive(Debug, clap::Args)]
pub struct NewArguments {
    /// Folder to make; its name is that of the model
    folder: PathBuf,
    /// What to start from: a pendulum by its energies, a rod on a cart by its bodies, a block on a rough slope, a ball
    /// that bounces; or the equations of a paper, to be verified
    #[arg(long, default_value = "energies", value_parser = TEMPLATES.map(|template| template.name))]
    template: String,
}

pub fn new(arguments: &NewArguments) -> Result {
    let folder = &arguments.folder;
    refuse(folder)?;
    let found = TEMPLATES
        .iter()
        .find(|template| template.name == arguments.template);
    let Some(template) = found else {
        return Err(Failure::wrong_input(format!(
            "there is no template `{}`",
            arguments.template
        )));
    };
    write(folder, template)
        .map_err(|error| Failure::system(format!("cannot write {}: {error}", folder.display())))?;
    let shown = folder.display().to_string();
    let next: Vec<String> = template
        .next
        .iter()
        .map(|command| command.replace("{}", &shown))
        .collect();
    print::output(format_args!("made {shown}; next:\n  {}", next.join("\n  ")))?;
    Ok(Outcome::Done)
}

/// Refuses a folder in which there is something.
fn refuse(folder: &Path) -> std::result::Result<(), Failure> {
    let shown = folder.display();
    match fs::read_dir(folder) {
        Ok(mut entries) => match entries.next() {
            None => Ok(()),
            Some(_) => Err(Failure::wrong_input(format!(
                "{shown}: exists and is not empty; choose another folder, or move its files away"
            ))),
        },
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) if error.kind() == std::io::ErrorKind::NotADirectory => {
            Err(Failure::wrong_input(format!(
                "{shown}: exists and is not a folder; choose another name"
            )))
        }
        Err(error) => Err(Failure::system(format!("cannot list {shown}: {error}"))),
    }
}

/// Writes the files. A file that is there by now is not replaced.
fn write(folder: &Path, template: &Template) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    for (name, text) in template.files {
        let mut file = fs::File::create_new(folder.join(name))?;
        std::io::Write::write_all(&mut file, text.as_bytes())?;
    }
    Ok(())
}
