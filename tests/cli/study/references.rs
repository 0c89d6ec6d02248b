//! Studies against independent references.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use serde_json::{Value, json};

use super::super::{ends_with, json as read_json, project};
use super::{table, write};

/// A folder with a scene.
fn folder_of(scene: &Value) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "scene.json", scene);
    folder
}

/// Runs a study in the folder `out` beside its scene.
fn run(folder: &tempfile::TempDir, study: &Value) {
    write(folder.path(), "study.json", study);
    let arguments = ["study", "study.json", "--out", "out", "--csv"];
    ends_with(0, folder.path(), &arguments);
}

/// Blocks under one wave of a sine.
fn block_under_a_wave() -> Value {
    json!({
        "model": "rocking_block",
        "inputs": { "ground_acceleration": { "sine": { "amplitude": 4.0, "frequency": 1.0, "cycles": 1 } } },
        "end": 8.0
    })
}

/// A row of the reference study.
fn rocking_study() -> Vec<BTreeMap<String, String>> {
    table(&project().join("tests/data/24_rocking_study.csv"))
}

#[test]
fn blocks_under_a_record_overturn_as_in_the_reference_study() {
    let reference = rocking_study();
    let folder = tempfile::tempdir().unwrap();
    let number = |row: &BTreeMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    let mut cases =
        "parameters.R,parameters.alpha,parameters.e,inputs.ground_acceleration.scale\n".to_owned();
    for row in &reference {
        let alpha = number(row, "alpha_rad");
        // Housner's restitution, of which the reference has no other.
        let e = 1.0 - 1.5 * alpha.sin().powi(2);
        writeln!(cases, "{},{alpha},{e},{}", row["R_m"], row["scale"]).unwrap();
    }
    fs::write(folder.path().join("cases.csv"), cases).unwrap();
    let record = project().join("tests/data/records/0111a.smc");
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "g": 9.81 },
        "inputs": { "ground_acceleration": { "record": record } },
        "end": 40.0,
        "accuracy": { "relative": 1e-10 }
    });
    write(folder.path(), "scene.json", &scene);
    // A block that falls leaves its edge before its side reaches the ground, and there a run stops: 0.7 rad, more than twice any
    // α here, are past any return.
    let study = json!({
        "scene": "scene.json",
        "cases": "cases.csv",
        "measure": ["peak.theta", "time.overturned"],
        "failure": { "measure": "peak.theta", "above": 0.7 },
        "second_runs": "all"
    });
    run(&folder, &study);
    let rows = table(&folder.path().join("out/runs.csv"));
    assert_eq!(rows.len(), reference.len());
    let mut times = 0;
    for (row, expected) in rows.iter().zip(&reference) {
        let overturned = expected["overturned"] == "1";
        assert_eq!(
            row["failed"],
            overturned.to_string(),
            "member {}",
            expected["member"]
        );
        // What the reference calls chaotic has a flag alone.
        if expected["time_determined"] == "0" {
            continue;
        }
        if !overturned {
            let ratio = number(row, "peak.theta") / number(row, "parameters.alpha");
            let exact = number(expected, "max_abs_theta_over_alpha");
            // Seven digits are printed.
            assert!(
                (ratio - exact).abs() < 6e-8,
                "member {}: {ratio} {exact}",
                expected["member"]
            );
        } else if !row["time.overturned"].is_empty() {
            let (t, exact) = (
                number(row, "time.overturned"),
                number(expected, "t_overturn_s"),
            );
            assert!(
                (t - exact).abs() < 1e-6,
                "member {}: {t} {exact}",
                expected["member"]
            );
            times += 1;
        }
    }
    assert!(times >= 1);
}

/// The least amplitude of one sine that overturns a block, as a multiple of α g.
fn critical(alpha: f64, frequency: f64, near: f64) -> Value {
    // With R = 3/4 m and g = 1 m/s² the block has p = 1/s. It rests until the pulse lifts it.
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "alpha": alpha, "g": 1.0, "R": 0.75 },
        "inputs": { "ground_acceleration": { "sine": {
            "amplitude": alpha * near, "angular_frequency": frequency, "cycles": 1 } } },
        // At the boundary the motion lingers at the unstable equilibrium: a part of 1e-16 grows to its size in 37 s.
        // The reference is without an impact: what comes down has not overturned.
        "end": { "time": 100.0, "after": { "base strikes": 1 } },
        "accuracy": { "relative": 1e-13 }
    });
    let folder = folder_of(&scene);
    let study = json!({
        "scene": "scene.json",
        "critical": {
            "value": "inputs.ground_acceleration.sine.amplitude",
            "from": alpha * near * 0.99, "to": alpha * near * 1.01, "scan": 4, "resolution": 1e-11
        },
        "measure": ["peak.theta"],
        "failure": { "measure": "peak.theta", "above": 0.7 }
    });
    run(&folder, &study);
    let rows = table(&folder.path().join("out/capacities.csv"));
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0]["censored"], "0");
    let capacity: f64 = rows[0]["capacity"].parse().unwrap();
    json!(capacity / alpha)
}

