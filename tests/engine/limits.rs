//! Limit states: found at their instants, and a run ends there or goes on.

use crate::common::*;
use dalembert::hybrid::{
    AtLimit, Ensemble, Member, Method, Observed, OwnLimit, Problem, Simulator, simulate,
};
use dalembert::input::Function;
use dalembert::precision::estimate;
use dalembert::record::{LimitState, Silent};
use std::f64::consts::FRAC_PI_2;

const METHODS: [Method; 3] = [Method::Auto, Method::Taylor, Method::Radau];

/// A block released at rest beyond its balance: it falls over without leaving the ground.
fn falling(theta: f64) -> Problem {
    let mut block = problem("rocking_block", &[]);
    block.set_initial("theta", theta).unwrap();
    block.end.time = 10.0;
    block
}

/// When the block that is released at `theta` has turned to `to` (rad), s: θ'² = 2p² (cos φ₀ − cos φ) with φ = θ − α
/// and p² = 3g/4R. With s = sin(φ/2) = s₀ cosh u, t = ∫ du/(p √(1 − s²)), by Simpson's rule.
fn time_of_fall(theta: f64, to: f64) -> f64 {
    let (alpha, p) = (0.25, (0.75 * 9.81_f64).sqrt());
    let half = |theta: f64| (0.5 * (theta - alpha)).sin();
    let (s0, s1) = (half(theta), half(to));
    let last = (s1 / s0).acosh();
    let panels = 2000;
    let h = last / (2 * panels) as f64;
    let f = |i: usize| 1.0 / (1.0 - (s0 * (i as f64 * h).cosh()).powi(2)).sqrt();
    let sum: f64 = (0..panels)
        .map(|k| f(2 * k) + 4.0 * f(2 * k + 1) + f(2 * k + 2))
        .sum();
    sum * h / 3.0 / p
}

/// The names and times of what was reached.
fn reached(states: &[LimitState]) -> Vec<(&str, f64)> {
    states.iter().map(|s| (s.name.as_str(), s.t)).collect()
}

#[test]
fn a_block_that_falls_over_ends_where_its_side_reaches_the_ground() {
    let exact = time_of_fall(0.3, FRAC_PI_2);
    for method in METHODS {
        for (relative, allowed) in [(1e-4, 1e-3), (1e-8, 1e-7), (1e-13, 1e-11)] {
            let mut block = falling(0.3);
            block.method = method;
            block.set_tolerance(relative);
            let run = run(&block);
            let [("past_balance", 0.0), ("overturned", t)] = reached(&run.reached.limit_states)[..]
            else {
                panic!("{:?}", run.reached)
            };
            let what = format!("{method:?}, {relative:e}");
            assert!((t - exact).abs() < allowed, "{what}: {:e}", t - exact);
            assert_eq!(run.end.t, t, "{what}: it ends there");
            let beyond = run.end.state.q[0] - FRAC_PI_2;
            assert!((0.0..1e-14).contains(&beyond), "{what}: {beyond:e}");
            assert!(run.trajectory.t.iter().all(|&row| row <= t), "{what}");
            // The same by a problem that is run again and again.
            let mut simulator = Simulator::new(&block).unwrap();
            for _ in 0..2 {
                simulator.run(&mut Silent).unwrap();
                assert_eq!(simulator.time(), t, "{what}");
                assert_eq!(simulator.reached(), run.reached, "{what}");
            }
        }
    }
}

#[test]
fn a_run_goes_on_past_a_limit_if_it_is_told_to() {
    for method in METHODS {
        let mut block = falling(0.3);
        block.method = method;
        let ended = run(&block);
        block.set_limit("overturned", AtLimit::Continue).unwrap();
        block.end.time = ended.end.t + 0.1;
        let run = run(&block);
        assert_eq!(run.end.t, block.end.time);
        let times = [&ended, &run].map(|run| run.reached.limit_states[1].t);
        assert!((times[0] - times[1]).abs() < 1e-8, "{times:?}");
        assert!(!run.reached.limit_states[1].ends);
    }
    assert!(
        falling(0.3)
            .set_limit("drowned", AtLimit::Continue)
            .is_err()
    );
}

