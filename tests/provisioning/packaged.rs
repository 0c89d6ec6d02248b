//! C that was generated before, in the folder `generated` of a crate: builds without Python.

use std::fs;

use super::fixture::{Fixture, fails, succeeds};
use super::has;

/// A project with C that was generated before, for the engine or for another crate.
fn packaged(of_crate: bool) -> (Fixture, impl Fn(&Fixture) -> std::process::Command) {
    let fixture = Fixture::new();
    let script = move |fixture: &Fixture| match of_crate {
        true => fixture.script_of_crate("own", "1.0.0"),
        false => fixture.script(),
    };
    succeeds(script(&fixture).env("DALEMBERT_PREGENERATE", "1"));
    fixture.log();
    (fixture, script)
}

#[test]
fn a_crate_with_generated_c_builds_without_python() {
    for of_crate in [false, true] {
        let (fixture, script) = packaged(of_crate);
        let mut script = script(&fixture);
        fixture.without_python(&mut script);
        let told = succeeds(&mut script).directives;
        assert!(fixture.log().is_empty());
        assert!(told.contains(&"cargo::rerun-if-changed=generated".to_owned()));
        assert!(
            told.iter()
                .any(|line| line.starts_with("cargo::rustc-link-lib=static=")
                    && line.ends_with("beta_model"))
        );
    }
}

#[test]
fn generated_c_that_does_not_fit_is_not_taken() {
    let (fixture, script) = packaged(false);
    let mut without = script(&fixture);
    fixture.without_python(&mut without);

    fixture.model("beta", "3.0");
    let message = fails(&mut without);
    has(
        &message,
        &[
            "the C that was generated before does not fit:\n    generated/beta: made from other files",
            "and it cannot be generated anew: no Python found",
            "to do: install Python",
        ],
    );
    // With Python it is generated, and what is there stays.
    succeeds(&mut script(&fixture));
    assert_eq!(fixture.log(), ["generate beta"]);
    has(
        &fails(&mut without),
        &["generated/beta: made from other files"],
    );
    fixture.model("beta", "2.0");
    succeeds(&mut without);

    let c = fixture.path("project/generated/alpha/alpha.c");
    let text = fs::read_to_string(&c).unwrap();
    fs::write(&c, text.replace("1.0", "7.0")).unwrap();
    has(
        &fails(&mut without),
        &["generated/alpha: its files were changed"],
    );
    fs::remove_file(&c).unwrap();
    has(&fails(&mut without), &["generated/alpha: "]);

    // Where there is none it is not spoken of.
    fs::remove_dir_all(fixture.path("project/generated")).unwrap();
    assert!(fails(&mut without).starts_with("no Python found"));
}

#[test]
fn it_is_another_crate_s_under_another_name() {
    let (fixture, _) = packaged(true);
    let mut other = fixture.script_of_crate("own", "1.0.1");
    fixture.without_python(&mut other);
    has(
        &fails(&mut other),
        &["for a crate of another name or version"],
    );
}

#[test]
fn models_for_tests_are_no_part_of_it() {
    let fixture = Fixture::new();
    fixture.write("project/tests/models/gamma/model.py", "3.0");
    let mut script = fixture.script();
    script
        .env("CARGO_FEATURE_TEST_MODELS", "1")
        .env("DALEMBERT_PREGENERATE", "1");
    succeeds(&mut script);
    assert!(fixture.path("project/generated/alpha/digest").is_file());
    assert!(!fixture.path("project/generated/gamma").exists());
    assert!(!fixture.path("project/generated.partial").exists());
}

#[test]
fn a_documentation_build_needs_neither_python_nor_a_compiler() {
    let fixture = Fixture::new();
    for mut script in [fixture.script(), fixture.script_of_crate("own", "1.0.0")] {
        fixture.without_python(&mut script);
        script.env("DOCS_RS", "1").env("CC", "/no/such/cc");
        let told = succeeds(&mut script).directives;
        assert!(
            told.iter()
                .any(|line| line.starts_with("cargo::rustc-env=DALEMBERT_MODELS="))
        );
        assert!(fixture.log().is_empty());
    }
}
