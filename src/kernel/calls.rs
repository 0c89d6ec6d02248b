//! Calls into the generated C of a model, for one trajectory: functions of modes.

use super::context::{Context, Dimensions, KeptAngle};
use super::raw::{Raw, RawContext};
use super::tables::{ConstantsKernel, Free, LinearSystem, ModeKernel};
use crate::numerics::{Matrix, ORDERS, Rows, Series, Size, Vector};
use std::sync::Arc;

unsafe extern "C" {
    /// Takes so many coefficients a row of q, v and a, of which so many rows are read, filled up to fours and to
    /// eight; a time; and room for three times as many middles and radii.
    fn dalembert_ranges(
        free: usize,
        rows: usize,
        q: *const f64,
        v: *const f64,
        a: *const f64,
        tau: f64,
        middles: *mut f64,
        radii: *mut f64,
    );
}

impl Context {
    /// Calls a generated function.
    ///
    /// # Safety
    /// `q`, `v`, `a` must have the length of the function's free coordinates (where it reads them), it must
    /// not read jerks, and `out` must have room for its outputs.
    #[inline(always)]
    pub(super) unsafe fn call(
        &self,
        function: Raw,
        dimensions: &Arc<Dimensions>,
        [q, v, a]: [*const f64; 3],
        out: *mut f64,
    ) {
        // SAFETY: the context is of the function's model, the rest is the caller's.
        unsafe { function(q, v, a, self.raw(dimensions), out) }
    }

    /// The context as C sees it.
    ///
    /// # Panics
    /// If it was made for another model. Its arrays have their lengths since it was made.
    #[inline(always)]
    pub(super) fn raw(&self, dimensions: &Arc<Dimensions>) -> &RawContext {
        assert!(
            Arc::ptr_eq(&self.dimensions, dimensions),
            "a context is used with the functions of the model it was made for"
        );
        &self.raw
    }
}

impl ConstantsKernel {
    /// Values at the parameters of a model, in its order.
    ///
    /// # Panics
    /// If the number of parameters is not the model's, or `out` has not one entry a value.
    pub fn evaluate(&self, parameters: &[f64], out: &mut [f64]) {
        assert_eq!(
            parameters.len(),
            self.dimensions.parameters,
            "number of parameters"
        );
        assert_eq!(out.len(), self.count);
        let mut angles = vec![KeptAngle::ZERO; self.dimensions.angles];
        let raw = RawContext {
            u: std::ptr::null(),
            u_dot: std::ptr::null(),
            d: std::ptr::null(),
            h: std::ptr::null(),
            c: std::ptr::null(),
            j: std::ptr::null(),
            angles: angles.as_mut_ptr(),
        };
        let none = std::ptr::null();
        // SAFETY: the function reads `parameters` only and writes `count` outputs.
        unsafe { (self.function)(parameters.as_ptr(), none, none, &raw, out.as_mut_ptr()) }
    }
}

/// Where the numbers are.
///
/// # Panics
/// If there are not as many as the mode has free coordinates.
#[inline(always)]
pub(super) fn pointer<V: Vector>(of: &V, size: V::Size) -> *const f64 {
    assert_eq!(of.size(), size, "one number a free coordinate");
    of.as_slice().as_ptr()
}

impl<F: Size> Free<'_, F> {
    /// Where the numbers are.
    ///
    /// # Panics
    /// If there are not as many as the mode has free coordinates.
    #[inline(always)]
    pub(super) fn pointers(&self, size: F) -> [*const f64; 3] {
        [
            pointer(self.q, size),
            pointer(self.v, size),
            pointer(self.a, size),
        ]
    }
}

impl<F: Size> ModeKernel<F> {
    /// Calls a function of the mode.
    ///
    /// # Safety
    /// `out` must have room for its outputs, and it must not read jerks.
    #[inline(always)]
    unsafe fn call(&self, function: Raw, x: &Context, at: Free<F>, out: *mut f64) {
        // SAFETY: there are as many coordinates, velocities and accelerations as it reads; the rest is the caller's.
        unsafe { x.call(function, &self.dimensions, at.pointers(self.size), out) }
    }

