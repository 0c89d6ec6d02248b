//! A model says where it ends, and a run which of that it leaves.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};

/// A steel tank on the ground of radius 7.5 m, filled 10 m high, with a bottom plate of 8 mm:
/// E t³/12(1 − ν²) with E = 210 GPa, ν = 0.3.
fn steel_tank() -> Problem {
    let water = 1000.0 * std::f64::consts::PI * 7.5_f64.powi(2) * 10.0;
    let (radius, half) = (7.5_f64, 5.0_f64);
    let distance = radius.hypot(half);
    let angle = (radius / half).atan();
    let shell = 0.05 * water;
    problem(
        "walking_tank",
        &[
            ("M_0", water),
            ("M_I", 0.6 * water),
            ("M_E", water),
            ("M_rb", 0.6 * water),
            ("M_S", shell),
            ("I_E", 1.4 * water * distance.powi(2)),
            ("I_S", 1.4 * shell * distance.powi(2)),
            ("R_0", distance),
            ("R_I", distance),
            ("R_S", distance),
            ("alpha_0", angle),
            ("alpha_I", angle),
            ("alpha_S", angle),
            (
                "B_plate",
                2.1e11 * 0.008_f64.powi(3) / (12.0 * (1.0 - 0.3_f64.powi(2))),
            ),
        ],
    )
}

#[test]
fn a_steel_tank_is_told_that_its_bottom_plate_is_not_rigid() {
    let left = steel_tank().invalid_parameters();
    assert_eq!(left.len(), 1, "{left:?}");
    assert!(
        left[0].message.starts_with("the bottom plate is rigid"),
        "{left:?}"
    );
    assert_eq!(left[0].t, None);
    let mut run_of = steel_tank();
    run_of.end.time = 0.1;
    assert_eq!(run(&run_of).reached.validity, left);
}

#[test]
fn the_tanks_of_the_paper_are_what_the_model_is_meant_for() {
    for set in &problem("walking_tank", &[]).model.parameter_sets {
        let tank = problem("walking_tank", &set.values);
        assert_eq!(tank.invalid_parameters(), [], "{}", set.name);
    }
}

#[test]
fn a_tank_that_uplifts_far_leaves_its_validity_at_that_instant() {
    for method in [Method::Auto, Method::Radau] {
        let mut tank = problem("walking_tank", &[("mu_s", 2.0), ("mu_k", 2.0)]);
        tank.method = method;
        tank.set_initial("theta", 0.1).unwrap();
        tank.set_initial("theta.rate", 2.5).unwrap();
        tank.end.time = 0.3;
        let run = run(&tank);
        let [left] = &run.reached.validity[..] else {
            panic!("{:?}", run.reached.validity)
        };
        assert!(
            left.message.starts_with("the uplift is moderate"),
            "{left:?}"
        );
        let t = left.t.unwrap();
        let theta = run.trajectory.column("theta").unwrap();
        let beyond = |i: &usize| run.trajectory.row(*i)[theta] > 0.785 / 4.0;
        let first = (0..run.trajectory.len()).find(beyond);
        // Nothing is cut: the rows are those of the steps.
        println!("{method:?}: left at {t}");
        assert!(first.is_none_or(|i| run.trajectory.t[i] >= t));
        assert!(t > 0.0);
    }
}
