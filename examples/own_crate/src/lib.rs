//! A rod on a cart, held upright by a force on the cart that is set a hundred times a second.

#![forbid(unsafe_code)]

use std::error::Error;
use std::path::Path;

use dalembert::hybrid::{Problem, Simulator};
use dalembert::input::{Command, Function};
use dalembert::model::Models;
use dalembert::scene::Scene;

/// Interval of the controller, s.
pub const TICK: f64 = 0.01;

/// Force on the cart, N, for each m, m/s, rad and rad/s of its place, its velocity, the angle and its rate. With the masses
/// and the length of the model all four roots of the linearised motion are −3/s (Ackermann 1972): of
/// s⁴ + (2 k₄/3 − 4 k₂/9) s³ + (2 k₃/3 − 4 k₁/9 − 2 g) s² + 2 g/3 (k₂ s + k₁).
const GAINS: [f64; 4] = [12.3853, 16.5138, 118.6869, 29.0092];

/// The models in the folder `models` of this crate.
pub fn models() -> Models {
    dalembert::models!()
}

/// The problem of `scenes/tilted.json`, with a force that is commanded.
pub fn tilted() -> Result<Problem, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/tilted.json");
    let mut problem = Scene::load(&path, &[], &models())?.problem;
    problem.set_input("force", Function::commanded(0.0))?;
    Ok(problem)
}

/// Runs the controller to the end of a problem. `see` is told the time, the state (place, velocity, angle, its rate) and
/// the force that is held from then on.
pub fn control(
    problem: &Problem,
    mut see: impl FnMut(f64, [f64; 4], f64),
) -> Result<[f64; 4], Box<dyn Error>> {
    let mut simulator = Simulator::new(problem)?;
    let ticks = (problem.end.time / TICK).round() as u32;
    for tick in 1..=ticks {
        let state = state(&mut simulator);
        let force = GAINS.iter().zip(state).map(|(k, x)| k * x).sum();
        see(simulator.time(), state, force);
        simulator.command("force", Command::Hold(force))?;
        simulator.advance_to(f64::from(tick) * TICK)?;
    }
    Ok(state(&mut simulator))
}

fn state(simulator: &mut Simulator) -> [f64; 4] {
    let now = simulator.moment();
    ["x", "x.rate", "phi", "phi.rate"].map(|name| now.state(name).expect("a name of the model"))
}
