//! The build script, run as cargo runs it, on small projects: what it installs, generates and
//! compiles, how often, and what it says when it cannot.

#![cfg(unix)]

mod fixture;

use std::fs;
use std::process::Command;

use fixture::{Fixture, PYTHON, VERSION, fails, finish, only_folder, start, succeeds};

const ALL: [&str; 3] = ["generate alpha", "generate beta", "install"];

/// Asserts that the text has each of the parts.
#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}

#[test]
fn the_first_build_does_everything_and_the_second_nothing() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    let first = succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ALL);
    has(
        &fixture.models(),
        &["pub mod alpha {", "&alpha::ALPHA,\n    &beta::BETA,"],
    );
    let libraries = fixture.path("target/debug/build/project/out/libraries");
    let library = only_folder(&libraries, "alpha-").join("libdalembert_alpha.a");
    let compiled = fs::metadata(&library).unwrap().modified().unwrap();

    let second = succeeds(&mut fixture.installing());
    assert!(fixture.log().is_empty());
    assert_eq!(
        fs::metadata(&library).unwrap().modified().unwrap(),
        compiled
    );
    // Libraries are linked, and the same things watched, whether or not they were just made.
    let essential = |lines: &[String]| -> Vec<String> {
        let kept = |line: &&String| line.starts_with("cargo::");
        lines.iter().filter(kept).cloned().collect()
    };
    assert_eq!(essential(&first.directives), essential(&second.directives));
}

#[test]
fn debug_and_release_share_what_was_generated() {
    let fixture = Fixture::new();
    succeeds(&mut fixture.script());
    fixture.log();
    let mut release = fixture.script();
    fixture.out_dir(&mut release, "target/release");
    succeeds(&mut release);
    assert!(fixture.log().is_empty());
}

#[test]
fn a_touched_model_is_regenerated_alone() {
    let fixture = Fixture::new();
    succeeds(&mut fixture.script());
    fixture.log();
    fixture.model("beta", "3.0");
    succeeds(&mut fixture.script());
    assert_eq!(fixture.log(), ["generate beta"]);
    // A second file of a model counts, its prose does not.
    fixture.write("project/models/alpha/README.md", "prose");
    succeeds(&mut fixture.script());
    assert!(fixture.log().is_empty());
    fixture.write("project/models/alpha/paper.py", "");
    succeeds(&mut fixture.script());
    assert_eq!(fixture.log(), ["generate alpha"]);
}

#[test]
fn a_changed_generator_regenerates_all_and_recompiles_nothing_that_came_out_the_same() {
    let fixture = Fixture::new();
    succeeds(&mut fixture.script());
    fixture.log();
    let libraries = fixture.path("target/debug/build/project/out/libraries");
    let before = only_folder(&libraries, "alpha-");
    let compiled = fs::metadata(&before).unwrap().modified().unwrap();
    fixture.write("project/codegen/more.py", "");
    succeeds(&mut fixture.script());
    assert_eq!(fixture.log(), ["generate alpha", "generate beta"]);
    assert_eq!(only_folder(&libraries, "alpha-"), before);
    assert_eq!(fs::metadata(&before).unwrap().modified().unwrap(), compiled);
    fixture.write("project/codegen/tests/test_more.py", "");
    succeeds(&mut fixture.script());
    assert!(fixture.log().is_empty());
}

#[test]
fn a_new_folder_is_a_new_model() {
    let fixture = Fixture::new();
    let watched = succeeds(&mut fixture.script()).directives;
    assert!(watched.contains(&"cargo::rerun-if-changed=models".to_owned()));
    fixture.log();
    fixture.model("gamma", "3.0");
    succeeds(&mut fixture.script());
    assert_eq!(fixture.log(), ["generate gamma"]);
    has(&fixture.models(), &["&gamma::GAMMA"]);
}

