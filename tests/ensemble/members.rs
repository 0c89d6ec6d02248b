//! What members differ in: initial states, inputs, tolerances.

use super::common::problem;
use super::{alone, difference, set_size, shaken_blocks, together, variations};
use dalembert::hybrid::Initial;
use dalembert::input::{Function, Interpolation, Outside, Side, Sine, Table};
use dalembert::kernel::processor_level;

#[test]
fn members_start_where_their_initial_state_says() {
    let initial = |h: f64| Initial {
        q: vec![h],
        v: vec![0.0],
        discrete: vec![],
        mode: None,
    };
    let mut ball = problem("hand_ball", &[]);
    ball.initial = initial(1.0);
    ball.end.time = 1.0;
    set_size(&mut ball, 1e-9, 1.0, 4.4);
    let g = ball.parameters[ball
        .model
        .parameters
        .iter()
        .position(|p| p.name == "g")
        .unwrap()];
    let balls = variations(&ball, 11, |p, x| p.initial = initial(1.0 + x));
    for (end, ball) in together(&balls, processor_level(), 1).iter().zip(&balls) {
        let fall = (2.0 * ball.initial.q[0] / g).sqrt();
        assert!(
            (end.events[0].1 - fall).abs() < 4e-16,
            "{} {fall}",
            end.events[0].1
        );
    }
}

/// Blocks under a record whose lines have a kink every hundredth of a second: lanes go on across it, to the same bits on every
/// level and with any threads, and to what single runs give.
#[test]
fn kinks_of_a_record_are_passed_in_lanes() {
    let times: Vec<f64> = (0..1001).map(|i| 0.01 * f64::from(i)).collect();
    let shake = |t: &f64| -3.4 * (3.0 * std::f64::consts::PI * t + 0.3).sin();
    let values: Vec<f64> = times.iter().map(shake).collect();
    let mut problems = shaken_blocks(1e-10, 16);
    for problem in &mut problems {
        let table = Table::new(&times, &values, Interpolation::Linear, Outside::Zero);
        problem
            .set_input("ground_acceleration", table.unwrap().into())
            .unwrap();
    }
    let single = alone(&problems);
    assert!(
        single
            .iter()
            .all(|end| end.steps > 1000 && end.failure.is_none())
    );
    let all = together(&problems, 0, 1);
    let found = difference(&all, &single);
    assert!(found < 1e-9, "{found:e}");
    for level in 0..=processor_level() {
        assert_eq!(together(&problems, level, 2), all, "level {level}");
    }
}

/// Blocks that are shaken by sines of their own, by records of their own, and some like the scene: what a member gives depends on
/// its own input alone.
#[test]
fn members_have_inputs_of_their_own() {
    let mut problems = shaken_blocks(1e-10, 21);
    for (i, problem) in problems.iter_mut().enumerate() {
        let x = i as f64 / 21.0;
        let shake = Sine::new(-3.4 - x, (3.0 - 0.5 * x) * std::f64::consts::PI, 0.3);
        let input: Function = match i % 3 {
            0 => continue,
            1 => shake.into(),
            _ => {
                let times: Vec<f64> = (0..900).map(|i| (0.01 + 1e-3 * x) * f64::from(i)).collect();
                let value = |t: &f64| Function::from(shake.clone()).at(*t, Side::Right).value;
                let values: Vec<f64> = times.iter().map(value).collect();
                let table = Table::new(&times, &values, Interpolation::Linear, Outside::Zero);
                table.unwrap().into()
            }
        };
        problem.set_input("ground_acceleration", input).unwrap();
    }
    let single = alone(&problems);
    assert!(single.iter().all(|end| end.failure.is_none()));
    let all = together(&problems, 0, 1);
    let found = difference(&all, &single);
    assert!(found < 1e-9, "{found:e}");
    for level in 0..=processor_level() {
        for threads in [1, 2] {
            assert_eq!(together(&problems, level, threads), all, "level {level}");
        }
    }
    let mut reversed = problems.clone();
    reversed[1..].reverse(); // the first one is the scene itself
    let mut ends = together(&reversed, processor_level(), 1);
    ends[1..].reverse();
    assert_eq!(ends, all);
}

#[test]
fn a_scene_that_is_never_shaken_has_no_members_that_are() {
    let shaken = &shaken_blocks(1e-9, 1)[0];
    let mut still = shaken.clone();
    let input = "ground_acceleration";
    still.set_input(input, Function::zero()).unwrap();
    let ends = together(&[still.clone(), shaken.clone()], processor_level(), 1);
    assert_eq!(ends[0].failure, None);
    let why = ends[1].failure.as_deref().unwrap();
    assert!(
        why.contains("acts in a member of the ensemble and not in its scene"),
        "{why}"
    );
    // The other way round the input of the member is zero.
    let ends = together(&[shaken.clone(), still.clone()], processor_level(), 1);
    // It comes to rest, at the limit of a series, which is known to the tolerance.
    assert!(difference(&ends[1..], &alone(&[still])) < 1e-8);
}

/// Each takes the steps that its own absolute tolerances ask for, and those of all events are its own, too.
#[test]
fn members_have_tolerances_of_their_own() {
    let mut problems = shaken_blocks(1e-6, 21);
    for (i, problem) in problems.iter_mut().enumerate() {
        let size = 10_f64.powi(i as i32 % 7 - 3);
        set_size(problem, 1e-6, 0.2 * size, 0.5 * size);
    }
    let single = alone(&problems);
    let steps = |i: usize| single[i].steps;
    assert!(steps(0) > steps(6) + 10, "{} {}", steps(0), steps(6));
    let all = together(&problems, 0, 1);
    for (one, other) in single.iter().zip(&all) {
        assert_eq!(one.steps, other.steps);
    }
    assert!(difference(&all, &single) < 1e-10);
    for level in 0..=processor_level() {
        assert_eq!(together(&problems, level, 2), all, "level {level}");
    }
}

#[test]
fn a_member_of_another_relative_tolerance_is_refused() {
    let mut problems = shaken_blocks(1e-6, 3);
    problems[2].set_tolerance(1e-8);
    let ends = together(&problems, processor_level(), 1);
    assert!(ends[1].failure.is_none());
    let why = ends[2].failure.as_deref().unwrap();
    assert!(
        why.contains("relative tolerance 1e-8, and its scene 1e-6"),
        "{why}"
    );
}
