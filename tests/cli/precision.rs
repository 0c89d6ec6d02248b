//! `precision`, and the estimate of `run`.

use super::*;

/// The rows of precision.csv, by the heads of the columns.
fn rows(folder: &Path) -> Vec<std::collections::HashMap<String, String>> {
    let mut csv = csv::Reader::from_path(folder.join("precision.csv")).unwrap();
    csv.deserialize().map(Result::unwrap).collect()
}

#[test]
fn every_method_comes_with_time_and_error_at_every_tolerance() {
    let home = tempfile::tempdir().unwrap();
    let precision = ["precision", &scene("sliding_oscillator"), "--out", "out"];
    let output = ends_with(0, home.path(), &precision);
    let text = stdout(&output);
    let out = home.path().join("out");
    assert!(
        fs::read_to_string(out.join("precision.svg"))
            .unwrap()
            .contains("radau")
    );
    let rows = rows(&out);
    assert_eq!(rows.len(), 3 * 11);
    for row in &rows {
        let number = |head: &str| {
            row[head]
                .parse::<f64>()
                .unwrap_or_else(|_| panic!("{head}: {row:?}"))
        };
        assert_eq!(row["outcome"], "complete");
        assert_eq!(
            (number("missed events"), number("extra events")),
            (0.0, 0.0)
        );
        assert!(number("time [s]") > 0.0 && number("steps") > 55.0);
        let (tolerance, error) = (number("tolerance"), number("end error"));
        // A global error is of the size of the tolerance here, down to the rounding of the states.
        assert!(error <= (10.0 * tolerance).max(1e-12), "{row:?}");
        assert!(number("event time error [s]") <= (10.0 * tolerance).max(1e-13));
        assert!((1e-16..1e-13).contains(&number("bound of the end error")));
        assert_eq!(number("events in tails"), 0.0, "nothing accumulates");
        let used = if row["method"] == "radau" {
            "Radau"
        } else {
            "Taylor"
        };
        assert!(row["used"].starts_with(used), "{row:?}");
    }
    let advice = text
        .lines()
        .filter(|line| line.starts_with("for an error of"));
    assert_eq!(advice.clone().count(), 3, "{text}");
    assert!(
        advice.clone().all(|line| line.contains("tolerance 1e-")),
        "{text}"
    );
}

#[test]
fn json_says_what_the_table_and_the_advice_say() {
    let home = tempfile::tempdir().unwrap();
    let precision = ["precision", &scene("belt_oscillator"), "--json"];
    let arguments = ["--error", "1e-6", "--error", "1e-20", "--out", "out"];
    let output = ends_with(0, home.path(), &[&precision[..], &arguments].concat());
    let found: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(found["complete"], true);
    let table = rows(&home.path().join("out"));
    let printed = found["rows"].as_array().unwrap();
    assert_eq!(printed.len(), table.len());
    for (printed, row) in printed.iter().zip(&table) {
        for key in ["method", "used", "outcome"] {
            assert_eq!(printed[key], row[key].as_str(), "{row:?}");
        }
        for (key, head) in [
            ("tolerance", "tolerance"),
            ("end_error", "end error"),
            ("event_time_error", "event time error [s]"),
            ("missed_events", "missed events"),
            ("extra_events", "extra events"),
            ("events_in_tails", "events in tails"),
            ("uncertain", "uncertain"),
            ("energy_imbalance", "energy imbalance [J]"),
            ("steps", "steps"),
            ("evaluations", "evaluations"),
            ("seconds", "time [s]"),
        ] {
            let number: f64 = row[head].parse().unwrap();
            assert_eq!(printed[key].as_f64(), Some(number), "{key} of {row:?}");
        }
    }
    let reference = &found["reference"];
    assert_eq!(reference["events"], 13);
    let bound = table[0]["bound of the end error"].parse::<f64>().unwrap();
    assert_eq!(reference["bound"]["end_error"].as_f64(), Some(bound));
    assert!(reference["horizon"].is_null());
    let [first, second] = [0, 1].map(|i| &found["advice"][i]);
    assert_eq!(
        (first["error"].as_f64(), second["error"].as_f64()),
        (Some(1e-6), Some(1e-20))
    );
    assert!(first["tolerance"].as_f64().is_some() && first["why_none"].is_null());
    assert_eq!(
        second["why_none"],
        "the reference itself is not known to that"
    );
}

