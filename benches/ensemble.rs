//! Throughput of ensembles in lanes against single runs, on one core: `cargo bench --bench ensemble`.
//!
//! * `blocks`: the rocking block on shaken ground of `benches/peers` (P2: 28 impacts in 10 s), each
//!   member with a half diagonal of its own.
//! * `oscillators`: the oscillator with dry friction, each member with a damping of its own: 16 stops and slips or so.
//! * `pendulums`: driven pendulums, each with an initial state of its own; no event. Their errors are
//!   against the solutions in `tests/data/forced_pendulum.json`.
//! * `sweep`: oscillators in the order of their friction on one thread and on two.
//!
//! Single runs of some members, prepared before, and the ensemble are timed in turns, so that a clock that
//! changes within seconds is the same for both; the least of all turns counts. With the name of an ensemble
//! only that one is run; with `--rows`, too, plain numbers are printed for the widest lanes and more
//! tolerances: tolerance, time of a trajectory in s, largest error.

use dalembert::hybrid::{Ensemble, Member, Problem, Simulator};
use dalembert::input::{Function, Sine};
use dalembert::kernel::{LANES_OF_LEVELS, processor_level};
use dalembert::model::models;
use dalembert::record::Silent;
use serde_json::Value;
use std::f64::consts::PI;
use std::time::Instant;

const MEMBERS: usize = 512;

/// Members of which single runs are timed.
const SAMPLE: usize = 16;

/// Repeats of which the fastest counts.
const REPEATS: usize = 100;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_wanted = |name: &str| {
        let names = ["blocks", "oscillators", "pendulums", "sweep"];
        let named = arguments.iter().any(|a| names.contains(&a.as_str()));
        !named || arguments.iter().any(|a| a == name)
    };
    let rows = arguments.iter().any(|a| a == "--rows");
    if !rows {
        println!(
            "{:>10}{:>10}{:>12}{:>7}{:>14}{:>8}{:>9}{:>12}{:>10}",
            "ensemble",
            "tolerance",
            "single / µs",
            "lanes",
            "ensemble / µs",
            "ratio",
            "events",
            "difference",
            "error"
        );
    }
    if is_wanted("sweep") && !rows {
        sweep();
    }
    // On the thread of the single runs: another has to be woken, on another core.
    let pool = (rayon::ThreadPoolBuilder::new().num_threads(1)).use_current_thread();
    let pool = pool.build().expect("the thread is in no other pool");
    for name in ["blocks", "oscillators", "pendulums"]
        .into_iter()
        .filter(|name| is_wanted(name))
    {
        for digits in (3..=14).step_by(if rows { 1 } else { 3 }) {
            let tolerance = 10f64.powi(-digits);
            let problems = match name {
                "blocks" => blocks(tolerance),
                "oscillators" => oscillators(tolerance),
                _ => pendulums(tolerance),
            };
            compare(&pool, name, tolerance, &problems, rows);
        }
    }
}

/// Runs an ensemble in lanes and its members one by one, and prints what it took.
fn compare(pool: &rayon::ThreadPool, name: &str, tolerance: f64, problems: &[Problem], rows: bool) {
    let each = |seconds: f64| seconds / MEMBERS as f64;
    let prepared = |problem| Simulator::new(problem).expect("it can be started");
    let run = |simulator: &mut Simulator| {
        simulator.run(&mut Silent).expect("it comes to its end");
    };
    let mut ends = Vec::new();
    for problem in problems.iter().filter(|_| !rows) {
        let mut simulator = prepared(problem);
        run(&mut simulator);
        ends.push((simulator.q()[0], simulator.events().len()));
    }
    let sample = problems.iter().step_by(MEMBERS / SAMPLE).filter(|_| !rows);
    let mut singles: Vec<_> = sample.map(|p| (prepared(p), f64::INFINITY)).collect();
    let members: Vec<_> = problems.iter().map(Member::from).collect();
    let levels = LANES_OF_LEVELS.iter().enumerate();
    for (level, lanes) in levels.take(processor_level() + 1) {
        if rows && level < processor_level() {
            continue;
        }
        let ensemble = Ensemble::new(&problems[0]).expect("it can be started");
        let ensemble = ensemble.at_level(level);
        let mut found = Vec::new();
        let mut together = f64::INFINITY;
        for _ in 0..REPEATS {
            for (simulator, least) in &mut singles {
                // The second has its memory at hand.
                for _ in 0..2 {
                    *least = least.min(time(|| run(simulator)));
                }
            }
            let run = || {
                ensemble.run(&members, |_, end| {
                    ([end.q()[0], end.v()[0]], end.events().len())
                })
            };
            together = together.min(time(|| found = pool.install(run)));
        }
        let single = singles.iter().map(|(_, least)| least).sum::<f64>() / singles.len() as f64;
        let error = match name {
            "pendulums" => Some(error(&found.iter().map(|end| end.0).collect::<Vec<_>>())),
            _ => None,
        };
        if rows {
            let error = error.expect("the ensemble has a reference");
            println!("{tolerance:e} {:e} {error:e}", each(together));
            continue;
        }
        let pairs = || found.iter().zip(&ends);
        assert!(pairs().all(|(a, b)| a.1 == b.1), "the events are the same");
        let difference = pairs()
            .map(|(a, b)| (a.0[0] - b.0).abs())
            .fold(0.0, f64::max);
        let events: usize = found.iter().map(|end| end.1).sum();
        println!(
            "{name:>10}{tolerance:10.0e}{:12.1}{lanes:7}{:14.1}{:8.2}{:9.1}{difference:12.0e}{:>10}",
            single * 1e6,
            each(together) * 1e6,
            single / each(together),
            events as f64 / MEMBERS as f64,
            error.map_or("–".into(), |error| format!("{error:.1e}"))
        );
    }
}

