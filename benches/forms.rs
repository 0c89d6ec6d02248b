//! A run by contacts against the same by modes written by hand: `cargo bench --bench forms`.
//!
//! The shipped models against those of `tests/models/hand_*`, one core, in turns, the least of repeats. Where gaps and slips are
//! coordinates contacts have the reduced form, with modes of their own: the aim is 1.2 times the time by hand. The last ones hold
//! contacts by multipliers: the aim is 3 times. Runs record nothing but their events.

use dalembert::hybrid::{Problem, Simulator};
use dalembert::input::Sine;
use dalembert::model::models;
use dalembert::record::Silent;
use dalembert::scene::Scene;
use std::f64::consts::PI;
use std::path::Path;
use std::time::Instant;

/// Repeats of which the fastest counts; more do not change the second digit of the ratios.
const REPEATS: usize = 200;
const TOLERANCES: [f64; 3] = [1e-4, 1e-8, 1e-12];

/// What is run, by contacts, by hand, and how: parameters, initial values, an input, its sine, and the end, s.
struct Pair {
    contacts: &'static str,
    hand: &'static str,
    parameters: &'static [(&'static str, f64)],
    initial: &'static [(&'static str, f64)],
    input: Option<(&'static str, [f64; 3])>,
    end: f64,
}

const BELT: Pair = Pair {
    contacts: "belt_oscillator",
    hand: "hand_belt",
    parameters: &[("mu_s", 0.1), ("mu_k", 0.05), ("belt", 0.5)],
    // It begins sticking: no direction of slip has to be given.
    initial: &[("x.rate", 0.5)],
    input: Some(("force", [0.7, 1.3, 0.2])),
    end: 40.0,
};

const PAIRS: [Pair; 8] = [
    Pair {
        contacts: "bouncing_ball",
        hand: "hand_ball",
        parameters: &[],
        initial: &[("h", 1.0)],
        input: None,
        end: 5.0,
    },
    Pair {
        contacts: "vibrating_table_ball",
        hand: "hand_table_ball",
        parameters: &[],
        initial: &[],
        input: Some(("table_acceleration", [1.2 * 9.81, 20.0 * PI, 0.0])),
        end: 2.0,
    },
    BELT,
    Pair {
        contacts: "coulomb_oscillator",
        hand: "hand_coulomb",
        parameters: &[("static_friction", 0.15), ("stop", 0.8), ("e", 0.5)],
        initial: &[],
        input: Some(("force", [1.4, 0.6, PI / 5.0])),
        end: 60.0,
    },
    Pair {
        contacts: "sliding_oscillator",
        hand: "hand_slider",
        parameters: &[],
        initial: &[],
        input: Some(("ground_acceleration", [20.0, 14.0 * PI, 0.0])),
        end: 2.0,
    },
    Pair {
        contacts: "rocking_block",
        hand: "hand_block",
        parameters: &[("R", 1.5), ("e", 0.85)],
        initial: &[("theta", 0.075)],
        input: Some(("ground_acceleration", [-0.35 * 9.81, 3.0 * PI, 0.3])),
        end: 10.0,
    },
    // A line that solves for a coordinate; it begins rolling.
    Pair {
        contacts: "rolling_wheel",
        hand: "hand_wheel",
        parameters: &[],
        initial: &[("phi.rate", 1.0)],
        input: Some(("moment", [9.0, 2.0, 0.0])),
        end: 20.0,
    },
    // By multipliers.
    Pair {
        contacts: "held_belt",
        ..BELT
    },
];

/// Scenes of the tank, whose edges have multipliers too.
const TANKS: [&str; 3] = [
    "tank_free_release",
    "tank_doughnut",
    "tank_rocks_and_slides",
];

fn main() {
    println!(
        "{:24}{:>12}{:>14}{:>12}{:>8}",
        "model", "tolerance", "contacts / µs", "hand / µs", "ratio"
    );
    for pair in &PAIRS {
        for tolerance in TOLERANCES {
            let problems = [pair.contacts, pair.hand].map(|name| problem(pair, name, tolerance));
            compare(pair.contacts, tolerance, problems);
        }
    }
    for name in TANKS {
        for tolerance in TOLERANCES {
            let problems = ["contacts", "modes"].map(|edges| tank(name, edges, tolerance));
            compare(name, tolerance, problems);
        }
    }
}

/// Runs a problem by contacts and the same by hand in turns, and prints the times.
fn compare(name: &str, tolerance: f64, problems: [Problem; 2]) {
    let mut simulators = problems
        .each_ref()
        .map(|problem| Simulator::new(problem).expect("it can be started"));
    let mut least = [f64::INFINITY; 2];
    for _ in 0..REPEATS {
        for (simulator, least) in simulators.iter_mut().zip(&mut least) {
            let start = Instant::now();
            simulator.run(&mut Silent).expect("it comes to its end");
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    let [contacts, hand] = least.map(|seconds| 1e6 * seconds);
    println!(
        "{name:24}{tolerance:12.0e}{contacts:14.1}{hand:12.1}{:8.2}",
        contacts / hand
    );
}

/// A shipped scene of the tank, on two edges by contacts or by modes, under a landing that both have.
fn tank(name: &str, edges: &str, tolerance: f64) -> Problem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.json"));
    let chosen = [format!("edges={edges}"), "landing=momenta".into()];
    let scene = Scene::load(&path, &chosen, models());
    let mut problem = scene.unwrap_or_else(|errors| panic!("{errors}")).problem;
    problem.record.columns.energies = false;
    problem.record.extremes = false;
    silent(&mut problem, tolerance);
    problem
}

/// A tolerance, and nothing that is recorded but events.
fn silent(problem: &mut Problem, tolerance: f64) {
    problem.set_tolerance(tolerance);
    problem.record.every = Some(f64::MAX);
    problem.record.ledger = false;
    problem.record.event_states = false;
}

fn problem(pair: &Pair, name: &str, tolerance: f64) -> Problem {
    let model = models().find(name).expect("the model is linked");
    let mut problem = Problem::new(&model);
    for &(parameter, value) in pair.parameters {
        let set = problem.set_parameter(parameter, value);
        set.expect("the model has it");
    }
    for &(what, value) in pair.initial {
        problem.set_initial(what, value).expect("the model has it");
    }
    if name == "rolling_wheel" {
        // What rolls with it.
        for (what, value) in [("x.rate", 0.3), ("psi.rate", 2.5)] {
            problem.set_initial(what, value).expect("the model has it");
        }
    }
    if let Some((input, [amplitude, frequency, phase])) = pair.input {
        let set = problem.set_input(input, Sine::new(amplitude, frequency, phase).into());
        set.expect("the model has it");
    }
    silent(&mut problem, tolerance);
    problem.end.time = pair.end;
    problem
}
