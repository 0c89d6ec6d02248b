//! Stacks: friction between bodies that move themselves, against references.

use super::multipliers::{check, scenes, sine};
use crate::common::*;
use dalembert::hybrid::{Method, Problem};
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
