//! Models from folders: what runs, how often it is derived and compiled, and what is refused.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::{new::TEMPLATES, project, stderr, stdout};

/// A folder with a cache of its own, and Python and a compiler that note their runs.
struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let place = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        let packages = env!("DALEMBERT_PYTHON_PATH");
        let options = match packages {
            "" => String::new(),
            _ => format!("PYTHONPATH='{packages}' "),
        };
        let python = env!("DALEMBERT_PYTHON_EXE");
        place.program("python", &format!("{options}exec '{python}' \"$@\""));
        place.program("compiler", "exec cc \"$@\"");
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A script that notes that it was run.
    fn program(&self, name: &str, body: &str) {
        let (path, log) = (self.path(name), self.path("log"));
        fs::write(
            &path,
            format!("#!/bin/sh\necho {name} >>'{}'\n{body}\n", log.display()),
        )
        .unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// The programs that were run since the last call.
    fn log(&self) -> String {
        let text = fs::read_to_string(self.path("log")).unwrap_or_default();
        let _ = fs::remove_file(self.path("log"));
        text
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dalembert"));
        command
            .current_dir(self.folder.path())
            .env("DALEMBERT_CACHE", self.path("cache"))
            .env("DALEMBERT_PYTHON", self.path("python"))
            .env("CC", self.path("compiler"))
            .args(arguments);
        command
    }

    #[track_caller]
    fn run(&self, status: i32, arguments: &[&str]) -> String {
        let output = self.command(arguments).output().unwrap();
        let text = stderr(&output).to_owned();
        assert_eq!(output.status.code(), Some(status), "{text}");
        text
    }

    /// Columns of a trajectory, by name.
    fn column(&self, out: &str, name: &str) -> Vec<f64> {
        let mut reader = csv::Reader::from_path(self.path(out).join("trajectory.csv")).unwrap();
        let headers = reader.headers().unwrap().clone();
        let index = headers.iter().position(|header| header == name);
        let index = index.unwrap_or_else(|| panic!("no {name} in {headers:?}"));
        let value = |row: csv::Result<csv::StringRecord>| row.unwrap()[index].parse().unwrap();
        reader.records().map(value).collect()
    }

    /// Copies a model of the project.
    fn copy(&self, model: &str) {
        fs::create_dir_all(self.path(model)).unwrap();
        for entry in fs::read_dir(project().join("models").join(model)).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), self.path(model).join(entry.file_name())).unwrap();
        }
    }

    /// A scene of the project, with the folder in place of the name.
    fn scene(&self, name: &str, model: &str) {
        let text = fs::read_to_string(project().join("scenes").join(name)).unwrap();
        let of_folder = text.replace(&format!("\"{model}\""), &format!("\"./{model}\""));
        assert_ne!(text, of_folder);
        fs::write(self.path(name), of_folder).unwrap();
    }
}

fn close(found: f64, expected: f64) {
    let error = (found - expected).abs() / expected.abs().max(1.0);
    assert!(error < 1e-6, "{found} is not {expected}");
}

#[test]
fn a_folder_may_have_any_name() {
    let place = Place::new();
    for (folder, model) in [
        ("My-Block.v2", "my_block_v2"),
        ("1st try", "model_1st_try"),
        ("tmp__x_", "tmp_x"),
        ("class", "class"),
        ("ж", "model"),
    ] {
        place.run(0, &["new", folder, "--template", "impact"]);
        place.run(0, &["run", &format!("{folder}/scene.json")]);
        let output = place.command(&["check", folder]).output().unwrap();
        let said = stdout(&output);
        assert!(said.starts_with(&format!("{model}: no errors\n")), "{said}");
    }
}

