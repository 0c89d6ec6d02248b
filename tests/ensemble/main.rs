//! Ensembles: each trajectory is what a single run gives, and independent of everything around it.

#[path = "../common/mod.rs"]
mod common;
mod contacts;
mod extremes;
mod members;

use common::{lifted_slider, numbers, problem, reference};
use dalembert::hybrid::{Ensemble, Member, Problem, Simulator};
use dalembert::input::{Function, Sine};
use dalembert::kernel::processor_level;
use dalembert::record::{Jump, Silent};

/// What a trajectory ends with.
#[derive(Debug, Clone, PartialEq)]
struct End {
    events: Vec<(&'static str, f64)>,
    /// Their numbers, and the modes that they lead from and to.
    numbers: Vec<[u64; 3]>,
    /// Coordinates, velocities, discrete states.
    state: Vec<f64>,
    failure: Option<String>,
    steps: u64,
    /// Matrices that were factorized: none is left over from the trajectory before.
    factorizations: u64,
}

/// The problems of the members: `count` variations of one, which `vary` makes of a number in [0, 1).
fn variations(like: &Problem, count: usize, vary: impl Fn(&mut Problem, f64)) -> Vec<Problem> {
    let variation = |i| {
        let mut own = like.clone();
        vary(&mut own, i as f64 / count as f64);
        own
    };
    (0..count).map(variation).collect()
}

fn numbers_of(jump: &Jump) -> [u64; 3] {
    [jump.j, jump.from as u64, jump.to as u64]
}

/// Each by itself.
fn alone(problems: &[Problem]) -> Vec<End> {
    let run = |problem: &Problem| {
        let mut simulator = Simulator::new(problem).unwrap();
        let failure = simulator.run(&mut Silent).err().map(|why| why.to_string());
        let events = simulator.events().iter().map(|e| (e.transition, e.t));
        End {
            events: events.collect(),
            numbers: simulator.events().iter().map(numbers_of).collect(),
            state: [simulator.q(), simulator.v(), simulator.discrete()].concat(),
            failure,
            steps: simulator.solver().steps,
            factorizations: simulator.solver().factorizations,
        }
    };
    problems.iter().map(run).collect()
}

/// All in lanes, at a level of the processor and on some threads.
fn together(problems: &[Problem], level: usize, threads: usize) -> Vec<End> {
    let ensemble = Ensemble::new(&problems[0]).unwrap().at_level(level);
    let members: Vec<_> = problems.iter().map(Member::from).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let extract = |_, finished: dalembert::hybrid::Finished| End {
        events: finished
            .events()
            .iter()
            .map(|e| (e.transition, e.t))
            .collect(),
        numbers: finished.events().iter().map(numbers_of).collect(),
        state: [finished.q(), finished.v(), finished.discrete()].concat(),
        failure: finished.failure.as_ref().map(|why| why.to_string()),
        steps: finished.steps(),
        factorizations: finished.solver().factorizations,
    };
    pool.build()
        .unwrap()
        .install(|| ensemble.run(&members, extract))
}

/// The largest difference of event times and states, relative to one; the transitions are the same.
fn difference(one: &[End], other: &[End]) -> f64 {
    let mut most = 0.0_f64;
    for (i, (one, other)) in one.iter().zip(other).enumerate() {
        let names = |end: &End| end.events.iter().map(|e| e.0).collect::<Vec<_>>();
        assert_eq!(names(one), names(other), "member {i}");
        assert_eq!(one.failure, other.failure, "member {i}");
        let times = one
            .events
            .iter()
            .zip(&other.events)
            .map(|(a, b)| (a.1, b.1));
        let states = one.state.iter().copied().zip(other.state.iter().copied());
        most = times
            .chain(states)
            .fold(most, |most, (a, b)| most.max((a - b).abs()));
    }
    most
}

fn set_size(problem: &mut Problem, tolerance: f64, q: f64, v: f64) {
    problem.set_tolerance(tolerance);
    problem.accuracy.q_absolute.fill(tolerance * q);
    problem.accuracy.v_absolute.fill(tolerance * v);
}

/// A rocking block on shaken ground: 28 impacts each.
fn shaken_blocks(tolerance: f64, count: usize) -> Vec<Problem> {
    let mut block = problem("rocking_block", &[("alpha", 0.25), ("R", 1.5), ("e", 0.85)]);
    block.set_initial("theta", 0.075).unwrap();
    let shake = Sine::new(-0.35 * 9.81, 3.0 * std::f64::consts::PI, 0.3);
    block
        .set_input("ground_acceleration", Function::from(shake))
        .unwrap();
    block.end.time = 10.0;
    set_size(&mut block, tolerance, 0.2, 0.5);
    variations(&block, count, |p, x| {
        p.set_parameter("R", 1.5 + 0.05 * x).unwrap()
    })
}

#[test]
fn each_trajectory_of_an_ensemble_is_a_single_run() {
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
        let blocks = shaken_blocks(tolerance, 37);
        let (alone, together) = (alone(&blocks), together(&blocks, processor_level(), 2));
        // The two take the same steps, with other roundings; the motion amplifies them a hundredfold.
        let difference = difference(&alone, &together);
        assert!(difference < 1e-12, "{tolerance:e}: {difference:e}");
        for (one, other) in alone.iter().zip(&together) {
            assert!(one.steps > 28 && one.steps == other.steps);
        }
    }
}

