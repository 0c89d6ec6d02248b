//! What cannot be simulated stops with a reason that names it, and keeps the motion so far.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, Reason, simulate};
use dalembert::record::{Failure, Run, Silent};

/// Runs a problem that stops early.
fn stopped(problem: &Problem) -> (Run, Failure) {
    let run = simulate(problem, &mut Silent).expect("the problem can be started");
    let failure = run.failure.clone().expect("the run stops early");
    (run, failure)
}

#[test]
fn guards_that_contradict_each_other_are_named() {
    let mut problem = problem("contradiction", &[]);
    problem.set_initial("x", 3.0).unwrap();
    problem.set_initial("x.rate", -1.0).unwrap();
    problem.initial.mode = Some(mode(&problem, "right"));
    problem.end.time = 10.0;
    let (run, failure) = stopped(&problem);
    for name in ["to_left (right → left)", "to_right (left → right)"] {
        assert!(
            failure.reason.to_string().contains(name),
            "{}",
            failure.reason
        );
    }
    // The place of the failure, and the motion up to it.
    assert!((failure.at.t - 2.0).abs() < 1e-12);
    assert!((failure.at.state.q[0] - 1.0).abs() < 1e-12);
    assert_eq!(failure.at.state.v, [-1.0]);
    assert_eq!(failure.at.j, run.events.len() as u64);
    assert!(run.trajectory.t.last().unwrap() >= &2.0);
}

#[test]
fn chattering_without_a_limit_names_its_guards() {
    let mut problem = problem("chatter", &[]);
    problem.set_initial("x", 1.0).unwrap();
    problem.end.time = 10.0;
    let (run, failure) = stopped(&problem);
    assert!(
        failure.reason.to_string().contains("chattering"),
        "{}",
        failure.reason
    );
    assert!(
        failure.reason.to_string().contains("down, up"),
        "{}",
        failure.reason
    );
    // x = 1 − t² and the surface x + x' = 0 meet at t = √2 − 1.
    assert!((failure.at.t - (2.0f64.sqrt() - 1.0)).abs() < 1e-8);
    assert!(run.events.len() < 100);
}

#[test]
fn a_mass_that_vanishes_on_the_way_is_named_before_it_does() {
    let methods = [Method::Auto, Method::Radau, Method::Taylor];
    for (method, tolerance) in methods
        .into_iter()
        .flat_map(|m| [(m, 1e-4), (m, 1e-8), (m, 1e-12)])
    {
        let mut problem = problem("vanishing_mass", &[]);
        problem.method = method;
        problem.end.time = 10.0;
        problem.set_tolerance(tolerance);
        let (_, failure) = stopped(&problem);
        for part in ["mode `moves`", "effective mass of `x` vanishes"] {
            assert!(
                failure.reason.to_string().contains(part),
                "{method:?}: {}",
                failure.reason
            );
        }
        // m (1 − x/L) ẋ²/2 = F x: nothing is left of the mass at t = π/2 √(m L/(2 F)).
        let end = std::f64::consts::FRAC_PI_2 * 0.5f64.sqrt();
        assert!(
            (failure.at.t - end).abs() < 100.0 * tolerance.max(1e-9),
            "{}",
            failure.at.t
        );
        assert!(failure.at.state.q[0] < 1.0);
    }
}

#[test]
fn numbers_that_leave_the_range_of_doubles_stop_the_run() {
    for method in [Method::Auto, Method::Radau, Method::Taylor] {
        for (end, h, rate) in [
            (1e155, 1.0, 0.0),
            (1e308, 1.0, 0.0),
            (1.0, 1.0, 1e200),
            (1.0, 1e300, -1e308),
            (1e10, 1e308, 1e305),
        ] {
            let mut problem = problem("hand_ball", &[("e", 1.0)]);
            problem.method = method;
            problem.end.time = end;
            problem.end.after = Some(("impact", 3));
            problem.set_initial("h", h).unwrap();
            problem.set_initial("h.rate", rate).unwrap();
            let run = simulate(&problem, &mut Silent).expect("the problem can be started");
            let state = [&run.end.state.q[..], &run.end.state.v].concat();
            assert!(
                state.iter().all(|x| x.is_finite()),
                "{method:?}, {end:e}: {state:?}"
            );
            let energy = run.energy.expect("it is kept");
            let overflows = !(energy.final_.is_finite() && energy.imbalance().is_finite());
            let stops = run
                .failure
                .as_ref()
                .map(|failure| failure.reason.to_string());
            if overflows || run.end.t < end && run.events.len() < 3 {
                let reason = stops.expect("it does not reach its end");
                assert!(reason.contains("is not finite"), "{reason}");
            }
        }
    }
}

#[test]
fn a_block_that_would_leave_the_ground_stops() {
    let mut problem = problem("rocking_block", &[]);
    problem.set_initial("theta", 0.05).unwrap();
    problem.set_initial("theta.rate", 5.0).unwrap();
    let (_, failure) = stopped(&problem);
    assert!(
        failure.reason.to_string().contains("leave the ground"),
        "{}",
        failure.reason
    );
    assert_eq!(failure.at.t, 0.0);
}

