//! What the targets have in common: runs that are short whatever the scene says, so that one that does not
//! end is a fault, and a panic that is planted to see that it is found.

use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::model::models;
use dalembert::record::{Progress, Run};
use dalembert::scene::{Files, Scene};
use std::hint::black_box;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;

/// Steps after which a run is stopped: enough for stick, slip and impacts, and some milliseconds.
const STEPS: u32 = 100;

/// Variable that plants a panic.
const PLANTED: &str = "DALEMBERT_FUZZ_PLANTED";

/// A table for scenes that name one.
pub const TABLE: &[u8] = b"t,a\n0,0\n0.1,2\n0.2,-3\n0.4,1\n";

/// Stops a run after some steps.
struct Budget(u32);

impl Progress for Budget {
    fn advance(&mut self, _t: f64, _events: u64) -> ControlFlow<()> {
        match self.0.checked_sub(1) {
            Some(left) => {
                self.0 = left;
                ControlFlow::Continue(())
            }
            None => ControlFlow::Break(()),
        }
    }
}

/// Files that all hold the same.
pub struct Everywhere<'a>(pub &'a [u8]);

impl Files for Everywhere<'_> {
    fn read(&self, _path: &Path) -> io::Result<Vec<u8>> {
        Ok(self.0.to_vec())
    }
}

/// Reads a scene; if it is one, runs it for some steps.
pub fn read_and_run(scene: &[u8], overrides: &[String], table: &[u8]) {
    let path = Path::new("scene.json");
    match Scene::parse(scene, path, overrides, models(), &Everywhere(table)) {
        Ok(scene) => run(scene.problem),
        // What is wrong is shown, too.
        Err(errors) => drop(errors.to_string()),
    }
}

/// Runs a problem for some steps.
fn run(mut problem: Problem) {
    if std::env::var_os(PLANTED).is_some() {
        planted(&problem);
    }
    // Rows take memory as the scene asks for it, and the events are what is of interest.
    problem.record.every = None;
    if let Ok(run) = simulate(&problem, &mut Budget(STEPS)) {
        check(&run);
    }
}

/// What every run keeps, however it ends.
fn check(run: &Run) {
    let times = run.events.iter().map(|event| event.t);
    assert!(times.is_sorted(), "time goes backwards from event to event");
    assert!(
        run.trajectory.t.is_sorted(),
        "time goes backwards from row to row"
    );
}

/// Three conditions that no shipped scene meets, nor two of them. Between them is what keeps the compiler
/// from making one of them, as there is between conditions of a program.
#[inline(never)]
fn planted(problem: &Problem) {
    if black_box(problem).method == Method::Radau {
        if black_box(problem).accuracy.relative > 1e-4 {
            if black_box(problem).end.time < 0.125 {
                panic!("planted");
            }
        }
    }
}
