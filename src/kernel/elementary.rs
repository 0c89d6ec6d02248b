//! Functions by the same bits on every processor: codegen/elementary.c and codegen/sums.c.

/// Sine and cosine, as C returns them.
#[repr(C)]
struct SinCos {
    sin: f64,
    cos: f64,
}

unsafe extern "C" {
    /// Takes every number.
    safe fn dalembert_sin_cos(x: f64) -> SinCos;

    /// Takes `n` factors, `n` rows of `n` entries, and room for `n` sums.
    fn dalembert_triangular_sums(n: usize, factors: *const f64, table: *const f64, out: *mut f64);
}

/// Sine and cosine of `x` (rad), by the same function as in generated code: by the same bits on every
/// processor, to less than one unit in the last place. NaN if `x` is not finite.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    let SinCos { sin, cos } = dalembert_sin_cos(x);
    (sin, cos)
}

/// Sums Σ_{k ≤ j} `factors[k]` · `table[k][j]`, by the same bits on every processor (codegen/sums.c). Below its
/// diagonal, for j < k, the table must be zero.
#[inline]
pub fn triangular_sums<const N: usize>(
    factors: &[f64; N],
    table: &[[f64; N]; N],
    sums: &mut [f64; N],
) {
    let table = table.as_ptr().cast();
    // SAFETY: all have the length N, the rows follow each other.
    unsafe { dalembert_triangular_sums(N, factors.as_ptr(), table, sums.as_mut_ptr()) }
}
