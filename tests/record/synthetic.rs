//! Runs made by formula.

use std::f64::consts::PI;
use std::time::Duration;

use dalembert::record::{
    ColumnKind, EnergyJump, Event, HybridState, Layout, Ledger, ModeNames, Peak, Quantity, Reached,
    Recorder, Run, Snapshot, Solver, Subject, Tally, Uncertain,
};

const G: f64 = 9.81;

/// A ball of 1 kg dropped from `height` onto the ground, `samples` samples up to the end of the
/// `bounces`-th flight, restitution 0.8. Its flights are parabolas.
pub fn bouncing_ball(height: f64, bounces: u64, samples: usize) -> Run {
    let restitution = 0.8;
    let layout = Layout {
        coordinates: vec![Quantity::new(
            "y",
            "m",
            "height of the ball above the ground",
        )],
        velocities: vec![Quantity::new("y.rate", "m/s", "rate of y")],
        reactions: vec![Quantity::new(
            "reaction.y",
            "N",
            "force of the ground on the ball",
        )],
        discretes: vec![Quantity::new("side", "1", "which side of the ball is up")],
        outputs: vec![],
        impulses: vec![Quantity::new(
            "ground.normal_impulse",
            "N s",
            "impulse of the normal force",
        )],
        energies: vec![Quantity::new(
            "energy.stored",
            "J",
            "kinetic and potential energy",
        )],
        inputs: vec![],
        modes: ModeNames::listed(vec!["flies".into(), "rests".into()]),
    };
    let snapshot = |y: f64, v: f64, side: f64| Snapshot {
        q: vec![y],
        v: vec![v],
        discrete: vec![side],
        reactions: vec![0.0],
        outputs: vec![],
    };
    // Flights: (start, duration, speed at the start).
    let impact_speed = (2.0 * G * height).sqrt();
    let mut flights = vec![(-impact_speed / G, 2.0 * impact_speed / G, impact_speed)];
    let mut events = Vec::new();
    let mut side = 1.0;
    for j in 1..=bounces {
        let (start, duration, speed) = *flights.last().unwrap();
        let t = start + duration;
        let after = restitution * speed;
        events.push(Event {
            t,
            j,
            transition: "bounce",
            from: 0,
            to: 0,
            before: snapshot(0.0, -speed, side),
            after: snapshot(0.0, after, -side),
            energy: Some(EnergyJump {
                lost: (speed * speed - after * after) / 2.0,
                ground_work: 0.0,
            }),
            impulses: vec![speed + after],
        });
        side = -side;
        flights.push((t, 2.0 * after / G, after));
    }
    let (start, duration, speed) = *flights.last().unwrap();
    let end = start + duration;
    events.push(Event {
        t: end,
        j: bounces + 1,
        transition: "rest",
        from: 0,
        to: 1,
        before: snapshot(0.0, -speed, side),
        after: Snapshot {
            reactions: vec![G],
            ..snapshot(0.0, 0.0, side)
        },
        energy: Some(EnergyJump {
            lost: speed * speed / 2.0,
            ground_work: 0.0,
        }),
        impulses: vec![speed],
    });
    let mut recorder = Recorder::new(&layout, samples);
    for i in 0..samples {
        let t = end * i as f64 / samples as f64;
        let flight = flights.partition_point(|f| f.0 <= t) - 1;
        let (start, _, speed) = flights[flight];
        let (y, v) = (
            speed * (t - start) - G / 2.0 * (t - start).powi(2),
            speed - G * (t - start),
        );
        recorder.push_row(t, 0, |row| {
            row.copy_from_slice(&[y, v, 0.0, if flight % 2 == 0 { 1.0 } else { -1.0 }, 0.0]);
            row[layout.range(ColumnKind::Energy)][0] = G * y + v * v / 2.0;
        });
    }
    with_peaks(Run {
        peaks: Vec::new(),
        tally: Tally::of(events.iter().map(Event::jump)),
        subject: Subject {
            projected: Vec::new(),
            model: "bouncing_ball".into(),
            title: "A ball".into(),
            choices: vec![("rules".into(), "reactions".into())],
            parameters: vec![("m".into(), 1.0), ("e".into(), restitution)],
            digests: vec![],
        },
        trajectory: recorder.finish(),
        end: HybridState {
            t: end,
            j: bounces + 1,
            mode: 1,
            state: events[bounces as usize].after.clone(),
        },
        events,
        layout,
        solver: Solver {
            method: "by formula".into(),
            ..Solver::default()
        },
        energy: Some(Ledger {
            initial: G * height,
            lost_at_impacts: G * height,
            frame: "The ground does not move.".into(),
            ..Ledger::default()
        }),
        error: None,
        uncertain: Uncertain::default(),
        reached: Reached::default(),
        wall: Duration::ZERO,
        failure: None,
    })
}

