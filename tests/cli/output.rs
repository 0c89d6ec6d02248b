//! Help, and readers that close the pipe.

use super::*;
use std::process::{Command, Stdio};

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    for arguments in [
        &["describe", "walking_tank"][..],
        &["run", &scene("bouncing_ball")],
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = Command::new(env!("CARGO_BIN_EXE_dalembert"))
            .args(arguments)
            .stdout(writer)
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        assert_eq!(stderr(&output), "");
        assert_eq!(output.status.code(), Some(0));
    }
}

#[test]
fn help_names_every_command_and_status() {
    let output = ends_with(0, &project(), &["--help"]);
    let text = stdout(&output);
    for command in [
        "run", "compare", "motion", "models", "describe", "schema", "verify",
    ] {
        assert!(text.contains(&format!("\n  {command} ")), "{command}");
    }
    assert!(text.contains("Exit status: 0 done;"));
    let output = ends_with(0, &project(), &["run", "--help"]);
    assert!(stdout(&output).contains("--resume"));
}

#[test]
fn wrong_arguments_are_wrong_input() {
    for arguments in [
        &["rnu"][..],
        &["run"],
        &["run", "a.json", "--ot", "b"],
        &["verify"],
    ] {
        let output = ends_with(2, &project(), arguments);
        assert!(stderr(&output).starts_with("error: "));
    }
}
