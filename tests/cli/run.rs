//! `run`: scenes that ship, output folders, overrides, early stops.

use super::*;

/// What every run leaves; `phase.svg` is there where something moves.
const FILES: [&str; 7] = [
    ".dalembert-digests",
    ".dalembert-output",
    "csv-metadata.json",
    "events.csv",
    "overview.svg",
    "summary.json",
    "trajectory.csv",
];

#[test]
fn every_scene_that_ships_runs() {
    let home = tempfile::tempdir().unwrap();
    let scenes = names(&project().join("scenes"));
    let scenes = scenes.iter().filter_map(|name| name.strip_suffix(".json"));
    let mut models = Vec::new();
    for name in scenes {
        let output = ends_with(0, home.path(), &["run", &scene(name), "--out", name]);
        assert_eq!(stderr(&output), "", "{name}");
        let out = home.path().join(name);
        for file in FILES {
            let path = out.join(file);
            let size = fs::metadata(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            assert!(size.len() > 0, "{}", path.display());
        }
        let summary = json(&out.join("summary.json"));
        assert!(summary["failure"].is_null(), "{name}");
        let energy = |key: &str| summary["energy"][key].as_f64().unwrap();
        assert!(energy("imbalance").is_finite(), "{name}");
        models.push(summary["model"].as_str().unwrap().to_owned());
    }
    for model in [
        "belt_oscillator",
        "bouncing_ball",
        "coulomb_oscillator",
        "double_pendulum",
    ] {
        assert!(models.iter().any(|m| m == model), "no scene of {model}");
    }
    for model in ["rocking_block", "vibrating_table_ball", "walking_tank"] {
        assert!(models.iter().any(|m| m == model), "no scene of {model}");
    }
}

#[test]
fn without_a_folder_nothing_is_written() {
    let home = tempfile::tempdir().unwrap();
    let output = ends_with(0, home.path(), &["run", &scene("bouncing_ball")]);
    assert!(stdout(&output).contains("reached t = 5 s, mode floor closed"));
    assert!(names(home.path()).is_empty());
}

#[test]
fn overrides_reach_the_simulation() {
    let home = tempfile::tempdir().unwrap();
    let run = ["run", &scene("bouncing_ball"), "--out", "out"];
    let settings = [
        "--set",
        "parameters.e=0.5",
        "--set",
        "initial.h=2",
        "--set",
        "end=1.5",
    ];
    ends_with(0, home.path(), &[&run[..], &settings].concat());
    let summary = json(&home.path().join("out/summary.json"));
    assert_eq!(summary["parameters"]["e"], 0.5);
    assert_eq!(summary["end"]["t"], 1.5);
    assert_eq!(summary["peaks"]["h"]["max"], 2.0);
    // Free fall from 2 m.
    let events = fs::read_to_string(home.path().join("out/events.csv")).unwrap();
    let first: f64 = events
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((first - (4.0_f64 / 9.81).sqrt()).abs() < 1e-14);
}

#[test]
fn an_early_stop_is_written_with_its_reason() {
    // A block that is thrown over is lifted off the ground by its own rotation.
    let home = tempfile::tempdir().unwrap();
    let run = ["run", &scene("rocking_block"), "--out", "out"];
    let thrown = [
        "--set",
        "initial.theta=0",
        "--set",
        "initial.theta.rate=2.5",
    ];
    let output = ends_with(3, home.path(), &[&run[..], &thrown].concat());
    assert!(stderr(&output).starts_with("stopped early at t = "));
    assert!(stdout(&output).contains("the block would leave the ground"));
    let out = home.path().join("out");
    assert!(FILES.iter().all(|file| out.join(file).is_file()));
    let summary = json(&out.join("summary.json"));
    let failure = &summary["failure"];
    assert!(
        failure["reason"]
            .as_str()
            .unwrap()
            .contains("the block would leave the ground")
    );
    assert_eq!(failure["mode"], "base open");
    let t = failure["t"].as_f64().unwrap();
    assert!(t > 0.0 && t < 12.0);
    let rows = fs::read_to_string(out.join("trajectory.csv")).unwrap();
    let last = rows.lines().last().unwrap().split(',').next().unwrap();
    assert_eq!(
        last.parse::<f64>().unwrap(),
        t,
        "the rows go up to the stop"
    );
}

#[test]
fn a_foreign_folder_is_refused_and_untouched() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("thesis.tex"), "years of work").unwrap();
    let output = ends_with(
        2,
        home.path(),
        &["run", &scene("bouncing_ball"), "--out", "out"],
    );
    assert!(stderr(&output).contains("was not written by dalembert"));
    assert_eq!(stdout(&output), "");
    assert_eq!(names(&out), ["thesis.tex"]);
    assert_eq!(
        fs::read_to_string(out.join("thesis.tex")).unwrap(),
        "years of work"
    );
    assert_eq!(names(home.path()), ["out"]);
}

