//! Extremes of trajectories in lanes are those of the motion, as of single runs, and independent of everything around it.

use super::common::problem;
use super::{dry_oscillators, pairs_of_balls, set_size, shaken_blocks, shuttles, variations};
use dalembert::hybrid::{Ensemble, Member, Problem, simulate};
use dalembert::kernel::processor_level;
use std::sync::atomic::AtomicBool;

use dalembert::record::{Peak, Recorded, Silent};

/// The extremes of coordinates and velocities of each, by single runs.
fn alone(problems: &[Problem]) -> Vec<Vec<Peak>> {
    let peaks = |problem: &Problem| {
        let run = simulate(problem, &mut Silent).unwrap();
        let count = 2 * problem.model.coordinates.len();
        let first = run.peaks.iter().take(count);
        first.map(|(_, peak)| *peak).collect()
    };
    problems.iter().map(peaks).collect()
}

fn together(problems: &[Problem], level: usize, threads: usize) -> Vec<Vec<Peak>> {
    let mut scene = problems[0].clone();
    (scene.record.ledger, scene.record.columns) = (false, Recorded::default());
    let ensemble = Ensemble::recording(&scene, &AtomicBool::new(false))
        .unwrap()
        .unwrap();
    let ensemble = ensemble.at_level(level);
    let members: Vec<_> = problems.iter().map(Member::from).collect();
    let count = 2 * problems[0].model.coordinates.len();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(|| {
        ensemble.run(&members, |_, finished| {
            (0..count).map(|i| finished.peak(i).unwrap()).collect()
        })
    })
}

/// The largest difference of extremes.
fn difference(one: &[Vec<Peak>], other: &[Vec<Peak>]) -> f64 {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    pairs.fold(0.0, |most: f64, (a, b)| {
        most.max((a.max - b.max).abs()).max((a.min - b.min).abs())
    })
}

/// `bound`: the motion amplifies the roundings in which the two differ, and limits are known to the tolerance.
fn check(problems: &[Problem], bound: f64) {
    let (single, all) = (alone(problems), together(problems, 0, 1));
    let found = difference(&single, &all);
    assert!(found < bound, "{found:e}");
    let has_times = |peak: &Peak| peak.t_max.is_finite() && peak.t_min.is_finite();
    assert!(all.iter().flatten().all(has_times));
    for level in 0..=processor_level() {
        assert_eq!(together(problems, level, 2), all, "level {level}");
    }
}

#[test]
fn extremes_of_shaken_blocks_are_those_of_single_runs() {
    check(&shaken_blocks(1e-10, 21), 1e-11);
    check(&shaken_blocks(1e-3, 21), 1e-11);
}

#[test]
fn extremes_between_events_that_the_engine_takes_are_those_of_single_runs() {
    check(&dry_oscillators(1e-10), 1e-10);
    // The tolerance is 1e-9, and the walls amplify.
    check(&shuttles(), 1e-7);
}

#[test]
fn extremes_of_accumulations_are_those_of_single_runs() {
    check(&pairs_of_balls(), 1e-8);
}

#[test]
fn extremes_inside_of_steps_are_found_in_lanes() {
    let mut pendulum = problem("double_pendulum", &[("m_2", 0.4)]);
    pendulum.end.time = 3.0;
    set_size(&mut pendulum, 1e-12, 1.0, 1.0);
    let problems = variations(&pendulum, 19, |p, x| {
        p.set_initial("theta_1", 0.5 + x).unwrap();
    });
    check(&problems, 1e-12);
}
