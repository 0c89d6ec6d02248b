//! What the README and the page of the walk say is what the program does.

use dalembert::model::models;
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
    let read = Scene::parse(
        scene.as_bytes(),
        Path::new("README.md"),
        &[],
        models(),
        &Disk,
    );
    if let Err(errors) = read {
        panic!("{errors}");
    }
}

/// Times depend on the machine and on the state of the code: the README names the commands that measure them.
#[test]
fn it_quotes_no_times_that_nothing_renews() {
    let words: Vec<_> = include_str!("../README.md").split_whitespace().collect();
    let is_time =
        |word: &str| ["µs", "ms", "ns"].contains(&word.trim_matches([',', '.', ';', ')']));
    for pair in words.windows(2) {
        let follows = pair[0] == "/" || pair[0].ends_with(|c: char| c.is_ascii_digit());
        assert!(
            !(follows && is_time(pair[1])),
            "README.md quotes a time: {pair:?}"
        );
    }
}

/// What it says of the comparison is what the table says that `benches/peers/run.py` writes.
#[test]
fn the_comparison_is_as_in_its_table() {
    let rows = include_str!("../docs/peers.md").lines().filter_map(|line| {
        let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
        match cells[..] {
            [problem, error, .., ratio] if error.starts_with("1e-") => {
                Some((problem, ratio, ratio.parse::<f64>().expect("a ratio")))
            }
            _ => None,
        }
    });
    let (free, others): (Vec<_>, Vec<_>) = rows.partition(|&(problem, ..)| problem == "free");
    let span = |of: &[(_, &str, f64)]| {
        let by_ratio = |a: &&(_, _, f64), b: &&(_, _, f64)| a.2.total_cmp(&b.2);
        let least = of.iter().min_by(by_ratio).expect("it is in the table").1;
        let most = of.iter().max_by(by_ratio).expect("it is in the table").1;
        format!("{least} to {most}")
    };
    for said in [
        format!("ours takes {}\n", span(&others)),
        format!("on the tank's free release it is {}.", span(&free)),
    ] {
        let is_said = include_str!("../README.md").contains(&said);
        assert!(is_said, "README.md lacks: {said}");
    }
}
