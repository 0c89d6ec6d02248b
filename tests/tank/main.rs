//! The walking tank: closed forms, Newton's second law, friction, landings, symmetry, tolerances.

#[path = "../common/mod.rs"]
mod common;

mod agreement;
mod body;
mod edges;
mod free;
mod landings;
mod laws;
mod mirror;
mod newton;
mod scenes;
