//! What must hold at every recorded instant: contact, Coulomb's law, the ledger.

use crate::body::Tank;
use crate::common::*;
use crate::scenes::{SCENES, scene};

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
            if run.layout.modes[usize::from(trajectory.mode[i])].ends_with("sticks") {
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
