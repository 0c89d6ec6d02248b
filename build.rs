//! Builds the models: see `build/mod.rs`.

#[path = "build/mod.rs"]
mod provision;

/// Reports failures as cargo errors. The exit status stays 0, on which cargo prints those lines
/// alone and still fails the build; a non-zero status would bury them under the build script's
/// whole output.
fn main() {
    if let Err(error) = provision::run() {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}
