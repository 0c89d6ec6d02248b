//! One-step methods, made once for each mode and kept.

use std::any::Any;

/// The methods that were used so far, by mode. Making one costs as much as many steps, and a method
/// remembers what it has learnt.
#[derive(Default)]
pub(super) struct Solvers {
    /// One list a mode, of at most one method of each type.
    kept: Vec<Vec<Box<dyn Any>>>,
}

impl Solvers {
    /// Takes the method of type `M` of a mode out, or makes it.
    pub fn take<M: Any>(&mut self, mode: usize, make: impl FnOnce() -> M) -> Box<M> {
        let kept = self.kept.get_mut(mode);
        let found = kept.and_then(|kept| {
            let place = kept.iter().position(|method| method.is::<M>())?;
            kept.swap_remove(place).downcast().ok()
        });
        found.unwrap_or_else(|| Box::new(make()))
    }

    /// Puts a method back.
    pub fn keep<M: Any>(&mut self, mode: usize, method: Box<M>) {
        if self.kept.len() <= mode {
            self.kept.resize_with(mode + 1, Vec::new);
        }
        self.kept[mode].push(method);
    }
}
