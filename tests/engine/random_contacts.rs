//! Random scenes of a body with two to six feet on shaken ground: complementarity, friction within its cone and against the slip,
//! the balance of momentum and the energy ledger in every row; mirrored scenes mirror, permuted feet permute.
//!
//! `DALEMBERT_RANDOM_SCENES=10000` runs as many, `DALEMBERT_RANDOM_SCENE=17` one of them.

use crate::common::random::Random;
use crate::common::*;
use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::input::Sine;
use dalembert::precision::{Ended, other, unsettled};
use dalembert::record::{Run, Silent};
use std::f64::consts::TAU;

/// Scenes in the suite.
const SHARE: u64 = 60;

/// Two beyond them. The six feet of one land flat, on a pivot: two that are close together say when, and move the farthest by roundings.
/// The rests of the other accumulate: half a million hops on gaps of a rounding followed.
const ALSO: [u64; 2] = [645, 2575];

/// Events of a run at most: hops that tell nothing are not gone through.
const EVENTS: usize = 10_000;

#[derive(Debug, Clone, Copy, PartialEq)]
struct Foot {
    across: f64,
    up: f64,
    mu: f64,
    e: f64,
}

/// A scene as numbers.
#[derive(Debug, Clone)]
struct Scene {
    feet: Vec<Foot>,
    inertia: f64,
    /// Place and rate of the centre, to the right, and of the tilt.
    start: [f64; 4],
    /// Height above the place where the lowest foot touches, and rate upwards.
    drop: [f64; 2],
    /// Amplitude, angular frequency and phase of the ground.
    shaking: [f64; 3],
}

const M: f64 = 1.5;
const G: f64 = 9.81;

impl Scene {
    fn random(random: &mut Random) -> Self {
        let count = 2 + (random.next() % 5) as usize;
        let plane = random.next().is_multiple_of(2);
        let mu = random.within(0.1, 0.9);
        let e = random.either(0.0, (0.0, 0.6));
        let feet = (0..count)
            .map(|k| {
                let across = -0.3 + 0.6 * (k as f64 + random.within(0.1, 0.4)) / count as f64;
                // On one line, or on an arc.
                let up = match plane {
                    true => -0.5,
                    false => -0.6 + across * across * random.within(0.2, 2.0),
                };
                Foot {
                    across,
                    up,
                    // Of more than two feet on one line only the sum of the forces is determined, and how they share an impact
                    // with restitution is decided by rounding.
                    mu: if plane {
                        mu
                    } else {
                        random.either(mu, (0.1, 0.9))
                    },
                    e: if plane {
                        0.0
                    } else {
                        random.either(e, (0.0, 0.5))
                    },
                }
            })
            .collect();
        let stands = random.next().is_multiple_of(3);
        let tilt = if stands {
            0.0
        } else {
            random.within(-0.3, 0.3)
        };
        let moves = |random: &mut Random, by: f64| match stands {
            true => 0.0,
            false => random.within(-by, by),
        };
        Scene {
            feet,
            inertia: random.within(0.05, 0.4),
            start: [moves(random, 1.0), tilt, moves(random, 2.0), 0.0],
            drop: [
                if stands { 0.0 } else { random.within(0.0, 0.1) },
                moves(random, 0.5),
            ],
            shaking: [
                random.within(0.0, 8.0),
                TAU * random.within(0.5, 4.0),
                random.within(0.0, TAU),
            ],
        }
    }

    fn mirrored(&self) -> Self {
        let mut other = self.clone();
        for foot in &mut other.feet {
            foot.across = -foot.across;
        }
        for value in &mut other.start {
            *value = -*value;
        }
        other.shaking[0] = -other.shaking[0];
        other
    }

    fn problem(&self, method: Method) -> Problem {
        let mut problem = problem("six_feet", &[("m", M), ("g", G), ("I", self.inertia)]);
        for (k, foot) in self.feet.iter().enumerate() {
            let mut set = |of: &str, value: f64| {
                problem
                    .set_parameter(&format!("{of}_{}", k + 1), value)
                    .unwrap();
            };
            set("across", foot.across);
            set("up", foot.up);
            set("mu", foot.mu);
            set("e", foot.e);
        }
        let [vx, tilt, turns, _] = self.start;
        let (sin, cos) = tilt.sin_cos();
        let lowest = (self.feet.iter().map(|f| f.across * sin + f.up * cos)).fold(0.0, f64::min);
        let mut set = |name: &str, value: f64| problem.set_initial(name, value).unwrap();
        set("y", self.drop[0] - lowest);
        set("theta", tilt);
        set("x.rate", vx);
        set("y.rate", self.drop[1]);
        set("theta.rate", turns);
        let [amplitude, omega, phase] = self.shaking;
        let shaking = Sine::new(amplitude, omega, phase);
        problem.set_input("a_h", shaking.into()).unwrap();
        problem.method = method;
        problem.set_tolerance(1e-12);
        problem.end.time = 1.0;
        problem.record.every = Some(0.02);
        problem.record.columns.outputs = true;
        problem
    }
}

