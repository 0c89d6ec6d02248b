//! Random scenes: what must hold in every one of them.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::input::Sine;
use dalembert::record::{Run, Silent};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::TAU;

/// The cases are the same in every run: a suite must not fail by chance.
fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        ..ProptestConfig::with_cases(cases)
    }
}

/// A problem with initial values, and the ground shaken by a sine.
fn scene(
    model: &str,
    parameters: &[(&str, f64)],
    initial: &[(&str, f64)],
    [amplitude, frequency, phase]: [f64; 3],
) -> Problem {
    let mut problem = problem(model, parameters);
    for (name, value) in initial {
        problem.set_initial(name, *value).unwrap();
    }
    if amplitude != 0.0 {
        let shaking = Sine::new(amplitude, TAU * frequency, phase);
        problem
            .set_input("ground_acceleration", shaking.into())
            .unwrap();
    }
    problem.set_tolerance(1e-10);
    problem.end.time = 1.5;
    problem.record.every = Some(2e-3);
    problem.record.columns.reactions = true;
    problem
}

fn value(problem: &Problem, name: &str) -> Option<f64> {
    problem.model.parameter(name).map(|i| problem.parameters[i])
}

/// Runs to the end, or to a stop that the model asks for.
fn run_with(problem: &Problem, method: Method) -> Run {
    let mut problem = problem.clone();
    problem.method = method;
    let run = simulate(&problem, &mut Silent).expect("the problem can be started");
    if let Some(failure) = &run.failure {
        let asked_for = ["would leave the ground"];
        assert!(
            asked_for
                .iter()
                .any(|a| failure.reason.to_string().contains(a)),
            "{failure:?}"
        );
    }
    run
}

/// Events are ordered and numbered, and happen before the end.
fn assert_order(run: &Run) {
    let mut last = 0.0;
    for (n, event) in run.events.iter().enumerate() {
        assert!(
            event.t >= last && event.t <= run.end.t,
            "event {n} at {}",
            event.t
        );
        assert_eq!(event.j, n as u64 + 1);
        last = event.t;
    }
    assert!(run.trajectory.t.is_sorted());
}

/// No coordinate is below its minimum at a sample or after an event.
fn assert_no_penetration(problem: &Problem, run: &Run) {
    for (i, coordinate) in problem.model.coordinates.iter().enumerate() {
        let Some(minimum) = coordinate.minimum else {
            continue;
        };
        let column = run.trajectory.column(coordinate.name).unwrap();
        for row in 0..run.trajectory.len() {
            let value = run.trajectory.row(row)[column];
            assert!(
                value >= minimum,
                "{} = {value:e} at {}",
                coordinate.name,
                run.trajectory.t[row]
            );
        }
        for event in &run.events {
            assert!(
                event.after.q[i] >= minimum,
                "{} after {}",
                coordinate.name,
                event.transition
            );
        }
    }
}

/// Stored energy changes by work, dissipation and impacts: to 10 tolerances of what is turned over. Found in
/// 30,000 scenes: 4.6, after a landing. With other seeds one oscillator in 100,000 has more, up to 80: a spring of over
/// 1e8 N/m that hardly moves, where the absolute tolerance of its elongation decides; a tenth of it leaves nothing.
fn assert_ledger(problem: &Problem, run: &Run) {
    let energy = run.energy.as_ref().unwrap();
    let turnover = energy.initial.abs()
        + energy.final_.abs()
        + energy.input_work.abs()
        + energy.dissipated.abs()
        + energy.lost_at_impacts.abs();
    let imbalance = energy.imbalance().abs();
    assert!(
        imbalance <= 10.0 * problem.accuracy.relative * turnover,
        "{imbalance:e} of {turnover:e}"
    );
    assert!(
        energy.dissipated >= -1e-13 * turnover && energy.lost_at_impacts >= -1e-13 * turnover,
        "{energy:?}"
    );
}

