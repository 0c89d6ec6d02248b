//! Contacts that stick although not all of their forces are determined: as long as some share of them holds.

use crate::common::random::Random;
use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Interpolation, Outside, Table};

/// An acceleration of the ground that grows at a rate from zero, m/s³.
fn ramp(problem: &mut Problem, rate: f64) {
    let end = problem.end.time;
    let table = Table::new(
        &[0.0, end],
        &[0.0, rate * end],
        Interpolation::Linear,
        Outside::Hold,
    );
    problem.set_input("a", table.unwrap().into()).unwrap();
}

/// Half of the length, mass and gravity of the ladder.
const L: f64 = 2.0;
const M: f64 = 10.0;
const G: f64 = 9.81;

fn ladder(theta: f64, [foot, top]: [f64; 2]) -> Problem {
    let mut ladder = problem("ladder", &[("mu_foot", foot), ("mu_top", top)]);
    let initial = [
        ("x", L * theta.cos()),
        ("y", L * theta.sin()),
        ("theta", theta),
    ];
    for (name, value) in initial {
        ladder.set_initial(name, value).unwrap();
    }
    ladder.end.time = 2.0;
    ladder.set_tolerance(TIGHTEST);
    ladder
}

/// The acceleration of the ground towards the wall at which the ladder slips away from it: both ends hold as much as they can.
fn ladder_slips(theta: f64, [foot, top]: [f64; 2]) -> f64 {
    let (s, c) = theta.sin_cos();
    // Moments about the centre, then forces upwards and away from the wall.
    let ratio = (c - s * foot) / (s + c * top);
    let ground = M * G / (1.0 + top * ratio);
    let wall = ratio * ground;
    (foot * ground - wall) / M
}

#[test]
fn a_ladder_slips_where_both_of_its_ends_hold_no_more() {
    // The second and the third would not stand at a wall without friction.
    for (theta, friction) in [
        (1.2, [0.3, 0.3]),
        (1.0, [0.29, 0.6]),
        (1.1, [0.24, 0.9]),
        (0.9, [0.7, 0.1]),
    ] {
        let most = ladder_slips(theta, friction);
        assert!(most > 0.0, "{most}");
        for method in [Method::Taylor, Method::Radau] {
            let mut ladder = ladder(theta, friction);
            ladder.method = method;
            ramp(&mut ladder, -most / 1.5);
            ladder.record.every = Some(0.05);
            ladder.record.columns.outputs = true;
            ladder.record.ledger = true;
            let run = run(&ladder);
            let first = &run.events[0];
            assert!(
                ["foot slips", "top slips"].contains(&first.transition),
                "{}",
                first.transition
            );
            assert!((first.t - 1.5).abs() <= 1e-14, "{theta}: {}", first.t);
            let column = |name: &str| run.trajectory.column(name).expect("a column");
            let forces = ["foot.normal", "foot.friction", "top.normal", "top.friction"].map(column);
            let shares = ["foot_shares", "top_shares"].map(column);
            for (k, &t) in run.trajectory.t.iter().enumerate() {
                let row = run.trajectory.row(k);
                let stands = t < first.t;
                assert_eq!(shares.map(|c| row[c]), [f64::from(stands); 2], "{t}");
                if stands {
                    let [n_foot, t_foot, n_top, t_top] = forces.map(|c| row[c]);
                    let (s, c) = theta.sin_cos();
                    let a = -most / 1.5 * t;
                    let sums = [
                        n_top + t_foot - M * a,
                        n_foot + t_top - M * G,
                        L * (c * (n_foot - t_top) + s * (t_foot - n_top)),
                    ];
                    assert!(sums.iter().all(|sum| sum.abs() <= 1e-12), "{t}: {sums:?}");
                    let within = |[normal, friction]: [f64; 2], mu: f64| {
                        normal >= 0.0 && friction.abs() <= mu * normal + 1e-12
                    };
                    assert!(within([n_foot, t_foot], friction[0]), "{t}");
                    assert!(within([n_top, t_top], friction[1]), "{t}");
                }
            }
            let imbalance = run.energy.as_ref().unwrap().imbalance();
            assert!(imbalance.abs() <= 1e-12, "{imbalance:e}");
        }
    }
}

/// Blocks of the row.
const BLOCKS: usize = 6;

