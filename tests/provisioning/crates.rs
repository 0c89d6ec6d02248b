//! Crates that depend on the engine and have models of their own.

use std::fs;

use super::fixture::{Fixture, fails, succeeds};
use super::has;

/// The variable by which `dalembert::models!()` finds the list of the models.
fn list(directives: &[String]) -> String {
    let prefix = "cargo::rustc-env=DALEMBERT_MODELS=";
    let mut found = directives
        .iter()
        .filter_map(|line| line.strip_prefix(prefix));
    found.next().expect("it is told").to_owned()
}

#[test]
fn a_crate_s_models_have_names_of_its_own() {
    let fixture = Fixture::new();
    let engine = succeeds(&mut fixture.script()).directives;
    assert_eq!(list(&engine), "dalembert_models");
    let libraries = |directives: &[String]| -> Vec<String> {
        let prefix = "cargo::rustc-link-lib=static=";
        let lines = directives
            .iter()
            .filter_map(|line| line.strip_prefix(prefix));
        lines.map(str::to_owned).collect()
    };
    assert!(libraries(&engine).contains(&"dalembert__elementary".to_owned()));

    // Names that differ in a hyphen, and versions of a crate, of which a program may have several.
    let crates = [("a-b", "1.0.0"), ("a_b", "1.0.0"), ("a-b", "1.1.0")];
    let lists = crates.map(|(name, version)| {
        let mut script = fixture.script_of_crate(name, version);
        let told = succeeds(&mut script).directives;
        assert_eq!(fixture.log(), ["generate alpha", "generate beta"]);
        let list = list(&told);
        let c = fixture.path("target-of-crate/debug/build/project/out/models.c");
        let c = fs::read_to_string(c).unwrap();
        has(
            &c,
            &[&format!(
                "dalembert_model *const {list}[] = {{&dalembert_a_b_"
            )],
        );
        // What all models call is in the engine, and its tests' variables are the engine's.
        for library in libraries(&told) {
            assert!(library.starts_with("dalembert_a_b_"), "{library}");
            assert!(!library.contains("elementary"), "{library}");
        }
        assert!(
            !told
                .iter()
                .any(|line| line.contains("DALEMBERT_PYTHON_EXE"))
        );
        list
    });
    for (i, one) in lists.iter().enumerate() {
        assert!(lists[..i].iter().all(|other| other != one), "{lists:?}");
    }
}

#[test]
fn another_version_of_the_engine_is_refused_with_both() {
    let fixture = Fixture::new();
    let own = env!("CARGO_PKG_VERSION");
    let mut script = fixture.script_of_crate("own", "1.0.0");
    let message = fails(script.env("DEP_DALEMBERT_VERSION", "9.8.7"));
    let both = format!("this crate has dalembert 9.8.7 and dalembert-build {own}: ");
    has(&message, &[&both, "to do: in Cargo.toml"]);

    let message = fails(script.env_remove("DEP_DALEMBERT_VERSION"));
    let line = format!("add dalembert = \"{own}\" to [dependencies]");
    has(&message, &["dalembert is none of its dependencies", &line]);
}

#[test]
fn a_generator_for_another_contract_is_refused() {
    let fixture = Fixture::new();
    let mut script = fixture.script_of_crate("own", "1.0.0");
    let header = include_str!("../../codegen/contract.h");
    let line = header
        .lines()
        .find(|line| line.contains("CONTRACT_VERSION "))
        .unwrap();
    let own = line.rsplit(' ').next().unwrap();

    // A change that nobody gave a number.
    fixture.write(
        "project/codegen/contract.h",
        &format!("{header}/* changed */\n"),
    );
    let message = fails(&mut script);
    has(
        &message,
        &[
            &format!("was built for models of the contract {own} ("),
            &format!("makes those of the contract {own} ("),
        ],
    );

    let other = header.replace(line, "#define DALEMBERT_CONTRACT_VERSION 77");
    fixture.write("project/codegen/contract.h", &other);
    has(
        &fails(&mut script),
        &[&format!("of the contract {own} ("), "of the contract 77 ("],
    );

    // Without a number there is nothing to compare: neither the engine nor another crate is built.
    fixture.write("project/codegen/contract.h", &header.replace(line, ""));
    for script in [&mut script, &mut fixture.script()] {
        let message = fails(script);
        has(
            &message,
            &[
                "no line `#define DALEMBERT_CONTRACT_VERSION NUMBER`",
                "to do: ",
            ],
        );
    }
}
