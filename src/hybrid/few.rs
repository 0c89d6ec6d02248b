//! Copies of a few numbers.

/// Copies as many numbers as a model has coordinates or discrete states: so few that a call of the C
/// library, which a copy of unknown length becomes, takes longer than the copy.
///
/// # Panics
/// If the lengths differ.
#[inline(always)]
pub(super) fn copy_few(from: &[f64], to: &mut [f64]) {
    match (from, to) {
        ([], []) => {}
        ([a], [to]) => *to = *a,
        ([a, b], [to_a, to_b]) => (*to_a, *to_b) = (*a, *b),
        ([a, b, c], [to_a, to_b, to_c]) => (*to_a, *to_b, *to_c) = (*a, *b, *c),
        (from, to) => to.copy_from_slice(from),
    }
}
