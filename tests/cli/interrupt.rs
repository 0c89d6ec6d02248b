//! Ctrl-C, and runs that are continued.

use super::*;
use dalembert::model::models;
use dalembert::record::{OutputFolder, Run};
use dalembert::scene::Scene;

/// The rows of a table, numbers where they are numbers.
fn table(path: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let record = |r: csv::Result<csv::StringRecord>| r.unwrap().iter().map(str::to_owned).collect();
    reader.records().map(record).collect()
}

/// Two folders hold the same run, to the last bit.
fn same(one: &Path, other: &Path) {
    for file in ["trajectory.csv", "events.csv"] {
        let [one, other] = [one, other].map(|folder| fs::read(folder.join(file)).unwrap());
        assert!(one == other, "{file}");
    }
    let [one, other] = [one, other].map(|folder| {
        let mut summary = json(&folder.join("summary.json"));
        summary["solver"]["wall_seconds"].take();
        summary["wall_seconds"].take();
        summary
    });
    assert_eq!(one, other);
}

#[test]
fn a_run_in_two_parts_is_that_in_one() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name);
    let scene = scene("tank_full_plate");
    let accuracy = ["run", &scene, "--set", "accuracy.relative=1e-10"];
    let run = |more: &[&str]| ends_with(0, home.path(), &[&accuracy[..], more].concat());
    run(&["--out", "whole"]);
    // Off the grid of the samples, so that the row of the end must not stay.
    run(&["--set", "end=0.7503", "--out", "first"]);
    run(&["--resume", "first", "--out", "both"]);
    same(&path("whole"), &path("both"));
    let first = json(&path("first").join("summary.json"));
    assert_eq!(first["end"]["t"], 0.7503);
}

#[test]
fn a_finished_run_that_is_continued_stays_the_same() {
    let home = tempfile::tempdir().unwrap();
    let scene = scene("bouncing_ball");
    ends_with(0, home.path(), &["run", &scene, "--out", "out"]);
    let files = ["trajectory.csv", "events.csv", "overview.svg"];
    let before = files.map(|file| fs::read(home.path().join("out").join(file)).unwrap());
    ends_with(0, home.path(), &["run", &scene, "--resume", "out"]);
    let after = files.map(|file| fs::read(home.path().join("out").join(file)).unwrap());
    assert!(before == after, "every number is read back to the bit");
}

