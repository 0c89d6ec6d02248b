//! What a run remembers, as words of 64 bits: written and read back without the loss of a bit.
//!
//! One list of fields serves both directions ([`Persist::persist`]), so that what is written is what is read. Types that hold
//! nothing else are listed by `persist!`, where a field that is forgotten does not compile.

use nalgebra::{Complex, SMatrix};

/// Memory that is written, or one that is read.
#[derive(Debug)]
pub enum Memory<'w> {
    /// Words are added at its end.
    Write(&'w mut Vec<u64>),
    /// Words are taken from its start.
    Read(&'w [u64]),
}

impl Memory<'_> {
    /// A word. `None`: there are no more.
    pub fn word(&mut self, word: &mut u64) -> Option<()> {
        match self {
            Memory::Write(words) => words.push(*word),
            Memory::Read(words) => {
                let (first, rest) = words.split_first()?;
                (*word, *words) = (*first, rest);
            }
        }
        Some(())
    }

    /// Whether it is read.
    pub fn is_read(&self) -> bool {
        matches!(self, Memory::Read(_))
    }

    /// Values whose number does not change. `None` if it is another one in the memory.
    pub fn slice<T: Persist>(&mut self, values: &mut [T]) -> Option<()> {
        let mut count = values.len();
        count.persist(self)?;
        (count == values.len()).then_some(())?;
        values.iter_mut().try_for_each(|value| value.persist(self))
    }

    /// Values whose number is in the memory; `blank` makes one to be read into.
    pub fn list<T: Persist>(&mut self, values: &mut Vec<T>, blank: impl Fn() -> T) -> Option<()> {
        let mut count = values.len();
        count.persist(self)?;
        if let Memory::Read(words) = self {
            // Each takes a word at least: what is damaged asks for no room beyond its own size.
            (count <= words.len()).then_some(())?;
            values.clear();
            values.resize_with(count, blank);
        }
        values.iter_mut().try_for_each(|value| value.persist(self))
    }

    /// One of several values that are all that there are, by its place among them.
    pub fn one_of<T: Copy + PartialEq>(&mut self, value: &mut T, all: &[T]) -> Option<()> {
        let mut place = all
            .iter()
            .position(|other| other == value)
            .unwrap_or(all.len());
        place.persist(self)?;
        *value = *all.get(place)?;
        Some(())
    }
}

/// What can be written, and read back.
pub trait Persist {
    /// Writes it, or takes over what is read. `None`: the memory does not fit.
    fn persist(&mut self, memory: &mut Memory) -> Option<()>;
}

impl Persist for u64 {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        memory.word(self)
    }
}

impl Persist for f64 {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let mut bits = self.to_bits();
        memory.word(&mut bits)?;
        *self = f64::from_bits(bits);
        Some(())
    }
}

impl Persist for bool {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        memory.one_of(self, &[false, true])
    }
}

impl Persist for usize {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let mut word = *self as u64;
        memory.word(&mut word)?;
        *self = word.try_into().ok()?;
        Some(())
    }
}

impl Persist for u32 {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let mut word = u64::from(*self);
        memory.word(&mut word)?;
        *self = word.try_into().ok()?;
        Some(())
    }
}

impl Persist for String {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let mut bytes: Vec<u64> = self.bytes().map(u64::from).collect();
        memory.list(&mut bytes, u64::default)?;
        let bytes: Option<Vec<u8>> = bytes.into_iter().map(|b| b.try_into().ok()).collect();
        *self = String::from_utf8(bytes?).ok()?;
        Some(())
    }
}

impl<T: Persist, const N: usize> Persist for [T; N] {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.iter_mut().try_for_each(|value| value.persist(memory))
    }
}

impl<A: Persist, B: Persist> Persist for (A, B) {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.0.persist(memory)?;
        self.1.persist(memory)
    }
}

/// A value that may not be there, whose memory is there all the same.
#[derive(Debug, Clone)]
pub(crate) struct Kept<T> {
    is_there: bool,
    value: T,
}

impl<T> Kept<T> {
    /// Nothing, in this memory.
    pub fn nothing(value: T) -> Self {
        Kept {
            is_there: false,
            value,
        }
    }

    /// It is no longer there.
    pub fn clear(&mut self) {
        self.is_there = false;
    }

    /// The value, if it is there.
    pub fn get(&self) -> Option<&T> {
        self.is_there.then_some(&self.value)
    }

    /// It is there, to be written.
    pub fn write(&mut self) -> &mut T {
        self.is_there = true;
        &mut self.value
    }
}

impl<T: Persist> Persist for Kept<T> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.is_there.persist(memory)?;
        match self.is_there {
            true => self.value.persist(memory),
            false => Some(()),
        }
    }
}

impl<T: Persist + Blank> Persist for Option<T> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let mut is_some = self.is_some();
        is_some.persist(memory)?;
        if memory.is_read() {
            *self = is_some.then(T::blank);
        }
        self.iter_mut().try_for_each(|value| value.persist(memory))
    }
}

/// What an optional value is before it is read.
pub trait Blank {
    /// Any value.
    fn blank() -> Self;
}

impl Blank for f64 {
    fn blank() -> Self {
        0.0
    }
}

impl Blank for bool {
    fn blank() -> Self {
        false
    }
}

impl<A: Blank, B: Blank> Blank for (A, B) {
    fn blank() -> Self {
        (A::blank(), B::blank())
    }
}

impl Persist for Complex<f64> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.re.persist(memory)?;
        self.im.persist(memory)
    }
}

impl<const R: usize, const C: usize> Persist for SMatrix<f64, R, C> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.iter_mut().try_for_each(|value| value.persist(memory))
    }
}

/// Tapes all fields of a type but those that follow from the problem, which stay as they are.
macro_rules! persist {
    ([$($generic:tt)*] $type:ty { $($field:ident),* $(,)? } $(but { $($stays:ident),* $(,)? })?) => {
        impl<$($generic)*> $crate::numerics::Persist for $type {
            fn persist(&mut self, memory: &mut $crate::numerics::Memory) -> Option<()> {
                let Self { $($field,)* $($($stays: _,)*)? } = self;
                $($crate::numerics::Persist::persist($field, memory)?;)*
                Some(())
            }
        }
    };
    ($type:ty { $($field:ident),* $(,)? }) => {
        $crate::numerics::persist!([] $type { $($field),* });
    };
}
pub(crate) use persist;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_comes_back_and_what_does_not_fit_is_refused() {
        let mut value = (f64::from_bits(0x7ff8_0000_dead_beef), [Some(-0.0), None]);
        let mut name = String::from("θ");
        let mut words = Vec::new();
        let mut memory = Memory::Write(&mut words);
        value.persist(&mut memory).unwrap();
        name.persist(&mut memory).unwrap();
        let mut read = (0.0, [None, Some(1.0)]);
        let mut read_name = String::new();
        let mut memory = Memory::Read(&words);
        read.persist(&mut memory).unwrap();
        read_name.persist(&mut memory).unwrap();
        assert_eq!(read.0.to_bits(), value.0.to_bits());
        assert_eq!(
            read.1.map(|x: Option<f64>| x.map(f64::to_bits)),
            [Some(1 << 63), None]
        );
        assert_eq!(read_name, name);
        assert!(matches!(memory, Memory::Read([])));
        assert_eq!(true.persist(&mut Memory::Read(&[2])), None);
        assert_eq!(0_u64.persist(&mut Memory::Read(&[])), None);
        assert_eq!(name.persist(&mut Memory::Read(&[u64::MAX])), None);
        assert_eq!(Memory::Read(&[1, 0]).slice(&mut [0.0; 2]), None);
    }
}
