//! A forced oscillation that just reaches a stop (tests/data/07_grazing.json).

use crate::common::*;
use dalembert::input::{Function, Sine};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Number of impacts in three cycles of the steady motion of a linear oscillator with stops.
fn impacts(case: &serde_json::Value, excess: f64) -> usize {
    let (omega, zeta) = (number(&case["omega"]), number(&case["zeta"]));
    let grazing = number(&case["F_graz"]);
    let parameters = [
        ("c", 2.0 * zeta),
        ("static_friction", 0.0),
        ("kinetic_friction", 0.0),
        ("stop", number(&case["sigma"])),
    ];
    let mut problem = problem("hand_coulomb", &parameters);
    // F cos(ωt + φ) gives x = x₀ cos(ωt + φ − lag): φ = lag + π/2 starts at x = 0, moving down.
    let phase = number(&case["phase_lag"]) + FRAC_PI_2;
    let force = Sine::new(grazing * (1.0 + excess), omega, phase + FRAC_PI_2);
    problem.set_input("force", Function::from(force)).unwrap();
    problem
        .set_initial("x.rate", -omega * (1.0 + excess))
        .unwrap();
    problem.set_initial("slip", -1.0).unwrap();
    tighten(&mut problem, 1e-2);
    problem.end.time = 3.0 * TAU / omega + 0.1 * PI;
    times(&run(&problem), "impact").len()
}

#[test]
fn the_steady_motion_reaches_the_stops_at_the_grazing_force() {
    with_each_method(|| {
        let reference = reference("07_grazing");
        for case in reference["reference"]["grazing"].as_array().unwrap() {
            assert_eq!(impacts(case, -1e-12), 0, "{case}");
            assert!(impacts(case, 1e-12) > 0, "{case}");
        }
    });
}
