//! Vectors and matrices of a size that is known when the program is compiled, or when it runs.
//!
//! What works with them is written once, for a [`Size`]: every number is made by the same operations in the same order
//! whichever it is, so that the bits are the same.

use super::buffer::{Buffer, Stored};
use super::persist::{Memory, Persist};
use super::series::{ORDERS, stretch, sum, sum_of};
pub use nalgebra::Const;
use nalgebra::{SMatrix, SVector};
use std::fmt::Debug;
use std::ops::{Index, IndexMut, Range};
use std::slice::SliceIndex;

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
    /// Coefficients of each coordinate, a row an order: [`ORDERS`] rows one behind the other.
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

impl<const N: usize> Size for Const<N> {
    type Vector = SVector<f64, N>;
    type Matrix = SMatrix<f64, N, N>;
    type List<T: Stored> = [T; N];
    type Square<T: Stored> = SquareArray<T, N>;
    type Rows = [SVector<f64, N>; ORDERS];
    type Row = SVector<f64, N>;

    #[inline(always)]
    fn get(self) -> usize {
        N
    }

    #[inline(always)]
    fn vector(self, mut component: impl FnMut(usize) -> f64) -> Self::Vector {
        SVector::from_fn(|i, _| component(i))
    }

    #[inline(always)]
    fn zeros(self) -> Self::Vector {
        SVector::zeros()
    }

    #[inline(always)]
    fn zero_matrix(self) -> Self::Matrix {
        SMatrix::zeros()
    }

    #[inline(always)]
    fn list<T: Stored>(self, entry: T) -> Self::List<T> {
        [entry; N]
    }

    #[inline(always)]
    fn square<T: Stored>(self, entry: T) -> Self::Square<T> {
        SquareArray([[entry; N]; N])
    }

    fn rows(self) -> Self::Rows {
        [SVector::zeros(); ORDERS]
    }

    #[inline(always)]
    fn with_room<const K: usize, R>(self, with: impl FnOnce(&mut [f64]) -> R) -> R {
        with([[0.0; N]; K].as_flattened_mut())
    }

    #[inline(always)]
    fn write_three(self, out: &mut [Self::Matrix; 3], write: impl FnOnce(*mut f64)) {
        write(out.as_mut_ptr().cast());
    }

    #[inline(always)]
    fn matrix_and_vector(self, write: impl FnOnce(*mut f64)) -> (Self::Matrix, Self::Vector) {
        #[repr(C)]
        struct Out<const N: usize>(SMatrix<f64, N, N>, SVector<f64, N>);
        let mut out = Out::<N>(SMatrix::zeros(), SVector::zeros());
        write((&raw mut out).cast());
        (out.0, out.1)
    }
}

impl<const N: usize> Vector for SVector<f64, N> {
    type Size = Const<N>;

    #[inline(always)]
    fn size(&self) -> Const<N> {
        Const
    }
    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        &self.data.0[0]
    }
    #[inline(always)]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.data.0[0]
    }
}

impl<const N: usize> Matrix for SMatrix<f64, N, N> {
    type Size = Const<N>;

    #[inline(always)]
    fn size(&self) -> Const<N> {
        Const
    }
    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        self.data.0.as_flattened()
    }
    #[inline(always)]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self.data.0.as_flattened_mut()
    }
}

/// A square of known size.
#[derive(Debug, Clone, Copy)]
pub struct SquareArray<T, const N: usize>([[T; N]; N]);

impl<T, const N: usize> Index<(usize, usize)> for SquareArray<T, N> {
    type Output = T;
    #[inline(always)]
    fn index(&self, (i, j): (usize, usize)) -> &T {
        &self.0[i][j]
    }
}

impl<T, const N: usize> IndexMut<(usize, usize)> for SquareArray<T, N> {
    #[inline(always)]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut T {
        &mut self.0[i][j]
    }
}

impl<T: Persist, const N: usize> Persist for SquareArray<T, N> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.0.persist(memory)
    }
}

impl<T: Stored, const N: usize> Square<T> for SquareArray<T, N> {
    #[inline(always)]
    fn swap_rows(&mut self, i: usize, j: usize) {
        self.0.swap(i, j);
    }
}

impl<const N: usize> Rows for [SVector<f64, N>; ORDERS] {
    type Row = SVector<f64, N>;
    type Size = Const<N>;
    #[inline(always)]
    fn as_ptr(&self) -> *const f64 {
        <[_]>::as_ptr(self).cast()
    }
    #[inline(always)]
    fn as_mut_ptr(&mut self) -> *mut f64 {
        <[_]>::as_mut_ptr(self).cast()
    }
    #[inline(always)]
    fn size(&self) -> Const<N> {
        Const
    }
    #[inline(always)]
    fn sum(&self, orders: Range<usize>, tau: f64) -> SVector<f64, N> {
        sum(&self[orders], tau)
    }
    #[inline(always)]
    fn stretch(&self, (count, index): (usize, usize), to: (f64, f64, usize), out: &mut [f64]) {
        stretch(&self[..count], |row| row[index], to, out);
    }
}

/// A number that is known when the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dynamic(pub usize);

impl Size for Dynamic {
    type Vector = Buffer<f64>;
    type Matrix = SquareBuffer<f64>;
    type List<T: Stored> = Buffer<T>;
    type Square<T: Stored> = SquareBuffer<T>;
    type Rows = RowBuffer;
    type Row = [f64];

