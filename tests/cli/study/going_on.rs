//! Interruptions, parts, threads: the same bytes in the end.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::json;

use super::super::{dalembert, ends_with, stderr, stdout};
use super::{folder, sweep, write};

/// The files of a result.
const FILES: [&str; 6] = [
    "runs.parquet",
    "runs.csv",
    "runs.svg",
    "study.json",
    "study.html",
    "summary.json",
];

fn same(one: &Path, other: &Path) {
    for file in FILES {
        let read = |folder: &Path| fs::read(folder.join(file)).unwrap();
        assert!(read(one) == read(other), "{file} differs");
    }
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let folder = folder();
    write(folder.path(), "study.json", &sweep());
    for threads in ["1", "2", "5"] {
        let arguments = [
            "study",
            "study.json",
            "--csv",
            "--out",
            threads,
            "--threads",
            threads,
        ];
        ends_with(0, folder.path(), &arguments);
    }
    same(&folder.path().join("1"), &folder.path().join("2"));
    same(&folder.path().join("1"), &folder.path().join("5"));
}

#[test]
fn parts_that_are_merged_are_the_whole() {
    let folder = folder();
    write(folder.path(), "study.json", &sweep());
    let study = |more: &[&str]| {
        let arguments = ["study", "study.json", "--csv", "--out"];
        ends_with(0, folder.path(), &[&arguments, more].concat())
    };
    study(&["whole"]);
    let shown = study(&["a", "--shard", "1/3"]);
    assert!(stdout(&shown).contains("7 of 20 cases are finished"));
    study(&["b", "--shard", "2/3"]);
    let merge = [
        "study",
        "merge",
        "study.json",
        "--csv",
        "--out",
        "merged",
        "a",
        "b",
    ];
    let refused = ends_with(2, folder.path(), &merge);
    let told = stderr(&refused);
    assert!(
        told.contains("6 of 20 cases are in none of these parts, the first is case 2"),
        "{told}"
    );
    assert!(!folder.path().join("merged").exists());
    study(&["c", "--shard", "3/3"]);
    ends_with(0, folder.path(), &[&merge[..], &["c"]].concat());
    same(&folder.path().join("whole"), &folder.path().join("merged"));
    // A part that goes on without a shard becomes the whole.
    study(&["b", "--resume"]);
    same(&folder.path().join("whole"), &folder.path().join("b"));
    let shown = study(&["b", "--resume"]);
    assert!(stdout(&shown).contains("the study is complete"));
}

/// A study of so many cases, 1500 of which take some seconds.
fn long(folder: &Path, cases: usize) {
    let scene = json!({
        "model": "rocking_block",
        "parameters": { "e": 0.999 },
        "initial": { "theta": 0.2, "side": 1 },
        "end": 400.0,
        "accuracy": { "relative": 1e-12 }
    });
    write(folder, "scene.json", &scene);
    let study = json!({
        "scene": "scene.json",
        "vary": { "parameters.alpha": { "from": 0.21, "to": 0.3, "count": cases } },
        "measure": ["peak.theta", "count.base strikes"]
    });
    write(folder, "study.json", &study);
}

