//! What a program without unsafe code may do with the kernels of models: it gets numbers or a panic, and
//! never memory that is not there.

#![forbid(unsafe_code)]

use dalembert::kernel::{Context, Free, MODELS, ModeKernel};
use dalembert::model::{Guard, Mode, Model};
use dalembert::with_kernel;
use nalgebra::SVector;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A mode with the model that it is of.
type Of = (&'static Model, &'static Mode);

fn modes() -> impl Iterator<Item = Of> {
    MODELS.iter().flat_map(|&model| {
        let modes = model.automata().flat_map(|variant| variant.modes);
        modes.map(move |mode| (model, mode))
    })
}

/// A context with the default parameters.
fn context(model: &'static Model) -> Context {
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
fn taken<const F: usize>(kernel: &ModeKernel<F>, own: Of, guard: &Guard) -> Vec<&'static str> {
    let rest = SVector::<f64, F>::zeros();
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
    for transition in guard.transitions {
        let transition = &transition.kernel;
        let mut out = room(own.0);
        expect_refusal(
            "reset",
            refuses(|| kernel.reset(&x, transition, at, &mut out)),
        );
        if transition.conditions() > 0 {
            let mut out = Default::default();
            expect_refusal(
                "conditions",
                refuses(|| kernel.conditions(&x, transition, at, &mut out).len()),
            );
        }
    }
    taken
}

/// One test, since the hook that prints panics is one of the process.
#[test]
fn a_kernel_takes_nothing_of_another_model() {
    std::panic::set_hook(Box::new(|_| {}));
    let (mut pairs, mut wrong) = (0, Vec::new());
    for own in modes() {
        for (model, mode) in modes() {
            // Those of other numbers of coordinates are refused by these.
            if std::ptr::eq(own.0, model) || own.1.free.len() != mode.free.len() {
                continue;
            }
            for guard in mode.guards {
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
                let rest = SVector::zeros();
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
    for own in modes() {
        let x = context(own.0);
        with_kernel!(&own.1.kernels, k => {
            let rest = SVector::zeros();
            let at = Free { q: &rest, v: &rest, a: &rest };
            for guard in own.1.guards {
                let _ = k.guard(&x, &guard.kernel, at);
                let _ = k.guard_magnitude(&x, &guard.kernel, at);
                for transition in guard.transitions {
                    k.reset(&x, &transition.kernel, at, &mut room(own.0));
                }
            }
        });
    }
}
