//! Sizes that are known when the program is compiled: arrays, on the stack.

use super::{Const, Matrix, Rows, Size, Square, Vector};
use crate::numerics::buffer::Stored;
use crate::numerics::persist::{Memory, Persist};
use crate::numerics::series::{ORDERS, stretch, sum};
use nalgebra::{SMatrix, SVector};
use std::ops::{Index, IndexMut, Range};

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
