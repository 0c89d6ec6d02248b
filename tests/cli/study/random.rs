//! Random variables: each distribution, their correlation, the designs.

use std::fs;

use serde_json::json;

use super::super::{json as read_json, project};
use super::{folder, run, write};

#[test]
fn every_distribution_and_the_copula_give_the_values_of_the_references() {
    let reference = read_json(&project().join("tests/data/study_distributions.json"));
    let folder = folder();
    fs::write(
        folder.path().join("scene.json"),
        r#"{ "model": "rocking_block", "initial": { "mode": "base open" }, "end": 1e-3 }"#,
    )
    .unwrap();
    let paths = [
        "parameters.R",
        "parameters.alpha",
        "parameters.e",
        "parameters.m",
        "initial.theta",
        "parameters.g",
        "initial.side",
    ];
    // As text: the order of the variables is that of the dimensions of the design.
    let (count, seed) = (&reference["count"], &reference["seed"]);
    let study = format!(
        r#"{{
            "scene": "scene.json",
            "random": {{
                "variables": {{
                    "parameters.R": {{ "lognormal": {{ "median": "1200 mm", "beta": 0.3 }} }},
                    "parameters.alpha": {{ "normal": {{ "mean": 0.25, "sd": 0.02 }} }},
                    "parameters.e": {{ "triangular": {{ "from": 0.85, "mode": 0.92, "to": 0.97 }} }},
                    "parameters.m": {{ "uniform": {{ "from": 1, "to": 3 }} }},
                    "initial.theta": {{ "normal": {{ "mean": 0.1, "sd": 0.05 }}, "above": 0.02, "below": 0.16 }},
                    "parameters.g": {{ "empirical": {{ "values": [9.83, 9.78, 9.81, 9.80] }} }},
                    "initial.side": {{ "discrete": {{ "values": [1, -1], "weights": [1, 3] }} }}
                }},
                "correlations": [
                    ["parameters.R", "parameters.alpha", -0.4],
                    ["parameters.R", "parameters.m", 0.5],
                    ["parameters.alpha", "parameters.e", 0.2]
                ],
                "count": {count},
                "seed": {seed}
            }},
            "measure": ["count"]
        }}"#
    );
    fs::write(folder.path().join("study.json"), study).unwrap();
    let rows = run(folder.path());
    for path in paths {
        let (_, name) = path.split_once('.').unwrap();
        let theirs = reference["values"][name].as_array().unwrap();
        assert_eq!(rows.len(), theirs.len());
        for (i, (row, exact)) in rows.iter().zip(theirs).enumerate() {
            let (x, exact): (f64, f64) = (row[path].parse().unwrap(), exact.as_f64().unwrap());
            // A quantile, a probability and a quantile, each rounded.
            assert!(
                (x / exact - 1.0).abs() < 2e-15,
                "{path}, sample {i}: {x} {exact}"
            );
        }
    }
}

#[test]
fn random_variables_have_their_distribution_and_correlation() {
    let folder = folder();
    let study = json!({
        "scene": "scene.json",
        "random": {
            "variables": {
                "parameters.alpha": { "normal": { "mean": 0.3, "sd": 0.02 }, "above": 0.25 },
                "parameters.R": { "lognormal": { "median": 1.0, "beta": 0.1 } },
                "parameters.e": { "discrete": { "values": [0.8, 0.9], "weights": [1, 3] } },
                "initial.theta": { "triangular": { "from": 0.1, "mode": 0.1, "to": 0.2 } }
            },
            "correlations": [["parameters.alpha", "parameters.R", 0.6]],
            "count": 512,
            "design": "latin_hypercube"
        },
        "measure": ["count"]
    });
    write(folder.path(), "study.json", &study);
    fs::write(
        folder.path().join("scene.json"),
        r#"{ "model": "rocking_block", "initial": { "side": 1 }, "end": 0.01 }"#,
    )
    .unwrap();
    let rows = run(folder.path());
    let column =
        |name: &str| -> Vec<f64> { rows.iter().map(|r| r[name].parse().unwrap()).collect() };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (alpha, radius) = (column("parameters.alpha"), column("parameters.R"));
    // The mean of a normal variable that is cut at -2.5: 0.3 + 0.02 φ(2.5)/Φ(2.5).
    assert!(
        (mean(&alpha) - 0.300_352_7).abs() < 2e-5,
        "{}",
        mean(&alpha)
    );
    assert!(alpha.iter().all(|a| *a > 0.25));
    let logarithms: Vec<f64> = radius.iter().map(|r| r.ln()).collect();
    assert!(mean(&logarithms).abs() < 5e-3);
    let deviations = |values: &[f64]| {
        let mean = mean(values);
        values.iter().map(|x| x - mean).collect::<Vec<_>>()
    };
    let (a, r) = (deviations(&alpha), deviations(&logarithms));
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let correlation = product(&a, &r) / (product(&a, &a) * product(&r, &r)).sqrt();
    // The copula is of the normal variables; cutting one at −2.5 changes next to nothing. 512 samples know it to 0.03.
    assert!((correlation - 0.6).abs() < 0.06, "{correlation}");
    // A hypercube hits each stratum once: three quarters to one sample.
    let many = column("parameters.e").iter().filter(|e| **e == 0.9).count();
    assert_eq!(many, 384);
    assert!((mean(&column("initial.theta")) - 0.4 / 3.0).abs() < 1e-4);
}
