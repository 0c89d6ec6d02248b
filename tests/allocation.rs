//! No memory is allocated while steps are made.
//!
//! This test binary is a program of its own because its allocator counts.

use dalembert::integrate::{Radau, System, Tolerances};
use nalgebra::Const;
use nalgebra::{SMatrix, SVector, matrix, vector};
use std::alloc::{GlobalAlloc, Layout, System as Heap};
use std::sync::atomic::{AtomicUsize, Ordering};

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: every call is handed on to the system's allocator as it is; counting touches no memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's obligations are those of the system's allocator.
        unsafe { Heap.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above; `pointer` came from the same allocator.
        unsafe { Heap.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Two masses on nonlinear springs.
struct Springs;

impl System<Const<2>> for Springs {
    fn residual(
        &mut self,
        t: f64,
        q: &SVector<f64, 2>,
        v: &SVector<f64, 2>,
        a: &SVector<f64, 2>,
        r: &mut SVector<f64, 2>,
    ) {
        let spring = 4.0 * (q[1] - q[0]) + (q[1] - q[0]).powi(3);
        r[0] = a[0] + 0.1 * v[0] - spring - t.sin();
        r[1] = a[1] + spring;
    }
    fn jacobian(
        &mut self,
        _t: f64,
        q: &SVector<f64, 2>,
        _v: &SVector<f64, 2>,
        _a: &SVector<f64, 2>,
        m: &mut SMatrix<f64, 2, 2>,
        c: &mut SMatrix<f64, 2, 2>,
        k: &mut SMatrix<f64, 2, 2>,
    ) {
        let slope = 4.0 + 3.0 * (q[1] - q[0]).powi(2);
        *m = SMatrix::identity();
        *c = matrix![0.1, 0.0; 0.0, 0.0];
        *k = matrix![slope, -slope; -slope, slope];
    }
}

#[test]
fn steps_restarts_and_dense_output_allocate_nothing() {
    let absolute = SVector::repeat(1e-8);
    let mut radau = Radau::<3, Const<2>>::new(&Tolerances::new(1e-8, absolute, absolute).unwrap());
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    let (q, v) = (vector![0.0, 1.0], vector![0.0, 0.0]);
    let mut a = SVector::zeros();
    Springs.acceleration(0.0, &q, &v, &mut a).unwrap();
    radau.restart(0.0, &q, &v, &a);
    for _ in 0..200 {
        let report = radau.step(&mut Springs, 1e3, 0.5).unwrap();
        radau.step_exactly(&mut Springs, 0.5 * report.h).unwrap();
        let state = *radau.state();
        radau.restart(state.t, &state.q, &state.v, &state.a);
        radau.suggest(report.h);
        radau.dense();
    }
    let allocations = ALLOCATIONS.load(Ordering::Relaxed) - before;
    // The test harness runs in another thread and allocates nothing while this one computes.
    assert_eq!(allocations, 0);
    assert!(radau.counters().steps > 100);
}