#[test]
fn a_run_is_not_continued_with_another_scene() {
    let home = tempfile::tempdir().unwrap();
    let tank = scene("tank_full_plate");
    ends_with(
        0,
        home.path(),
        &["run", &tank, "--set", "end=0.1", "--out", "out"],
    );
    let before = fs::read(home.path().join("out/summary.json")).unwrap();
    for (scene, setting, words) in [
        (
            &tank,
            "parameters.mu_s=0.3",
            "`mu_s` is 0.3 now and was 0.2",
        ),
        (
            &tank,
            "rules=paper",
            "`rules` was reactions and is paper now",
        ),
        (&tank, "record.every=0.002", "row 2 of the trajectory"),
        (&tank, "record.inputs=false", "other columns"),
        (
            &scene("bouncing_ball"),
            "end=1",
            "a run of the model `walking_tank`",
        ),
    ] {
        let arguments = ["run", scene, "--resume", "out", "--set", setting];
        let output = ends_with(2, home.path(), &arguments);
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
    assert_eq!(
        fs::read(home.path().join("out/summary.json")).unwrap(),
        before
    );
    let output = ends_with(2, home.path(), &["run", &tank, "--resume", "nowhere"]);
    assert!(stderr(&output).contains("cannot read the run"));
}

#[test]
fn a_folder_that_was_changed_is_not_continued() {
    let home = tempfile::tempdir().unwrap();
    let ball = scene("bouncing_ball");
    let run = ["run", &ball, "--set", "end=0.5", "--out", "out"];
    ends_with(0, home.path(), &run);
    let refused = |file: &str, change: &dyn Fn(&str) -> String, words: &str| {
        let path = home.path().join("out").join(file);
        let before = fs::read_to_string(&path).unwrap();
        let changed = change(&before);
        assert_ne!(before, changed);
        fs::write(&path, changed).unwrap();
        let output = ends_with(2, home.path(), &["run", &ball, "--resume", "out"]);
        let said = stderr(&output);
        assert!(said.contains(file) && said.contains(words), "{said}");
        fs::write(&path, before).unwrap();
    };
    let without = |text: &str, line: usize| -> String {
        let lines = text.split_inclusive('\n').enumerate();
        lines
            .filter(|(i, _)| i + 1 != line)
            .map(|(_, l)| l)
            .collect()
    };
    let rows = |text: &str| text.lines().count();
    // Cut off at the end of a line, as no parser sees it.
    let cut = |text: &str| without(text, rows(text));
    refused("trajectory.csv", &cut, "it has 101 lines, and had 102");
    refused("events.csv", &|text| without(text, 2), "line 2 is not");
    let digit = |text: &str| text.replacen("0.25,", "0.26,", 1);
    refused(
        "trajectory.csv",
        &digit,
        "line 52 is not what the run has written",
    );
    let work = |text: &str| text.replacen("\"initial\": ", "\"initial\": 1", 1);
    refused("summary.json", &work, "is not what the run has written");
    let later = |text: &str| text.replacen("\"format\": 1", "\"format\": 2", 1);
    refused(
        "summary.json",
        &later,
        "has format 2, and this version of dalembert reads format 1",
    );
    // As it was it goes on.
    ends_with(0, home.path(), &["run", &ball, "--resume", "out"]);
}

#[test]
fn a_run_is_not_continued_with_other_inputs_or_another_accuracy() {
    let home = tempfile::tempdir().unwrap();
    let tank = scene("tank_full_plate");
    let first = ["run", &tank, "--set", "end=0.1", "--out", "out"];
    ends_with(0, home.path(), &first);
    for (setting, part, line) in [
        (
            "inputs.ground_acceleration.sine.amplitude=19",
            "`inputs` is not what it was",
            "tank_full_plate.json:5:3",
        ),
        (
            "accuracy.relative=1e-9",
            "`accuracy` is not what it was",
            "tank_full_plate.json:7:3",
        ),
        (
            "initial.theta=0.01",
            "`initial` is not what it was",
            "--set:1:1",
        ),
        ("method=radau", "`method` is not what it was", "--set:1:8"),
    ] {
        let arguments = ["run", &tank, "--resume", "out", "--set", setting];
        let output = ends_with(2, home.path(), &arguments);
        let said = stderr(&output);
        // With the line to blame.
        assert!(said.contains(part) && said.contains(line), "{said}");
    }
}

#[test]
fn a_run_is_not_continued_with_a_model_that_was_changed_since() {
    let home = tempfile::tempdir().unwrap();
    let ball = scene("bouncing_ball");
    let run = ["run", &ball, "--set", "end=0.5", "--out", "out"];
    ends_with(0, home.path(), &run);
    // The same folder as another version of the model would have written it.
    let out = home.path().join("out");
    let scene = Scene::load(Path::new(&ball), &[], models()).unwrap();
    let problem = &scene.problem;
    let layout = problem.layout();
    let mut earlier = Run::read(&out, &problem.model, problem.variant(), layout).unwrap();
    let mut digests = earlier.subject.digests.iter_mut();
    let (_, digest) = digests.find(|(part, _)| part == "model").unwrap();
    assert_eq!(digest.len(), 16);
    *digest = "0123456789abcdef".into();
    earlier.write(&OutputFolder::new(&out).unwrap()).unwrap();
    let output = ends_with(2, home.path(), &["run", &ball, "--resume", "out"]);
    let said = stderr(&output);
    assert!(
        said.contains("the model, or what makes code of it, was changed since"),
        "{said}"
    );
}

/// A signal needs a process that listens to it, which Linux tells.
#[cfg(target_os = "linux")]
mod signals {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::process::{Child, Command, Stdio};
    use std::thread;
    use std::time::{Duration, Instant};

    /// SIGINT in the masks of /proc.
    const SIGINT: u64 = 1 << (2 - 1);

    /// Waits until the process catches SIGINT.
    fn wait_until_it_listens(child: &Child) {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(60) {
            let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
            let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
            let caught = u64::from_str_radix(caught.unwrap_or("0").trim(), 16).unwrap();
            if caught & SIGINT != 0 {
                return;
            }
            thread::sleep(Duration::from_millis(10));
        }
        panic!("the process does not listen to SIGINT");
    }

    /// Whether some rows have come to a file in one of its folders, the hidden ones among them.
    fn has_rows(folder: &Path) -> bool {
        let tables = fs::read_dir(folder).unwrap();
        let mut tables = tables.map(|entry| entry.unwrap().path().join("trajectory.csv"));
        tables.any(|table| fs::metadata(table).is_ok_and(|data| data.len() > 0))
    }

    /// Sends SIGINT; gives when.
    fn interrupt(child: &Child) -> Instant {
        let id = child.id().to_string();
        let sent = Command::new("kill").args(["-INT", &id]).status();
        assert!(sent.unwrap().success());
        Instant::now()
    }

    fn interrupted(folder: &Path, arguments: &[&str]) -> Output {
        interrupted_when(folder, arguments, || true)
    }

    fn interrupted_when(folder: &Path, arguments: &[&str], ready: impl Fn() -> bool) -> Output {
        let child = Command::new(env!("CARGO_BIN_EXE_dalembert"))
            .args(arguments)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_until_it_listens(&child);
        while !ready() {
            thread::sleep(Duration::from_millis(1));
        }
        interrupt(&child);
        child.wait_with_output().unwrap()
    }

    /// What there is takes some tenths of a second to be drawn as PNG.
    #[test]
    fn ctrl_c_is_answered_at_once_and_the_second_one_ends_the_drawing() {
        let home = tempfile::tempdir().unwrap();
        let scene = scene("tank_full_plate");
        let long = ["run", &scene, "--set", "end=400", "--out", "out"];
        let mut child = Command::new(env!("CARGO_BIN_EXE_dalembert"))
            .args(long)
            .args(["--plot-format", "png"])
            .current_dir(home.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_until_it_listens(&child);
        let (mut said, mut line) = (BufReader::new(child.stderr.take().unwrap()), String::new());
        let sent = interrupt(&child);
        said.read_line(&mut line).unwrap();
        let answered = sent.elapsed();
        assert!(line.starts_with("interrupted: "), "{line}");
        let sent = interrupt(&child);
        assert_eq!(child.wait().unwrap().code(), Some(130));
        for time in [answered, sent.elapsed()] {
            assert!(time < Duration::from_millis(100), "{time:?}");
        }
        assert!(!home.path().join("out").exists(), "nothing is written");
    }

    #[test]
    fn an_interrupted_run_is_written_and_can_be_continued() {
        let home = tempfile::tempdir().unwrap();
        let scene = scene("belt_oscillator");
        // Far more cycles than there is time for.
        let endless = [
            "run",
            &scene,
            "--set",
            "end=1e9",
            "--set",
            "record.every=1e6",
            "--out",
            "out",
        ];
        let output = interrupted(home.path(), &endless);
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stderr(&output).contains("interrupted"));
        assert!(stderr(&output).contains("continue with --resume out"));
        let summary = json(&home.path().join("out/summary.json"));
        assert_eq!(summary["failure"]["reason"], "interrupted");
        let t = summary["end"]["t"].as_f64().unwrap();
        let until = format!("end={}", t + 1.0);
        let more = [
            "run",
            &scene,
            "--set",
            &until,
            "--set",
            "record.every=1e6",
            "--resume",
            "out",
        ];
        ends_with(0, home.path(), &more);
        let summary = json(&home.path().join("out/summary.json"));
        assert_eq!(summary["end"]["t"].as_f64(), Some(t + 1.0));
        assert!(summary["failure"].is_null());
    }

    #[test]
    fn a_long_run_goes_on_from_its_last_checkpoint_to_the_bit() {
        let home = tempfile::tempdir().unwrap();
        let scene = scene("tank_full_plate");
        let tank = ["run", &scene, "--set", "record.every=0.1"];
        let first = [&tank[..], &["--set", "end=6000", "--out", "out"]].concat();
        let begun = Instant::now();
        // A checkpoint is taken after a second.
        let output = interrupted_when(home.path(), &first, || begun.elapsed().as_secs() >= 2);
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        let [out, whole, both] = ["out", "whole", "both"].map(|name| home.path().join(name));
        let ended = json(&out.join("summary.json"))["end"]["t"]
            .as_f64()
            .unwrap();
        let kept = json(&out.join(".dalembert-checkpoint"));
        let [rows, events] = ["rows", "events"].map(|key| kept[key].as_u64().unwrap());
        assert!(rows > 100 && events > 100, "{rows} {events}");
        // To the same end it goes on from there. A run with an earlier end is done again: its last steps are shaped by that.
        for end in [ended + 0.5, 6000.0] {
            let until = format!("end={end}");
            let until = [&tank[..], &["--set", &until]].concat();
            ends_with(0, home.path(), &[&until[..], &["--out", "whole"]].concat());
            let resumed = ["--resume", "out", "--out", "both"];
            ends_with(0, home.path(), &[&until[..], &resumed].concat());
            same(&whole, &both);
        }
        // A checkpoint that was changed is refused, and one of another list of limits.
        let path = out.join(".dalembert-checkpoint");
        let text = fs::read_to_string(&path).unwrap();
        let resumed = [&tank[..], &["--set", "end=6001", "--resume", "out"]].concat();
        fs::write(&path, text.replacen("\"rows\":", "\"rows\":1", 1)).unwrap();
        let output = ends_with(2, home.path(), &resumed);
        let said = stderr(&output);
        assert!(said.contains("is not what the run has written"), "{said}");
        fs::write(&path, text).unwrap();
        let limits = ["--set", "limits.far.theta.above=10"];
        let output = ends_with(2, home.path(), &[&resumed[..], &limits].concat());
        let said = stderr(&output);
        assert!(said.contains("the list of limits is"), "{said}");
        ends_with(0, home.path(), &resumed);
    }

    #[test]
    fn a_run_is_interrupted_between_the_samples_of_a_step() {
        let home = tempfile::tempdir().unwrap();
        // A fall of 0.4 s is one step.
        let fall = ["run", &scene("bouncing_ball"), "--set", "record.every=2e-7"];
        let out = ["--set", "end=0.45", "--out", "out"];
        let (home_of, arguments) = (home.path(), [&fall[..], &out].concat());
        let output = interrupted_when(home_of, &arguments, || has_rows(home_of));
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        let summary = json(&home.path().join("out/summary.json"));
        let t = summary["end"]["t"].as_f64().unwrap();
        assert!(0.0 < t && t < 0.45, "{t}");
        let until = format!("end={}", t + 1e-3);
        let more = ["--set", &until, "--resume", "out"];
        ends_with(0, home.path(), &[&fall[..], &more].concat());
        let rows = table(&home.path().join("out/trajectory.csv"));
        for (i, row) in rows.iter().enumerate().step_by(1000) {
            let [t, h] = [0, 1].map(|column| row[column].parse::<f64>().unwrap());
            assert_eq!(t, i as f64 * 2e-7);
            assert!((h - (1.0 - 9.81 / 2.0 * t * t)).abs() < 1e-12, "{t} {h}");
        }
    }

    /// Largest resident memory of a process so far, kB.
    fn memory(child: &Child) -> Option<u64> {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
        let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
        line.trim().strip_suffix(" kB")?.parse().ok()
    }

    #[test]
    fn memory_does_not_grow_with_the_rows() {
        let home = tempfile::tempdir().unwrap();
        let most = |every: &str| {
            let mut child = Command::new(env!("CARGO_BIN_EXE_dalembert"))
                .args(["run", &scene("bouncing_ball"), "--set", every])
                .current_dir(home.path())
                .stdout(Stdio::null())
                .spawn()
                .unwrap();
            let mut most = 0;
            while child.try_wait().unwrap().is_none() {
                most = memory(&child).unwrap_or(0).max(most);
                thread::sleep(Duration::from_millis(1));
            }
            most
        };
        let (few, many) = (most("record.every=1e-4"), most("record.every=5e-6"));
        // A million rows were 80 MB.
        assert!(many < few + 8_000, "{few} and {many} kB");
    }

    #[test]
    fn an_interrupted_study_of_precision_is_written_as_far_as_it_came() {
        let home = tempfile::tempdir().unwrap();
        let precision = ["precision", &scene("belt_oscillator"), "--set", "end=1e9"];
        let output = interrupted(home.path(), &[&precision[..], &["--out", "out"]].concat());
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stdout(&output).contains("interrupted: 0 of 33 runs are there"));
        let rows = table(&home.path().join("out/precision.csv"));
        assert_eq!(rows.len(), 33);
        assert!(rows.iter().all(|row| row[3] == "interrupted"));
    }

    #[test]
    fn a_run_without_its_estimate_is_written() {
        let home = tempfile::tempdir().unwrap();
        let run = [
            "run",
            &scene("belt_oscillator"),
            "--set",
            "end=1e9",
            "--error-estimate",
        ];
        let quiet = ["--set", "record.every=1e6", "--out", "out"];
        let output = interrupted(home.path(), &[&run[..], &quiet].concat());
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stderr(&output).contains("no estimate of the error"));
        let summary = json(&home.path().join("out/summary.json"));
        assert_eq!(summary["failure"]["reason"], "interrupted");
        assert!(summary.get("error_estimate").is_none());
    }

    #[test]
    fn an_interrupted_comparison_says_so() {
        let home = tempfile::tempdir().unwrap();
        let compare = ["compare", &scene("tank_full_plate"), "--set", "end=1e6"];
        let compare = [
            &compare[..],
            &["--set", "record.every=1e3", "--vary", "landing"],
        ]
        .concat();
        let output = interrupted(home.path(), &compare);
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stdout(&output).contains("stopped early"));
    }
}