/// Coulomb's law at every sample: the shear is within the cone of static friction where the base
/// sticks, and on that of kinetic friction, against the slip, where it slips.
fn assert_friction(problem: &Problem, run: &Run, coordinate: &str) {
    let trajectory = &run.trajectory;
    let column = |name: &str| trajectory.column(name).unwrap();
    let [rate, slip, normal, shear, base] = [
        &format!("{coordinate}.rate"),
        "slip",
        "reaction.y",
        &format!("reaction.{coordinate}"),
        "reaction.z_h",
    ]
    .map(column);
    let [mu_s, mu_k] = ["mu_s", "mu_k"].map(|name| value(problem, name).unwrap());
    for i in 0..trajectory.len() {
        let (t, row) = (trajectory.t[i], trajectory.row(i));
        assert!(row[normal] > 0.0, "N = {} at {t}", row[normal]);
        if run
            .layout
            .modes
            .name(trajectory.mode[i])
            .ends_with("sticks")
        {
            assert_eq!(row[rate], 0.0);
            assert!(
                row[shear].abs() <= mu_s * row[normal],
                "R = {}, N = {} at {t}",
                row[shear],
                row[normal]
            );
        } else {
            assert!(
                row[slip] * row[rate] >= 0.0,
                "slips at {} in {t}",
                row[rate]
            );
            let friction = -mu_k * row[normal] * row[slip];
            assert!(
                (row[base] - friction).abs() <= 1e-13 * mu_k * row[normal],
                "R = {} at {t}",
                row[base]
            );
        }
    }
}

/// The methods agree on the first ten transitions and their times. Found in 20,000 scenes: 1.6e-8 s at a
/// tolerance of 1e-10, at landings that all but graze; later ones amplify what these differ by.
fn assert_agreement(a: &Run, b: &Run) {
    let count = a.events.len().min(b.events.len()).min(10);
    assert_eq!(transitions(a)[..count], transitions(b)[..count]);
    for (a, b) in a.events.iter().zip(&b.events).take(count) {
        assert!(
            (a.t - b.t).abs() < 1e-7,
            "{} at {} and {}",
            a.transition,
            a.t,
            b.t
        );
    }
}

fn check(problem: &Problem, slips: Option<&str>) {
    let [auto, radau] = [Method::Auto, Method::Radau].map(|method| run_with(problem, method));
    for run in [&auto, &radau] {
        assert_order(run);
        assert_no_penetration(problem, run);
        if run.failure.is_none() {
            assert_ledger(problem, run);
        }
        if let Some(coordinate) = slips {
            assert_friction(problem, run, coordinate);
        }
    }
    assert_agreement(&auto, &radau);
    if auto.events.len() < 10 {
        assert_eq!(transitions(&auto), transitions(&radau));
    }
}

// Of the seeds 200 to 420, those with which something was wrong before: a block did not know whether it lifted off,
// since its acceleration was rounding; the slip of a tank stopped at a landing that turns it round.

proptest! {
    #![proptest_config(config(1000, 308))]

    #[test]
    fn a_ball_bounces(e in 0.0..1.0_f64, g in 0.1..100.0_f64, h in 0.0..2.0_f64, v in -5.0..5.0_f64) {
        check(&scene("hand_ball", &[("e", e), ("g", g)], &[("h", h), ("h.rate", v)], [0.0; 3]), None);
    }

    #[test]
    fn a_block_rocks(
        alpha in 0.1..0.4_f64, e in 0.5..0.95_f64, r in 0.3..3.0_f64, start in 0.0..0.9_f64,
        amplitude in 0.0..8.0_f64, frequency in 0.5..4.0_f64, phase in 0.0..TAU,
    ) {
        let parameters = [("alpha", alpha), ("e", e), ("R", r)];
        check(&scene("rocking_block", &parameters, &[("theta", start * alpha)], [amplitude, frequency, phase]), None);
    }

    #[test]
    fn an_oscillator_slips(
        mu in 0.05..0.9_f64, ratio in 0.5..1.0_f64, exponent in 3.0..9.0_f64, damping in 0.0..1.5_f64,
        speed in -2.0..2.0_f64, amplitude in 0.0..30.0_f64, frequency in 0.5..9.0_f64, phase in 0.0..TAU,
    ) {
        let k = 10f64.powf(exponent);
        let parameters = [("mu_s", mu), ("mu_k", mu * ratio), ("k", k), ("c", 2.0 * damping * (40.0 * k).sqrt())];
        let initial = [("u.rate", speed), ("slip", 1f64.copysign(speed))];
        check(&scene("hand_slider", &parameters, &initial, [amplitude, frequency, phase]), Some("u"));
    }
}

