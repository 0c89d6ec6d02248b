//! The factors L D Lᵀ of a symmetric positive definite matrix: an inertia.

use super::size::{Matrix, Size};

/// Unit roundoff of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// A pivot that is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NotPositive {
    /// Its row.
    pub row: usize,
    pub pivot: f64,
}

/// The factors of the symmetric part of a matrix.
#[derive(Debug, Clone)]
pub(crate) struct Definite<F: Size> {
    /// L D below the diagonal, D on it.
    lower: F::Matrix,
    not_positive: Option<NotPositive>,
}

impl<F: Size> Definite<F> {
    /// Factorizes the matrix with the given entry (row, column). Beyond a pivot that is not positive nothing means anything.
    pub fn factorize(size: F, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut lower = size.zero_matrix();
        let mut not_positive = None;
        for i in 0..size.get() {
            for j in 0..=i {
                let symmetric = 0.5 * (entry(i, j) + entry(j, i));
                let product = |k| lower[(i, k)] * (lower[(j, k)] / lower[(k, k)]);
                let rest = symmetric - (0..j).map(product).sum::<f64>();
                // A pivot within the rounding of its own sum is not told from zero.
                let rounding = (size.get() + 1) as f64 * ROUNDOFF * symmetric.abs();
                if i == j && (rest.is_nan() || rest <= rounding) {
                    let here = NotPositive {
                        row: i,
                        pivot: rest,
                    };
                    not_positive = not_positive.or(Some(here));
                }
                lower[(i, j)] = rest;
            }
        }
        Definite {
            lower,
            not_positive,
        }
    }

    /// The pivots D.
    ///
    /// # Errors
    /// The first that is not positive.
    pub fn pivots(&self) -> Result<F::Vector, NotPositive> {
        match self.not_positive {
            Some(not_positive) => Err(not_positive),
            None => Ok(self.lower.size().vector(|i| self.lower[(i, i)])),
        }
    }

    /// D^(−1/2) L⁻¹ b: in these coordinates the matrix is 1. Not numbers where a pivot is not positive.
    pub fn scaled(&self, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        for i in 0..x.len() {
            for k in 0..i {
                x[i] -= self.lower[(i, k)] / self.lower[(k, k)] * x[k];
            }
        }
        for (i, x) in x.iter_mut().enumerate() {
            *x /= self.lower[(i, i)].sqrt();
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::super::Dynamic;
    use super::*;

    fn factors(matrix: [[f64; 2]; 2]) -> Definite<Dynamic> {
        Definite::factorize(Dynamic(2), |i, j| matrix[i][j])
    }

    #[test]
    fn factors_make_the_matrix_one() {
        let of = factors([[4.0, 2.0], [2.0, 5.0]]);
        assert_eq!(of.pivots().unwrap()[..], [4.0, 4.0]);
        // bᵀ A⁻¹ b.
        let x = of.scaled(&[2.0, 5.0]);
        assert_eq!(x, [1.0, 2.0]);
        assert_eq!(x.iter().map(|x| x * x).sum::<f64>(), 5.0);
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_told() {
        let pivot = |matrix| factors(matrix).pivots().unwrap_err();
        let of = pivot([[1.0, 2.0], [2.0, 1.0]]);
        assert_eq!((of.row, of.pivot), (1, -3.0));
        assert_eq!(pivot([[1.0, 1.0], [1.0, 1.0]]).row, 1);
        assert_eq!(pivot([[0.0, 1.0], [1.0, 1.0]]).row, 0);
        assert!(
            factors([[-1.0, 0.0], [0.0, 1.0]])
                .scaled(&[1.0, 1.0])
                .iter()
                .any(|x| x.is_nan())
        );
    }
}