#[test]
fn test_models_are_built_for_the_tests_only() {
    let fixture = Fixture::new();
    fixture.write("project/tests/models/gamma/model.py", "3.0");
    succeeds(&mut fixture.script());
    assert_eq!(fixture.log(), ["generate alpha", "generate beta"]);
    succeeds(fixture.script().env("CARGO_FEATURE_TEST_MODELS", "1"));
    assert_eq!(fixture.log(), ["generate gamma for tests"]);
}

#[test]
fn two_builds_at_once_share_the_work() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    let mut one = fixture.installing();
    let mut other = fixture.installing();
    fixture.out_dir(&mut other, "other-target");
    let children = [start(&mut one), start(&mut other)];
    for outcome in children.map(finish) {
        assert_eq!(outcome.errors, "");
    }
    assert_eq!(fixture.log(), ALL);
}

#[test]
fn a_damaged_cache_heals() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    let directives = succeeds(&mut fixture.installing()).directives;
    fixture.log();
    let cache = fixture.path("home/.cache/dalembert");
    let packages = only_folder(&cache.join("python"), "cpython-");
    let inventory = packages.join("inventory");
    assert!(directives.contains(&format!("cargo::rerun-if-changed={}", inventory.display())));

    fs::remove_file(packages.join("casadi/__init__.py")).unwrap();
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ["install"]);

    fs::write(packages.join("casadi/__init__.py"), "cut off").unwrap();
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ["install"]);

    let generated = only_folder(&cache.join("generated"), "alpha-");
    fs::remove_file(generated.join("alpha/model.rs")).unwrap();
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ["generate alpha"]);

    // What a killed installation leaves.
    let partial = format!("{}.partial", packages.display());
    fs::rename(&packages, &partial).unwrap();
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ["install"]);
    assert!(!fs::exists(partial).unwrap());

    fs::remove_dir_all(&cache).unwrap();
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ALL);
}

#[test]
fn a_home_that_cannot_be_written_is_done_without() {
    let fixture = Fixture::new();
    // Permissions would not stop a test run by root; a file in the way stops everybody.
    fixture.write("blocked/.cache", "a file, not a folder");
    let missing = fixture.path("missing");
    let homes = [None, Some(missing.clone()), Some(fixture.path("blocked"))];
    for home in homes {
        let mut script = fixture.script();
        script.env_remove("HOME");
        script.envs(home.map(|home| ("HOME", home)));
        succeeds(&mut script);
        assert_eq!(fixture.log(), ["generate alpha", "generate beta"]);
        let cache = fixture.path("target/dalembert-cache");
        only_folder(&cache.join("generated"), "alpha-");
        fs::remove_dir_all(cache).unwrap();
    }
    assert!(!missing.exists());
}

#[test]
fn the_cache_can_be_put_elsewhere() {
    let fixture = Fixture::new();
    for (variable, folder) in [
        ("DALEMBERT_CACHE", "cache/generated"),
        ("XDG_CACHE_HOME", "caches/dalembert/generated"),
    ] {
        let value = fixture.path(folder.split('/').next().unwrap());
        succeeds(fixture.script().env(variable, value));
        only_folder(&fixture.path(folder), "alpha-");
    }
    let file = fixture.write("file", "");
    let message = fails(fixture.script().env("DALEMBERT_CACHE", file.join("cache")));
    has(
        &message,
        &["DALEMBERT_CACHE=", "cannot write there", "to do: "],
    );
}

#[test]
fn without_python_the_message_says_what_to_install() {
    let fixture = Fixture::new();
    let empty = fixture.path("empty");
    fs::create_dir(&empty).unwrap();
    let message = fails(fixture.installing().env("PATH", empty));
    assert!(
        message.starts_with("no Python found: none of python3, python,"),
        "{message}"
    );
    has(
        &message,
        &[
            "to do: install Python 3.9 or newer with pip",
            "DALEMBERT_PYTHON",
        ],
    );
}

