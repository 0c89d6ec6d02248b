//! Outputs: values, extremes and limits against closed forms; the motion does not depend on them.

use crate::common::*;
use dalembert::hybrid::{Observed, OwnLimit, Problem, Simulator};
use dalembert::input::{Function, Sine};
use dalembert::record::{Peak, Recorded, Run};

fn record_outputs(problem: &mut Problem) {
    problem.record.columns = Recorded {
        outputs: true,
        ..Recorded::default()
    };
}

fn peak(run: &Run, name: &str) -> Peak {
    run.peak(name)
        .unwrap_or_else(|| panic!("`{name}` has a peak"))
}

fn close(found: f64, exact: f64, what: &str) {
    let error = (found - exact).abs();
    assert!(
        error <= 1e-12 * exact.abs(),
        "{what}: {found:.17} {exact:.17}"
    );
}

#[test]
fn the_head_of_a_ball_is_what_its_impacts_leave_of_it() {
    with_each_method(|| {
        let mut ball = problem("hand_ball", &[("e", 0.8)]);
        ball.set_initial("h", 1.0).unwrap();
        ball.end.time = 1.8;
        ball.record.every = Some(0.1);
        ball.add_output(
            "head",
            "mm",
            "h + h.rate^2 / (2 * g)",
            "height that it comes from",
        )
        .unwrap();
        ball.add_output("lost", "1", "1 - head", "").unwrap_err();
        record_outputs(&mut ball);
        let run = run(&ball);
        let impacts = times(&run, "impact").len() as i32;
        assert_eq!(impacts, 3);
        let head = peak(&run, "head");
        close(head.max, 1000.0, "at first");
        close(
            head.min,
            1000.0 * 0.64_f64.powi(impacts),
            "after the impacts",
        );
        // Both sides of an event, and every row.
        let event = &run.events[0];
        close(event.before.outputs[0], 1000.0, "before");
        close(event.after.outputs[0], 640.0, "after");
        let column = run.trajectory.column("head").unwrap();
        for (i, &t) in run.trajectory.t.iter().enumerate() {
            let so_far = run.events.iter().filter(|e| e.t < t).count() as i32;
            let exact = 1000.0 * 0.64_f64.powi(so_far);
            close(run.trajectory.row(i)[column], exact, &format!("at {t}"));
        }
    });
}

/// A free block rocks: the cosine of what is left to the balance is kept between landings, and its distance from that at
/// rest is multiplied by e² at each.
#[test]
fn the_edges_of_a_block_rise_as_high_as_its_energy_takes_them() {
    with_each_method(|| {
        let (alpha, e, theta): (f64, f64, f64) = (0.25, 0.9, 0.2);
        let mut block = problem("rocking_block", &[("alpha", alpha), ("e", e), ("R", 1.3)]);
        block.set_initial("theta", theta).unwrap();
        block.end.time = 4.0;
        tighten(&mut block, 0.1);
        record_outputs(&mut block);
        let run = run(&block);
        assert_eq!(transitions(&run)[..2], ["base strikes", "base strikes"]);
        let rest = alpha.cos();
        let next = alpha - (rest + e * e * ((alpha - theta).cos() - rest)).acos();
        let height = |theta: f64| 2.0 * 1.3 * alpha.sin() * theta.sin();
        let away = |theta: f64| 1.3 * ((alpha - theta).sin() - alpha.sin());
        let [rotation, left, right, x, y] = [
            "rotation",
            "left_edge",
            "right_edge",
            "centre_x",
            "centre_y",
        ]
        .map(|name| peak(&run, name));
        close(rotation.max, theta, "rotation to the left");
        close(rotation.min, -next, "rotation to the right");
        close(right.max, height(theta), "right edge");
        close(left.max, height(next), "left edge");
        // A landing is strictly beyond its crossing, on the dense output of the method.
        let below = height(peak(&run, "theta").min);
        for least in [left.min, right.min] {
            assert!((below..=0.0).contains(&least), "{least:e} {below:e}");
        }
        close(x.min, away(theta), "centre to the left");
        close(x.max, -away(next), "centre to the right");
        close(y.max, 1.3 * ((alpha - theta).cos() - rest), "rise");
        assert!(left.t_max > run.events[0].t && left.t_max < run.events[1].t);
    });
}

#[test]
fn a_belt_pulls_with_the_kinetic_friction_while_it_slips() {
    with_each_method(|| {
        let mut belt = problem("hand_belt", &[("belt", 1.0)]);
        belt.set_initial("x", 3.9).unwrap();
        belt.end.time = 30.0;
        record_outputs(&mut belt);
        let run = run(&belt);
        assert!(times(&run, "stick").len() > 1, "{:?}", transitions(&run));
        let friction = peak(&run, "friction");
        // It slips off where the spring reaches the static friction.
        let (least, most) = (-0.25 * 9.81, 0.4 * 9.81);
        assert!((friction.max - most).abs() < 1e-9 * most, "{friction:?}");
        assert!(
            (friction.min - least).abs() < 1e-9 * most || friction.min > 0.0,
            "{friction:?}"
        );
        let slip = run.events.iter().find(|e| e.transition == "slip").unwrap();
        let place = |name: &str| {
            run.layout
                .outputs
                .iter()
                .position(|q| q.name == name)
                .unwrap()
        };
        let after = slip.after.outputs[place("friction")];
        assert!((after - 0.25 * 9.81).abs() < 1e-12, "{after}");
        assert_eq!(slip.before.outputs[place("slip_rate")], 0.0);
    });
}

