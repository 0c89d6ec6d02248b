//! The interpolating cubic spline.

/// Coefficients, in powers of t − tᵢ, of the twice continuously differentiable cubic spline through
/// at least two points, with the not-a-knot condition: the third derivative does not jump at the
/// second and the last but one point either. Two points give a line, three a parabola.
///
/// The slopes at the points solve a tridiagonal system (de Boor, *A Practical Guide to Splines*,
/// chapter IV).
pub(super) fn not_a_knot(times: &[f64], values: &[f64]) -> Vec<[f64; 4]> {
    let h: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).collect();
    let secants: Vec<f64> = values
        .windows(2)
        .zip(&h)
        .map(|(y, h)| (y[1] - y[0]) / h)
        .collect();
    let slopes = match secants[..] {
        [d] => vec![d, d],
        [d0, d1] => {
            // The parabola: its slope at the middle is the weighted mean of the secants, and a
            // secant of a parabola has the mean slope of its ends.
            let middle = (h[1] * d0 + h[0] * d1) / (h[0] + h[1]);
            vec![2.0 * d0 - middle, middle, 2.0 * d1 - middle]
        }
        _ => slopes(&h, &secants),
    };
    (0..h.len())
        .map(|i| {
            let (m0, m1, d) = (slopes[i], slopes[i + 1], secants[i]);
            let second = (3.0 * d - 2.0 * m0 - m1) / h[i];
            let third = (m0 + m1 - 2.0 * d) / h[i] / h[i];
            [values[i], m0, second, third]
        })
        .collect()
}

/// Slopes at the points of a spline with at least three pieces, by elimination without pivoting:
/// the second pivot is h₀ + h₁, from which follows that each further one is larger than the entry
/// above the diagonal in its row, and that the last, h²/(2h + h′) at least, is positive.
fn slopes(h: &[f64], d: &[f64]) -> Vec<f64> {
    let n = h.len();
    // Rows (lower, diagonal, upper, right-hand side).
    let end = |h0: f64, h1: f64, d0: f64, d1: f64| {
        ((h0 + 2.0 * (h0 + h1)) * h1 * d0 + h0 * h0 * d1) / (h0 + h1)
    };
    let mut rows = Vec::with_capacity(n + 1);
    rows.push((0.0, h[1], h[0] + h[1], end(h[0], h[1], d[0], d[1])));
    for i in 1..n {
        let right = 3.0 * (h[i] * d[i - 1] + h[i - 1] * d[i]);
        rows.push((h[i], 2.0 * (h[i - 1] + h[i]), h[i - 1], right));
    }
    let right = end(h[n - 1], h[n - 2], d[n - 1], d[n - 2]);
    rows.push((h[n - 1] + h[n - 2], h[n - 2], 0.0, right));

    for i in 1..=n {
        let (_, pivot, upper, right) = rows[i - 1];
        let row = &mut rows[i];
        let factor = row.0 / pivot;
        row.1 -= factor * upper;
        row.3 -= factor * right;
    }
    let mut slopes = vec![0.0; n + 1];
    slopes[n] = rows[n].3 / rows[n].1;
    for i in (0..n).rev() {
        let (_, diagonal, upper, right) = rows[i];
        slopes[i] = (right - upper * slopes[i + 1]) / diagonal;
    }
    slopes
}