#[test]
fn a_limit_that_is_ignored_is_not_told_and_changes_nothing() {
    for method in METHODS {
        let mut block = falling(0.3);
        block.method = method;
        for limit in ["past_balance", "overturned"] {
            block.set_limit(limit, AtLimit::Continue).unwrap();
        }
        block.end.time = 2.0;
        let watched = run(&block);
        assert_eq!(watched.reached.limit_states.len(), 2);
        block.set_limit("past_balance", AtLimit::Ignore).unwrap();
        let one = run(&block);
        assert_eq!(reached(&one.reached.limit_states).len(), 1);
        block.set_limit("overturned", AtLimit::Ignore).unwrap();
        let none = run(&block);
        assert!(none.reached.limit_states.is_empty());
        assert_eq!(none.end, watched.end, "{method:?}");
    }
}

#[test]
fn a_limit_that_does_not_end_a_run_may_be_told_to() {
    let mut block = falling(0.2);
    block.set_initial("theta.rate", 0.5).unwrap();
    block.set_limit("past_balance", AtLimit::End).unwrap();
    for method in METHODS {
        block.method = method;
        let run = run(&block);
        assert_eq!(
            reached(&run.reached.limit_states),
            [("past_balance", run.end.t)]
        );
        let beyond = run.end.state.q[0] - 0.25;
        assert!((0.0..1e-14).contains(&beyond), "{method:?}: {beyond:e}");
    }
}

/// A block on ground that is accelerated against its fall: it passes its balance and comes back.
#[test]
fn the_first_passage_of_the_balance_is_told_from_overturning() {
    let mut block = falling(0.2);
    block.set_initial("theta.rate", 0.35).unwrap();
    let against = Function::constant(-1.0);
    block.set_input("ground_acceleration", against).unwrap();
    block.end.after = Some(("base strikes", 1));
    let mut times = Vec::new();
    for method in METHODS {
        block.method = method;
        let run = run(&block);
        let [("past_balance", t)] = reached(&run.reached.limit_states)[..] else {
            panic!("{method:?}: {:?}", run.reached)
        };
        assert_eq!(transitions(&run), ["base strikes"], "it comes back");
        times.push(t);
    }
    assert!(
        times.iter().all(|t| (t - times[0]).abs() < 1e-7),
        "{times:?}"
    );
}

/// Runs that end at a limit end at times of their own.
#[test]
fn an_estimate_of_the_error_compares_the_times_of_limits() {
    let exact = time_of_fall(0.3, FRAC_PI_2);
    let mut block = falling(0.3);
    block.set_tolerance(1e-4);
    let run = run(&block);
    let estimated = estimate(&block, &run, &mut Silent).unwrap();
    let error = (run.end.t - exact).abs();
    let ratio = estimated.event_time / error;
    assert!((0.5..2.0).contains(&ratio), "{ratio}, {error:e}");
    assert_eq!((estimated.missed, estimated.extra), (0, 0));
}

/// A limit of a problem.
fn limit(of: Observed, above: bool, level: f64) -> OwnLimit {
    OwnLimit {
        name: "own".into(),
        message: "reached".into(),
        of,
        above,
        level,
        ends: true,
    }
}

#[test]
fn limits_of_coordinates_rates_and_reactions_are_found_at_their_roots() {
    let ball = |of, above, level: f64| {
        let mut ball = problem("hand_ball", &[("e", 0.5)]);
        ball.set_initial("h", 1.0).unwrap();
        ball.limits.own = vec![limit(of, above, level)];
        ball
    };
    let slider = || {
        let mut slider = lifted_slider(0.5, 9.0, 1e-9);
        slider.limits.own = vec![limit(Observed::Reaction(1), false, 4.0)];
        slider
    };
    let g = 9.81_f64;
    let impact = (2.0 / g).sqrt();
    let cases = [
        (ball(Observed::Coordinate(0), false, 0.5), (1.0 / g).sqrt()),
        (ball(Observed::Rate(0), false, -2.0), 2.0 / g),
        // By the jump at an impact, of √(2 g) to half of it.
        (ball(Observed::Rate(0), true, 1.0), impact),
        // N = 10 − 9 sin 3t.
        (slider(), (6.0_f64 / 9.0).asin() / 3.0),
    ];
    for (case, (problem, exact)) in cases.iter().enumerate() {
        for method in METHODS {
            let mut problem = problem.clone();
            problem.method = method;
            let run = run(&problem);
            let what = format!("{case}, {method:?}");
            assert_eq!(
                reached(&run.reached.limit_states),
                [("own", run.end.t)],
                "{what}"
            );
            assert!(
                (run.end.t - exact).abs() < 1e-9,
                "{what}: {:e}",
                run.end.t - exact
            );
        }
    }
}

