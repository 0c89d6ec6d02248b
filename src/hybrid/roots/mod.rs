//! Where on a window a guard falls through zero.
//!
//! A guard is a continuous scalar g; its mode is admissible while g ≥ 0. On a window \[a, b\] this
//! module finds the earliest event t\* with a < t\* ≤ b, for a [`Polynomial`] or for any smooth
//! function ([`search`]), or the earliest of several guards ([`earliest`]).
//!
//! # What an event is
//!
//! The guard's own values, as doubles, decide; nothing is nudged, and only 0.0 is zero.
//!
//! * **Fall**: the bracket (`inside`, `outside`) are neighbouring doubles, g(`inside`) ≥ 0 and
//!   g(`outside`) < 0 strictly, and t\* = `outside`: the first state that is strictly crossed.
//!   A guard that is exactly 0 at b has not fallen yet; it falls in the next window or does not.
//! * **Touch**: the guard reaches exactly 0 from above and turns back. `inside` is that place,
//!   `outside` its upper neighbour. A touch is reported by the window in which g leaves zero.
//! * A guard that rises is no event; it changes the remembered sign.
//!
//! # Remembered sign
//!
//! [`Watch`] is what is remembered from before the window, so an event is not found again after its
//! own reset and not missed after it. A guard that starts at exactly 0 is [`Watch::Dormant`]: this
//! zero is no event, whatever its multiplicity. It wakes where it leaves zero: to the positive side
//! it is armed, and any later fall is an event; to the negative side that is reported at once, as
//! [`Kind::LeavesNegative`]. Searching \[a, c\] finds what searching \[a, b\] and then \[b, c\], with the
//! sign that the first search returns, finds.
//!
//! # What is guaranteed, and what is not
//!
//! *Polynomials*: every event is found whose excursion below zero is deeper than the rounding error
//! of evaluating the polynomial, 2n·u·Σ|cₖ|sᵏ (u = 2⁻⁵³). A shallower one, a touch among them, is
//! found if a value at its minimum, as a double, is ≤ 0, and an excursion above zero that is as
//! small does not arm. At s = 0 leading zero coefficients are divided out exactly, so a flight of
//! 1e-300 of the window is a flight. About a root of multiplicity 3 or more the doubles may cross
//! zero more than once; each crossing that is returned is one.
//!
//! *Functions* are represented by Chebyshev interpolants of degree 4, 8, 16, then by halving the
//! window; a decision is taken from an interpolant only where its value exceeds its error, and by
//! the function's own values elsewhere. The error is the sum of the upper half of its coefficients
//! if that is at most a third of the lower half and one more sample differs by no more than such a
//! decay foretells; at degree 4 it is the whole variation. This **assumes** that the coefficients
//! go on to decay, which finitely many values cannot prove: a feature narrower than the spacing of
//! the first six samples may not be seen. Windows of the size of an integrator's step, whose own
//! error control resolves the motion, meet this. Of two crossings closer than their interpolant's
//! error shows, both are found if the value at the extremum between them has the other sign.
//!
//! *Dormant functions* need their values near the start to full relative accuracy, which a guard
//! written in time since its start has. The zero is divided out; a fall after a short flight is
//! then seen down to the last double. Behind a zero of multiplicity 2 or more a *negative*
//! departure that is shorter than rounding, relative to the window, and turns positive is not.
//!
//! *Noise*: a guard that is identically zero but for rounding (x² + y² − 1 on a circle) cannot be
//! told from its values alone. A caller that knows a bound of the rounding error, n·u·Σ|terms| for
//! a sum of n terms, gives it as `noise`: a dormant guard is then asleep until |g| > noise. Without
//! one (0) the noise of a dormant function is measured, from its second differences over 2⁻²⁶ of
//! the window; while its values are no more than that it sleeps on, and the answer says
//! `resolved: false`, because that is a statistical judgement.
//!
//! *Jumps and poles* are closed in on to neighbouring doubles and told apart from falls by
//! [`Kind::Jump`] and [`Kind::Pole`].

mod bracket;
mod chebyshev;
mod doubles;
mod earliest;
mod extrema;
mod first_crossing;
mod function;
mod polynomial;
mod quadratic;
mod walk;

pub(super) use bracket::minimum;
pub use chebyshev::FIRST_POINTS;
pub use earliest::{Earliest, earliest};
pub(super) use earliest::{at_most_one, first_of_several};
pub use function::search;
pub use polynomial::Polynomial;
pub(super) use polynomial::sum_of;
pub(super) use quadratic::straight_crossing;

