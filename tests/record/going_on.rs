//! Runs that go on from a checkpoint, against those that were never left: every bit.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use dalembert::hybrid::{Checkpoint, Observer, Problem, Simulator, simulate_from, simulate_with};
use dalembert::model::models;
use dalembert::record::{Jump, Run, Sides, Silent, Tally};
use dalembert::scene::Scene;

/// Rows, by their bits, transitions, and the checkpoints that it asks for after so many steps, with what came before each.
#[derive(Default)]
struct Told {
    rows: Vec<Vec<u64>>,
    events: Vec<(Jump, Option<Sides>)>,
    every: Option<u64>,
    asked: u64,
    checkpoints: Vec<(usize, usize, Checkpoint)>,
}

impl Observer for Told {
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()> {
        let bits = std::iter::once(&t).chain(values).map(|x| x.to_bits());
        self.rows.push(bits.chain([mode as u64]).collect());
        ControlFlow::Continue(())
    }
    fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        self.events.push((*jump, sides.cloned()));
    }
    fn keeps_checkpoints(&self) -> bool {
        self.every.is_some()
    }
    fn wants_checkpoint(&mut self) -> bool {
        self.asked += 1;
        self.asked >= self.every.expect("it keeps checkpoints")
    }
    fn checkpoint(&mut self, checkpoint: Checkpoint) {
        self.asked = 0;
        let before = (self.rows.len(), self.events.len());
        self.checkpoints.push((before.0, before.1, checkpoint));
    }
}

fn results(run: &Run) -> String {
    let Run {
        peaks,
        tally,
        failure,
        end,
        solver,
        energy,
        uncertain,
        reached,
        ..
    } = run;
    format!(
        "{peaks:?} {tally:?} {failure:?} {end:?} {solver:?} {energy:?} {uncertain:?} {reached:?}"
    )
}

/// A run goes on from checkpoints that a run with an earlier end has taken; from how many.
fn check(problem: &Problem, every: u64, name: &str) -> usize {
    let mut gone_on = 0;
    let mut whole = Told::default();
    let run = simulate_with(problem, &mut whole, &mut Silent).unwrap();
    let mut shorter = problem.clone();
    shorter.end.time *= 0.7;
    shorter.end.after = None;
    let mut first = Told {
        every: Some(every),
        ..Told::default()
    };
    simulate_with(&shorter, &mut first, &mut Silent).unwrap();
    let count = first.checkpoints.len();
    let some = [count / 5, count / 2, count.saturating_sub(1)];
    for (rows, events, checkpoint) in some.iter().filter_map(|&i| first.checkpoints.get(i)) {
        if checkpoint.time() >= run.end.t {
            continue;
        }
        // It travels as a text.
        let text = serde_json::to_string(checkpoint).unwrap();
        let checkpoint: Checkpoint = serde_json::from_str(&text).unwrap();
        let before = Tally::of(first.events[..*events].iter().map(|(jump, _)| *jump));
        let mut rest = Told::default();
        let from = (&checkpoint, before);
        let went_on = simulate_from(problem, from, &mut rest, &mut Silent).unwrap();
        let t = checkpoint.time();
        assert!(
            first.rows[..*rows] == whole.rows[..*rows],
            "{name}, {t} s: rows before"
        );
        assert!(rest.rows[..] == whole.rows[*rows..], "{name}, {t} s: rows");
        assert!(
            rest.events[..] == whole.events[*events..],
            "{name}, {t} s: events"
        );
        assert_eq!(results(&went_on), results(&run), "{name}, {t} s");
        gone_on += 1;
    }
    gone_on
}

#[test]
fn every_scene_goes_on_to_the_bit_from_where_a_shorter_run_of_it_was() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let scenes = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let scenes = scenes.filter(|path| path.extension().is_some_and(|e| e == "json"));
    let (mut runs, mut gone_on) = (0, 0);
    for path in scenes {
        for (method, every) in [("auto", 1), ("radau", 3)] {
            let overrides = [format!("method={method}")];
            let scene = Scene::load(&path, &overrides, models()).unwrap();
            let name = format!("{} by {method}", path.file_stem().unwrap().display());
            gone_on += check(&scene.problem, every, &name);
            runs += 1;
        }
    }
    assert!(gone_on > 2 * runs, "{gone_on} of {runs} runs");
}

#[test]
fn a_run_in_parts_does_not_go_on_from_a_checkpoint_with_extremes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/bouncing_ball.json");
    let scene = Scene::load(&path, &[], models()).unwrap();
    let mut told = Told {
        every: Some(1),
        ..Told::default()
    };
    simulate_with(&scene.problem, &mut told, &mut Silent).unwrap();
    let (.., checkpoint) = &told.checkpoints[0];
    let mut simulator = Simulator::new(&scene.problem).unwrap();
    let why = simulator.restore(checkpoint).unwrap_err().to_string();
    assert!(
        why.contains("the list of extremes is not kept now and was kept"),
        "{why}"
    );
}
