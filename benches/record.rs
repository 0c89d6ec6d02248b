//! A rocking block under a record of 4,000 samples, on one core: `cargo bench --bench record`.
//!
//! A bare loop (the series of θ to order 8 in every piece, no event, no error control), single runs and runs in lanes are
//! timed in turns, so that a clock that changes within seconds is the same for all; the least of all turns counts. The bare
//! loop knows no edges: it goes on with one equation. The error is that of θ at the end, against a run at
//! the tightest tolerance.

use dalembert::hybrid::{Ensemble, Member, Problem, Simulator};
use dalembert::input::{Interpolation, Outside, Table};
use dalembert::kernel::processor_level;
use dalembert::model::models;
use dalembert::record::Silent;
use std::time::Instant;

/// Samples and their step, s.
const SAMPLES: usize = 4_000;
const STEP: f64 = 0.005;

/// Of the block: half diagonal (m), angle (rad), restitution, gravity (m/s²), and the uplift that it starts with: it
/// rocks to the end.
const R: f64 = 2.0;
const ALPHA: f64 = 0.25;
const E: f64 = 0.98;
const G: f64 = 9.81;
const START: f64 = 0.1;

const MEMBERS: usize = 64;
const REPEATS: usize = 30;

fn main() {
    let samples = samples();
    let pool = (rayon::ThreadPoolBuilder::new().num_threads(1)).use_current_thread();
    let pool = pool.build().expect("the thread is in no other pool");
    let run = |simulator: &mut Simulator| simulator.run(&mut Silent).expect("it comes to its end");
    let exact = {
        let problem = problem(&samples, 1e-14);
        let mut simulator = Simulator::new(&problem).expect("it can be started");
        run(&mut simulator);
        println!("{} landings", simulator.events().len());
        simulator.q()[0]
    };
    println!(
        "{:>10}{:>12}{:>12}{:>8}{:>12}{:>8}{:>8}{:>10}",
        "tolerance", "bare / µs", "single / µs", "ratio", "lanes / µs", "ratio", "steps", "error"
    );
    for tolerance in [1e-3, 1e-6, 1e-8, 1e-10, 1e-12] {
        let problem = problem(&samples, tolerance);
        let mut simulator = Simulator::new(&problem).expect("it can be started");
        let ensemble = Ensemble::new(&problem).expect("it can be started");
        let ensemble = ensemble.at_level(processor_level());
        let members: Vec<_> = (0..MEMBERS).map(|_| Member::from(&problem)).collect();
        let [mut bare, mut single, mut together] = [f64::INFINITY; 3];
        for _ in 0..REPEATS {
            bare = bare.min(time(|| {
                std::hint::black_box(bare_loop(std::hint::black_box(&samples)));
            }));
            single = single.min(time(|| {
                run(&mut simulator);
            }));
            let lanes = time(|| {
                pool.install(|| ensemble.run(&members, |_, end| end.q()[0]));
            });
            together = together.min(lanes / MEMBERS as f64);
        }
        println!(
            "{tolerance:10.0e}{:12.1}{:12.1}{:8.2}{:12.1}{:8.2}{:8}{:10.1e}",
            bare * 1e6,
            single * 1e6,
            single / bare,
            together * 1e6,
            together / bare,
            simulator.solver().steps,
            (simulator.q()[0] - exact).abs()
        );
    }
}

/// Accelerations of the ground, m/s²: sums of sines whose frequencies have no common measure.
fn samples() -> Vec<f64> {
    let sine = |t: f64, k: f64| (t * k * 2.0f64.sqrt() + k).sin() / k;
    let at = |t: f64| (1..=20).map(|k| sine(t, f64::from(k) * 1.7)).sum::<f64>();
    (0..SAMPLES).map(|i| 0.05 * at(i as f64 * STEP)).collect()
}