#[test]
fn the_height_of_a_ball_on_a_table_is_that_of_the_table() {
    with_each_method(|| {
        let omega = 5.0;
        let mut ball = problem("hand_table_ball", &[]);
        // −A ω² sin ωt, of a table that rises by A (sin ωt − ωt).
        ball.set_input(
            "table_acceleration",
            Function::from(Sine::new(-2.0, omega, 0.0)),
        )
        .unwrap();
        ball.end.time = 2.0;
        record_outputs(&mut ball);
        ball.record.every = Some(0.05);
        let run = run(&ball);
        assert!(run.events.is_empty(), "it never flies");
        let column = run.trajectory.column("height").unwrap();
        let exact = |t: f64| 2.0 / (omega * omega) * ((omega * t).sin() - omega * t);
        for (i, &t) in run.trajectory.t.iter().enumerate() {
            assert!(
                (run.trajectory.row(i)[column] - exact(t)).abs() < 1e-13,
                "at {t}"
            );
        }
        let height = peak(&run, "height");
        assert_eq!(height.max, 0.0);
        assert!((height.min - exact(2.0)).abs() < 1e-13);
    });
}

#[test]
fn a_formula_gives_what_the_model_gives() {
    let mut tank = problem("walking_tank", &[("mu_s", 0.5), ("mu_k", 0.45)]);
    tank.set_initial("theta", 0.02).unwrap();
    tank.set_input(
        "ground_acceleration",
        Function::from(Sine::new(4.0, 12.0, 0.3)),
    )
    .unwrap();
    tank.end.time = 0.5;
    tank.record.every = Some(0.01);
    record_outputs(&mut tank);
    let own = [
        ("own_rotation", "rad", "side * theta", "rotation"),
        (
            "own_shear",
            "1",
            "reaction.z_h / ((M_0 + M_S) * g)",
            "shear_ratio",
        ),
        (
            "own_x",
            "m",
            "x + side*R_0*(sin(alpha_0 - theta) - sin(alpha_0))",
            "centre_x",
        ),
        (
            "own_edge",
            "mm",
            "y + (1 - side) * (R_0 * sin(alpha_0)) * sin(theta)",
            "left_edge",
        ),
        ("twice", "rad", "2 * own_rotation", "rotation"),
    ];
    for (name, unit, formula, _) in own {
        tank.add_output(name, unit, formula, "").unwrap();
    }
    let run = run(&tank);
    assert!(run.events.len() > 5);
    let column = |name: &str| run.trajectory.column(name).unwrap();
    for (name, unit, _, of) in own {
        let (own, of) = (column(name), column(of));
        let factor = match (name, unit) {
            ("twice", _) => 2.0,
            (_, "mm") => 1e3,
            _ => 1.0,
        };
        let size = (0..run.trajectory.len()).map(|i| run.trajectory.row(i)[own].abs());
        let size = size.fold(0.0, f64::max);
        assert!(size > 0.0, "{name}");
        for i in 0..run.trajectory.len() {
            let row = run.trajectory.row(i);
            let error = (row[own] - factor * row[of]).abs();
            assert!(
                error <= 1e-14 * size,
                "{name} at {}: {error:e}",
                run.trajectory.t[i]
            );
        }
    }
}

#[test]
fn the_motion_does_not_depend_on_what_is_recorded_of_it() {
    let mut block = problem("rocking_block", &[]);
    block.set_initial("theta", 0.1).unwrap();
    block
        .set_input(
            "ground_acceleration",
            Function::from(Sine::new(2.0, 8.0, 0.0)),
        )
        .unwrap();
    block.end.time = 3.0;
    let plain = run(&block);
    record_outputs(&mut block);
    block.add_output("lean", "deg", "side * theta", "").unwrap();
    let observed = run(&block);
    assert_eq!(observed.solver, plain.solver);
    assert_eq!(observed.end.state.q, plain.end.state.q);
    let times = |run: &Run| run.events.iter().map(|e| e.t).collect::<Vec<_>>();
    assert_eq!(times(&observed), times(&plain));
    for (of, peak) in &plain.peaks {
        assert_eq!(observed.peaks[*of], (*of, *peak));
    }
}

#[test]
fn a_limit_over_an_output_is_reached_at_its_root() {
    with_each_method(|| {
        let mut ball = problem("hand_ball", &[]);
        ball.set_initial("h", 2.0).unwrap();
        ball.add_output("fallen", "cm", "h.rate^2 / (2 * g)", "")
            .unwrap();
        let of = Observed::Output(ball.output("fallen").unwrap());
        ball.limits.own = vec![OwnLimit {
            name: "half".into(),
            message: String::new(),
            of,
            above: true,
            level: 50.0,
            ends: true,
        }];
        let run = run(&ball);
        let [reached] = &run.reached.limit_states[..] else {
            panic!("{:?}", run.reached)
        };
        close(reached.t, (2.0 * 0.5 / 9.81_f64).sqrt(), "time");
        assert_eq!(run.end.t, reached.t);
        assert!(ball.output("fallne").is_err());
    });
}

#[test]
fn a_run_in_parts_has_outputs_at_every_instant() {
    let mut ball = problem("hand_ball", &[]);
    ball.set_initial("h", 1.0).unwrap();
    ball.add_output("fallen", "m", "h.rate^2 / (2 * g)", "")
        .unwrap();
    let mut simulator = Simulator::new(&ball).unwrap();
    simulator.advance_to(0.25).unwrap();
    let found = simulator.moment().output("fallen").unwrap();
    close(found, 0.5 * 9.81 * 0.25 * 0.25, "fallen");
    assert_eq!(simulator.moment().outputs(), [found]);
    assert_eq!(simulator.moment().output("h"), None);
}