/// The acceleration of the table to the right at which each block begins to slip, given the most that each holds by itself,
/// whether it touches the one before, or the stop, and whether there is one. Those slip together that lean on the fewest which hold
/// the least; the last two are one.
fn row_slips(holds: [f64; BLOCKS], touches: [bool; BLOCKS], stop: bool) -> [f64; BLOCKS] {
    let mut slips = [f64::INFINITY; BLOCKS];
    let is_joint = |&k: &usize| k < BLOCKS && !touches[k];
    let mut first = match stop {
        true => (1..=BLOCKS).find(|k| *k == BLOCKS || is_joint(k)).unwrap(),
        false => 0,
    };
    while first < BLOCKS {
        let end = (first + 1..BLOCKS).find(is_joint).unwrap_or(BLOCKS);
        while first < end {
            let mean =
                |last: &usize| holds[first..=*last].iter().sum::<f64>() / (last + 1 - first) as f64;
            let last = (first..end)
                .filter(|&last| last != BLOCKS - 2)
                .min_by(|a, b| mean(a).total_cmp(&mean(b)))
                .unwrap();
            slips[first..=last].fill(mean(&last));
            first = last + 1;
        }
    }
    slips
}

#[test]
fn random_rows_of_blocks_slip_where_no_share_holds_them() {
    let mut random = Random(11);
    for case in 0..30 {
        let mut row = problem("pushed_row", &[]);
        let holds: [f64; BLOCKS] = std::array::from_fn(|_| random.within(1.0, 5.0));
        let mut touches: [bool; BLOCKS] = std::array::from_fn(|_| random.within(0.0, 1.0) < 0.7);
        touches[BLOCKS - 1] = true;
        let stop = random.within(0.0, 1.0) < 0.3;
        touches[0] = stop;
        if stop {
            row.set_parameter("stop", 0.0).unwrap();
        }
        for k in 0..BLOCKS {
            let [mu, s] = ["mu", "s"].map(|of| format!("{of}_{}", k + 1));
            row.set_parameter(&mu, holds[k] / 10.0).unwrap();
            let clear = if touches[k] { 0.0 } else { 50.0 };
            row.set_initial(&s, clear).unwrap();
        }
        row.method = [Method::Taylor, Method::Radau][case % 2];
        row.set_tolerance(TIGHTEST);
        row.end.time = 2.6;
        row.record.every = Some(0.01);
        row.record.columns.outputs = true;
        let rate = 2.0;
        ramp(&mut row, rate);
        let run = run(&row);
        let times = row_slips(holds, touches, stop).map(|a| a / rate);
        let column = |name: &str| run.trajectory.column(name).unwrap();
        for (k, &time) in times.iter().enumerate() {
            let slips = match time.is_finite() {
                true => {
                    let off = |event: &f64| (event - time).abs();
                    let events = run.events.iter().map(|event| event.t);
                    let nearest = events.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
                    assert!(off(&nearest) <= 1e-13, "{case}, {k}: {nearest} {time}");
                    nearest
                }
                false => time,
            };
            let [direction, shares] =
                ["direction", "shares"].map(|of| column(&format!("block_{}_{of}", k + 1)));
            // It has a share where it touches another, or the stop, as long as neither has slipped away.
            let with =
                |j: usize| (j == 0 && stop) || touches[j] && times[j - 1].min(times[j]) == time;
            let has_share = with(k) || k + 1 < BLOCKS && with(k + 1);
            for (i, &t) in run
                .trajectory
                .t
                .iter()
                .enumerate()
                .filter(|(_, t)| **t != slips)
            {
                let row = run.trajectory.row(i);
                assert_eq!(
                    row[direction],
                    -f64::from(t > slips),
                    "{case}, {k}: {t} {time}"
                );
                if t > slips {
                    assert_eq!(row[shares], 0.0, "{case}, {k}: {t} {time}");
                } else if has_share {
                    assert_eq!(row[shares], 1.0, "{case}, {k}: {t} {time}");
                }
            }
        }
        let [shares, last] = [column("link_shares"), BLOCKS - 1];
        for (i, &t) in run.trajectory.t.iter().enumerate() {
            let stands = run
                .events
                .iter()
                .all(|e| (e.t - times[last]).abs() > 1e-13 || t < e.t);
            assert_eq!(
                run.trajectory.row(i)[shares],
                f64::from(stands),
                "{case}: {t}"
            );
        }
    }
}
