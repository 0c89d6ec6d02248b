//! What it saves to model only what a scene needs: `cargo bench --bench reduction`.
//!
//! 1. Each mode integrates its free coordinates alone. Here the same stretches of the same motion
//!    are integrated again with all three coordinates of the tank: the equations of the mode in
//!    which all are free, with a = 0 in place of those of the coordinates that are held. Integrator,
//!    tolerances and results are the same.
//! 2. A scene that freezes coordinates evaluates no guard that cannot fire.
//!
//! Times are the minima of repeats, in which all else that the machine does only adds.

use dalembert::hybrid::{Problem, simulate};
use dalembert::input::Signals;
use dalembert::integrate::{Radau, System, Tolerances};
use dalembert::kernel::{Context, Free, ModeKernel, ModeKernels};
use dalembert::model::models;
use dalembert::record::{Event, Recorded, Silent, Snapshot};
use dalembert::scene::Scene;
use dalembert::with_kernel;
use nalgebra::Const;
use nalgebra::{SMatrix, SVector};
use std::path::Path;
use std::time::Instant;

/// Repeats of which the fastest counts; more do not change the second digit of the ratios.
const REPEATS: usize = 50;

/// The tank's coordinates besides its height, which every mode holds.
const ALL: usize = 3;

fn main() {
    println!("1. free coordinates of each mode, against always all {ALL}\n");
    println!(
        "{:24}{:>12}{:>12}{:>8}   largest difference",
        "scene", "free / µs", "all / µs", "ratio"
    );
    for name in [
        "tank_full_plate",
        "tank_doughnut",
        "tank_free_release",
        "tank_rocks_and_slides",
    ] {
        let problem = problem(name, &[]);
        let stretches = stretches(&problem);
        let (mut free, mut all, mut difference) = (0.0, 0.0, 0.0);
        // One by one: short work is seldom interrupted, so its minimum is its own.
        for stretch in &stretches {
            let (time, end) = fastest(|| integrate_free(&problem, stretch));
            let (other_time, other_end) = fastest(|| integrate_all(&problem, stretch));
            free += time;
            all += other_time;
            difference = f64::max(difference, (end - other_end).abs().max());
        }
        println!(
            "{name:24}{free:12.0}{all:12.0}{:8.2}   {difference:.0e} m or rad",
            all / free
        );
    }

    println!(
        "\n2. the doughnut under 1 m/s², where nothing slips or lifts, with and without its guards\n"
    );
    println!("{:24}{:>12}{:>12}", "frozen", "guards", "run / µs");
    let quiet = "inputs.ground_acceleration.sine.amplitude=1";
    let mut times = Vec::new();
    for freeze in ["[]", r#"["x"]"#, r#"["theta", "x"]"#] {
        let problem = problem("tank_doughnut", &[quiet, &format!("freeze={freeze}")]);
        let (time, events) = fastest(|| {
            simulate(&problem, &mut Silent)
                .expect("it starts")
                .events
                .len()
        });
        assert_eq!(events, 0);
        println!("{freeze:24}{:12}{time:12.0}", guards(&problem));
        times.push(time);
    }
    println!("ratio {:.2}", times[0] / times[2]);
}

/// A scene with nothing recorded but the events and the end.
fn problem(scene: &str, overrides: &[&str]) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let overrides: Vec<String> = overrides.iter().map(|&o| o.into()).collect();
    let scene = Scene::load(
        &folder.join(scene).with_extension("json"),
        &overrides,
        models(),
    )
    .unwrap_or_else(|errors| panic!("{errors}"));
    let mut problem = scene.problem;
    problem.record.every = Some(f64::INFINITY);
    problem.record.columns = Recorded {
        outputs: false,
        reactions: false,
        energies: false,
        inputs: false,
    };
    problem
}

/// Fastest of the repeats, µs, with the result.
fn fastest<T>(work: impl Fn() -> T) -> (f64, T) {
    let mut result = work();
    let mut least = f64::INFINITY;
    for _ in 0..REPEATS {
        let start = Instant::now();
        result = work();
        least = least.min(start.elapsed().as_secs_f64());
    }
    (1e6 * least, result)
}

/// Number of guards of the mode at the start that lead to a mode the scene may visit.
fn guards(problem: &Problem) -> usize {
    let modes = &problem.variant().modes;
    let allowed = |m: usize| problem.freeze.iter().all(|i| !modes[m].free.contains(i));
    let leads_on = |g: &&dalembert::model::Guard| g.transitions.iter().any(|t| allowed(t.target));
    modes[0].guards.iter().filter(leads_on).count()
}

/// Motion between two events.
struct Stretch {
    mode: usize,
    start: f64,
    duration: f64,
    from: Snapshot,
}

fn stretches(problem: &Problem) -> Vec<Stretch> {
    let run = simulate(problem, &mut Silent).expect("the initial state fits a mode");
    let initial = &problem.initial;
    let start = Snapshot {
        q: initial.q.clone(),
        v: initial.v.clone(),
        discrete: initial.discrete.clone(),
        reactions: Vec::new(),
        outputs: Vec::new(),
    };
    let mode = run.events.first().map_or(run.end.j as usize, |e| e.from);
    let starts = std::iter::once((0.0, mode, start));
    let after = |e: Event| (e.t, e.to, e.after);
    let ends: Vec<f64> = run.events.iter().map(|e| e.t).chain([run.end.t]).collect();
    let starts = starts.chain(run.events.into_iter().map(after));
    let stretch = |((start, mode, from), end): ((f64, usize, Snapshot), f64)| Stretch {
        mode,
        start,
        duration: end - start,
        from,
    };
    // Hops at the end of an accumulation are shorter than the last place of t.
    starts
        .zip(ends)
        .map(stretch)
        .filter(|s| s.duration > 0.0)
        .collect()
}

