//! What must hold at every recorded instant: contact, Coulomb's law, the ledger.

use crate::body::Tank;
use crate::common::*;
use crate::scenes::{SCENES, scene};
use dalembert::input::Sine;
use std::f64::consts::TAU;

#[test]
fn contact_and_friction_hold_at_every_instant() {
    for name in SCENES {
        let mut problem = scene(name, &["accuracy.relative=1e-10"]);
        problem.record.every = Some(2e-4);
        problem.record.columns.reactions = true;
        let run = run(&problem);
        let tank = Tank::of(&problem);
        let trajectory = &run.trajectory;
        let [theta, slip, rate, base, shear, normal] = [
            "theta",
            "slip",
            "x.rate",
            "reaction.z_h",
            "reaction.x",
            "reaction.y",
        ]
        .map(|name| trajectory.column(name).unwrap());
        let mut worst = [0.0f64; 3];
        for i in 0..trajectory.len() {
            let (t, row) = (trajectory.t[i], trajectory.row(i));
            assert!(row[normal] > 0.0, "{name}, t = {t}: N = {}", row[normal]);
            worst[0] = worst[0].max(-row[theta]);
            if run
                .layout
                .modes
                .name(trajectory.mode[i])
                .ends_with("sticks")
            {
                assert_eq!(row[rate], 0.0, "{name}, t = {t}");
                worst[1] = worst[1].max(row[shear].abs() / (tank.mu_s * row[normal]) - 1.0);
                assert_eq!(row[shear], row[base]);
            } else {
                assert!(
                    row[slip] * row[rate] >= 0.0,
                    "{name}, t = {t}: {}",
                    row[rate]
                );
                let friction = -tank.mu_k * row[normal] * row[slip];
                worst[2] = worst[2].max((row[base] / friction - 1.0).abs());
            }
        }
        assert!(worst[0] <= 0.0, "{name}: θ = {:e}", -worst[0]);
        assert!(worst[1] <= 0.0, "{name}: |R|/μN − 1 = {:e}", worst[1]);
        assert!(worst[2] <= 1e-14, "{name}: |R|/μN − 1 = {:e}", worst[2]);
    }
}

#[test]
fn the_energy_ledger_closes_in_every_scene() {
    for name in SCENES {
        for law in ["momenta", "velocities"] {
            for (tolerance, allowed) in [("1e-6", 1e-5), ("1e-10", 1e-9)] {
                let overrides = [
                    format!("accuracy.relative={tolerance}"),
                    format!("landing=\"{law}\""),
                ];
                let problem = scene(name, &[&overrides[0], &overrides[1]]);
                let run = run(&problem);
                let energy = run.energy.as_ref().unwrap();
                let turnover = energy.initial.abs() + energy.input_work.abs() + energy.dissipated;
                let imbalance = energy.imbalance().abs() / turnover;
                assert!(
                    imbalance < allowed,
                    "{name} {law} {tolerance}: {imbalance:e}"
                );
            }
        }
    }
}

/// Where nearly all of the mass sloshes, what is left stands and slips with forces of its own acceleration, which hangs on the
/// elongation of the liquid through a stiffness that is large beside the rest. The default tolerances suit that: no row
/// on which it sticks is outside of the cone.
#[test]
fn no_stick_row_is_outside_the_friction_cone_where_nearly_all_mass_is_impulsive() {
    let mut sticking = 0;
    for (k, part) in [0.9, 0.98, 0.999, 1.0].into_iter().enumerate() {
        for (j, mu) in [0.15, 0.4, 0.83].into_iter().enumerate() {
            for rest in [1e-6, 1.0] {
                let mut problem = problem("walking_tank", &[]);
                let water = Tank::of(&problem).m_0;
                for (name, value) in [
                    ("M_I", part * water),
                    ("M_E", rest),
                    ("M_rb", rest),
                    ("mu_s", mu),
                    ("mu_k", 0.7 * mu),
                ] {
                    problem.set_parameter(name, value).unwrap();
                }
                let shaking = Sine::new(6.0 + 4.0 * k as f64, TAU * (1.5 + 2.5 * j as f64), 0.0);
                problem
                    .set_input("ground_acceleration", shaking.into())
                    .unwrap();
                problem.end.time = 1.5;
                problem.record.every = Some(2e-3);
                problem.record.columns.reactions = true;
                let run = run(&problem);
                let [shear, normal] =
                    ["reaction.x", "reaction.y"].map(|name| run.trajectory.column(name).unwrap());
                for i in 0..run.trajectory.len() {
                    let mode = run.trajectory.mode[i];
                    if run.layout.modes.name(mode).ends_with("sticks") {
                        let row = run.trajectory.row(i);
                        let ratio = row[shear].abs() / (mu * row[normal]);
                        let (t, total) = (run.trajectory.t[i], run.uncertain.total);
                        assert!(
                            ratio <= 1.0 || total > 0,
                            "{part} {mu} {rest}: {ratio} at {t}"
                        );
                        sticking += 1;
                    }
                }
            }
        }
    }
    assert!(sticking > 1000, "{sticking}");
}
