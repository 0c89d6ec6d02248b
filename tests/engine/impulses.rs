//! Impulses of contacts and constraints, as outputs, against the balance of momentum.

use crate::common::*;
use dalembert::hybrid::Method;
use dalembert::record::Run;

/// What momentum gains is what the contacts and gravity deliver, in every row.
fn check_balance(run: &Run, (m, g): (f64, f64)) {
    let column = |name: &str| run.trajectory.column(name).expect("a column");
    let [across, up] = ["x.rate", "y.rate"].map(column);
    let impulses =
        |of: &str| ["left", "right"].map(|contact| column(&format!("{contact}.{of}_impulse")));
    let (normal, friction) = (impulses("normal"), impulses("friction"));
    let first = run.trajectory.row(0);
    for (k, t) in run.trajectory.t.iter().enumerate() {
        let row = run.trajectory.row(k);
        let sum = |columns: &[usize]| columns.iter().map(|&i| row[i]).sum::<f64>();
        let [off_up, off_across] = [
            m * (row[up] - first[up]) - (sum(&normal) - m * g * t),
            m * (row[across] - first[across]) - sum(&friction),
        ];
        // Sums of up to m g t, about 40 N s.
        assert!(off_up.abs() <= 1e-11, "upwards at {t}: {off_up:e}");
        assert!(
            off_across.abs() <= 1e-11,
            "to the right at {t}: {off_across:e}"
        );
    }
}

#[test]
fn impulses_of_contacts_are_what_momentum_gains() {
    for (method, e) in [
        (Method::Taylor, 0.0),
        (Method::Taylor, 0.3),
        (Method::Radau, 0.0),
    ] {
        let (m, g) = (2.5, 9.81);
        let mut block = problem("rigid_block", &[("m", m), ("g", g), ("e", e)]);
        for (name, value) in [("y", 0.75), ("theta", 0.1), ("x.rate", 0.4)] {
            block.set_initial(name, value).unwrap();
        }
        block.method = method;
        block.set_tolerance(TIGHTEST);
        block.end.time = 1.5;
        block.record.every = Some(0.01);
        block.record.columns.outputs = true;
        let whole = run(&block);
        assert!(whole.tally.count("left strikes") > 0);
        check_balance(&whole, (m, g));
    }
}
