//! Rows of the Rust crates diffsol and `ivp`: `peers CRATE [PROBLEM ...]`; see `../README.md`.

mod diffsol_rows;
mod ivp_rows;
mod problems;

use problems::Problem;
use std::time::{Duration, Instant};

/// What a run has found.
#[derive(Default)]
struct Run {
    time: f64,
    y: Vec<f64>,
    events: Vec<f64>,
    steps: usize,
    status: i32,
}

impl Run {
    /// More than any method that suits its problem needs.
    const MOST_STEPS: usize = 3_000_000;

    /// Whether the run does not end by itself: no problem has so many events.
    fn runaway(&mut self) -> bool {
        if self.events.len() > 1000 || self.steps > Self::MOST_STEPS {
            self.status = -1000;
        }
        self.status != 0
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (peer, named) = arguments.split_first().expect("the name of a crate");
    let quick = std::env::var_os("PEERS_QUICK").is_some();
    for problem in Problem::all() {
        if !named.is_empty() && !named.iter().any(|name| name == problem.name()) {
            continue;
        }
        let stiff = problem.name() == "P4S";
        for digits in (3..=13).step_by(if quick { 3 } else { 1 }) {
            let tolerance = 10f64.powi(-digits);
            match peer.as_str() {
                "diffsol" => diffsol_rows::rows(&problem, tolerance, stiff),
                "ivp" => ivp_rows::rows(&problem, tolerance, stiff),
                other => panic!("no crate `{other}`"),
            }
        }
    }
}

/// Runs again and again, and prints a row.
fn measure(
    peer: &str,
    method: &str,
    problem: &Problem,
    tolerance: f64,
    mut work: impl FnMut(&mut Run),
) {
    let quick = std::env::var_os("PEERS_QUICK").is_some();
    let (repeats, budget) = if quick { (3, 10) } else { (10, 80) };
    let (mut run, mut times, begin) = (Run::default(), Vec::new(), Instant::now());
    while times.len() < repeats || begin.elapsed() < Duration::from_millis(budget) {
        run = Run::default();
        let start = Instant::now();
        work(&mut run);
        times.push(start.elapsed().as_secs_f64());
        if times[0] > 0.2 || run.status != 0 {
            break;
        }
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{peer}|{method}|{}|{tolerance:e}|{:e}|{:e}|{}|{}|{}|{}|{}|{}|{}|{}",
        problem.name(),
        times[0],
        times[times.len() / 2],
        times.len(),
        problem.rhs_calls.get(),
        problem.jacobian_calls.get(),
        run.steps,
        run.status,
        run.time,
        join(&run.y),
        join(&run.events),
    );
}

fn join(values: &[f64]) -> String {
    let texts: Vec<_> = values.iter().map(f64::to_string).collect();
    texts.join(";")
}
