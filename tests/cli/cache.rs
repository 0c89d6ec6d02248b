//! `cache`: what it shows and removes. (What it never removes is tested in `codegen/build/evict.rs`.)

use std::fs;

use super::{dalembert, stdout};

#[test]
fn sizes_are_shown_and_limits_kept() {
    let folder = tempfile::tempdir().unwrap();
    let entry = folder.path().join("derived/old-1");
    fs::create_dir_all(&entry).unwrap();
    fs::write(entry.join("file"), vec![b'x'; 1500]).unwrap();
    let run = |arguments: &[&str], status: i32| {
        let mut command = dalembert(folder.path());
        let command = command
            .env("DALEMBERT_CACHE", folder.path())
            .args(arguments);
        command.assert().code(status).get_output().clone()
    };
    let output = run(&["cache"], 0);
    let text = stdout(&output);
    assert!(
        text.contains("C of model folders") && text.contains("1.5 kB"),
        "{text}"
    );
    assert!(text.contains("of at most 4.0 GB"), "{text}");
    run(&["cache", "--limit", "2 kB"], 0);
    assert!(entry.exists());
    let output = run(&["cache", "--limit", "1kB", "--json"], 0);
    let answer: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(
        (&answer["bytes"], &answer["limit"]),
        (&0.into(), &1000.into())
    );
    assert_eq!(answer["removed"]["entries"], 1);
    assert!(!entry.exists());
    run(&["cache", "--limit", "much"], 2);
    run(&["cache", "--clear"], 0);
}