/// What must hold in every row.
fn check(scene: &Scene, run: &Run, of: &str, [vertical, horizontal, ledger]: [f64; 3]) {
    let column = |name: &str| run.trajectory.column(name).expect("a column");
    let feet: Vec<[usize; 6]> = (1..=scene.feet.len())
        .map(|k| {
            let named = |of: &str| column(&format!("foot_{k}.{of}"));
            [
                "gap",
                "slip",
                "normal",
                "friction",
                "normal_impulse",
                "friction_impulse",
            ]
            .map(named)
        })
        .collect();
    let [vx, vy] = ["x.rate", "y.rate"].map(column);
    let first = run.trajectory.row(0).to_vec();
    let [amplitude, omega, phase] = scene.shaking;
    let ground = |t: f64| amplitude / omega * (phase.cos() - (omega * t + phase).cos());
    for (i, &t) in run.trajectory.t.iter().enumerate() {
        let row = run.trajectory.row(i);
        let sum = |index: usize| feet.iter().map(|foot| row[foot[index]]).sum::<f64>();
        let (mut limit, mut friction, mut slides) = (0.0, 0.0, Some(0.0));
        for (foot, &[gap, slip, normal, along, ..]) in scene.feet.iter().zip(&feet) {
            let [gap, slip, normal, along] = [gap, slip, normal, along].map(|c| row[c]);
            assert!(gap > -1e-14, "{of}, {t}: penetrates by {gap:e}");
            assert!(normal >= -1e-9, "{of}, {t}: pulls by {normal:e}");
            assert!(
                normal.abs() <= 1e-14 || gap.abs() <= 1e-15,
                "{of}, {t}: pushes by {normal:e} at {gap:e}"
            );
            assert!(along * slip <= 1e-12, "{of}, {t}: friction drives");
            limit += foot.mu * normal;
            friction += along;
            // In which direction all slide that push.
            let direction = if slip.abs() < 1e-9 {
                0.0
            } else {
                slip.signum()
            };
            slides = match slides {
                all if normal == 0.0 => all,
                Some(0.0) if direction != 0.0 => Some(direction),
                Some(all) if all == direction && all != 0.0 => Some(all),
                _ => None,
            };
        }
        // Of feet that stick side by side the sum is what is determined.
        let cone = limit * (1.0 + 1e-12) + 1e-9;
        assert!(friction.abs() <= cone, "{of}, {t}: {friction} of {limit}");
        if let Some(direction) = slides {
            let off = friction + direction * limit;
            assert!(
                off.abs() <= 1e-12 * limit,
                "{of}, {t}: off kinetic friction by {off:e}"
            );
        }
        let upwards = M * (row[vy] - first[vy]) - (sum(4) - M * G * t);
        let across = M * (row[vx] - first[vx] + ground(t)) - sum(5);
        assert!(upwards.abs() < vertical, "{of}, {t}: {upwards:e} upwards");
        assert!(across.abs() < horizontal, "{of}, {t}: {across:e} across");
    }
    // No row is beyond the extremes, which are those of the motion between the rows.
    for (column, peak) in &run.peaks {
        let values = (0..run.trajectory.t.len()).map(|i| run.trajectory.row(i)[*column]);
        let values = values.filter(|value| !value.is_nan());
        let size = peak.max.abs().max(peak.min.abs());
        let within = 1e-9 * size.max(1e-3);
        for value in values {
            let is_inside = peak.min - within <= value && value <= peak.max + within;
            assert!(is_inside, "{of}: column {column}: {value} beyond {peak:?}");
        }
    }
    let energy = run.energy.as_ref().unwrap();
    let turnover = energy.initial.abs()
        + energy.final_.abs()
        + energy.input_work.abs()
        + energy.dissipated.abs()
        + energy.lost_at_impacts.abs();
    assert!(
        energy.imbalance().abs() <= ledger * turnover,
        "{of}: {energy:?}"
    );
    assert!(energy.dissipated >= -1e-12 * turnover, "{of}: {energy:?}");
}