#[test]
fn members_with_more_free_coordinates_than_lanes_take_are_single_runs() {
    let mut masses = problem("spring_chain", &[]);
    masses.choose(&[("masses", "7")]).unwrap();
    masses.end.time = 3.0;
    let masses = variations(&masses, 5, |p, x| {
        p.set_parameter("k_3", 1e3 + 1e4 * x).unwrap()
    });
    let (alone, together) = (alone(&masses), together(&masses, processor_level(), 2));
    assert_eq!(alone, together);
    assert!(
        alone
            .iter()
            .all(|one| one.steps > 10 && !one.events.is_empty())
    );
}

#[test]
fn a_smooth_ensemble_is_within_its_tolerance_of_solutions_of_forty_digits() {
    // Driven pendulums, of which some nearly turn over: errors grow along their motion, at most so much.
    const AMPLIFICATION: f64 = 100.0;
    let reference = reference("forced_pendulum");
    let members = reference["members"].as_array().unwrap();
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
        let mut pendulum = problem("forced_pendulum", &[("g", 4.84)]);
        let drive = Sine::new(1.0, 3.0 * std::f64::consts::PI, 0.0);
        pendulum.set_input("moment", Function::from(drive)).unwrap();
        pendulum.end.time = 10.0;
        set_size(&mut pendulum, tolerance, 1.0, 1.0);
        let pendulums: Vec<_> = (members.iter())
            .map(|member| {
                let mut own = pendulum.clone();
                let start = numbers(&member["start"]);
                own.set_initial("theta", start[0]).unwrap();
                own.set_initial("theta.rate", start[1]).unwrap();
                own
            })
            .collect();
        let ends = together(&pendulums, processor_level(), 1);
        for (member, end) in members.iter().zip(&ends) {
            for (x, exact) in end.state.iter().zip(numbers(&member["end"])) {
                let error = (x - exact).abs();
                assert!(
                    error < AMPLIFICATION * tolerance,
                    "{tolerance:e}, {member}: {error:e}"
                );
            }
        }
        // They take the same steps alone, with other roundings.
        assert!(difference(&alone(&pendulums), &ends) < 1e-13);
        for level in 0..processor_level() {
            assert_eq!(together(&pendulums, level, 2), ends, "level {level}");
        }
    }
}

#[test]
fn accumulations_and_rest_are_those_of_single_runs() {
    // Free rocking dies out in an accumulation, in another mode, at times of its own for each.
    let mut block = problem("rocking_block", &[("alpha", 0.25), ("R", 1.5)]);
    block.end.time = 60.0;
    set_size(&mut block, 1e-9, 0.2, 0.5);
    let blocks = variations(&block, 29, |p, x| {
        p.set_parameter("e", 0.6 + 0.3 * x).unwrap();
        p.set_initial("theta", 0.02 + 0.2 * x).unwrap();
    });
    let ends = together(&blocks, processor_level(), 1);
    assert!(
        ends.iter()
            .all(|end| end.events.last().unwrap().0 == "rest")
    );
    // The limit of a series is known to the tolerance.
    assert!(difference(&alone(&blocks), &ends) < 1e-8);
}