fn start(folder: &Path, more: &[&str]) -> std::process::Child {
    Command::new(env!("CARGO_BIN_EXE_dalembert"))
        .current_dir(folder)
        .args(["study", "study.json", "--csv", "--out"])
        .args(more)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits until some files with finished cases are there.
fn wait_for_parts(out: &Path, count: usize) {
    let parts = out.join(".study/parts");
    let begin = Instant::now();
    let there = || fs::read_dir(&parts).map_or(0, |entries| entries.count());
    while there() < count {
        assert!(
            begin.elapsed() < Duration::from_secs(60),
            "no cases are kept"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_study_that_was_killed_goes_on_to_the_same_bytes() {
    let folder = folder();
    long(folder.path(), 8000);
    assert!(start(folder.path(), &["whole"]).wait().unwrap().success());
    let out = folder.path().join("killed");
    for parts in [1, 2] {
        let resume: &[&str] = if parts > 1 {
            &["killed", "--resume"]
        } else {
            &["killed"]
        };
        let mut child = start(folder.path(), resume);
        wait_for_parts(&out, parts);
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(
            !out.join("summary.json").exists(),
            "it was killed too late to tell"
        );
    }
    let resume = [
        "study",
        "study.json",
        "--csv",
        "--out",
        "killed",
        "--resume",
    ];
    ends_with(0, folder.path(), &resume);
    same(&folder.path().join("whole"), &out);
}

#[test]
fn a_study_may_be_killed_at_any_instant() {
    let folder = folder();
    long(folder.path(), 400);
    assert!(start(folder.path(), &["whole"]).wait().unwrap().success());
    let out = folder.path().join("killed");
    let key = out.join(".study/key");
    // From the first file on to the last; later instants come after the end.
    let mut wait = Duration::from_millis(1);
    let finished = loop {
        let more: &[&str] = match key.exists() {
            true => &["killed", "--resume"],
            false => &["killed"],
        };
        let mut child = start(folder.path(), more);
        std::thread::sleep(wait);
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        wait *= 2;
    };
    assert!(finished.success());
    same(&folder.path().join("whole"), &out);
}

/// A program that may write no more than some blocks of 512 bytes into a file: as on a full disk a part of a file is written,
/// and then no more.
#[cfg(unix)]
fn with_room(folder: &Path, blocks: u32, more: &[&str]) -> std::process::Output {
    // POSIX counts in blocks of 512 bytes. A signal that is ignored leaves the error of the write.
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
    Command::new("sh")
        .current_dir(folder)
        .args(["-c", &script, "sh", env!("CARGO_BIN_EXE_dalembert")])
        .args(["study", "study.json", "--csv", "--out"])
        .args(more)
        .output()
        .unwrap()
}

#[cfg(unix)]
#[test]
fn a_disk_that_is_full_loses_nothing_that_was_kept() {
    let folder = folder();
    write(folder.path(), "study.json", &sweep());
    ends_with(
        0,
        folder.path(),
        &["study", "study.json", "--csv", "--out", "whole"],
    );
    // No room for the first finished cases; for some of them; for all of them, but not for the page.
    for blocks in [1, 2, 40] {
        let out = blocks.to_string();
        let output = with_room(folder.path(), blocks, &[&out]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{blocks}: {said}");
        assert!(said.contains("cannot write"), "{blocks}: {said}");
        let path = folder.path().join(&out);
        assert!(!path.join("summary.json").exists(), "{blocks}");
        let again = with_room(folder.path(), blocks, &[&out, "--resume"]);
        assert_eq!(again.status.code(), Some(1), "{blocks}");
        let resume = ["study", "study.json", "--csv", "--out", &out, "--resume"];
        ends_with(0, folder.path(), &resume);
        same(&folder.path().join("whole"), &path);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_finished_and_two_writers_are_refused() {
    let folder = folder();
    long(folder.path(), 1500);
    let child = start(folder.path(), &["out"]);
    let out = folder.path().join("out");
    wait_for_parts(&out, 1);
    let second = ends_with(
        2,
        folder.path(),
        &["study", "study.json", "--out", "out", "--resume"],
    );
    assert!(stderr(&second).contains("another program is writing this study"));
    let pid = child.id().to_string();
    let begin = Instant::now();
    assert!(
        Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    assert!(begin.elapsed() < Duration::from_secs(2));
    assert_eq!(output.status.code(), Some(3));
    assert!(
        stderr(&output).contains("go on with --resume"),
        "{}",
        stderr(&output)
    );
    assert!(!out.join("summary.json").exists());
    ends_with(
        0,
        folder.path(),
        &["study", "study.json", "--out", "out", "--resume"],
    );
    assert!(out.join("summary.json").exists());
}

#[test]
fn what_another_study_or_version_wrote_is_refused() {
    let folder = folder();
    write(folder.path(), "study.json", &sweep());
    let part = ["study", "study.json", "--out", "out", "--shard", "1/2"];
    ends_with(0, folder.path(), &part);
    let resume = |more: &[&str]| {
        let arguments = ["study", "study.json", "--out", "out", "--resume"];
        let output = ends_with(2, folder.path(), &[&arguments, more].concat());
        stderr(&output).to_owned()
    };
    assert!(resume(&["--set", "vary.parameters.e=[0.8]"]).contains("this is another study"));
    // The scene counts, and its title does too: it is what was run.
    let scene = fs::read_to_string(folder.path().join("scene.json")).unwrap();
    fs::write(
        folder.path().join("scene.json"),
        scene.replace("3.0", "3.5"),
    )
    .unwrap();
    assert!(resume(&[]).contains("model, scene or design differs"));
    fs::write(folder.path().join("scene.json"), scene).unwrap();
    // Without --resume nothing is replaced.
    let begun = ends_with(2, folder.path(), &part);
    assert!(stderr(&begun).contains("go on with it by --resume"));
    let parts = folder.path().join("out/.study/parts");
    let file = fs::read_dir(&parts)
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let contents = fs::read(&file).unwrap();
    fs::write(&file, &contents[..contents.len() - 1]).unwrap();
    assert!(resume(&[]).contains("this file is damaged; delete it"));
    fs::write(&file, &contents).unwrap();
    let key = folder.path().join("out/.study/key");
    let text = fs::read_to_string(&key).unwrap();
    fs::write(&key, text.replace(env!("CARGO_PKG_VERSION"), "0.0.9")).unwrap();
    assert!(resume(&[]).contains("a study of another version of dalembert (0.0.9)"));
    fs::write(&key, text).unwrap();
    dalembert(folder.path())
        .args(["study", "study.json", "--out", "out", "--resume"])
        .assert()
        .success();
}
