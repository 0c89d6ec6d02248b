//! The tank on two edges by contacts: as the modes by hand under the landings that these have, as a rigid block where it has
//! hardly any liquid, and in the air.

use crate::common::*;
use crate::scenes::{SCENES, scene};
use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::record::{Run, Silent};

const METHODS: [Method; 2] = [Method::Taylor, Method::Radau];

fn at_tolerance(mut problem: Problem, relative: f64, method: Method) -> Problem {
    problem.set_tolerance(relative);
    problem.method = method;
    problem.record.ledger = true;
    problem
}

/// When something happens before a rest, each instant once: what contacts decide at once modes by hand decide one behind the other.
fn instants(run: &Run) -> Vec<f64> {
    let until = times(run, "rest").first().copied().unwrap_or(f64::INFINITY);
    let mut instants: Vec<f64> = Vec::new();
    for event in run.events.iter().filter(|e| e.t < until) {
        if instants.last().is_none_or(|last| event.t > *last) {
            instants.push(event.t);
        }
    }
    instants
}

#[test]
fn contacts_reproduce_the_modes_by_hand() {
    for name in SCENES {
        for landing in ["momenta", "velocities"] {
            for method in METHODS {
                let of = |edges: &str| {
                    let chosen = [&*format!("edges={edges}"), &*format!("landing={landing}")];
                    run(&at_tolerance(scene(name, &chosen), 1e-12, method))
                };
                let at = format!("{name}, {landing}, {method:?}");
                let [hand, contacts] = ["modes", "contacts"].map(of);
                let [expected, found] = [&hand, &contacts].map(instants);
                // Of an accumulation one may leave earlier than the other.
                let rests = [&hand, &contacts].map(|run| times(run, "rest"));
                assert_eq!(rests[0].len(), rests[1].len(), "{at}");
                match rests[0].is_empty() {
                    true => assert_eq!(expected.len(), found.len(), "{at}"),
                    false => assert!(found.len() > 25 && expected.len() > 25, "{at}"),
                }
                let pairs = expected
                    .iter()
                    .zip(&found)
                    .chain(rests[0].iter().zip(&rests[1]));
                for (expected, found) in pairs {
                    assert!((expected - found).abs() < 1e-11, "{at}: {expected} {found}");
                }
                for column in ["theta", "x_I", "x", "theta.rate", "x_I.rate", "x.rate"] {
                    let [expected, found] = [&hand, &contacts].map(|run| at_end(run, column));
                    assert!(
                        (expected - found).abs() < 1e-9,
                        "{at}: {column} {expected} {found}"
                    );
                }
                let [expected, found] =
                    [&hand, &contacts].map(|run| run.energy.as_ref().unwrap().lost_at_impacts);
                assert!((expected - found).abs() < 1e-9 * expected.max(1.0), "{at}");
            }
        }
    }
}

