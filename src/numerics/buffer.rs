//! Numbers whose count is known when the program runs.
//!
//! A step makes and drops many short vectors. Their memory goes back to a store of the thread and is taken from it
//! again, so that once each kind was needed nothing is allocated.

use super::persist::{Memory, Persist};
use nalgebra::Complex;
use std::cell::RefCell;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::thread::LocalKey;

/// Memory that is not in use, by the logarithm of its capacity to base 2.
pub struct Store<T> {
    free: Vec<Vec<Vec<T>>>,
    /// How many of each are there, in use or not.
    made: Vec<usize>,
}

impl<T> Store<T> {
    const fn new() -> Self {
        Store {
            free: Vec::new(),
            made: Vec::new(),
        }
    }

    /// What is free of a class, and how many of it are there.
    fn class(&mut self, class: usize) -> (&mut Vec<Vec<T>>, &mut usize) {
        if self.free.len() <= class {
            self.free.resize_with(class + 1, Vec::new);
            self.made.resize(class + 1, 0);
        }
        (&mut self.free[class], &mut self.made[class])
    }

    fn take(&mut self, class: usize) -> Vec<T> {
        let (free, made) = self.class(class);
        free.pop().unwrap_or_else(|| {
            *made += 1;
            // So that there is room when all are given back.
            free.reserve(*made);
            Vec::with_capacity(1 << class)
        })
    }

    fn give_back(&mut self, mut memory: Vec<T>) {
        // Of another thread, perhaps: any class is as good as the one that it was made for, as long as it fits.
        let class = memory.capacity().ilog2() as usize;
        memory.clear();
        self.class(class).0.push(memory);
    }
}

/// What buffers hold.
pub trait Stored: Copy + fmt::Debug + PartialEq + Persist + 'static {
    /// The store of this thread.
    fn store() -> &'static LocalKey<RefCell<Store<Self>>>;
}

macro_rules! stored {
    ($($of:ty),*) => {
        $(impl Stored for $of {
            fn store() -> &'static LocalKey<RefCell<Store<Self>>> {
                thread_local! {
                    static STORE: RefCell<Store<$of>> = const { RefCell::new(Store::new()) };
                }
                &STORE
            }
        })*
    };
}
stored!(f64, Complex<f64>, usize, bool);

/// Numbers whose count stays as it is; a slice.
pub struct Buffer<T: Stored>(Vec<T>);

impl<T: Stored> Buffer<T> {
    fn room(count: usize) -> Vec<T> {
        match count {
            0 => Vec::new(),
            // Behind the end of the thread nothing is stored any more.
            _ => T::store()
                .try_with(|store| {
                    let class = count.next_power_of_two().ilog2() as usize;
                    store.borrow_mut().take(class)
                })
                .unwrap_or_default(),
        }
    }

    /// So many times the same.
    pub fn repeat(value: T, count: usize) -> Self {
        let mut room = Self::room(count);
        room.resize(count, value);
        Buffer(room)
    }

    /// What a function gives for each place.
    #[inline]
    pub fn from_fn(count: usize, value: impl FnMut(usize) -> T) -> Self {
        let mut room = Self::room(count);
        room.extend((0..count).map(value));
        Buffer(room)
    }
}

impl<T: Stored> Drop for Buffer<T> {
    fn drop(&mut self) {
        let memory = std::mem::take(&mut self.0);
        if memory.capacity() > 0 {
            let _ = T::store().try_with(|store| store.borrow_mut().give_back(memory));
        }
    }
}

impl<T: Stored> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        let mut room = Self::room(self.len());
        room.extend_from_slice(self);
        Buffer(room)
    }

    fn clone_from(&mut self, source: &Self) {
        match self.len() == source.len() {
            true => self.copy_from_slice(source),
            false => *self = source.clone(),
        }
    }
}

impl<T: Stored> Deref for Buffer<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T: Stored> DerefMut for Buffer<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

impl<T: Stored> fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<T: Stored> PartialEq for Buffer<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Stored> Persist for Buffer<T> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.iter_mut().try_for_each(|value| value.persist(memory))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_was_dropped_is_taken_again() {
        let one = Buffer::repeat(1.0, 5);
        let place = one.as_ptr();
        drop(one);
        let other = Buffer::from_fn(7, |i| i as f64);
        assert_eq!(other.as_ptr(), place);
        assert_eq!(*other, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_ne!(other.clone().as_ptr(), place);
    }

    #[test]
    fn nothing_is_no_memory() {
        assert_eq!(Buffer::repeat(1.0, 0).0.capacity(), 0);
        assert_eq!(Buffer::repeat(false, 0).clone().0.capacity(), 0);
    }
}
