//! A run allocates as much for a thousand steps as for a hundred.
//!
//! This test binary is a program of its own because its allocator counts.

mod common;
use common::*;
use dalembert::hybrid::{Method, Problem, Simulator, simulate};
use dalembert::input::{Command, Function, Sine};
use dalembert::record::Silent;
use std::alloc::{GlobalAlloc, Layout, System as Heap};
use std::cell::Cell;

thread_local! {
    /// Allocations of this thread: tests run in several.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

fn count() {
    ALLOCATIONS.set(ALLOCATIONS.get() + 1);
}

// SAFETY: every call is handed on to the system's allocator as it is; counting touches no memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's obligations are those of the system's allocator.
        unsafe { Heap.alloc(layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as above; `pointer` came from the same allocator.
        unsafe { Heap.realloc(pointer, layout, size) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { Heap.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Allocations and steps of a run without events.
fn cost(problem: &Problem) -> (usize, u64) {
    let before = ALLOCATIONS.get();
    let run = simulate(problem, &mut Silent).unwrap();
    let allocations = ALLOCATIONS.get() - before;
    assert_eq!((run.failure, run.events.len()), (None, 0));
    (allocations, run.solver.steps)
}

/// Allocations must not depend on the number of steps.
fn check(mut problem: Problem, ends: [f64; 2]) {
    let [short, long] = ends.map(|end| {
        problem.end.time = end;
        cost(&problem)
    });
    assert!(long.1 > 4 * short.1, "{} and {} steps", short.1, long.1);
    assert_eq!(short.0, long.0, "for {} and {} steps", short.1, long.1);
}

#[test]
fn steps_of_a_smooth_motion_allocate_nothing() {
    let mut problem = problem("double_pendulum", &[]);
    problem.set_initial("theta_1", 2.0).unwrap();
    problem.set_initial("theta_2", 2.5).unwrap();
    check(problem, [1.0, 12.0]);
}

/// Of seven free coordinates the number is known when the program runs: what a step makes and drops is kept by the thread, and
/// was made in the first steps.
#[test]
fn steps_of_any_number_of_free_coordinates_allocate_nothing() {
    for method in [Method::Radau, Method::Taylor] {
        let mut problem = problem("link_chain", &[]);
        problem.method = method;
        problem.initial.q.fill(1.0);
        problem.end.time = 0.5;
        cost(&problem);
        check(problem, [0.5, 10.0]);
    }
}

#[test]
fn steps_with_guards_inputs_and_conditions_allocate_nothing() {
    // Friction enough to stick: guards with reactions are searched in every step.
    let mut problem = problem("walking_tank", &[("mu_s", 10.0), ("mu_k", 9.0)]);
    let shake = Sine::new(1.0, 44.0, 0.0);
    problem
        .set_input("ground_acceleration", Function::from(shake))
        .unwrap();
    check(problem, [0.2, 2.4]);
}

#[test]
fn samples_are_allocated_up_front() {
    let mut problem = problem("double_pendulum", &[]);
    problem.set_initial("theta_1", 2.0).unwrap();
    problem.record.columns.reactions = true;
    problem.record.columns.energies = true;
    problem.end.time = 3.0;
    let [few, many] = [0.1, 0.001].map(|every| {
        problem.record.every = Some(every);
        cost(&problem).0
    });
    assert_eq!(few, many);
}

#[test]
fn a_control_loop_allocates_nothing_once_it_runs() {
    let mut slider = problem("hand_coulomb", &[]);
    slider.set_input("force", Function::commanded(0.0)).unwrap();
    slider.end.time = 100.0;
    slider.record.event_states = false;
    slider.record.ledger = false;
    let mut simulator = Simulator::new(&slider).unwrap();
    let mut tick = 0;
    let mut drive = |ticks: i32| {
        let (before, transitions) = (ALLOCATIONS.get(), simulator.events().len());
        for _ in 0..ticks {
            tick += 1;
            let x = simulator.moment().q()[0];
            let force = (0.7 * f64::from(tick)).sin() - x;
            simulator.command("force", Command::Hold(force)).unwrap();
            simulator.advance_to(0.05 * f64::from(tick)).unwrap();
        }
        (
            ALLOCATIONS.get() - before,
            simulator.events().len() - transitions,
        )
    };
    drive(1000);
    let (allocations, transitions) = drive(500);
    assert!(transitions > 10, "{transitions} transitions");
    // The list of transitions is all that grows.
    assert!(allocations <= 2, "{allocations} allocations");
}
