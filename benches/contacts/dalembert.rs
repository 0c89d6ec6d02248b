//! Our rows of the comparison of contacts and constraints: `cargo bench --bench contacts`.
//!
//! One line a problem, method and tolerance, in the format of `results.csv`. Preparation is outside the timed part; the largest
//! penetration is that of another run, which is recorded.

use dalembert::hybrid::{Method, Problem, Simulator, simulate};
use dalembert::input::Sine;
use dalembert::model::models;
use dalembert::record::Silent;
use serde_json::Value;
use std::time::Instant;

/// Runs of which the fastest counts.
const REPEATS: usize = 20;

fn main() {
    for name in ["block", "stack", "linkage"] {
        for method in [Method::Taylor, Method::Radau] {
            for digits in (2..=12).step_by(2) {
                measure(name, method, 10f64.powi(-digits));
            }
        }
    }
}

fn measure(name: &str, method: Method, tolerance: f64) {
    let mut problem = problem(name);
    problem.method = method;
    problem.set_tolerance(tolerance);
    problem.record.every = Some(1e-3);
    problem.record.columns.outputs = true;
    let run = simulate(&problem, &mut Silent).expect("the initial state fits a mode");
    let setting = format!("{method:?} tolerance {tolerance:.0e}");
    if let Some(failure) = run.failure {
        eprintln!("{name}, {setting}: {}", failure.reason);
        return;
    }
    let layout = &run.layout;
    let gaps: Vec<usize> = (["left.gap", "right.gap"].iter())
        .filter_map(|name| run.trajectory.column(name))
        .collect();
    let rows = 0..run.trajectory.len();
    let deepest = rows.fold(0.0_f64, |deepest, k| {
        let row = run.trajectory.row(k);
        let opens = match name {
            "linkage" => joints(row).fold(0.0, f64::max),
            _ => gaps.iter().fold(0.0, |d, &i| f64::max(d, -row[i])),
        };
        deepest.max(opens)
    });
    assert!(name != "block" || gaps.len() == 2, "{layout:?}");
    problem.record.every = None;
    problem.record.columns.outputs = false;
    problem.record.ledger = false;
    problem.record.event_states = false;
    let mut simulator = Simulator::new(&problem).expect("it has run");
    let mut fastest = f64::INFINITY;
    for _ in 0..REPEATS {
        let start = Instant::now();
        simulator.run(&mut Silent).expect("it has run");
        fastest = fastest.min(start.elapsed().as_secs_f64());
    }
    let exact = reference(name);
    let q = simulator.q();
    // Of the linkage the place of the first moving pin.
    let places = match name {
        "linkage" => vec![q[0].cos(), q[0].sin()],
        _ => q.to_vec(),
    };
    let off = (places.iter().zip(&exact)).map(|(q, exact)| (q - exact).abs());
    let error = off.fold(0.0, f64::max);
    let events = simulator.events().len();
    println!("{name},dalembert,{setting},{error:.1e},{fastest:.3e},{deepest:.1e},{events}");
}

/// The problems of `problems.py`.
fn problem(name: &str) -> Problem {
    let of = |model: &str, parameters: &[(&str, f64)]| {
        let mut problem = Problem::new(&models().find(model).expect("the model exists"));
        for (name, value) in parameters {
            problem.set_parameter(name, *value).expect("a parameter");
        }
        problem
    };
    if name == "block" {
        let given = [("b", 0.2), ("h", 0.4), ("mu_s", 0.55), ("mu_k", 0.55)];
        let mut block = of("rigid_block", &given);
        block
            .set_input("a_h", Sine::new(12.0, 16.0, 0.0).into())
            .expect("an input");
        block
            .set_input("a_v", Sine::new(3.0, 20.0, 0.7).into())
            .expect("an input");
        for (coordinate, place) in [("x", 0.2), ("y", 0.4)] {
            block.set_initial(coordinate, place).expect("a coordinate");
        }
        block.end.time = 2.0;
        return block;
    }
    if name == "linkage" {
        let mut linkage = of("double_four_bar", &[]);
        for crank in ["crank_1", "crank_2", "crank_3"] {
            let rate = format!("{crank}.rate");
            for (quantity, value) in [(crank, std::f64::consts::FRAC_PI_2), (&rate, -1.0)] {
                linkage.set_initial(quantity, value).expect("a coordinate");
            }
        }
        linkage.project = true;
        linkage.end.time = 10.0;
        return linkage;
    }
    let mut stack = of("stacked_friction", &[]);
    stack
        .set_input("a_g", Sine::new(6.0, 7.0, 0.0).into())
        .expect("an input");
    stack.end.time = 3.0;
    stack
}

/// How far the joints of the linkage are apart, m: each from the coupler's end to the crank's, along both axes.
fn joints(q: &[f64]) -> impl Iterator<Item = f64> {
    (0..2).flat_map(move |k| {
        let (crank, next, coupler) = (q[k].sin_cos(), q[k + 1].sin_cos(), q[3 + k].sin_cos());
        let across = crank.1 + coupler.1 - 1.0 - next.1;
        let up = crank.0 + coupler.0 - next.0;
        [across.abs(), up.abs()]
    })
}

/// The coordinates at the end.
fn reference(name: &str) -> Vec<f64> {
    let data = |file: &str| -> Value {
        let path = format!("{}/tests/data/{file}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a file");
        serde_json::from_str(&text).expect("JSON")
    };
    let numbers = |of: &Value| -> Vec<f64> {
        let all = of.as_array().expect("a list").iter();
        all.map(|text| text.as_str().expect("a text").parse().expect("a number"))
            .collect()
    };
    if name == "linkage" {
        let data = data("14b_n_four_bar");
        let all = data["reference"].as_array().expect("a list");
        let last = all.iter().find(|r| r["N"] == 2 && r["t"] == "10.0");
        return numbers(&last.expect("the end of the run")["B0"]);
    }
    let (file, scene) = match name {
        "block" => ("13c_block_forced", "rock, slide and slide-rock"),
        _ => (
            "15a_two_block_stack",
            "big sticks, small slips first (mu_top<mu_table)",
        ),
    };
    let data = data(file);
    let scene = &data["scenes"][scene];
    let end = match name {
        "block" => &scene["final"]["q"],
        _ => &scene["samples"]
            .as_array()
            .and_then(|all| all.last())
            .expect("a sample")["q"],
    };
    numbers(end)
}
