//! What a program without unsafe code may do with the kernels of models: it gets numbers or a panic, and
//! never memory that is not there.

#![forbid(unsafe_code)]

use dalembert::integrate::{Matrix, ORDERS, Series, Size, Vector};
use dalembert::kernel::{Context, Free, ModeKernel};
use dalembert::model::models;
use dalembert::model::{Guard, Mode, Model, Variant};
use dalembert::with_kernel;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// A mode with the model that it is of.
type Of<'m> = (&'m Model, &'m Mode);

fn all_models() -> Vec<Arc<Model>> {
    models().iter().collect()
}

fn modes(models: &[Arc<Model>]) -> impl Iterator<Item = Of<'_>> {
    models.iter().flat_map(|model| {
        let modes = model.automata().flat_map(|variant| &variant.modes);
        modes.map(move |mode| (&**model, mode))
    })
}

/// A context with the default parameters.
fn context(model: &Model) -> Context {
    let parameters: Vec<_> = model.parameters.iter().map(|p| p.default).collect();
    Context::new(model, &parameters)
}

fn refuses<T>(call: impl FnOnce() -> T) -> bool {
    catch_unwind(AssertUnwindSafe(call)).is_err()
}

/// Room for a reset of a model.
fn room(model: &Model) -> Vec<f64> {
    vec![0.0; 2 * model.coordinates.len() + model.discretes.len()]
}

/// What the functions of a kernel that are passed a guard, or a transition of it, make of those of another
/// model: names of the functions that take it.
fn taken<F: Size>(kernel: &ModeKernel<F>, own: Of, guard: &Guard) -> Vec<&'static str> {
    let rest = kernel.size().zeros();
    let (q, v, a) = (&rest, &rest, &rest);
    let at = Free { q, v, a };
    let x = context(own.0);
    let own_guard = &guard.kernel;
    let mut taken = Vec::new();
    let mut expect_refusal = |name, refused: bool| {
        if !refused {
            taken.push(name);
        }
    };
    expect_refusal("guard", refuses(|| kernel.guard(&x, own_guard, at)));
    expect_refusal(
        "guard_rate",
        refuses(|| kernel.guard_rate(&x, own_guard, at, &rest)),
    );
    expect_refusal(
        "guard_magnitude",
        refuses(|| kernel.guard_magnitude(&x, own_guard, at)),
    );
    expect_refusal(
        "guard_rounding",
        refuses(|| kernel.guard_rounding(&x, own_guard, at)),
    );
    for transition in &guard.transitions {
        let transition = &transition.kernel;
        let mut out = room(own.0);
        expect_refusal(
            "reset",
            refuses(|| kernel.reset(&x, transition, at, &mut out)),
        );
        if transition.says_impulses() {
            expect_refusal(
                "impulses",
                refuses(|| drop(kernel.impulses(&x, transition, at))),
            );
        }
        if transition.conditions() > 0 {
            let (mut x, after) = (context(own.0), room(own.0));
            let after = (&*after, &*own.1.free);
            expect_refusal(
                "conditions",
                refuses(|| kernel.conditions(&mut x, transition, after).is_some()),
            );
        }
    }
    taken
}

/// One test, since the hook that prints panics is one of the process.
#[test]
fn a_kernel_takes_nothing_of_another_model() {
    std::panic::set_hook(Box::new(|_| {}));
    let models = all_models();
    let (mut pairs, mut wrong) = (0, Vec::new());
    for own in modes(&models) {
        for (model, mode) in modes(&models) {
            // Those of other numbers of coordinates are refused by these.
            if std::ptr::eq(own.0, model) || own.1.free.len() != mode.free.len() {
                continue;
            }
            for guard in &mode.guards {
                let taken = with_kernel!(&own.1.kernels, k => taken(k, own, guard));
                if !taken.is_empty() {
                    wrong.push(format!(
                        "{} {} takes {taken:?} of {} {}",
                        own.0.name, own.1.name, model.name, guard.name
                    ));
                }
                pairs += 1;
            }
            let of_another = context(model);
            let takes = with_kernel!(&own.1.kernels, k => {
                let rest = k.size().zeros();
                let at = Free { q: &rest, v: &rest, a: &rest };
                !refuses(|| k.energies(&of_another, at))
            });
            if takes {
                wrong.push(format!("{} takes a context of {}", own.0.name, model.name));
            }
        }
    }
    let _ = std::panic::take_hook();
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(pairs > 100, "only {pairs} pairs");
}

#[test]
fn a_kernel_takes_what_is_of_its_own_model() {
    let models = all_models();
    for own in modes(&models) {
        let x = context(own.0);
        with_kernel!(&own.1.kernels, k => {
            let rest = k.size().zeros();
            let at = Free { q: &rest, v: &rest, a: &rest };
            for guard in &own.1.guards {
                let _ = k.guard(&x, &guard.kernel, at);
                let _ = k.guard_magnitude(&x, &guard.kernel, at);
                let _ = k.guard_rounding(&x, &guard.kernel, at);
                for transition in &guard.transitions {
                    k.reset(&x, &transition.kernel, at, &mut room(own.0));
                    let _ = k.impulses(&x, &transition.kernel, at);
                }
            }
        });
    }
}

/// What is written before a call: not a number, with bits that no calculation gives.
const UNWRITTEN: u64 = 0x7ff8_5eed_5eed_5eed;

