//! Stacks: friction between bodies that move themselves, against references.

use super::multipliers::{check, scenes, sine};
use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::record::Run;
use serde_json::Value;

/// A problem of two blocks on a shaking table in a scene of a reference.
pub fn stack(scene: &Value) -> Problem {
    let given = &scene["parameters"];
    let [masses, bounds] = ["masses", "bounds"].map(|key| numbers(&given[key]));
    let stiffness: Vec<f64> = (given["K"].as_array().unwrap().iter())
        .flat_map(numbers)
        .collect();
    let mut stack = problem(
        "stacked_friction",
        &[
            ("m_1", masses[0]),
            ("m_2", masses[1]),
            ("bound_1", bounds[0]),
            ("bound_2", bounds[1]),
            ("k_11", stiffness[0]),
            ("k_12", stiffness[1]),
            ("k_22", stiffness[3]),
        ],
    );
    let motion = given["table_acceleration"][0].as_str().unwrap();
    stack.set_input("a_g", sine(motion)).unwrap();
    let [q, u] = ["q", "u"].map(|key| numbers(&scene["initial"][key]));
    for (i, name) in ["x_1", "x_2"].iter().enumerate() {
        stack.set_initial(name, q[i]).unwrap();
        stack.set_initial(&format!("{name}.rate"), u[i]).unwrap();
    }
    stack.set_tolerance(TIGHTEST);
    stack.end.time = number(&scene["t_end"]);
    stack.record.every = Some(0.1);
    stack
}

#[test]
fn a_block_on_a_block_on_a_shaking_table_sticks_and_slips() {
    for (_, scene) in scenes("15a_two_block_stack") {
        for method in [Method::Taylor, Method::Radau] {
            let mut stack = stack(&scene);
            stack.method = method;
            check(&scene, &run(&stack), 2, method);
        }
    }
}

/// More sets of contact states than are tried: a pivoting method finds them. Each slab slips when its own friction lets it.
#[test]
fn eight_slabs_slip_one_after_the_other_as_their_friction_says() {
    let g = 9.81;
    let mus = [0.40, 0.37, 0.34, 0.31, 0.28, 0.25, 0.22, 0.19];
    for order in [[0, 1, 2, 3, 4, 5, 6, 7], [3, 1, 0, 2, 7, 5, 6, 4]] {
        let mut stack = problem("slab_stack", &[]);
        for (k, &place) in order.iter().enumerate() {
            let name = format!("mu_{}", k + 1);
            stack.set_parameter(&name, mus[place]).unwrap();
        }
        // The acceleration of the table grows until all have slipped, and goes back.
        stack.set_input("a_g", sine("6 sin(5 t+0)")).unwrap();
        stack.set_tolerance(1e-12);
        stack.end.time = 2.0;
        stack.record.every = Some(0.01);
        stack.record.columns.outputs = true;
        let run = run(&stack);
        // The first slip is above the least friction of those below all others: what is on it goes along.
        let least = order.iter().map(|&place| mus[place]).fold(1.0, f64::min);
        let first = (least * g / 6.0).asin() / 5.0;
        assert!((run.events[0].t - first).abs() <= 1e-14);
        assert!(run.events.len() > 5, "{}", run.events.len());
        let forces: Vec<usize> = (1..=8)
            .map(|k| run.trajectory.column(&format!("below_{k}.friction")))
            .map(|column| column.expect("an output"))
            .collect();
        for row in 0..run.trajectory.t.len() {
            let values = run.trajectory.row(row);
            let n = run.layout.coordinates.len();
            let mut below = 0.0;
            for k in 0..8 {
                let slip = values[n + k] - below;
                below = values[n + k];
                let bound = mus[order[k]] * (8 - k) as f64 * g;
                let force = values[forces[k]];
                assert!(force.abs() <= bound * (1.0 + 1e-13), "{k}: {force} {bound}");
                if slip.abs() > 1e-12 {
                    assert!((force + slip.signum() * bound).abs() <= 1e-13 * bound);
                }
            }
        }
        let energy = run.energy.expect("a ledger");
        let imbalance = energy.final_ - energy.initial - energy.input_work + energy.dissipated;
        assert!(
            imbalance.abs() <= 1e-11 * energy.dissipated,
            "{imbalance:e}"
        );
    }
}

/// Blocks on each other, which also rock.
fn stacked(parameters: &[(&str, f64)]) -> Problem {
    let mut stack = problem("stacked_blocks", parameters);
    stack.set_initial("y_lower", 0.4).unwrap();
    stack.set_initial("y_upper", 1.3).unwrap();
    stack.set_tolerance(1e-13);
    stack.record.every = Some(0.01);
    stack.record.columns.outputs = true;
    stack
}

/// Columns of a run, and those of another one, are the same.
fn assert_columns(one: &Run, other: &Run, columns: &[[&str; 2]], within: f64) {
    for [a, b] in columns {
        let [i, j] = [(one, a), (other, b)].map(|(run, name)| {
            let column = run.trajectory.column(name);
            column.unwrap_or_else(|| panic!("{name}"))
        });
        for row in 0..one.trajectory.len() {
            let (x, y) = (one.trajectory.row(row)[i], other.trajectory.row(row)[j]);
            assert!((x - y).abs() <= within, "{a} in row {row}: {x} and {y}");
        }
    }
}

