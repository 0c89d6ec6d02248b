//! Any number of free coordinates: small ones whose number the compiler knows, and all others.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::kernel::ModeKernels;
use dalembert::model::Models;
use dalembert::record::Run;

/// A model of the tests with as many free coordinates as an option says.
fn problem_of(models: &Models, model: &str, choice: &str, free: usize) -> Problem {
    let model = models.find(model).unwrap();
    let mut problem = Problem::new(&model);
    problem.choose(&[(choice, &free.to_string())]).unwrap();
    problem.end.time = 3.0;
    problem
}

/// Links that begin bent, more and more.
fn links(models: &Models, free: usize) -> Problem {
    let mut problem = problem_of(models, "link_chain", "links", free);
    for k in 0..free {
        problem.initial.q[k] = 1.0 + 0.1 * k as f64;
    }
    problem
}

/// Masses that a belt drags along, with springs that stiffen.
fn masses(models: &Models, free: usize) -> Problem {
    let mut problem = problem_of(models, "spring_chain", "masses", free);
    problem.set_parameter("k_3", 1e4).unwrap();
    problem.end.time = 6.0;
    problem
}

/// All that a run leaves, to the bit: numbers are written so that they read back the same.
fn bits(run: &Run) -> String {
    let Run {
        trajectory,
        events,
        peaks,
        end,
        solver,
        energy,
        uncertain,
        ..
    } = run;
    format!("{trajectory:?} {events:?} {peaks:?} {end:?} {solver:?} {energy:?} {uncertain:?}")
}

fn is_dynamic(problem: &Problem) -> bool {
    let modes = &problem.automaton().modes;
    (modes.iter()).all(|mode| matches!(mode.kernels, ModeKernels::Any(_)))
}

#[test]
fn a_size_that_the_compiler_knows_changes_no_bit() {
    let (known, dynamic) = (Models::linked(), Models::linked().with_dynamic_sizes());
    let mut seen = (0, 0);
    for free in 1..=6 {
        for method in [Method::Radau, Method::Taylor, Method::Auto] {
            for make in [links, masses] {
                let [known, dynamic] = [&known, &dynamic].map(|models| {
                    let mut problem = make(models, free);
                    problem.method = method;
                    problem
                });
                assert!(!is_dynamic(&known) && is_dynamic(&dynamic));
                let (known, dynamic) = (run(&known), run(&dynamic));
                assert!(bits(&known) == bits(&dynamic), "{free} {method:?}");
                seen.0 += known.solver.steps;
                seen.1 += known.events.len();
            }
        }
    }
    assert!(seen.0 > 1000 && seen.1 > 100, "{seen:?} steps and events");
}

/// The double pendulum against 50-digit solutions; see `pendulum.rs`.
#[test]
fn two_links_are_a_double_pendulum() {
    let reference = reference("09_pendulums");
    let cases = reference["reference"]["double_pendulum"]
        .as_array()
        .unwrap();
    let case = cases.iter().find(|c| c["name"] == "chaotic").unwrap();
    let models = Models::linked().with_dynamic_sizes();
    for method in [Method::Radau, Method::Taylor] {
        let mut problem = links(&models, 2);
        problem.method = method;
        let start = numbers(&case["y0"]);
        problem.initial.q[..2].copy_from_slice(&start[..2]);
        problem.initial.v[..2].copy_from_slice(&start[2..]);
        tighten(&mut problem, 1e-3);
        let mut amplification = 1.0_f64;
        for row in case["rows"].as_array().unwrap() {
            problem.end.time = number(&row["t"]);
            if problem.end.time > 10.0 {
                break;
            }
            let state = run(&problem).end.state;
            let found = state.q[..2].iter().chain(&state.v[..2]);
            let exact = numbers(&row["th1,th2,w1,w2"]);
            let error = found
                .zip(&exact)
                .fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()));
            amplification = amplification.max(number(&row["amplification_d/dth1(0)"]));
            assert!(
                error < 1e-14 * amplification,
                "t = {}: {error:e}",
                problem.end.time
            );
        }
    }
}

/// Seven are more than the compiler knows.
#[test]
fn more_coordinates_than_the_engine_is_compiled_for_keep_the_energy_by_both_methods() {
    let models = Models::linked();
    for make in [links, masses] {
        let [radau, taylor] = [Method::Radau, Method::Taylor].map(|method| {
            let mut problem = make(&models, 7);
            assert!(
                problem
                    .automaton()
                    .modes
                    .iter()
                    .any(|mode| mode.free.len() == 7)
            );
            problem.method = method;
            tighten(&mut problem, 1e-2);
            run(&problem)
        });
        let [x, y] = [&radau, &taylor].map(|run| {
            let ledger = run.energy.as_ref().unwrap();
            assert!(ledger.imbalance().abs() < 1e-14 * (1.0 + ledger.initial.abs()));
            (run.events.len(), &run.end.state.q)
        });
        assert_eq!(x.0, y.0, "events");
        // Tolerances of ten roundings, and motions that amplify errors by some powers of ten.
        let error = (x.1.iter().zip(y.1)).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()));
        assert!(error < 1e-13, "{error:e}");
    }
}
