//! Small dense linear systems: LU factorization with row pivoting, unrolled by the compiler.
//!
//! Rows of the matrices here are generalized forces in different units (N, N m, …), so pivots are
//! compared after scaling row i by a typical size of coordinate i: all entries of a column then
//! have the same unit. The choice of pivots, and with it every bit of the result, does not depend on
//! the units of the coordinates.

use super::buffer::Stored;
use super::persist::persist;
use super::size::{Matrix, Size, Square, Vector};
use nalgebra::Complex;
use std::ops::{Mul, Sub};

/// A matrix is singular to working precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Singular {
    /// Index of the coordinate (column) for which no pivot was left.
    pub coordinate: usize,
}

/// Entries of a matrix: real or complex.
pub(crate) trait Scalar: Stored + Default + Mul<Output = Self> + Sub<Output = Self> {
    /// Size for the choice of a pivot; for complex numbers |Re| + |Im|, within √2 of the modulus.
    fn size(self) -> f64;
    /// 1 / self. Complex: |self| in 1e-154 … 1e154, where its square is a normal number.
    fn reciprocal(self) -> Self;
}

impl Scalar for f64 {
    #[inline(always)]
    fn size(self) -> f64 {
        self.abs()
    }
    #[inline(always)]
    fn reciprocal(self) -> Self {
        1.0 / self
    }
}

impl Scalar for Complex<f64> {
    #[inline(always)]
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
    #[inline(always)]
    fn reciprocal(self) -> Self {
        let scale = 1.0 / (self.re * self.re + self.im * self.im);
        Complex::new(self.re * scale, -self.im * scale)
    }
}

/// P A = L U of an F × F matrix.
#[derive(Debug, Clone)]
pub(crate) struct Lu<T: Stored, F: Size> {
    size: F,
    /// L below the diagonal, U above.
    rows: F::Square<T>,
    /// Reciprocals of the diagonal of U.
    reciprocals: F::List<T>,
    /// Row of A that became row i.
    order: F::List<usize>,
    /// Whether an odd number of rows were exchanged for that.
    is_odd: bool,
}

persist!([T: Stored, F: Size] Lu<T, F> { rows, reciprocals, order, is_odd } but { size });

impl<T: Scalar, F: Size> Lu<T, F> {
    /// Placeholder until the first factorization.
    pub fn empty(size: F) -> Self {
        Lu {
            size,
            rows: size.square(T::default()),
            reciprocals: size.list(T::default()),
            order: size.list(0),
            is_odd: false,
        }
    }

    /// Factorizes the matrix with the given entry (row, column); `row_scale` as in the module's
    /// text, positive.
    #[inline(always)]
    pub fn factorize(
        entry: impl Fn(usize, usize) -> T,
        row_scale: &F::Vector,
    ) -> Result<Self, Singular> {
        let size = row_scale.size();
        let mut lu = Self::empty(size);
        let mut scale = size.list(0.0);
        // Of each entry the largest number of its sum.
        let mut largest = size.square(0.0);
        for i in 0..size.get() {
            lu.order[i] = i;
            scale[i] = row_scale[i];
            for j in 0..size.get() {
                lu.rows[(i, j)] = entry(i, j);
                largest[(i, j)] = lu.rows[(i, j)].size();
            }
        }
        for k in 0..size.get() {
            lu.eliminate(k, (&mut scale, &mut largest))?;
        }
        Ok(lu)
    }