/// Oscillators with dry friction, which come to rest or turn back where they stop: a condition decides which transition the fall
/// of one guard is.
fn dry_oscillators(tolerance: f64) -> Vec<Problem> {
    let friction = [("static_friction", 0.5), ("kinetic_friction", 0.3)];
    let mut oscillator = problem("hand_coulomb", &friction);
    oscillator.end.time = 40.0;
    set_size(&mut oscillator, tolerance, 1.0, 1.0);
    variations(&oscillator, 29, |p, x| {
        let force = Sine::new(0.9 + 0.4 * x, 0.45 + 0.2 * x, 0.0);
        p.set_input("force", Function::from(force)).unwrap();
    })
}

#[test]
fn falls_whose_transition_depends_on_conditions_are_those_of_single_runs() {
    for tolerance in [1e-6, 1e-10] {
        let oscillators = dry_oscillators(tolerance);
        let single = alone(&oscillators);
        for name in ["stick", "slip", "reversal"] {
            let happens = |end: &End| end.events.iter().any(|e| e.0 == name);
            assert!(single.iter().any(happens), "{name}");
        }
        let all = together(&oscillators, 0, 1);
        let found = difference(&single, &all);
        assert!(found < 1e-10, "{tolerance:e}: {found:e}");
        for level in 0..=processor_level() {
            assert_eq!(together(&oscillators, level, 2), all, "level {level}");
        }
    }
}

#[test]
fn modes_that_do_not_go_in_lanes_are_run_alone() {
    // Stick and slip: sticking is left when a force exceeds friction, which is no coordinate.
    let mut slider = problem("hand_slider", &[("k", 1.05e6), ("c", 642.0)]);
    let shake = Sine::new(20.0, 14.0 * std::f64::consts::PI, 0.0);
    slider
        .set_input("ground_acceleration", Function::from(shake))
        .unwrap();
    slider.end.time = 0.5;
    set_size(&mut slider, 1e-9, 1e-3, 0.1);
    let sliders = variations(&slider, 21, |p, x| {
        p.set_parameter("c", 642.0 + 100.0 * x).unwrap()
    });
    let ends = together(&sliders, processor_level(), 1);
    assert!(ends.iter().all(|end| end.events.len() > 5));
    assert!(difference(&alone(&sliders), &ends) < 1e-8);
}

#[test]
fn a_trajectory_has_the_same_bits_at_every_level_with_any_threads_and_neighbours() {
    let blocks = shaken_blocks(1e-6, 37);
    let all = together(&blocks, 0, 1);
    for level in 0..=processor_level() {
        for threads in [1, 2, 3] {
            assert_eq!(
                together(&blocks, level, threads),
                all,
                "level {level}, {threads} threads"
            );
        }
    }
    let mut reversed = blocks.clone();
    reversed[1..].reverse(); // the first one is the scene itself
    let mut ends = together(&reversed, processor_level(), 1);
    ends[1..].reverse();
    assert_eq!(ends, all);
}

#[test]
fn a_transition_that_ends_the_run_is_counted() {
    let mut blocks = shaken_blocks(1e-6, 13);
    for block in &mut blocks {
        block.end.after = Some(("base strikes", 5));
    }
    for end in together(&blocks, processor_level(), 1) {
        assert_eq!(end.events.len(), 5);
    }
}

/// A transition that a run counts is taken by the engine for single runs.
fn by_the_engine(problems: &[Problem], transition: &'static str) -> Vec<End> {
    let mut problems = problems.to_vec();
    for problem in &mut problems {
        problem.end.after = Some((transition, u64::MAX));
    }
    together(&problems, processor_level(), 1)
}

#[test]
fn transitions_in_lanes_are_those_of_the_engine_to_the_bit() {
    // An accumulation ends within the tolerances of the state or, of tiny ones, where its rest does not
    // advance the time.
    let sizes = [(1e-3, 1.0), (1e-9, 1.0), (1e-9, 1e-9)];
    let dying = sizes.map(|(tolerance, size)| {
        let mut block = problem("rocking_block", &[("alpha", 0.25), ("R", 1.5)]);
        block.end.time = 60.0;
        set_size(&mut block, tolerance, 0.2 * size, 0.5 * size);
        variations(&block, 29, |p, x| {
            p.set_parameter("e", 0.6 + 0.3 * x).unwrap();
            p.set_initial("theta", 0.02 + 0.2 * x).unwrap();
        })
    });
    let balls = sizes.map(|(tolerance, size)| {
        let mut ball = problem("hand_ball", &[]);
        ball.end.time = 40.0;
        set_size(&mut ball, tolerance, size, 4.4 * size);
        variations(&ball, 21, |p, x| {
            p.set_parameter("e", 0.1 + 0.8 * x).unwrap();
            p.set_initial("h", 1.0 + x).unwrap();
        })
    });
    let shaken = [1e-3, 1e-6, 1e-9, 1e-12].map(|tolerance| shaken_blocks(tolerance, 37));
    let blocks = shaken.iter().chain(&dying).map(|p| (p, "base strikes"));
    let balls = balls.iter().map(|p| (p, "impact"));
    let shuttles = shuttles();
    let shuttles = ["turn", "left", "right"].map(|name| (&shuttles, name));
    let pairs = pairs_of_balls();
    let pairs = ["impact_a", "impact_b"].map(|name| (&pairs, name));
    for (problems, name) in blocks.chain(balls).chain(shuttles).chain(pairs) {
        let ends = together(problems, processor_level(), 1);
        let happens = |end: &End| end.events.iter().any(|e| e.0 == name);
        assert!(ends.iter().any(happens), "{name}");
        assert_eq!(by_the_engine(problems, name), ends, "{name}");
    }
}

