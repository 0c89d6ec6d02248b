//! The problems of `problems.hpp`, through the table of `problems.cpp`: the only unsafe code.

use std::cell::Cell;
use std::ffi::{CStr, c_char, c_int};

/// As many as `problems.cpp` lists.
const COUNT: usize = 8;

/// A row of the table. The functions read and write `states` numbers in `y` and `f`, its square in `j`,
/// and `guards` in `g`.
#[repr(C)]
struct Table {
    name: *const c_char,
    states: c_int,
    guards: c_int,
    end: f64,
    scales: *const f64,
    start: unsafe extern "C" fn(*mut f64, f64),
    rhs: unsafe extern "C" fn(f64, *const f64, *mut f64),
    jacobian: unsafe extern "C" fn(f64, *const f64, *mut f64),
    values: unsafe extern "C" fn(f64, *const f64, *mut f64),
    event: unsafe extern "C" fn(f64, *mut f64, c_int) -> bool,
}

unsafe extern "C" {
    static peers_problems: [Table; COUNT];
}

/// A hybrid automaton. There is one instance of each problem, so that only one run at a time may use it.
pub struct Problem {
    table: &'static Table,
    /// Calls of [`Self::rhs`] since the last start.
    pub rhs_calls: Cell<u64>,
    /// Calls of [`Self::jacobian`] since the last start.
    pub jacobian_calls: Cell<u64>,
}

impl Problem {
    /// All problems.
    pub fn all() -> impl Iterator<Item = Problem> {
        // SAFETY: the table is constant and has COUNT rows.
        let tables: &'static [Table; COUNT] = unsafe { &peers_problems };
        tables.iter().map(|table| Problem {
            table,
            rhs_calls: Cell::new(0),
            jacobian_calls: Cell::new(0),
        })
    }

    pub fn name(&self) -> &'static str {
        // SAFETY: names are literals.
        unsafe { CStr::from_ptr(self.table.name) }
            .to_str()
            .expect("names are ASCII")
    }

    /// Number of components of the state.
    pub fn states(&self) -> usize {
        self.table.states as usize
    }

    /// Number of guards.
    pub fn guards(&self) -> usize {
        self.table.guards as usize
    }

    /// Where a run ends at the latest, s.
    pub fn end(&self) -> f64 {
        self.table.end
    }

    /// Absolute tolerances: `tolerance` times the scales.
    pub fn absolute(&self, tolerance: f64) -> Vec<f64> {
        // SAFETY: a scale for each component.
        let scales = unsafe { std::slice::from_raw_parts(self.table.scales, self.states()) };
        scales.iter().map(|scale| scale * tolerance).collect()
    }

    /// Begins anew.
    pub fn start(&self, y: &mut [f64], tolerance: f64) {
        assert_eq!(y.len(), self.states());
        self.rhs_calls.set(0);
        self.jacobian_calls.set(0);
        // SAFETY: the length was checked.
        unsafe { (self.table.start)(y.as_mut_ptr(), tolerance) }
    }

    #[inline]
    pub fn rhs(&self, t: f64, y: &[f64], f: &mut [f64]) {
        assert!(y.len() == self.states() && f.len() == self.states());
        self.rhs_calls.set(self.rhs_calls.get() + 1);
        // SAFETY: the lengths were checked.
        unsafe { (self.table.rhs)(t, y.as_ptr(), f.as_mut_ptr()) }
    }

    /// ∂f/∂y in rows.
    #[inline]
    pub fn jacobian(&self, t: f64, y: &[f64], j: &mut [f64]) {
        assert!(y.len() == self.states() && j.len() == y.len() * y.len());
        self.jacobian_calls.set(self.jacobian_calls.get() + 1);
        // SAFETY: the lengths were checked.
        unsafe { (self.table.jacobian)(t, y.as_ptr(), j.as_mut_ptr()) }
    }

    /// Values of the guards.
    #[inline]
    pub fn values(&self, t: f64, y: &[f64], g: &mut [f64]) {
        assert!(y.len() == self.states() && g.len() == self.guards());
        // SAFETY: the lengths were checked.
        unsafe { (self.table.values)(t, y.as_ptr(), g.as_mut_ptr()) }
    }

    /// The jump at the fall of guard `which`; whether the run ends there.
    pub fn event(&self, t: f64, y: &mut [f64], which: usize) -> bool {
        assert!(y.len() == self.states() && which < self.guards());
        // SAFETY: the length was checked.
        unsafe { (self.table.event)(t, y.as_mut_ptr(), which as c_int) }
    }
}
