//! The tests of the Python packages, with the interpreter that the build found or made.

use std::process::Command;

/// Runs the tests of a folder under the project's root.
fn run_tests(folder: &str) {
    let mut command = Command::new(env!("DALEMBERT_PYTHON_EXE"));
    command.arg("-s");
    for (name, _) in std::env::vars_os() {
        let name = name.to_string_lossy().into_owned();
        if name.starts_with("PYTHON") || name == "VIRTUAL_ENV" {
            command.env_remove(name);
        }
    }
    let packages = env!("DALEMBERT_PYTHON_PATH");
    if !packages.is_empty() {
        command.arg("-S").env("PYTHONPATH", packages);
    }
    let output = command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args([
            "-B",
            "-m",
            "unittest",
            "discover",
            "--top-level-directory",
            ".",
        ])
        .args(["--start-directory", folder])
        .output()
        .expect("the interpreter of the build runs");
    let report = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{folder}:\n{report}");
    assert!(!report.contains("Ran 0 tests"), "{folder}: no tests found");
}

#[test]
fn generator() {
    run_tests("codegen/tests");
}

#[test]
fn verification() {
    run_tests("codegen/verify/tests");
}
