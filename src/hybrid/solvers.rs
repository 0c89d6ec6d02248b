//! One-step methods, made once for each mode and kept.

use super::problem::Accuracy;
use super::segment::tolerances;
use crate::integrate::{Const, Counters, Dynamic, Radau, Series, Size, Taylor};
use crate::kernel::ModeKernels;
use crate::model::Mode;

/// The methods of modes with `F` free coordinates that were used so far, by mode; `None` while one is in use.
/// Making one costs as much as many steps, and a method remembers what it has learnt.
pub(super) struct Slots<F: Size> {
    pub taylor: Box<[Option<Box<Taylor<F>>>]>,
    pub radau_of_five: Box<[Option<Box<Radau<5, F>>>]>,
    pub radau_of_seven: Box<[Option<Box<Radau<7, F>>>]>,
    /// Room for the series of a motion that no step follows.
    pub series: Option<Box<Series<F>>>,
}

impl<F: Size> Slots<F> {
    /// Places by mode; none where no mode is of this kind.
    fn new(modes: &[Mode], is_own: impl Fn(&ModeKernels) -> bool) -> Self {
        let modes = match modes.iter().any(|mode| is_own(&mode.kernels)) {
            true => modes.len(),
            false => 0,
        };
        Slots {
            taylor: (0..modes).map(|_| None).collect(),
            radau_of_five: (0..modes).map(|_| None).collect(),
            radau_of_seven: (0..modes).map(|_| None).collect(),
            series: None,
        }
    }

    /// As [`Taylor::order_between_knots`] of a mode; `None` where it was not used.
    fn order_between_knots(&self, mode: usize) -> Option<usize> {
        self.taylor.get(mode)?.as_ref()?.order_between_knots()
    }

    /// A new run begins: what Radau's method keeps ends with a restart in any case.
    fn forget(&mut self) {
        self.taylor
            .iter_mut()
            .flatten()
            .for_each(|taylor| taylor.forget());
    }

    /// Gives the methods of all modes other absolute tolerances.
    fn set_accuracy(&mut self, modes: &[Mode], accuracy: &Accuracy) {
        fn each<M>(slots: &mut [Option<Box<M>>], modes: &[Mode], set: impl Fn(&mut M, &Mode)) {
            for (slot, mode) in slots.iter_mut().zip(modes) {
                slot.iter_mut().for_each(|method| set(method, mode));
            }
        }
        let of = |size: F, mode: &Mode| tolerances(size, accuracy, mode);
        each(&mut self.taylor, modes, |taylor, mode| {
            taylor.set_tolerances(|size| of(size, mode));
        });
        each(&mut self.radau_of_five, modes, |radau, mode| {
            radau.set_tolerances(|size| of(size, mode));
        });
        each(&mut self.radau_of_seven, modes, |radau, mode| {
            radau.set_tolerances(|size| of(size, mode));
        });
    }

    /// Gives the work done since it was last taken, of each method.
    fn take_counters(&mut self, take: &mut impl FnMut(Counters)) {
        let methods = self.taylor.iter_mut().flatten();
        methods.for_each(|method| take(method.take_counters()));
        let methods = self.radau_of_five.iter_mut().flatten();
        methods.for_each(|method| take(method.take_counters()));
        let methods = self.radau_of_seven.iter_mut().flatten();
        methods.for_each(|method| take(method.take_counters()));
    }
}

/// What has methods for `F` free coordinates.
pub(super) trait SlotsOf<F: Size> {
    fn slots(&mut self) -> &mut Slots<F>;
}

/// By the number of free coordinates: a type each, so that nothing has to be told from a pointer.
macro_rules! solvers {
    ($($name:ident: $kernels:ident of $free:ty),*) => {
        /// The methods that were used so far.
        pub(super) struct Solvers {
            $($name: Slots<$free>,)*
        }

        impl Solvers {
            /// None yet.
            pub fn new(modes: &[Mode]) -> Self {
                Solvers { $($name: Slots::new(modes, |of| matches!(of, ModeKernels::$kernels(_))),)* }
            }

            /// Forgets what was learnt in the run before.
            pub fn forget(&mut self) {
                $(self.$name.forget();)*
            }

            /// Gives the methods that were made so far other absolute tolerances.
            pub fn set_accuracy(&mut self, modes: &[Mode], accuracy: &Accuracy) {
                $(self.$name.set_accuracy(modes, accuracy);)*
            }

            /// As [`Taylor::order_between_knots`] of a mode; `None` where it was not used.
            pub fn order_between_knots(&self, mode: usize) -> Option<usize> {
                None$(.or_else(|| self.$name.order_between_knots(mode)))*
            }

            /// Gives the work done since it was last taken, of each method.
            pub fn take_counters(&mut self, mut take: impl FnMut(Counters)) {
                $(self.$name.take_counters(&mut take);)*
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
    };
}
solvers!(
    none: F0 of Const<0>,
    one: F1 of Const<1>,
    two: F2 of Const<2>,
    three: F3 of Const<3>,
    four: F4 of Const<4>,
    five: F5 of Const<5>,
    six: F6 of Const<6>,
    any: Any of Dynamic
);
