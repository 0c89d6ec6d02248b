//! Cost of a step, and how much of it is the model's own functions: `cargo bench --bench peers -- overhead`.
//!
//! The functions are timed one by one, outside of any run, and multiplied by how often a run calls
//! them: an estimate, since in a run they overlap with what is around them.

use super::{PROBLEMS, plain, quick};
use dalembert::hybrid::{Method, Problem, Simulator};
use dalembert::integrate::{Series, Taylor, Tolerances};
use dalembert::kernel::{Context, Free, ModeKernel, with_kernel};
use dalembert::model::{Guard, GuardShape, Mode};
use dalembert::record::{Progress, Silent};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector};
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

/// Prints the table in Markdown.
pub fn report() {
    println!(
        "| problem | tolerance | method | steps | ns a step | of the model's functions, ns | share |"
    );
    println!("|---|--:|---|--:|--:|--:|--:|");
    for name in PROBLEMS {
        for digits in [3, 6, 9, 12] {
            for method in [Method::Taylor, Method::Radau] {
                // An explicit method does not suit the stiff problem, nor an implicit one the others.
                if (name == "P4S") == (method == Method::Radau) {
                    row(name, method, 10f64.powi(-digits));
                }
            }
        }
    }
}

fn row(name: &str, method: Method, tolerance: f64) {
    let problem = plain(name, method, tolerance);
    let mut simulator = Simulator::new(&problem).expect("the initial state fits a mode");
    let repeats = if quick() { 3 } else { 200 };
    let times = (0..repeats).map(|_| {
        let start = Instant::now();
        simulator.run(&mut Silent).expect("the run succeeds");
        start.elapsed().as_secs_f64()
    });
    let total = times.fold(f64::INFINITY, f64::min);
    let steps = steps_by_mode(&problem, &mut simulator);
    let all: u64 = steps.iter().sum();
    let solver = simulator.solver();
    // Of residuals and Jacobians the sum over all modes is known: they are shared out by steps.
    let [residuals, jacobians] =
        [solver.residual_evaluations, solver.jacobian_evaluations].map(|n| n as f64 / all as f64);
    let own: f64 = (problem.variant().modes.iter().zip(&steps))
        .filter(|&(_, &steps)| steps > 0)
        .map(|(mode, &steps)| {
            let cost = with_kernel!(&mode.kernels, k => functions(k, &problem, mode), _any => unreachable!("few are free"));
            let step = match method {
                Method::Taylor => cost.series,
                _ => residuals * cost.residual + jacobians * cost.jacobian,
            };
            steps as f64 * (step + cost.checks)
        })
        .sum();
    println!(
        "| {name} | {tolerance:e} | {method:?} | {all} | {:.0} | {:.0} | {:.0} % |",
        1e9 * total / all as f64,
        1e9 * own / all as f64,
        100.0 * own / total,
    );
}

/// Counts the steps, by the events before each.
struct Steps(Vec<u64>);

impl Progress for Steps {
    fn advance(&mut self, _t: f64, events: u64) -> ControlFlow<()> {
        let events = events as usize;
        if self.0.len() <= events {
            self.0.resize(events + 1, 0);
        }
        self.0[events] += 1;
        ControlFlow::Continue(())
    }
}

/// Steps in each mode of the variant.
fn steps_by_mode(problem: &Problem, simulator: &mut Simulator) -> Vec<u64> {
    let mut steps = Steps(Vec::new());
    simulator.run(&mut steps).expect("the run succeeds");
    let mut by_mode = vec![0; problem.variant().modes.len()];
    let events = simulator.events();
    for (before, &count) in steps.0.iter().enumerate() {
        // The mode is the one that the last event entered, or the next one leaves.
        let mode = match (
            before.checked_sub(1).and_then(|k| events.get(k)),
            events.get(before),
        ) {
            (Some(last), _) => last.to,
            (None, Some(next)) => next.from,
            (None, None) => simulator.mode(),
        };
        by_mode[mode] += count;
    }
    by_mode
}

/// Seconds a call.
struct Cost {
    /// Of the Taylor series of the motion, and of the guards that are no polynomial of it.
    series: f64,
    residual: f64,
    jacobian: f64,
    /// Of what is checked after every step.
    checks: f64,
}

fn functions<const F: usize>(
    kernel: &ModeKernel<Const<F>>,
    problem: &Problem,
    mode: &Mode,
) -> Cost {
    let mut context = Context::new(&problem.model, &problem.parameters);
    context.autonomous = problem.signals.is_zero();
    // A state at which nothing is zero.
    let (q, v) = (SVector::repeat(0.01), SVector::repeat(0.1));
    let (a, inverse) = (SVector::repeat(1.0), SMatrix::identity());
    let at = Free {
        q: &q,
        v: &v,
        a: &a,
    };
    let (mut r, mut j) = (SVector::zeros(), [SMatrix::zeros(); 3]);
    let residual = seconds(|| kernel.residual(black_box(&context), at, &mut r));
    let jacobian = seconds(|| kernel.jacobian(black_box(&context), at, &mut j));
    let mut required = vec![0.0; mode.requirements.len() + mode.margins.len()];
    let mut checks = seconds(|| kernel.requirements(black_box(&context), at, &mut required));
    if !kernel.mass_is_constant() {
        checks += seconds(|| {
            black_box(kernel.system(&context, &q, &v));
        });
    }
    let accuracy = &problem.accuracy;
    let absolute = |all: &[f64]| SVector::from_fn(|i, _| all[mode.free[i]]);
    let (q_absolute, v_absolute) = (
        absolute(&accuracy.q_absolute),
        absolute(&accuracy.v_absolute),
    );
    let tolerances = Tolerances::new(accuracy.relative, q_absolute, v_absolute);
    let tolerances = tolerances.expect("they are those of the run");
    let order = Taylor::<Const<F>>::new(&tolerances, kernel.series_kind(&context)).order();
    let mut motion = Series::zero(Const::<F>);
    (motion.q[0], motion.v[0], motion.a[0]) = (q, v, a);
    (motion.q[1], motion.v[1], motion.q[2]) = (v, a, a * 0.5);
    let mut series = seconds(|| {
        black_box(kernel.series_start(&mut context, &motion));
        kernel.series_run(&mut context, order, &inverse, &mut motion);
    });
    let general = |guard: &Guard| matches!(guard.shape, GuardShape::General { .. });
    if mode.guards.iter().any(general) {
        series += seconds(|| {
            kernel.guard_series(&mut context, order, black_box(&motion));
        });
    }
    Cost {
        series,
        residual,
        jacobian,
        checks,
    }
}

/// The least of many, of calls in a row.
fn seconds(mut call: impl FnMut()) -> f64 {
    const CALLS: u32 = 200;
    let once = |_| {
        let start = Instant::now();
        (0..CALLS).for_each(|_| call());
        start.elapsed().as_secs_f64() / f64::from(CALLS)
    };
    (0..if quick() { 5 } else { 100 })
        .map(once)
        .fold(f64::INFINITY, f64::min)
}
