//! ARCHITECTURE.md describes the tree as it is, and the notes beside it name what is there.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const PAGE: &str = include_str!("../ARCHITECTURE.md");

/// Inline code of a page.
fn code(page: &str) -> impl Iterator<Item = &str> {
    let prose = page.split("```").step_by(2);
    prose.flat_map(|text| text.split('`').skip(1).step_by(2))
}

/// Whether inline code is a path: it has a slash or a file's ending, and nothing that paths lack.
fn is_path(code: &str) -> bool {
    let endings = [".rs", ".py", ".md", ".json", ".toml", ".lock"];
    let looks_like_one = code.contains('/') || endings.iter().any(|e| code.ends_with(e));
    looks_like_one
        && code
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || "._-/".contains(c))
}

/// The paths that a page names.
fn paths(page: &str) -> BTreeSet<&str> {
    code(page)
        .filter(|c| is_path(c))
        .map(|c| c.trim_end_matches('/'))
        .collect()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Names of what is in a folder, without what builds, runs and version control leave there.
fn contents(folder: &str) -> Vec<String> {
    let entries = fs::read_dir(root().join(folder)).expect("the folder exists");
    let names = entries.map(|e| e.expect("it can be listed").file_name());
    let left_behind = ["target", "out", ".git", "__pycache__"];
    names
        .map(|name| name.into_string().expect("names are UTF-8"))
        .filter(|name| !left_behind.contains(&name.as_str()))
        .collect()
}

#[test]
fn every_path_it_names_exists() {
    let named = paths(PAGE);
    assert!(named.len() > 30, "the paths are recognised: {named:?}");
    let missing: Vec<_> = named.iter().filter(|p| !root().join(p).exists()).collect();
    assert!(
        missing.is_empty(),
        "ARCHITECTURE.md names what does not exist: {missing:?}"
    );
}

#[test]
fn every_path_of_the_notes_exists() {
    for name in contents("docs/notes") {
        let file = root().join("docs/notes").join(&name);
        let page = fs::read_to_string(&file).expect("a note is a text");
        let missing: Vec<_> = (paths(&page).into_iter())
            .filter(|p| !root().join(p).exists())
            .collect();
        assert!(
            missing.is_empty(),
            "docs/notes/{name} names what does not exist: {missing:?}"
        );
    }
}

#[test]
fn every_folder_and_every_module_is_named() {
    let named = paths(PAGE);
    let folders = contents("")
        .into_iter()
        .filter(|name| root().join(name).is_dir());
    let modules = contents("src")
        .into_iter()
        .map(|name| format!("src/{name}"));
    let parts = contents("src/hybrid")
        .into_iter()
        .map(|name| format!("src/hybrid/{name}"));
    let missing: Vec<_> = folders
        .chain(modules)
        .chain(parts)
        .filter(|path| !named.contains(path.as_str()))
        .collect();
    assert!(
        missing.is_empty(),
        "ARCHITECTURE.md does not name {missing:?}"
    );
}
