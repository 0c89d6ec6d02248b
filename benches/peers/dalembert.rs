//! Our rows of the comparison with other solvers: `cargo bench --bench peers -- [PROBLEM ...]`, or
//! `overhead` for the cost of a step. For a profile `PEERS_DIGITS=6` measures that tolerance alone, 1e-6, and `PEERS_METHOD=Taylor`
//! that method alone.
//!
//! One row a problem, method and tolerance, in the format of `benches/peers/README.md`. Preparation
//! is outside the timed part, as it is for the peers; events are recorded with their times only.

#[path = "overhead.rs"]
mod overhead;

use dalembert::hybrid::{AtLimit, End, Method, Problem, Simulator};
use dalembert::input::{Function, Sine};
use dalembert::model::models;
use dalembert::record::Silent;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

pub const PROBLEMS: [&str; 8] = ["P1", "P2", "P3b", "P4", "P4S", "P5", "free", "plate"];
const METHODS: [Method; 3] = [Method::Auto, Method::Taylor, Method::Radau];

/// Repeats end when both are reached: minima of fewer scatter by more than a few percent.
const REPEATS: usize = 20;
const BUDGET: Duration = Duration::from_millis(100);

/// Whether a trial was asked for: few tolerances and repeats.
fn quick() -> bool {
    std::env::var_os("PEERS_QUICK").is_some()
}

fn main() {
    let named: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    if named == ["overhead"] {
        return overhead::report();
    }
    let only = std::env::var("PEERS_DIGITS").ok();
    let only: Option<i32> = only.map(|digits| digits.parse().expect("PEERS_DIGITS is a number"));
    let method_alone = std::env::var("PEERS_METHOD").ok();
    for name in PROBLEMS {
        if !named.is_empty() && !named.iter().any(|n| n == name) {
            continue;
        }
        for method in METHODS {
            if method_alone
                .as_ref()
                .is_some_and(|alone| format!("{method:?}") != *alone)
            {
                continue;
            }
            if method == Method::Taylor && name == "P4S" {
                // An explicit method: 300 000 steps.
                continue;
            }
            let digits = (3..=13).step_by(if quick() { 3 } else { 1 });
            for digits in digits.filter(|digits| only.is_none_or(|only| only == *digits)) {
                measure(name, method, 10f64.powi(-digits));
            }
        }
    }
}

/// A problem whose events are recorded with their times only.
pub fn plain(name: &str, method: Method, tolerance: f64) -> Problem {
    let mut problem = problem(name, tolerance);
    problem.method = method;
    problem.record.ledger = false;
    problem.record.event_states = false;
    problem
}

fn measure(name: &str, method: Method, tolerance: f64) {
    let problem = plain(name, method, tolerance);
    let mut simulator = Simulator::new(&problem).expect("the initial state fits a mode");
    let (repeats, budget) = match quick() {
        true => (3, Duration::ZERO),
        false => (REPEATS, BUDGET),
    };
    let (mut times, start) = (Vec::new(), Instant::now());
    let mut failed = false;
    while !failed && (times.len() < repeats || start.elapsed() < budget) {
        let start = Instant::now();
        failed = simulator.run(&mut Silent).is_err();
        times.push(start.elapsed().as_secs_f64());
        // A long run needs no repeats.
        if times[0] > 0.2 {
            break;
        }
    }
    times.sort_by(f64::total_cmp);
    let solver = simulator.solver();
    let events = simulator.events().iter();
    let events = events
        .filter(|e| e.transition != "rest")
        .map(|e| e.t.to_string());
    println!(
        "dalembert|{method:?}|{name}|{tolerance:e}|{:e}|{:e}|{}|{}|{}|{}|{}|{}|{}|{}",
        times[0],
        times[times.len() / 2],
        times.len(),
        solver.residual_evaluations,
        solver.jacobian_evaluations,
        solver.steps,
        i32::from(failed),
        simulator.time(),
        join(state(name, &simulator).iter().map(f64::to_string)),
        join(events),
    );
}

fn join(values: impl Iterator<Item = String>) -> String {
    values.collect::<Vec<_>>().join(";")
}

