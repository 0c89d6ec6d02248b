//! One-step methods, made once for each mode and kept.

use crate::integrate::{Radau, Taylor};

/// The methods of modes with `F` free coordinates that were used so far, by mode; `None` while one is in use.
/// Making one costs as much as many steps, and a method remembers what it has learnt.
pub(super) struct Slots<const F: usize> {
    pub taylor: Box<[Option<Box<Taylor<F>>>]>,
    pub radau_of_five: Box<[Option<Box<Radau<5, F>>>]>,
    pub radau_of_seven: Box<[Option<Box<Radau<7, F>>>]>,
}

impl<const F: usize> Slots<F> {
    fn new(modes: usize) -> Self {
        Slots {
            taylor: (0..modes).map(|_| None).collect(),
            radau_of_five: (0..modes).map(|_| None).collect(),
            radau_of_seven: (0..modes).map(|_| None).collect(),
        }
    }
}

/// What has methods for `F` free coordinates.
pub(super) trait SlotsOf<const F: usize> {
    fn slots(&mut self) -> &mut Slots<F>;
}

/// By the number of free coordinates: a type each, so that nothing has to be told from a pointer.
macro_rules! solvers {
    ($($name:ident: $free:literal),*) => {
        /// The methods that were used so far.
        pub(super) struct Solvers {
            $($name: Slots<$free>,)*
        }

        impl Solvers {
            /// None yet, of so many modes.
            pub fn new(modes: usize) -> Self {
                Solvers { $($name: Slots::new(modes),)* }
            }
        }

        $(
            impl SlotsOf<$free> for Solvers {
                #[inline(always)]
                fn slots(&mut self) -> &mut Slots<$free> {
                    &mut self.$name
                }
            }
        )*

        const _: () = assert!([$($free),*].len() == crate::kernel::MOST_FREE + 1);
    };
}
solvers!(none: 0, one: 1, two: 2, three: 3, four: 4, five: 5, six: 6);
