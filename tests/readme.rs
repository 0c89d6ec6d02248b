//! What the README and the page of the walk say is what the program does.

use dalembert::kernel::MODELS;
use dalembert::scene::{Disk, Scene};
use std::path::Path;

#[allow(dead_code)] // `main` prints the table
#[path = "../examples/walk.rs"]
mod walk;

#[test]
fn the_table_of_the_walk_is_the_computed_one() {
    let page = include_str!("../docs/walking.md");
    for row in walk::table().lines() {
        assert!(
            page.contains(row),
            "docs/walking.md lacks the row\n{row}\nrun `cargo run --release --example walk`"
        );
    }
}

#[test]
fn the_scene_it_shows_is_one() {
    let readme = include_str!("../README.md");
    let mut blocks = readme.split("```json\n").skip(1);
    let scene = blocks.next().expect("it shows a scene");
    let scene = scene.split("```").next().expect("the block ends");
    let read = Scene::parse(scene.as_bytes(), Path::new("README.md"), &[], MODELS, &Disk);
    if let Err(errors) = read {
        panic!("{errors}");
    }
}