/// Room of exactly so many numbers.
fn unwritten(count: usize) -> Vec<f64> {
    vec![f64::from_bits(UNWRITTEN); count]
}

fn is_written<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> bool {
    numbers.into_iter().all(|x| x.to_bits() != UNWRITTEN)
}

/// Calls all functions of a mode with arrays of exactly their sizes, each in memory of its own where a
/// sanitizer sees who leaves it; names those that leave an output as it was.
fn call_all<F: Size>(kernel: &ModeKernel<F>, (model, mode): Of, variant: &Variant) -> Vec<String> {
    let mut unfinished = Vec::new();
    let mut expect = |what: &str, written: bool| {
        if !written {
            unfinished.push(format!("{}: {}: {what}", model.name, mode.name));
        }
    };
    let mut x = context(model);
    // Somewhere near the beginning, moving a little.
    let size = kernel.size();
    let numbers = |scale: f64| {
        let number = |i: usize| scale * (1.0 + i as f64);
        Box::new(size.vector(number))
    };
    let (q, v, a) = (numbers(0.01), numbers(0.1), numbers(1.0));
    let at = Free {
        q: &*q,
        v: &*v,
        a: &*a,
    };
    let coordinates = model.coordinates.len();
    let forces = coordinates + model.motions.len();

    let mut r = Box::new(size.repeat(f64::from_bits(UNWRITTEN)));
    kernel.residual(&x, at, &mut r);
    expect("residual", is_written(r.as_slice()));
    let mut square = size.zero_matrix();
    square.as_mut_slice().fill(f64::from_bits(UNWRITTEN));
    let mut matrices = Box::new([(); 3].map(|()| square.clone()));
    kernel.jacobian(&x, at, &mut matrices);
    expect(
        "jacobian",
        is_written(matrices.iter().flat_map(|matrix| matrix.as_slice())),
    );
    let _ = kernel.system(&x, at.q, at.v);
    let _ = kernel.inertia(&x, at.q, at.v);
    let _ = kernel.jerk_load(&x, at);
    let _ = kernel.magnitude(&x, at);
    let _ = kernel.energies(&x, at);
    let _ = kernel.powers(&x, at);
    let mut out = unwritten(forces);
    kernel.reactions(&x, at, &mut out);
    expect("reactions", is_written(&out));
    let mut out = unwritten(forces);
    kernel.momenta(&x, at, &mut out);
    expect("momenta", is_written(&out));
    // The margins of limit states and of validity follow the requirements.
    let watched = mode.requirements.len() + mode.margins.len();
    let mut out = unwritten(watched);
    kernel.requirements(&x, at, &mut out);
    expect("requirements", is_written(&out));
    let mut out = unwritten(watched);
    kernel.requirement_roundings(&x, at, &mut out);
    expect("requirement_roundings", is_written(&out));
    let mut out = unwritten(coordinates);
    kernel.drift(&x, &mut out);
    expect("drift", is_written(&out));
    kernel.coordinates(&x, at, &mut out);
    expect("coordinates", is_written(&out));
    kernel.rates(&x, at, &mut out);
    expect("rates", is_written(&out));
    kernel.accelerations(&x, at, &mut out);
    expect("accelerations", is_written(&out));

    for guard in &mode.guards {
        let _ = kernel.guard(&x, &guard.kernel, at);
        let _ = kernel.guard_magnitude(&x, &guard.kernel, at);
        let _ = kernel.guard_rounding(&x, &guard.kernel, at);
        let _ = kernel.guard_rate(&x, &guard.kernel, at, &a);
        for transition in &guard.transitions {
            let mut out = unwritten(room(model).len());
            kernel.reset(&x, &transition.kernel, at, &mut out);
            expect(transition.name, is_written(&out));
            let _ = kernel.impulses(&x, &transition.kernel, at);
            let target = &variant.modes[transition.target];
            let free = &target.free;
            with_kernel!(&target.kernels, target => {
                let _ = target.conditions(&mut x, &transition.kernel, (&out, free));
            });
        }
    }

    let mut series = Box::new(Series::zero(size));
    let mut inverse = size.zero_matrix();
    for i in 0..size.get() {
        (series.q[0][i], series.v[0][i], series.a[0][i]) = (q[i], v[i], a[i]);
        (series.q[1][i], series.v[1][i], series.q[2][i]) = (v[i], a[i], a[i] / 2.0);
        inverse[(i, i)] = 1.0;
    }
    for autonomous in [false, true] {
        x.autonomous = autonomous;
        for orders in 1..=ORDERS - 2 {
            let mut series = series.clone();
            let _ = kernel.series_start(&mut x, &series);
            kernel.series_run(&mut x, orders, &inverse, &mut series);
            kernel.guard_series(&mut x, orders, &series);
            let mut out = unwritten(watched);
            kernel.requirement_bounds(&mut x, (&series, orders), 1e-3, &mut out);
            expect("requirement_bounds", is_written(&out));
        }
    }
    unfinished
}

#[test]
fn every_function_writes_all_its_outputs() {
    let mut unfinished = Vec::new();
    for model in models().iter() {
        // The lean ones too.
        for variant in model.automata() {
            for mode in &variant.modes {
                unfinished
                    .extend(with_kernel!(&mode.kernels, k => call_all(k, (&model, mode), variant)));
            }
        }
    }
    assert!(unfinished.is_empty(), "{unfinished:#?}");
}
