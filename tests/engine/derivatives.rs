//! Every generated function of every mode of every model and variant against the others: Jacobians
//! and rates against differences, the energies against the power of the forces.

use dalembert::hybrid::Problem;
use dalembert::integrate::solve;
use dalembert::kernel::{Context, Free, ModeKernel};
use dalembert::model::models;
use dalembert::model::{InputKind, Mode, Model, Variant};
use dalembert::with_kernel;
use nalgebra::Const;
use nalgebra::{SMatrix, SVector};

/// Random numbers of a fixed sequence (xorshift64*: Vigna 2016).
struct Random(u64);

impl Random {
    /// Uniform on (−1, 1).
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A point of a motion with the jerk given: what moves, and how fast.
struct Point<const F: usize> {
    context: Context,
    q: SVector<f64, F>,
    v: SVector<f64, F>,
    a: SVector<f64, F>,
    jerk: SVector<f64, F>,
    drift: Vec<f64>,
}

impl<const F: usize> Point<F> {
    fn random(
        model: &Model,
        mode: &Mode,
        kernel: &ModeKernel<Const<F>>,
        random: &mut Random,
    ) -> Self {
        let parameters: Vec<f64> = (model.parameters.iter())
            .map(|p| (p.default * (1.0 + 0.01 * random.next())).clamp(p.minimum, p.maximum))
            .collect();
        let mut context = Context::new(model, &parameters);
        for (value, discrete) in context.discrete_mut().iter_mut().zip(&model.discretes) {
            *value = discrete.values[usize::from(random.next() > 0.0)];
        }
        for (i, c) in model.coordinates.iter().enumerate() {
            let q = c.scale * random.next();
            context.held_mut()[i] = c.minimum.map_or(q, |m| m + q.abs());
        }
        let mut held = vec![0.0; model.coordinates.len()];
        let free = SVector::from_fn(|i, _| context.held()[mode.free[i]]);
        let at = Free {
            q: &free,
            v: &free,
            a: &free,
        };
        kernel.coordinates(&context, at, &mut held);
        context.held_mut()[..held.len()].copy_from_slice(&held);
        let [signals, rates] = context.signals_mut();
        signals.fill_with(|| random.next());
        rates.fill_with(|| random.next());
        for input in model
            .inputs
            .iter()
            .filter(|i| i.kind == InputKind::Acceleration)
        {
            // Velocity and displacement of the ground belong to its acceleration.
            for k in 0..2 {
                rates[input.signal + k + 1] = signals[input.signal + k];
            }
        }
        let held = context.held().to_vec();
        let mut drift = vec![0.0; model.coordinates.len()];
        kernel.drift(&context, &mut drift);
        let rate = |i: usize| model.coordinates[mode.free[i]].rate_scale;
        Point {
            context,
            q: SVector::from_fn(|i, _| held[mode.free[i]]),
            v: SVector::from_fn(|i, _| rate(i) * random.next()),
            a: SVector::from_fn(|i, _| rate(i) * random.next()),
            jerk: SVector::from_fn(|i, _| rate(i) * random.next()),
            drift,
        }
    }

    fn at(&self) -> Free<'_, Const<F>> {
        Free {
            q: &self.q,
            v: &self.v,
            a: &self.a,
        }
    }

    /// The point a time `t` later on the motion whose jerk and signal rates are constant.
    fn later(&self, t: f64) -> Self {
        let mut context = self.context.clone();
        let [signals, rates] = context.signals_mut();
        for (u, rate) in signals.iter_mut().zip(rates) {
            *u += *rate * t;
        }
        for (held, rate) in context.held_mut().iter_mut().zip(&self.drift) {
            *held += rate * t;
        }
        Point {
            context,
            q: self.q + (self.v + (self.a + self.jerk * (t / 3.0)) * (t / 2.0)) * t,
            v: self.v + (self.a + self.jerk * (t / 2.0)) * t,
            a: self.a + self.jerk * t,
            jerk: self.jerk,
            drift: self.drift.clone(),
        }
    }
}

