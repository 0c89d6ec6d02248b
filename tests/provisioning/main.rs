//! The build script, run as cargo runs it, on small projects: what it installs, generates and
//! compiles, how often, and what it says when it cannot.

#![cfg(unix)]

mod cache;
mod crates;
mod fixture;
mod models;
mod packaged;
mod python;

/// What a fixture's first build does, as its log tells.
const ALL: [&str; 3] = ["generate alpha", "generate beta", "install"];

/// Asserts that the text has each of the parts.
#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}