#[test]
fn an_interpreter_that_will_not_do_is_named_with_the_reason_and_the_next_is_tried() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    let bare = fixture.path("bare");
    fixture.program("bare/python3", &format!("exec '{PYTHON}' -S \"$@\""));
    fixture.program("bare/python", "echo 2.7; exit 1");
    fixture.program(
        "bare/python3.12",
        "echo 'python3.12: command not found' >&2; exit 127",
    );
    let message = fails(fixture.installing().env("PATH", &bare));
    has(
        &message,
        &[
            "no Python found that can install CasADi:\n    python3: is Python 3.",
            ", but has no pip\n",
            "    python: is Python 2.7; needed is 3.9 to",
            "    python3.12: does not run as Python does: python3.12: command not found\n",
            "to do: install Python",
        ],
    );
    // The last name that is tried; those before it must not be found elsewhere.
    fixture.program("bare/python3.9", &format!("exec '{PYTHON}' \"$@\""));
    let path = format!("{}:{}", bare.display(), std::env::var("PATH").unwrap());
    for name in ["python3.14", "python3.13", "python3.11", "python3.10"] {
        fixture.program(&format!("bare/{name}"), "exit 1");
    }
    succeeds(fixture.installing().env("PATH", path));
    assert_eq!(fixture.log(), ALL);
}

#[test]
fn a_named_interpreter_is_checked_and_nothing_is_installed_for_it() {
    let fixture = Fixture::new();
    let name = "DALEMBERT_PYTHON";

    let message = fails(fixture.script().env(name, "/no/such/python"));
    has(
        &message,
        &[
            "DALEMBERT_PYTHON=/no/such/python: no such program",
            "to do: ",
        ],
    );

    let without = fixture.program("without", &format!("exec '{PYTHON}' -S \"$@\""));
    let message = fails(fixture.script().env(name, without));
    has(
        &message,
        &[
            "cannot import CasADi: ModuleNotFoundError: No module named 'casadi'",
            "to do: install casadi==1.2.3 for it",
        ],
    );

    let wrong = fixture.python_with_casadi("1.0.0");
    let message = fails(fixture.script().env(name, wrong));
    has(
        &message,
        &[
            "has CasADi 1.0.0; needed is 1.2.3",
            "to do: install casadi==1.2.3",
        ],
    );

    let right = fixture.python_with_casadi(VERSION);
    let outcome = succeeds(fixture.script().env(name, right));
    assert_eq!(fixture.log(), ["generate alpha", "generate beta"]);
    let line = "cargo::rustc-env=DALEMBERT_PYTHON_PATH=".to_owned();
    assert!(
        outcome.directives.contains(&line),
        "{:?}",
        outcome.directives
    );
}

#[test]
fn without_a_network_our_message_comes_before_that_of_pip() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    let message = fails(fixture.installing().env_remove("PIP_FIND_LINKS"));
    assert!(
        message.starts_with("cannot fetch CasADi 1.2.3: "),
        "{message}"
    );
    has(
        &message,
        &[
            "    with a network: check the connection, or the proxy",
            "    without: ",
            "PIP_NO_INDEX=1 PIP_FIND_LINKS=",
            "DALEMBERT_PYTHON",
            "pip says:\n    ",
            "No matching distribution found for casadi==1.2.3",
        ],
    );
    // The failure left nothing that would stand in the way of the next build.
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ALL);
}

#[test]
fn a_package_with_another_hash_is_refused() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    fixture.lock(&"0".repeat(64));
    let message = fails(&mut fixture.installing());
    assert!(message.starts_with("refused CasADi 1.2.3: "), "{message}");
    has(
        &message,
        &["codegen/requirements.lock", "pip says:\n", "Got "],
    );
    assert!(fixture.log().is_empty());
}

#[test]
fn a_lock_file_that_does_not_pin_casadi_is_refused() {
    let fixture = Fixture::new();
    fixture.write("project/codegen/requirements.lock", "numpy==2.0.2\n");
    has(
        &fails(&mut fixture.installing()),
        &["requirements.lock: no line `casadi==VERSION`", "to do: "],
    );
}

