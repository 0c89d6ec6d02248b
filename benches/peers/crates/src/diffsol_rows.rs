//! diffsol: BDF, TR-BDF2, ESDIRK 3(4) and Tsitouras 5(4), with its root finding.

use crate::Run;
use crate::problems::Problem;
use diffsol::{
    NalgebraContext, NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquationsImplicit,
    OdeSolverMethod, OdeSolverProblem, OdeSolverStopReason, Vector, VectorCommon,
};
use std::cell::RefCell;

type Matrix = NalgebraMat<f64>;
type Solver = NalgebraLU<f64>;

/// The Jacobian where it was evaluated last: diffsol asks for it column by column.
struct Columns {
    t: f64,
    y: Vec<f64>,
    j: Vec<f64>,
}

/// Rows of all methods that suit the problem.
pub fn rows(problem: &Problem, tolerance: f64, stiff: bool) {
    let n = problem.states();
    let last = RefCell::new(Columns {
        t: f64::NAN,
        y: vec![f64::NAN; n],
        j: vec![0.0; n * n],
    });
    // An event changes the mode, and with it the Jacobian at the same place.
    let forget = || last.borrow_mut().t = f64::NAN;
    let times_jacobian = |x: &[f64], _: &[f64], t: f64, v: &[f64], out: &mut [f64]| {
        let Columns { t: at, y, j } = &mut *last.borrow_mut();
        if *at != t || y != x {
            problem.jacobian(t, x, j);
            *at = t;
            y.copy_from_slice(x);
        }
        for (row, out) in j.chunks(n).zip(out) {
            *out = row.iter().zip(v).map(|(j, v)| j * v).sum();
        }
    };
    let built = OdeBuilder::<Matrix>::new()
        .rtol(tolerance)
        .atol(problem.absolute(tolerance))
        .rhs_implicit(
            |x: &[f64], _: &[f64], t: f64, out: &mut [f64]| problem.rhs(t, x, out),
            times_jacobian,
        )
        .init(
            |_: &[f64], _: f64, out: &mut [f64]| problem.start(out, tolerance),
            n,
        )
        .root(
            |x: &[f64], _: &[f64], t: f64, out: &mut [f64]| problem.values(t, x, out),
            problem.guards(),
        )
        .build();
    let mut equations = built.expect("the problem is complete");
    // Hops of a bouncing body become shorter than its default.
    equations.ode_options.min_timestep = f64::EPSILON;
    // A new mode means a few failures until the Jacobian is that of the mode; they add up over events.
    equations.ode_options.max_nonlinear_solver_failures = usize::MAX;
    equations.ode_options.max_error_test_failures = usize::MAX;
    let equations = equations;
    macro_rules! row {
        ($method:literal, $order:literal, $solver:expr) => {
            if let Ok(mut solver) = $solver {
                crate::measure("diffsol", $method, problem, tolerance, |run| {
                    drive(
                        problem,
                        &equations,
                        &mut solver,
                        $order,
                        tolerance,
                        &forget,
                        run,
                    )
                });
            }
        };
    }
    row!("BDF", 1, equations.bdf::<Solver>());
    row!("TR-BDF2", 2, equations.tr_bdf2::<Solver>());
    row!("ESDIRK 34", 4, equations.esdirk34::<Solver>());
    if !stiff {
        row!("Tsit 45", 5, equations.tsit45());
    }
}

/// One run; the solver restarts in place, at the beginning as after an event.
fn drive<'a, E, S>(
    problem: &Problem,
    equations: &'a OdeSolverProblem<E>,
    solver: &mut S,
    order: usize,
    tolerance: f64,
    forget: &impl Fn(),
    run: &mut Run,
) where
    E: OdeEquationsImplicit<M = Matrix, V = NalgebraVec<f64>, T = f64, C = NalgebraContext> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    let restart = |solver: &mut S, t: f64, jump: &mut dyn FnMut(&mut [f64]) -> bool| {
        let mut state = solver.state_mut();
        *state.t = t;
        let ended = jump(state.y.inner_mut().as_mut_slice());
        forget();
        let (y, dy) = (state.y.inner().as_slice(), state.dy.inner_mut());
        problem.rhs(t, y, dy.as_mut_slice());
        let (atol, rtol) = (&equations.atol, equations.rtol);
        state.set_step_size(equations.h0, atol, rtol, &equations.eqn, order);
        Ok::<_, diffsol::error::DiffsolError>(ended || solver.set_stop_time(problem.end()).is_err())
    };
    let mut go = || {
        restart(solver, 0.0, &mut |y| {
            problem.start(y, tolerance);
            false
        })?;
        loop {
            let outcome = solver.step()?;
            run.steps += 1;
            match outcome {
                OdeSolverStopReason::InternalTimestep if run.runaway() => break,
                OdeSolverStopReason::InternalTimestep => {}
                OdeSolverStopReason::TstopReached => break,
                OdeSolverStopReason::RootFound(t, which) => {
                    run.events.push(t);
                    solver.state_mut_back(t)?;
                    let ended = restart(solver, t, &mut |y| problem.event(t, y, which))?;
                    if ended || run.runaway() {
                        break;
                    }
                }
            }
        }
        Ok::<_, diffsol::error::DiffsolError>(())
    };
    if go().is_err() {
        run.status = -1;
    }
    let state = solver.state();
    run.time = state.t;
    run.y = state.y.inner().as_slice().to_vec();
}