#[test]
fn a_limit_that_holds_at_the_start_is_reached_there_and_its_level_is_not_beyond() {
    let mut ball = problem("hand_ball", &[]);
    ball.set_initial("h", 1.0).unwrap();
    ball.limits.own = vec![limit(Observed::Coordinate(0), true, 0.5)];
    let above = run(&ball);
    assert_eq!((above.end.t, above.reached.limit_states[0].t), (0.0, 0.0));
    // It starts at the level and falls; after the impact it stays below.
    ball.limits.own[0].level = 1.0;
    let at = run(&ball);
    assert_eq!((at.end.t, at.reached.limit_states.len()), (1.0, 0));
    // A ball that lies on the floor is not above it.
    ball.initial.q[0] = 0.0;
    ball.limits.own[0].level = 0.0;
    assert_eq!(run(&ball).reached.limit_states, []);
}

/// Blocks that are thrown towards their balances: those that reach a limit end there, at the instant at which a single
/// run ends.
#[test]
fn a_member_of_an_ensemble_ends_where_its_single_run_does() {
    let mut scene = problem("rocking_block", &[]);
    scene.set_initial("theta", 0.14).unwrap();
    scene.set_initial("theta.rate", 0.3).unwrap();
    scene.end.time = 4.0;
    scene.method = Method::Taylor;
    // Of those that fall over some would leave the ground.
    scene.set_limit("past_balance", AtLimit::End).unwrap();
    let alphas: Vec<f64> = (0..37).map(|i| 0.15 + 0.005 * f64::from(i)).collect();
    let members: Vec<Problem> = (alphas.iter())
        .map(|&alpha| {
            let mut member = scene.clone();
            member.set_parameter("alpha", alpha).unwrap();
            member
        })
        .collect();
    for own in [false, true] {
        let mut scene = scene.clone();
        if own {
            scene.limits.own = vec![limit(Observed::Coordinate(0), true, 0.2)];
        }
        let ensemble = Ensemble::new(&scene).unwrap();
        let take = |_: usize, finished: dalembert::hybrid::Finished| {
            assert_eq!(finished.failure, None);
            (finished.time(), finished.reached())
        };
        let members: Vec<Problem> = (members.iter().cloned())
            .map(|member| Problem {
                limits: scene.limits.clone(),
                ..member
            })
            .collect();
        let all: Vec<Member> = members.iter().map(Member::from).collect();
        let together = ensemble.run(&all, take);
        let mut ended = 0;
        for (member, (time, reached)) in members.iter().zip(&together) {
            // Alone it has the same bits.
            assert_eq!(
                ensemble.run(&[Member::from(member)], take),
                [(*time, reached.clone())]
            );
            let single = simulate(member, &mut Silent).unwrap();
            assert_eq!(single.failure, None);
            let names =
                |states: &[LimitState]| states.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
            assert_eq!(
                names(&reached.limit_states),
                names(&single.reached.limit_states)
            );
            for (one, other) in reached
                .limit_states
                .iter()
                .zip(&single.reached.limit_states)
            {
                assert!((one.t - other.t).abs() < 1e-6, "{one:?} {other:?}");
            }
            ended += usize::from(*time < 4.0);
        }
        println!("{ended} of {} end at a limit", members.len());
        assert!(0 < ended && ended < members.len(), "{ended}");
    }
}