#[test]
fn the_tolerance_that_is_advised_reaches_the_error() {
    // P2 of benches/peers, against its reference of 30 digits.
    let home = tempfile::tempdir().unwrap();
    let reference: serde_json::Value =
        serde_json::from_str(include_str!("../../benches/peers/reference.json")).unwrap();
    let end = &reference["P2"]["y_end"];
    let number = |i: usize| end[i].as_str().unwrap().parse::<f64>().unwrap();
    let (theta, rate) = (number(0), number(1));
    fs::write(
        home.path().join("scene.json"),
        r#"{"model": "rocking_block",
            "parameters": {"alpha": 0.25, "R": 1.5, "e": 0.85},
            "initial": {"theta": 0.075},
            "inputs": {"ground_acceleration": {"sine": {"amplitude": -3.4335, "frequency": 1.5, "phase": 0.3}}},
            "end": 10, "accuracy": {"relative": 1e-8}}"#,
    )
    .unwrap();
    for error in ["1e-4", "1e-8"] {
        let output = ends_with(
            0,
            home.path(),
            &["precision", "scene.json", "--error", error],
        );
        let text = stdout(&output);
        let line = text
            .lines()
            .find(|line| line.starts_with("for an error of"))
            .unwrap();
        let word = |after: &str| {
            let rest = line.split_once(after).unwrap().1;
            rest.split(',').next().unwrap().trim().to_owned()
        };
        let settings = [
            format!("method={}", word("method ")),
            format!("accuracy.relative={}", word("tolerance ")),
        ];
        let run = [
            "run",
            "scene.json",
            "--set",
            &settings[0],
            "--set",
            &settings[1],
            "--out",
            "out",
        ];
        ends_with(0, home.path(), &run);
        let summary = json(&home.path().join("out/summary.json"));
        // The model's angle is measured from the edge on which the block stands. Its typical size is
        // 0.1 rad, that of its rate 0.1 rad/s.
        let side = summary["end"]["discrete"]["side"].as_f64().unwrap();
        for (of, exact) in [
            (&summary["end"]["q"]["theta"], theta),
            (&summary["end"]["v"]["theta.rate"], rate),
        ] {
            let found = side * of.as_f64().unwrap();
            let reached = (found - exact).abs() / (0.1 + exact.abs());
            assert!(reached <= error.parse().unwrap(), "{line}: {reached:e}");
        }
    }
}

#[test]
fn a_method_that_is_hopeless_is_given_up_and_a_failing_scene_says_so() {
    let home = tempfile::tempdir().unwrap();
    let stiff = |end: &str| {
        let run = [
            "precision",
            &scene("sliding_oscillator"),
            "--out",
            "out",
            "--set",
            "parameters.k=1.05e16",
            "--set",
            "parameters.c=6.42e12",
            "--set",
            end,
        ];
        stdout(&ends_with(0, home.path(), &run)).to_owned()
    };
    // Some millions of steps.
    let text = stiff("end=3e-4");
    assert!(text.contains("given up"), "{text}");
    assert!(
        text.contains("taylor did not come to its end in 2 s"),
        "{text}"
    );
    // So many that the method refuses them.
    let text = stiff("end=0.05");
    assert!(text.contains("mode `base sticks` is stiff"), "{text}");
}

#[test]
fn a_scene_is_compared_up_to_where_it_stops() {
    // A block that is thrown over is lifted off the ground by its own rotation.
    let home = tempfile::tempdir().unwrap();
    let thrown = [
        "precision",
        &scene("rocking_block"),
        "--set=initial.theta=0",
        "--set=initial.theta.rate=2.5",
        "--out=out",
    ];
    let output = ends_with(0, home.path(), &thrown);
    let text = stdout(&output);
    assert!(
        text.contains("not determined beyond event 0, at t = 0.35"),
        "{text}"
    );
    assert!(text.contains("the block would leave the ground"), "{text}");
    let rows = rows(&home.path().join("out"));
    assert!(rows.iter().all(|row| row["outcome"] == "complete"));
}

#[test]
fn a_chaotic_scene_is_compared_up_to_where_its_events_are_determined() {
    let home = tempfile::tempdir().unwrap();
    let scene = scene("vibrating_table_ball");
    let chaos = ["--set=end=20", "--set=parameters.e=0.8", "--out=out"];
    let output = ends_with(
        0,
        home.path(),
        &[&["precision", &scene][..], &chaos].concat(),
    );
    let text = stdout(&output);
    let line = text
        .lines()
        .find(|line| line.starts_with("It is not determined beyond event"));
    let line = line.unwrap_or_else(|| panic!("{text}"));
    assert!(
        line.contains("its two runs have different events"),
        "{line}"
    );
    assert!(
        text.contains("1e-9: the reference itself is not known to that"),
        "{text}"
    );
    // Up to there the tightest rows have all its events; in 20 s they have others.
    for row in rows(&home.path().join("out")) {
        if row["tolerance"] == "1e-13" {
            let wrong = (&*row["missed events"], &*row["extra events"]);
            assert_eq!(wrong, ("0", "0"), "{row:?}");
        }
    }
}

