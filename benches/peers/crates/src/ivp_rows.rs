//! `ivp`: its methods with its terminal events, a call of its solver for each piece between events.

use crate::Run;
use crate::problems::Problem;
use ivp::matrix::Matrix;
use ivp::prelude::*;
use std::cell::RefCell;

struct System<'p> {
    problem: &'p Problem,
    jacobian: RefCell<Vec<f64>>,
}

impl FirstOrderSystem for System<'_> {
    fn derivative(&self, t: f64, y: &[f64], f: &mut [f64]) {
        self.problem.rhs(t, y, f)
    }

    fn jac(&self, t: f64, y: &[f64], out: &mut Matrix) {
        let j = &mut *self.jacobian.borrow_mut();
        self.problem.jacobian(t, y, j);
        let n = y.len();
        for row in 0..n {
            for column in 0..n {
                out[(row, column)] = j[row * n + column];
            }
        }
    }

    fn events(&self, t: f64, y: &[f64], g: &mut [f64]) {
        self.problem.values(t, y, g)
    }

    fn n_events(&self) -> usize {
        self.problem.guards()
    }

    fn event_config(&self, _: usize) -> EventConfig {
        let mut config = EventConfig::new();
        config.terminal();
        config.negative();
        config
    }
}

/// Rows of all methods that suit the problem.
pub fn rows(problem: &Problem, tolerance: f64, stiff: bool) {
    let system = System {
        problem,
        jacobian: RefCell::new(vec![0.0; problem.states().pow(2)]),
    };
    let absolute = problem.absolute(tolerance);
    let implicit = [
        ("Radau", Method::RADAU),
        ("BDF", Method::BDF),
        ("LSODA", Method::LSODA),
    ];
    let explicit = [("DOP853", Method::DOP853), ("DOPRI5", Method::DOPRI5)];
    let explicit = explicit.into_iter().filter(|_| !stiff);
    for (name, method) in implicit.into_iter().chain(explicit) {
        crate::measure("ivp", name, problem, tolerance, |run| {
            drive(&system, method, tolerance, &absolute, run)
        });
    }
}

fn drive(system: &System, method: Method, tolerance: f64, absolute: &[f64], run: &mut Run) {
    let problem = system.problem;
    run.y.resize(problem.states(), 0.0);
    problem.start(&mut run.y, tolerance);
    while run.time < problem.end() && !run.runaway() {
        let solver = Ivp::first_order(system, run.time, problem.end(), &run.y)
            .method(method)
            .rtol(tolerance)
            .atol(absolute.to_vec())
            .max_steps(Run::MOST_STEPS)
            .jacobian_source(JacobianSource::UserProvided)
            // Nothing is recorded but where it ends.
            .t_eval(vec![problem.end()]);
        let Ok(piece) = solver.solve() else {
            run.status = -1;
            return;
        };
        run.steps += piece.nstep;
        let (Some(&t), Some(y), true) = (piece.t.last(), piece.y.last(), piece.status.is_success())
        else {
            run.status = -2;
            return;
        };
        run.time = t;
        run.y.copy_from_slice(y);
        let Some(which) = piece.t_events.iter().position(|times| !times.is_empty()) else {
            return;
        };
        run.events.push(t);
        if problem.event(t, &mut run.y, which) {
            return;
        }
    }
}
