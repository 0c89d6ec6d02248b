//! Typed errors, with the state as it was.

use crate::problems::Oscillator;
use crate::tolerances;
use dalembert::integrate::{Radau, StepError, System};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector, vector};

/// A system given by functions of (t, q, v, a); M, C, K likewise.
struct Given<R, J>(R, J);

impl<R: FnMut(f64, f64, f64, f64) -> f64, J: FnMut(f64, f64, f64, f64) -> [f64; 3]> System<Const<1>>
    for Given<R, J>
{
    fn residual(
        &mut self,
        t: f64,
        q: &SVector<f64, 1>,
        v: &SVector<f64, 1>,
        a: &SVector<f64, 1>,
        r: &mut SVector<f64, 1>,
    ) {
        r[0] = self.0(t, q[0], v[0], a[0]);
    }
    fn jacobian(
        &mut self,
        t: f64,
        q: &SVector<f64, 1>,
        v: &SVector<f64, 1>,
        a: &SVector<f64, 1>,
        m: &mut SMatrix<f64, 1, 1>,
        c: &mut SMatrix<f64, 1, 1>,
        k: &mut SMatrix<f64, 1, 1>,
    ) {
        [m[0], c[0], k[0]] = self.1(t, q[0], v[0], a[0]);
    }
}

/// Steps from (t = 1, q = 1, v = 0, a) until an error.
fn failure(system: &mut impl System<Const<1>>, a: f64) -> StepError {
    let mut radau = Radau::<3, Const<1>>::new(&tolerances(1e-6, 1.0, 1.0));
    radau.restart(1.0, &vector![1.0], &vector![0.0], &vector![a]);
    loop {
        let before = *radau.state();
        if let Err(error) = radau.step(system, 10.0, f64::INFINITY) {
            assert_eq!(*radau.state(), before, "the state is unchanged");
            return error;
        }
    }
}

#[test]
fn a_vanishing_mass_matrix_is_singular() {
    let mut system = Given(|_, _, _, _| 1.0, |_, _, _, _| [0.0, 0.0, 0.0]);
    let error = failure(&mut system, 0.0);
    assert!(
        matches!(
            error,
            StepError::Singular {
                t: 1.0,
                coordinate: 0,
                ..
            }
        ),
        "{error}"
    );
    assert!(error.to_string().contains("effective mass"), "{error}");
}

#[test]
fn a_wrong_jacobian_fails_in_newton() {
    let mut system = Given(|_, q, _, a| a + q, |_, _, _, _| [-0.4, 0.0, 1.0]);
    let error = failure(&mut system, -1.0);
    assert!(matches!(error, StepError::Newton { .. }), "{error}");
}

#[test]
fn an_equation_that_ends_is_followed_to_its_end() {
    // a = −1/(2 √q)³-like force that is undefined below q = 0: q reaches 0 in finite time.
    let mut system = Given(
        |_, q: f64, _, a| a + 1.0 / q.sqrt(),
        |_, q: f64, _, _| [1.0, 0.0, -0.5 / (q * q.sqrt())],
    );
    match failure(&mut system, -1.0) {
        // Energy: v²/2 + 2√q = 2 from q = 1, so the time is ∫ dq/(2 √(1 − √q)) = 4/3.
        StepError::NonFinite { t, .. }
        | StepError::Tolerance { t, .. }
        | StepError::Newton { t, .. } => assert!((t - (1.0 + 4.0 / 3.0)).abs() < 1e-6, "{t}"),
        error => panic!("{error}"),
    }
}

#[test]
fn equations_that_are_not_finite_are_named() {
    let mut system = Given(|_, _, _, _| f64::NAN, |_, _, _, _| [1.0, 0.0, 0.0]);
    let error = failure(&mut system, 0.0);
    assert!(
        matches!(
            error,
            StepError::NonFinite {
                what: "the residual",
                ..
            }
        ),
        "{error}"
    );
    let mut system = Given(|_, _, _, a| a, |_, _, _, _| [f64::NAN, 0.0, 0.0]);
    let error = failure(&mut system, 0.0);
    assert!(
        matches!(
            error,
            StepError::NonFinite {
                what: "the Jacobian",
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn a_start_that_is_not_finite_is_refused() {
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.0,
        linear: false,
    };
    let error = failure(&mut oscillator, f64::INFINITY);
    assert!(
        matches!(
            error,
            StepError::NonFinite {
                what: "an acceleration",
                h: 0.0,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn a_jump_of_the_force_is_passed_with_short_steps() {
    // The engine cuts steps at jumps it knows of; one it does not know must not stop the run.
    let force = |t: f64| if t < 1.5 { 0.0 } else { 1.0 };
    let mut system = Given(move |t, _, _, a| a - force(t), |_, _, _, _| [1.0, 0.0, 0.0]);
    let mut radau = Radau::<3, Const<1>>::new(&tolerances(1e-6, 1.0, 1.0));
    radau.restart(1.0, &vector![0.0], &vector![0.0], &vector![0.0]);
    while radau.state().t < 2.5 {
        radau.step(&mut system, 2.5, f64::INFINITY).unwrap();
    }
    // The tolerance of the estimate is ten times the one asked for, which smooth motion would meet.
    assert!(
        (radau.state().v[0] - 1.0).abs() < 1e-4,
        "{}",
        radau.state().v
    );
    assert!(radau.counters().rejected > 0);
}