#[test]
fn the_least_overturning_pulse_is_that_of_the_spectrum_to_nine_digits() {
    let reference = read_json(&project().join("tests/data/02_overturning_spectrum.json"));
    let rows = reference["reference"]["one_sine_no_impact_nonlinear"]
        .as_array()
        .unwrap();
    assert_eq!(rows.len(), 4);
    for row in rows {
        let number = |key: &str| row[key].as_str().unwrap().parse::<f64>().unwrap();
        let [alpha, frequency, exact] = ["alpha", "omega_p_over_p", "ap_over_g_alpha"].map(number);
        let found = critical(alpha, frequency, exact).as_f64().unwrap();
        assert!(
            (found / exact - 1.0).abs() < 1e-9,
            "{alpha} {frequency}: {found} {exact}"
        );
    }
}

#[test]
fn capacities_of_an_ida_are_those_of_fine_bisection_and_fitted_as_the_command_fits_them() {
    let folder = folder_of(&block_under_a_wave());
    let path = "inputs.ground_acceleration.sine.amplitude";
    let failure = json!({ "measure": "peak.theta", "above": 0.7 });
    let random = json!({
        "variables": {
            "parameters.alpha": { "uniform": { "from": 0.2, "to": 0.3 } },
            "parameters.R": { "uniform": { "from": 0.8, "to": 1.6 } }
        },
        "count": 12
    });
    let ida = json!({
        "scene": "scene.json", "random": random, "failure": failure, "measure": ["peak.theta"],
        "ida": { "intensity": path, "first": 2.0, "step": 1.0, "increment": 0.2, "runs": 18, "resolution": 0.01 }
    });
    write(folder.path(), "ida.json", &ida);
    ends_with(
        0,
        folder.path(),
        &["study", "ida.json", "--out", "ida", "--csv"],
    );
    let critical = json!({
        "scene": "scene.json", "random": random, "failure": failure, "measure": ["peak.theta"],
        "critical": { "value": path, "from": 2.0, "to": 40.0, "scan": 38 }
    });
    write(folder.path(), "critical.json", &critical);
    ends_with(
        0,
        folder.path(),
        &["study", "critical.json", "--out", "critical", "--csv"],
    );
    let capacities = |out: &str| table(&folder.path().join(out).join("capacities.csv"));
    let number = |row: &BTreeMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    let mut inside = 0;
    for (coarse, fine) in capacities("ida").iter().zip(&capacities("critical")) {
        assert_eq!(
            (&coarse["censored"], &fine["censored"]),
            (&"0".into(), &"0".into())
        );
        let (below, above) = (number(coarse, "below"), number(coarse, "above"));
        assert!(above - below <= 0.01 * above);
        assert!(number(fine, "above") - number(fine, "below") <= 1e-9 * number(fine, "above"));
        // A hunt may step over a first, narrow region of failures that the scan sees, or the other way round.
        inside += usize::from((below..=above).contains(&number(fine, "capacity")));
    }
    assert!(inside >= 9, "{inside}");
    // The fit of the summary is that of the table of capacities.
    let summary = read_json(&folder.path().join("ida/summary.json"));
    let fitted = ends_with(
        0,
        folder.path(),
        &["fragility", "ida/capacities.csv", "--json"],
    );
    let fitted: Value = serde_json::from_slice(&fitted.stdout).unwrap();
    for key in ["theta", "beta", "theta_interval", "beta_interval"] {
        assert_eq!(summary["fragility"][key], fitted[key], "{key}");
    }
    let [low, high] = [0, 1].map(|i| summary["fragility"]["theta_bootstrap"][i].as_f64().unwrap());
    let theta = fitted["theta"].as_f64().unwrap();
    assert!(low < theta && theta < high);
    // Fractile curves: intensities grow with the measure, and 16 % needs less than 84 %.
    let curves = &summary["ida"];
    let column = |name: &str| -> Vec<f64> {
        curves[name]
            .as_array()
            .unwrap()
            .iter()
            .map(|x| x.as_f64().unwrap())
            .collect()
    };
    let (low, middle, high) = (column("p16"), column("p50"), column("p84"));
    assert!(middle.is_sorted() && middle.len() == 101);
    assert!((0..101).all(|i| low[i] <= middle[i] && middle[i] <= high[i]));
}

