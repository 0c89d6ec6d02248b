//! Reactions and momenta against Newton's second law on the whole tank.

use crate::body::{Motion, Tank};
use crate::common::*;
use crate::scenes::{SCENES, scene};
use dalembert::hybrid::Problem;
use dalembert::record::{Run, Snapshot};
use std::collections::BTreeSet;

/// Interval of the samples, s: a fortieth of a radian of bulging, so that differences over four of
/// them are good to 1e-8 of the largest force.
const EVERY: f64 = 1e-4;

/// Motions of the ground upwards, beside those of the scenes: none, and one that lifts and drops the tank while it rocks.
const RISES: [Option<&str>; 2] = [
    None,
    Some(
        r#"inputs.vertical_acceleration={"sum": [{"constant": 1.5}, {"sine": {"amplitude": 4, "frequency": 7.3, "phase": 0.4}}]}"#,
    ),
];

/// A scene with fine samples of everything, long enough to rock and to slide.
fn sampled(name: &str, rise: Option<&str>) -> (Problem, Run) {
    let overrides: Vec<&str> = ["accuracy.relative=1e-12"]
        .into_iter()
        .chain(rise)
        .collect();
    let mut problem = scene(name, &overrides);
    problem.end.time = problem.end.time.min(0.5);
    problem.record.every = Some(EVERY);
    problem.record.columns.reactions = true;
    problem.record.columns.inputs = true;
    let run = run(&problem);
    (problem, run)
}

/// A row as a motion, with a look-up of further columns.
struct Rows<'r> {
    run: &'r Run,
}

impl Rows<'_> {
    fn value(&self, row: usize, name: &str) -> f64 {
        let trajectory = &self.run.trajectory;
        trajectory.row(row)[trajectory.column(name).unwrap()]
    }

    fn motion(&self, row: usize) -> Motion {
        Motion {
            theta: self.value(row, "theta"),
            x_i: self.value(row, "x_I"),
            theta_rate: self.value(row, "theta.rate"),
            x_i_rate: self.value(row, "x_I.rate"),
            x_rate: self.value(row, "x.rate"),
            side: self.value(row, "side"),
            ground_velocity: self.value(row, "ground_acceleration.velocity"),
            rise: self.value(row, "vertical_acceleration.velocity"),
        }
    }

    /// Rows around which two rows on either side are free of events.
    fn smooth(&self) -> Vec<usize> {
        let t = &self.run.trajectory.t;
        let events = &self.run.events;
        (2..t.len() - 2)
            .filter(|&row| t[row + 2] - t[row - 2] < 4.5 * EVERY)
            .filter(|&row| {
                let first = events.partition_point(|e| e.t < t[row - 2] - EVERY);
                events.get(first).is_none_or(|e| e.t > t[row + 2] + EVERY)
            })
            .collect()
    }

    /// Rate of a function of the row, by the five-point formula.
    fn rate(&self, row: usize, f: impl Fn(usize) -> f64) -> f64 {
        (8.0 * (f(row + 1) - f(row - 1)) - (f(row + 2) - f(row - 2))) / (12.0 * EVERY)
    }
}

#[test]
fn reactions_are_the_rates_of_the_momenta() {
    let mut visited = BTreeSet::new();
    for (name, rise) in SCENES
        .into_iter()
        .flat_map(|name| RISES.map(|rise| (name, rise)))
    {
        let (problem, run) = sampled(name, rise);
        let tank = Tank::of(&problem);
        let rows = Rows { run: &run };
        let weight = tank.mass() * tank.g;
        let smooth = rows.smooth();
        assert!(smooth.len() > 500, "{name}: {} rows", smooth.len());
        let mut worst = [0.0f64; 4];
        for row in smooth {
            visited.insert((rise, run.trajectory.mode[row]));
            let horizontal = rows.rate(row, |r| tank.horizontal_momentum(&rows.motion(r)));
            let vertical = rows.rate(row, |r| tank.vertical_momentum(&rows.motion(r))) + weight;
            let error = [
                horizontal - rows.value(row, "reaction.z_h"),
                vertical - rows.value(row, "reaction.y"),
                vertical - rows.value(row, "reaction.z_v"),
            ];
            for (worst, error) in worst.iter_mut().zip(error) {
                *worst = worst.max(error.abs() / weight);
            }
            if run
                .layout
                .modes
                .name(run.trajectory.mode[row])
                .starts_with("stands")
            {
                let motion = rows.motion(row);
                let x_i = rows.rate(row, |r| rows.value(r, "x_I.rate"));
                let u = rows.rate(row, |r| {
                    rows.value(r, "x.rate") + rows.value(r, "ground_acceleration.velocity")
                });
                let rising = rows.value(row, "vertical_acceleration");
                let moment = tank.holding_moment(&motion, [x_i, u, rising]);
                let error = moment - rows.value(row, "reaction.theta");
                worst[3] = worst[3].max(error.abs() / (weight * tank.r_0));
            }
        }
        assert!(
            worst.iter().all(|&w| w < 1e-7),
            "{name}, {rise:?}: {worst:?}"
        );
    }
    // All four modes, with and without the ground rising.
    assert_eq!(visited.len(), 2 * 4, "{visited:?}");
}

