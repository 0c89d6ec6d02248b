//! Charts: other coordinates of the same state.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, Reason, simulate};
use dalembert::record::Silent;

const MU: f64 = 0.2;
const G: f64 = 9.81;

/// A block 1 m to the right of the mark, at a height and with rates.
fn block(y: f64, rates: [f64; 2], mu: f64, method: Method) -> Problem {
    let mut problem = problem("past_the_mark", &[("g", G), ("mu", mu)]);
    for (name, value) in [
        ("x", 1.0),
        ("y", y),
        ("x.rate", rates[0]),
        ("y.rate", rates[1]),
    ] {
        problem.set_initial(name, value).unwrap();
    }
    problem.set_tolerance(TIGHTEST);
    problem.method = method;
    problem.record.ledger = true;
    problem.end.time = 2.0;
    problem
}

#[test]
fn a_block_slides_past_the_mark_and_nothing_happens() {
    for method in [Method::Taylor, Method::Radau] {
        let run = run(&block(0.0, [-3.0, 0.0], MU, method));
        assert_eq!(transitions(&run), ["floor sticks"]);
        assert!((run.events[0].t - 3.0 / (MU * G)).abs() <= 1e-14);
        let place = at_end(&run, "side") * at_end(&run, "x");
        assert!(
            (place - (1.0 - 9.0 / (2.0 * MU * G))).abs() <= 1e-13,
            "{place}"
        );
        let energy = run.energy.as_ref().unwrap();
        // Sticking takes the rounding of a rate.
        assert!(energy.lost_at_impacts.abs() <= 1e-28);
        assert!(energy.imbalance().abs() <= 1e-12, "{}", energy.imbalance());
    }
}

#[test]
fn it_flies_past_it_and_back() {
    for method in [Method::Taylor, Method::Radau] {
        // It lands behind the mark, and bounces.
        let run = run(&block(1.0, [-2.5, 1.0], 0.0, method));
        let lands = (1.0 + (1.0 + 2.0 * G).sqrt()) / G;
        assert_eq!(transitions(&run)[0], "floor strikes");
        assert!((run.events[0].t - lands).abs() <= 1e-14);
        let place = at_end(&run, "side") * at_end(&run, "x");
        assert!((place - (1.0 - 2.5 * 2.0)).abs() <= 1e-13, "{place}");
    }
}

#[test]
fn one_that_moves_something_is_refused() {
    for (parameter, mu, of) in [("rise", MU, "the gap"), ("kick", MU, "the slip rate")] {
        for (y, method) in [(0.0, Method::Taylor), (1.0, Method::Radau)] {
            let mut problem = block(y, [-3.0, 0.0], mu, method);
            problem.set_parameter(parameter, 0.01).unwrap();
            let failure = simulate(&problem, &mut Silent).unwrap().failure.unwrap();
            let text = failure.reason.to_string();
            let Reason::Chart {
                name,
                before,
                after,
                ..
            } = failure.reason
            else {
                panic!("{text}")
            };
            assert_eq!(name, "mark");
            assert!(((after - before).abs() - 0.01).abs() <= 1e-12, "{text}");
            assert!(text.contains(&format!("changes {of} of `floor`")), "{text}");
            assert!((at_mark(&problem) - failure.at.t).abs() <= 1e-13);
        }
    }
}

/// When it comes to the mark, s: with friction or in the air.
fn at_mark(problem: &Problem) -> f64 {
    let slides = problem.initial.q[problem.model.coordinate("y").unwrap()] == 0.0;
    match slides {
        true => (3.0 - (9.0 - 2.0 * MU * G).sqrt()) / (MU * G),
        false => 1.0 / 3.0,
    }
}