    /// Column `k` of Gauss's elimination: its pivot is chosen, and its multiples are taken from the rows that are left.
    #[inline(always)]
    fn eliminate(
        &mut self,
        k: usize,
        (scale, largest): (&mut F::List<f64>, &mut F::Square<f64>),
    ) -> Result<(), Singular> {
        let n = self.size.get();
        let mut pivot = k;
        let mut size = self.rows[(k, k)].size() * scale[k];
        for i in k + 1..n {
            let candidate = self.rows[(i, k)].size() * scale[i];
            if candidate > size {
                pivot = i;
                size = candidate;
            }
        }
        // F roundings of the largest number of its sum: what is left below that is no information.
        // A row of small numbers may well be exact. (A NaN fails the comparison as well.)
        let rounding = if k == 0 { 0.0 } else { n as f64 * f64::EPSILON };
        if !(size > rounding * largest[(pivot, k)] * scale[pivot] && size.is_finite()) {
            return Err(Singular { coordinate: k });
        }
        if pivot != k {
            self.rows.swap_rows(pivot, k);
            largest.swap_rows(pivot, k);
            let (row, own) = (self.order[pivot], scale[pivot]);
            (self.order[pivot], scale[pivot]) = (self.order[k], scale[k]);
            (self.order[k], scale[k]) = (row, own);
            self.is_odd = !self.is_odd;
        }
        self.reciprocals[k] = self.rows[(k, k)].reciprocal();
        for i in k + 1..n {
            self.rows[(i, k)] = self.rows[(i, k)] * self.reciprocals[k];
        }
        // By columns, as many coordinates store them.
        for j in k + 1..n {
            let own = self.rows[(k, j)];
            for i in k + 1..n {
                let product = self.rows[(i, k)] * own;
                largest[(i, j)] = largest[(i, j)].max(product.size());
                self.rows[(i, j)] = self.rows[(i, j)] - product;
            }
        }
        Ok(())
    }

    /// A⁻¹ b.
    #[inline(always)]
    pub fn solve(&self, b: impl Fn(usize) -> T) -> F::List<T> {
        let n = self.size.get();
        let mut x = self.size.list(T::default());
        for i in 0..n {
            x[i] = b(self.order[i]);
        }
        for j in 0..n {
            for i in j + 1..n {
                x[i] = x[i] - self.rows[(i, j)] * x[j];
            }
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] = x[i] - self.rows[(i, j)] * x[j];
            }
            x[i] = x[i] * self.reciprocals[i];
        }
        x
    }
}

impl<F: Size> Lu<f64, F> {
    /// Sign of the determinant of A, +1 or −1.
    #[inline(always)]
    pub fn sign(&self) -> i8 {
        let n = self.size.get();
        let negative = (0..n).filter(|&i| self.reciprocals[i] < 0.0).count();
        match (negative % 2 == 1) == self.is_odd {
            true => 1,
            false => -1,
        }
    }

    /// A⁻¹.
    pub fn inverted(&self) -> F::Matrix {
        let mut inverse = self.size.zero_matrix();
        self.inverse(|i, j, entry| inverse[(i, j)] = entry);
        inverse
    }

    /// Gives the entries of A⁻¹, by columns: row, column, value.
    #[inline(always)]
    pub fn inverse(&self, mut entry: impl FnMut(usize, usize, f64)) {
        let n = self.size.get();
        for j in 0..n {
            let column = self.solve(|i| if i == j { 1.0 } else { 0.0 });
            (0..n).for_each(|i| entry(i, j, column[i]));
        }
    }
}

/// Solves `matrix` · x = `right_side` by LU with row pivoting; rows are compared as they are after
/// scaling row i by `row_scale[i]` (a typical size of coordinate i; all ones where units agree).
///
/// # Errors
/// [`Singular`] if no pivot exceeds the rounding of its column, or an entry is not finite.
#[inline(always)]
pub fn solve<M: Matrix>(
    matrix: &M,
    right_side: &<M::Size as Size>::Vector,
    row_scale: &<M::Size as Size>::Vector,
) -> Result<<M::Size as Size>::Vector, Singular> {
    solve_for(matrix, |i| right_side[i], row_scale)
}

