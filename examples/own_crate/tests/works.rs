//! Scene, engine and ensemble work with a model of this crate, and the motion obeys the law of momentum.

use dalembert::hybrid::{Ensemble, Member, Method, Simulator, simulate};
use dalembert::model::Models;
use dalembert::record::Silent;
use own_crate::{TICK, control, models, tilted};

#[test]
fn the_rod_is_held_upright_and_the_momentum_is_that_of_the_force() {
    let (mut impulse, mut unstable) = (0.0, 0.0f64);
    let problem = tilted().unwrap();
    let [_, v, phi, rate] = control(&problem, |_, state, force| {
        impulse += force * TICK;
        unstable = unstable.max(state[2].abs());
    })
    .unwrap();
    assert!(
        phi.abs() < 1e-3 && unstable < 0.35,
        "{phi} rad after {unstable} rad"
    );
    // (M + m) v + m l/2 φ' cos φ, which is zero at first.
    let momentum = 3.0 * v + 0.5 * rate * phi.cos();
    assert!(
        (momentum - impulse).abs() < 1e-9,
        "{momentum} N s of {impulse} N s"
    );
}

#[test]
fn a_scene_runs_as_a_whole_and_in_an_ensemble() {
    let mut problem = tilted().unwrap();
    let run = simulate(&problem, &mut Silent).unwrap();
    assert!(run.failure.is_none());
    // Nothing pushes: what is left of the energy of the start is all of it.
    let energy = |q: &[f64], v: &[f64]| {
        1.5 * v[0] * v[0] + v[1] * v[1] / 6.0 + 0.5 * v[0] * v[1] * q[1].cos() + 4.905 * q[1].cos()
    };
    let end = &run.end.state;
    let lost = energy(&[0.0, 0.3], &[0.0, 0.0]) - energy(&end.q, &end.v);
    assert!(lost.abs() < 1e-6, "{lost} J");

    problem.method = Method::Taylor;
    let variations: Vec<_> = (0..16)
        .map(|i| {
            let mut own = problem.clone();
            own.set_initial("phi", 0.1 + 0.02 * f64::from(i)).unwrap();
            own
        })
        .collect();
    let members: Vec<_> = variations.iter().map(Member::from).collect();
    let ensemble = Ensemble::new(&problem).unwrap();
    let ends = ensemble.run(&members, |_, end| end.q().to_vec());
    for (own, end) in variations.iter().zip(ends) {
        let mut alone = Simulator::new(own).unwrap();
        alone.run(&mut Silent).unwrap();
        for (one, other) in alone.q().iter().zip(end) {
            assert!((one - other).abs() < 1e-6, "{one} alone, {other} in lanes");
        }
    }
}

#[test]
fn its_models_are_this_crate_s_own_and_go_with_those_of_dalembert() {
    assert_eq!(models().names().collect::<Vec<_>>(), ["rod_on_cart"]);
    let both = Models::linked().and(models()).unwrap();
    assert!(both.find("rod_on_cart").is_some());
    assert_eq!(both.names().count(), Models::linked().names().count() + 1);
    assert!(both.and(models()).is_err());
}