/// What happens, but for strikes, of which rounding decides how many of an accumulation are seen, and for feet that stay.
fn kinds(run: &Run) -> Vec<&'static str> {
    let mut all = transitions(run);
    all.retain(|name| !name.ends_with(" strikes") && !name.ends_with(" stays"));
    all
}

fn same_motion(one: &Run, other: &Run, sign: f64, within: f64, of: &str) {
    let signs = [sign, 1.0, sign];
    let [a, b] = [one, other].map(|run| {
        let state = &run.end.state;
        [&state.q[..3], &state.v[..3]].concat()
    });
    for (i, (a, b)) in a.iter().zip(&b).enumerate() {
        let off = (a - signs[i % 3] * b).abs();
        assert!(off <= within * (1.0 + a.abs()), "{of}: {a} and {b}");
    }
}

#[test]
fn random_scenes_of_several_contacts_keep_all_laws() {
    let asked = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<u64>().ok());
    let share = asked("DALEMBERT_RANDOM_SCENES").unwrap_or(SHARE);
    let only = asked("DALEMBERT_RANDOM_SCENE");
    let from = asked("DALEMBERT_FROM").unwrap_or(0);
    let numbers = only.map_or_else(|| (from..share).chain(ALSO).collect(), |n| vec![n]);
    let mut unsettled_scenes = 0;
    let (mut stops, mut events) = (std::collections::BTreeMap::<String, u64>::new(), 0);
    for number in numbers {
        let mut random = Random(number);
        let scene = Scene::random(&mut random);
        let of = format!("scene {number}");
        let runs = |scene: &Scene, method| simulate(&scene.problem(method), &mut Silent);
        let run = match runs(&scene, Method::Taylor) {
            Ok(run) => run,
            Err(reason) => panic!("{of}: {reason}"),
        };
        if only.is_some() {
            println!("{scene:#?}\n{:?}", run.failure);
            for event in &run.events {
                println!(
                    "{:.15} {} {:?} | {}",
                    event.t,
                    event.transition,
                    &event.after.outputs[..8],
                    run.layout.modes.name(event.to)
                );
            }
        }
        check(&scene, &run, &of, [1e-12, 1e-12, 1e-12]);
        if let Some(failure) = &run.failure {
            let reason = failure.reason.to_string();
            let kind = reason.split('`').next().unwrap_or_default();
            *stops.entry(format!("{number}: {kind}")).or_default() += 1;
            continue;
        }
        events += run.events.len();
        assert!(run.events.len() <= EVENTS, "{of}: {}", run.events.len());
        let mirrored = runs(&scene.mirrored(), Method::Taylor).unwrap();
        // Where rounding decides what happens, as a tighter tolerance shows, what follows may differ.
        let problem = scene.problem(Method::Taylor);
        let other = other(&problem, &Ended::default(), &mut Silent).unwrap();
        let doubts =
            unsettled(&problem, &run, &run.events, &other).is_some() || run.uncertain.total > 0;
        if doubts {
            unsettled_scenes += 1;
            continue;
        }
        assert_eq!(kinds(&run), kinds(&mirrored), "{of}");
        same_motion(&run, &mirrored, -1.0, 1e-8, &format!("{of} mirrored"));
        let mut order: Vec<usize> = (0..scene.feet.len()).collect();
        order.rotate_left(1);
        order.swap(0, scene.feet.len() / 2);
        let mut permuted = scene.clone();
        for (k, &place) in order.iter().enumerate() {
            permuted.feet[place] = scene.feet[k];
        }
        let permuted = runs(&permuted, Method::Taylor).unwrap();
        assert_eq!(kinds(&run).len(), kinds(&permuted).len(), "{of}");
        same_motion(&run, &permuted, 1.0, 1e-8, &format!("{of} permuted"));
        let radau = runs(&scene, Method::Radau).unwrap();
        check(
            &scene,
            &radau,
            &format!("{of} by Radau"),
            [1e-12, 1e-10, 1e-12],
        );
        let is_certain = radau.uncertain.total == 0 && radau.failure.is_none();
        if is_certain && kinds(&radau) == kinds(&run) {
            same_motion(&run, &radau, 1.0, 1e-8, &format!("{of} by Radau"));
        }
    }
    // What stops is told why: events that accumulate in a way that is not known, or guards that contradict each other.
    assert!(20 * stops.len() as u64 <= share, "{stops:#?}");
    println!("{events} events; {unsettled_scenes} scenes that rounding decides; {stops:#?}");
}
