//! Newmark's sliding block that slips downhill only (tests/data/04_newmark.json).

use crate::common::*;
use dalembert::hybrid::Problem;
use dalembert::input::{Function, Interpolation, Outside, Sine, Table};

fn block(friction: f64, force: Function, end: f64) -> Problem {
    let mut problem = problem("one_way_block", &[("friction", friction)]);
    problem.set_input("force", force).unwrap();
    // The shortest slip is 0.45 mm.
    tighten(&mut problem, 1e-4);
    problem.end.time = end;
    problem
}

fn relative(found: f64, exact: f64) -> f64 {
    (found / exact - 1.0).abs()
}

#[test]
fn a_rectangular_pulse_moves_the_block() {
    with_each_method(|| {
        let reference = reference("04_newmark");
        for case in reference["reference"]["rectangular_one_way"]
            .as_array()
            .unwrap()
        {
            let (a, t0) = (number(&case["a"]), number(&case["t0"]));
            let pulse = Table::new(
                &[0.0, t0],
                &[a, 0.0],
                Interpolation::Previous,
                Outside::Zero,
            );
            let run = run(&block(
                number(&case["ay"]),
                Function::from(pulse.unwrap()),
                5.0,
            ));
            assert_eq!(transitions(&run), ["slip", "stick"]);
            assert!(relative(run.events[1].t, number(&case["t_stop"])) < 1e-12);
            assert!(relative(at_end(&run, "s"), number(&case["slip"])) < 1e-12);
        }
    });
}

#[test]
fn a_sine_moves_the_block_once_a_cycle() {
    with_each_method(|| {
        let reference = reference("04_newmark");
        for case in reference["reference"]["sine_one_way"].as_array().unwrap() {
            let sine = Function::from(Sine::new(1.0, 1.0, 0.0));
            let run = run(&block(
                number(&case["eta"]),
                sine,
                2.0 * std::f64::consts::TAU,
            ));
            let (start, stop) = (number(&case["t_start"]), number(&case["t_stop"]));
            let (slips, sticks) = (times(&run, "slip"), times(&run, "stick"));
            let tau = std::f64::consts::TAU;
            for (found, exact) in [
                (slips[0], start),
                (sticks[0], stop),
                (slips[1], start + tau),
                (sticks[1], stop + tau),
            ] {
                assert!(
                    relative(found, exact) < 1e-12,
                    "{found:.17} instead of {exact:.17}"
                );
            }
            let slip = number(&case["slip_per_cycle"]);
            assert!(
                relative(at_end(&run, "s"), 2.0 * slip) < 1e-12,
                "{}",
                at_end(&run, "s")
            );
        }
    });
}