/// A mode's equations over a stretch.
struct Reduced<'a, const F: usize> {
    kernel: &'a ModeKernel<Const<F>>,
    context: Context,
    signals: &'a Signals,
    start: f64,
}

impl<'a, const F: usize> Reduced<'a, F> {
    fn new(problem: &'a Problem, stretch: &Stretch, kernel: &'a ModeKernel<Const<F>>) -> Self {
        let mut context = Context::new(&problem.model, &problem.parameters);
        context
            .discrete_mut()
            .copy_from_slice(&stretch.from.discrete);
        context.held_mut().copy_from_slice(&stretch.from.q);
        Reduced {
            kernel,
            context,
            signals: &problem.signals,
            start: stretch.start,
        }
    }

    fn at(&mut self, t: f64) {
        self.signals
            .evaluate(self.start + t, self.context.signals_mut()[0]);
    }
}

type Vector<const F: usize> = SVector<f64, F>;
type Matrix<const F: usize> = SMatrix<f64, F, F>;

impl<const F: usize> System<Const<F>> for Reduced<'_, F> {
    fn residual(&mut self, t: f64, q: &Vector<F>, v: &Vector<F>, a: &Vector<F>, r: &mut Vector<F>) {
        self.at(t);
        self.kernel.residual(&self.context, Free { q, v, a }, r);
    }

    fn jacobian(
        &mut self,
        t: f64,
        q: &Vector<F>,
        v: &Vector<F>,
        a: &Vector<F>,
        m: &mut Matrix<F>,
        c: &mut Matrix<F>,
        k: &mut Matrix<F>,
    ) {
        self.at(t);
        let mut out = [SMatrix::zeros(); 3];
        self.kernel
            .jacobian(&self.context, Free { q, v, a }, &mut out);
        [*m, *c, *k] = out;
    }
}

/// All coordinates, of which some are held by a = 0.
struct Whole<'a> {
    all: Reduced<'a, ALL>,
    held: [bool; ALL],
}

impl System<Const<ALL>> for Whole<'_> {
    fn residual(
        &mut self,
        t: f64,
        q: &Vector<ALL>,
        v: &Vector<ALL>,
        a: &Vector<ALL>,
        r: &mut Vector<ALL>,
    ) {
        self.all.residual(t, q, v, a, r);
        for i in (0..ALL).filter(|&i| self.held[i]) {
            r[i] = a[i];
        }
    }

    fn jacobian(
        &mut self,
        t: f64,
        q: &Vector<ALL>,
        v: &Vector<ALL>,
        a: &Vector<ALL>,
        m: &mut Matrix<ALL>,
        c: &mut Matrix<ALL>,
        k: &mut Matrix<ALL>,
    ) {
        self.all.jacobian(t, q, v, a, m, c, k);
        for i in (0..ALL).filter(|&i| self.held[i]) {
            for j in 0..ALL {
                m[(i, j)] = if i == j { 1.0 } else { 0.0 };
                (c[(i, j)], k[(i, j)]) = (0.0, 0.0);
            }
        }
    }
}

/// Integrates a stretch; the coordinates `free` at its end are put into those of all.
fn integrate<const F: usize, Y: System<Const<F>>>(
    problem: &Problem,
    stretch: &Stretch,
    free: &[usize],
    system: &mut Y,
) -> Vector<ALL> {
    let pick = |all: &[f64]| Vector::<F>::from_fn(|i, _| all[free[i]]);
    let (q, v) = (pick(&stretch.from.q), pick(&stretch.from.v));
    let accuracy = &problem.accuracy;
    let absolute = (pick(&accuracy.q_absolute), pick(&accuracy.v_absolute));
    let tolerances = Tolerances::new(accuracy.relative, absolute.0, absolute.1)
        .expect("a scene's tolerances are positive");
    let mut a = Vector::<F>::zeros();
    system
        .acceleration(0.0, &q, &v, &mut a)
        .expect("a regular mass matrix");
    let mut radau = Radau::<3, Const<F>>::new(&tolerances);
    radau.restart(0.0, &q, &v, &a);
    while radau.state().t < stretch.duration {
        let longest = problem.signals.resolution(stretch.start + radau.state().t);
        radau
            .step(system, stretch.duration, longest)
            .expect("the step succeeds");
    }
    let mut end = Vector::<ALL>::from_row_slice(&stretch.from.q[..ALL]);
    for (i, &coordinate) in free.iter().enumerate() {
        end[coordinate] = radau.state().q[i];
    }
    end
}

fn integrate_free(problem: &Problem, stretch: &Stretch) -> Vector<ALL> {
    let mode = &problem.variant().modes[stretch.mode];
    with_kernel!(&mode.kernels,
        kernel => integrate(problem, stretch, &mode.free, &mut Reduced::new(problem, stretch, kernel)),
        _any => unreachable!("few are free")
    )
}

fn integrate_all(problem: &Problem, stretch: &Stretch) -> Vector<ALL> {
    let modes = &problem.variant().modes;
    let kernels = modes.iter().map(|m| &m.kernels);
    let mut all = kernels.filter_map(|k| {
        if let ModeKernels::F3(k) = k {
            Some(k)
        } else {
            None
        }
    });
    let kernel = all.next().expect("in one mode all are free");
    let free = &modes[stretch.mode].free;
    let mut system = Whole {
        all: Reduced::new(problem, stretch, kernel),
        held: std::array::from_fn(|i| !free.contains(&i)),
    };
    integrate(problem, stretch, &[0, 1, 2], &mut system)
}
