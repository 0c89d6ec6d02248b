//! Which interpreter is taken, what is installed for it, and what is said when that fails.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::fixture::{Fixture, PYTHON, VERSION, fails, succeeds};
use super::{ALL, has};

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
    let warned = |line: &String| line.starts_with("cargo::warning=") && line.contains("no SymPy");
    assert!(
        outcome.directives.iter().any(warned),
        "{:?}",
        outcome.directives
    );
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
fn a_package_with_another_hash_or_none_is_refused() {
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
    // And so is one without a hash.
    let lock = format!("casadi=={VERSION}\n");
    fixture.write("project/codegen/requirements.lock", &lock);
    let message = fails(&mut fixture.installing());
    assert!(
        message.starts_with("cannot install CasADi 1.2.3: "),
        "{message}"
    );
    has(&message, &["to do: ", "Hashes are required"]);
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
    let settings = "[global]\nrequire-virtualenv = true\n[install]\nuser = true\n";
    let settings = fixture.write("pip.conf", settings);
    succeeds(
        fixture
            .installing()
            .env("PYTHONPATH", &intruder)
            .env("PYTHONHOME", &intruder)
            .env("PYTHONWARNINGS", "error")
            .env("VIRTUAL_ENV", &intruder)
            .env("PIP_PREFIX", &intruder)
            .env("PIP_CONFIG_FILE", settings),
    );
    assert_eq!(fixture.log(), ALL);
}

/// Code that Python runs at its start where a user or a site wants it to.
#[test]
fn no_code_of_a_user_or_a_site_runs_in_the_generator() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    let ask = "import site, sys; print(site.getusersitepackages())";
    let user_site = Command::new(PYTHON)
        .args(["-c", ask])
        .env("HOME", fixture.path("home"))
        .env_remove("PYTHONUSERBASE")
        .output()
        .expect("the interpreter runs");
    let user_site = PathBuf::from(String::from_utf8(user_site.stdout).unwrap().trim());
    let mark = fixture.path("mark");
    let code = format!("open({mark:?}, 'a').write('run')");
    let below_home = user_site.strip_prefix(fixture.path("home"));
    let user_site = Path::new("home").join(below_home.expect("the user's site is at home"));
    fixture.write(user_site.join("usercustomize.py").to_str().unwrap(), &code);
    fixture.write(user_site.join("casadi.py").to_str().unwrap(), &code);
    // Where the generator is started.
    fixture.write("project/sitecustomize.py", &code);
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ALL);
    assert!(!mark.exists());
    // Nor for an interpreter that is named.
    fixture.model("alpha", "3.0");
    succeeds(&mut fixture.script());
    assert!(!mark.exists());
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
