//! `run --watch`.

use super::*;
use serde_json::json;
use std::io::Read;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A program that watches, which ends with the test.
struct Watching(Child, PathBuf);

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Watching {
    fn start(home: &Path, arguments: &[&str]) -> Watching {
        let errors = home.join("errors.txt");
        let child = std::process::Command::new(env!("CARGO_BIN_EXE_dalembert"))
            .current_dir(home)
            .args(arguments)
            .stdout(Stdio::null())
            .stderr(fs::File::create(&errors).unwrap())
            .spawn();
        Watching(child.unwrap(), errors)
    }

    /// Waits until it has said `words` this many times.
    fn until(&self, times: usize, words: &str) {
        let begin = Instant::now();
        loop {
            let mut text = String::new();
            let mut file = fs::File::open(&self.1).unwrap();
            file.read_to_string(&mut text).unwrap();
            if text.matches(words).count() >= times {
                return;
            }
            // Long for a machine that builds beside it; it takes tenths of a second.
            assert!(begin.elapsed() < Duration::from_secs(60), "{text}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

const WATCHES: &str = "Ctrl-C ends";

fn end(home: &Path) -> serde_json::Value {
    super::json(&home.join("out/summary.json"))["end"]["t"].clone()
}

#[test]
fn a_scene_and_its_table_are_run_again_when_they_change() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let scene = |end: f64| {
        let text = json!({
            "model": "rocking_block", "end": end,
            "inputs": {"ground_acceleration": {"table": {"file": "ground.csv"}}},
        });
        fs::write(home.join("scene.json"), text.to_string()).unwrap();
    };
    let table =
        |a: &str| fs::write(home.join("ground.csv"), format!("t,a\n0,0\n0.5,0\n9,{a}\n")).unwrap();
    table("0");
    scene(0.25);
    let watching = Watching::start(home, &["run", "scene.json", "--out", "out", "--watch"]);
    watching.until(1, WATCHES);
    assert_eq!(end(home), 0.25);
    scene(0.5);
    watching.until(2, WATCHES);
    assert_eq!(end(home), 0.5, "the results are of the new scene");
    table("x");
    watching.until(3, WATCHES);
    watching.until(1, "ground.csv");
    watching.until(1, "error: ");
    assert_eq!(
        end(home),
        0.5,
        "what is wrong leaves the results as they are"
    );
    table("0.1");
    watching.until(4, WATCHES);
}

#[test]
fn a_model_is_run_again_when_it_changes() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    ends_with(0, home, &["new", "my_ball", "--template", "impact"]);
    let model = home.join("my_ball/model.py");
    let text = fs::read_to_string(&model).unwrap();
    // Results beside the model are none of its sources.
    let arguments = [
        "run",
        "my_ball/scene.json",
        "--out",
        "my_ball/out",
        "--watch",
    ];
    let watching = Watching::start(home, &arguments);
    watching.until(1, WATCHES);
    fs::write(&model, text.clone() + "\nfrom .more import nothing\n").unwrap();
    watching.until(2, WATCHES);
    fs::write(home.join("my_ball/more.py"), "nothing = 0\n").unwrap();
    watching.until(3, WATCHES);
    assert!(home.join("my_ball/out/summary.json").exists());
}

#[test]
fn a_run_whose_scene_changes_ends_early_and_begins_anew() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let scene = |end: f64| {
        let start = json!({"theta_1": 1.5, "theta_2": 1.5});
        let text = json!({"model": "double_pendulum", "end": end, "initial": start, "record": {}});
        fs::write(home.join("scene.json"), text.to_string()).unwrap();
    };
    // This takes minutes.
    scene(1e7);
    let watching = Watching::start(home, &["run", "scene.json", "--watch"]);
    std::thread::sleep(Duration::from_millis(300));
    scene(1.0);
    watching.until(1, "stopped early");
    watching.until(2, WATCHES);
}
