//! What is measured: outputs of models and of scenes, limit states over them, extremes against closed forms.

use serde_json::json;

use super::super::json as read_json;
use super::{folder, run, write};

#[test]
fn outputs_and_limits_over_them_are_measured() {
    let folder = folder();
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "R": 1.0, "alpha": 0.25, "e": 0.8 },
        "initial": { "theta": 0.2, "side": 1, "mode": "base open" },
        "outputs": {
            "top": { "expression": "side * theta * R", "unit": "cm", "meaning": "along the arc" }
        },
        "limits": { "far": { "top": { "below": "-50 mm" }, "then": "continue" } },
        "end": 14.0,
        "accuracy": { "relative": 1e-11 }
    });
    write(folder.path(), "scene.json", &scene);
    let study = json!({
        "scene": "scene.json",
        "vary": { "initial.theta": [0.02, 0.1, 0.2], "parameters.e": [0.8, 0.9] },
        "measure": [
            "peak.rotation", "min.rotation", "max.centre_y", "end.rotation", "max.top", "min.top",
            "reached.far", "time.far", "count.base strikes", "max.energy.stored"
        ],
        "failure": { "measure": "min.top", "below": "-0.1 m" }
    });
    write(folder.path(), "study.json", &study);
    let rows = run(folder.path());
    assert_eq!(rows.len(), 6);
    let (alpha, g) = (0.25_f64, 9.81);
    for row in &rows {
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        let (theta, e) = (number("initial.theta"), number("parameters.e"));
        let near = |name: &str, exact: f64| {
            let found = number(name);
            assert!(
                (found - exact).abs() < 1e-10 * exact.abs().max(0.01),
                "{name}: {found} {exact}"
            );
        };
        // It leans to the left first; of the height that the centre falls e² is left for the other side.
        near("peak.rotation", theta);
        let rise = (alpha - theta).cos() - alpha.cos();
        near("max.centre_y", rise);
        let other = alpha - (alpha.cos() + e * e * rise).acos();
        near("min.rotation", -other);
        near("max.top", 100.0 * theta);
        near("min.top", -100.0 * other);
        near("max.energy.stored", g * (alpha - theta).cos());
        // In the end it stands.
        near("end.rotation", 0.0);
        assert_eq!(row["reached.far"], (other > 0.05).to_string());
        assert_eq!(row["time.far"].is_empty(), other <= 0.05);
        assert_eq!(row["failed"], (other > 0.1).to_string());
    }
    let summary = read_json(&folder.path().join("out/summary.json"));
    assert_eq!(summary["measures"]["max.top"]["unit"], "cm");
    assert_eq!(summary["measures"]["max.centre_y"]["unit"], "m");
    let failed = rows.iter().filter(|row| row["failed"] == "true").count();
    assert_eq!(summary["failures"]["failed"], failed);
}

#[test]
fn a_limit_state_of_the_scene_is_a_failure_and_is_searched_for() {
    let folder = folder();
    // The other side is reached with e² of the height: the amplitude there is 0.08 rad for exactly one release.
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "R": 1.0, "alpha": 0.25, "e": 0.9 },
        "initial": { "theta": 0.1, "side": 1, "mode": "base open" },
        "limits": { "leans": { "rotation": { "below": "-0.08 rad" } } },
        "end": 4.0,
        "accuracy": { "relative": 1e-12 }
    });
    write(folder.path(), "scene.json", &scene);
    let study = json!({
        "scene": "scene.json",
        "critical": { "value": "initial.theta", "from": 0.02, "to": 0.24, "scan": 4 },
        "failure": { "limit": "leans" },
        "measure": ["peak.rotation"]
    });
    write(folder.path(), "study.json", &study);
    run(folder.path());
    let found = super::table(&folder.path().join("out/capacities.csv"));
    let capacity: f64 = found[0]["capacity"].parse().unwrap();
    let (alpha, e) = (0.25_f64, 0.9);
    let exact = alpha - (alpha.cos() + ((alpha - 0.08).cos() - alpha.cos()) / (e * e)).acos();
    assert!((capacity / exact - 1.0).abs() < 2e-9, "{capacity} {exact}");
    // No measure says how near it was, so the two runs about it are made again.
    let summary = read_json(&folder.path().join("out/summary.json"));
    assert!(summary["failures"]["undecided"].as_u64() <= Some(2));
}

