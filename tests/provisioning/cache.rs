//! Where the cache is, that builds share it, and that it heals.

use std::fs;

use super::fixture::{Fixture, fails, finish, only_folder, start, succeeds};
use super::{ALL, has};

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

    let generated = only_folder(&cache.join("code"), "alpha-");
    fs::remove_file(generated.join("alpha/alpha_model.c")).unwrap();
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ["generate alpha"]);

    // Of the same size, and C as good as before.
    let c = generated.join("alpha/alpha.c");
    let text = fs::read_to_string(&c).unwrap();
    fs::write(&c, text.replace("return 1.0", "return 7.0")).unwrap();
    succeeds(&mut fixture.installing());
    assert_eq!(fixture.log(), ["generate alpha"]);
    assert_eq!(fs::read_to_string(&c).unwrap(), text);

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
        only_folder(&cache.join("code"), "alpha-");
        fs::remove_dir_all(cache).unwrap();
    }
    assert!(!missing.exists());
}

#[test]
fn the_cache_can_be_put_elsewhere() {
    let fixture = Fixture::new();
    for (variable, folder) in [
        ("DALEMBERT_CACHE", "cache/code"),
        ("XDG_CACHE_HOME", "caches/dalembert/code"),
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