/// Remembered sign of a guard at the start of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watch {
    /// It was positive: the next fall is an event.
    Armed,
    /// It started at exactly zero and has not left it.
    Dormant,
    /// It is negative: it arms when it becomes positive.
    Violated,
}

impl Watch {
    /// The sign of a guard's value where a segment starts. Only 0.0 (of either sign) is zero; a
    /// value that is not a number counts as violated.
    pub fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Armed
        } else if value == 0.0 {
            Self::Dormant
        } else {
            Self::Violated
        }
    }
}

/// What happens in the bracket of a [`Crossing`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From ≥ 0 to < 0, continuously as far as it was resolved.
    Crossing,
    /// Down to exactly 0 and back up: a tangent touch.
    Touch,
    /// A dormant guard left zero downwards. `inside` is where it last was not below zero, or the
    /// start of the window.
    LeavesNegative,
    /// From ≥ 0 to < 0 by a jump.
    Jump,
    /// The sign changes where |g| grows without bound on both sides; not a zero.
    Pole,
}

/// An event of one guard: neighbouring doubles `inside` < `outside`; its time is `outside`. The engine's own search of a
/// polynomial's fall leaves them some rounding errors apart, or only finds a place near it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Last double before the event, in the unit of the searched variable.
    pub inside: f64,
    /// The event: first double beyond it, in the unit of the searched variable.
    pub outside: f64,
    /// What happens between them.
    pub kind: Kind,
}

/// How closely a search is to isolate the fall of a polynomial that is certainly its only root in a piece of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Isolation {
    /// By a bracket at whose ends the signs are certain, some rounding errors wide.
    Bracket,
    /// By the root itself, `inside` and `outside` in one, before or behind it by some 10⁻⁹ of itself: for a caller who goes on
    /// from there by Newton's method.
    Root,
}

/// Answer of a search on one window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// The earliest event of the window.
    pub crossing: Option<Crossing>,
    /// Remembered sign at the event, or at the window's end where there is none.
    pub watch: Watch,
    /// Whether the guard could be resolved. If not, single values decided, and an event between
    /// them may have been missed; a shorter window or a `noise` bound helps.
    pub resolved: bool,
    /// How near to zero the guard turns, in its unit. With an event: a value down to which it falls (0
    /// for a touch), in the window or as its slope and curvature tell; −∞ where it does not turn. Without one, of a guard
    /// that stays armed: a value that it stays above, but where it rises from its start, be it zero; ∞ of others.
    pub turn: f64,
}

impl Search {
    /// No event; `watch` at the end of the window.
    pub(crate) fn nothing(watch: Watch) -> Self {
        Self {
            crossing: None,
            watch,
            resolved: true,
            turn: f64::INFINITY,
        }
    }

    /// No event; the guard is armed and stays above `turn`, or at it.
    pub(crate) fn above(turn: f64) -> Self {
        Self {
            turn,
            ..Self::nothing(Watch::Armed)
        }
    }

    /// An event, and the remembered sign right after it.
    pub(crate) fn found(inside: f64, outside: f64, kind: Kind, watch: Watch) -> Self {
        Self {
            crossing: Some(Crossing {
                inside,
                outside,
                kind,
            }),
            watch,
            resolved: true,
            turn: match kind {
                Kind::Touch => 0.0,
                _ => f64::NEG_INFINITY,
            },
        }
    }

    /// Of what was found of a guard divided by sᵏ, k = `order`, makes what is found of the guard, whose events are the same:
    /// only how near to zero it turns is another thing. The window is from the zero at s = 0 to the event or the end of the
    /// window, `s`; beside its turn the quotient is no less than `least`, and it is no steeper than `steepest`.
    ///
    /// At a minimum of sᵏ h the quotient h falls with the slope −k h/s, so that s is no less than k h/|h′|. Behind a fall
    /// sᵏ h is deeper than sᵏ times what h falls to.
    pub(crate) fn of_quotient(&mut self, order: usize, (least, steepest): (f64, f64), s: f64) {
        let power = |s: f64| (0..order).fold(1.0, |power, _| power * s);
        if self.crossing.is_some() {
            self.turn *= power(s);
            return;
        }
        let least = least.min(self.turn);
        let nearest = order as f64 * least / steepest;
        // Not where it has no slope at all.
        let place = if nearest < s { nearest } else { s };
        self.turn = match least > 0.0 {
            true => least * power(place),
            false => least,
        };
    }

    /// The same event, of a guard that would turn back at the value `turn`.
    pub(crate) fn turning(self, turn: f64) -> Self {
        Self { turn, ..self }
    }
}
