//! Constraints on velocities, one-sided (ratchets) and two-sided (a blade), against closed forms.

use crate::common::*;
use dalembert::hybrid::{ImpactLaw, ImpactOrder, Method, Problem, simulate};
use dalembert::input::Sine;
use dalembert::model::models;
use dalembert::record::{Run, Silent};
use std::f64::consts::PI;

fn assert_near(found: &[f64], expected: &[f64], within: f64) {
    for (found, expected) in found.iter().zip(expected) {
        let off = (found - expected).abs();
        assert!(off <= within, "{found} for {expected}: {off:e}");
    }
}

/// What a motion may be off by within steps at the tightest tolerance: Radau's dense output is of a lower order than its steps.
fn within(method: Method) -> f64 {
    match method {
        Method::Radau => 5e-12,
        _ => 2e-14,
    }
}

fn columns<const N: usize>(run: &Run, names: [&str; N]) -> [usize; N] {
    names.map(|name| run.trajectory.column(name).expect("a column"))
}

/// A ratchet is free, or it pushes, and not both, at every sample.
fn check_complementarity(run: &Run, name: &str) {
    let [force, rate] = [".force", ".rate"].map(|of| columns(run, [&format!("{name}{of}")])[0]);
    for k in 0..run.trajectory.len() {
        let row = run.trajectory.row(k);
        assert!(row[force] >= 0.0 && row[rate] >= 0.0, "{k}: {row:?}");
        assert!(row[force] == 0.0 || row[rate] == 0.0, "{k}: {row:?}");
    }
}

fn pawl(parameters: &[(&str, f64)], x: f64) -> Problem {
    let mut problem = problem("pawl", parameters);
    problem.set_initial("x", x).unwrap();
    problem.set_tolerance(TIGHTEST);
    problem.end.time = 10.0;
    problem.record.every = Some(0.5);
    problem.record.columns.outputs = true;
    problem
}

#[test]
fn a_pawl_holds_the_mass_where_it_would_turn_round() {
    with_each_method(|| {
        let run = run(&pawl(&[], -1.0));
        assert_eq!(transitions(&run), ["pawl engages"]);
        assert_near(&[run.events[0].t], &[PI], 4e-15);
        assert_near(&[at_end(&run, "x")], &[1.0], 4.0 * f64::EPSILON);
        assert_eq!(at_end(&run, "x.rate"), 0.0);
        check_complementarity(&run, "pawl");
        let [force, impulse] = columns(&run, ["pawl.force", "pawl.impulse"]);
        for (k, &t) in run.trajectory.t.iter().enumerate() {
            let row = run.trajectory.row(k);
            let is_engaged = t > PI;
            let mode = &run.layout.modes.name(run.trajectory.mode[k]);
            let expected = if is_engaged { "engaged" } else { "free" };
            assert_eq!(*mode, format!("pawl {expected}"), "{t}");
            let held = if is_engaged { 1.0 } else { 0.0 };
            assert_near(&[row[force]], &[held], 4.0 * f64::EPSILON);
            assert_near(&[row[impulse]], &[held * (t - PI)], 1e-14);
        }
    });
}

#[test]
fn a_pawl_that_feeds_pushes_from_the_start_and_its_work_is_input() {
    with_each_method(|| {
        let mut problem = pawl(&[("feed", 0.2)], 0.0);
        problem.set_initial("x.rate", 0.2).unwrap();
        let run = run(&problem);
        assert_eq!(run.events, []);
        assert_near(&[at_end(&run, "x")], &[2.0], 1e-14);
        let energy = run.energy.as_ref().unwrap();
        assert_near(&[energy.input_work], &[2.0], 1e-13);
        assert_near(&[energy.imbalance()], &[0.0], 1e-13);
    });
}

#[test]
fn a_pawl_on_shaken_ground_pushes_or_is_free() {
    let found = std::cell::RefCell::new(Vec::<Run>::new());
    with_each_method(|| {
        let mut problem = pawl(&[("k", 1.0), ("feed", 0.02)], 0.0);
        let shaking = Sine::new(1.5, 9.0, 0.4);
        problem.set_input("shaking", shaking.into()).unwrap();
        problem.set_initial("x.rate", 0.3).unwrap();
        problem.set_tolerance(1e-13);
        problem.record.every = Some(0.01);
        let run = run(&problem);
        check_complementarity(&run, "pawl");
        let energy = run.energy.as_ref().unwrap();
        assert_near(&[energy.imbalance()], &[0.0], 3e-12);
        found.borrow_mut().push(run);
    });
    let [radau, taylor] = <[Run; 2]>::try_from(found.into_inner()).unwrap();
    assert!(radau.events.len() >= 6, "{}", radau.events.len());
    assert_eq!(transitions(&radau), transitions(&taylor));
    for (one, other) in radau.events.iter().zip(&taylor.events) {
        assert_near(&[one.t], &[other.t], 1e-10);
    }
}