#[test]
fn landings_that_a_looser_tolerance_leaves_out_are_not_missed() {
    let home = tempfile::tempdir().unwrap();
    ends_with(
        0,
        home.path(),
        &["precision", &scene("bouncing_ball"), "--out", "out"],
    );
    let mut tails = Vec::new();
    for row in rows(&home.path().join("out")) {
        assert_eq!(
            (&*row["missed events"], &*row["extra events"]),
            ("0", "0"),
            "{row:?}"
        );
        tails.push(row["events in tails"].parse::<u64>().unwrap());
    }
    // Three rows a tolerance; a tighter one leaves less out. Restitution 0.8 makes 153 impacts and
    // a rest at 1e-14, and a factor of 1e10 in the tolerance is that of 103 hops.
    assert!(tails.is_sorted_by(|a, b| a >= b), "{tails:?}");
    assert!(tails[0] > 100 && tails[32] > 0, "{tails:?}");
}

#[test]
fn wrong_requests_of_precision_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let scene = scene("bouncing_ball");
    for wrong in ["0", "-1e-3", "much"] {
        let output = ends_with(
            2,
            home.path(),
            &["precision", &scene, &format!("--error={wrong}")],
        );
        assert!(
            stderr(&output).contains("positive number"),
            "{}",
            stderr(&output)
        );
    }
    ends_with(2, home.path(), &["precision", "nowhere.json"]);
    let both = ["run", &scene, "--resume", "out", "--error-estimate"];
    let output = ends_with(2, home.path(), &both);
    assert!(stderr(&output).contains("run the scene from its start, without --resume"));
    fs::create_dir(home.path().join("mine")).unwrap();
    fs::write(home.path().join("mine/notes"), "mine").unwrap();
    let output = ends_with(2, home.path(), &["precision", &scene, "--out", "mine"]);
    assert!(stderr(&output).contains("was not written by dalembert"));
}

#[test]
fn a_run_that_stops_early_has_no_estimate_and_says_so() {
    let home = tempfile::tempdir().unwrap();
    let thrown = ["--set=initial.theta=0", "--set=initial.theta.rate=2.5"];
    let run = ["run", &scene("rocking_block"), "--error-estimate"];
    let output = ends_with(3, home.path(), &[&run[..], &thrown].concat());
    assert!(stderr(&output).contains("no estimate of the error: the run stopped early"));
}

#[test]
fn the_estimate_of_a_run_is_its_error() {
    // The error is told by a run at the tightest tolerance.
    let home = tempfile::tempdir().unwrap();
    let scene = scene("sliding_oscillator");
    let at = |tolerance: &str, more: &[&str], out: &str| {
        let tolerance = format!("accuracy.relative={tolerance}");
        let run = ["run", &scene, "--set", &tolerance, "--out", out];
        ends_with(0, home.path(), &[&run[..], more].concat());
        json(&home.path().join(out).join("summary.json"))
    };
    let exact = at("1e-13", &[], "exact");
    for tolerance in ["1e-4", "1e-7"] {
        let run = at(tolerance, &["--error-estimate"], "out");
        let estimate = &run["error_estimate"];
        assert_eq!(estimate["missed_events"], 0);
        // Over the peaks of the run, so that different units compare.
        let mut parts = Vec::new();
        for state in ["q", "v"] {
            for (name, value) in estimate[state].as_object().unwrap() {
                let of =
                    |summary: &serde_json::Value| summary["end"][state][name].as_f64().unwrap();
                let peak = |which: &str| run["peaks"][name][which].as_f64().unwrap().abs();
                let size = peak("max").max(peak("min"));
                let error = (of(&run) - of(&exact)).abs();
                if size == 0.0 {
                    assert_eq!((value.as_f64(), error), (Some(0.0), 0.0), "{name} is held");
                    continue;
                }
                parts.push((value.as_f64().unwrap() / size, error / size));
            }
        }
        let largest = parts.iter().fold(0.0_f64, |most, part| most.max(part.1));
        // The better run is itself off by a few percent.
        assert!(
            parts
                .iter()
                .all(|(e, error)| (e - error).abs() <= 0.1 * largest),
            "{parts:?}"
        );
    }
    assert!(exact.get("error_estimate").is_none());
}