#[test]
fn the_python_environment_of_the_caller_changes_nothing() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    fixture.write("intruder/casadi.py", "raise RuntimeError('an intruder')");
    let intruder = fixture.path("intruder");
    succeeds(
        fixture
            .installing()
            .env("PYTHONPATH", &intruder)
            .env("PYTHONHOME", &intruder)
            .env("PYTHONWARNINGS", "error")
            .env("VIRTUAL_ENV", &intruder)
            .env("PIP_TARGET", &intruder)
            .env("PIP_USER", "1")
            .env("PIP_REQUIRE_VIRTUALENV", "1"),
    );
    assert_eq!(fixture.log(), ALL);
}

#[test]
fn every_model_with_a_fault_is_named_and_the_others_are_kept() {
    let fixture = Fixture::new();
    fixture.model("beta", "fault");
    fixture.model("gamma", "crash");
    let message = fails(&mut fixture.script());
    // The generator's own words, with nothing around them.
    let first = "models/beta/model.py:1: the model has a fault\nmodels/gamma: ";
    assert!(message.starts_with(first), "{message}");
    has(
        &message,
        &[
            "did not name the fault",
            "    RuntimeError: the generator has a fault",
        ],
    );
    assert_eq!(fixture.log().len(), 3);
    fixture.model("beta", "2.0");
    fixture.model("gamma", "3.0");
    succeeds(&mut fixture.script());
    assert_eq!(fixture.log(), ["generate beta", "generate gamma"]);
}

#[test]
fn folder_names_that_cannot_be_modules_are_refused() {
    let fixture = Fixture::new();
    for name in ["Alpha", "1st", "two-part", "two__part", "part_"] {
        fixture.model(name, "1.0");
        let message = fails(&mut fixture.script());
        has(
            &message,
            &[&format!("models/{name}: "), "to do: rename the folder"],
        );
        fs::remove_dir_all(fixture.path(&format!("project/models/{name}"))).unwrap();
    }
    fixture.write("project/tests/models/alpha/model.py", "1.0");
    let mut script = fixture.script();
    script.env("CARGO_FEATURE_TEST_MODELS", "1");
    let message = fails(&mut script);
    has(
        &message,
        &["models/alpha and tests/models/alpha have the same name"],
    );
}

#[test]
fn a_missing_compiler_and_c_that_does_not_compile_are_told_apart() {
    let fixture = Fixture::new();
    let mut script = fixture.script();
    let message = fails(script.env("CC", "/no/such/cc"));
    has(
        &message,
        &[
            "cannot compile the models: /no/such/cc: ",
            "to do: install a C compiler",
        ],
    );
    fixture.model("beta", "no number");
    let message = fails(&mut fixture.script());
    has(&message, &["cannot compile the C code of models/beta: "]);
}

#[test]
fn the_lock_file_pins_by_hash_and_names_no_registry() {
    let lock = include_str!("../../codegen/requirements.lock");
    assert!(!lock.contains("://"));
    let packages: Vec<_> = lock.lines().filter(|line| !line.starts_with(' ')).collect();
    for package in ["casadi==3.8.2 ", "numpy==", "sympy==", "mpmath=="] {
        assert!(
            packages.iter().any(|line| line.starts_with(package)),
            "{package}"
        );
    }
    let hashed = lock.matches("\\\n    --hash=sha256:").count();
    assert!(hashed >= packages.len() && packages.iter().all(|line| line.ends_with('\\')));
}

/// The interpreter and packages that the crate was built with are those its own Python runs use.
#[test]
fn the_crate_can_run_its_python() {
    let mut python = Command::new(PYTHON);
    let packages = env!("DALEMBERT_PYTHON_PATH");
    if !packages.is_empty() {
        python.env("PYTHONPATH", packages);
    }
    let output = python
        .args(["-B", "-c", "import casadi; print(casadi.__version__)"])
        .output()
        .unwrap();
    let version = String::from_utf8(output.stdout).unwrap();
    assert_eq!(version.trim(), env!("DALEMBERT_CASADI_VERSION"));
}