#[test]
fn a_cloud_is_regressed_and_its_dispersion_told() {
    let folder = folder();
    let scene = json!({
        "model": "rocking_block",
        "initial": { "theta": 0.1, "side": 1, "mode": "base open" },
        "end": 1e-3
    });
    write(folder.path(), "scene.json", &scene);
    // The peak is the release: the line is known, and nothing scatters.
    let study = json!({
        "scene": "scene.json",
        "random": { "variables": { "initial.theta": { "uniform": { "from": 0.02, "to": 0.2 } } }, "count": 16 },
        "cloud": { "intensity": "initial.theta" },
        "failure": { "measure": "peak.theta", "above": 0.1 }
    });
    write(folder.path(), "study.json", &study);
    let rows = run(folder.path());
    let summary = read_json(&folder.path().join("out/summary.json"));
    let cloud = &summary["cloud"];
    let near = |key: &str, exact: f64, within: f64| {
        let found = cloud[key].as_f64().unwrap();
        assert!((found - exact).abs() <= within, "{key}: {found} {exact}");
    };
    assert_eq!(cloud["measure"], "peak.theta");
    near("a", 1.0, 1e-14);
    near("b", 1.0, 1e-14);
    near("dispersion", 0.0, 1e-14);
    near("theta", 0.1, 1e-15);
    assert_eq!(
        (cloud["runs"].as_u64(), cloud["left_out"].as_u64()),
        (Some(16), Some(0))
    );
    // Whether a run fails follows from its intensity: no slope fits that.
    assert!(rows.iter().any(|row| row["failed"] == "true"));
    let problem = summary["fragility"]["problem"].as_str().unwrap();
    assert!(problem.starts_with("perfect separation"), "{problem}");
    assert_eq!(summary["fragility"]["theta"], serde_json::Value::Null);
    for file in ["cloud.svg", "fragility.svg"] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
}

#[test]
fn a_run_at_its_limit_is_undecided_and_one_away_from_it_is_not() {
    let folder = folder();
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "R": 1.0, "alpha": 0.25, "e": 0.9 },
        "initial": { "theta": 0.1, "side": 1, "mode": "base open" },
        "end": 1.5,
        "accuracy": { "relative": 1e-3 }
    });
    write(folder.path(), "scene.json", &scene);
    // The level is what the exact motion from 0.1 rad reaches: what this tolerance lets err decides.
    let (alpha, e) = (0.25_f64, 0.9);
    let rise = (alpha - 0.1).cos() - alpha.cos();
    let level = (alpha.cos() + e * e * rise).acos() - alpha;
    for (second_runs, undecided) in [("near", ["true", "false"]), ("none", ["false", "false"])] {
        let study = json!({
            "scene": "scene.json",
            "vary": { "initial.theta": [0.1, 0.12] },
            "failure": { "measure": "min.rotation", "below": level },
            "measure": ["min.rotation"],
            "second_runs": second_runs
        });
        write(folder.path(), "study.json", &study);
        let rows = run(folder.path());
        let found = [0, 1].map(|i| rows[i]["undecided"].as_str());
        assert_eq!(found, undecided, "{second_runs}: {rows:?}");
        let summary = read_json(&folder.path().join("out/summary.json"));
        let count = undecided.iter().filter(|is| **is == "true").count();
        assert_eq!(summary["failures"]["undecided"], count);
        std::fs::remove_dir_all(folder.path().join("out")).unwrap();
    }
}