#[test]
fn a_second_run_replaces_the_first() {
    let home = tempfile::tempdir().unwrap();
    let run = ["run", &scene("bouncing_ball"), "--out", "out"];
    ends_with(0, home.path(), &run);
    ends_with(0, home.path(), &[&run[..], &["--set", "end=1"]].concat());
    let summary = json(&home.path().join("out/summary.json"));
    assert_eq!(summary["end"]["t"], 1.0);
    assert_eq!(names(home.path()), ["out"]);
}

#[test]
fn a_refused_run_leaves_the_last_one() {
    let home = tempfile::tempdir().unwrap();
    let run = ["run", &scene("bouncing_ball"), "--out", "out"];
    ends_with(0, home.path(), &run);
    ends_with(2, home.path(), &[&run[..], &["--set", "end=-1"]].concat());
    assert_eq!(json(&home.path().join("out/summary.json"))["end"]["t"], 5.0);
}

/// A forced oscillation that reaches a stop at x = 1 but for `missing` (tests/data/07_grazing.json).
fn grazing(missing: f64) -> String {
    let (omega, force, lag) = (0.8, 0.39395431207184417, 0.4182243295792291);
    let (amplitude, phase) = (force * (1.0 - missing), lag + std::f64::consts::PI);
    format!(
        r#"{{"model": "coulomb_oscillator",
            "parameters": {{"c": 0.2, "static_friction": 0, "kinetic_friction": 0, "stop": 1}},
            "initial": {{"mode": "base slides, right open, left open", "x.rate": {}, "base_direction": -1}},
            "inputs": {{"force": {{"sine": {{"amplitude": {amplitude}, "frequency": {}, "phase": {phase}}}}}}},
            "end": 3, "accuracy": {{"relative": 1e-8}}}}"#,
        -omega * (1.0 - missing),
        omega / std::f64::consts::TAU,
    )
}

#[test]
fn what_hangs_on_the_tolerance_is_said() {
    let home = tempfile::tempdir().unwrap();
    for (missing, total) in [(1e-10, 1), (1e-5, 0)] {
        fs::write(home.path().join("scene.json"), grazing(missing)).unwrap();
        let output = ends_with(0, home.path(), &["run", "scene.json", "--out", "out"]);
        let uncertain = &json(&home.path().join("out/summary.json"))["uncertain"];
        assert_eq!(uncertain["total"], total, "{uncertain}");
        let line = stdout(&output)
            .lines()
            .find(|line| line.starts_with("uncertain"));
        assert_eq!(line.is_some(), total > 0);
        let Some(line) = line else { continue };
        assert!(
            line.contains("what happens at one place, first at t = 1.9635 s: left strikes turns back at 1e-10 m, with an error of 4e-8 m; tighten"),
            "{line}"
        );
        let first = &uncertain["first"][0];
        assert_eq!(
            (&first["what"], &first["unit"]),
            (&"near-miss".into(), &"m".into())
        );
        let [value, error] = ["value", "error"].map(|key| first[key].as_f64().unwrap());
        assert!((value / missing - 1.0).abs() < 0.1, "{value:e}");
        assert!((1e-8..1e-6).contains(&error), "{error:e}");
    }
    // What was said of the run that is continued is said of the whole.
    fs::write(home.path().join("scene.json"), grazing(1e-10)).unwrap();
    ends_with(0, home.path(), &["run", "scene.json", "--out", "out"]);
    let longer = ["run", "scene.json", "--resume", "out", "--set", "end=3.5"];
    ends_with(0, home.path(), &longer);
    assert_eq!(
        json(&home.path().join("out/summary.json"))["uncertain"]["total"],
        1
    );
}

#[test]
fn ordinary_scenes_leave_nothing_uncertain() {
    let home = tempfile::tempdir().unwrap();
    let scenes = fs::read_dir(project().join("scenes")).unwrap();
    let names = scenes.map(|entry| entry.unwrap().path().display().to_string());
    for name in names.filter(|name| name.ends_with(".json")) {
        // At the tightest it says that it cannot pass a singular position.
        let tolerances = ["1e-4", "1e-8", "1e-12"].into_iter();
        let passes = !name.ends_with("double_four_bar.json");
        for tolerance in tolerances.filter(|&tolerance| passes || tolerance != "1e-12") {
            let relative = format!("accuracy.relative={tolerance}");
            let run = [
                "run",
                &name,
                "--set",
                &relative,
                "--set",
                "record.energies=false",
            ];
            let output = ends_with(0, home.path(), &run);
            assert!(
                !stdout(&output).contains("uncertain"),
                "{name} at {tolerance}"
            );
        }
    }
}

