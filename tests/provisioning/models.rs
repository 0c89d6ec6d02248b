//! What is generated and compiled, how often, and what is said of a model with a fault.

use std::fs;

use super::fixture::{Fixture, fails, only_folder, succeeds};
use super::{ALL, has};

#[test]
fn the_first_build_does_everything_and_the_second_nothing() {
    let Some(fixture) = Fixture::if_pip() else {
        return;
    };
    let first = succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ALL);
    has(
        &fixture.models(),
        &["{&dalembert_model_alpha, &dalembert_model_beta, 0}"],
    );
    let libraries = fixture.path("target/debug/build/project/out/libraries");
    let library = only_folder(&libraries, "dalembert_alpha-").join("libdalembert_alpha.a");
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
    // The library of the old model is gone.
    only_folder(
        &fixture.path("target/debug/build/project/out/libraries"),
        "dalembert_beta-",
    );
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
    let before = only_folder(&libraries, "dalembert_alpha-");
    let compiled = fs::metadata(&before).unwrap().modified().unwrap();
    fixture.write("project/codegen/more.py", "");
    succeeds(&mut fixture.script());
    assert_eq!(fixture.log(), ["generate alpha", "generate beta"]);
    assert_eq!(only_folder(&libraries, "dalembert_alpha-"), before);
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
    has(&fixture.models(), &["&dalembert_model_gamma"]);
}

#[test]
fn an_engine_without_models_needs_no_python() {
    let fixture = Fixture::new();
    let mut script = fixture.script();
    fixture.without_python(script.env_remove("CARGO_FEATURE_SHIPPED_MODELS"));
    succeeds(&mut script);
    has(&fixture.models(), &["dalembert_models[] = {0};"]);
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
fn the_generator_runs_from_the_cache() {
    let fixture = Fixture::new();
    succeeds(&mut fixture.script());
    let generators = fixture.path("home/.cache/dalembert/generator");
    let generator = only_folder(&generators, "");
    let lock = generator.join("codegen/requirements.lock");
    let locked = fs::read(fixture.path("project/codegen/requirements.lock")).unwrap();
    assert_eq!(fs::read(&lock).unwrap(), locked);
    // What was changed there is not run.
    fs::write(generator.join("codegen/__main__.py"), "raise SystemExit(1)").unwrap();
    fixture.model("alpha", "5.0");
    succeeds(&mut fixture.script());
    // A folder `codegen` of the project is not it, unless it is named.
    let mut script = fixture.script();
    script.env("DALEMBERT_GENERATOR", fixture.path("nowhere"));
    has(
        &fails(&mut script),
        &["DALEMBERT_GENERATOR=", "nowhere: ", "to do: let it name"],
    );
}