fn problem(samples: &[f64], tolerance: f64) -> Problem {
    let model = models().find("rocking_block").expect("it is in models/");
    let mut problem = Problem::new(&model);
    let times: Vec<f64> = (0..SAMPLES).map(|i| i as f64 * STEP).collect();
    let table = Table::new(&times, samples, Interpolation::Linear, Outside::Zero);
    let table = table.expect("the samples make a table");
    problem
        .set_input("ground_acceleration", table.into())
        .expect("the model has it");
    for (name, value) in [("alpha", ALPHA), ("R", R), ("e", E), ("g", G)] {
        problem
            .set_parameter(name, value)
            .expect("the model has it");
    }
    problem
        .set_initial("theta", START)
        .expect("the model has it");
    problem.end.time = (SAMPLES - 1) as f64 * STEP;
    problem.set_tolerance(tolerance);
    problem.record.ledger = false;
    problem.record.event_states = false;
    problem.record.extremes = false;
    problem
}

/// Order of the accelerations in the bare loop.
const ORDER: usize = 8;

/// 1/k.
const INVERSES: [f64; ORDER + 3] = {
    let mut inverses = [0.0; ORDER + 3];
    let mut k = 1;
    while k < inverses.len() {
        inverses[k] = 1.0 / k as f64;
        k += 1;
    }
    inverses
};

/// The series of φ = α − θ in a piece of the record.
struct Piece {
    /// Acceleration of the ground and its rate.
    ground: [f64; 2],
    phi: [f64; ORDER + 3],
    /// k φₖ.
    rates: [f64; ORDER + 3],
    sin: [f64; ORDER + 1],
    cos: [f64; ORDER + 1],
}

impl Piece {
    /// The next order: the compiler knows which, so its sums are written out.
    #[inline(always)]
    fn order<const K: usize>(&mut self) {
        if K > 0 {
            let (mut sin, mut cos) = (0.0, 0.0);
            for j in 1..=K {
                sin += self.rates[j] * self.cos[K - j];
                cos -= self.rates[j] * self.sin[K - j];
            }
            (self.sin[K], self.cos[K]) = (sin * INVERSES[K], cos * INVERSES[K]);
        }
        let later = if K > 0 { self.cos[K - 1] } else { 0.0 };
        let shaken = self.ground[0] * self.cos[K] + self.ground[1] * later;
        let a = 0.75 / R * (G * self.sin[K] - shaken);
        self.rates[K + 2] = a * INVERSES[K + 1];
        self.phi[K + 2] = self.rates[K + 2] * INVERSES[K + 2];
    }
}

/// θ and its rate at the end: θ'' = −(3/4R) (g sin(α − θ) − a cos(α − θ)), by the recurrences of sine and cosine, to
/// order 8 in every piece.
fn bare_loop(samples: &[f64]) -> [f64; 2] {
    let (mut theta, mut rate) = (START, 0.0);
    for pair in samples.windows(2) {
        let mut piece = Piece {
            ground: [pair[0], (pair[1] - pair[0]) / STEP],
            phi: [0.0; ORDER + 3],
            rates: [0.0; ORDER + 3],
            sin: [0.0; ORDER + 1],
            cos: [0.0; ORDER + 1],
        };
        (piece.phi[0], piece.phi[1], piece.rates[1]) = (ALPHA - theta, -rate, -rate);
        (piece.sin[0], piece.cos[0]) = piece.phi[0].sin_cos();
        piece.order::<0>();
        piece.order::<1>();
        piece.order::<2>();
        piece.order::<3>();
        piece.order::<4>();
        piece.order::<5>();
        piece.order::<6>();
        piece.order::<7>();
        piece.order::<8>();
        let value = |of: &[f64]| of.iter().rev().fold(0.0, |sum, c| sum * STEP + c);
        (theta, rate) = (ALPHA - value(&piece.phi), -value(&piece.rates[1..]));
    }
    [theta, rate]
}

/// Duration of a run, s.
fn time(run: impl FnOnce()) -> f64 {
    let start = Instant::now();
    run();
    start.elapsed().as_secs_f64()
}
