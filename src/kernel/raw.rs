//! What is passed to generated C, and the types of its functions.

use super::context::{Arrays, KeptAngle};
use std::ops::{Deref, DerefMut};
use std::ptr::NonNull;

/// Context of a call, as C sees it: signals, their rates, discrete states, held coordinates,
/// constants, jerks.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub(crate) struct RawContext {
    pub(super) u: *const f64,
    pub(super) u_dot: *const f64,
    pub(super) d: *const f64,
    pub(super) h: *const f64,
    pub(super) c: *const f64,
    pub(super) j: *const f64,
    pub(super) angles: *mut KeptAngle,
}

// SAFETY: it is what arrays that may be sent to another thread look like to C, and goes with them.
unsafe impl Send for RawContext {}

/// Numbers at an address that stays as long as they are there, so that it can be told to C once.
#[derive(Debug)]
pub(super) struct Array<T>(NonNull<[T]>);

// SAFETY: it owns its numbers as a box does.
unsafe impl<T: Send> Send for Array<T> {}

impl<T> Array<T> {
    pub(super) fn of(numbers: Vec<T>) -> Self {
        Array(NonNull::from(Box::leak(numbers.into_boxed_slice())))
    }

    pub(super) fn pointer(&self) -> *mut T {
        self.0.as_ptr().cast()
    }
}

impl<T> Deref for Array<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        // SAFETY: the numbers are there until it is dropped, and borrowed as it is.
        unsafe { self.0.as_ref() }
    }
}

impl<T> DerefMut for Array<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: as in `deref`.
        unsafe { self.0.as_mut() }
    }
}

impl<T: Clone> Clone for Array<T> {
    fn clone(&self) -> Self {
        Array::of(self.to_vec())
    }
}

impl<T> Drop for Array<T> {
    fn drop(&mut self) {
        // SAFETY: they were a box, and nobody else has taken them back.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) })
    }
}

impl Arrays {
    /// The arrays as C sees them, as long as they are there.
    pub(super) fn raw(&self) -> RawContext {
        RawContext {
            u: self.signals.pointer(),
            u_dot: self.signal_rates.pointer(),
            d: self.discrete.pointer(),
            h: self.held.pointer(),
            c: self.constants.pointer(),
            // Only the rate of a guard reads jerks.
            j: std::ptr::null(),
            angles: self.angles.pointer().cast(),
        }
    }
}

/// A generated C function.
pub(crate) type Raw =
    unsafe extern "C" fn(*const f64, *const f64, *const f64, *const RawContext, *mut f64);

/// Generated C functions that expand the motion in time: coefficients of order 0, and of the orders
/// 1 … n − 1. The arrays q, v, a and u hold one row an order.
pub(crate) type RawStart = unsafe extern "C" fn(
    *mut f64,
    *mut f64,
    *mut f64,
    *const f64,
    *const RawContext,
    *mut f64,
    *mut f64,
);
pub(crate) type RawRun = unsafe extern "C" fn(
    usize,
    *mut f64,
    *mut f64,
    *mut f64,
    *const f64,
    *const RawContext,
    *mut f64,
    *mut f64,
);
