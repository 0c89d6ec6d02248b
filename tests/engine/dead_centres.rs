//! Friction at dead centres: where the line of a slip vanishes, or depends on others at one position alone, the slip is zero however
//! fast the mechanism moves. It turns back there, and nothing is lost at that instant.

use crate::common::*;
use dalembert::hybrid::Problem;
use dalembert::record::Run;
use std::f64::consts::PI;

/// A problem with contacts, to 1e-12 for 2 s.
fn started(mut problem: Problem, initial: &[(&str, f64)]) -> Problem {
    for &(name, value) in initial {
        problem.set_initial(name, value).unwrap();
    }
    problem.set_tolerance(1e-12);
    problem.end.time = 2.0;
    problem
}

fn balanced(run: &Run) {
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let energy = run.energy.as_ref().unwrap();
    assert!(energy.imbalance().abs() < 1e-11, "{energy:?}");
}

#[test]
fn a_yoke_turns_back_at_its_dead_centres_and_loses_what_friction_takes() {
    with_each_method(|| {
        // Also through the angle 0, which is known to any number of digits.
        for start in [0.3, -0.5] {
            let problem = problem("dead_centre", &[]);
            let problem = started(problem, &[("phi", start), ("phi.rate", 10.0)]);
            let run = run(&problem);
            balanced(&run);
            assert!(run.events.len() >= 6, "{}", run.events.len());
            for (k, event) in run.events.iter().enumerate() {
                assert_eq!(event.transition, "guide reverses");
                let centre = (k as f64 + if start > 0.0 { 1.0 } else { 0.0 }) * PI;
                let angle = event.before.q[0];
                assert!((angle - centre).abs() < 1e-11, "{angle} and {centre}");
                assert_eq!(event.before.v[0], event.after.v[0]);
                let first: f64 = if start > 0.0 {
                    1.0 + start.cos()
                } else {
                    1.0 - start.cos()
                };
                let way = 0.1 * (first + 2.0 * k as f64);
                let energy = 0.05 * event.after.v[0].powi(2);
                assert!((energy - (5.0 - way)).abs() < 1e-11, "{energy} after {way}");
            }
        }
    });
}

#[test]
fn a_yoke_starts_at_its_dead_centre() {
    with_each_method(|| {
        for start in [0.0, PI, -PI] {
            let problem = problem("dead_centre", &[]);
            let problem = started(problem, &[("phi", start), ("phi.rate", 10.0)]);
            let run = run(&problem);
            balanced(&run);
            let turns: Vec<f64> = run.events.iter().map(|event| event.before.q[0]).collect();
            for (k, angle) in turns.iter().enumerate() {
                let centre = start + (k + 1) as f64 * PI;
                assert!((angle - centre).abs() < 1e-11, "{angle} and {centre}");
            }
            assert!(turns.len() >= 5, "{turns:?}");
        }
    });
}

#[test]
fn a_slider_on_a_rod_turns_back_where_crank_and_rod_are_in_line() {
    with_each_method(|| {
        let problem = problem("rod_and_guide", &[]);
        let initial = [("phi", 0.3), ("phi.rate", 10.0), ("x", 0.39), ("psi", 0.1)];
        let mut problem = started(problem, &initial);
        problem.project = true;
        let run = run(&problem);
        balanced(&run);
        let turns = run
            .events
            .iter()
            .filter(|e| e.transition == "guide reverses");
        let angles: Vec<f64> = turns.map(|event| event.before.q[0]).collect();
        assert_eq!(angles.len(), 5);
        for (k, angle) in angles.iter().enumerate() {
            assert!((angle - (k + 1) as f64 * PI).abs() < 1e-10, "{angle}");
        }
    });
}

#[test]
fn a_foot_that_others_hold_for_an_instant_goes_on() {
    with_each_method(|| {
        let problem = problem("foot_and_wheel", &[]);
        let mut problem = started(
            problem,
            &[
                ("y_l", 0.7290559764401972),
                ("x_l.rate", 1.2151),
                ("y_l.rate", 0.8001),
                ("p_l.rate", -2.8388),
                ("x_w", 0.7),
                ("y_w", 0.43570305800522025),
                ("x_w.rate", -1.3693),
                ("y_w.rate", 1.2644),
                ("p_w.rate", -2.6045),
            ],
        );
        problem.project = true;
        let run = run(&problem);
        balanced(&run);
        let names = transitions(&run);
        assert_eq!(
            names,
            [
                "wheel strikes",
                "foot strikes",
                "wheel sticks",
                "foot reverses",
                "foot reverses"
            ]
        );
        for event in &run.events[2..] {
            for (before, after) in event.before.v[..6].iter().zip(&event.after.v) {
                let off = (before - after).abs();
                assert!(off < 1e-11, "{}: {before} and {after}", event.transition);
            }
        }
    });
}
