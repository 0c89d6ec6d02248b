//! Which files of a folder count: of a model, and of the generator (this crate's own build script asks too).

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The files of a folder and its sub-folders on which what is generated from it can depend, sorted: all but
/// prose, tests, bytecode and hidden files.
pub fn sources(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut paths: Vec<_> =
        (fs::read_dir(folder)?.map(|entry| Ok(entry?.path()))).collect::<io::Result<_>>()?;
    paths.sort();
    for path in paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with('.')
            || name.ends_with(".md")
            || ["tests", "__pycache__"].contains(&&*name)
        {
            continue;
        } else if path.is_dir() {
            found.extend(sources(&path)?);
        } else {
            found.push(path);
        }
    }
    Ok(found)
}

/// The files of the generator in the folder `codegen`: this crate's own Rust is not among them.
pub fn of_generator(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let own = [
        "build",
        "build.rs",
        "Cargo.toml",
        "Cargo.toml.orig",
        "Cargo.lock",
        "target",
    ];
    let mut files = sources(folder)?;
    files.retain(|file| !own.iter().any(|name| file.starts_with(folder.join(name))));
    Ok(files)
}
