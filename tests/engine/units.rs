//! Units of length, mass and time are arbitrary: a change of units changes rounding at most, and
//! one by powers of two no bit.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use dalembert::record::{Run, Snapshot};
use std::f64::consts::TAU;

/// What a metre, a kilogram and a second are in the new units.
type Units = [f64; 3];

/// Value of a unit such as `kg m^2/s` in the new units.
fn factor(unit: &str, units: Units) -> f64 {
    let mut parts = unit.split('/');
    let part = |text: &str| -> f64 {
        let symbol = |symbol: &str| {
            let (name, power) = symbol.split_once('^').unwrap_or((symbol, "1"));
            let [m, kg, s] = units;
            let value = match name {
                "1" | "rad" => 1.0,
                "m" => m,
                "kg" => kg,
                "s" => s,
                "Hz" => 1.0 / s,
                "N" => kg * m / (s * s),
                "J" => kg * m * m / (s * s),
                _ => panic!("unit `{name}`"),
            };
            value.powi(power.parse().unwrap())
        };
        text.split(' ').map(symbol).product()
    };
    let numerator = part(parts.next().unwrap());
    parts.fold(numerator, |value, below| value / part(below))
}

/// The problem in other units; `inputs` are its inputs there.
fn in_units(problem: &Problem, units: Units, inputs: &[(&str, Function)]) -> Problem {
    let mut other = problem.clone();
    let model = &problem.model;
    for (value, parameter) in other.parameters.iter_mut().zip(&model.parameters) {
        *value *= factor(parameter.unit, units);
    }
    let (initial, accuracy) = (&mut other.initial, &mut other.accuracy);
    for (i, coordinate) in model.coordinates.iter().enumerate() {
        let of_q = factor(coordinate.unit, units);
        for q in [&mut initial.q[i], &mut accuracy.q_absolute[i]] {
            *q *= of_q;
        }
        for v in [&mut initial.v[i], &mut accuracy.v_absolute[i]] {
            *v *= of_q / units[2];
        }
    }
    for (name, function) in inputs {
        other.set_input(name, function.clone()).unwrap();
    }
    other.end.time *= units[2];
    other.record.every = other.record.every.map(|every| every * units[2]);
    other
}

/// Everything a run computed, back in metres, kilograms and seconds.
fn results(run: &Run, units: Units) -> Vec<f64> {
    let mut all = Vec::new();
    let seconds = units[2];
    let mut state = |t: f64, state: &Snapshot| {
        all.push(t / seconds);
        for (i, quantity) in run.layout.coordinates.iter().enumerate() {
            let of_q = factor(&quantity.unit, units);
            all.push(state.q[i] / of_q);
            all.push(state.v[i] / (of_q / seconds));
        }
        all.extend(&state.discrete);
    };
    for event in &run.events {
        state(event.t, &event.before);
        state(event.t, &event.after);
    }
    state(run.end.t, &run.end.state);
    let joule = factor("J", units);
    let energy = run.energy.as_ref().unwrap();
    for part in [
        energy.initial,
        energy.final_,
        energy.dissipated,
        energy.input_work,
        energy.lost_at_impacts,
    ] {
        all.push(part / joule);
    }
    for row in 0..run.trajectory.len() {
        all.push(run.trajectory.t[row] / seconds);
        for (value, column) in run.trajectory.row(row).iter().zip(&run.trajectory.columns) {
            all.push(value / factor(&column.unit, units));
        }
    }
    all
}

/// A scene in units that make a metre, a kilogram and a second so much: what it is, and the run.
fn scene(name: &str, method: Method, relative: f64, units: Units) -> Run {
    let (parameters, initial, amplitude, end): (&[_], &[_], _, _) = match name {
        // Rocks, slides and bulges.
        "walking_tank" => (&[("mu_s", 1.4), ("mu_k", 1.33)], &[], 20.0, 0.7),
        // Lands until it rests.
        "rocking_block" => (&[("e", 0.7)], &[("theta", 0.1)], 0.0, 4.0),
        "hand_ball" => (&[("e", 0.7)], &[("h", 1.0)], 0.0, 4.0),
        // Sticks and slips, with a stiff spring.
        "hand_slider" => (&[("k", 1.05e10), ("c", 6.42e6)], &[], 20.0, 0.5),
        _ => unreachable!("a scene of SCENES"),
    };
    let mut problem = problem(name, parameters);
    for (name, value) in initial {
        problem.set_initial(name, *value).unwrap();
    }
    problem.method = method;
    problem.set_tolerance(relative);
    problem.end.time = end;
    problem.record.every = Some(0.0078125);
    problem.record.columns.reactions = true;
    problem.record.columns.energies = true;
    let mut inputs = Vec::new();
    if amplitude != 0.0 {
        let amplitude = amplitude * factor("m/s^2", units);
        let shaking = Sine::new(amplitude, TAU * 7.0 / units[2], 0.0);
        inputs.push(("ground_acceleration", shaking.into()));
    }
    run(&in_units(&problem, units, &inputs))
}

const SCENES: [&str; 4] = ["walking_tank", "rocking_block", "hand_ball", "hand_slider"];

/// Powers of two that make up a metre, a kilogram and a second. Taylor coefficients of order 30 leave
/// the range of doubles where a second is 2^±30 units of time.
const POWERS: [[i32; 3]; 7] = [
    [10, 0, 0],
    [0, 10, 0],
    [0, 0, 10],
    [-7, 3, -5],
    [40, -30, 20],
    [-60, 90, -20],
    [100, 100, 1],
];

#[test]
fn units_of_powers_of_two_change_no_bit() {
    for name in SCENES {
        for method in [Method::Auto, Method::Radau] {
            for relative in [1e-4, 1e-8, 1e-12] {
                let metres = scene(name, method, relative, [1.0; 3]);
                let expected = results(&metres, [1.0; 3]);
                assert!(
                    metres.events.len() > 3,
                    "{name}: {:?}",
                    transitions(&metres)
                );
                for powers in POWERS {
                    let units = powers.map(|power| 2f64.powi(power));
                    let other = scene(name, method, relative, units);
                    let at = format!("{name} {method:?} {relative:e} {powers:?}");
                    assert_eq!(transitions(&other), transitions(&metres), "{at}");
                    assert_eq!(other.solver.steps, metres.solver.steps, "{at}");
                    let found = results(&other, units);
                    let mut pairs = expected.iter().zip(&found);
                    let first = pairs.find(|(a, b)| a.to_bits() != b.to_bits());
                    assert_eq!(first, None, "{at}");
                }
            }
        }
    }
}

#[test]
fn millimetres_and_tonnes_change_rounding_only() {
    for name in SCENES {
        for method in [Method::Auto, Method::Radau] {
            let metres = scene(name, method, 1e-12, [1.0; 3]);
            let units = [1e3, 1e-3, 1.0];
            let other = scene(name, method, 1e-12, units);
            assert_eq!(transitions(&other), transitions(&metres), "{name}");
            let pairs = metres.events.iter().zip(&other.events);
            let worst = pairs.fold(0.0f64, |most, (a, b)| most.max((a.t / b.t - 1.0).abs()));
            // Found: 9e-16, after 30 events of the tank. Were a scale lost, it would be of the tolerance.
            assert!(worst < 1e-14, "{name} {method:?}: {worst:e}");
        }
    }
}
