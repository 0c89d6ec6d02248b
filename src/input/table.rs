//! Tabulated functions: piecewise polynomials with exact antiderivatives.

use super::{Jet, Side};
use crate::input::spline;
use crate::numerics::persist;

/// How a table is read between its rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines. Inner knots, where nothing jumps but the slope, are not breakpoints, but
    /// [joints](Table::next_joint).
    Linear,
    /// Twice continuously differentiable cubic spline with the not-a-knot condition at both ends,
    /// so that a table of a cubic polynomial gives that polynomial. Its inner knots are joints, too.
    Cubic,
    /// Each value holds until the time of the next row; every jump is a breakpoint.
    Previous,
}

/// What a table is before its first and after its last row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outside {
    /// Zero, as a ground record is.
    Zero,
    /// The first and the last value.
    Hold,
}

/// Why rows do not make a table. Row numbers count from 0.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableError {
    /// There are too few rows.
    #[error("a table needs at least {needed} rows, this one has {found}")]
    TooFewRows {
        /// Rows there are.
        found: usize,
        /// Rows that the interpolation needs.
        needed: usize,
    },
    /// A time is not after the one before it.
    #[error("time {time} does not come after {previous}, the time of the row before")]
    UnsortedTime {
        /// Row with the offending time.
        row: usize,
        /// Its time, in s.
        time: f64,
        /// Time of the row before, in s.
        previous: f64,
    },
    /// A time or a value is infinite or not a number.
    #[error("times and values must be finite")]
    NotFinite {
        /// Row of the number.
        row: usize,
    },
    /// The rows are so close, or the values so large, that a coefficient overflows.
    #[error("the table is too steep here for double precision")]
    TooSteep {
        /// Row at which the piece starts.
        row: usize,
    },
    /// The last row of a [`Interpolation::Previous`] table that is zero outside holds for no time,
    /// so its value, which is not zero, would be lost.
    #[error("the last value, {value}, would hold for no time")]
    LastValueUnused {
        /// The last row.
        row: usize,
        /// Its value.
        value: f64,
    },
}

/// A function given by rows (time, value).
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Times of the rows, increasing.
    knots: Vec<f64>,
    /// `pieces[i]` reaches from `knots[i - 1]` to `knots[i]`; the first and the last are outside.
    pieces: Vec<Piece>,
    /// Knots at which the value jumps, and ends at which anything does.
    breakpoints: Vec<f64>,
    interpolation: Interpolation,
    /// Knots a second, on average.
    density: f64,
}

/// c₀ + c₁ s + c₂ s² + c₃ s³ with s = t − origin, and the antiderivatives at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    origin: f64,
    coefficients: [f64; 4],
    integral: f64,
    double_integral: f64,
}

persist!(Piece {
    origin,
    coefficients,
    integral,
    double_integral
});

impl Table {
    /// Hands on the numbers that decide it.
    pub(super) fn content(&self, put: &mut dyn FnMut(f64)) {
        put(self.knots.len() as f64);
        self.knots.iter().copied().for_each(&mut *put);
        for piece in &self.pieces {
            put(piece.origin);
            piece.coefficients.into_iter().for_each(&mut *put);
        }
    }

