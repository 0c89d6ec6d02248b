//! `new`: what it leaves, and what it refuses.

use std::fs;

use super::{ends_with, json, names, stderr, stdout};

/// The templates of models.
pub const TEMPLATES: [&str; 5] = ["energies", "bodies", "stick-slip", "impact", "contacts"];

#[test]
fn a_new_folder_is_a_model_without_errors() {
    let folder = tempfile::tempdir().unwrap();
    for template in TEMPLATES {
        let name = template.replace('-', "_");
        let output = ends_with(0, folder.path(), &["new", &name, "--template", template]);
        assert!(stdout(&output).contains(&format!("dalembert check {name}\n")));
        let made = folder.path().join(&name);
        assert_eq!(names(&made), ["README.md", "model.py", "scene.json"]);
        assert_eq!(json(&made.join("scene.json"))["model"], "./");
        let output = ends_with(0, folder.path(), &["check", &name]);
        let said = stdout(&output);
        assert!(said.starts_with(&format!("{name}: no errors\n")) && said.contains("\n  mode "));
    }
}

#[test]
fn a_new_paper_is_judged_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let output = ends_with(0, folder.path(), &["new", "cart", "--template", "paper"]);
    assert!(stdout(&output).contains("dalembert verify cart\n"));
    let made = folder.path().join("cart");
    assert_eq!(names(&made), ["README.md", "paper.tex", "symbols.csv"]);
    let output = ends_with(0, folder.path(), &["verify", "cart", "--quick"]);
    assert!(
        stdout(&output).contains("0 findings"),
        "{}",
        stdout(&output)
    );
}

#[test]
fn a_folder_that_holds_something_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("full")).unwrap();
    fs::write(folder.path().join("full/notes.txt"), "").unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    for (name, says) in [
        ("full", "exists and is not empty"),
        ("file", "exists and is not a folder"),
    ] {
        let output = ends_with(2, folder.path(), &["new", name]);
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    }
    assert_eq!(names(&folder.path().join("full")), ["notes.txt"]);
    // An empty one may be filled.
    fs::create_dir(folder.path().join("empty")).unwrap();
    ends_with(0, folder.path(), &["new", "empty"]);
    ends_with(2, folder.path(), &["new", "other", "--template", "nothing"]);
}