/// The state in the order of the references.
pub fn state(name: &str, simulator: &Simulator) -> Vec<f64> {
    let (q, v) = (simulator.q(), simulator.v());
    match name {
        // The model's angle is measured from the edge on which the block stands.
        "P1" | "P2" => {
            let side = simulator.discrete()[0];
            vec![side * q[0], side * v[0]]
        }
        "P4" | "P4S" => vec![q[0], q[1], v[0], v[1]],
        // The height of the base is held.
        "free" | "plate" => [&q[..3], &v[..3]].concat(),
        _ => vec![q[0], v[0]],
    }
}

/// The block, without the limit states of the model: none of the others looks for them.
fn block(e: f64) -> Problem {
    let mut block = model("hand_block", &[("alpha", 0.25), ("R", 1.5), ("e", e)]);
    for limit in ["past_balance", "overturned"] {
        block
            .set_limit(limit, AtLimit::Ignore)
            .expect("the model has it");
    }
    block
}

/// The problem in our models; the definition is that of `problems.hpp`.
pub fn problem(name: &str, tolerance: f64) -> Problem {
    match name {
        "P1" => {
            let mut p = block(0.9);
            start(&mut p, "theta", 0.6 * 0.25);
            p.end.time = 6.0;
            accuracy(p, tolerance, &[0.2], &[0.5])
        }
        "P2" => {
            let mut p = block(0.85);
            start(&mut p, "theta", 0.3 * 0.25);
            shake(&mut p, Sine::new(-0.35 * 9.81, TAU * 1.5, 0.3));
            p.end.time = 10.0;
            accuracy(p, tolerance, &[0.2], &[0.5])
        }
        "P3b" => {
            let mut p = model("hand_belt", &[("k", 400.0), ("c", 0.1), ("belt", 0.2)]);
            start(&mut p, "x", 0.05);
            p.end.time = 20.0;
            accuracy(p, tolerance, &[0.05], &[0.9])
        }
        "P4" | "P4S" => {
            let stiff = name == "P4S";
            let factor = if stiff { 1e4 } else { 1.0 };
            let spring = [("k", 1.05e6 * factor), ("c", 642.0 * factor)];
            let mut p = model("hand_slider", &spring);
            shake(&mut p, Sine::new(20.0, TAU * 7.0, 0.0));
            p.end.time = 2.0;
            let (d, rate) = if stiff { (8e-8, 3.5e-6) } else { (1e-3, 0.1) };
            accuracy(p, tolerance, &[0.02, d], &[0.9, rate])
        }
        "P5" => {
            let mut p = model("hand_ball", &[]);
            start(&mut p, "h", 1.0);
            p.end = End {
                time: 100.0,
                after: Some(("impact", 30)),
            };
            accuracy(p, tolerance, &[1.0], &[4.4])
        }
        // The scenes tank_free_release.json and tank_full_plate.json, with the model's own scales.
        "free" => {
            let mut p = model("walking_tank", &[]);
            start(&mut p, "theta", 0.02);
            p.end.time = 0.5;
            p.set_tolerance(tolerance);
            p
        }
        "plate" => {
            let mut p = model("walking_tank", &[]);
            shake(&mut p, Sine::new(20.0, TAU * 7.0, 0.0));
            p.end.time = 2.0;
            p.set_tolerance(tolerance);
            p
        }
        _ => unreachable!("problems are those of PROBLEMS"),
    }
}

fn model(name: &str, parameters: &[(&str, f64)]) -> Problem {
    let model = models().find(name);
    let mut problem = Problem::new(&model.expect("the model is linked"));
    for &(name, value) in parameters {
        problem
            .set_parameter(name, value)
            .expect("the model has it");
    }
    problem
}

fn start(problem: &mut Problem, coordinate: &str, value: f64) {
    problem
        .set_initial(coordinate, value)
        .expect("the model has it");
}

fn shake(problem: &mut Problem, sine: Sine) {
    let set = problem.set_input("ground_acceleration", Function::from(sine));
    set.expect("the model has it");
}

/// Relative tolerance, and absolute ones of the tolerance times the scales of the problem.
fn accuracy(mut problem: Problem, tolerance: f64, q: &[f64], v: &[f64]) -> Problem {
    problem.set_tolerance(tolerance);
    for i in 0..q.len() {
        problem.accuracy.q_absolute[i] = tolerance * q[i];
        problem.accuracy.v_absolute[i] = tolerance * v[i];
    }
    problem
}
