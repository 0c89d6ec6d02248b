//! One-step methods, made once for each mode and kept.

use std::any::Any;

/// A method, while nobody uses it.
type Kept = Option<Box<dyn Any>>;

/// The methods that were used so far, by mode. Making one costs as much as many steps, and a method
/// remembers what it has learnt.
pub(super) struct Solvers {
    /// Of each mode the explicit and the implicit one.
    kept: Box<[[Kept; 2]]>,
}

impl Solvers {
    /// None yet, of so many modes.
    pub fn new(modes: usize) -> Self {
        Solvers {
            kept: (0..modes).map(|_| [None, None]).collect(),
        }
    }

    /// Takes the method of a mode out, or makes it.
    pub fn take<M: Any>(
        &mut self,
        mode: usize,
        explicit: bool,
        make: impl FnOnce() -> M,
    ) -> Box<M> {
        let kept = self.kept[mode][usize::from(explicit)].take();
        let found = kept.and_then(|method| method.downcast().ok());
        found.unwrap_or_else(|| Box::new(make()))
    }

    /// Puts a method back.
    pub fn keep<M: Any>(&mut self, mode: usize, explicit: bool, method: Box<M>) {
        self.kept[mode][usize::from(explicit)] = Some(method);
    }
}
