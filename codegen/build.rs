//! Puts the generator into the crate: `generator.rs` in `OUT_DIR` lists its files with their contents.

#[path = "build/files.rs"]
mod files;

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let files = files::of_generator(&folder).expect("the crate's own folder can be listed");
    let mut list = String::from("&[\n");
    let mut folders = vec![folder.as_path()];
    for file in &files {
        let name = file.strip_prefix(&folder).expect("it is in the folder");
        // The same name on every system.
        let name: Vec<_> = name.iter().map(|part| part.to_string_lossy()).collect();
        list += &format!("    ({:?}, include_bytes!({file:?})),\n", name.join("/"));
        folders.extend(file.parent());
    }
    list += "]\n";
    let out = env::var_os("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&out).join("generator.rs"), list).expect("OUT_DIR can be written");
    // A new file counts; contents are watched by `include_bytes`.
    folders.sort();
    folders.dedup();
    for folder in folders {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    let target = env::var("TARGET").expect("cargo sets it");
    println!("cargo::rustc-env=DALEMBERT_BUILD_TARGET={target}");
}
