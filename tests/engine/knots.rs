//! Knots of lines and splines, where the slope or the third derivative of an input jumps: errors follow the tolerance across them,
//! and steps end there without starting anew.

use crate::common::{at_end, problem, run, tighten};
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Interpolation, Outside, Side, Table};

/// Nine rows (s, m/s²), of which seven are knots between two pieces.
const TIMES: [f64; 9] = [0.0, 0.11, 0.21, 0.35, 0.62, 0.7, 1.04, 1.2, 1.3];
const VALUES: [f64; 9] = [0.4, 1.0, -3.0, 2.5, 4.0, -1.0, -5.0, 2.0, 1.0];
/// Before the last row, behind the last knot, s.
const END: f64 = 1.25;

const INTERPOLATIONS: [Interpolation; 2] = [Interpolation::Linear, Interpolation::Cubic];

fn rows(interpolation: Interpolation) -> Function {
    let table = Table::new(&TIMES, &VALUES, interpolation, Outside::Hold);
    table.expect("the rows make a table").into()
}

fn over_the_knots(
    problem: Problem,
    (input, rows): (&str, Function),
    method: Method,
    relative: f64,
) -> Problem {
    let mut problem = problem;
    problem.set_input(input, rows).unwrap();
    problem.method = method;
    problem.set_tolerance(relative);
    problem.end.time = END;
    problem
}

/// A ball that never lands moves by g t²/2 and the table under it.
#[test]
fn a_flight_over_knots_is_as_accurate_as_the_tolerance() {
    for (method, interpolation) in [Method::Radau, Method::Taylor]
        .into_iter()
        .flat_map(|method| INTERPOLATIONS.map(|interpolation| (method, interpolation)))
    {
        for relative in [1e-4, 1e-8, 1e-11, 1e-13] {
            let mut ball = problem("hand_table_ball", &[]);
            ball.set_initial("gap", 20.0).unwrap();
            let input = ("table_acceleration", rows(interpolation));
            let problem = over_the_knots(ball, input, method, relative);
            let run = run(&problem);
            assert!(run.events.is_empty());
            let moved = rows(interpolation).at(END, Side::Left).double_integral;
            let error = at_end(&run, "gap") - (20.0 - 9.81 * END * END / 2.0 - moved);
            // The rounding of some ten sums of 20 m.
            assert!(error.abs() < 20.0 * 1e-15 * 10.0, "{method:?}: {error:e}");
        }
    }
}

/// An oscillator of 4 s period on ground that moves so: its motion is no polynomial, and a step may be longer
/// than a piece.
#[test]
fn errors_of_an_oscillator_follow_the_tolerance_across_knots() {
    for interpolation in INTERPOLATIONS {
        let oscillator = |method, relative| {
            let parameters = [("mu_s", 10.0), ("k", 100.0), ("c", 5.0)];
            let problem = problem("hand_slider", &parameters);
            let input = ("ground_acceleration", rows(interpolation));
            over_the_knots(problem, input, method, relative)
        };
        let mut exact = oscillator(Method::Taylor, 1e-13);
        tighten(&mut exact, 1.0);
        let exact = at_end(&run(&exact), "d");
        for method in [Method::Radau, Method::Taylor] {
            for relative in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
                let run = run(&oscillator(method, relative));
                let error = (at_end(&run, "d") - exact).abs();
                println!("{relative:e}: {error:e} m, {} steps", run.solver.steps);
                // The size of d is 1 m, of its rate 1 m/s.
                assert!(error < relative, "{relative:e}: {error:e} m");
            }
        }
    }
}

/// A record of a thousand rows on a smooth curve: where a step ends at a knot, the next is as long as the
/// tolerance lets it.
#[test]
fn an_implicit_step_goes_on_beyond_a_knot() {
    INTERPOLATIONS.into_iter().for_each(implicit_steps);
}

fn implicit_steps(interpolation: Interpolation) {
    let times: Vec<_> = (0..=1000).map(|i| i as f64 * 1e-2).collect();
    let values: Vec<_> = times.iter().map(|t| (t * 0.7).sin()).collect();
    let table = Table::new(&times, &values, interpolation, Outside::Hold);
    let mut problem = problem("hand_table_ball", &[]);
    problem
        .set_input("table_acceleration", table.unwrap().into())
        .unwrap();
    problem.method = Method::Radau;
    problem.set_initial("gap", 1e4).unwrap();
    problem.end.time = 10.0;
    let run = run(&problem);
    let counters = &run.solver;
    assert_eq!(counters.rejected, 0);
    assert!(counters.steps <= 1000 + 10, "{}", counters.steps);
}
