//! Small bulging of the tank at rest on the ground: a damped oscillator.

use crate::common::*;

#[test]
fn bulging_is_a_damped_oscillation_at_26_hz() {
    let x_0 = 1e-5;
    let mut problem = problem("walking_tank", &[]);
    problem.set_initial("x_I", x_0).unwrap();
    tighten(&mut problem, 1e-6);
    problem.end.time = 0.2;
    problem.record.every = Some(1e-3);
    let run = run(&problem);
    assert_eq!(run.events, []);
    let (damping, omega) = (0.05f64, std::f64::consts::TAU * 26.0);
    let undamped = (1.0 - damping * damping).sqrt();
    let column = run.trajectory.column("x_I").unwrap();
    for (row, t) in run.trajectory.t.iter().enumerate() {
        let (sin, cos) = (undamped * omega * t).sin_cos();
        let exact = x_0 * (-damping * omega * t).exp() * (cos + damping / undamped * sin);
        let error = run.trajectory.row(row)[column] - exact;
        assert!(error.abs() < 1e-12 * x_0, "t = {t}: {:e}", error / x_0);
    }
}
