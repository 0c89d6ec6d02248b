//! Modes that follow from contacts, held against modes written by hand, and against the laws of contact.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use dalembert::record::Run;
use std::f64::consts::PI;

const METHODS: [Method; 3] = [Method::Auto, Method::Taylor, Method::Radau];

/// Two models of one system, run alike: by contacts and by hand.
fn pair(names: [&str; 2], prepare: impl Fn(&mut Problem)) -> Vec<[Run; 2]> {
    METHODS
        .iter()
        .map(|&method| {
            names.map(|name| {
                let mut problem = problem(name, &[]);
                prepare(&mut problem);
                problem.method = method;
                println!("{name} {method:?}"); // is shown with a failure
                run(&problem)
            })
        })
        .collect()
}

/// The same number of events, at the same times and places to `error`, of the same meaning: `words` pairs the names of
/// transitions.
fn assert_same_motion([contacts, hand]: &[Run; 2], words: &[(&str, &str)], error: f64) {
    let translated: Vec<_> = transitions(contacts)
        .iter()
        .map(|name| words.iter().find(|word| word.0 == *name).expect(name).1)
        .collect();
    assert_eq!(translated, transitions(hand));
    for (a, b) in contacts.events.iter().zip(&hand.events) {
        assert!(
            (a.t - b.t).abs() <= error * b.t.max(1.0),
            "{} at {} and {}",
            a.transition,
            a.t,
            b.t
        );
        for (x, y) in [(&a.before.q, &b.before.q), (&a.after.v, &b.after.v)] {
            assert!(
                (x[0] - y[0]).abs() <= error,
                "{} at {}: {} and {}",
                a.transition,
                a.t,
                x[0],
                y[0]
            );
        }
    }
    let ends = [contacts, hand].map(|run| (run.end.t, run.end.state.q[0], run.end.state.v[0]));
    assert!((ends[0].1 - ends[1].1).abs() <= error, "{ends:?}");
    assert!((ends[0].2 - ends[1].2).abs() <= error, "{ends:?}");
}

#[test]
fn a_ball_by_its_contact_bounces_and_rests_as_the_one_by_hand() {
    for runs in pair(["bouncing_ball", "hand_ball"], |ball| {
        ball.set_initial("h", 1.0).unwrap();
        ball.set_tolerance(1e-12);
        ball.end.time = 5.0;
    }) {
        assert!(runs[0].events.len() > 20);
        assert_same_motion(
            &runs,
            &[("floor strikes", "impact"), ("rest", "rest")],
            1e-12,
        );
        assert_eq!(runs[0].layout.modes.name(runs[0].end.mode), "floor closed");
    }
}

#[test]
fn a_belt_by_its_friction_sticks_and_slips_as_the_one_by_hand() {
    let words = [
        ("belt sticks", "stick"),
        ("belt reverses", "reversal"),
        ("belt slips", "slip"),
    ];
    for [static_friction, kinetic, belt] in
        [[0.04, 0.025, 0.1], [0.1, 0.05, 0.5], [0.05, 0.05, 0.2]]
    {
        for runs in pair(["belt_oscillator", "hand_belt"], |mass| {
            mass.set_parameter("mu_s", static_friction).unwrap();
            mass.set_parameter("mu_k", kinetic).unwrap();
            mass.set_parameter("belt", belt).unwrap();
            mass.set_input("force", Sine::new(0.7, 1.3, 0.2).into())
                .unwrap();
            let direction = match mass.model.name {
                "belt_oscillator" => "belt_direction",
                _ => "slip",
            };
            mass.set_initial(direction, -1.0).unwrap();
            mass.set_tolerance(1e-12);
            mass.end.time = 40.0;
        }) {
            println!("{} events", runs[0].events.len());
            assert!(runs[0].events.len() > 5);
            assert_same_motion(&runs, &words, 1e-10);
        }
    }
}

#[test]
fn a_ball_on_a_table_and_a_base_that_slips_move_as_those_by_hand() {
    let words = [
        ("table strikes", "impact"),
        ("table opens", "take_off"),
        ("rest", "rest"),
    ];
    for runs in pair(["vibrating_table_ball", "hand_table_ball"], |ball| {
        let shaken = Sine::new(1.2 * 9.81, 20.0 * PI, 0.0);
        ball.set_input("table_acceleration", shaken.into()).unwrap();
        ball.set_tolerance(1e-12);
        ball.end.time = 2.0;
    }) {
        assert!(runs[0].events.len() > 50);
        assert_same_motion(&runs, &words, 1e-10);
    }
    let words = [
        ("base sticks", "stick"),
        ("base reverses", "reversal"),
        ("base slips", "slip"),
    ];
    for runs in pair(["sliding_oscillator", "hand_slider"], |base| {
        let shaken = Sine::new(20.0, 14.0 * PI, 0.0);
        base.set_input("ground_acceleration", shaken.into())
            .unwrap();
        base.set_tolerance(1e-12);
        base.end.time = 2.0;
    }) {
        assert!(runs[0].events.len() > 20);
        assert_same_motion(&runs, &words, 1e-10);
    }
}

