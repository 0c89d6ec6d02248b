//! A function of time whose values the caller sets while a run goes on.

use super::table::{Piece, Sum};
use super::{Jet, Side};
use crate::numerics::persist;

/// What an input does from the present time of a run on: see [`crate::hybrid::Simulator::command`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// It jumps to a value, in the unit of the input, and holds it (zero-order hold).
    Hold(f64),
    /// It goes along a straight line from the value that it has.
    Ramp {
        /// Value at the end of the line, in the unit of the input; it is held after it.
        to: f64,
        /// When the line ends, s: after the present time.
        until: f64,
    },
}

/// A piece, and the sums that its antiderivatives are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Span {
    piece: Piece,
    sums: [Sum; 2],
}

persist!(Span { piece, sums });

impl Span {
    /// A piece that holds t = 0, where both antiderivatives are zero.
    fn first(value: f64) -> Self {
        let piece = Piece::from_zero(0.0, [value, 0.0, 0.0, 0.0]);
        Span {
            piece,
            sums: piece.sums(),
        }
    }

    /// The piece after this one, from `origin` (s) on; antiderivatives go on.
    fn next(mut self, origin: f64, [value, slope]: [f64; 2]) -> Self {
        let piece = self
            .piece
            .next(origin, [value, slope, 0.0, 0.0], &mut self.sums);
        Span {
            piece,
            sums: self.sums,
        }
    }
}

/// What has been commanded last, and what it was before: with the values and antiderivatives of a [`super::Table`] that
/// had all its rows from the start, but without those that are past.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Commanded {
    /// The value that it starts with.
    initial: f64,
    /// Before, between and after the knots.
    spans: [Span; 3],
    /// When the last command was given, and when its line ends, s.
    knots: [f64; 2],
}

persist!(Commanded {
    initial,
    spans,
    knots
});

impl Commanded {
    /// A value, until something is commanded.
    pub fn new(initial: f64) -> Self {
        Commanded {
            initial,
            spans: [Span::first(initial); 3],
            knots: [f64::INFINITY; 2],
        }
    }

    /// Hands on the number that decides it before a run.
    pub fn content(&self, put: &mut dyn FnMut(f64)) {
        put(self.initial);
    }

    fn span(&self, t: f64, side: Side) -> &Span {
        let is_past = |&&knot: &&f64| match side {
            Side::Right => knot <= t,
            Side::Left => knot < t,
        };
        &self.spans[self.knots.iter().filter(is_past).count()]
    }

    pub fn at(&self, t: f64, side: Side) -> Jet {
        self.span(t, side).piece.at(t)
    }

    pub fn add_series(&self, t: f64, side: Side, out: &mut [f64]) {
        self.span(t, side).piece.add_series(t, out);
    }

    /// The first knot after `t`, s.
    pub fn next_knot(&self, t: f64) -> f64 {
        let knots = self.knots.into_iter();
        knots.filter(|&knot| knot > t).fold(f64::INFINITY, f64::min)
    }

    /// Goes on from time `t` (s) as it is commanded, `t` not before the last command. Gives whether anything changes.
    pub fn command(&mut self, t: f64, command: Command) -> bool {
        let (before, now) = (*self.span(t, Side::Left), *self.span(t, Side::Right));
        // At its origin the value of a piece is its first coefficient, and not a sum that rounds.
        let value = now.piece.at(t).value;
        let hold = match command {
            Command::Hold(to) => Some(to),
            Command::Ramp { to, .. } => (to == value).then_some(to),
        };
        if let Some(to) = hold {
            let held = before.next(t, [to, 0.0]);
            if now.piece.is_same_constant(&held.piece) && self.next_knot(t) == f64::INFINITY {
                return false;
            }
            self.spans = [before, held, held];
            self.knots = [t, f64::INFINITY];
        } else if let Command::Ramp { to, until } = command {
            let line = before.next(t, [value, (to - value) / (until - t)]);
            self.spans = [before, line, line.next(until, [to, 0.0])];
            self.knots = [t, until];
        }
        true
    }

    /// Forgets all commands.
    pub fn rewind(&mut self) {
        *self = Commanded::new(self.initial);
    }
}
