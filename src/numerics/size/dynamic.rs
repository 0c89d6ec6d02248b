//! Sizes that are known when the program runs: buffers, from the store of the thread.

use super::{Matrix, Rows, Size, Square, Vector};
use crate::numerics::buffer::{Buffer, Stored};
use crate::numerics::persist::{Memory, Persist};
use crate::numerics::series::{ORDERS, stretch, sum_of};
use std::ops::{Index, IndexMut, Range};
use std::slice::SliceIndex;

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