/// The same with a right side whose components a function gives.
#[inline(always)]
pub(crate) fn solve_for<M: Matrix>(
    matrix: &M,
    right_side: impl Fn(usize) -> f64,
    row_scale: &<M::Size as Size>::Vector,
) -> Result<<M::Size as Size>::Vector, Singular> {
    let lu = Lu::<f64, M::Size>::factorize(|i, j| matrix[(i, j)], row_scale)?;
    let x = lu.solve(right_side);
    Ok(matrix.size().vector(|i| x[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Const, SMatrix, SVector};

    /// Entries without structure in (−1, 1), the same in every run.
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn check<const F: usize>() {
        let mut seed = 7;
        for _ in 0..200 {
            let real = SMatrix::<f64, F, F>::from_fn(|_, _| noise(&mut seed));
            let imaginary = SMatrix::<f64, F, F>::from_fn(|_, _| noise(&mut seed));
            let matrix = real.zip_map(&imaginary, Complex::new);
            let x = SVector::<f64, F>::from_fn(|_, _| noise(&mut seed));
            let scale = SVector::repeat(1.0);

            let b = real * x;
            let residual = real * solve(&real, &b, &scale).unwrap() - b;
            assert!(residual.amax() < 1e-12, "{residual}");

            let b = matrix * x.map(|x| Complex::new(x, -x));
            let lu = Lu::<_, Const<F>>::factorize(|i, j| matrix[(i, j)], &scale).unwrap();
            let residual = matrix * SVector::from(lu.solve(|i| b[i])) - b;
            assert!(residual.iter().all(|r| r.size() < 1e-12), "{residual}");
        }
    }

    #[test]
    fn solves_real_and_complex_systems() {
        check::<1>();
        check::<2>();
        check::<3>();
        check::<6>();
    }

    #[test]
    fn pivots_where_the_leading_block_is_singular() {
        // An effective mass matrix with Coulomb friction: regular, but its first entry is zero.
        let matrix = SMatrix::<f64, 2, 2>::new(0.0, 2.0, -3.0, 1.0);
        let x = solve(&matrix, &SVector::from([4.0, -1.0]), &SVector::repeat(1.0)).unwrap();
        assert_eq!(x, SVector::from([1.0, 2.0]));
    }

    #[test]
    fn names_the_coordinate_of_a_singular_matrix() {
        let matrix = SMatrix::<f64, 2, 2>::new(0.1, 0.3, 0.3, 0.9);
        let error = solve(&matrix, &SVector::from([1.0, 1.0]), &SVector::repeat(1.0)).unwrap_err();
        assert_eq!(error, Singular { coordinate: 1 });
        let matrix = SMatrix::<f64, 1, 1>::new(f64::NAN);
        assert!(solve(&matrix, &SVector::from([1.0]), &SVector::repeat(1.0)).is_err());
    }

    #[test]
    fn units_scaled_by_powers_of_two_change_no_bit() {
        let mut seed = 3;
        for _ in 0..100 {
            let matrix = SMatrix::<f64, 3, 3>::from_fn(|_, _| noise(&mut seed));
            let b = SVector::<f64, 3>::from_fn(|_, _| noise(&mut seed));
            let x = solve(&matrix, &b, &SVector::repeat(1.0)).unwrap();
            // Coordinate i in units of 1/unit_i: q' = unit q, so M'_ij = M_ij / (unit_i unit_j).
            let unit = SVector::<f64, 3>::new(1024.0, 1.0, 1.0 / 4096.0);
            let scaled = SMatrix::from_fn(|i, j| matrix[(i, j)] / (unit[i] * unit[j]));
            let y = solve(&scaled, &b.component_div(&unit), &unit).unwrap();
            assert_eq!(y, x.component_mul(&unit));
        }
    }

    #[test]
    fn no_coordinates_no_work() {
        let x = solve(
            &SMatrix::<f64, 0, 0>::zeros(),
            &SVector::zeros(),
            &SVector::zeros(),
        );
        assert_eq!(x, Ok(SVector::<f64, 0>::zeros()));
    }
}
