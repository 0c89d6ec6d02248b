//! Calls into the generated C of a model, for one trajectory: guards and transitions.

use super::calls::pointer;
use super::context::Context;
use super::raw::{Raw, RawContext};
use super::tables::{Free, GuardKernel, LinearSystem, ModeKernel, TransitionKernel};
use crate::numerics::Size;
use std::sync::Arc;

impl<F: Size> ModeKernel<F> {
    /// Value of a guard of this mode.
    ///
    /// # Panics
    /// If it is one of another model, or of another number of free coordinates; so do the other
    /// functions that are passed a guard or a transition.
    #[inline]
    pub fn guard(&self, x: &Context, guard: &GuardKernel, at: Free<F>) -> f64 {
        self.of_guard(guard.value, x, guard, at)
    }

    /// What a function of a guard with one output gives.
    #[inline(always)]
    fn of_guard(&self, function: Raw, x: &Context, guard: &GuardKernel, at: Free<F>) -> f64 {
        assert_eq!(
            guard.free,
            self.size.get(),
            "a guard is evaluated in its own mode"
        );
        let mut out = 0.0;
        let pointers = at.pointers(self.size);
        // SAFETY: one output; the guard's number of free coordinates was checked.
        unsafe { x.call(function, &guard.dimensions, pointers, &mut out) }
        out
    }

    /// Derivative of a guard along the flow with jerk `j`; needs the signals to be set.
    pub fn guard_rate(&self, x: &Context, guard: &GuardKernel, at: Free<F>, j: &F::Vector) -> f64 {
        assert_eq!(
            guard.free,
            self.size.get(),
            "a guard is evaluated in its own mode"
        );
        let mut out = 0.0;
        let [q, v, a] = at.pointers(self.size);
        let raw = RawContext {
            j: pointer(j, self.size),
            ..*x.raw(&guard.dimensions)
        };
        // SAFETY: one output; the guard's number of free coordinates was checked.
        unsafe { (guard.rate)(q, v, a, &raw, &mut out) }
        out
    }

    /// Sum of the absolute values of the terms that a guard is the sum of, in its unit.
    pub fn guard_magnitude(&self, x: &Context, guard: &GuardKernel, at: Free<F>) -> f64 {
        self.of_guard(guard.magnitude, x, guard, at)
    }

    /// What bounds the rounding error of a guard, to first order, in its unit, where all that it depends on is known to its own
    /// rounding (running error, Higham 2002, §3.3).
    pub fn guard_rounding(&self, x: &Context, guard: &GuardKernel, at: Free<F>) -> f64 {
        // Of a half for each operation, in units of the machine epsilon.
        0.5 * f64::EPSILON * self.of_guard(guard.rounding, x, guard, at)
    }

    /// The reset of a transition out of this mode: all q, all v, all discrete states after it.
    ///
    /// # Panics
    /// If `out` has not two entries a coordinate and one a discrete state.
    pub fn reset(&self, x: &Context, transition: &TransitionKernel, at: Free<F>, out: &mut [f64]) {
        assert_eq!(
            transition.source_free,
            self.size.get(),
            "a reset is evaluated in its source mode"
        );
        let dimensions = &transition.dimensions;
        assert_eq!(out.len(), 2 * dimensions.coordinates + dimensions.discretes);
        // SAFETY: the lengths were checked.
        unsafe {
            x.call(
                transition.reset,
                dimensions,
                at.pointers(self.size),
                out.as_mut_ptr(),
            )
        }
    }

    /// The impulses of a transition out of this mode, if it says them.
    pub fn impulses(
        &self,
        x: &Context,
        transition: &TransitionKernel,
        at: Free<F>,
    ) -> Option<Vec<f64>> {
        assert_eq!(
            transition.source_free,
            self.size.get(),
            "impulses are evaluated in the source mode"
        );
        let (function, count) = transition.impulses?;
        let mut out = vec![0.0; count];
        // SAFETY: room for `count` outputs; the number of free coordinates was checked.
        unsafe {
            x.call(
                function,
                &transition.dimensions,
                at.pointers(self.size),
                out.as_mut_ptr(),
            )
        }
        Some(out)
    }

    /// The conditions of a transition into this mode, where its reset leads: at the coordinates, rates and discrete states `after` it, of
    /// which those with the indices `free` are free, and the time of the context. A transition without conditions has none of them;
    /// `None` where the accelerations are not determined.
    ///
    /// # Panics
    /// If `after` has not one entry for each coordinate, rate and discrete state, or the mode has another number of free coordinates.
    pub fn conditions<'x>(
        &self,
        x: &'x mut Context,
        transition: &TransitionKernel,
        (after, free): (&[f64], &[usize]),
    ) -> Option<&'x [f64]> {
        let Some((function, of_target, count)) = transition.condition else {
            return Some(&[]);
        };
        let (n, size) = (self.dimensions.coordinates, self.size);
        assert!(
            Arc::ptr_eq(&self.dimensions, &transition.dimensions) && of_target == size.get(),
            "a condition is evaluated in the target mode"
        );
        assert_eq!(after.len(), 2 * n + self.dimensions.discretes);
        assert_eq!(free.len(), size.get(), "the free coordinates of the mode");
        assert!(count <= x.conditions.len());
        let [q, v] = [0, n].map(|from| size.vector(|i| after[from + free[i]]));
        let out = x.conditions.as_mut_ptr();
        let raw = RawContext {
            h: after.as_ptr(),
            d: after[2 * n..].as_ptr(),
            ..*x.raw(&self.dimensions)
        };
        let (at_q, at_v) = (pointer(&q, size), pointer(&v, size));
        let (mass, load) = size.matrix_and_vector(|out| {
            if size.get() > 0 {
                // SAFETY: F × F and F outputs, one behind the other; `a` is not read.
                unsafe { (self.functions.system)(at_q, at_v, at_v, &raw, out) }
            }
        });
        let system: LinearSystem<F> = LinearSystem { mass, load };
        let a: F::Vector = system.accelerations(&size.repeat(1.0)).ok()?;
        // SAFETY: room for `count` outputs; the number of free coordinates was checked.
        unsafe { function(at_q, at_v, pointer(&a, size), &raw, out) }
        Some(&x.conditions[..count])
    }
}