    /// r(q, v, a, u): generalized forces that are missing for equilibrium, one a free coordinate.
    #[inline]
    pub fn residual(&self, x: &Context, at: Free<F>, r: &mut F::Vector) {
        assert_eq!(r.size(), self.size, "one number a free coordinate");
        // SAFETY: F outputs.
        unsafe {
            self.call(
                self.functions.residual,
                x,
                at,
                r.as_mut_slice().as_mut_ptr(),
            )
        }
    }

    /// [∂r/∂a, ∂r/∂v, ∂r/∂q].
    #[inline]
    pub fn jacobian(&self, x: &Context, at: Free<F>, out: &mut [F::Matrix; 3]) {
        let [m, c, k] = &*out;
        assert!(m.size() == self.size && c.size() == self.size && k.size() == self.size);
        let at = at.pointers(self.size);
        // SAFETY: three dense column-major F × F outputs, one behind the other.
        let write = |out| unsafe { x.call(self.functions.jacobian, &self.dimensions, at, out) };
        self.size.write_three(out, write);
    }

    /// Mass matrix and load at (q, v).
    #[inline]
    pub fn system(&self, x: &Context, q: &F::Vector, v: &F::Vector) -> LinearSystem<F> {
        let (q, v) = (pointer(q, self.size), pointer(v, self.size));
        let (mass, load) = self.size.matrix_and_vector(|out| {
            if self.size.get() > 0 {
                // SAFETY: F × F and F outputs, one behind the other; `a` is not read.
                unsafe { x.call(self.functions.system, &self.dimensions, [q, v, v], out) }
            }
        });
        LinearSystem { mass, load }
    }

    /// Fills `Context::guard_series` with the Taylor coefficients of all guards, one row an order,
    /// along a motion that is known to that order.
    ///
    /// # Panics
    /// If `orders` is more than [`ORDERS`].
    pub fn guard_series(&self, x: &mut Context, orders: usize, at: &Series<F>) {
        let series = &self.guard_series;
        assert!(orders <= ORDERS);
        self.assert_rows(at);
        let (q, v, a) = (
            at.q.as_ptr().cast_mut(),
            at.v.as_ptr().cast_mut(),
            at.a.as_ptr().cast_mut(),
        );
        let (u, w) = (x.signal_series.as_ptr(), x.workspace.as_mut_ptr().cast());
        let out = x.guard_series.as_mut_ptr();
        let raw = x.raw(&self.dimensions);
        // SAFETY: F entries a row of q, v and a, which are only read, and all rows are there; one
        // output a guard and order; guard series and workspace have room for every mode of the model.
        unsafe {
            (series.start)(q, v, a, u, raw, w, out);
            (series.run)(orders, q, v, a, u, raw, w, out);
        }
    }

    /// Begins a Taylor series: mass matrix and load at order 0 of q and v.
    #[inline]
    pub fn series_start(&self, x: &mut Context, at: &Series<F>) -> LinearSystem<F> {
        self.assert_rows(at);
        let (mass, load) = self.size.matrix_and_vector(|out| {
            if self.size.get() == 0 {
                return;
            }
            let series = self.motion_series(x);
            let (q, v, a) = (
                at.q.as_ptr().cast_mut(),
                at.v.as_ptr().cast_mut(),
                at.a.as_ptr().cast_mut(),
            );
            let (u, w) = (x.signal_series.as_ptr(), x.workspace.as_mut_ptr().cast());
            let raw = x.raw(&self.dimensions);
            // SAFETY: F entries a row, which are only read; F × F and F outputs, one behind the other; the
            // workspace has room for every mode of the model.
            unsafe { (series.start)(q, v, a, u, raw, w, out) }
        });
        LinearSystem { mass, load }
    }

