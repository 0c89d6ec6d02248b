//! Chains, and a row of linkages, with more free coordinates than the engine is compiled for, as models in folders: what takes
//! minutes to derive, to compile and to run, and so is called by `.ci/run` alone.

use std::fs;
use std::process::Command;

use serde_json::{Value, json};

use super::{json as read_json, project, stderr};

/// The summary of a chain of n bodies after some seconds, by each method.
fn by_each_method(model: &str, n: usize, scene: Value) -> [Value; 2] {
    ["taylor", "radau"].map(|method| summary((model, n), &scene, method))
}

/// The summary of a run of a model with n bodies in place of those of the test model.
fn summary((model, n): (&str, usize), scene: &Value, method: &str) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let own = project().join("tests/models").join(model).join("model.py");
    let text = fs::read_to_string(own).unwrap();
    let (before, own) = text.split_once("\nN = ").unwrap();
    let (_, after) = own.split_once('\n').unwrap();
    let longer = format!("{before}\nN = {n}\n{after}");
    fs::create_dir(folder.path().join("chain")).unwrap();
    fs::write(folder.path().join("chain/model.py"), longer).unwrap();
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    // Models of one text are one in the cache.
    let output = Command::new(env!("CARGO_BIN_EXE_dalembert"))
        .current_dir(folder.path())
        .args(["run", "scene.json", "--out", "out", "--set"])
        .arg(format!("method={method}"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    read_json(&folder.path().join("out/summary.json"))
}

/// The largest difference of the end states.
fn difference(runs: &[Value; 2]) -> f64 {
    let [one, other] = runs.each_ref().map(|run| &run["end"]);
    let mut most = 0.0_f64;
    for group in ["q", "v"] {
        for (name, value) in one[group].as_object().unwrap() {
            let values = [value, &other[group][name]].map(|x| x.as_f64().unwrap());
            most = most.max((values[0] - values[1]).abs());
        }
    }
    most
}

#[test]
#[ignore = "takes minutes; .ci/run calls it"]
fn links_are_the_same_by_both_methods_and_keep_their_energy() {
    for n in [13, 20] {
        let initial: serde_json::Map<_, _> = (1..=n)
            .map(|k| (format!("theta_{k}"), json!(0.3)))
            .collect();
        let runs = by_each_method(
            "link_chain",
            n,
            json!({
                "model": "./chain", "links": n.to_string(), "initial": initial, "end": 1.0,
                "accuracy": { "relative": 1e-10 }, "record": { "every": 1.0 }
            }),
        );
        let found = difference(&runs);
        assert!(found < 1e-7, "{n} links: {found:e}");
        for run in &runs {
            let energy = |key: &str| run["energy"][key].as_f64().unwrap();
            // Of the energy that moves, from all rods at 0.3 rad.
            let scale = 9.81 * (n * (n + 1) / 2) as f64 * (1.0 - 0.3_f64.cos());
            let imbalance = energy("imbalance").abs();
            assert!(
                imbalance < 1e-8 * scale,
                "{n} links: {imbalance:e} of {scale}"
            );
        }
    }
}

#[test]
#[ignore = "takes minutes; .ci/run calls it"]
fn masses_with_friction_are_the_same_by_both_methods() {
    for n in [13, 40] {
        let runs = by_each_method(
            "spring_chain",
            n,
            json!({
                "model": "./chain", "masses": n.to_string(), "parameters": { "k_3": 1e4 }, "end": 10.0,
                "accuracy": { "relative": 1e-10 }, "record": { "every": 1.0 }
            }),
        );
        let found = difference(&runs);
        assert!(found < 1e-7, "{n} masses: {found:e}");
        let [one, other] = runs.each_ref().map(|run| &run["events"]["by_transition"]);
        assert_eq!(one, other, "{n} masses");
        assert!(
            one["stick"].as_u64() > Some(0) && one["slip"].as_u64() > Some(0),
            "{one}"
        );
    }
}

/// Angle and rate of all cranks after a time, by Runge and Kutta's method on the one equation that they move by (reference 14b):
/// θ̈ = −(B/A) cos θ with A = (n + 1)/3 + n and B = ((n + 1)/2 + n) g, from the upright at −1 rad/s.
fn cranks(n: usize, t: f64) -> [f64; 2] {
    let n = n as f64;
    let ratio = ((n + 1.0) / 2.0 + n) * 9.81 / ((n + 1.0) / 3.0 + n);
    let slope = |[angle, rate]: [f64; 2]| [rate, -ratio * angle.cos()];
    let steps = 400_000;
    let h = t / f64::from(steps);
    let mut at = [std::f64::consts::FRAC_PI_2, -1.0];
    for _ in 0..steps {
        let by = |k: [f64; 2], part: f64| [at[0] + part * h * k[0], at[1] + part * h * k[1]];
        let first = slope(at);
        let second = slope(by(first, 0.5));
        let third = slope(by(second, 0.5));
        let fourth = slope(by(third, 1.0));
        at = std::array::from_fn(|i| {
            at[i] + h / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        });
    }
    at
}

/// 81 bars, 80 constraints, whose forces are not determined where all bars are in line: that is passed six times.
#[test]
#[ignore = "takes minutes; .ci/run calls it"]
fn forty_windows_pass_positions_in_which_all_bars_are_in_line() {
    let n = 40;
    let initial: serde_json::Map<_, _> = (1..=n + 1)
        .flat_map(|k| {
            let upright = json!(std::f64::consts::FRAC_PI_2);
            [
                (format!("crank_{k}"), upright),
                (format!("crank_{k}.rate"), json!(-1.0)),
            ]
        })
        .collect();
    for (method, end) in [("auto", 10.0), ("taylor", 2.0)] {
        let scene = json!({
            "model": "./chain", "initial": initial, "end": end, "accuracy": { "relative": 1e-9 },
            "record": { "every": 1.0, "outputs": false }
        });
        let run = summary(("windows", n), &scene, method);
        let exact = cranks(n, end);
        for k in 1..=n + 1 {
            for (group, name, exact) in [
                ("q", format!("crank_{k}"), exact[0]),
                ("v", format!("crank_{k}.rate"), exact[1]),
            ] {
                let off = run["end"][group][&name].as_f64().unwrap() - exact;
                assert!(off.abs() < 1e-9, "{method}, {name}: {off:e}");
            }
        }
        let energy = |key: &str| run["energy"][key].as_f64().unwrap();
        let imbalance = energy("imbalance") / energy("initial");
        assert!(imbalance.abs() < 1e-10, "{method}: {imbalance:e}");
    }
}