#[test]
fn a_folder_without_a_slash_is_one_that_no_model_is_called() {
    let place = Place::new();
    place.run(0, &["new", "my_ball", "--template", "impact"]);
    let describe = |name: &str| {
        let output = place.command(&["describe", name]).output().unwrap();
        (output.status.code(), stdout(&output).to_owned())
    };
    let (status, said) = describe("my_ball");
    assert!(status == Some(0) && said.starts_with("my_ball: "), "{said}");
    assert_eq!(describe("./my_ball"), (status, said));
    let (status, _) = describe("my_bell");
    assert_eq!(status, Some(2));
    // In a scene names and folders are told apart by the slash.
    fs::write(
        place.path("scene.json"),
        r#"{ "model": "my_ball", "end": 1 }"#,
    )
    .unwrap();
    let refused = place.run(2, &["run", "scene.json"]);
    assert!(refused.contains(r#"write "./my_ball""#), "{refused}");
}

#[test]
fn every_template_runs_as_its_page_says() {
    let place = Place::new();
    for template in TEMPLATES {
        let name = template.replace('-', "_");
        place.run(0, &["new", &name, "--template", template]);
        let scene = format!("{name}/scene.json");
        place.run(0, &["run", &scene, "--out", &format!("out_{name}")]);
    }
    // The box lies on both corners, which share one friction.
    for (name, end) in [
        ("left.gap", 0.0),
        ("right.gap", 0.0),
        ("x.rate", 0.0),
        ("right_shares", 1.0),
    ] {
        close(*place.column("out_contacts", name).last().unwrap(), end);
    }
    let g = 9.81_f64;

    // Of the pendulum the period, by the mean of Gauss: after one it is where it was.
    let (mut a, mut b) = (1.0_f64, 1.0_f64.cos());
    for _ in 0..10 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    let period = 2.0 * std::f64::consts::PI * (0.8 / g).sqrt() / a;
    let end = format!("end={period}");
    place.run(
        0,
        &[
            "run",
            "energies/scene.json",
            "--set",
            &end,
            "--out",
            "period",
        ],
    );
    close(*place.column("period", "theta").last().unwrap(), 2.0);
    let half = format!("end={}", period / 2.0);
    place.run(
        0,
        &[
            "run",
            "energies/scene.json",
            "--set",
            &half,
            "--out",
            "half",
        ],
    );
    close(*place.column("half", "theta").last().unwrap(), -2.0);

    // The centre of mass of cart and rod stays.
    let (x, theta) = (
        place.column("out_bodies", "x"),
        place.column("out_bodies", "theta"),
    );
    assert!(x.len() > 900 && x.iter().any(|x| *x > 0.2));
    for (x, theta) in x.iter().zip(theta) {
        close(*x, (1.0_f64.sin() - theta.sin()) / 6.0);
    }

    // The block stops, and slips again where the force exceeds friction.
    let (beta, mu_s, mu_k) = (0.3_f64, 0.4, 0.3);
    let stops = 2.0 / (g * (beta.sin() + mu_k * beta.cos()));
    let slips = 1.0 + g * (beta.sin() + mu_s * beta.cos()) / 10.0;
    let (t, x) = (
        place.column("out_stick_slip", "t"),
        place.column("out_stick_slip", "x"),
    );
    for (t, x) in t.iter().zip(x) {
        if (stops..slips).contains(t) {
            close(x, stops);
        } else if *t > slips {
            assert!(x > stops, "{t}");
        }
    }

    // Infinitely many bounces end.
    let ends = (2.0 / g).sqrt() * 1.7 / 0.3;
    let (t, h) = (
        place.column("out_impact", "t"),
        place.column("out_impact", "h"),
    );
    let last = t
        .iter()
        .zip(h)
        .filter(|(_, h)| *h > 0.0)
        .map(|(t, _)| *t)
        .next_back()
        .unwrap();
    assert!(last < ends && last > ends - 0.05, "{last}: {ends}");
}

#[test]
fn a_folder_gives_the_same_bits_as_the_model_of_the_program() {
    let place = Place::new();
    place.copy("rocking_block");
    place.scene("rocking_block.json", "rocking_block");
    place.run(0, &["run", "rocking_block.json", "--out", "loaded"]);
    let scene = project().join("scenes/rocking_block.json");
    place.run(0, &["run", scene.to_str().unwrap(), "--out", "linked"]);
    for file in ["trajectory.csv", "events.csv"] {
        let read = |out: &str| fs::read(place.path(out).join(file)).unwrap();
        assert!(read("loaded") == read("linked"), "{file}");
    }
}

#[test]
fn what_is_unchanged_starts_no_python_and_no_compiler() {
    let place = Place::new();
    place.run(0, &["new", "ball", "--template", "impact"]);
    place.run(0, &["run", "ball/scene.json"]);
    let log = place.log();
    assert!(log.contains("python") && log.contains("compiler"));
    place.run(0, &["run", "ball/scene.json"]);
    assert_eq!(place.log(), "");
    // Neither a scene nor prose is part of the model.
    fs::write(place.path("ball/README.md"), "prose").unwrap();
    fs::write(place.path("ball/other.json"), "{}").unwrap();
    place.run(
        0,
        &[
            "run",
            "ball/scene.json",
            "--set",
            "end=1",
            "--out",
            "ball/out",
        ],
    );
    assert_eq!(place.log(), "");
    // What the model reads is.
    let model = fs::read_to_string(place.path("ball/model.py")).unwrap();
    let reads = format!("{model}\nopen(__file__.replace('model.py', 'other.json')).read()\n");
    fs::write(place.path("ball/model.py"), reads).unwrap();
    place.run(0, &["run", "ball/scene.json"]);
    assert!(place.log().contains("python"));
    fs::write(place.path("ball/other.json"), "{ }").unwrap();
    place.run(0, &["run", "ball/scene.json"]);
    assert!(place.log().contains("python"));
    place.run(0, &["run", "ball/scene.json"]);
    assert_eq!(place.log(), "");
}

#[test]
fn processes_at_once_share_the_work_and_a_killed_one_leaves_nothing_in_the_way() {
    let place = Place::new();
    place.run(0, &["new", "ball", "--template", "impact"]);
    // Killed while it derives.
    let mut killed = place.command(&["run", "ball/scene.json"]);
    let mut killed = killed
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    // Asked what it is, what it has, and for the derivation.
    let runs = || fs::read_to_string(place.path("log")).unwrap_or_default();
    while runs().matches("python").count() < 3 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    place.log();
    let start = |out: &str| {
        let mut command = place.command(&["run", "ball/scene.json", "--out", out]);
        command
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    for process in [start("one"), start("other"), start("third")] {
        let output = process.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
    }
    // Asked what it is, what it has, and for the derivation.
    assert_eq!(place.log().matches("python").count(), 3);
}

#[test]
fn a_compiler_that_fails_is_quoted_and_the_c_kept() {
    let place = Place::new();
    place.run(0, &["new", "ball", "--template", "impact"]);
    place.program(
        "compiler",
        "case \"$*\" in *ball.c*) echo 'out of patience' >&2; exit 1;; esac; exec cc \"$@\"",
    );
    let text = place.run(2, &["run", "ball/scene.json"]);
    assert!(
        text.contains("out of patience") && text.contains("the C is in "),
        "{text}"
    );
    let kept = text.split("the C is in ").nth(1).unwrap();
    let kept = Path::new(kept.split_whitespace().next().unwrap());
    assert!(kept.join("ball.c").is_file(), "{text}");
    // Repaired, it is compiled, and not derived again.
    place.log();
    place.program("compiler", "exec cc \"$@\"");
    place.run(0, &["run", "ball/scene.json"]);
    assert!(!place.log().contains("python"));
    let mut without = place.command(&["run", "ball/scene.json"]);
    let output = without.env("CC", "/no/such/cc").output().unwrap();
    assert!(
        stderr(&output).contains("install a C compiler"),
        "{}",
        stderr(&output)
    );
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_damaged_library_is_made_again() {
    let place = Place::new();
    place.run(0, &["new", "ball", "--template", "impact"]);
    place.run(0, &["run", "ball/scene.json"]);
    let shared = fs::read_dir(place.path("cache/shared")).unwrap();
    let entry = shared
        .map(|e| e.unwrap().path())
        .find(|path| path.is_dir())
        .unwrap();
    let library = entry.join(format!("libball{}", std::env::consts::DLL_SUFFIX));
    fs::write(&library, "no library").unwrap();
    place.run(0, &["run", "ball/scene.json"]);
    assert!(fs::metadata(&library).unwrap().len() > 10_000);
}

#[test]
fn folders_are_refused_with_reasons() {
    let place = Place::new();
    fs::write(place.path("file"), "").unwrap();
    fs::create_dir_all(place.path("hollow/model.py")).unwrap();
    for (name, says) in [
        ("./nowhere", "no model folder: No such file"),
        ("./file", "a file, not a model folder"),
        (
            "./",
            "the model folder has no readable model.py: No such file",
        ),
        (
            "./hollow",
            "the model folder has no readable model.py: Is a directory",
        ),
    ] {
        fs::write(
            place.path("scene.json"),
            format!("{{\"model\": \"{name}\", \"end\": 1}}"),
        )
        .unwrap();
        let text = place.run(2, &["run", "scene.json"]);
        assert!(
            text.contains(says) && text.contains("scene.json:1:11"),
            "{text}"
        );
    }
    fs::create_dir_all(place.path("locked")).unwrap();
    fs::write(place.path("locked/model.py"), "").unwrap();
    let shut = fs::Permissions::from_mode(0o000);
    fs::set_permissions(place.path("locked/model.py"), shut).unwrap();
    // Root may read what nobody may.
    if fs::read(place.path("locked/model.py")).is_err() {
        let text = place.run(2, &["check", "locked"]);
        let denied = text.contains("Permission denied") && text.contains("allow yourself to read");
        assert!(denied, "{text}");
    }
    place.run(0, &["new", "ball", "--template", "impact"]);
    let text = place.run(2, &["run", "ball/scene.json", "--no-build"]);
    assert!(
        text.contains("--no-build refuses models from folders"),
        "{text}"
    );
    assert!(!place.path("cache/derived").exists());
    let model = fs::read_to_string(place.path("ball/model.py")).unwrap();
    fs::write(
        place.path("ball/model.py"),
        model.replace("falls(h)", "falls(m)"),
    )
    .unwrap();
    let text = place.run(2, &["run", "ball/scene.json"]);
    assert!(
        text.contains("guard of `impact`") && text.contains("ball/model.py:"),
        "{text}"
    );
}

/// More free coordinates than the engine is compiled for, by both methods: links that keep their energy, and masses that stick
/// and slip.
#[test]
fn models_of_many_free_coordinates_run() {
    let place = Place::new();
    for (model, choice, number, beginning) in [
        (
            "link_chain",
            "links",
            8,
            r#""initial": {"theta_1": 1.0, "theta_8": -1.0}"#,
        ),
        (
            "spring_chain",
            "masses",
            12,
            r#""parameters": {"k_3": 1e4}"#,
        ),
    ] {
        let text = fs::read_to_string(project().join("tests/models").join(model).join("model.py"));
        let text = text
            .unwrap()
            .replace("\nN = 7\n", &format!("\nN = {number}\n"));
        assert!(text.contains(&format!("\nN = {number}\n")));
        fs::create_dir(place.path(model)).unwrap();
        fs::write(place.path(model).join("model.py"), text).unwrap();
        let scene = format!(
            r#"{{"model": "./{model}", "{choice}": "{number}", {beginning}, "end": 2.0, "accuracy": {{"relative": 1e-12}}}}"#
        );
        let file = format!("{model}.json");
        fs::write(place.path(&file), scene).unwrap();
        let [taylor, radau] = ["taylor", "radau"].map(|method| {
            let out = format!("{model}_{method}");
            let set = format!("method={method}");
            place.run(0, &["run", &file, "--set", &set, "--out", &out]);
            let summary = fs::read_to_string(place.path(&out).join("summary.json")).unwrap();
            let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
            (out, summary)
        });
        for (_, summary) in [&taylor, &radau] {
            let imbalance = summary["energy"]["imbalance"].as_f64().unwrap();
            assert!(imbalance.abs() < 1e-9, "{model}: {imbalance:e}");
        }
        let name = if model == "link_chain" {
            "theta_8"
        } else {
            "x_12"
        };
        let [taylor, radau] = [taylor.0, radau.0].map(|out| place.column(&out, name));
        close(*taylor.last().unwrap(), *radau.last().unwrap());
        assert!(taylor.len() > 2 && taylor.last() != taylor.first());
    }
}

/// Sixteen contacts have 43 million sets of states, which nothing lists.
#[test]
fn a_body_lands_on_sixteen_feet() {
    let place = Place::new();
    fs::create_dir(place.path("slab")).unwrap();
    let model = r#""""A slab that falls on sixteen feet."""

from codegen.model import *

model = Model("Slab on sixteen feet", source="test")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
w = model.parameter("w", "m", 0.1, "from foot to foot", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
x = model.coordinate("x", "m", "centre, to the right")
y = model.coordinate("y", "m", "centre, height")
theta = model.coordinate("theta", "rad", "tilt")
model.gravity(g)
model.rigid_body(m, inertia=m * w**2, position=(x, y), angle=theta)
for k in range(16):
    s = (k - 7.5) * w
    model.contact(f"foot_{k}", gap=y + s * sin(theta), slip=x + s * cos(theta), kinetic=0.3)
"#;
    fs::write(place.path("slab/model.py"), model).unwrap();
    let scene = r#"{ "model": "./slab", "initial": { "y": 0.5, "theta": 0.1 }, "end": 0.5, "record": { "every": 0.05 } }"#;
    fs::write(place.path("scene.json"), scene).unwrap();
    place.run(
        0,
        &["run", "scene.json", "--out", "out", "--html", "page.html"],
    );
    // However the steps were made.
    for (method, tolerance) in [("radau", "1e-10"), ("radau", "1e-14"), ("taylor", "1e-14")] {
        let [method, relative] = [
            format!("method={method}"),
            format!("accuracy.relative={tolerance}"),
        ];
        place.run(
            0,
            &[
                "run",
                "scene.json",
                "--set",
                &method,
                "--set",
                &relative,
                "--out",
                "other",
            ],
        );
        for name in ["y", "theta", "x.rate", "y.rate", "theta.rate"] {
            // To the rounding of a height of 0.5 m.
            let end = *place.column("other", name).last().unwrap();
            assert!(end.abs() <= 1e-16, "{name}: {end:e}");
        }
    }
    // It lies, and says so by names that are read back.
    for name in ["y", "theta", "x.rate", "y.rate", "theta.rate"] {
        assert_eq!(*place.column("out", name).last().unwrap(), 0.0, "{name}");
    }
    place.run(
        0,
        &["run", "scene.json", "--resume", "out", "--set", "end=0.6"],
    );
    let rows = place.column("out", "y");
    assert_eq!((rows.len(), rows[12]), (13, 0.0));
}
