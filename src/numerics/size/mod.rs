//! Vectors and matrices of a size that is known when the program is compiled, or when it runs.
//!
//! What works with them is written once, for a [`Size`]: every number is made by the same operations in the same order
//! whichever it is, so that the bits are the same.

mod dynamic;
mod known;

use super::buffer::Stored;
use super::persist::Persist;
pub use dynamic::Dynamic;
pub use nalgebra::Const;
use std::fmt::Debug;
use std::ops::{IndexMut, Range};

/// A number of coordinates: [`Const`], or [`Dynamic`].
pub trait Size: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// A number for each coordinate.
    type Vector: Vector<Size = Self>;
    /// A number for each two coordinates.
    type Matrix: Matrix<Size = Self>;
    /// Something for each coordinate.
    type List<T: Stored>: Clone + Debug + Persist + IndexMut<usize, Output = T>;
    /// Something for each two, (row, column).
    type Square<T: Stored>: Square<T>;
    /// Coefficients of each coordinate, a row an order: [`ORDERS`](crate::numerics::ORDERS) rows one behind the other.
    type Rows: Rows<Row = Self::Row, Size = Self>;
    /// One of these rows.
    type Row: ?Sized + IndexMut<usize, Output = f64>;

    /// The number.
    fn get(self) -> usize;

    /// The vector with these components.
    fn vector(self, component: impl FnMut(usize) -> f64) -> Self::Vector;

    /// The vector whose components are all zero.
    fn zeros(self) -> Self::Vector;

    /// The vector whose components are all the same.
    fn repeat(self, component: f64) -> Self::Vector {
        self.vector(|_| component)
    }

    /// The matrix whose entries are all zero.
    fn zero_matrix(self) -> Self::Matrix;

    /// The list whose entries are all the same.
    fn list<T: Stored>(self, entry: T) -> Self::List<T>;

    /// The square whose entries are all the same.
    fn square<T: Stored>(self, entry: T) -> Self::Square<T>;

    /// All coefficients zero.
    fn rows(self) -> Self::Rows;

    /// Gives zeros for `K` vectors, one behind the other.
    fn with_room<const K: usize, R>(self, with: impl FnOnce(&mut [f64]) -> R) -> R;

    /// Lets three matrices be written column by column, and one behind the other.
    fn write_three(self, out: &mut [Self::Matrix; 3], write: impl FnOnce(*mut f64));

    /// What is written as a matrix, column by column, with a vector behind it.
    fn matrix_and_vector(self, write: impl FnOnce(*mut f64)) -> (Self::Matrix, Self::Vector);
}

/// A number for each coordinate.
pub trait Vector: Clone + Debug + PartialEq + Persist + IndexMut<usize, Output = f64> {
    /// How many there are.
    type Size: Size<Vector = Self>;
    /// How many there are.
    fn size(&self) -> Self::Size;
    /// The numbers.
    fn as_slice(&self) -> &[f64];
    /// The numbers.
    fn as_mut_slice(&mut self) -> &mut [f64];
}

/// A number for each two coordinates.
pub trait Matrix:
    Clone + Debug + PartialEq + Persist + IndexMut<(usize, usize), Output = f64>
{
    /// Number of rows and columns.
    type Size: Size<Matrix = Self>;
    /// Number of rows and columns.
    fn size(&self) -> Self::Size;
    /// The numbers, column by column.
    fn as_slice(&self) -> &[f64];
    /// The numbers, column by column.
    fn as_mut_slice(&mut self) -> &mut [f64];
    /// The matrix times a vector: the columns are added one after the other.
    fn times(&self, vector: &<Self::Size as Size>::Vector) -> <Self::Size as Size>::Vector {
        let size = self.size();
        let n = size.get();
        size.vector(|i| {
            let first = if n > 0 { self[(i, 0)] * vector[0] } else { 0.0 };
            (1..n).fold(first, |sum, j| sum + self[(i, j)] * vector[j])
        })
    }
}

/// Something for each two coordinates, (row, column).
pub trait Square<T>: Clone + Debug + Persist + IndexMut<(usize, usize), Output = T> {
    /// Exchanges two rows.
    fn swap_rows(&mut self, i: usize, j: usize);
}

/// Coefficients, a row an order.
pub trait Rows: Clone + Debug + PartialEq + Persist + IndexMut<usize, Output = Self::Row> {
    /// One of the rows.
    type Row: ?Sized;
    /// Number of numbers in a row.
    type Size: Size<Rows = Self>;
    /// Number of numbers in a row.
    fn size(&self) -> Self::Size;
    /// Where all numbers are, row by row.
    fn as_ptr(&self) -> *const f64;
    /// Where all numbers are, row by row.
    fn as_mut_ptr(&mut self) -> *mut f64;
    /// Σ c_k τᵏ of the rows c of a range.
    fn sum(&self, orders: Range<usize>, tau: f64) -> <Self::Size as Size>::Vector;
    /// Of the first coefficients of a coordinate, (count, index), writes those in powers of s/`scale` of `factor` times
    /// the polynomial in s, (factor, scale, first), from the power `first` on, as many as there is room for.
    fn stretch(&self, of: (usize, usize), to: (f64, f64, usize), out: &mut [f64]);
}