/// A tank of a shell of one kilogram with hardly any liquid, kg, and the block that it is.
fn shell_and_block([amplitude, e, mu]: [f64; 3], (liquid, method): (f64, Method)) -> [Problem; 2] {
    let (b, h, m): (f64, f64, f64) = (0.2, 0.5, 1.0);
    let (r, alpha) = (b.hypot(h), b.atan2(h));
    let pivot = 4.0 / 3.0 * r * r;
    let mut overrides = vec!["landing=contact".to_owned(), "end=3.0".to_owned()];
    let given = [
        ("M_0", liquid),
        ("M_I", liquid),
        ("M_rb", 0.0),
        ("M_E", liquid),
        ("M_S", m),
        ("I_S", m * pivot),
        ("I_E", liquid * pivot),
        ("R_0", r),
        ("R_I", r),
        ("R_S", r),
        ("alpha_0", alpha),
        ("alpha_I", alpha),
        ("alpha_S", alpha),
        ("frequency", 2.0),
        ("mu_s", mu),
        ("mu_k", 0.9 * mu),
        ("e_edge", e),
    ];
    overrides.extend(given.map(|(name, value)| format!("parameters.{name}={value:e}")));
    let shaking = [
        ("ground_acceleration", "a_h", amplitude, 1.3),
        ("vertical_acceleration", "a_v", 6.0, 2.1),
    ];
    let sine = |amplitude: f64, frequency: f64| {
        format!(r#"{{"sine": {{"amplitude": {amplitude:e}, "frequency": {frequency:e}}}}}"#)
    };
    for (name, _, amplitude, frequency) in shaking {
        overrides.push(format!("inputs.{name}={}", sine(amplitude, frequency)));
    }
    let overrides: Vec<&str> = overrides.iter().map(|o| &**o).collect();
    let tank = scene("tank_thrown_up", &overrides);
    let mut of_block = vec!["end=3.0".to_owned(), format!("initial={{\"y\": {h:e}}}")];
    let given = [
        ("b", b),
        ("h", h),
        ("m", m),
        ("mu_s", mu),
        ("mu_k", 0.9 * mu),
        ("e", e),
    ];
    let given = given.map(|(name, value)| format!("\"{name}\": {value:e}"));
    of_block.push(format!("parameters={{{}}}", given.join(", ")));
    let inputs = shaking.map(|(_, name, amplitude, frequency)| {
        format!("\"{name}\": {}", sine(amplitude, frequency))
    });
    of_block.push(format!("inputs={{{}}}", inputs.join(", ")));
    let of_block: Vec<&str> = of_block.iter().map(|o| &**o).collect();
    let block = scene("rigid_block", &of_block);
    [tank, block].map(|problem| at_tolerance(problem, 1e-12, method))
}

#[test]
fn a_tank_that_is_hardly_more_than_its_shell_is_a_rigid_block() {
    // It rocks; it rocks, slides and comes to rest; it turns over.
    for shaken in [[5.0, 0.0, 0.6], [6.0, 0.4, 0.45], [4.5, 0.0, 2.0]] {
        // The implicit method solves for forces, of which those of a nanogram are the rounding of those of a kilogram.
        // Turning over multiplies what the liquid does by thousands.
        let cases = [(1e-12, Method::Taylor, 1e-8), (1e-9, Method::Radau, 1e-5)];
        for (liquid, method, within) in cases {
            let at = format!("{shaken:?} {method:?}");
            let of = (liquid, method);
            let [tank, block] = shell_and_block(shaken, of).map(|p| run(&p));
            // The liquid that would stand on the ground beside the tank weighs nothing.
            let of_edges = |run: &Run| {
                let events = run
                    .events
                    .iter()
                    .filter(|e| !e.transition.starts_with("core"));
                let events = events.map(|e| (e.transition.to_owned(), e.t));
                let mut seen: Vec<(String, f64)> = events.collect();
                if let Some(first) = seen.iter().position(|(name, _)| name == "rest") {
                    seen.truncate(first);
                }
                seen
            };
            let [expected, found] = [of_edges(&block), of_edges(&tank)];
            let common = expected.len().min(found.len());
            assert!(common >= 5, "{at}: {expected:?}");
            for ((expected, t), (found, of_tank)) in expected.iter().zip(&found) {
                assert_eq!(expected, found, "{at}, {t} s, {of_tank} s");
                assert!(
                    (t - of_tank).abs() < within,
                    "{at}: {expected} {t} {of_tank}"
                );
            }
            for column in ["left.gap", "right.gap"] {
                let [expected, found] = [at_end(&block, column), at_end(&tank, column)];
                assert!(
                    (expected - found).abs() < 10.0 * within,
                    "{at}: {column} {expected} {found}"
                );
            }
        }
    }
}

/// Vertical momentum relative to the ground, N s, from the state.
fn vertical_momentum(problem: &Problem, run: &Run) -> f64 {
    let of = |name: &str| problem.parameters[problem.model.parameter(name).unwrap()];
    let at = |name: &str| at_end(run, name);
    let (theta, turns) = (at("theta"), at("theta.rate"));
    let arm = |mass: &str, radius: &str, angle: &str| {
        of(mass) * of(radius) * (of(angle) - theta).sin() * turns
    };
    let bulges = at("x_I.rate") * theta.sin() + at("x_I") * theta.cos() * turns;
    (of("M_E") + of("M_S")) * at("y.rate")
        + arm("M_E", "R_0", "alpha_0")
        + arm("M_S", "R_S", "alpha_S")
        + at("side") * of("M_rb") * bulges
}

#[test]
fn a_tank_is_thrown_up_and_lands() {
    for restitution in [0.0, 0.3, 0.7] {
        for method in METHODS {
            let overrides = [
                &*format!("parameters.e_edge={restitution}"),
                "inputs.vertical_acceleration.sine.amplitude=14",
                "end=2",
            ];
            let mut problem = at_tolerance(scene("tank_thrown_up", &overrides), 1e-10, method);
            problem.record.every = Some(1e-3);
            problem.record.columns.inputs = true;
            let run = run(&problem);
            let at = format!("{restitution} {method:?}");
            let trajectory = &run.trajectory;
            let column = |name: &str| trajectory.column(name).unwrap();
            let rows = || (0..trajectory.len()).map(|i| trajectory.row(i));
            let least = |name: &str| {
                rows()
                    .map(|r| r[column(name)])
                    .fold(f64::INFINITY, f64::min)
            };
            for side in ["left", "right"] {
                assert!(least(&format!("{side}.gap")) > -1e-16, "{at}: {side}");
                assert!(least(&format!("{side}.normal")) > -1e-9, "{at}: {side}");
            }
            // In the air for a good part of each shake, where nothing holds it.
            let flies = |row: &&[f64]| row[column("left.gap")].min(row[column("right.gap")]) > 1e-6;
            let in_air: Vec<&[f64]> = rows().filter(|row| flies(row)).collect();
            assert!(in_air.len() > 300, "{at}: {}", in_air.len());
            for row in in_air {
                assert!(row[column("reaction.z_v")].abs() < 1e-9, "{at}");
                assert!(row[column("reaction.z_h")].abs() < 1e-9, "{at}");
            }
            // Impulses, impacts included, against weight, shaking and momentum.
            let parameter = |name: &str| problem.parameters[problem.model.parameter(name).unwrap()];
            let (mass, g) = (parameter("M_E") + parameter("M_S"), parameter("g"));
            let t = run.end.t;
            let rises = rows().map(|row| row[column("vertical_acceleration.velocity")]);
            let rises: Vec<f64> = rises.collect();
            let risen = rises.last().unwrap() - rises[0];
            let impulses =
                at_end(&run, "left.normal_impulse") + at_end(&run, "right.normal_impulse");
            let expected = vertical_momentum(&problem, &run) + mass * (g * t + risen);
            assert!(
                (impulses - expected).abs() < 1e-8 * expected,
                "{at}: {impulses} {expected}"
            );
            let energy = run.energy.as_ref().unwrap();
            let imbalance = energy.imbalance().abs();
            assert!(
                imbalance < 1e-8 * energy.input_work.abs(),
                "{at}: {imbalance}"
            );
        }
    }
}

#[test]
fn mirrored_shaking_throws_it_to_the_other_side() {
    for method in METHODS {
        let thrown = |amplitude: f64, side: i32| {
            let overrides = [
                &*format!("inputs.ground_acceleration.sine.amplitude={amplitude}"),
                &*format!("initial={{\"side\": {side}}}"),
            ];
            run(&at_tolerance(
                scene("tank_thrown_up", &overrides),
                1e-12,
                method,
            ))
        };
        let [run, mirrored] = [thrown(6.0, 1), thrown(-6.0, -1)];
        let other = |name: &str| match name.strip_prefix("left") {
            Some(rest) => format!("right{rest}"),
            None => name.replacen("right", "left", 1),
        };
        // In free fall slip has no friction that would stop it: the instants at which it does are of no consequence.
        let of_edges = |run: &Run| -> Vec<(String, f64)> {
            let events = run
                .events
                .iter()
                .filter(|e| !e.transition.starts_with("core"));
            events.map(|e| (e.transition.to_owned(), e.t)).collect()
        };
        for ((name, t), (of_mirrored, at)) in of_edges(&run).into_iter().zip(of_edges(&mirrored)) {
            assert!((t - at).abs() < 1e-8, "{method:?}: {name} {t} {at}");
            let is_both = name.ends_with("slips") || name.ends_with("sticks");
            assert!(
                is_both || other(&name) == of_mirrored,
                "{method:?}: {t} {name} {of_mirrored}"
            );
        }
        for (column, sign) in [("theta", 1.0), ("x", -1.0), ("x_I", -1.0), ("y", 1.0)] {
            let [one, two] = [&run, &mirrored].map(|run| at_end(run, column));
            assert!(
                (one - sign * two).abs() < 1e-8,
                "{method:?}: {column} {one} {two}"
            );
        }
    }
}

#[test]
fn a_landing_that_says_nothing_of_flight_stops_where_the_tank_takes_off() {
    for landing in ["momenta", "velocities"] {
        let chosen = [&*format!("landing={landing}"), "edges=contacts"];
        let run = simulate(&scene("tank_thrown_up", &chosen), &mut Silent).unwrap();
        let failure = run.failure.unwrap();
        assert!(
            failure
                .reason
                .to_string()
                .contains("the tank would leave the ground"),
            "{}",
            failure.reason
        );
    }
}