#[test]
fn more_rows_than_there_is_room_for_are_refused_before_the_run() {
    let home = tempfile::tempdir().unwrap();
    let ball = scene("bouncing_ball");
    for every in ["1e-12", "1e-30"] {
        let setting = format!("record.every={every}");
        let run = ["run", &ball, "--set", &setting, "--out", "out"];
        let output = ends_with(2, home.path(), &run);
        let said = stderr(&output);
        assert!(
            said.contains("rows of the trajectory") && said.contains("bytes of disk"),
            "{said}"
        );
        assert!(!home.path().join("out").exists());
        // Without a folder and a page nobody sees them: they are not computed, and the report is the same.
        let [shown, of_scene] = [&run[..4], &run[..2]].map(|run| {
            let output = ends_with(0, home.path(), run);
            stdout(&output).split_once("solver").unwrap().0.to_owned()
        });
        assert_eq!(shown, of_scene);
    }
}

#[test]
fn the_report_is_shown_where_files_cannot_be_written() {
    let home = tempfile::tempdir().unwrap();
    let ball = scene("bouncing_ball");
    // A file of somebody else in the way, which only the writing finds.
    ends_with(
        0,
        home.path(),
        &[
            "run",
            &ball,
            "--out",
            "out",
            "--set",
            "end=0.1",
            "--set",
            "record={}",
        ],
    );
    let out = home.path().join("out");
    let marker = fs::read_to_string(out.join(".dalembert-output")).unwrap();
    fs::write(
        out.join(".dalembert-output"),
        marker.replace("events.csv\n", ""),
    )
    .unwrap();
    let output = dalembert(home.path())
        .args(["run", &ball, "--out", "out"])
        .output()
        .unwrap();
    assert_ne!(output.status.code(), Some(0));
    assert!(
        stderr(&output).contains("events.csv"),
        "{}",
        stderr(&output)
    );
    assert!(
        stdout(&output).contains("reached t ="),
        "{}",
        stdout(&output)
    );
}

#[test]
fn plots_survive_the_largest_and_the_smallest_numbers() {
    let home = tempfile::tempdir().unwrap();
    let ball = scene("bouncing_ball");
    for settings in [
        ["initial.h=1e-308", "end=1e-160"],
        ["parameters.g=1e307", "end=1e-154"],
    ] {
        let [one, two] = settings;
        let run = [
            "run",
            &ball,
            "--set",
            one,
            "--set",
            two,
            "--set",
            "record={}",
            "--out",
            "out",
        ];
        let output = dalembert(home.path()).args(run).output().unwrap();
        let code = output.status.code();
        assert!(
            matches!(code, Some(0 | 2 | 3)),
            "{settings:?}: {code:?} {}",
            stderr(&output)
        );
    }
}

/// Landings of a tank on both edges, whose errors grow from one to the next: a change of gravity in its last place changes
/// the order of the last ones, by either method.
#[test]
fn events_that_no_tolerance_settles_are_said_to_be_unsettled() {
    let home = tempfile::tempdir().unwrap();
    let scene = r#"{"model": "walking_tank", "landing": "velocities",
        "parameters": {"set": "doughnut", "mu_s": 0.67, "mu_k": 0.67, "e": 0.674, "damping": 0},
        "inputs": {"ground_acceleration": {"sine": {"amplitude": 13.4, "angular_frequency": 35.5}}},
        "accuracy": {"relative": 1e-8}, "end": 1.1}"#;
    fs::write(home.path().join("scene.json"), scene).unwrap();
    let output = ends_with(0, home.path(), &["run", "scene.json", "--out", "out"]);
    let uncertain = &json(&home.path().join("out/summary.json"))["uncertain"];
    let first = &uncertain["first"][0];
    assert_eq!(first["what"], "unsettled", "{uncertain}");
    assert_eq!(first["guard"], "landing", "{uncertain}");
    assert!(stdout(&output).contains("is another event at another tolerance"));
}

#[test]
fn pictures_come_in_the_formats_that_are_asked_for() {
    let home = tempfile::tempdir().unwrap();
    let scene = scene("bouncing_ball");
    let run = |more: &[&str], status| {
        ends_with(
            status,
            home.path(),
            &[&["run", &scene, "--out", "out"], more].concat(),
        )
    };
    run(&["--plot-format", "png,pdf", "--set", "end=0.5"], 0);
    let file = |name: &str| fs::read(home.path().join("out").join(name)).unwrap();
    let pdf = file("overview.pdf");
    assert!(pdf.starts_with(b"%PDF-1.") && pdf.trim_ascii_end().ends_with(b"%%EOF"));
    // Width and height stand behind the name of the first part: twice those of the picture.
    let png = file("phase.png");
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    assert_eq!(png[16..24], [0, 0, 2, 248, 0, 0, 2, 148]);
    assert!(!home.path().join("out/overview.svg").exists());
    run(&["--plot-format", "gif"], 2);
    run(&["--plot-format", "png", "--plot-size", "20000x20000"], 2);
}
