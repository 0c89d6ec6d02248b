//! The problems of the comparison with other solvers, against their references of 30 digits.

use dalembert::hybrid::{Method, Simulator};
use dalembert::record::Silent;
use serde_json::Value;

#[allow(dead_code)] // `main` measures
#[path = "../benches/peers/dalembert.rs"]
mod rows;

fn numbers(value: &Value) -> Vec<f64> {
    let number = |x: &Value| x.as_str().unwrap().parse().unwrap();
    value.as_array().unwrap().iter().map(number).collect()
}

/// How many events must be found: all, but of landings that accumulate those before a hop that is lower
/// than the absolute tolerance of the angle.
fn least_events(reference: &Value, tolerance: f64) -> Option<usize> {
    let (_, least) = (reference["least_events"].as_object()?.iter())
        .find(|(of, _)| of.parse::<f64>().unwrap() == tolerance)?;
    Some(least.as_u64().unwrap() as usize)
}

/// At every tolerance no event is missed or doubled, and end state and times of events are as accurate
/// as asked for. Found: 1.2 tolerances at most for the times (P2), and 8.5 for the end (P1, whose impacts
/// amplify the errors before them tenfold).
#[test]
fn no_event_is_missed_or_doubled_at_any_tolerance() {
    let text = include_str!("../benches/peers/reference.json");
    let reference: Value = serde_json::from_str(text).unwrap();
    for name in rows::PROBLEMS {
        let events = numbers(&reference[name]["events"]);
        let end = numbers(&reference[name]["y_end"]);
        let scales: Vec<f64> = (reference[name]["scales"].as_array().unwrap().iter())
            .map(|x| x.as_f64().unwrap())
            .collect();
        let components = match name {
            // Its spring is slaved: nanometres.
            "P4S" => vec![0, 2],
            _ => (0..scales.len()).collect(),
        };
        for method in [Method::Auto, Method::Radau] {
            for digits in 3..=13 {
                let tolerance = 10f64.powi(-digits);
                let mut problem = rows::problem(name, tolerance);
                problem.method = method;
                let mut simulator = Simulator::new(&problem).unwrap();
                let at = format!("{name} {method:?} {tolerance:e}");
                simulator
                    .run(&mut Silent)
                    .unwrap_or_else(|e| panic!("{at}: {e}"));
                let found = simulator.events().iter().filter(|e| e.transition != "rest");
                let found: Vec<f64> = found.map(|e| e.t).collect();
                let least = least_events(&reference[name], tolerance).unwrap_or(events.len());
                assert!((least..=events.len()).contains(&found.len()), "{at}");
                for (found, exact) in found.iter().zip(&events) {
                    assert!(
                        (found - exact).abs() < 2.0 * tolerance * exact,
                        "{at}: {found} {exact}"
                    );
                }
                let state = rows::state(name, &simulator);
                for &i in &components {
                    let error = (state[i] - end[i]).abs() / scales[i];
                    assert!(error < 10.0 * tolerance, "{at}: {i} {error:e}");
                }
            }
        }
    }
}

/// The scripts of the comparison judge rows as they should.
#[test]
fn the_scripts_of_the_comparison_pass_their_tests() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers");
    let run = std::process::Command::new(env!("DALEMBERT_PYTHON_EXE"))
        .args(["-B", "test_rows.py"])
        .current_dir(folder)
        .output()
        .expect("python3 runs");
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{said}");
}
