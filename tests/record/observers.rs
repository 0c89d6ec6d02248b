//! Runs that are observed while they go on.

use std::ops::ControlFlow;
use std::path::Path;

use dalembert::hybrid::{MadeStep, Observer, Problem, Reason, simulate, simulate_with};
use dalembert::model::models;
use dalembert::record::{
    ColumnKind, Earlier, Jump, OutputFolder, Run, Sides, Silent, Sketch, Stream,
};
use dalembert::scene::Scene;

fn scene(name: &str, overrides: &[&str]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.json"));
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    Scene::load(&path, &overrides, models()).unwrap()
}

/// A time, and coordinates and velocities then.
type At = (f64, Vec<f64>, Vec<f64>);

/// Keeps what it is told, and ends the run at a row by its index.
#[derive(Default)]
struct Told {
    rows: Vec<(f64, usize, Vec<f64>)>,
    /// Rows and points, in the order in which they came.
    curve: Vec<(f64, Vec<f64>)>,
    sees_points: bool,
    window: Option<[f64; 2]>,
    events: Vec<(Jump, Option<Sides>)>,
    /// Times at which steps begin and end, and the states at these.
    steps: Vec<[At; 2]>,
    sees_steps: bool,
    coordinates: usize,
    end_at: Option<usize>,
}

impl Observer for Told {
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()> {
        self.rows.push((t, mode, values.to_vec()));
        self.curve.push((t, values.to_vec()));
        match self.end_at == Some(self.rows.len()) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
    fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        self.events.push((*jump, sides.cloned()));
    }
    fn sees_points(&self) -> bool {
        self.sees_points
    }
    fn window(&self) -> Option<[f64; 2]> {
        self.window
    }
    fn point(&mut self, t: f64, _mode: usize, values: &[f64]) {
        self.curve.push((t, values.to_vec()));
    }
    fn sees_steps(&self) -> bool {
        self.sees_steps
    }
    fn step(&mut self, step: &mut MadeStep) {
        let count = self.coordinates;
        let ends = [step.from, step.to].map(|t| {
            let (mut q, mut v) = (vec![0.0; count], vec![0.0; count]);
            step.state_at(t, &mut q, &mut v);
            (t, q, v)
        });
        self.steps.push(ends);
    }
}

fn same(run: &Run, told: &Told) {
    assert_eq!(run.trajectory.len(), told.rows.len());
    for (i, (t, mode, values)) in told.rows.iter().enumerate() {
        assert_eq!(run.trajectory.t[i], *t, "row {i}");
        assert_eq!(run.trajectory.mode[i], *mode, "row {i}");
        assert_eq!(run.trajectory.row(i), values, "row {i}");
    }
    assert_eq!(run.events.len(), told.events.len());
    for (event, (jump, sides)) in run.events.iter().zip(&told.events) {
        assert_eq!(event.jump(), *jump);
        let sides = sides.as_ref().unwrap();
        assert_eq!((&event.before, &event.after), (&sides.before, &sides.after));
        assert_eq!(event.impulses, sides.impulses);
    }
}

#[test]
fn an_observer_is_told_what_a_run_in_memory_holds() {
    for name in [
        "bouncing_ball",
        "tank_full_plate",
        "vibrating_table_ball",
        "belt_oscillator",
    ] {
        let scene = scene(name, &["end=0.9"]);
        let run = simulate(&scene.problem, &mut Silent).unwrap();
        let mut told = Told::default();
        let observed = simulate_with(&scene.problem, &mut told, &mut Silent).unwrap();
        same(&run, &told);
        assert!(observed.trajectory.is_empty() && observed.events.is_empty());
        assert_eq!(observed.trajectory.columns, run.trajectory.columns);
        assert_eq!(observed.tally, run.tally);
        assert_eq!(observed.peaks, run.peaks);
        assert_eq!((observed.energy, observed.end), (run.energy, run.end));
    }
}

#[test]
fn steps_are_shown_with_their_dense_output_up_to_their_events() {
    for (name, method) in [("bouncing_ball", "taylor"), ("tank_full_plate", "radau")] {
        let method = format!("method={method}");
        let scene = scene(name, &["end=0.9", "record={}", &method]);
        let problem = &scene.problem;
        let mut told = Told {
            sees_steps: true,
            coordinates: problem.model.coordinates.len(),
            ..Told::default()
        };
        let run = simulate_with(problem, &mut told, &mut Silent).unwrap();
        assert_eq!(told.steps.len() as u64, run.solver.steps, "{name}");
        // One step begins where the one before has ended, in time and, without an event between them, in state.
        for steps in told.steps.windows(2) {
            let [(end, ..), (start, ..)] = [&steps[0][1], &steps[1][0]];
            assert!((start - end).abs() < 1e-12, "{name}: {end} {start}");
        }
        // Before an event the state is that at the end of a step, but for what it takes to the far side.
        let mut seen = 0;
        for (jump, sides) in &told.events {
            let before = &sides.as_ref().unwrap().before;
            let at_its_time = |(t, ..): &&At| (t - jump.t).abs() < 1e-14;
            let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-10);
            let mut ends = told.steps.iter().map(|step| &step[1]).filter(at_its_time);
            seen += usize::from(ends.any(|(_, q, v)| near(q, &before.q) && near(v, &before.v)));
        }
        assert!(2 * seen > told.events.len(), "{name}: {seen}");
    }
}

