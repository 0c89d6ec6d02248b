//! Helpers of the tests that simulate.
#![allow(dead_code)] // each test file uses some of them

pub mod random;

use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::model::models;
use dalembert::record::{Run, Silent};
use serde_json::Value;
use std::cell::Cell;

/// The tightest tolerance that the method takes: ten roundings.
pub const TIGHTEST: f64 = 10.0 * f64::EPSILON;

/// Sets the tightest tolerances for a motion of the given size, in the units of its coordinates and
/// rates.
pub fn tighten(problem: &mut Problem, size: f64) {
    let accuracy = &mut problem.accuracy;
    accuracy.relative = TIGHTEST;
    accuracy.q_absolute.fill(TIGHTEST * size);
    accuracy.v_absolute.fill(TIGHTEST * size);
}

thread_local! {
    static METHOD: Cell<Method> = Cell::default();
}

/// Runs a test with each method of integration: `problem` makes problems that use it.
pub fn with_each_method(test: impl Fn()) {
    for method in [Method::Radau, Method::Taylor] {
        println!("method: {method:?}"); // is shown with a failure
        METHOD.set(method);
        test();
    }
}

/// A problem of a model by name, with the given parameters.
pub fn problem(model: &str, parameters: &[(&str, f64)]) -> Problem {
    let model = models().find(model).expect("the model exists");
    let mut problem = Problem::new(&model);
    problem.method = METHOD.get();
    for (name, value) in parameters {
        problem.set_parameter(name, *value).unwrap();
    }
    problem
}

/// Runs a problem that must reach its end.
pub fn run(problem: &Problem) -> Run {
    let run = simulate(problem, &mut Silent).expect("the problem can be started");
    assert_eq!(run.failure, None);
    run
}

/// Reference values: a file of tests/data, copied from the independent reference set.
pub fn reference(file: &str) -> Value {
    let path = format!("{}/tests/data/{file}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A number written as a decimal string.
pub fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

/// A list of numbers written as decimal strings.
pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// Times of the events with the given transition.
pub fn times(run: &Run, transition: &str) -> Vec<f64> {
    run.events
        .iter()
        .filter(|e| e.transition == transition)
        .map(|e| e.t)
        .collect()
}

/// Value of a coordinate, rate, discrete state or output at the end of a run.
pub fn at_end(run: &Run, name: &str) -> f64 {
    let layout = &run.layout;
    let state = &run.end.state;
    let find = |names: &[dalembert::record::Quantity], values: &[f64]| {
        names.iter().position(|q| q.name == name).map(|i| values[i])
    };
    find(&layout.coordinates, &state.q)
        .or_else(|| find(&layout.velocities, &state.v))
        .or_else(|| find(&layout.discretes, &state.discrete))
        .or_else(|| find(&layout.outputs, &state.outputs))
        .unwrap_or_else(|| panic!("no `{name}`"))
}

/// Index of a mode of the problem's variant.
pub fn mode(problem: &Problem, name: &str) -> usize {
    let mut modes = problem.variant().modes.iter();
    modes.position(|m| m.name == name).expect("the mode exists")
}

/// Names of the transitions of a run, in their order.
pub fn transitions(run: &Run) -> Vec<&'static str> {
    run.events.iter().map(|e| e.transition).collect()
}

/// A slider x = a cos 2t that an input pulls upwards by p sin 3t, for 1.9 s.
pub fn lifted_slider(a: f64, p: f64, relative: f64) -> Problem {
    let mut slider = problem("lifted_slider", &[("lift", p)]);
    slider.set_initial("x", a).unwrap();
    let pull = dalembert::input::Sine::new(1.0, 3.0, 0.0);
    slider.set_input("pull", pull.into()).unwrap();
    slider.set_tolerance(relative);
    slider.end.time = 1.9;
    slider
}
