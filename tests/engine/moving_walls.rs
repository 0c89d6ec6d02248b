//! Impacts on walls and belts that move: they work, which is input work, so that what an impact loses is lost in the frame of what
//! is struck.

use crate::common::*;
use dalembert::hybrid::Method;
use dalembert::input::Sine;
use dalembert::record::{Run, Snapshot};

/// Mass, restitution, and the speed of the belt.
const M: f64 = 2.0;
const E: f64 = 0.3;
const RUNS: f64 = 0.7;

/// Amplitude and angular frequency of the table's acceleration, m/s² and rad/s.
const AMPLITUDE: f64 = 8.0;
const OMEGA: f64 = 11.0;

/// A ball that is thrown against the belt, in a form.
fn thrown(form: &str, method: Method) -> Run {
    let mut ball = problem(
        "thrown_on_a_belt",
        &[("m", M), ("e", E), ("g", 9.81), ("runs", RUNS)],
    );
    ball.choose(&[("form", form)]).unwrap();
    for (name, value) in [
        ("y", 0.05),
        ("x.rate", -1.5),
        ("table.rate", -AMPLITUDE / OMEGA),
    ] {
        ball.set_initial(name, value).unwrap();
    }
    ball.set_input("a", Sine::new(AMPLITUDE, OMEGA, 0.0).into())
        .unwrap();
    ball.method = method;
    ball.set_tolerance(TIGHTEST);
    ball.end.time = 2.0;
    ball.record.event_states = true;
    ball.record.ledger = true;
    run(&ball)
}

#[test]
fn what_an_impact_loses_is_lost_in_the_frame_of_what_is_struck() {
    for form in ["reduced", "multipliers"] {
        for method in [Method::Taylor, Method::Radau] {
            let run = thrown(form, method);
            let of = format!("{form} by {method:?}");
            let mut slips = 0;
            for event in run.events.iter().filter(|e| e.transition == "top strikes") {
                let table = -AMPLITUDE / OMEGA * (OMEGA * event.t).cos();
                // Across and upwards, against the belt.
                let against = |of: &Snapshot| [of.v[0] - RUNS, of.v[1] - table];
                let [before, after] = [&event.before, &event.after].map(against);
                slips += usize::from(after[0].abs() > 1e-3);
                let energy = |[across, up]: [f64; 2]| 0.5 * M * (across * across + up * up);
                let lost = energy(before) - energy(after);
                let told = event.energy.expect("an impact").lost;
                assert!(
                    (told - lost).abs() < 1e-11,
                    "{of} at {}: {told} and {lost}",
                    event.t
                );
            }
            assert!(
                run.tally.count("top strikes") > 10 && slips > 0,
                "{of}: {slips} {:?}",
                run.tally
            );
            assert!(run.tally.gains.is_empty(), "{of}: {:?}", run.tally.gains);
            let energy = run.energy.as_ref().unwrap();
            let turnover = energy.initial + energy.input_work.abs() + energy.lost_at_impacts;
            assert!(
                energy.imbalance().abs() < 1e-13 * turnover,
                "{of}: {energy:?}"
            );
        }
    }
}
