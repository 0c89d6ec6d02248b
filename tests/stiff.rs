//! A block that slides to rest under a stiff oscillator (tests/data/11_stiff_block.json).

mod common;
use common::*;

#[test]
fn a_block_with_a_stiff_oscillator_stops() {
    let reference = reference("11_stiff_block");
    let mut rows = 0;
    for row in reference["reference"]["rows"].as_array().unwrap() {
        let (k, c) = (number(&row["k"]), number(&row["c"]));
        // At k = 1e12 an undamped oscillation has 300,000 cycles until the block stops, and the stop
        // depends on its phase: each is resolved, by two steps of the Taylor method.
        rows += 1;
        let mut problem = problem("stiff_block", &[("k", k), ("c", c)]);
        problem.set_initial("x.rate", 2.0).unwrap();
        problem.set_tolerance(1e-12);
        // The elongation is of the order μ (M + m) g/k.
        let r = problem.model.coordinate("r").unwrap();
        problem.accuracy.q_absolute[r] = 1e-12 * 3.0 / k;
        problem.end.time = 0.7;
        let run = run(&problem);
        assert_eq!(transitions(&run), ["stick"]);
        let stop = &run.events[0];
        let time = stop.t - number(&row["t_stop"]);
        assert!(
            time.abs() < 1e-11,
            "k = {k:e}, c = {c:e}: t off by {time:e}"
        );
        let place = stop.after.q[0] - number(&row["x_block_stop"]);
        assert!(
            place.abs() < 1e-12,
            "k = {k:e}, c = {c:e}: x off by {place:e}"
        );
        let exact = number(&row["r_at_stop"]);
        let elongation = (stop.after.q[1] - exact).abs();
        let allowed = if k == 1e12 { 1e-15 } else { 1e-6 * exact };
        assert!(
            elongation < allowed,
            "k = {k:e}, c = {c:e}: r off by {elongation:e}"
        );
    }
    assert_eq!(rows, 8);
}
