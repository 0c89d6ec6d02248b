//! The command line, from outside: statuses, messages, files.

#[path = "../browser/mod.rs"]
mod browser;
mod cache;
mod check;
mod compare;
mod describe;
mod folders;
mod fragility;
mod hostile;
mod input;
mod interrupt;
mod limits;
mod motion;
mod new;
mod output;
mod outputs;
mod page;
#[cfg(feature = "png-pdf")]
mod pictures;
mod precision;
#[path = "../common/random.rs"]
mod random;
mod random_mechanisms;
mod random_models;
mod run;
mod sizes;
mod study;
mod verify;
mod watch;

use assert_cmd::Command;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::{fs, str};

/// The program, run in the given folder.
fn dalembert(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dalembert"));
    command.current_dir(folder);
    command
}

/// Runs the program, which must end with this status; gives what it wrote.
fn ends_with(status: i32, folder: &Path, arguments: &[&str]) -> Output {
    let assert = dalembert(folder).args(arguments).assert().code(status);
    assert.get_output().clone()
}

fn stdout(output: &Output) -> &str {
    str::from_utf8(&output.stdout).expect("the output is UTF-8")
}

fn stderr(output: &Output) -> &str {
    str::from_utf8(&output.stderr).expect("errors are UTF-8")
}

/// A scene that ships.
fn scene(name: &str) -> String {
    let path = project().join("scenes").join(name);
    path.with_extension("json").display().to_string()
}

fn project() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The names of the files in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
    let mut names: Vec<String> = entries.map(|e| name(e).into_string().unwrap()).collect();
    names.sort();
    names
}

/// A JSON file.
fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}
