//! Extrema of an expansion on [0, 1], which cut it into monotone pieces.
//!
//! The roots of f′ separate the pieces of f, those of f″ the pieces of f′, and so on. The descent
//! stops at the first derivative whose coefficients alone decide its number of roots (Descartes'
//! rule in Bernstein form, or a bound of the sum), mostly the first or second.

use super::bracket::close;

/// What the coefficients say about the number of roots in (0, 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Count {
    None,
    /// One, simple, and the values at 0 and 1 have opposite signs.
    One,
    Unknown,
}

/// A finite expansion on [0, 1] that can be differentiated.
pub(super) trait Expansion: Copy {
    fn value(&self, s: f64) -> f64;
    /// A positive multiple of the derivative.
    fn derivative(&self) -> Self;
    /// [`Count::Unknown`] is always allowed, except for a constant: that is [`Count::None`].
    fn count(&self) -> Count;
}

/// Ascending places in (0, 1), at most `N`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extrema<const N: usize> {
    values: [f64; N],
    len: usize,
}

impl<const N: usize> Extrema<N> {
    pub(super) fn new() -> Self {
        Self {
            values: [0.0; N],
            len: 0,
        }
    }

    pub(super) fn push(&mut self, place: f64) {
        self.values[self.len] = place;
        self.len += 1;
    }

    pub(super) fn as_slice(&self) -> &[f64] {
        &self.values[..self.len]
    }
}

/// The extrema of `f` in (0, 1), ascending, each to a neighbouring double as far as f′ decides.
/// `N` is at least the degree of `f`.
pub(super) fn extrema<const N: usize>(f: &impl Expansion) -> Extrema<N> {
    let mut ladder = [f.derivative(); N];
    let mut last = 0;
    while ladder[last].count() == Count::Unknown {
        ladder[last + 1] = ladder[last].derivative();
        last += 1;
    }
    let mut places = Extrema::new();
    if ladder[last].count() == Count::One {
        places = roots_between(&ladder[last], &places);
    }
    for derivative in ladder[..last].iter().rev() {
        places = roots_between(derivative, &places);
    }
    places
}

/// Roots in (0, 1) of `f`, of which `extrema` are the extrema. A root at an extremum counts once.
fn roots_between<const N: usize>(f: &impl Expansion, extrema: &Extrema<N>) -> Extrema<N> {
    let mut roots = Extrema::new();
    let mut left = (0.0, f.value(0.0));
    let ends = extrema.as_slice().iter().copied().chain([1.0]);
    for end in ends {
        let right = (end, f.value(end));
        if left.1 > 0.0 && right.1 < 0.0 {
            roots.push(close(&mut |s| f.value(s), left, right).0.0);
        } else if left.1 < 0.0 && right.1 > 0.0 {
            let flipped = ((left.0, -left.1), (right.0, -right.1));
            roots.push(close(&mut |s| -f.value(s), flipped.0, flipped.1).0.0);
        } else if right.1 == 0.0 && end < 1.0 {
            roots.push(end);
        }
        left = right;
    }
    roots
}