#[test]
fn the_ground_carries_what_it_lifts() {
    let mut problem = scene(
        "tank_full_plate",
        &[
            "inputs={\"vertical_acceleration\": {\"constant\": 2}}",
            "end=0.1",
        ],
    );
    problem.record.every = Some(0.01);
    problem.record.columns.reactions = true;
    let tank = Tank::of(&problem);
    let run = run(&problem);
    let rows = Rows { run: &run };
    let force = tank.mass() * (tank.g + 2.0);
    assert!((force - 682.3).abs() < 0.1, "{force}");
    for row in 0..run.trajectory.len() {
        for name in ["reaction.y", "reaction.z_v"] {
            let error = rows.value(row, name) - force;
            assert!(error.abs() < 1e-12 * force, "{name}: {error:e}");
        }
    }
}

#[test]
fn ground_that_rises_steadily_is_stronger_gravity() {
    // With (g + a) in place of g, the shaking the same: the tank cannot tell them apart.
    for name in ["tank_free_release", "tank_rocks_and_slides"] {
        let lifted = r#"inputs.vertical_acceleration={"constant": 2.5}"#;
        let heavier = "parameters.g=12.31";
        let runs = [lifted, heavier].map(|change| {
            let mut problem = scene(name, &["accuracy.relative=1e-12", change]);
            problem.end.time = problem.end.time.min(0.5);
            run(&problem)
        });
        let [lifted, heavier] = &runs;
        assert_eq!(transitions(lifted), transitions(heavier), "{name}");
        assert!(!lifted.events.is_empty(), "{name}");
        for (a, b) in lifted.events.iter().zip(&heavier.events) {
            assert!(
                (a.t - b.t).abs() < 1e-8,
                "{name}: {} at {} and {}",
                a.transition,
                a.t,
                b.t
            );
        }
    }
}

fn motion_of(snapshot: &Snapshot, ground_velocity: f64) -> Motion {
    let (q, v) = (&snapshot.q, &snapshot.v);
    Motion {
        theta: q[0],
        x_i: q[1],
        theta_rate: v[0],
        x_i_rate: v[1],
        x_rate: v[2],
        side: snapshot.discrete[0],
        ground_velocity,
        rise: 0.0,
    }
}

/// Velocity of the ground at `t`.
fn ground_velocity(problem: &Problem, t: f64) -> f64 {
    let mut signals = vec![0.0; problem.model.signal_count()];
    problem.signals.evaluate(t, &mut signals);
    signals[1]
}

#[test]
fn momentum_changes_by_the_impulses_of_the_ground_alone() {
    let every = 2e-5;
    for name in SCENES {
        let mut problem = scene(name, &["accuracy.relative=1e-10"]);
        problem.end.time = problem.end.time.min(0.5);
        problem.record.every = Some(every);
        problem.record.columns.reactions = true;
        problem.record.columns.inputs = true;
        let run = run(&problem);
        let tank = Tank::of(&problem);
        let rows = Rows { run: &run };
        let weight = tank.mass() * tank.g;
        let momentum = |row| tank.horizontal_momentum(&rows.motion(row));
        let force = |row| rows.value(row, "reaction.z_h");
        let mut events = run.events.iter().peekable();
        let mut smooth = 0.0;
        for row in 1..run.trajectory.len() {
            let mut gained = momentum(row) - momentum(row - 1);
            let mut eventful = false;
            while let Some(event) = events.next_if(|e| e.t <= run.trajectory.t[row]) {
                let u = ground_velocity(&problem, event.t);
                let [before, after] = [&event.before, &event.after]
                    .map(|state| tank.horizontal_momentum(&motion_of(state, u)));
                if event.transition == "landing" {
                    gained -= after - before;
                } else {
                    // Everything else but an impact keeps all velocities.
                    assert!(
                        (after - before).abs() < 1e-12,
                        "{name}: {}",
                        event.transition
                    );
                }
                eventful = true;
            }
            if eventful {
                // Forces jump at events in the middle of an interval; they are below three weights.
                assert!(
                    gained.abs() < 3.0 * weight * every,
                    "{name}: {gained:e} at an event"
                );
            } else {
                smooth += gained - 0.5 * (force(row) + force(row - 1)) * every;
            }
        }
        // Error of trapezoids over the bulging: T (ω h)²/12 of the largest force.
        let allowed = 0.5 * (163.0 * every).powi(2) / 12.0 * 3.0 * weight;
        assert!(smooth.abs() < allowed, "{name}: {smooth:e} of {allowed:e}");
    }
}
