//! A block that slides to rest under a stiff oscillator (tests/data/11_stiff_block.json).

mod common;
use common::*;

#[test]
fn a_block_with_a_stiff_oscillator_stops() {
    let reference = reference("11_stiff_block");
    for row in reference["reference"]["rows"].as_array().unwrap() {
        let (k, c) = (number(&row["k"]), number(&row["c"]));
        let mut problem = problem("stiff_block", &[("k", k), ("c", c)]);
        problem.set_initial("x.rate", 2.0).unwrap();
        // The elongation is of the order μ (M + m) g/k.
        problem.set_tolerance(1e-12);
        let r = problem.model.coordinate("r").unwrap();
        problem.accuracy.q_absolute[r] = 1e-12 * 3.0 / k;
        problem.end.time = 1.0;
        let run = run(&problem);
        let stop = run.events.iter().find(|e| e.transition == "stick").unwrap();
        println!(
            "k {k:e} c {c:e} steps {} rejected {} t {:e} x {:e} r {:e}",
            run.solver.steps,
            run.solver.rejected,
            stop.t - number(&row["t_stop"]),
            stop.after.q[0] - number(&row["x_block_stop"]),
            stop.after.q[1] / number(&row["r_at_stop"]) - 1.0
        );
    }
}
