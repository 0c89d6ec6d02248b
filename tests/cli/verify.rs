//! `verify`: how Python is run. What it finds is tested beside it, in codegen/verify/tests.

use super::*;

const EXAMPLE: &str = "codegen/verify/examples/double_pendulum";

#[test]
fn equations_are_judged_and_a_page_is_written_where_the_command_was_given() {
    let home = tempfile::tempdir().unwrap();
    let example = project().join(EXAMPLE).display().to_string();
    let pages = [
        "--html",
        "report.html",
        "--latex",
        "report.tex",
        "--certificate",
        "claims.json",
    ];
    let arguments = [&["verify", &example, "--quick"][..], &pages].concat();
    // A foreign environment must not reach the interpreter of the build.
    let assert = dalembert(home.path())
        .env("PYTHONPATH", "/nowhere")
        .env("PYTHONHOME", "/nowhere")
        .args(arguments)
        .assert()
        .code(0);
    assert!(!assert.get_output().stdout.is_empty());
    assert_eq!(
        names(home.path()),
        ["claims.json", "report.html", "report.tex"]
    );
}

#[test]
fn a_model_without_printed_equations_is_wrong_input() {
    let output = ends_with(2, &project(), &["verify", "bouncing_ball"]);
    assert!(
        stderr(&output).contains("bouncing_ball"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn an_interpreter_that_is_gone_is_named_with_what_to_do() {
    let home = tempfile::tempdir().unwrap();
    let assert = dalembert(home.path())
        .env("DALEMBERT_PYTHON", "/nowhere/python3")
        .args(["verify", "walking_tank"])
        .assert()
        .code(2);
    let message = stderr(assert.get_output());
    let setting = "DALEMBERT_PYTHON=/nowhere/python3: no such program";
    assert!(message.contains(setting), "{message}");
    assert!(message.contains("to do: "), "{message}");
}

#[test]
fn misprints_fail_where_they_are_asked_to() {
    let home = tempfile::tempdir().unwrap();
    ends_with(0, home.path(), &["new", "cart", "--template", "paper"]);
    let paper = home.path().join("cart/paper.tex");
    let text = std::fs::read_to_string(&paper).unwrap();
    std::fs::write(&paper, text.replace("+ m g l", "- m g l")).unwrap();
    let judge = ["verify", "cart", "--quick", "--fail-on", "misprint"];
    let output = ends_with(1, home.path(), &judge);
    assert!(
        stderr(&output).contains("--fail-on misprint: 6-1"),
        "{}",
        stderr(&output)
    );
    std::fs::write(home.path().join("known"), "6-1: the author knows\n").unwrap();
    ends_with(
        0,
        home.path(),
        &[&judge[..], &["--waivers", "known"]].concat(),
    );
}