#[test]
fn stripes_are_counted_and_fitted_as_the_command_fits_them() {
    let folder = folder_of(&block_under_a_wave());
    let study = json!({
        "scene": "scene.json",
        "random": {
            "variables": {
                "parameters.alpha": { "uniform": { "from": 0.2, "to": 0.3 } },
                "parameters.R": { "uniform": { "from": 0.8, "to": 1.6 } }
            },
            "count": 16
        },
        "vary": { "parameters.e": [0.85, 0.9] },
        "stripes": { "intensity": "inputs.ground_acceleration.sine.amplitude", "levels": { "from": 2.2, "to": 4.7, "count": 6 } },
        "failure": { "measure": "peak.theta", "above": 0.7 },
        "measure": ["peak.theta"],
        "group": "parameters.e"
    });
    run(&folder, &study);
    let rows = table(&folder.path().join("out/runs.csv"));
    assert_eq!(rows.len(), 2 * 16 * 6);
    let summary = read_json(&folder.path().join("out/summary.json"));
    for (group, fragility) in [
        (None, &summary["fragility"]),
        (Some("0.85"), &summary["fragility_by_group"][0]),
        (Some("0.9"), &summary["fragility_by_group"][1]),
    ] {
        let mut counts: BTreeMap<u64, [u32; 2]> = BTreeMap::new();
        for row in rows
            .iter()
            .filter(|row| group.is_none_or(|g| row["parameters.e"] == g))
        {
            let level: f64 = row["inputs.ground_acceleration.sine.amplitude"]
                .parse()
                .unwrap();
            let count = counts.entry(level.to_bits()).or_default();
            count[0] += 1;
            count[1] += u32::from(row["failed"] == "true");
        }
        let mut text = "im,n,k\n".to_owned();
        for (level, [n, k]) in counts {
            writeln!(text, "{},{n},{k}", f64::from_bits(level)).unwrap();
        }
        fs::write(folder.path().join("counts.csv"), text).unwrap();
        let fitted = ends_with(0, folder.path(), &["fragility", "counts.csv", "--json"]);
        let fitted: Value = serde_json::from_slice(&fitted.stdout).unwrap();
        for key in ["theta", "beta"] {
            let (mine, theirs) = (
                fragility[key].as_f64().unwrap(),
                fitted[key].as_f64().unwrap(),
            );
            assert!(
                (mine / theirs - 1.0).abs() < 1e-12,
                "{key}: {mine} {theirs}"
            );
        }
    }
}

#[test]
fn capacities_beyond_the_last_run_are_censored() {
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "alpha": 0.25 },
        "initial": { "theta": 0.1, "side": 1, "mode": "base open" },
        "end": 0.01
    });
    let folder = folder_of(&scene);
    // The centre is highest in the beginning: the level is reached from α − acos(cos α + level/R) on.
    let study = |level: f64| {
        json!({
            "scene": "scene.json",
            "random": { "variables": { "parameters.R": { "uniform": { "from": 0.5, "to": 1.5 } } }, "count": 16 },
            "ida": { "intensity": "initial.theta", "first": 0.02, "step": 0.02, "runs": 6, "resolution": 0.02 },
            "failure": { "measure": "max.centre_y", "above": level },
            "measure": ["max.centre_y"]
        })
    };
    write(folder.path(), "study.json", &study(0.0131));
    ends_with(0, folder.path(), &["study", "study.json", "--out", "out"]);
    let mut censored = 0;
    for row in table(&folder.path().join("out/capacities.csv")) {
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        let exact = 0.25 - (0.25_f64.cos() + 0.0131 / number("parameters.R")).acos();
        if exact > 0.12 {
            // Six steps of 0.02 rad without a failure.
            assert_eq!(row["censored"], "1");
            assert!((number("capacity") - 0.12).abs() < 1e-15);
            censored += 1;
        } else {
            assert_eq!(row["censored"], "0");
            assert!(
                number("below") <= exact && exact <= number("above"),
                "{row:?}"
            );
        }
    }
    let summary = read_json(&folder.path().join("out/summary.json"));
    assert_eq!(summary["capacities"]["censored"], censored);
    assert!(censored >= 2);
    let fitted = ["fragility", "out/capacities.csv", "--json"];
    let fitted: Value =
        serde_json::from_slice(&ends_with(0, folder.path(), &fitted).stdout).unwrap();
    assert!(fitted["theta"].is_number());
    for key in ["theta", "beta", "theta_interval", "beta_interval"] {
        assert_eq!(summary["fragility"][key], fitted[key], "{key}");
    }
    // Nothing fails: nothing is fitted.
    write(folder.path(), "study.json", &study(1.0));
    ends_with(0, folder.path(), &["study", "study.json", "--out", "none"]);
    let summary = read_json(&folder.path().join("none/summary.json"));
    assert_eq!(summary["capacities"]["censored"], 16);
    assert_eq!(summary["fragility"]["theta"], Value::Null);
    let problem = summary["fragility"]["problem"].as_str().unwrap();
    assert!(problem.contains("no failure"), "{problem}");
}