#[test]
fn blocks_on_each_other_that_slide_alone_are_those_of_a_model_without_tilts() {
    let (g, below, between) = (9.81, 0.2, 0.1);
    let friction = [
        ("mu_s_lower", below),
        ("mu_k_lower", below),
        ("mu_s_upper", between),
        ("mu_k_upper", between),
        ("m_lower", 3.0),
    ];
    for method in [Method::Taylor, Method::Radau] {
        let motion = || sine("4 sin(7 t+0.3)");
        let mut stack = stacked(&friction);
        stack.set_input("a_h", motion()).unwrap();
        let bounds = [("bound_1", below * 4.0 * g), ("bound_2", between * g)];
        let mut flat = problem("stacked_friction", &bounds);
        flat.set_input("a_g", motion()).unwrap();
        flat.set_tolerance(1e-13);
        flat.record.every = Some(0.01);
        for problem in [&mut stack, &mut flat] {
            problem.method = method;
            problem.end.time = 3.0;
        }
        let (stack, flat) = (run(&stack), run(&flat));
        let names = [["x_lower", "x_1"], ["x_upper", "x_2"]];
        assert_columns(&stack, &flat, &names, 1e-11);
        let slips = stack
            .events
            .iter()
            .filter(|e| e.transition.ends_with("sticks"));
        assert!(slips.count() >= 4);
    }
}

#[test]
fn a_block_on_one_that_stays_rocks_as_on_the_ground() {
    // The lower one is heavy, wide and does not slip.
    let of_lower = [
        ("m_lower", 1e3),
        ("b_lower", 4.0),
        ("mu_s_lower", 0.6),
        ("mu_k_lower", 0.6),
    ];
    let motion = || sine("5 sin(9 t+0)");
    let mut stack = stacked(&of_lower);
    stack.set_input("a_h", motion()).unwrap();
    let same = [
        ("b", 0.2),
        ("h", 0.5),
        ("m", 1.0),
        ("mu_s", 0.6),
        ("mu_k", 0.5),
    ];
    let mut block = problem("rigid_block", &same);
    block.set_initial("y", 0.5).unwrap();
    block.set_input("a_h", motion()).unwrap();
    block.set_tolerance(1e-13);
    block.record.every = Some(0.01);
    for problem in [&mut stack, &mut block] {
        problem.end.time = 2.0;
    }
    let (stack, block) = (run(&stack), run(&block));
    let strikes = |run: &Run| {
        let all = run.events.iter();
        all.filter(|event| event.transition.ends_with("strikes"))
            .count()
    };
    let counts = [&stack, &block].map(strikes);
    assert!(counts[0] >= 2 && counts[0] == counts[1], "{counts:?}");
    let names = [["theta_upper", "theta"], ["x_upper", "x"]];
    assert_columns(&stack, &block, &names, 1e-9);
}

#[test]
fn a_stack_that_rocks_and_slides_keeps_all_laws() {
    for (amplitude, e) in [(4.0, 0.0), (5.0, 0.0), (5.0, 0.2), (8.0, 0.0)] {
        let mut stack = stacked(&[("e_lower", e), ("e_upper", e)]);
        let motion = format!("{amplitude} sin(9 t+0)");
        stack.set_input("a_h", sine(&motion)).unwrap();
        stack.end.time = 1.5;
        let run = run(&stack);
        assert!(run.events.len() >= 10, "{}", run.events.len());
        let column = |name: &str| run.trajectory.column(name).expect("a column");
        let impulse = |of: &str| {
            let contacts = ["lower_left", "lower_right", "upper_left", "upper_right"];
            contacts.map(|contact| column(&format!("{contact}.{of}")))
        };
        let (gaps, normals) = (impulse("gap"), impulse("normal"));
        let pushes = impulse("normal_impulse");
        let rates = ["y_lower.rate", "y_upper.rate"].map(column);
        let first = run.trajectory.row(0);
        for (k, t) in run.trajectory.t.iter().enumerate() {
            let row = run.trajectory.row(k);
            for (gap, normal) in gaps.iter().zip(&normals) {
                assert!(row[*gap] > -1e-14 && row[*normal] > -1e-12);
                assert!(row[*normal].abs() < 1e-12 || row[*gap].abs() < 1e-14);
            }
            // What the ground pushes, less both weights, is the momentum upwards.
            let gained: f64 = rates.iter().map(|&i| row[i] - first[i]).sum();
            let pushed = row[pushes[0]] + row[pushes[1]] - 2.0 * 9.81 * t;
            // With restitution what the limit of an accumulation holds is not among the impulses.
            let within = 1e-9;
            assert!((gained - pushed).abs() < within, "{t}: {gained} {pushed}");
        }
        let energy = run.energy.as_ref().expect("a ledger");
        let turned_over = energy.initial + energy.dissipated + energy.lost_at_impacts;
        assert!(energy.imbalance().abs() < 1e-11 * turned_over, "{energy:?}");
        assert!(energy.lost_at_impacts > 0.0 && energy.dissipated >= 0.0);
    }
}