    /// One number a free coordinate in each row.
    #[inline(always)]
    fn assert_rows(&self, at: &Series<F>) {
        let (n, Series { q, v, a }) = (self.size, at);
        let is_own = q.size() == n && v.size() == n && a.size() == n;
        assert!(is_own, "a series of the mode's free coordinates");
    }

    /// Goes on to the first `n` accelerations of the series begun by [`Self::series_start`], for the
    /// same context: a_k with v_{k+1} and q_{k+2} for k < n. The inverse of M_0 is given, and a_0, v_1,
    /// q_1 and q_2 are.
    ///
    /// # Panics
    /// If `n` is more than [`ORDERS`] − 2.
    #[inline]
    pub fn series_run(&self, x: &mut Context, n: usize, inverse: &F::Matrix, at: &mut Series<F>) {
        if self.size.get() == 0 {
            return;
        }
        self.assert_rows(at);
        assert_eq!(inverse.size(), self.size);
        let series = self.motion_series(x);
        assert!(n <= ORDERS - 2);
        let (q, v, a) = (at.q.as_mut_ptr(), at.v.as_mut_ptr(), at.a.as_mut_ptr());
        let (u, w) = (x.signal_series.as_ptr(), x.workspace.as_mut_ptr().cast());
        let inverse = inverse.as_slice().as_ptr().cast_mut();
        let raw = x.raw(&self.dimensions);
        // SAFETY: F entries a row of q, v and a, and n + 2 rows are there; the F × F entries of the
        // inverse are only read; the workspace has room for every mode of the model.
        unsafe { (series.run)(n, q, v, a, u, raw, w, inverse) }
    }

    /// Mass matrix without friction: ∂²T/∂v² on the free coordinates.
    pub fn inertia(&self, x: &Context, q: &F::Vector, v: &F::Vector) -> F::Matrix {
        let mut out = self.size.zero_matrix();
        let (q, v) = (pointer(q, self.size), pointer(v, self.size));
        let to = out.as_mut_slice().as_mut_ptr();
        // SAFETY: F × F outputs; `a` is not read.
        unsafe { x.call(self.functions.inertia, &self.dimensions, [q, v, v], to) }
        out
    }

    /// b with M j + b = 0 for the jerk j; needs the signals to be set.
    pub fn jerk_load(&self, x: &Context, at: Free<F>) -> F::Vector {
        // SAFETY: F outputs.
        unsafe { self.one_a_coordinate(self.functions.jerk_load, x, at) }
    }

    /// Number of terms × sum of their magnitudes, per equation: times machine epsilon a bound of
    /// the rounding error of the residual.
    pub fn magnitude(&self, x: &Context, at: Free<F>) -> F::Vector {
        // SAFETY: F outputs.
        unsafe { self.one_a_coordinate(self.functions.magnitude, x, at) }
    }

    /// What a function of the mode gives, one number a free coordinate.
    ///
    /// # Safety
    /// The function must have F outputs.
    unsafe fn one_a_coordinate(&self, function: Raw, x: &Context, at: Free<F>) -> F::Vector {
        let mut out = self.size.zeros();
        if self.size.get() > 0 {
            // SAFETY: as the caller promises.
            unsafe { self.call(function, x, at, out.as_mut_slice().as_mut_ptr()) }
        }
        out
    }

    /// Reactions of all coordinates (0 where free), then of the ground motions.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate and motion.
    #[inline]
    pub fn reactions(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        assert_eq!(
            out.len(),
            self.dimensions.coordinates + self.dimensions.motions.len()
        );
        // SAFETY: the length was checked.
        unsafe { self.call(self.functions.reactions, x, at, out.as_mut_ptr()) }
    }

    /// The outputs of the model.
    ///
    /// # Panics
    /// If `out` has not one entry an output.
    pub fn outputs(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        let (function, count) = (self.functions.outputs, self.outputs);
        assert_eq!(out.len(), count);
        // SAFETY: the length was checked.
        unsafe { self.call(function, x, at, out.as_mut_ptr()) }
    }