/// Masses that are pushed to and fro between walls of which one steps: guards with factors and offsets that
/// resets change.
fn shuttles() -> Vec<Problem> {
    let mut shuttle = problem("shuttle", &[]);
    let push = Function::from(Sine::new(4.0, 2.5, 0.4));
    shuttle.set_input("push", push).unwrap();
    shuttle.set_initial("x.rate", 2.0).unwrap();
    shuttle.set_initial("y", 0.5).unwrap();
    shuttle.end.time = 20.0;
    set_size(&mut shuttle, 1e-9, 1.0, 1.0);
    variations(&shuttle, 37, |p, x| {
        p.set_parameter("k", 1.0 + 5.0 * x).unwrap()
    })
}

/// Two balls each, dropped from heights of which one differs: accumulations of one while the other flies.
fn pairs_of_balls() -> Vec<Problem> {
    let mut balls = problem("two_balls", &[]);
    balls.set_initial("b", 1.0).unwrap();
    balls.end.time = 6.0;
    set_size(&mut balls, 1e-9, 1.0, 4.4);
    variations(&balls, 23, |p, x| {
        p.set_initial("a", 0.25 + 4.0 * x).unwrap();
    })
}

#[test]
fn rests_of_a_mode_that_has_several_are_those_of_single_runs() {
    let pairs = pairs_of_balls();
    let ends = together(&pairs, processor_level(), 1);
    for end in &ends {
        let rests = end.events.iter().filter(|e| e.0 == "rest").count();
        assert_eq!((rests, &end.state), (2, &vec![0.0; 4]), "{end:?}");
    }
    assert!(difference(&alone(&pairs), &ends) < 1e-8);
    for level in 0..processor_level() {
        assert_eq!(together(&pairs, level, 2), ends, "level {level}");
    }
}

#[test]
fn guards_that_resets_change_are_those_of_single_runs() {
    let shuttles = shuttles();
    let ends = together(&shuttles, processor_level(), 1);
    let at_once = |end: &End| end.events.windows(2).any(|pair| pair[0].1 == pair[1].1);
    assert!(ends.iter().any(at_once), "a wall steps behind a mass");
    assert!(ends.iter().any(|end| !at_once(end)));
    assert!(difference(&alone(&shuttles), &ends) < 1e-7);
    for level in 0..processor_level() {
        assert_eq!(together(&shuttles, level, 2), ends, "level {level}");
    }
}

#[test]
fn a_member_that_fails_says_why_and_leaves_the_others_alone() {
    // A block in strong gravity stays on the ground; in weak gravity the ground's motion lifts it off.
    let mut blocks = shaken_blocks(1e-6, 16);
    for (i, block) in blocks.iter_mut().enumerate().skip(1) {
        if i % 3 == 0 {
            block.set_initial("theta", 0.24).unwrap();
            block.set_initial("theta.rate", 3.0).unwrap();
        }
    }
    let (single, ends) = (alone(&blocks), together(&blocks, processor_level(), 1));
    for (i, (one, other)) in single.iter().zip(&ends).enumerate() {
        assert_eq!(one.failure.is_some(), other.failure.is_some(), "member {i}");
        assert_eq!(
            one.failure.is_some(),
            i > 0 && i % 3 == 0,
            "member {i}: {one:?}"
        );
    }
}

