//! Throughput of an ensemble in lanes against single runs, on one core: `cargo bench --bench ensemble`.
//!
//! The rocking block on shaken ground of `benches/peers` (P2: 28 impacts in 10 s), each member with a
//! half diagonal of its own. A single run is the fastest of several of each member, prepared before.

use dalembert::hybrid::{Ensemble, Member, Problem, Simulator};
use dalembert::input::{Function, Sine};
use dalembert::kernel::{LANES_OF_LEVELS, MODELS, processor_level};
use dalembert::record::Silent;
use std::time::Instant;

const MEMBERS: usize = 512;

/// Repeats of which the fastest counts.
const REPEATS: usize = 20;

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let pool = pool.build().expect("a thread can be started");
    println!(
        "{:>10}{:>14}{:>7}{:>14}{:>8}{:>9}   largest difference",
        "tolerance", "single / µs", "lanes", "ensemble / µs", "ratio", "impacts"
    );
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
        let problems = problems(tolerance);
        let mut single = 0.0;
        let mut ends = Vec::new();
        for problem in &problems {
            let mut simulator = Simulator::new(problem).expect("it can be started");
            single += fastest(|| simulator.run(&mut Silent).expect("it comes to its end"));
            ends.push((simulator.q()[0], simulator.events().len()));
        }
        let members: Vec<_> = problems.iter().map(Member::from).collect();
        for (level, lanes) in LANES_OF_LEVELS
            .iter()
            .enumerate()
            .take(processor_level() + 1)
        {
            let ensemble = Ensemble::new(&problems[0])
                .expect("it can be started")
                .at_level(level);
            let mut found = Vec::new();
            let together = fastest(|| {
                let run = || ensemble.run(&members, |_, end| (end.q()[0], end.events().len()));
                found = pool.install(run);
            });
            let pairs = || found.iter().zip(&ends);
            assert!(pairs().all(|(a, b)| a.1 == b.1), "the events are the same");
            let difference = pairs().map(|(a, b)| (a.0 - b.0).abs()).fold(0.0, f64::max);
            let impacts: usize = found.iter().map(|end| end.1).sum();
            let each = |seconds: f64| seconds / MEMBERS as f64 * 1e6;
            println!(
                "{tolerance:10.0e}{:14.1}{lanes:7}{:14.1}{:8.2}{:9.1}   {difference:.0e} rad",
                each(single),
                each(together),
                single / together,
                impacts as f64 / MEMBERS as f64
            );
        }
    }
}

/// Members of the ensemble.
fn problems(tolerance: f64) -> Vec<Problem> {
    let model = MODELS.iter().find(|m| m.name == "rocking_block");
    let mut problem = Problem::new(model.expect("the model is there"));
    let shake = Sine::new(-0.35 * 9.81, 3.0 * std::f64::consts::PI, 0.3);
    problem
        .set_input("ground_acceleration", Function::from(shake))
        .expect("the model has the input");
    problem.end.time = 10.0;
    problem.set_tolerance(tolerance);
    problem.accuracy.q_absolute[0] = tolerance * 0.2;
    problem.accuracy.v_absolute[0] = tolerance * 0.5;
    problem.record.ledger = false;
    problem.record.event_states = false;
    let member = |i: usize| {
        let mut own = problem.clone();
        let diagonal = 1.5 + 0.05 * i as f64 / MEMBERS as f64;
        let known = "the model has the parameter";
        for (name, value) in [("alpha", 0.25), ("R", diagonal), ("e", 0.85)] {
            own.set_parameter(name, value).expect(known);
        }
        own.set_initial("theta", 0.075).expect(known);
        own
    };
    (0..MEMBERS).map(member).collect()
}

/// Least time of repeats, s.
fn fastest(mut run: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    };
    (0..REPEATS).map(time).fold(f64::INFINITY, f64::min)
}
