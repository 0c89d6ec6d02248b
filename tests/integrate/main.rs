//! The integrators against independent values: orders, reference problems, dense output, failures.

mod dense;
mod failures;
mod order;
mod pleiades;
mod problems;
mod references;
mod robustness;
mod stepping;
mod stiff;

use dalembert::integrate::{
    Coefficients, Counters, Radau, RadauIia, State, StepError, System, Tolerances,
};
use nalgebra::Const;
use nalgebra::SVector;

/// Tolerances `relative` and `relative` × `size` for all components.
fn tolerances<const F: usize>(relative: f64, q_size: f64, v_size: f64) -> Tolerances<Const<F>> {
    let absolute = |size| SVector::repeat(relative * size);
    Tolerances::new(relative, absolute(q_size), absolute(v_size)).unwrap()
}

/// An integrator at (0, q, v), with the acceleration that belongs to it.
fn start<const S: usize, const F: usize>(
    system: &mut impl System<Const<F>>,
    q: SVector<f64, F>,
    v: SVector<f64, F>,
    tolerances: &Tolerances<Const<F>>,
) -> Radau<S, Const<F>>
where
    RadauIia<S>: Coefficients<S>,
{
    let mut a = SVector::zeros();
    system.acceleration(0.0, &q, &v, &mut a).unwrap();
    let mut radau = Radau::new(tolerances);
    radau.restart(0.0, &q, &v, &a);
    radau
}

/// The state at `t_end`.
fn run<const S: usize, const F: usize>(
    system: &mut impl System<Const<F>>,
    q: SVector<f64, F>,
    v: SVector<f64, F>,
    tolerances: &Tolerances<Const<F>>,
    t_end: f64,
) -> Result<(State<Const<F>>, Counters), StepError>
where
    RadauIia<S>: Coefficients<S>,
{
    let mut radau = start::<S, F>(system, q, v, tolerances);
    while radau.state().t < t_end {
        radau.step(system, t_end, f64::INFINITY)?;
    }
    assert_eq!(radau.state().t, t_end);
    Ok((*radau.state(), *radau.counters()))
}
