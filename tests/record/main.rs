//! What is made of a run: tables, summary, pictures, and the folder they are in. The runs are made
//! by formula.

#[path = "../browser/mod.rs"]
mod browser;
mod going_on;
mod killed;
mod observers;
mod pages;
mod synthetic;

use std::fs;
use std::path::Path;

use dalembert::record::plot::{Chart, Curve, Dimension, Style, overview, phase_portraits};
use dalembert::record::table::{write_events, write_metadata, write_trajectory};
use dalembert::record::{
    ColumnKind, Event, Failure, HybridState, ModeNames, OutputFolder, Quantity, Recorder, Report,
    Run, Snapshot, Summary,
};
use proptest::prelude::*;
use synthetic::{bouncing_ball, tank_like};

fn text(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn header(table: &str) -> Vec<&str> {
    table.lines().next().unwrap().split(',').collect()
}

#[test]
fn a_small_run_gives_these_files() {
    let run = bouncing_ball(1.0, 2, 5);
    golden("trajectory.csv", &text(|out| write_trajectory(&run, out)));
    golden("events.csv", &text(|out| write_events(&run, out)));
    golden("csv-metadata.json", &text(|out| write_metadata(&run, out)));
    golden("summary.json", &text(|out| Summary::new(&run).write(out)));
    golden("report.txt", &Report::new(&run).to_string());
}

/// Renews golden files.
const RENEW: &str = "DALEMBERT_RENEW";

/// Holds a text against its golden file, or renews that.
fn golden(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/record/golden");
    let path = path.join(name);
    if std::env::var_os(RENEW).is_some() {
        return fs::write(path, text).unwrap();
    }
    let kept = fs::read_to_string(path).unwrap_or_default();
    assert!(
        text == kept,
        "{name} has changed\nfrom\n{kept}\nto\n{text}\nIf that is meant, renew it by\n  {RENEW}=1 cargo test --test record\n\
         and look at what `git diff` says."
    );
}

#[test]
fn the_metadata_describe_every_column() {
    let run = tank_like(10, 3);
    let metadata: serde_json::Value =
        serde_json::from_str(&text(|out| write_metadata(&run, out))).unwrap();
    let tables = [
        text(|out| write_trajectory(&run, out)),
        text(|out| write_events(&run, out)),
    ];
    for (i, table) in tables.iter().enumerate() {
        let columns = metadata["tables"][i]["tableSchema"]["columns"]
            .as_array()
            .unwrap();
        let names: Vec<_> = columns
            .iter()
            .map(|c| c["name"].as_str().unwrap())
            .collect();
        assert_eq!(names, header(table));
        let is_number = |c: &&serde_json::Value| c["datatype"] == "double";
        assert!(
            columns
                .iter()
                .filter(is_number)
                .all(|c| c["schema:unitText"].is_string())
        );
    }
}

#[test]
fn names_with_separators_are_quoted() {
    let mut run = bouncing_ball(1.0, 1, 2);
    run.layout.modes = ModeNames::listed(vec!["flies, \"freely\"".into(), "rests".into()]);
    let table = text(|out| write_trajectory(&run, out));
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(
        &reader.records().next().unwrap().unwrap()[6],
        "flies, \"freely\""
    );
}

proptest! {
    #[test]
    fn a_trajectory_is_read_back_bit_for_bit(rows in prop::collection::vec(any::<[f64; 6]>(), 0..20)) {
        let mut run = bouncing_ball(1.0, 1, 0);
        let mut recorder = Recorder::new(&run.layout, rows.len());
        for row in &rows {
            recorder.push_row(row[0], 1, |values| values.copy_from_slice(&row[1..]));
        }
        run.trajectory = recorder.finish();
        let table = text(|out| write_trajectory(&run, out));
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let records: Vec<_> = reader.records().map(Result::unwrap).collect();
        prop_assert_eq!(records.len(), rows.len());
        for (record, row) in records.iter().zip(&rows) {
            for (field, x) in record.iter().zip(row) {
                prop_assert_eq!(field.parse::<f64>().unwrap().to_bits(), x.to_bits());
            }
            prop_assert_eq!(&record[6], "rests");
        }
    }
}

#[test]
fn rows_go_in_without_allocation() {
    let run = tank_like(2, 0);
    let rows = Recorder::grid_rows(2.0, 0.001);
    let mut recorder = Recorder::new(&run.layout, rows);
    (0..2001).for_each(|i| recorder.push_row(f64::from(i) * 0.001, 0, |row| row[0] = 1.0));
    let trajectory = recorder.finish();
    assert_eq!(trajectory.t.capacity(), rows);
    assert_eq!(
        trajectory.values.capacity(),
        rows * trajectory.columns.len()
    );
    assert_eq!(trajectory.row(2000)[..2], [1.0, 0.0]);
}

#[test]
fn a_curve_has_both_sides_of_every_transition_in_order() {
    let run = bouncing_ball(1.0, 3, 50);
    let times: Vec<f64> = run.curve(1).map(|p| p.0).collect();
    assert_eq!(times.len(), 50 + 2 * run.events.len());
    assert!(times.is_sorted());
    let energy = run.layout.range(ColumnKind::Energy).start;
    assert_eq!(
        run.curve(energy).count(),
        50,
        "the state does not hold the energy"
    );
}

/// The run as it would have been left by a failure half-way.
fn stopped(mut run: Run) -> Run {
    let place = HybridState {
        t: 1.25,
        j: 2,
        mode: 0,
        state: run.events[1].after.clone(),
    };
    run.events.truncate(2);
    run.end = place.clone();
    run.failure = Some(Failure {
        reason: dalembert::hybrid::Reason::Requirement {
            mode: "flight",
            failure: "the normal force would be negative",
            text: "N",
            value: -0.5,
            unit: "N",
        },
        at: place,
    });
    run
}

#[test]
fn a_run_that_stopped_early_says_where_and_why() {
    let run = stopped(bouncing_ball(1.0, 3, 50));
    let summary: serde_json::Value =
        serde_json::from_str(&text(|out| Summary::new(&run).write(out))).unwrap();
    let failure = &summary["failure"];
    let reason = "mode `flight`: the normal force would be negative (N = -5e-1 N)";
    assert_eq!(failure["reason"], reason);
    assert_eq!(failure["t"], 1.25);
    assert_eq!(failure["j"], 2);
    assert_eq!(failure["mode"], "flies");
    assert_eq!(failure["q"]["y"], 0);
    let report = Report::new(&run).to_string();
    assert!(
        report.contains("stopped early at t = 1.25 s, after 2 transitions, in mode flies"),
        "{report}"
    );
    assert!(
        overview(&run).contains("stopped early at t = 1.25 s: mode `flight`: the normal force")
    );
    let home = tempfile::tempdir().unwrap();
    run.write(&OutputFolder::new(&home.path().join("out")).unwrap())
        .unwrap();
    assert!(home.path().join("out/summary.json").is_file());
}

#[test]
fn numbers_that_are_not_finite_are_written_as_such() {
    let mut run = stopped(bouncing_ball(1.0, 3, 0));
    run.events[1].after.q[0] = f64::NAN;
    run.end.state.q[0] = f64::INFINITY;
    assert!(text(|out| write_events(&run, out)).contains(",NaN,"));
    let summary: serde_json::Value =
        serde_json::from_str(&text(|out| Summary::new(&run).write(out))).unwrap();
    assert!(summary["end"]["q"]["y"].is_null());
    overview(&run);
}

#[test]
fn a_run_is_written_into_a_folder_with_the_same_bytes_each_time() {
    let home = tempfile::tempdir().unwrap();
    let run = tank_like(500, 40);
    let write = |name| {
        let path = home.path().join(name);
        run.write(&OutputFolder::new(&path).unwrap()).unwrap();
        let mut files: Vec<_> = fs::read_dir(&path)
            .unwrap()
            .map(|e| e.unwrap().path())
            .collect();
        files.sort();
        let read = |file: std::path::PathBuf| {
            (
                file.file_name().unwrap().to_str().unwrap().to_owned(),
                fs::read(&file).unwrap(),
            )
        };
        files.into_iter().map(read).collect::<Vec<_>>()
    };
    let (first, second) = (write("first"), write("second"));
    let names: Vec<_> = first.iter().map(|f| f.0.as_str()).collect();
    assert_eq!(
        names,
        [
            ".dalembert-digests",
            ".dalembert-output",
            "csv-metadata.json",
            "events.csv",
            "overview.svg",
            "phase.svg",
            "summary.json",
            "trajectory.csv",
        ]
    );
    assert!(first == second);
}

#[test]
fn pictures_of_long_runs_stay_small() {
    let run = tank_like(200_000, 20_000);
    let (overview, phase) = (overview(&run), phase_portraits(&run).unwrap());
    assert!(overview.len() < 400_000, "{} bytes", overview.len());
    assert!(phase.len() < 1_000_000, "{} bytes", phase.len());
    assert!(
        overview.contains(">\n6666\n<"),
        "the number of transitions is shown"
    );
}

#[test]
fn an_empty_run_has_a_picture() {
    let mut run = bouncing_ball(1.0, 1, 0);
    run.events.clear();
    run.end = HybridState {
        mode: 0,
        t: 0.0,
        j: 0,
        ..run.end
    };
    assert!(overview(&run).ends_with("</svg>\n"));
    assert_eq!(phase_portraits(&run), None);
}

#[test]
fn a_mode_that_is_left_at_once_is_in_the_strip() {
    let mut run = bouncing_ball(1.0, 1, 2);
    let state = Snapshot {
        q: vec![1.0],
        v: vec![0.0],
        discrete: vec![1.0],
        reactions: vec![0.0],
        outputs: vec![],
    };
    let leave = Event {
        t: 0.0,
        from: 1,
        before: state.clone(),
        after: state,
        ..run.events[0].clone()
    };
    run.events.insert(0, leave);
    run.end.mode = 0;
    assert!(overview(&run).contains(">\nrests\n<"));
}

#[test]
fn a_chart_shows_what_its_scales_can() {
    let chart = Chart {
        title: String::new(),
        x: Dimension::log("error", "1"),
        y: Dimension::log("time", "s"),
        curves: vec![Curve {
            label: "a".into(),
            points: vec![(0.0, 1.0), (1e-9, 2.0), (1e-3, 0.1)],
            style: Style::default(),
        }],
        marks: true,
    };
    let svg = chart.svg((400.0, 300.0));
    assert_eq!(
        svg.matches("<circle").count(),
        2,
        "an error of zero has no place"
    );
    let empty = Chart {
        curves: vec![],
        ..chart
    };
    assert!(
        empty.svg((400.0, 300.0)).contains("10⁰") || empty.svg((400.0, 300.0)).contains(">\n1\n<")
    );
    let quantity = Quantity::new("x_I", "m", "bulging");
    let runs = vec![Curve {
        label: "μ = 0.2".into(),
        points: vec![(0.0, 0.0), (1.0, 2e-6)],
        style: Style::default(),
    }];
    let compared = dalembert::record::plot::comparison(&quantity, runs).svg((400.0, 300.0));
    assert!(compared.contains("μ = 0.2") && compared.contains("(µm)"));
}