    /// A table of at least two rows, with strictly increasing times (s).
    ///
    /// # Panics
    /// If there are not as many values as times.
    pub fn new(
        times: &[f64],
        values: &[f64],
        interpolation: Interpolation,
        outside: Outside,
    ) -> Result<Self, TableError> {
        assert_eq!(times.len(), values.len(), "one value for each time");
        check_rows(times, values)?;
        let last = times.len() - 1;
        if (interpolation, outside) == (Interpolation::Previous, Outside::Zero)
            && values[last] != 0.0
        {
            return Err(TableError::LastValueUnused {
                row: last,
                value: values[last],
            });
        }

        let (before, after) = match outside {
            Outside::Zero => (0.0, 0.0),
            Outside::Hold => (values[0], values[last]),
        };
        let constant = |c: f64| [c, 0.0, 0.0, 0.0];
        let inner: Vec<[f64; 4]> = match interpolation {
            Interpolation::Previous => values[..last].iter().map(|&y| constant(y)).collect(),
            Interpolation::Linear => {
                let slope = |i: usize| (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
                (0..last).map(|i| [values[i], slope(i), 0.0, 0.0]).collect()
            }
            Interpolation::Cubic => spline::not_a_knot(times, values),
        };
        if let Some(row) = inner.iter().position(|c| c.iter().any(|x| !x.is_finite())) {
            return Err(TableError::TooSteep { row });
        }

        let origins = std::iter::once(times[0]).chain(times.iter().copied());
        let coefficients = std::iter::once(constant(before))
            .chain(inner)
            .chain(std::iter::once(constant(after)));
        let pieces = origins
            .zip(coefficients)
            .map(|(origin, c)| Piece::new(origin, c))
            .collect::<Vec<_>>();

        let mut table = Table {
            knots: times.to_vec(),
            pieces,
            breakpoints: Vec::new(),
            interpolation,
            density: last as f64 / (times[last] - times[0]),
        };
        table.breakpoints = (0..=last)
            .filter(|&i| table.breaks_at(i))
            .map(|i| times[i])
            .collect();
        table.integrate();
        Ok(table)
    }

    /// Value, rate and antiderivatives at time `t` (s).
    pub fn at(&self, t: f64, side: Side) -> Jet {
        self.pieces[self.piece_index(t, side)].at(t)
    }

    /// Adds the coefficients of the piece about `t`.
    pub(super) fn add_series(&self, t: f64, side: Side, out: &mut [f64]) {
        self.pieces[self.piece_index(t, side)].add_series(t, out);
    }

    /// Whether it is a spline.
    pub(super) fn is_cubic(&self) -> bool {
        self.interpolation == Interpolation::Cubic
    }

    /// Time of the last row, s.
    pub(super) fn end(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// The first row after `t`.
    pub(super) fn next_knot(&self, t: f64) -> f64 {
        let next = self.piece_index(t, Side::Right);
        self.knots.get(next).copied().unwrap_or(f64::INFINITY)
    }

    /// The first knot after `t` at which the motion is to start anew: where the value jumps, or at an end of the table where
    /// anything does.
    pub fn next_breakpoint(&self, t: f64) -> f64 {
        let next = self.breakpoints.partition_point(|&b| b <= t);
        self.breakpoints.get(next).copied().unwrap_or(f64::INFINITY)
    }

    /// The first time after `t` at which two polynomials join, so that the slope, or of a spline the third derivative, may
    /// jump, in s. Infinite where each value holds until it jumps.
    pub fn next_joint(&self, t: f64) -> f64 {
        match self.interpolation {
            Interpolation::Cubic => self.next_knot(t),
            Interpolation::Linear => {
                let first = self.piece_index(t, Side::Right);
                let slope = |i: usize| self.pieces[i].coefficients[1];
                let joint = (first..self.knots.len()).find(|&i| slope(i) != slope(i + 1));
                joint.map_or(f64::INFINITY, |i| self.knots[i])
            }
            Interpolation::Previous => f64::INFINITY,
        }
    }

    /// How many knots are before `t`, one at `t` counted for the limit from the right.
    fn piece_index(&self, t: f64, side: Side) -> usize {
        let is_before = |&knot: &f64| match side {
            Side::Right => knot <= t,
            Side::Left => knot < t,
        };
        // Most records are sampled uniformly: there the index follows from the time, up to one
        // for rounding. The cast saturates, so times outside give the ends.
        let guess = ((t - self.knots[0]) * self.density) as usize;
        let fits = |&i: &usize| {
            i.checked_sub(1).is_none_or(|i| is_before(&self.knots[i]))
                && self.knots.get(i).is_none_or(|knot| !is_before(knot))
        };
        // Behind so many steps of the first knot there is one knot more.
        let near = guess.saturating_add(1).min(self.knots.len());
        let others = [near - 1, (near + 1).min(self.knots.len())];
        match fits(&near) {
            true => near,
            false => (others.into_iter().find(fits))
                .unwrap_or_else(|| self.knots.partition_point(is_before)),
        }
    }

    /// Whether a knot is a breakpoint. At inner knots lines and splines go on continuously by construction; whether their
    /// rounded values agree to the last bit does not matter.
    fn breaks_at(&self, knot: usize) -> bool {
        let (left, right) = (&self.pieces[knot], &self.pieces[knot + 1]);
        let last = self.knots.len() - 1;
        if knot == 0 {
            return left.coefficients[..3] != right.coefficients[..3];
        }
        match self.interpolation {
            Interpolation::Previous => left.coefficients != right.coefficients,
            Interpolation::Linear | Interpolation::Cubic if knot < last => false,
            // At the last knot the outside is constant: zero, or the last value.
            Interpolation::Linear | Interpolation::Cubic => {
                let span = self.knots[last] - left.origin;
                let [_, c1, c2, c3] = left.coefficients;
                let continuous =
                    right.coefficients[0] != 0.0 || left.at(self.knots[last]).value == 0.0;
                let smooth = continuous
                    && c1 + span * (2.0 * c2 + span * 3.0 * c3) == 0.0
                    && 2.0 * c2 + span * 6.0 * c3 == 0.0;
                !smooth
            }
        }
    }

    /// Sets the antiderivatives at the origins of the pieces, outwards from the piece that holds
    /// t = 0, where both are zero.
    fn integrate(&mut self) {
        let base = self.piece_index(0.0, Side::Right);
        let Piece {
            origin,
            coefficients,
            ..
        } = self.pieces[base];
        self.pieces[base] = Piece::from_zero(origin, coefficients);
        let start = self.pieces[base].sums();
        let mut sums = start;
        for i in base..self.knots.len() {
            let Piece {
                origin,
                coefficients,
                ..
            } = self.pieces[i + 1];
            self.pieces[i + 1] = self.pieces[i].next(origin, coefficients, &mut sums);
        }
        let [mut integral, mut double] = start;
        for i in (0..base).rev() {
            // The first piece has the origin of the second.
            let end = self.pieces[i + 1].origin;
            self.pieces[i].integral = integral.add(-self.pieces[i].increment(end).0);
            self.pieces[i].double_integral = double.add(-self.pieces[i].increment(end).1);
        }
    }
}

impl Piece {
    /// A piece whose antiderivatives are zero at t = 0.
    pub(super) fn from_zero(origin: f64, coefficients: [f64; 4]) -> Self {
        let mut piece = Piece::new(origin, coefficients);
        // Both integrals, taken from its origin, are zero at the origin.
        piece.integral = -piece.at(0.0).integral;
        piece.double_integral = -piece.at(0.0).double_integral;
        piece
    }

    /// The sums that the antiderivatives of pieces after this one, or before it, go on with.
    pub(super) fn sums(&self) -> [Sum; 2] {
        [self.integral, self.double_integral].map(Sum::new)
    }

    /// The piece that follows this one; `sums` are those up to the origin of this one, and go on to that of the next.
    pub(super) fn next(&self, origin: f64, coefficients: [f64; 4], sums: &mut [Sum; 2]) -> Self {
        let (integral, double_integral) = self.increment(origin);
        Piece {
            integral: sums[0].add(integral),
            double_integral: sums[1].add(double_integral),
            ..Piece::new(origin, coefficients)
        }
    }

    /// Whether this piece and another are the same constant.
    pub(super) fn is_same_constant(&self, other: &Piece) -> bool {
        let [_, slopes @ ..] = self.coefficients;
        slopes == [0.0; 3] && self.coefficients == other.coefficients
    }

    /// Adds the coefficients of the function in powers of the time after `t` (s).
    pub(super) fn add_series(&self, t: f64, out: &mut [f64]) {
        let [_, _, c2, c3] = self.coefficients;
        let Jet { rate, value, .. } = self.at(t);
        let about_t = [value, rate, c2 + 3.0 * c3 * (t - self.origin), c3];
        for (out, c) in out.iter_mut().zip(about_t) {
            *out += c;
        }
    }

    fn new(origin: f64, coefficients: [f64; 4]) -> Self {
        Piece {
            origin,
            coefficients,
            integral: 0.0,
            double_integral: 0.0,
        }
    }

    pub(super) fn at(&self, t: f64) -> Jet {
        let [c0, c1, c2, c3] = self.coefficients;
        let s = t - self.origin;
        let (integral, double_integral) = self.increment(t);
        Jet {
            rate: c1 + s * (2.0 * c2 + s * 3.0 * c3),
            value: c0 + s * (c1 + s * (c2 + s * c3)),
            integral: self.integral + integral,
            double_integral: self.double_integral + double_integral,
        }
    }

    /// By how much the two antiderivatives grow from the origin to `t`.
    fn increment(&self, t: f64) -> (f64, f64) {
        let [c0, c1, c2, c3] = self.coefficients;
        let s = t - self.origin;
        (
            s * (c0 + s * (c1 / 2.0 + s * (c2 / 3.0 + s * (c3 / 4.0)))),
            s * (self.integral
                + s * (c0 / 2.0 + s * (c1 / 6.0 + s * (c2 / 12.0 + s * (c3 / 20.0))))),
        )
    }
}

/// A compensated sum (Neumaier 1974): a record has thousands of rows, and its antiderivatives are
/// to be as good as the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sum {
    sum: f64,
    compensation: f64,
}

persist!(Sum { sum, compensation });

impl Sum {
    fn new(start: f64) -> Self {
        Sum {
            sum: start,
            compensation: 0.0,
        }
    }

    /// Adds a term and gives the sum so far.
    fn add(&mut self, term: f64) -> f64 {
        let sum = self.sum + term;
        self.compensation += if self.sum.abs() >= term.abs() {
            (self.sum - sum) + term
        } else {
            (term - sum) + self.sum
        };
        self.sum = sum;
        self.sum + self.compensation
    }
}

fn check_rows(times: &[f64], values: &[f64]) -> Result<(), TableError> {
    // One row has no extent in time, whatever the interpolation.
    const NEEDED: usize = 2;
    if let Some(row) = times
        .iter()
        .zip(values)
        .position(|(t, y)| !t.is_finite() || !y.is_finite())
    {
        return Err(TableError::NotFinite { row });
    }
    if let Some(i) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(TableError::UnsortedTime {
            row: i + 1,
            time: times[i + 1],
            previous: times[i],
        });
    }
    if times.len() < NEEDED {
        return Err(TableError::TooFewRows {
            found: times.len(),
            needed: NEEDED,
        });
    }
    Ok(())
}
