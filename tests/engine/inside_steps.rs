//! What is read off inside of a step is as accurate as its ends.

use dalembert::hybrid::Method;
use dalembert::model::models;
use dalembert::record::Run;
use dalembert::scene::Scene;
use std::path::Path;

/// Rows amid the steps of a shipped scene.
fn rows_of(scene: &str, method: Method, relative: f64) -> Run {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.json"));
    let mut problem = Scene::load(&file, &[], models()).unwrap().problem;
    problem.method = method;
    problem.set_tolerance(relative);
    problem.end.time = 3.0;
    // Steps do not end at its multiples.
    problem.record.every = Some(0.0173);
    crate::common::run(&problem)
}

/// Largest difference of the coordinates and rates in the rows of two runs, in parts of the size of each.
fn apart(one: &Run, other: &Run) -> f64 {
    let states = 2 * one.layout.coordinates.len();
    let rows = 0..one.trajectory.t.len() - 1;
    let of = |column: usize| {
        let pairs = rows
            .clone()
            .map(|k| [one, other].map(|run| run.trajectory.row(k)[column]));
        let (size, off) = pairs.fold((0.0_f64, 0.0_f64), |(size, off), [a, b]| {
            (size.max(b.abs()), off.max((a - b).abs()))
        });
        if size == 0.0 { 0.0 } else { off / size }
    };
    (0..states).map(of).fold(0.0, f64::max)
}

/// By the polynomial of the stages alone they were off by a hundred tolerances and more at 1e-12.
#[test]
fn rows_between_steps_of_the_implicit_method_meet_the_tolerance() {
    // A motion of one coordinate, one with constraints, one with impacts, and one that is stiff as a step at these tolerances is long.
    for (scene, most) in [
        ("forced_pendulum", 1.0),
        ("four_bar", 5.0),
        ("rocking_block", 5.0),
        ("sliding_oscillator", 10.0),
    ] {
        let exact = rows_of(scene, Method::Taylor, 1e-14);
        for relative in [1e-9, 1e-12] {
            let run = rows_of(scene, Method::Radau, relative);
            let off = apart(&run, &exact) / relative;
            println!("{scene} {relative:e}: {off} tolerances");
            assert!(off <= most, "{scene} at {relative:e}: {off} tolerances");
        }
    }
}