#[test]
fn a_block_that_is_thrown_over_stops_where_it_lifts_off_first() {
    // Its centre, at R from the pivot, falls freely there: g = R (cos φ θ'² + p² sin² φ), φ = α − θ, p² = 3g/4R,
    // θ'² = ω² + 2p² (cos α − cos φ). Long steps go beyond the time at which it would press down again.
    let (radius, alpha, g, omega) = (1.0, 0.25_f64, 9.81, 2.5_f64);
    let p2 = 0.75 * g / radius;
    let square = |phi: f64| omega.powi(2) + 2.0 * p2 * (alpha.cos() - phi.cos());
    let pressure = |phi: f64| g - radius * (phi.cos() * square(phi) + p2 * phi.sin().powi(2));
    let (mut presses, mut lifts) = (alpha, alpha);
    while pressure(lifts) > 0.0 {
        (presses, lifts) = (lifts, lifts - 1e-3);
    }
    while presses - lifts > f64::EPSILON {
        let middle = 0.5 * (presses + lifts);
        match pressure(middle) > 0.0 {
            true => presses = middle,
            false => lifts = middle,
        }
    }
    for method in [Method::Taylor, Method::Radau] {
        for relative in [1e-3, 1e-6, 1e-9, 1e-12] {
            let parameters = [("R", radius), ("alpha", alpha), ("g", g)];
            let mut problem = problem("rocking_block", &parameters);
            problem.set_initial("theta.rate", omega).unwrap();
            problem.set_tolerance(relative);
            (problem.method, problem.end.time) = (method, 10.0);
            let (run, failure) = stopped(&problem);
            let (theta, rate) = (failure.at.state.q[0], failure.at.state.v[0]);
            let (of_angle, of_rate) = (theta - (alpha - lifts), rate - square(lifts).sqrt());
            assert!(
                of_angle.abs() < relative,
                "{method:?}, {relative:e}: {of_angle:e}"
            );
            assert!(
                of_rate.abs() < relative,
                "{method:?}, {relative:e}: {of_rate:e}"
            );
            assert!(run.trajectory.t.iter().all(|t| *t <= failure.at.t));
        }
    }
}

#[test]
fn a_tank_without_weight_on_the_ground_stops() {
    let mut problem = problem("walking_tank", &[]);
    problem.set_initial("theta", 0.02).unwrap();
    problem.set_initial("theta.rate", 20.0).unwrap();
    let (_, failure) = stopped(&problem);
    assert!(
        failure.reason.to_string().contains("normal force"),
        "{}",
        failure.reason
    );
}

#[test]
fn kinetic_energies_that_are_no_norm_are_refused() {
    let indefinite = [("m_y", -1.0)];
    let singular = [("m_xy", 1.0 - 1e-16)];
    let indefinite_off_diagonal = [("m_xy", 1.5)];
    for parameters in [indefinite, singular, indefinite_off_diagonal] {
        let (_, failure) = stopped(&problem("coupled_masses", &parameters));
        assert!(
            failure.reason.to_string().contains("not positive definite"),
            "{}",
            failure.reason
        );
        assert!(
            failure.reason.to_string().contains("`y`"),
            "{}",
            failure.reason
        );
    }
    // A tank whose shell has less inertia than its mass has there.
    let mut tank = problem("walking_tank", &[("I_S", 1e-6), ("I_E", 1e-6)]);
    tank.set_initial("theta", 0.01).unwrap();
    let (_, failure) = stopped(&tank);
    assert!(
        failure.reason.to_string().contains("not positive definite"),
        "{}",
        failure.reason
    );
}

#[test]
fn nearly_singular_mass_matrices_are_solved_as_well_as_they_can_be() {
    let reference = reference("12_mass_matrix");
    let items = reference["reference"]["items"].as_array().unwrap();
    let item = items
        .iter()
        .find(|i| i["name"] == "12c_nearly_singular")
        .unwrap();
    for row in &item["rows"].as_array().unwrap()[..3] {
        let (eps, condition) = (number(&row["eps"]), number(&row["cond"]));
        for (f_y, key) in [(-1.0, "acc_for_f=(1,-1)"), (1.0, "acc_for_f=(1,1)")] {
            let mut problem = problem("coupled_masses", &[("m_xy", 1.0 - eps), ("f_y", f_y)]);
            problem.end.time = 2.0;
            let run = run(&problem);
            let exact = numbers(&row[key]);
            for i in 0..2 {
                // x = a t²/2 at t = 2.
                let error = run.end.state.q[i] / (2.0 * exact[i]) - 1.0;
                assert!(
                    error.abs() < condition * f64::EPSILON,
                    "ε = {eps:e}: {error:e}"
                );
            }
        }
    }
}

#[test]
fn states_that_fit_no_mode_and_scenes_that_freeze_too_much_are_refused() {
    let refused = |problem: &Problem| simulate(problem, &mut Silent).expect_err("it is refused");
    let mut lifted = problem("rocking_block", &[]);
    lifted.set_initial("y", 0.1).unwrap();
    assert!(matches!(refused(&lifted), Reason::Initial { .. }));
    let mut frozen = problem("double_pendulum", &[]);
    frozen.freeze = vec![0];
    let Reason::NoModeLeft { frozen } = refused(&frozen) else {
        panic!("another reason")
    };
    assert_eq!(frozen, ["theta_1"]);
}

/// Found by fuzzing: steps of 1e-25 s, of which the event of one guard left nothing to search for another.
#[test]
fn an_absurd_acceleration_of_the_ground_ends_with_a_reason() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/tank_doughnut.json");
    let overrides = [
        "inputs.ground_acceleration.sine.amplitude=855555555555555555555555555555555555555551.0",
        "inputs.ground_acceleration.sine.frequency=3.0",
    ]
    .map(String::from);
    let scene =
        dalembert::scene::Scene::load(&path, &overrides, dalembert::model::models()).unwrap();
    let (_, failure) = stopped(&scene.problem);
    assert!(
        failure.reason.to_string().contains("leave the ground"),
        "{}",
        failure.reason
    );
}
