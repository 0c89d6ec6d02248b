//! Whether there is room for what a scene asks to record.

use std::fs;
use std::path::Path;

use super::outcome::Failure;
use crate::scene::Scene;

/// Most bytes of a number in a table: sign, 17 digits, point, exponent and separator.
const DIGITS: f64 = 25.0;

/// Bytes of the digest of a row.
const DIGEST: f64 = 9.0;

/// Refuses a scene whose rows exceed the disk on which `out` is to be. (In memory there are never many.)
pub fn check_disk(scene: &Scene, out: Option<&Path>) -> Result<(), Failure> {
    let bytes = |columns: f64| columns * DIGITS + DIGEST;
    check(scene, "disk", bytes, out.and_then(free_disk))
}

/// Refuses a scene whose rows, of so many runs, exceed the memory.
pub fn check_memory(scene: &Scene, runs: usize) -> Result<(), Failure> {
    let bytes = |columns: f64| runs as f64 * columns * 8.0;
    check(scene, "memory", bytes, free_memory())
}

/// Fewest bytes of a run in the table of a study, while it goes on and in memory when it is written.
const RUN: f64 = 128.0;

/// Says that a study with so many cases exceeds the disk on which `out` is to be, or the memory that holds its table in the end.
pub fn check_rows(cases: f64, out: &Path) -> Result<(), String> {
    let needed = cases * RUN;
    for (what, free) in [("disk", free_disk(out)), ("memory", free_memory())] {
        if let Some(free) = free
            && needed > free
        {
            return Err(format!(
                "{cases:.4e} cases would take at least {needed:.3e} bytes of {what}, of which {free:.3e} are free"
            ));
        }
    }
    Ok(())
}

/// Refuses a scene whose rows, each of so many `bytes` for its columns, exceed what is `free`.
fn check(
    scene: &Scene,
    what: &str,
    bytes: impl Fn(f64) -> f64,
    free: Option<f64>,
) -> Result<(), Failure> {
    let problem = &scene.problem;
    let (Some(every), Some(free)) = (problem.record.every, free) else {
        return Ok(());
    };
    let layout = problem.layout();
    // With the time and the mode.
    let columns = (layout.columns().len() + 2) as f64;
    let rows = (problem.end.time / every).floor() + 1.0;
    let bytes = rows * bytes(columns);
    if bytes <= free {
        return Ok(());
    }
    let message = format!(
        "{rows:.4e} rows of the trajectory would take up to {bytes:.3e} bytes of {what}, of which {free:.3e} are free"
    );
    let help = "raise `record.every`, or leave out columns";
    let source = &scene.source;
    Err(source.error_at("record.every", message, Some(help)).into())
}

/// Memory that programs can still have, in bytes, where the system tells.
fn free_memory() -> Option<f64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024.0)
}

/// Free bytes of the disk of a folder, or of the first one above it that exists.
fn free_disk(folder: &Path) -> Option<f64> {
    #[cfg(any(target_os = "linux", target_vendor = "apple"))]
    {
        let folder = std::path::absolute(folder).ok()?;
        let existing = folder.ancestors().find(|path| path.is_dir())?;
        let disk = rustix::fs::statvfs(existing).ok()?;
        Some(disk.f_bavail as f64 * disk.f_frsize as f64)
    }
    #[cfg(not(any(target_os = "linux", target_vendor = "apple")))]
    {
        let _ = folder;
        None
    }
}