/// A gap that opens to two sides: free, shaken, and with a landing that takes all.
#[test]
fn a_block_on_two_edges_rocks_as_the_one_by_hand() {
    let words = [
        ("base opens", "lift_off"),
        ("base strikes", "landing"),
        ("rest", "rest"),
    ];
    for (tilt, amplitude, e, least) in [
        (0.2, 0.0, 0.9, 200),
        (0.0, 4.0, 0.85, 20),
        (0.0, -4.0, 0.5, 20),
        (0.1, 3.0, 0.0, 2),
    ] {
        for runs in pair(["rocking_block", "hand_block"], |block| {
            block.set_parameter("e", e).unwrap();
            block.set_initial("theta", tilt).unwrap();
            let shaken = Sine::new(amplitude, 3.0 * PI, 0.3);
            block
                .set_input("ground_acceleration", shaken.into())
                .unwrap();
            block.set_tolerance(1e-12);
            block.end.time = 12.0;
            block.record.every = Some(0.1);
            block.record.columns.reactions = true;
            block.record.columns.outputs = true;
        }) {
            let found = transitions(&runs[0]).len();
            assert!(found >= least, "{tilt} {amplitude} {e}: {found} events");
            assert_same_motion(&runs, &words, 1e-11);
            let of = |name| runs[0].trajectory.column(name).unwrap();
            let (force, reaction) = (of("edge.2.force"), of("reaction.y"));
            let t = &runs[0].trajectory;
            assert!((0..t.len()).all(|i| t.row(i)[force] == t.row(i)[reaction]));
        }
    }
}

#[test]
fn stops_and_friction_on_one_coordinate_act_as_the_ones_by_hand() {
    let words = [
        ("base sticks", "stick"),
        ("base reverses", "reversal"),
        ("base slips", "slip"),
        ("left strikes", "impact"),
        ("right strikes", "impact"),
        ("left opens", "leave"),
        ("right opens", "leave"),
        ("rest", "rest"),
    ];
    for e in [0.0, 0.5, 1.0] {
        for mut runs in pair(["coulomb_oscillator", "hand_coulomb"], |mass| {
            for (name, value) in [("static_friction", 0.15), ("stop", 0.8), ("e", e)] {
                mass.set_parameter(name, value).unwrap();
            }
            mass.set_input("force", Sine::new(1.4, 0.6, PI / 5.0).into())
                .unwrap();
            mass.set_tolerance(1e-12);
            mass.end.time = 60.0;
        }) {
            assert!(runs[0].events.len() > 20);
            if e == 0.0 {
                // By hand, the mass that a stop has caught is said to slide away from it, and reverses at once.
                let hand = &mut runs[1].events;
                let caught: Vec<f64> = hand
                    .iter()
                    .filter(|e| e.transition == "impact")
                    .map(|e| e.t)
                    .collect();
                hand.retain(|event| event.transition != "reversal" || !caught.contains(&event.t));
            }
            assert_same_motion(&runs, &words, 1e-9);
        }
    }
}

/// A block on a table that shakes in both directions: what the record must satisfy at each instant.
#[test]
fn a_block_that_hops_with_friction_keeps_the_laws_of_contact() {
    for method in METHODS {
        for (e, mu_s, mu_k) in [
            (0.0, 0.5, 0.4),
            (0.3, 0.5, 0.4),
            (0.6, 0.2, 0.2),
            (0.3, 0.0, 0.0),
        ] {
            let mut block = problem(
                "contact_hopper",
                &[("e", e), ("mu_s", mu_s), ("mu_k", mu_k)],
            );
            block.method = method;
            block
                .set_input("horizontal", Function::from(Sine::new(7.0, 5.0, 0.3)))
                .unwrap();
            block
                .set_input("vertical", Function::from(Sine::new(14.0, 9.0, 0.0)))
                .unwrap();
            block.set_initial("y", 0.05).unwrap();
            block.set_initial("x.rate", 0.5).unwrap();
            block.set_tolerance(1e-11);
            block.end.time = 10.0;
            let run = run(&block);
            let words = transitions(&run);
            println!("{method:?} e = {e}, mu = {mu_s}: {} events", words.len());
            for wanted in ["table strikes", "table opens"] {
                assert!(words.contains(&wanted), "no `{wanted}`: {words:?}");
            }
            for event in &run.events {
                let (before, after) = (&event.before, &event.after);
                assert!(
                    after.q[1] >= -1e-10,
                    "{} at {}: y = {}",
                    event.transition,
                    event.t,
                    after.q[1]
                );
                if event.transition == "table strikes" {
                    let push = after.v[1] - before.v[1];
                    let friction = after.v[0] - before.v[0];
                    assert!((after.v[1] + e * before.v[1]).abs() <= 1e-14);
                    assert!(push > 0.0, "{} at {}", event.transition, event.t);
                    // It slips against its friction impulse, which is the whole cone, or it sticks within it; up to the
                    // rounding of the rates.
                    let rounding = 2.0 * f64::EPSILON * (before.v[0].abs() + push);
                    match after.v[0] {
                        0.0 => assert!(friction.abs() <= mu_k * push + rounding),
                        slip => assert!((friction + slip.signum() * mu_k * push).abs() <= rounding),
                    }
                }
            }
            assert!(run.end.t == 10.0);
        }
    }
}

/// The same scene from behind: the block moves the other way, by the same bits.
#[test]
fn a_mirrored_scene_mirrors() {
    for method in METHODS {
        let [right, left] = [1.0, -1.0].map(|side| {
            let mut block = problem("contact_hopper", &[]);
            block.method = method;
            block
                .set_input("horizontal", Sine::new(side * 7.0, 5.0, 0.3).into())
                .unwrap();
            block
                .set_input("vertical", Sine::new(14.0, 9.0, 0.0).into())
                .unwrap();
            block.set_initial("y", 0.05).unwrap();
            block.set_initial("x.rate", side * 0.5).unwrap();
            block.end.time = 5.0;
            run(&block)
        });
        assert_eq!(transitions(&right), transitions(&left));
        for (a, b) in right.events.iter().zip(&left.events) {
            assert_eq!(
                (a.t, a.after.q[0], a.after.q[1]),
                (b.t, -b.after.q[0], b.after.q[1])
            );
            assert_eq!((a.after.v[0], a.after.v[1]), (-b.after.v[0], b.after.v[1]));
        }
    }
}
