//! A function of time as a sum of simple terms.

use super::commanded::{Command, Commanded};
use super::lanes::LaneJet;
use super::sine::{self, Sine};
use super::{Signals, Table};
use crate::numerics::{LaneMask, Lanes, Side};
use crate::numerics::{Memory, Persist};

/// A function of time and what is needed of it at one instant. Units: those of the function f,
/// per second, times second and times second squared.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Jet {
    /// f′(t).
    pub rate: f64,
    /// f(t).
    pub value: f64,
    /// ∫₀ᵗ f.
    pub integral: f64,
    /// ∫₀ᵗ ∫₀ˢ f.
    pub double_integral: f64,
}

impl std::ops::Add for Jet {
    type Output = Jet;
    fn add(self, other: Jet) -> Jet {
        Jet {
            rate: self.rate + other.rate,
            value: self.value + other.value,
            integral: self.integral + other.integral,
            double_integral: self.double_integral + other.double_integral,
        }
    }
}

/// A prescribed function of time: a sum of constants, sines, tables, and of what the caller commands while a run goes
/// on. The empty sum is zero.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Function {
    terms: Vec<Term>,
}

#[derive(Debug, Clone, PartialEq)]
enum Term {
    Constant(f64),
    Sine(Sine),
    Table(Table),
    Commanded(Commanded),
    Start(Start),
}

/// Where a motion is at t = 0, and its rate there: zero as an acceleration.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Start {
    pub place: f64,
    pub rate: f64,
}

impl Function {
    /// The function that is zero.
    pub fn zero() -> Self {
        Function::default()
    }

    /// A constant.
    pub fn constant(value: f64) -> Self {
        Function {
            terms: vec![Term::Constant(value)],
        }
    }

    /// A value that the caller changes while a run goes on, by [`crate::hybrid::Simulator::command`].
    pub fn commanded(initial: f64) -> Self {
        Function {
            terms: vec![Term::Commanded(Commanded::new(initial))],
        }
    }

    /// Where the motion is at t = 0 whose acceleration this is.
    pub(super) fn start(&self) -> Start {
        let start = |term: &Term| match term {
            Term::Start(start) => Some(*start),
            _ => None,
        };
        self.terms.iter().find_map(start).unwrap_or_default()
    }

    /// The same acceleration of a motion that starts elsewhere.
    pub(super) fn starting(mut self, start: Start) -> Self {
        self.terms.retain(|term| !matches!(term, Term::Start(_)));
        if start != Start::default() {
            self.terms.push(Term::Start(start));
        }
        self
    }

    /// Whether the caller changes it while a run goes on.
    pub fn is_commanded(&self) -> bool {
        let is_commanded = |term: &Term| matches!(term, Term::Commanded(_));
        self.terms.iter().any(is_commanded)
    }

    /// Commands the first of its terms that can be, from time `t` (s) on. Gives whether the function changes, or `None`
    /// if it has no such term.
    pub(super) fn command(&mut self, t: f64, command: Command) -> Option<bool> {
        self.terms.iter_mut().find_map(|term| match term {
            Term::Commanded(term) => Some(term.command(t, command)),
            _ => None,
        })
    }

