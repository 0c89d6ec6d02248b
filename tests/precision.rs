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

/// The coordinates and velocities that the reference has; the others of the model are held.
fn free<'a>(q: &'a [f64], v: &'a [f64], components: usize) -> impl Iterator<Item = f64> + 'a {
    let n = components / 2;
    q[..n].iter().chain(&v[..n]).copied()
}

/// What a relative tolerance of 1 would allow of each component.
fn sizes(problem: &Problem, end: &[f64]) -> Vec<f64> {
    let accuracy = &problem.accuracy;
    free(&accuracy.q_absolute, &accuracy.v_absolute, end.len())
        .zip(end)
        .map(|(absolute, exact)| absolute / accuracy.relative + exact.abs())
        .collect()
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

                // Each component over its size, since the error of one may be small by luck.
                let (state, times) = solve(name, &problem);
                let parts: Vec<(f64, f64)> = free(&found.q, &found.v, end.len())
                    .zip(state.iter().zip(&end))
                    .zip(sizes(&problem, &end))
                    .map(|((e, (found, exact)), size)| (e / size, (found - exact).abs() / size))
                    .collect();
                let error = largest(parts.iter().map(|part| part.1));
                // The better run is itself off by some of that, and by what rounding grows to.
                let allowed = 0.1 * error + 1e-12;
                for (estimated, error) in &parts {
                    assert!((estimated - error).abs() <= allowed, "{at}: {parts:?}");
                }
                let apart = found.relative - error;
                assert!(apart.abs() <= allowed, "{at}: {error:e} {found:?}");
                let error = largest(times.iter().zip(&events).map(|(a, b)| (a - b).abs()));
                let allowed = 0.1 * error + 1e-12 * problem.end.time;
                let apart = found.event_time - error;
                assert!(apart.abs() <= allowed, "{at}: {error:e} {found:?}");
            }
        }
    }
}

#[test]
fn the_advice_reaches_the_wanted_error() {
    for name in ["P1", "P4"] {
        let (end, events) = reference(name);
        let study = Study::new(&rows::problem(name, 1e-8), &mut Silent, |_, _| ()).unwrap();
        assert!(study.is_complete());
        for wanted in [1e-3, 1e-6, 1e-9] {
            let row = study.advice(wanted).expect("a row reaches it");
            let mut problem = rows::problem(name, row.tolerance);
            problem.method = row.method;
            let (state, times) = solve(name, &problem);
            assert_eq!(times.len(), events.len());
            let errors = state.iter().zip(&end).zip(sizes(&problem, &end));
            let error = largest(errors.map(|((found, exact), size)| (found - exact).abs() / size));
            assert!(error <= wanted, "{name}: {wanted:e}: {error:e}");
        }
        let beyond = study.advice(1e-17);
        assert_eq!(beyond, None, "below the bound of the reference");
    }
}
