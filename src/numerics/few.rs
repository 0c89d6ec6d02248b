//! A few numbers: copied, or exchanged.

use std::sync::atomic::{Ordering, compiler_fence};

/// Copies as many numbers as a model has coordinates, discrete states or signals: so few that a call of the C
/// library, which a copy of unknown length becomes, takes longer than the copy.
///
/// One by one: each was written alone just before, and a load of two of them would have to wait until both
/// are in memory.
///
/// # Panics
/// If the lengths differ.
#[inline(always)]
pub(crate) fn copy_few(from: &[f64], to: &mut [f64]) {
    match (from, to) {
        ([], []) => {}
        ([a], [to]) => *to = *a,
        ([a, b], [to_a, to_b]) => {
            *to_a = *a;
            compiler_fence(Ordering::SeqCst);
            *to_b = *b;
        }
        ([a, b, c], [to_a, to_b, to_c]) => {
            *to_a = *a;
            compiler_fence(Ordering::SeqCst);
            *to_b = *b;
            compiler_fence(Ordering::SeqCst);
            *to_c = *c;
        }
        (from, to) => to.copy_from_slice(from),
    }
}

/// Exchanges as many numbers as [`copy_few`] copies.
///
/// # Panics
/// If the lengths differ.
#[inline(always)]
pub(crate) fn swap_few(one: &mut [f64], other: &mut [f64]) {
    match (one, other) {
        ([], []) => {}
        ([a], [b]) => std::mem::swap(a, b),
        ([a, c], [b, d]) => {
            std::mem::swap(a, b);
            compiler_fence(Ordering::SeqCst);
            std::mem::swap(c, d);
        }
        (one, other) => one.swap_with_slice(other),
    }
}