/// A sweep in the order of the friction: the first oscillators slide, the last are held, so that its halves last unequally.
fn sweep() {
    let mut problems = oscillators(1e-8);
    for (i, problem) in problems.iter_mut().enumerate() {
        let friction = 1.5 * i as f64 / MEMBERS as f64;
        for name in ["kinetic_friction", "static_friction"] {
            problem
                .set_parameter(name, friction)
                .expect("the model has it");
        }
    }
    let members: Vec<_> = problems.iter().map(Member::from).collect();
    let ensemble = Ensemble::new(&problems[0]).expect("it can be started");
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [1, 2].map(|threads| pool(threads).expect("threads can be started"));
    let mut least = [f64::INFINITY; 2];
    for _ in 0..REPEATS {
        for (pool, least) in pools.iter().zip(&mut least) {
            let run = || ensemble.run(&members, |_, end| end.q()[0]);
            *least = least.min(time(|| {
                pool.install(run);
            }));
        }
    }
    let [one, two] = least.map(|seconds| seconds * 1e3);
    println!(
        "sweep over friction, 512 members: {one:.2} ms on one thread, {two:.2} ms on two, {:.2} times as fast",
        one / two
    );
}

fn model(name: &str) -> Problem {
    let model = models().find(name);
    let mut problem = Problem::new(&model.expect("the model is there"));
    problem.end.time = 10.0;
    problem.record.ledger = false;
    problem.record.event_states = false;
    problem
}

fn blocks(tolerance: f64) -> Vec<Problem> {
    let mut problem = model("rocking_block");
    let shake = Sine::new(-0.35 * 9.81, 3.0 * PI, 0.3);
    problem
        .set_input("ground_acceleration", Function::from(shake))
        .expect("the model has the input");
    problem.set_tolerance(tolerance);
    problem.accuracy.q_absolute[0] = tolerance * 0.2;
    problem.accuracy.v_absolute[0] = tolerance * 0.5;
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

fn oscillators(tolerance: f64) -> Vec<Problem> {
    let mut problem = model("coulomb_oscillator");
    let known = "the model has it";
    for (name, value) in [("static_friction", 0.5), ("kinetic_friction", 0.3)] {
        problem.set_parameter(name, value).expect(known);
    }
    problem.end.time = 60.0;
    problem.set_tolerance(tolerance);
    let force = Sine::new(1.1, 0.5, 0.0);
    let force = Function::from(force);
    problem.set_input("force", force).expect(known);
    let member = |i: usize| {
        let mut own = problem.clone();
        let damping = 0.1 * i as f64 / MEMBERS as f64;
        own.set_parameter("c", damping).expect(known);
        own
    };
    (0..MEMBERS).map(member).collect()
}

fn pendulums(tolerance: f64) -> Vec<Problem> {
    let mut problem = model("forced_pendulum");
    let known = "the model has it";
    problem.set_parameter("g", 4.84).expect(known);
    let drive = Sine::new(1.0, 3.0 * PI, 0.0);
    problem
        .set_input("moment", Function::from(drive))
        .expect(known);
    problem.set_tolerance(tolerance);
    problem.accuracy.q_absolute[0] = tolerance;
    problem.accuracy.v_absolute[0] = tolerance;
    let member = |i: usize| {
        let mut own = problem.clone();
        let (angle, rate) = (
            i as f64 * 0.6180339887498949 % 1.0,
            i as f64 * 0.41421356237309515 % 1.0,
        );
        own.set_initial("theta", 3.0 * angle - 1.5).expect(known);
        own.set_initial("theta.rate", 2.0 * rate - 1.0)
            .expect(known);
        own
    };
    (0..MEMBERS).map(member).collect()
}

/// Largest error of the pendulums whose solution is known, rad and rad/s.
fn error(ends: &[[f64; 2]]) -> f64 {
    let text = include_str!("../tests/data/forced_pendulum.json");
    let reference: Value = serde_json::from_str(text).expect("the reference is JSON");
    let members = reference["members"].as_array().expect("it has members");
    let errors = members.iter().flat_map(|member| {
        let end = ends[member["member"].as_u64().expect("it has a number") as usize];
        let exact = member["end"].as_array().expect("it has an end");
        let exact = exact.iter().filter_map(|x| x.as_str()?.parse::<f64>().ok());
        end.into_iter()
            .zip(exact)
            .map(|(x, exact)| (x - exact).abs())
    });
    errors.fold(0.0, f64::max)
}

/// Duration of a run, s.
fn time(run: impl FnOnce()) -> f64 {
    let start = Instant::now();
    run();
    start.elapsed().as_secs_f64()
}
