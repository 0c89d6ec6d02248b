//! The command that makes a run of a study again, alone.

use super::file::Study;
use super::rows::Row;
use super::summary::shown;
use crate::record::exact;

/// The command of a run, as a shell takes it: the scene, and what this run changes in it.
pub(crate) fn command(study: &Study, row: &Row) -> String {
    let levels = study.design.levels(row.case).into_iter().map(shown);
    let paths = study.design.factors().map(|factor| factor.path.as_str());
    let along = study.procedure.along();
    let along = along.map(|along| (along.path.as_str(), exact(row.intensity)));
    let mut command = format!(
        "dalembert run {}",
        quoted(&study.scene.display().to_string())
    );
    for (path, value) in paths.zip(levels).chain(along) {
        command += " --set ";
        command += &quoted(&format!("{path}={value}"));
    }
    command
}

/// An argument as a shell takes it.
pub(crate) fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-=+,:@%".contains(c);
    match !argument.is_empty() && argument.chars().all(plain) {
        true => argument.to_owned(),
        false => format!("'{}'", argument.replace('\'', "'\\''")),
    }
}