    #[inline(always)]
    fn get(self) -> usize {
        self.0
    }

    #[inline(always)]
    fn vector(self, component: impl FnMut(usize) -> f64) -> Buffer<f64> {
        Buffer::from_fn(self.0, component)
    }

    fn zeros(self) -> Buffer<f64> {
        Buffer::repeat(0.0, self.0)
    }

    fn zero_matrix(self) -> SquareBuffer<f64> {
        self.square(0.0)
    }

    fn list<T: Stored>(self, entry: T) -> Buffer<T> {
        Buffer::repeat(entry, self.0)
    }

    fn square<T: Stored>(self, entry: T) -> SquareBuffer<T> {
        SquareBuffer {
            size: self.0,
            entries: Buffer::repeat(entry, self.0 * self.0),
        }
    }

    fn rows(self) -> RowBuffer {
        RowBuffer {
            width: self.0,
            entries: Buffer::repeat(0.0, ORDERS * self.0),
        }
    }

    fn with_room<const K: usize, R>(self, with: impl FnOnce(&mut [f64]) -> R) -> R {
        with(&mut Buffer::repeat(0.0, K * self.0))
    }

    fn write_three(self, out: &mut [SquareBuffer<f64>; 3], write: impl FnOnce(*mut f64)) {
        let count = self.0 * self.0;
        let mut room = Buffer::from_fn(3 * count, |i| out[i / count].entries[i % count]);
        write(room.as_mut_ptr());
        for (k, matrix) in out.iter_mut().enumerate() {
            matrix.entries.copy_from_slice(&room[k * count..][..count]);
        }
    }

    fn matrix_and_vector(self, write: impl FnOnce(*mut f64)) -> (SquareBuffer<f64>, Buffer<f64>) {
        let count = self.0 * self.0;
        let mut out = Buffer::repeat(0.0, count + self.0);
        write(out.as_mut_ptr());
        let matrix = SquareBuffer {
            size: self.0,
            entries: Buffer::from_fn(count, |i| out[i]),
        };
        (matrix, self.vector(|i| out[count + i]))
    }
}

impl Vector for Buffer<f64> {
    type Size = Dynamic;

    #[inline(always)]
    fn size(&self) -> Dynamic {
        Dynamic(self.len())
    }
    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        self
    }
    #[inline(always)]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }
}

impl<T: Stored, I: SliceIndex<[T]>> Index<I> for Buffer<T> {
    type Output = I::Output;
    #[inline(always)]
    fn index(&self, i: I) -> &I::Output {
        &(**self)[i]
    }
}

impl<T: Stored, I: SliceIndex<[T]>> IndexMut<I> for Buffer<T> {
    #[inline(always)]
    fn index_mut(&mut self, i: I) -> &mut I::Output {
        &mut (**self)[i]
    }
}

/// A square whose size is known when the program runs, column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct SquareBuffer<T: Stored> {
    size: usize,
    entries: Buffer<T>,
}

impl<T: Stored> Index<(usize, usize)> for SquareBuffer<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, (i, j): (usize, usize)) -> &T {
        &self.entries[j * self.size + i]
    }
}

impl<T: Stored> IndexMut<(usize, usize)> for SquareBuffer<T> {
    #[inline(always)]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut T {
        &mut self.entries[j * self.size + i]
    }
}

impl<T: Stored> Persist for SquareBuffer<T> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.entries.persist(memory)
    }
}

impl<T: Stored> Square<T> for SquareBuffer<T> {
    fn swap_rows(&mut self, i: usize, j: usize) {
        for column in self.entries.chunks_exact_mut(self.size) {
            column.swap(i, j);
        }
    }
}

impl Matrix for SquareBuffer<f64> {
    type Size = Dynamic;

    #[inline(always)]
    fn size(&self) -> Dynamic {
        Dynamic(self.size)
    }
    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        &self.entries
    }
    #[inline(always)]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.entries
    }
}

/// Rows of a length that is known when the program runs.
#[derive(Debug, Clone, PartialEq)]
pub struct RowBuffer {
    width: usize,
    entries: Buffer<f64>,
}

impl Index<usize> for RowBuffer {
    type Output = [f64];
    #[inline(always)]
    fn index(&self, k: usize) -> &[f64] {
        &self.entries[k * self.width..][..self.width]
    }
}

impl IndexMut<usize> for RowBuffer {
    #[inline(always)]
    fn index_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.entries[k * self.width..][..self.width]
    }
}

impl Persist for RowBuffer {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.entries.persist(memory)
    }
}

impl Rows for RowBuffer {
    type Row = [f64];
    type Size = Dynamic;
    fn as_ptr(&self) -> *const f64 {
        self.entries.as_ptr()
    }
    fn as_mut_ptr(&mut self) -> *mut f64 {
        self.entries.as_mut_ptr()
    }
    fn size(&self) -> Dynamic {
        Dynamic(self.width)
    }
    fn sum(&self, orders: Range<usize>, tau: f64) -> Buffer<f64> {
        let rows = &self.entries[orders.start * self.width..orders.end * self.width];
        Buffer::from_fn(self.width, |i| {
            sum_of(orders.len(), |k| rows[k * self.width + i], tau)
        })
    }
    fn stretch(&self, (count, index): (usize, usize), to: (f64, f64, usize), out: &mut [f64]) {
        let places: [usize; ORDERS] = std::array::from_fn(|k| k);
        stretch(&places[..count], |k| self[*k][index], to, out);
    }
}