/// f′(0) by central differences over ±h, ±h/2 and ±h/4, extrapolated (Richardson); the error is of
/// the order h⁶ and u/h.
fn derivative<const N: usize>(f: impl Fn(f64) -> SVector<f64, N>, h: f64) -> SVector<f64, N> {
    let central = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    let [coarse, middle, fine] = [central(h), central(h / 2.0), central(h / 4.0)];
    let [first, second] = [(middle * 4.0 - coarse) / 3.0, (fine * 4.0 - middle) / 3.0];
    (second * 16.0 - first) / 15.0
}

/// Compares relative to `size`, the largest magnitude involved.
fn close<const N: usize>(what: &str, found: &SVector<f64, N>, exact: &SVector<f64, N>, size: f64) {
    let error = (found - exact).amax();
    assert!(
        error <= 1e-9 * size,
        "{what}: {found} instead of {exact} (size {size:e})"
    );
}

fn residual<const F: usize>(kernel: &ModeKernel<Const<F>>, point: &Point<F>) -> SVector<f64, F> {
    let mut r = SVector::zeros();
    kernel.residual(&point.context, point.at(), &mut r);
    r
}

fn energy<const F: usize>(kernel: &ModeKernel<Const<F>>, point: &Point<F>) -> [f64; 2] {
    kernel.energies(&point.context, point.at())
}

/// Equations and their derivatives.
fn check_equations<const F: usize>(
    what: &str,
    kernel: &ModeKernel<Const<F>>,
    point: &Point<F>,
    scale: &SVector<f64, F>,
) {
    let r = residual(kernel, point);
    let system = kernel.system(&point.context, &point.q, &point.v);
    let sizes = kernel.magnitude(&point.context, point.at());
    // Two orders of evaluation, and terms that are products of a few factors.
    let rounding = 8.0 * sizes.amax() * f64::EPSILON;
    let linear = system.mass * point.a + system.load;
    assert!(
        (linear - r).amax() <= rounding,
        "{what}: r = {r}, M a + b = {linear}"
    );
    assert!(
        r.iter().zip(&sizes).all(|(r, size)| r.abs() <= *size),
        "{what}: magnitude"
    );

    let mut jacobians = [SMatrix::zeros(); 3];
    kernel.jacobian(&point.context, point.at(), &mut jacobians);
    let [m, c, k] = jacobians;
    assert!(
        (m - system.mass).amax() <= m.amax() * 1e-14,
        "{what}: mass matrix"
    );
    for j in 0..F {
        let moved = |h: f64, of: fn(&mut Point<F>) -> &mut SVector<f64, F>| {
            let mut moved = point.later(0.0);
            of(&mut moved)[j] += h;
            residual(kernel, &moved)
        };
        let step = 1e-2 * scale[j];
        let size = sizes.amax() / step * 1e-2;
        let by_v = derivative(|h| moved(h, |p| &mut p.v), step);
        close(
            &format!("{what}: ∂r/∂v[{j}]"),
            &c.column(j).into(),
            &by_v,
            size,
        );
        let by_q = derivative(|h| moved(h, |p| &mut p.q), step);
        close(
            &format!("{what}: ∂r/∂q[{j}]"),
            &k.column(j).into(),
            &by_q,
            size.max(k.amax()),
        );
    }
    let along = derivative(|t| residual(kernel, &point.later(t)), 1e-3);
    let load = kernel.jerk_load(&point.context, point.at()) + system.mass * point.jerk;
    close(
        &format!("{what}: jerk"),
        &load,
        &along,
        sizes.amax().max(along.amax()),
    );
}

fn check_guards<const F: usize>(
    what: &str,
    kernel: &ModeKernel<Const<F>>,
    mode: &Mode,
    point: &Point<F>,
) {
    for guard in &mode.guards {
        let value = |t: f64| {
            let point = point.later(t);
            SVector::from([kernel.guard(&point.context, &guard.kernel, point.at())])
        };
        let rate = kernel.guard_rate(&point.context, &guard.kernel, point.at(), &point.jerk);
        // Shorter where the guard changes quickly, as near a pole.
        let change = 0.02 * value(0.0)[0].abs() / rate.abs();
        let exact = derivative(value, change.min(1e-3));
        let size = value(0.0).amax().max(exact.amax());
        close(
            &format!("{what}: rate of {}", guard.name),
            &SVector::from([rate]),
            &exact,
            size,
        );
    }
}

