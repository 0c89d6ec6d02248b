//! Chains with more free coordinates than the engine is compiled for, as models in folders: what takes minutes to derive and to
//! compile, and so is called by `.ci/run` alone.

use std::fs;
use std::process::Command;

use serde_json::{Value, json};

use super::{json as read_json, project, stderr};

/// The summary of a chain of n bodies after some seconds, by each method.
fn by_each_method(model: &str, n: usize, scene: Value) -> [Value; 2] {
    let folder = tempfile::tempdir().unwrap();
    let own = project().join("tests/models").join(model).join("model.py");
    let text = fs::read_to_string(own).unwrap();
    let longer = text.replace("\nN = 7\n", &format!("\nN = {n}\n"));
    assert_ne!(text, longer);
    fs::create_dir(folder.path().join("chain")).unwrap();
    fs::write(folder.path().join("chain/model.py"), longer).unwrap();
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    ["taylor", "radau"].map(|method| {
        let output = Command::new(env!("CARGO_BIN_EXE_dalembert"))
            .current_dir(folder.path())
            .env("DALEMBERT_CACHE", folder.path().join("cache"))
            .args(["run", "scene.json", "--out", method, "--set"])
            .arg(format!("method={method}"))
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        read_json(&folder.path().join(method).join("summary.json"))
    })
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