/// What is required fails within a step of some members, and holds again at its end: lanes hand that over.
#[test]
fn requirements_that_fail_within_a_step_are_seen_in_lanes() {
    for relative in [1e-3, 1e-9] {
        let lifted = |i: usize| match i % 4 {
            0 => lifted_slider(0.5, 9.99, relative),
            1 => lifted_slider(0.5, 10.01 + 0.01 * i as f64, relative),
            2 => lifted_slider(0.91, 5.0 - 0.1 * i as f64, relative),
            _ => lifted_slider(0.89, 5.0, relative),
        };
        let sliders: Vec<_> = (0..24).map(lifted).collect();
        let (single, ends) = (alone(&sliders), together(&sliders, processor_level(), 1));
        assert_eq!(single, ends);
        for (i, end) in single.iter().enumerate() {
            assert_eq!(
                end.failure.is_some(),
                (1..=2).contains(&(i % 4)),
                "member {i}"
            );
        }
    }
}

/// Thousands of steps of a linear motion are of a lower order than the last ones.
#[test]
fn oscillations_of_thousands_of_periods_are_those_of_single_runs() {
    let slider = |i: usize| {
        // So long a rope does not break, however wide the bounds of x.
        let parameters = [("k", 3e10 + 5e9 * i as f64), ("length", 1e9)];
        let mut slider = problem("lifted_slider", &parameters);
        slider.set_initial("x", 0.5).unwrap();
        slider.set_tolerance(1e-12);
        slider.end.time = 0.13;
        slider
    };
    let sliders: Vec<_> = (0..10).map(slider).collect();
    let single = alone(&sliders);
    assert_eq!(single, together(&sliders, processor_level(), 1));
    for (end, slider) in single.iter().zip(&sliders) {
        let omega = slider.parameters[1].sqrt();
        let exact = 0.5 * (omega * slider.end.time).cos();
        // Rounding of the phase, and a tolerance a radian.
        let bound = 1e-12 * omega * slider.end.time;
        assert!(
            end.failure.is_none() && (end.state[0] - exact).abs() < bound,
            "{end:?} {exact}"
        );
    }
}

/// The velocity is that of the load over 1e15 to 1e17 N s/m, below any tolerance, and turns back where the force is its own
/// rounding.
#[test]
fn a_motion_below_rounding_goes_through_in_lanes_as_alone() {
    let frictionless = [("static_friction", 0.0), ("kinetic_friction", 0.0)];
    let mut like = problem("coulomb_oscillator", &frictionless);
    let sine = Function::from(Sine::new(1.0, 0.2, 0.0));
    like.set_input("force", sine).unwrap();
    like.end.time = 120.0;
    for tolerance in [1e-7, 1e-10] {
        like.set_tolerance(tolerance);
        let problems = variations(&like, 24, |problem, part| {
            let c = 10f64.powf(15.0 + 2.0 * part);
            problem.set_parameter("c", c).unwrap();
            problem.initial.v[0] = part;
        });
        let alone = alone(&problems);
        for (i, end) in alone.iter().enumerate() {
            assert_eq!(end.failure, None, "member {i} at {tolerance:e}");
        }
        assert_eq!(alone, together(&problems, processor_level(), 1));
    }
}

/// Tanks that are let go from a tilt, and stick while they rock: friction and lift-off are guards that depend on forces.
fn released_tanks(tolerance: f64) -> Vec<Problem> {
    let mut tank = problem("walking_tank", &[]);
    tank.set_initial("theta", 0.02).unwrap();
    tank.set_initial("side", 1.0).unwrap();
    tank.end.time = 0.5;
    tank.set_tolerance(tolerance);
    variations(&tank, 19, |p, x| {
        p.set_initial("theta", 0.02 + 0.01 * x).unwrap();
        p.set_tolerance(tolerance);
    })
}

#[test]
fn guards_that_are_forces_are_followed_in_lanes() {
    for tolerance in [1e-6, 1e-10] {
        let tanks = released_tanks(tolerance);
        let (single, all) = (alone(&tanks), together(&tanks, 0, 1));
        for (one, other) in single.iter().zip(&all) {
            assert_eq!(one.failure, None);
            assert!(one.events.len() > 3 && one.steps == other.steps);
        }
        let found = difference(&single, &all);
        assert!(found < 1e-10, "{tolerance:e}: {found:e}");
        for level in 0..=processor_level() {
            assert_eq!(together(&tanks, level, 2), all, "level {level}");
        }
    }
}