/// ∂T/∂v, and the power of all forces on the motion that obeys the equations.
fn check_energies<const F: usize>(
    what: &str,
    kernel: &ModeKernel<Const<F>>,
    model: &Model,
    mode: &Mode,
    point: &Point<F>,
) {
    let mut momenta = vec![0.0; model.coordinates.len() + model.motions.len()];
    kernel.momenta(&point.context, point.at(), &mut momenta);
    let all_rates = |moved: &Point<F>| {
        let mut all = vec![0.0; model.coordinates.len()];
        kernel.rates(&moved.context, moved.at(), &mut all);
        all
    };
    for j in 0..mode.free.len() {
        // Momenta of what depends on a free coordinate count for it, too.
        let [mut before, mut after] = [point.later(0.0), point.later(0.0)];
        (before.v[j], after.v[j]) = (0.0, 1.0);
        let along = all_rates(&after).into_iter().zip(all_rates(&before));
        let of_all = along.zip(&momenta);
        let momentum: f64 = of_all
            .map(|((after, before), p)| (after - before) * p)
            .sum();
        let kinetic = |h: f64| {
            let mut moved = point.later(0.0);
            moved.v[j] += h;
            SVector::from([energy(kernel, &moved)[0]])
        };
        let exact = derivative(kinetic, 1.0);
        let size = kinetic(1.0).amax().max(kinetic(-1.0).amax());
        close(
            &format!("{what}: momentum"),
            &SVector::from([momentum]),
            &exact,
            size,
        );
    }
    let system = kernel.system(&point.context, &point.q, &point.v);
    let mut motion = point.later(0.0);
    motion.a = solve(&system.mass, &-system.load, &SVector::repeat(1.0)).expect("regular");
    motion.jerk.fill(0.0);
    let stored = |t: f64| SVector::from([energy(kernel, &motion.later(t)).iter().sum::<f64>()]);
    let [dissipated, input] = kernel.powers(&motion.context, motion.at());
    let exact = derivative(stored, 1e-2 / (1.0 + motion.a.amax()).sqrt());
    let size = stored(0.0).amax() * 1e3 + dissipated.abs() + input.abs();
    close(
        &format!("{what}: power"),
        &SVector::from([input - dissipated]),
        &exact,
        size,
    );
}

fn check_mode(model: &Model, variant: &Variant, mode: &Mode, random: &mut Random) {
    let what = format!("{} {:?} {}", model.name, variant.options, mode.name);
    // Sizes that the compiler does not know are those of other modes: the same functions.
    with_kernel!(&mode.kernels, kernel => {
        for _ in 0..5 {
            let point = Point::random(model, mode, kernel, random);
            let scale = SVector::from_fn(|i, _| model.coordinates[mode.free[i]].scale);
            check_equations(&what, kernel, &point, &scale);
            check_guards(&what, kernel, mode, &point);
            // Equations by hand need not belong to the energies.
            if !variant.options.iter().any(|o| o.contains("printed") || o.contains("corrected")) {
                check_energies(&what, kernel, model, mode, &point);
            }
        }
    }, _any => {});
}

#[test]
fn generated_functions_agree_with_each_other() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut modes = 0;
    for model in models().iter() {
        for variant in model.automata() {
            for mode in &variant.modes {
                check_mode(&model, variant, mode, &mut random);
                modes += 1;
            }
        }
    }
    assert!(modes > 20, "{modes} modes");
}

#[test]
fn every_model_starts_with_its_defaults() {
    for model in models().iter() {
        assert_eq!(
            Problem::new(&model).parameters.len(),
            model.parameters.len()
        );
    }
}