#[test]
fn points_between_rows_are_those_of_the_motion() {
    // A fall: y = 1 − g t²/2, of which the energy is kept; rows are 0.1 s apart.
    for method in ["method=taylor", "method=radau"] {
        let scene = scene("bouncing_ball", &["end=0.4", "record.every=0.1", method]);
        let problem = &scene.problem;
        let mut told = Told {
            sees_points: true,
            ..Told::default()
        };
        simulate_with(problem, &mut told, &mut Silent).unwrap();
        let run = simulate(problem, &mut Silent).unwrap();
        same(&run, &told);
        let gravity = run
            .subject
            .parameters
            .iter()
            .find(|p| p.0 == "g")
            .unwrap()
            .1;
        assert!(
            told.curve.len() > told.rows.len() + 25,
            "{method}: {}",
            told.curve.len()
        );
        assert!(told.curve.is_sorted_by(|a, b| a.0 <= b.0), "{method}");
        let energy = problem.layout().range(ColumnKind::Energy).start;
        for (t, values) in &told.curve {
            let (h, rate) = (1.0 - gravity * t * t / 2.0, -gravity * t);
            assert!((values[0] - h).abs() < 1e-14, "{method}: h at {t}");
            assert!(
                (values[1] - rate).abs() < 1e-14 * 4.0,
                "{method}: rate at {t}"
            );
            assert!((values[energy] / told.curve[0].1[energy] - 1.0).abs() < 1e-14);
        }
    }
    // Rows at the ends of steps alone are few of its points.
    let steps = scene("bouncing_ball", &["end=0.4", "record={}"]);
    let mut told = Told {
        sees_points: true,
        ..Told::default()
    };
    simulate_with(&steps.problem, &mut told, &mut Silent).unwrap();
    assert!(
        told.curve.len() > 25 * told.rows.len().max(1) / 2,
        "{}",
        told.curve.len()
    );
    assert!(told.curve.is_sorted_by(|a, b| a.0 <= b.0));
    // Rows that are as close as that are the curve.
    let scene = scene("bouncing_ball", &["end=0.4", "record.every=5e-5"]);
    let mut told = Told {
        sees_points: true,
        ..Told::default()
    };
    simulate_with(&scene.problem, &mut told, &mut Silent).unwrap();
    assert_eq!(told.curve.len(), told.rows.len());
}

/// Rows that nobody sees are not computed, and change nothing.
#[test]
fn an_observer_that_sees_no_rows_is_told_of_none() {
    let scene = scene("bouncing_ball", &["end=0.4", "record.every=1e-30"]);
    struct Blind(usize);
    impl Observer for Blind {
        fn row(&mut self, _: f64, _: usize, _: &[f64]) -> ControlFlow<()> {
            self.0 += 1;
            ControlFlow::Break(())
        }
        fn sees_rows(&self) -> bool {
            false
        }
        fn event(&mut self, _: &Jump, _: Option<&Sides>) {}
    }
    let mut blind = Blind(0);
    let run = simulate_with(&scene.problem, &mut blind, &mut Silent).unwrap();
    assert_eq!((blind.0, run.end.t), (0, 0.4));
}

/// A picture of a window far shorter than a step has curves in it.
#[test]
fn a_window_that_is_looked_at_closely_has_points_of_its_own() {
    let scene = scene("forced_pendulum", &["end=10", "record.every=0.5"]);
    let curve = |window| {
        let mut told = Told {
            sees_points: true,
            window,
            ..Told::default()
        };
        simulate_with(&scene.problem, &mut told, &mut Silent).unwrap();
        told.curve
    };
    let all = curve(None);
    for window in [[4.2001, 4.2003], [0.0, 1e-6], [9.4, 12.0]] {
        let closely = curve(Some(window));
        let is_shown = |point: &&(f64, Vec<f64>)| window[0] <= point.0 && point.0 <= window[1];
        let [inside, before] = [&closely, &all].map(|curve| curve.iter().filter(is_shown).count());
        assert!(inside > 30 && inside > before, "{inside} {before}");
        assert!(inside < 5000 + 20);
        assert!(closely.is_sorted_by(|a, b| a.0 < b.0));
        // A line between neighbours is one of the motion, as on a page of the whole run.
        let longest = window[1].min(10.0) - window[0];
        let within: Vec<_> = closely.iter().filter(is_shown).collect();
        assert!(
            within
                .windows(2)
                .all(|ends| ends[1].0 - ends[0].0 <= longest / 25.0)
        );
        let early =
            |curve: &[(f64, Vec<f64>)]| curve.iter().filter(|point| point.0 < window[0]).count();
        // Of the step in which it opens the part before it has as many as else the step.
        let [with, without] = [&closely, &all].map(|curve| early(curve));
        assert!((without..without + 32).contains(&with), "{with} {without}");
    }
}

