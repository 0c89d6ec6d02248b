//! The output folder of a program that is killed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use dalembert::record::OutputFolder;

/// Names the folder to the writing process; without it, [`write_forever`] has nothing to do.
const FOLDER: &str = "DALEMBERT_TEST_FOLDER";
/// Files of a generation, each long enough that writing it takes a while.
const FILES: [&str; 3] = ["a.csv", "b.csv", "c.csv"];
const LINES: usize = 2_000;

/// Not a test of its own: what the killed process does. Replaces the folder again and again, each
/// time with files that repeat their generation in every line.
#[test]
fn write_forever() {
    let Some(path) = std::env::var_os(FOLDER) else {
        return;
    };
    let folder = OutputFolder::new(Path::new(&path)).unwrap();
    for generation in 0u64.. {
        let written = folder.replace(|staging| {
            FILES.iter().try_for_each(|name| {
                staging.file(name, |out| {
                    (0..LINES).try_for_each(|_| writeln!(out, "{generation}"))
                })
            })
        });
        written.unwrap();
    }
}

/// A writing process; it is killed when the value goes, also where a test fails.
struct Writer(Child);

impl Writer {
    fn start(folder: &Path) -> Writer {
        let child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "killed::write_forever", "--test-threads", "1"])
            .env(FOLDER, folder)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        Writer(child.unwrap())
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

/// The generation of the folder's files, which must be whole and the same in all.
fn generation(folder: &Path) -> String {
    let texts = FILES.map(|name| fs::read_to_string(folder.join(name)).unwrap());
    let first = texts[0].lines().next().unwrap().to_owned();
    for text in texts {
        assert_eq!(text.lines().count(), LINES);
        assert!(
            text.lines().all(|line| line == first),
            "files of two generations"
        );
    }
    first
}

#[test]
fn a_killed_program_leaves_the_old_files_or_the_new_ones() {
    let home = tempfile::tempdir().unwrap();
    let folder: PathBuf = home.path().join("out");
    let foreign = folder.join("own.txt");
    let mut generations = Vec::new();
    for i in 0..20u64 {
        let writer = Writer::start(&folder);
        let started = Instant::now();
        while !folder.exists() {
            assert!(
                started.elapsed() < Duration::from_secs(60),
                "the writer writes nothing"
            );
            std::thread::sleep(Duration::from_millis(1));
        }
        if i == 0 {
            fs::write(&foreign, "mine").unwrap();
        }
        // Killed at another phase of its work each time.
        let started = Instant::now();
        while started.elapsed() < Duration::from_micros(100_000 + i * 317) {
            assert!(
                foreign.exists(),
                "somebody else's file was away for a moment"
            );
        }
        drop(writer);
        generations.push(generation(&folder));
        assert!(folder.join(".dalembert-output").is_file());
    }
    assert!(
        generations.iter().any(|g| g != "0"),
        "the folder was never replaced"
    );
}
