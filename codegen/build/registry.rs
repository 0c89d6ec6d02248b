//! The Rust file that the crate includes: every model's generated description, and their list.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use super::error::Error;
use super::generate::Generated;

/// Most free coordinates that a mode may have: the cases of `ModeKernels` in `src/kernel/mod.rs`.
const MOST_FREE: usize = 6;

/// Writes the file, and tells the crate which numbers of free coordinates its modes have. It holds a module per model, with the generated fragment inside, and
/// `MODELS`, in the order of the names. The fragments are copied, not included by path: the cache
/// they come from may be deleted.
pub fn write(models: &[Generated], path: &Path) -> Result<(), Error> {
    for free in 0..=MOST_FREE {
        println!("cargo::rustc-check-cfg=cfg(free_{free})");
        let kernel = format!("ModeKernels::F{free}(");
        if models.iter().any(|m| m.fragment.contains(&kernel)) {
            println!("cargo::rustc-cfg=free_{free}");
        }
    }
    fs::write(path, text(models)).map_err(Error::io("write", path))
}

fn text(models: &[Generated]) -> String {
    let mut text = String::new();
    let mut list = String::new();
    for Generated {
        name,
        folder,
        fragment,
        item,
        ..
    } in models
    {
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "/// The model `{folder}`, as generated.\n\
             #[allow(clippy::approx_constant)] // numbers are those of the model file\n\
             pub mod {name} {{\n\
             use super::*;\n\
             {fragment}\n\
             }}\n\n"
        );
        let _ = writeln!(list, "    &{name}::{item},");
    }
    text.push_str(
        "/// Most conditions of a transition, of any model.\npub const MOST_CONDITIONS: usize = most(&[\n",
    );
    for model in models {
        let _ = writeln!(text, "    {}::MOST_CONDITIONS,", model.name);
    }
    text.push_str("]);\n\n");
    text + "/// Every model that was found when the crate was built, by name.\n\
            pub static MODELS: &[&Model] = &[\n"
        + &list
        + "];\n"
}