    /// [kinetic, potential] energy, J, in the inertial frame.
    pub fn energies(&self, x: &Context, at: Free<F>) -> [f64; 2] {
        let mut out = [0.0; 2];
        // SAFETY: two outputs.
        unsafe { self.call(self.functions.energies, x, at, out.as_mut_ptr()) }
        out
    }

    /// [dissipated, input] power, W.
    #[inline]
    pub fn powers(&self, x: &Context, at: Free<F>) -> [f64; 2] {
        let mut out = [0.0; 2];
        // SAFETY: two outputs.
        unsafe { self.call(self.functions.powers, x, at, out.as_mut_ptr()) }
        out
    }

    /// ∂T/∂v of all coordinates, then of the ground motions.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate and motion.
    pub fn momenta(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        assert_eq!(
            out.len(),
            self.dimensions.coordinates + self.dimensions.motions.len()
        );
        // SAFETY: the length was checked.
        unsafe { self.call(self.functions.momenta, x, at, out.as_mut_ptr()) }
    }

    /// Gaps, their rates, slip rates, coefficients of friction and restitution of contacts, then values and rates of
    /// constraints, with what times the unit roundoff bounds their rounding ([`crate::model::Contacts`]).
    ///
    /// # Panics
    /// If the mode has none by multipliers.
    pub fn contact_values(&self, x: &Context, q: &F::Vector, v: &F::Vector) -> Vec<f64> {
        self.of_contacts(self.contact_values, x, [q, v])
    }

    /// Inertia of the coordinates that are no multipliers, row by row, then how gaps and slips of contacts and what constraints hold
    /// change with these coordinates, a row each.
    ///
    /// # Panics
    /// If the mode has none by multipliers.
    pub fn lines(&self, x: &Context, q: &F::Vector, v: &F::Vector) -> Vec<f64> {
        self.of_contacts(self.lines, x, [q, v])
    }

    /// What a function of contacts by multipliers gives, which reads no accelerations.
    fn of_contacts(
        &self,
        function: Option<(Raw, usize)>,
        x: &Context,
        [q, v]: [&F::Vector; 2],
    ) -> Vec<f64> {
        let (function, count) = function.expect("contacts by multipliers");
        let mut out = vec![0.0; count];
        let at = Free { q, v, a: v };
        // SAFETY: as many outputs as the tables state; accelerations are not read.
        unsafe { self.call(function, x, at, out.as_mut_ptr()) }
        out
    }

    /// What must be positive in this mode.
    ///
    /// # Panics
    /// If `out` has not one entry a requirement.
    #[inline]
    pub fn requirements(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        let (function, count) = (self.functions.requirements, self.requirements);
        assert_eq!(out.len(), count);
        // SAFETY: the length was checked.
        unsafe { self.call(function, x, at, out.as_mut_ptr()) }
    }

    /// Which of the series of guards, and of what else is looked at within steps, swing with inputs while the motion may not, as the force on
    /// a cam: a step resolves them.
    pub fn swinging(&self) -> &[usize] {
        &self.swinging
    }

    /// What bounds, to first order, the rounding errors of what may vanish of what must not be negative (running error, Higham 2002,
    /// §3.3); 0 of the others and of margins.
    ///
    /// # Panics
    /// If `out` has not one entry a requirement.
    pub fn requirement_roundings(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        let function = self.functions.requirement_roundings;
        assert_eq!(out.len(), self.requirements);
        // SAFETY: the length was checked.
        unsafe { self.call(function, x, at, out.as_mut_ptr()) }
        // Of a half for each operation, in units of the machine epsilon.
        out.iter_mut()
            .for_each(|bound| *bound *= 0.5 * f64::EPSILON);
    }

