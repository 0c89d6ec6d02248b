//! Estimates of errors and studies of precision, on the problems of the comparison with other solvers
//! and their references of 30 digits.

use dalembert::hybrid::{Method, Problem, Simulator, simulate};
use dalembert::precision::{Study, estimate};
use dalembert::record::Silent;
use serde_json::Value;

#[allow(dead_code)] // `main` measures
#[path = "../benches/peers/dalembert.rs"]
mod rows;

fn numbers(value: &Value) -> Vec<f64> {
    let number = |x: &Value| x.as_str().unwrap().parse().unwrap();
    value.as_array().unwrap().iter().map(number).collect()
}

/// Components of the state of the reference, and times of its events.
fn reference(name: &str) -> (Vec<f64>, Vec<f64>) {
    let text = include_str!("../benches/peers/reference.json");
    let all: Value = serde_json::from_str(text).unwrap();
    (numbers(&all[name]["y_end"]), numbers(&all[name]["events"]))
}

/// The state of a problem at its end, in the order of the references, and the times of its events.
fn solve(name: &str, problem: &Problem) -> (Vec<f64>, Vec<f64>) {
    let mut simulator = Simulator::new(problem).unwrap();
    simulator.run(&mut Silent).unwrap();
    let events = simulator.events().iter();
    let times = events.filter(|e| e.transition != "rest").map(|e| e.t);
    (rows::state(name, &simulator), times.collect())
}

fn largest(differences: impl Iterator<Item = f64>) -> f64 {
    differences.fold(0.0, f64::max)
}

#[test]
fn the_estimate_of_an_error_brackets_the_true_one() {
    for name in rows::PROBLEMS {
        let (end, events) = reference(name);
        for method in [Method::Auto, Method::Radau] {
            for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
                let mut problem = rows::problem(name, tolerance);
                problem.method = method;
                let at = format!("{name} {method:?} {tolerance:e}");
                let run = simulate(&problem, &mut Silent).unwrap();
                let found = estimate(&problem, &run, &mut Silent).unwrap();
                assert_eq!((found.missed, found.extra), (0, 0), "{at}");

                let (state, times) = solve(name, &problem);
                // The better run itself is off by up to a tenth of it, and by the roundings that the
                // motion amplifies from event to event.
                let agree = |estimated: f64, true_error: f64, size: f64, what: &str| {
                    let apart = (estimated - true_error).abs();
                    assert!(
                        apart <= 0.1 * true_error + 1e-12 * size,
                        "{at}: {what}: estimated {estimated:e}, is {true_error:e}"
                    );
                };
                let estimated: Vec<f64> = found.q.iter().chain(&found.v).copied().collect();
                // Of models with more coordinates than the references the others are held.
                let n = found.q.len();
                let components = match end.len() {
                    2 => vec![0, n],
                    _ => vec![0, 1, n, n + 1],
                };
                for (i, component) in components.into_iter().enumerate() {
                    let true_error = (state[i] - end[i]).abs();
                    agree(estimated[component], true_error, 1.0, &format!("state {i}"));
                }
                let apart = times.iter().zip(&events).map(|(a, b)| (a - b).abs());
                agree(found.event_time, largest(apart), problem.end.time, "event");
            }
        }
    }
}

#[test]
fn the_advice_reaches_the_wanted_error() {
    for name in ["P1", "P4"] {
        let (end, _) = reference(name);
        let study = Study::new(&rows::problem(name, 1e-8), &mut Silent, |_, _| ()).unwrap();
        assert!(study.is_complete());
        for wanted in [1e-3, 1e-6, 1e-9] {
            let row = study
                .advice(wanted)
                .unwrap_or_else(|| panic!("{name}: {wanted:e}"));
            let mut problem = rows::problem(name, row.tolerance);
            problem.method = row.method;
            let accuracy = &problem.accuracy;
            let n = end.len() / 2;
            let absolute = accuracy.q_absolute[..n]
                .iter()
                .chain(&accuracy.v_absolute[..n]);
            let (state, times) = solve(name, &problem);
            assert_eq!(times.len(), reference(name).1.len());
            for ((found, exact), absolute) in state.iter().zip(&end).zip(absolute) {
                let error = (found - exact).abs() / (absolute / row.tolerance + exact.abs());
                assert!(error <= wanted, "{name}: {wanted:e}: {error:e}");
            }
        }
        assert!(
            study.advice(1e-17).is_none(),
            "below the bound of the reference"
        );
    }
}