proptest! {
    #![proptest_config(config(300, 214))]

    #[test]
    fn a_tank_walks(
        mu in 0.2..0.8_f64, ratio in 0.7..1.0_f64, e in 0.0..0.9_f64, theta in 0.0..0.02_f64,
        frequency in 5.0..40.0_f64, damping in 0.0..0.2_f64,
        amplitude in 0.0..15.0_f64, shaking in 1.0..9.0_f64, phase in 0.0..TAU,
    ) {
        let parameters = [("mu_s", mu), ("mu_k", mu * ratio), ("e", e), ("frequency", frequency), ("damping", damping)];
        let mut tank = scene("walking_tank", &parameters, &[("theta", theta)], [amplitude, shaking, phase]);
        tank.end.time = 0.5;
        check(&tank, Some("x"));
    }
}

/// A tank by the rules of the paper, whose guards act together with conditions. The printed equations, corrected, may
/// stop it for reasons of their own.
fn check_by_the_paper(equations: &str, parameters: &[(&str, f64)], theta: f64, shaking: [f64; 3]) {
    let mut tank = scene("walking_tank", parameters, &[("theta", theta)], shaking);
    tank.choose(&[("equations", equations), ("rules", "paper")])
        .unwrap();
    tank.end.time = 0.5;
    tank.set_tolerance(1e-8);
    let run = simulate(&tank, &mut Silent).expect("the problem can be started");
    assert_order(&run);
    if let Some(failure) = &run.failure {
        let asked_for = ["would leave the ground"];
        let of_the_equations = ["Painlevé", "positive definite", "contradict"];
        let mut may = asked_for.to_vec();
        if equations == "corrected" {
            may.extend(of_the_equations);
        }
        assert!(
            may.iter().any(|a| failure.reason.to_string().contains(a)),
            "{failure:?}"
        );
    }
}

proptest! {
    #![proptest_config(config(100, 1))]

    #[test]
    fn a_tank_walks_by_the_rules_of_the_paper(
        mu in 0.2..0.8_f64, ratio in 0.7..1.0_f64, e in 0.0..0.9_f64, theta in 0.0..0.02_f64,
        frequency in 5.0..40.0_f64, damping in 0.0..0.2_f64,
        amplitude in 0.0..15.0_f64, shaking in 1.0..9.0_f64, phase in 0.0..TAU,
    ) {
        let parameters = [("mu_s", mu), ("mu_k", mu * ratio), ("e", e), ("frequency", frequency), ("damping", damping)];
        for equations in ["derived", "corrected"] {
            check_by_the_paper(equations, &parameters, theta, [amplitude, shaking, phase]);
        }
    }
}

/// A guard with conditions crosses zero on the dense output of a step whose end, more accurate, is not across: there
/// is nothing left of the step to search. It was searched without end.
#[test]
fn a_crossing_at_the_end_of_a_step_is_looked_for_once() {
    let parameters = [
        ("mu_s", 0.6004556979656792),
        ("mu_k", 0.45859948332229233),
        ("e", 0.01634266925446889),
        ("frequency", 8.388848862716253),
        ("damping", 0.01763088342990775),
    ];
    let shaking = [3.251418278366523, 8.434044658980413, 1.6309281280040964];
    check_by_the_paper("corrected", &parameters, 0.011965010167278769, shaking);
}
