//! Order of convergence of the end point and of the dense output, with steps of fixed length.

use crate::problems::{DoublePendulum, Oscillator};
use crate::{start, tolerances};
use dalembert::integrate::{Coefficients, Radau, RadauIia, System};
use nalgebra::Const;
use nalgebra::{SVector, vector};

/// Steps of length h from (0, q, v) to time `t`, without error control; `visit` sees each.
fn fixed<const S: usize, const F: usize>(
    system: &mut impl System<Const<F>>,
    q: SVector<f64, F>,
    v: SVector<f64, F>,
    t: f64,
    steps: usize,
    mut visit: impl FnMut(&Radau<S, Const<F>>),
) -> Radau<S, Const<F>>
where
    RadauIia<S>: Coefficients<S>,
{
    // Newton's iteration to rounding.
    let mut radau = start::<S, F>(system, q, v, &tolerances(1e-14, 1.0, 1.0));
    for step in 0..steps {
        if step > 0 {
            let state = *radau.state();
            radau.restart(state.t, &state.q, &state.v, &state.a);
        }
        radau.step_exactly(system, t / steps as f64).unwrap();
        visit(&radau);
    }
    radau
}

/// log₂ of the quotient of the errors with n and 2n steps.
fn measured(error: impl Fn(usize) -> f64, steps: usize) -> f64 {
    let (coarse, fine) = (error(steps), error(2 * steps));
    assert!(fine > 1e-14, "the error {fine:e} is rounding");
    (coarse / fine).log2()
}

fn end_point<const S: usize>(steps: usize)
where
    RadauIia<S>: Coefficients<S>,
{
    let (q, v) = (vector![1.5, -1.0], vector![0.0, 0.5]);
    let mut pendulum = DoublePendulum { g: 1.0 };
    let exact = *fixed::<7, 2>(&mut pendulum, q, v, 2.0, 128, |_| ()).state();
    let error = |steps| {
        let mut pendulum = DoublePendulum { g: 1.0 };
        let state = *fixed::<S, 2>(&mut pendulum, q, v, 2.0, steps, |_| ()).state();
        (state.q - exact.q).amax().max((state.v - exact.v).amax())
    };
    let order = measured(error, steps);
    let expected = 2.0 * S as f64 - 1.0;
    assert!((order - expected).abs() < 0.25, "S = {S}: order {order}");
}

#[test]
fn end_point_has_order_2s_minus_1() {
    end_point::<1>(512);
    end_point::<3>(32);
    end_point::<5>(12);
}

/// For 13 the pendulum leaves no room between the steps on which Newton's iteration converges and
/// rounding; a linear motion does.
#[test]
fn seven_stages_have_order_13_on_a_linear_motion() {
    let error = |steps| {
        let mut oscillator = Oscillator {
            omega: 1.0,
            zeta: 0.0,
            linear: true,
        };
        let (q, v) = (vector![1.0], vector![0.0]);
        let state = *fixed::<7, 1>(&mut oscillator, q, v, 12.0, steps, |_| ()).state();
        (state.q[0] - 12f64.cos())
            .abs()
            .max((state.v[0] + 12f64.sin()).abs())
    };
    let order = measured(error, 5);
    assert!((order - 13.0).abs() < 0.25, "order {order}");
}

/// Largest errors of q, v and a between the ends of the steps.
fn dense_errors<const S: usize>(t: f64, steps: usize) -> [f64; 3]
where
    RadauIia<S>: Coefficients<S>,
{
    let mut oscillator = Oscillator {
        omega: 1.0,
        zeta: 0.0,
        linear: false,
    };
    let mut worst = [0.0_f64; 3];
    let h = t / steps as f64;
    fixed::<S, 1>(
        &mut oscillator,
        vector![0.8],
        vector![0.6],
        t,
        steps,
        |radau| {
            let dense = radau.dense().unwrap();
            for part in 0..=20 {
                let t = dense.start() + h * f64::from(part) / 20.0;
                let (q, v, a) = dense.at(t);
                let (sin, cos) = t.sin_cos();
                let (exact_q, exact_v) = (0.8 * cos + 0.6 * sin, 0.6 * cos - 0.8 * sin);
                worst[0] = worst[0].max((q[0] - exact_q).abs());
                worst[1] = worst[1].max((v[0] - exact_v).abs());
                worst[2] = worst[2].max((a[0] + exact_q).abs());
            }
        },
    );
    worst
}

/// Orders of q, v and a in the dense output: over one step, and over many.
fn dense_orders<const S: usize>(local: [f64; 3], global: [f64; 3], t: f64, steps: usize)
where
    RadauIia<S>: Coefficients<S>,
{
    for i in 0..3 {
        let error = |parts| dense_errors::<S>(t / parts as f64, 1)[i];
        let order = measured(error, 1);
        assert!(
            (order - local[i]).abs() < 0.3,
            "S = {S}, one step, derivative {i}: {order}"
        );
        let order = measured(|steps| dense_errors::<S>(4.0, steps)[i], steps);
        assert!(
            (order - global[i]).abs() < 0.3,
            "S = {S}, derivative {i}: {order}"
        );
    }
}

#[test]
fn dense_output_has_the_documented_order() {
    dense_orders::<3>([6.0, 5.0, 4.0], [5.0, 5.0, 4.0], 0.5, 20);
    dense_orders::<5>([8.0, 7.0, 6.0], [8.0, 7.0, 6.0], 1.0, 6);
    dense_orders::<7>([10.0, 9.0, 8.0], [10.0, 9.0, 8.0], 2.0, 3);
}

#[test]
fn stages_integrate_with_the_order_of_the_method() {
    // The work of the spring in one step, ∫ −q v dt.
    let error = |parts: usize| {
        let mut oscillator = Oscillator {
            omega: 1.0,
            zeta: 0.0,
            linear: true,
        };
        let mut radau = start::<3, 1>(
            &mut oscillator,
            vector![0.3],
            vector![1.0],
            &tolerances(1e-12, 1.0, 1.0),
        );
        radau
            .step_exactly(&mut oscillator, 1.0 / parts as f64)
            .unwrap();
        let work: f64 = radau
            .stages()
            .map(|node| -node.weight * node.state.q[0] * node.state.v[0])
            .sum();
        let end = radau.stages().last().unwrap();
        assert_eq!(end.state.a, radau.state().a);
        let (sin, cos) = radau.state().t.sin_cos();
        (work - 0.5 * (0.3 * 0.3 - (0.3 * cos + sin).powi(2))).abs()
    };
    let order = measured(error, 16);
    assert!((order - 6.0).abs() < 0.3, "local order {order}");
}
