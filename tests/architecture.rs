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

/// The modules of the crate, from the bottom up: each may import those above it in this list, none below it.
const LAYERS: [&str; 17] = [
    "numerics",
    "kernel",
    "model",
    "formula",
    "input",
    "jets",
    "integrate",
    "run",
    "hybrid",
    "motion",
    "record",
    "scene",
    "study",
    "precision",
    "page",
    "folders",
    "cli",
];

/// The layers that a file imports. Its tests may import what they like.
fn imports(source: &str) -> BTreeSet<String> {
    let source = source.split("#[cfg(test)]\nmod tests {").next();
    let lines = source.into_iter().flat_map(str::lines).map(str::trim_start);
    let code = lines.filter(|line| !line.starts_with("//"));
    let code: Vec<&str> = code.collect();
    let mut found = BTreeSet::new();
    for rest in code.join(" ").split("crate::").skip(1) {
        // `crate::a::…` or `crate::{a::…, b}`
        let list = match rest.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap_or(list),
            None => rest,
        };
        let count = if rest.starts_with('{') { usize::MAX } else { 1 };
        for item in list.split(',').take(count) {
            let end = |c: char| !(c.is_ascii_alphanumeric() || c == '_');
            let name = item.trim_start().split(end).next().unwrap_or(item);
            found.insert(name.to_owned());
        }
    }
    found.retain(|name| LAYERS.contains(&name.as_str()));
    found
}

/// The Rust files below a folder, or the file itself, without those of tests.
fn files(path: &Path) -> Vec<std::path::PathBuf> {
    let is_tests = path.file_stem().is_some_and(|name| name == "tests");
    if is_tests {
        return Vec::new();
    }
    if !path.is_dir() {
        return vec![path.to_owned()];
    }
    let entries = fs::read_dir(path).expect("it can be listed");
    let mut found: Vec<_> = (entries.map(|e| e.expect("it can be listed").path()))
        .filter(|path| path.is_dir() || path.extension().is_some_and(|e| e == "rs"))
        .flat_map(|path| files(&path))
        .collect();
    found.sort();
    found
}

#[test]
fn no_layer_imports_one_above_it() {
    let source = root().join("src");
    let mut modules: Vec<String> = (contents("src").into_iter())
        .map(|name| name.trim_end_matches(".rs").to_owned())
        .filter(|name| name != "lib" && name != "main")
        .collect();
    let mut layers = LAYERS.map(str::to_owned).to_vec();
    modules.sort();
    layers.sort();
    assert_eq!(modules, layers, "every module is a layer");
    let mut wrong = Vec::new();
    for (place, layer) in LAYERS.iter().enumerate() {
        let folder = source.join(layer);
        let path = match folder.is_dir() {
            true => folder,
            false => folder.with_extension("rs"),
        };
        for file in files(&path) {
            let text = fs::read_to_string(&file).expect("a module is a text");
            for name in imports(&text) {
                if LAYERS.iter().position(|l| *l == name) > Some(place) {
                    wrong.push(format!("{} imports {name}", file.display()));
                }
            }
        }
    }
    // Of the engine, what runs one trajectory knows nothing of many at once.
    for file in files(&source.join("hybrid")) {
        let text = fs::read_to_string(&file).expect("a module is a text");
        let is_root = file.ends_with("hybrid/mod.rs");
        let is_of_many = file.components().any(|c| c.as_os_str() == "ensemble");
        if !is_root && !is_of_many && text.contains("ensemble::") {
            wrong.push(format!("{} imports ensemble", file.display()));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn imports_are_recognised() {
    let source = "use crate::scene::Scene;\n// crate::cli\nuse crate::{page, record::Run};\nfn f() { crate::hybrid::g() }\n\
                  #[cfg(test)]\nmod tests {\n use crate::cli;\n}";
    let found: Vec<_> = imports(source).into_iter().collect();
    assert_eq!(found, ["hybrid", "page", "record", "scene"]);
}