    /// What was commanded, written or read.
    pub(super) fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.terms.iter_mut().try_for_each(|term| match term {
            Term::Commanded(term) => term.persist(memory),
            _ => Some(()),
        })
    }

    /// Forgets all commands.
    pub(super) fn rewind(&mut self) {
        for term in &mut self.terms {
            if let Term::Commanded(term) = term {
                term.rewind();
            }
        }
    }

    /// The sum of functions.
    pub fn sum(functions: impl IntoIterator<Item = Function>) -> Self {
        Function {
            terms: functions.into_iter().flat_map(|f| f.terms).collect(),
        }
    }

    /// Hands on the numbers that decide it; a term begins with its kind.
    pub(super) fn content(&self, put: &mut dyn FnMut(f64)) {
        put(self.terms.len() as f64);
        for term in &self.terms {
            match term {
                Term::Constant(value) => [0.0, *value].into_iter().for_each(&mut *put),
                Term::Sine(sine) => {
                    put(1.0);
                    sine.content(put);
                }
                Term::Table(table) => {
                    put(2.0);
                    table.content(put);
                }
                Term::Commanded(commanded) => {
                    put(3.0);
                    commanded.content(put);
                }
                Term::Start(Start { place, rate }) => {
                    [4.0, *place, *rate].into_iter().for_each(&mut *put);
                }
            }
        }
    }

    /// Value, rate and antiderivatives at time `t` (s).
    #[inline(always)]
    pub fn at(&self, t: f64, side: Side) -> Jet {
        if let [Term::Sine(sine)] = &self.terms[..] {
            return sine.at(t, side);
        }
        let mut sum = Jet::default();
        let mut rest = &self.terms[..];
        while let [first, others @ ..] = rest {
            let (sines, behind) = leading_sines(rest);
            (sum, rest) = match rest.len() - behind.len() {
                0 | 1 => (sum + first.at(t, side), others),
                _ => (sine::add_jets(sines, t, side, sum), behind),
            };
        }
        sum
    }

    /// The values alone at up to eight instants; the others are zero.
    #[inline]
    pub(super) fn values(&self, at: &[(f64, Side)]) -> [f64; 8] {
        if let [Term::Sine(sine)] = &self.terms[..] {
            return sine.values(at);
        }
        let mut values = [0.0; 8];
        for (value, &(t, side)) in values.iter_mut().zip(at) {
            *value = self.at(t, side).value;
        }
        values
    }

    /// Fills every `stride`-th entry of `out` with the coefficients of f(t + τ) in powers of τ, of the
    /// function that acts just before or after `t` (s): that of τᵏ, in the unit of f over sᵏ, in
    /// `out[stride · k]`. They are those of one analytic function up to [`Function::next_knot`]. `known`
    /// are value and rate, which [`Function::at`] gave.
    ///
    /// # Panics
    /// If there are more than [`Signals::MOST_ORDERS`] of them.
    #[inline(always)]
    pub fn series(&self, t: f64, side: Side, known: [f64; 2], stride: usize, out: &mut [f64]) {
        if let [Term::Sine(sine)] = &self.terms[..] {
            return sine.fill_series(known, stride, out);
        }
        let out = out.iter_mut().step_by(stride);
        let mut room = [0.0; Signals::MOST_ORDERS];
        let room = &mut room[..out.len()];
        let mut rest = &self.terms[..];
        while let [first, others @ ..] = rest {
            let (sines, behind) = leading_sines(rest);
            rest = if rest.len() - behind.len() > 1 {
                sine::add_series(sines, t, side, room);
                behind
            } else {
                first.add_series(t, side, room);
                others
            };
        }
        out.zip(room).for_each(|(out, c)| *out = *c);
    }

    /// The sine that it is, if it is one.
    pub(super) fn sine(&self) -> Option<&Sine> {
        match &self.terms[..] {
            [Term::Sine(sine)] => Some(sine),
            _ => None,
        }
    }

    /// [`Function::at`] on the right of each of several times, for some lanes. Sines are for [`sine::LaneSines`].
    #[inline]
    pub(super) fn at_lanes<const W: usize>(
        &self,
        lanes: LaneMask,
        t: &Lanes<W>,
        jet: &mut LaneJet<W>,
    ) {
        let lanes = (0..W).filter(|&lane| lanes.is(lane));
        match &self.terms[..] {
            [Term::Table(table)] => {
                lanes.for_each(|lane| jet.set(lane, table.at(t.0[lane], Side::Right)));
            }
            _ => lanes.for_each(|lane| jet.set(lane, self.at(t.0[lane], Side::Right))),
        }
    }

    /// [`Function::series`] for each of several times, into every `stride`-th of `rows`, for some lanes. Sines are for
    /// [`sine::LaneSines`].
    #[inline]
    pub(super) fn series_of_lanes<const W: usize>(
        &self,
        lanes: LaneMask,
        t: &Lanes<W>,
        jet: &LaneJet<W>,
        stride: usize,
        rows: &mut [Lanes<W>],
    ) {
        let [rate, value, ..] = jet.0;
        // What jets tell is all of a constant, and of a straight line.
        let is_line_in_pieces = match &self.terms[..] {
            [] => true,
            [Term::Table(table)] => !table.is_cubic(),
            _ => false,
        };
        if is_line_in_pieces {
            for (k, row) in rows.iter_mut().step_by(stride).enumerate() {
                let own = match k {
                    0 => &value,
                    1 => &rate,
                    _ => &Lanes::of(0.0),
                };
                match lanes == LaneMask::ALL {
                    true => *row = *own,
                    false => lanes.lanes().for_each(|lane| row.0[lane] = own.0[lane]),
                }
            }
            return;
        }
        let mut room = [0.0; Signals::MOST_ORDERS];
        let room = &mut room[..rows.len().div_ceil(stride)];
        for lane in (0..W).filter(|&lane| lanes.is(lane)) {
            let known = [value, rate].map(|x| x.0[lane]);
            self.series(t.0[lane], Side::Right, known, 1, room);
            for (row, value) in rows.iter_mut().step_by(stride).zip(&*room) {
                row.0[lane] = *value;
            }
        }
    }

    /// The first time after `t` at which the function is not analytic, in s: a breakpoint or any
    /// knot of a spline; infinite if there is none.
    #[inline(always)]
    pub fn next_knot(&self, t: f64) -> f64 {
        self.terms
            .iter()
            .map(|term| term.next_knot(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// The last time at which the function is not analytic, s; 0 if there is none after the start.
    pub(super) fn last_knot(&self) -> f64 {
        let last = |term: &Term| match term {
            Term::Table(table) => table.end().max(0.0),
            _ => {
                let next = |t: &f64| Some(term.next_knot(*t)).filter(|knot| knot.is_finite());
                std::iter::successors(Some(0.0), next).fold(0.0, f64::max)
            }
        };
        self.terms.iter().map(last).fold(0.0, f64::max)
    }

    /// The first time after `t` at which the function breaks, in s; infinite if there is
    /// none.
    pub fn next_breakpoint(&self, t: f64) -> f64 {
        self.terms
            .iter()
            .map(|term| term.next_breakpoint(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// The first time after `t` at which a slope or a third derivative jumps that no breakpoint tells of: a kink of
    /// a table, a knot of a spline; in s, infinite if there is none.
    pub fn next_joint(&self, t: f64) -> f64 {
        self.terms
            .iter()
            .map(|term| term.next_joint(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// The longest window after `t` over which the function is close to a polynomial of low
    /// degree, in s: a quarter period of a sine. Infinite for polynomials between breakpoints and
    /// joints.
    pub fn resolution(&self, t: f64) -> f64 {
        self.terms
            .iter()
            .map(|term| term.resolution(t))
            .fold(f64::INFINITY, f64::min)
    }
}

impl From<Sine> for Function {
    fn from(sine: Sine) -> Self {
        Function {
            terms: vec![Term::Sine(sine)],
        }
    }
}

impl From<Table> for Function {
    fn from(table: Table) -> Self {
        Function {
            terms: vec![Term::Table(table)],
        }
    }
}

/// The sines that a sum begins with, as many as go side by side, and the terms behind them.
#[inline]
fn leading_sines(terms: &[Term]) -> (impl Iterator<Item = &Sine> + Clone, &[Term]) {
    let sines = terms.iter().map_while(|term| match term {
        Term::Sine(sine) => Some(sine),
        _ => None,
    });
    let sines = sines.take(sine::SIDE_BY_SIDE);
    let behind = &terms[sines.clone().count()..];
    (sines, behind)
}

impl Term {
    fn at(&self, t: f64, side: Side) -> Jet {
        match self {
            Term::Constant(c) => Jet {
                rate: 0.0,
                value: *c,
                integral: c * t,
                double_integral: 0.5 * c * t * t,
            },
            Term::Sine(sine) => sine.at(t, side),
            Term::Table(table) => table.at(t, side),
            Term::Commanded(commanded) => commanded.at(t, side),
            Term::Start(Start { place, rate }) => Jet {
                integral: *rate,
                double_integral: place + rate * t,
                ..Jet::default()
            },
        }
    }

    fn add_series(&self, t: f64, side: Side, out: &mut [f64]) {
        match self {
            Term::Constant(c) => {
                if let Some(first) = out.first_mut() {
                    *first += c;
                }
            }
            Term::Sine(sine) => sine::add_series(std::iter::once(sine), t, side, out),
            Term::Table(table) => table.add_series(t, side, out),
            Term::Commanded(commanded) => commanded.add_series(t, side, out),
            Term::Start(_) => {}
        }
    }

    fn next_knot(&self, t: f64) -> f64 {
        match self {
            Term::Table(table) => table.next_knot(t),
            _ => self.next_breakpoint(t),
        }
    }

    fn next_breakpoint(&self, t: f64) -> f64 {
        match self {
            Term::Constant(_) | Term::Start(_) => f64::INFINITY,
            Term::Sine(sine) => sine.next_breakpoint(t),
            Term::Table(table) => table.next_breakpoint(t),
            Term::Commanded(commanded) => commanded.next_knot(t),
        }
    }

    fn next_joint(&self, t: f64) -> f64 {
        match self {
            Term::Constant(_) | Term::Start(_) | Term::Sine(_) | Term::Commanded(_) => {
                f64::INFINITY
            }
            Term::Table(table) => table.next_joint(t),
        }
    }

    fn resolution(&self, t: f64) -> f64 {
        match self {
            Term::Constant(_) | Term::Start(_) | Term::Table(_) | Term::Commanded(_) => {
                f64::INFINITY
            }
            Term::Sine(sine) => sine.resolution(t),
        }
    }
}