#[test]
fn a_rate_below_that_of_a_ratchet_is_refused_or_projected() {
    let mut problem = pawl(&[], -1.0);
    problem.set_initial("x.rate", -0.1).unwrap();
    let reason = simulate(&problem, &mut Silent).unwrap_err().to_string();
    let says = "the rate of ratchet `pawl` is -1e-1 there; it must not be negative";
    assert!(reason.contains(says), "{reason}");
    problem.project = true;
    let run = crate::common::run(&problem);
    assert_eq!(&*run.subject.projected[0].0, "x.rate");
    assert_eq!(transitions(&run), ["pawl engages"]);
}

#[test]
fn a_pawl_holds_at_rest_what_it_can_push() {
    for (x, rests) in [(0.5, 0.5), (-0.5, 0.0)] {
        let mut problem = pawl(&[], x);
        problem.at_rest = true;
        let run = run(&problem);
        assert_eq!(run.events, []);
        assert_eq!(at_end(&run, "x.rate"), 0.0);
        assert_near(&[at_end(&run, "x")], &[rests], f64::MIN_POSITIVE);
    }
}

/// Three masses, of which the first is about to strike the second.
fn about_to_strike(rates: [f64; 3]) -> Problem {
    let mut problem = problem("one_way", &[]);
    problem.set_initial("x_0", -1.0).unwrap();
    for (k, rate) in rates.iter().enumerate() {
        problem.set_initial(&format!("x_{k}.rate"), *rate).unwrap();
    }
    problem.end.time = 1.0;
    problem.set_tolerance(TIGHTEST);
    problem
}

#[test]
fn an_overrunning_clutch_takes_part_in_an_impact_that_would_turn_it_round() {
    let (third, sixth) = (1.0 / 3.0, 1.0 / 6.0);
    let together = ImpactOrder::Together;
    let sequence = ImpactOrder::InSequence;
    let [engaged, free] = ["engaged", "free"].map(|of| format!("hit open, clutch {of}"));
    for (order, before, after, mode) in [
        // As one mass of 2 kg.
        (together, [2.0, 0.0, 0.0], [0.0, 1.0, 1.0], &engaged),
        // It engages within the impact.
        (
            together,
            [2.0, 0.0, 0.5],
            [sixth, 7.0 * sixth, 7.0 * sixth],
            &engaged,
        ),
        // It overruns.
        (together, [2.0, 0.0, 2.0], [0.5, 1.5, 2.0], &free),
        // It takes over after the impact.
        (sequence, [2.0, 0.0, 0.0], [0.5, 0.75, 0.75], &engaged),
        (sequence, [2.0, 0.0, 0.5], [0.5, 1.0, 1.0], &engaged),
        // It is struck while it turns at one speed.
        (together, [3.0, 1.0, 1.0], [1.0, 2.0, 2.0], &engaged),
    ] {
        for law in [ImpactLaw::Newton, ImpactLaw::Poisson] {
            with_each_method(|| {
                let mut problem = about_to_strike(before);
                problem.collisions.law = law;
                problem.collisions.order = order;
                let run = run(&problem);
                assert_eq!(transitions(&run), ["hit strikes"]);
                let rates = [0, 1, 2].map(|k| at_end(&run, &format!("x_{k}.rate")));
                let expected = match (law, order, before) {
                    // Compression to 5/6 of all; half of its impulse once more, which the clutch passes on.
                    (ImpactLaw::Poisson, ImpactOrder::Together, [_, _, 0.5]) => {
                        let all = 2.5 * third;
                        let more = 0.5 * (2.0 - all);
                        [all - more, all + more / 2.0, all + more / 2.0]
                    }
                    _ => after,
                };
                assert_near(&rates, &expected, 8.0 * f64::EPSILON);
                let at_end = &run.layout.modes.name(run.end.mode);
                assert_eq!(at_end, mode, "{order:?} {before:?}");
                let lost = run.events[0].energy.expect("an impact").lost;
                let energy = |v: [f64; 3]| v.iter().map(|v| v * v / 2.0).sum::<f64>();
                assert_near(&[lost], &[energy(before) - energy(rates)], 1e-14);
                assert!(lost > 0.0);
            });
        }
    }
}

#[test]
fn a_clutch_lets_go_where_its_driver_slows_down() {
    with_each_method(|| {
        let mut problem = problem("one_way", &[("k", 1.0)]);
        for (name, value) in [("x_0", -9.0), ("x_1", -1.0), ("x_2", 3.0)] {
            problem.set_initial(name, value).unwrap();
        }
        problem.set_tolerance(TIGHTEST);
        problem.end.time = 6.0;
        problem.record.every = Some(0.25);
        problem.record.columns.outputs = true;
        let run = run(&problem);
        // Both masses on the spring up to a quarter of a period; then each alone.
        let omega = 0.5_f64.sqrt();
        let release = PI / 2.0 / omega;
        assert_eq!(transitions(&run), ["clutch releases"]);
        assert_near(&[run.events[0].t], &[release], 8.0 * f64::EPSILON);
        check_complementarity(&run, "clutch");
        let [first, second] = columns(&run, ["x_1", "x_2"]);
        for (k, &t) in run.trajectory.t.iter().enumerate() {
            let row = run.trajectory.row(k);
            let after = t - release;
            let expected = match after < 0.0 {
                true => [-(omega * t).cos(), 4.0 - (omega * t).cos()],
                false => [omega * after.sin(), 4.0 + omega * after],
            };
            assert_near(
                &[row[first], row[second]],
                &expected,
                within(problem.method),
            );
        }
    });
}