    /// Lower bounds of what must be positive, while time goes on by `tau` (s) from where the series of motion
    /// and signals, of so many orders, were begun. Not positive or not a number where nothing is known.
    ///
    /// # Panics
    /// If `out` has not one entry a requirement, or `orders` is more than [`ORDERS`] − 2.
    #[inline]
    pub fn requirement_bounds(
        &self,
        x: &mut Context,
        (at, orders): (&Series<F>, usize),
        tau: f64,
        out: &mut [f64],
    ) {
        assert_eq!(out.len(), self.requirements);
        assert!(orders + 2 <= ORDERS);
        self.assert_rows(at);
        let n = self.size.get();
        let (q, v, a) = (at.q.as_ptr(), at.v.as_ptr(), at.a.as_ptr());
        self.size.with_room::<6, _>(|room| {
            let (middles, radii) = room.split_at_mut(3 * n);
            let (to_middles, to_radii) = (middles.as_mut_ptr(), radii.as_mut_ptr());
            // SAFETY: F entries a row, and all ORDERS rows are there, those beyond the order zero; room for three times F.
            unsafe { dalembert_ranges(n, orders + 2, q, v, a, tau, to_middles, to_radii) };
            x.set_signal_radii(orders, tau);
            let u = match x.autonomous {
                true => x.arrays.signals.as_ptr(),
                false => x.signal_series.as_ptr(),
            };
            let raw = RawContext {
                u,
                u_dot: x.signal_radii.as_ptr(),
                j: radii.as_ptr(),
                ..*x.raw(&self.dimensions)
            };
            let (q, v, a) = (
                middles.as_ptr(),
                middles[n..].as_ptr(),
                middles[2 * n..].as_ptr(),
            );
            // SAFETY: the length of `out` was checked; an entry a signal; F entries each, and three times F
            // radii.
            unsafe { (self.functions.requirement_bounds)(q, v, a, &raw, out.as_mut_ptr()) }
        });
    }

    /// Constant rates at which what the context holds drifts while the mode lasts (0 where it rests or is free).
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate.
    pub fn drift(&self, x: &Context, out: &mut [f64]) {
        let none = self.size.zeros();
        let at = Free {
            q: &none,
            v: &none,
            a: &none,
        };
        self.of_all(self.functions.drift, x, at, out);
    }

    /// All coordinates: those that are free, and where the mode holds the others: at a value, where the context has them, or where
    /// they follow from those that are free.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate.
    pub fn coordinates(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        self.of_all(self.functions.coordinates, x, at, out);
    }

    /// Their rates.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate.
    pub fn rates(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        self.of_all(self.functions.rates, x, at, out);
    }

    /// Their accelerations.
    ///
    /// # Panics
    /// If `out` has not one entry a coordinate.
    pub fn accelerations(&self, x: &Context, at: Free<F>, out: &mut [f64]) {
        self.of_all(self.functions.accelerations, x, at, out);
    }

    /// What, times the unit roundoff, bounds the rounding of all coordinates that depend on others, then of their rates; 0 of
    /// those that do not. Empty where none does.
    pub fn roundings(&self, x: &Context, at: Free<F>) -> Vec<f64> {
        self.counted(self.roundings, x, at)
    }

    /// Rates of what impulses act along where no coordinate moves: those of walls, belts and constraints that do. Empty where none moves.
    pub fn carried(&self, x: &Context, at: Free<F>) -> Vec<f64> {
        self.counted(self.carried, x, at)
    }

    /// Whether walls, belts or constraints move along which impulses act.
    pub fn is_carried(&self) -> bool {
        self.carried.is_some()
    }

    /// What a function gives that says how many results it has; nothing where there is none.
    fn counted(&self, function: Option<(Raw, usize)>, x: &Context, at: Free<F>) -> Vec<f64> {
        let Some((function, count)) = function else {
            return Vec::new();
        };
        let mut out = vec![0.0; count];
        // SAFETY: there is room for all.
        unsafe { self.call(function, x, at, out.as_mut_ptr()) };
        out
    }

    /// What a function of the mode gives that has one output a coordinate.
    fn of_all(&self, function: Raw, x: &Context, at: Free<F>, out: &mut [f64]) {
        assert_eq!(out.len(), self.dimensions.coordinates);
        // SAFETY: the length was checked.
        unsafe { self.call(function, x, at, out.as_mut_ptr()) }
    }
}