/// The run with the extremes of its rows and events as its peaks.
pub fn with_peaks(mut run: Run) -> Run {
    let has_peak = |group| {
        matches!(
            group,
            ColumnKind::Coordinate | ColumnKind::Velocity | ColumnKind::Reaction
        )
    };
    let columns = run.trajectory.columns.iter().enumerate();
    let peaks = columns
        .filter(|(_, c)| has_peak(c.group))
        .filter_map(|(i, _)| {
            let mut curve = run.curve(i).filter(|(_, x)| !x.is_nan());
            let (t, x) = curve.next()?;
            let first = Peak {
                max: x,
                t_max: t,
                min: x,
                t_min: t,
            };
            let peak = curve.fold(first, |mut peak, (t, x)| {
                if x > peak.max {
                    (peak.max, peak.t_max) = (x, t);
                }
                if x < peak.min {
                    (peak.min, peak.t_min) = (x, t);
                }
                peak
            });
            Some((i, peak))
        });
    run.peaks = peaks.collect();
    run
}

/// Something with the quantities, the units and the magnitudes of a tank: it slips by millimetres,
/// bulges by micrometres, and changes its mode about `changes` times.
pub fn tank_like(samples: usize, changes: usize) -> Run {
    let coordinates = [
        ("theta", "rad", "uplift about the pivot edge, ≥ 0", "N m"),
        (
            "x_I",
            "m",
            "bulging displacement along the base line, to the right",
            "N",
        ),
        ("x", "m", "slip of the base, to the right", "N"),
        ("y", "m", "height of the pivot edge", "N"),
    ];
    let rate = |(name, unit): (&str, &str)| {
        Quantity::new(
            format!("{name}.rate"),
            format!("{unit}/s"),
            format!("rate of {name}"),
        )
    };
    let reaction = |name: &str, unit: &str| {
        let meaning = format!("generalized force that holds {name} still");
        Quantity::new(format!("reaction.{name}"), unit, meaning)
    };
    let layout = Layout {
        coordinates: coordinates
            .map(|(n, u, m, _)| Quantity::new(n, u, m))
            .into(),
        velocities: coordinates.map(|(n, u, ..)| rate((n, u))).into(),
        reactions: coordinates
            .map(|(n, .., u)| reaction(n, u))
            .into_iter()
            .chain([Quantity::new(
                "reaction.z_h",
                "N",
                "force of the ground on the system along z_h",
            )])
            .collect(),
        discretes: vec![Quantity::new(
            "side",
            "1",
            "pivot: +1 left edge, −1 right edge",
        )],
        outputs: vec![],
        impulses: vec![],
        energies: [
            ("stored", "kinetic and potential energy"),
            ("input_work", "work of the inputs so far"),
            ("dissipated", "energy dissipated so far"),
            ("lost_at_impacts", "energy lost at impacts so far"),
        ]
        .map(|(n, m)| Quantity::new(format!("energy.{n}"), "J", m))
        .into(),
        inputs: vec![Quantity::new(
            "ground_acceleration",
            "m/s^2",
            "of the ground, to the right",
        )],
        modes: ModeNames::listed(
            [
                "stands_sticks",
                "stands_slides",
                "rocks_sticks",
                "rocks_slides",
            ]
            .map(String::from)
            .into(),
        ),
    };
    let end = 2.0;
    let state = |t: f64, mode: usize| {
        let (slides, rocks) = (mode % 2 == 1, mode > 1);
        let s = 2.0 * PI * 7.0 * t;
        let ring = (2.0 * PI * 26.0 * t).sin();
        let theta = if rocks {
            3e-6 * (1.0 - (s * 2.0).cos())
        } else {
            0.0
        };
        let slip = 2.3e-3 * (s - 0.6).sin() - 1.1e-3 * t;
        let q = vec![theta, 34e-6 * (s.sin() + 0.3 * ring), slip, 0.0];
        let v = vec![
            if rocks { 2.6e-4 * (s * 2.0).sin() } else { 0.0 },
            1.5e-3 * (s.cos() + ring),
            if slides { 0.1 * (s - 0.6).cos() } else { 0.0 },
            0.0,
        ];
        let shear = 110.0 * s.cos();
        let moment = if rocks { 0.0 } else { 60.0 + 40.0 * s.sin() };
        let reactions = vec![
            moment,
            0.0,
            if slides { 0.0 } else { shear },
            612.0 + 3.0 * ring,
            shear,
        ];
        Snapshot {
            q,
            v,
            discrete: vec![if s.sin() > 0.0 { 1.0 } else { -1.0 }],
            reactions,
            outputs: vec![],
        }
    };
    let names = ["slip", "stick", "lift_off", "landing", "reversal"];
    let mut events: Vec<Event> = Vec::new();
    let mut mode = 0;
    for i in 0..changes {
        // Irregular intervals, and a pause in the middle.
        let share = (i as f64 + 0.4 * ((i * i) as f64).sin()) / changes as f64;
        let t = end
            * if share < 0.5 {
                share * 0.9
            } else {
                1.0 - (1.0 - share) * 0.9
            };
        let next = (mode + 1 + i % 3) % 4;
        let energy = (i % 5 == 3).then_some(EnergyJump {
            lost: 1e-5,
            ground_work: 2e-6,
        });
        events.push(Event {
            t: t.max(events.last().map_or(0.0, |e| e.t)),
            j: i as u64 + 1,
            transition: names[(mode + next) % 5],
            from: mode,
            to: next,
            before: state(t, mode),
            after: state(t, next),
            energy,
            impulses: Vec::new(),
        });
        mode = next;
    }
    let mut recorder = Recorder::new(&layout, samples);
    let mut passed = 0;
    for i in 0..samples {
        let t = end * i as f64 / (samples - 1) as f64;
        while passed < events.len() && events[passed].t <= t {
            passed += 1;
        }
        let mode = passed.checked_sub(1).map_or(0, |last| events[last].to);
        let work = 4.0 * t + 0.4 * (40.0 * t).sin().powi(2);
        recorder.push_row(t, mode, |row| {
            let state: Vec<f64> = state(t, mode).values().collect();
            row[..state.len()].copy_from_slice(&state);
            row[layout.range(ColumnKind::Energy)].copy_from_slice(&[
                0.3 + 0.2 * (40.0 * t).sin(),
                work,
                work * 0.9,
                work * 0.05,
            ]);
            row[layout.range(ColumnKind::Input)][0] = 20.0 * (2.0 * PI * 7.0 * t).sin();
        });
    }
    with_peaks(Run {
        peaks: Vec::new(),
        tally: Tally::of(events.iter().map(Event::jump)),
        subject: Subject {
            projected: Vec::new(),
            model: "walking_tank".into(),
            title: "Something like a tank".into(),
            choices: vec![
                ("rules".into(), "reactions".into()),
                ("landing".into(), "momenta".into()),
            ],
            parameters: vec![("mu_s".into(), 0.2)],
            digests: vec![],
        },
        layout,
        trajectory: recorder.finish(),
        end: HybridState {
            t: end,
            j: changes as u64,
            mode,
            state: state(end, mode),
        },
        events,
        solver: Solver {
            method: "by formula".into(),
            steps: 12_345,
            rejected: 67,
            residual_evaluations: 98_765,
            jacobian_evaluations: 4_321,
            factorizations: 8_642,
        },
        energy: Some(Ledger {
            initial: 0.3,
            final_: 0.7,
            dissipated: 7.2,
            input_work: 8.0,
            lost_at_impacts: 0.4,
            frame:
                "The ledger is kept in the inertial frame, where a landing on the moving ground \
                    does work."
                    .into(),
        }),
        error: None,
        uncertain: Uncertain::default(),
        reached: Reached::default(),
        wall: Duration::from_millis(123),
        failure: None,
    })
}