/// Problems of which steps hold many samples: a flight, and a motion with energies in its rows.
fn with_many_samples() -> [Scene; 3] {
    [
        scene("bouncing_ball", &["record.every=1e-4", "end=0.4"]),
        scene(
            "bouncing_ball",
            &["record={\"every\":1e-4}", "end=0.4", "method=radau"],
        ),
        scene("forced_pendulum", &["record.every=1e-3", "end=4"]),
    ]
}

#[test]
fn a_run_ends_at_a_sample_with_its_state_energies_and_extremes() {
    for scene in with_many_samples() {
        let problem = &scene.problem;
        let whole = simulate(problem, &mut Silent).unwrap();
        let mut told = Told {
            end_at: Some(1235),
            ..Told::default()
        };
        let first = simulate_with(problem, &mut told, &mut Silent).unwrap();
        assert_eq!(first.failure.as_ref().unwrap().reason, Reason::Interrupted);
        assert_eq!(told.rows.len(), 1235);
        // The state is that of the sample, and so are the energies and the extremes.
        assert_eq!(first.end.t, whole.trajectory.t[1234]);
        let row = whole.trajectory.row(1234);
        assert_eq!(first.end.state.q[..], row[..first.end.state.q.len()]);
        assert!(
            first
                .peaks
                .iter()
                .all(|(_, p)| p.t_max.max(p.t_min) <= first.end.t)
        );
        let (energy, exact) = (
            first.energy.as_ref().unwrap(),
            whole.energy.as_ref().unwrap(),
        );
        assert!(
            energy.imbalance().abs() < 1e-8 * (1.0 + exact.initial.abs()),
            "{energy:?}"
        );
    }
}

/// All files of a folder that a run decides, by name.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let names = [
        "trajectory.csv",
        "events.csv",
        "csv-metadata.json",
        "overview.svg",
        "phase.svg",
    ];
    let read = |name: &str| (name.to_owned(), std::fs::read(folder.join(name)).unwrap());
    names.map(read).into()
}

/// Files and pictures of a run, as they come.
struct Files(Stream, Sketch);

impl Observer for Files {
    fn row(&mut self, t: f64, mode: usize, values: &[f64]) -> ControlFlow<()> {
        self.0.row(t, mode, values);
        self.1.row(t, values);
        ControlFlow::Continue(())
    }
    fn event(&mut self, jump: &Jump, sides: Option<&Sides>) {
        let states = sides.map(|sides| [&sides.before, &sides.after]);
        let impulses = sides.map_or(&[][..], |sides| &sides.impulses);
        self.0.event(jump, states.map(|states| (states, impulses)));
        self.1.event(jump, states);
    }
}

fn observed(problem: &Problem, folder: &Path) -> Run {
    let run = simulate(problem, &mut Silent).unwrap();
    let folder = OutputFolder::new(folder).unwrap();
    let mut files = Files(Stream::new(&folder, &run.layout), Sketch::new(&run.layout));
    let run = simulate_with(problem, &mut files, &mut Silent).unwrap();
    files.0.finish(&run, &files.1, &Default::default()).unwrap();
    run
}

#[test]
fn files_that_were_written_as_rows_came_are_those_of_a_run_in_memory() {
    let home = tempfile::tempdir().unwrap();
    let [streamed, written] = ["streamed", "written"].map(|name| home.path().join(name));
    let mut scene = scene("tank_full_plate", &["end=1.2"]);
    for every in [scene.problem.record.every, None] {
        scene.problem.record.every = every;
        observed(&scene.problem, &streamed);
        let run = simulate(&scene.problem, &mut Silent).unwrap();
        run.write(&OutputFolder::new(&written).unwrap()).unwrap();
        assert!(files(&streamed) == files(&written));
    }
}

#[test]
fn a_run_is_read_back_row_by_row_or_whole() {
    let home = tempfile::tempdir().unwrap();
    let scene = scene("tank_full_plate", &["end=0.7503"]);
    let problem = &scene.problem;
    let out = home.path().join("out");
    observed(problem, &out);
    let layout = problem.layout();
    let run = Run::read(&out, &problem.model, problem.variant(), layout.clone()).unwrap();
    let mut earlier = Earlier::open(&out, &problem.model, problem.variant(), layout).unwrap();
    let mut told = Told::default();
    earlier
        .rows(|t, mode, values| {
            told.rows.push((t, mode, values.to_vec()));
            Ok(())
        })
        .unwrap();
    earlier
        .events(|jump, sides| told.event(jump, Some(sides)))
        .unwrap();
    assert_eq!(earlier.run.tally, run.tally);
    same(&run, &told);
}