#[test]
fn a_clutch_is_left_out_or_held_for_good() {
    let of = |option: &str| {
        let mut problem = about_to_strike([0.0, 1.0, 1.0]);
        problem.choose(&[("contacts.clutch", option)]).unwrap();
        problem.set_parameter("k", 1.0).unwrap();
        problem.end.time = 2.0;
        run(&problem)
    };
    let held = of("permanent");
    // It pulls too: both masses go on together.
    let omega = 0.5_f64.sqrt();
    let expected = [(2.0 * omega).cos(), (2.0 * omega).cos()];
    let rates = |run: &Run| ["x_1.rate", "x_2.rate"].map(|name| at_end(run, name));
    assert_near(&rates(&held), &expected, 1e-14);
    assert_near(&rates(&of("off")), &[2.0_f64.cos(), 1.0], 1e-14);
}

#[test]
fn a_ratchet_is_described_by_its_rate() {
    let model = models().find("one_way").unwrap();
    let clutch = &model.variants[0].contacts[1];
    assert_eq!((clutch.name, clutch.kind), ("clutch", "ratchet"));
    assert_eq!(clutch.gap, Some("(x_2.rate-x_1.rate)"));
    assert_eq!(*clutch.states, ["free", "engaged"]);
}

#[test]
fn a_sleigh_glides_as_chaplygin_says() {
    with_each_method(|| {
        let (m, inertia, a) = (1.5, 0.4, 0.3);
        let mut sleigh = problem("sleigh", &[("m", m), ("I", inertia), ("a", a)]);
        // It starts backwards, which does not last, and turns.
        let (v, omega) = (-0.8, 1.1);
        sleigh.set_initial("phi", 0.6).unwrap();
        for (name, rate) in [
            ("x", v * 0.6_f64.cos()),
            ("y", v * 0.6_f64.sin()),
            ("phi", omega),
        ] {
            sleigh.set_initial(&format!("{name}.rate"), rate).unwrap();
        }
        sleigh.project = true;
        sleigh.set_tolerance(TIGHTEST);
        sleigh.end.time = 8.0;
        sleigh.record.every = Some(0.1);
        sleigh.record.columns.outputs = true;
        let run = run(&sleigh);
        // v' = a ω², ω' = −m a v ω / (I + m a²).
        let ratio = (inertia + m * a * a) / m;
        let fastest = (v * v + ratio * omega * omega).sqrt();
        let (rate, phase) = (a * fastest / ratio, (v / fastest).atanh());
        let [x, y, phi, turns] = columns(&run, ["x.rate", "y.rate", "phi", "phi.rate"]);
        for (k, &t) in run.trajectory.t.iter().enumerate() {
            let row = run.trajectory.row(k);
            let (sin, cos) = row[phi].sin_cos();
            let sideways = row[y] * cos - row[x] * sin;
            assert!(sideways.abs() < 4.0 * f64::EPSILON, "{t}: {sideways:e}");
            let ahead = row[x] * cos + row[y] * sin;
            let at = rate * t + phase;
            let expected = [fastest * at.tanh(), fastest / ratio.sqrt() / at.cosh()];
            assert_near(&[ahead, row[turns]], &expected, within(sleigh.method));
        }
        let energy = run.energy.as_ref().unwrap();
        assert_near(&[energy.imbalance()], &[0.0], 1e-13);
    });
}

#[test]
fn of_two_slips_along_one_line_one_stops() {
    with_each_method(|| {
        let mut block = problem("two_belts", &[]);
        block.set_tolerance(TIGHTEST);
        block.end.time = 1.0;
        block.record.columns.outputs = true;
        let run = run(&block);
        // The belt pulls with 10 N, the weight with 5 N against it; then the belt holds against the weight.
        assert_eq!(transitions(&run), ["belt sticks"]);
        assert_near(&[run.events[0].t], &[0.2], 1e-16);
        let at_end = &run.layout.modes.name(run.end.mode);
        assert_eq!(at_end, "belt sticks, weight slides");
        assert_near(
            &[crate::common::at_end(&run, "x.rate")],
            &[1.0],
            f64::EPSILON,
        );
        let [belt, weight] = columns(&run, ["belt.friction", "weight.friction"]);
        let last = run.trajectory.row(run.trajectory.len() - 1);
        assert_near(&[last[belt], last[weight]], &[5.0, -5.0], 1e-14);
    });
}
