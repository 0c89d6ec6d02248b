//! Expressions as lists of instructions, written by `codegen/tape.py`, and their expansion order by order.

use crate::kernel::sin_cos;
use crate::numerics::Bounded;

/// Coefficients of an expansion, that of order 0 included. A guard of a mechanical system leaves zero with one of its
/// first six derivatives as a rule (a force that sets in with a cubic input moves a coordinate by its fifth); as many
/// again tell how long they decide.
pub const JET_ORDERS: usize = 12;

/// A column of expressions.
#[derive(Debug)]
pub struct Tape {
    /// In the order in which they are carried out.
    pub instructions: Box<[Instruction]>,
    /// The places of those that are the results.
    pub results: Box<[usize]>,
}

/// One operation; operands by the place of their instruction.
#[derive(Debug, Clone, Copy)]
pub enum Instruction {
    /// A number.
    Constant(f64),
    /// A free coordinate of the model.
    Coordinate(usize),
    /// Where the mode holds a coordinate, or any was as it began.
    Held(usize),
    /// Its rate.
    Rate(usize),
    /// Its acceleration.
    Acceleration(usize),
    /// A signal of an input.
    Signal(usize),
    /// A discrete state.
    Discrete(usize),
    /// A parameter.
    Parameter(usize),
    /// x + y.
    Sum(usize, usize),
    /// x − y.
    Difference(usize, usize),
    /// x y.
    Product(usize, usize),
    /// x / y.
    Quotient(usize, usize),
    /// −x.
    Negative(usize),
    /// z = f(x), with dz/dt = w dx/dt: x and w. That may stand behind z, or be z.
    Function(Name, usize, usize),
    /// What is not smooth, of what does not change in time.
    Fixed(Pick, usize, usize),
}

/// A smooth function.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub enum Name {
    SquareRoot,
    Exponential,
    Logarithm,
    Sine,
    Cosine,
    Tangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
    HyperbolicSine,
    HyperbolicCosine,
    HyperbolicTangent,
}

/// An operation that is not smooth, on two operands or the first of them.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub enum Pick {
    Least,
    Greatest,
    Less,
    NotMore,
    Equal,
    Unequal,
    Not,
    And,
    Or,
    /// The second where the first is true, else 0.
    Where,
    Modulus,
    Sign,
    Floor,
    Ceiling,
}

/// Coefficients of powers of time.
pub(crate) type Powers = [Bounded; JET_ORDERS];

/// What an expression is made of: rows of coefficients, one a coordinate, signal and so on.
#[derive(Debug)]
pub(crate) struct Operands {
    pub q: Vec<Powers>,
    pub held: Vec<Powers>,
    pub v: Vec<Powers>,
    pub a: Vec<Powers>,
    pub signals: Vec<Powers>,
    pub discrete: Vec<f64>,
    pub parameters: Vec<f64>,
}

impl Tape {
    /// The coordinates whose accelerations what an instruction gives depends on.
    pub(super) fn accelerations_of(&self, place: usize) -> Vec<usize> {
        let mut is_needed = vec![false; self.instructions.len()];
        is_needed[place] = true;
        let mut found = Vec::new();
        let mut pending = vec![place];
        while let Some(place) = pending.pop() {
            let operands = match self.instructions[place] {
                Instruction::Acceleration(i) => {
                    found.push(i);
                    continue;
                }
                Instruction::Sum(x, y)
                | Instruction::Difference(x, y)
                | Instruction::Product(x, y)
                | Instruction::Quotient(x, y)
                | Instruction::Function(_, x, y)
                | Instruction::Fixed(_, x, y) => [x, y],
                Instruction::Negative(x) => [x, x],
                _ => continue,
            };
            for operand in operands {
                if !std::mem::replace(&mut is_needed[operand], true) {
                    pending.push(operand);
                }
            }
        }
        found
    }

    /// Appends the coefficients of order `k` of all instructions, given those below. Accelerations that a result does
    /// not depend on need not be known.
    pub(crate) fn expand(&self, k: usize, given: &Operands, rows: &mut [Powers]) {
        let still = |value: f64| match k {
            0 => Bounded::exact(value),
            _ => Bounded::default(),
        };
        for (place, instruction) in self.instructions.iter().enumerate() {
            let next = match *instruction {
                Instruction::Constant(value) => still(value),
                Instruction::Coordinate(i) => given.q[i][k],
                Instruction::Held(i) => given.held[i][k],
                Instruction::Rate(i) => given.v[i][k],
                Instruction::Acceleration(i) => given.a[i][k],
                Instruction::Signal(i) => given.signals[i][k],
                Instruction::Discrete(i) => still(given.discrete[i]),
                Instruction::Parameter(i) => still(given.parameters[i]),
                Instruction::Sum(x, y) => rows[x][k] + rows[y][k],
                Instruction::Difference(x, y) => rows[x][k] - rows[y][k],
                Instruction::Negative(x) => -rows[x][k],
                Instruction::Product(x, y) => {
                    let (x, y) = (&rows[x], &rows[y]);
                    let mut sum = Bounded::default();
                    // What is constant is nothing beyond its first.
                    for j in (0..=k).filter(|&j| !x[j].is_nothing() && !y[k - j].is_nothing()) {
                        sum = sum + x[j] * y[k - j];
                    }
                    sum
                }
                Instruction::Quotient(x, y) => {
                    let mut rest = rows[x][k];
                    for j in 1..=k {
                        rest = rest - rows[y][j] * rows[place][k - j];
                    }
                    rest / rows[y][0]
                }
                Instruction::Function(name, x, _) if k == 0 => name.of(rows[x][0]),
                Instruction::Function(_, x, w) => {
                    let mut sum = Bounded::default();
                    for j in 1..=k {
                        sum = sum + Bounded::exact(j as f64) * rows[x][j] * rows[w][k - j];
                    }
                    sum / Bounded::exact(k as f64)
                }
                Instruction::Fixed(pick, x, y) if k == 0 => pick.of(rows[x][0], rows[y][0]),
                Instruction::Fixed(..) => Bounded::default(),
            };
            rows[place][k] = next;
        }
    }
}

impl Name {
    /// Value at x, and what the error of x makes of it.
    fn of(self, x: Bounded) -> Bounded {
        // Last places that a value may be off by: roots are rounded correctly, sine and cosine are the engine's own, and
        // libraries state less than four for the others.
        const OF_THE_LIBRARY: f64 = 4.0;
        let at = x.value;
        let (value, slope, places) = match self {
            Name::SquareRoot => (at.sqrt(), 0.5 / at.sqrt(), 1.0),
            Name::Exponential => (at.exp(), at.exp(), OF_THE_LIBRARY),
            Name::Logarithm => (at.ln(), 1.0 / at, OF_THE_LIBRARY),
            Name::Sine => (sin_cos(at).0, sin_cos(at).1, 2.0),
            Name::Cosine => (sin_cos(at).1, sin_cos(at).0, 2.0),
            Name::Tangent => (at.tan(), 1.0 + at.tan() * at.tan(), OF_THE_LIBRARY),
            Name::ArcSine => (at.asin(), 1.0 / (1.0 - at * at).sqrt(), OF_THE_LIBRARY),
            Name::ArcCosine => (at.acos(), 1.0 / (1.0 - at * at).sqrt(), OF_THE_LIBRARY),
            Name::ArcTangent => (at.atan(), 1.0 / (1.0 + at * at), OF_THE_LIBRARY),
            Name::HyperbolicSine => (at.sinh(), at.cosh(), OF_THE_LIBRARY),
            Name::HyperbolicCosine => (at.cosh(), at.sinh(), OF_THE_LIBRARY),
            Name::HyperbolicTangent => (at.tanh(), 1.0 - at.tanh() * at.tanh(), OF_THE_LIBRARY),
        };
        let error = match x.error == 0.0 {
            true => 0.0,
            false => slope.abs() * x.error,
        };
        Bounded::rounded(value, 2.0 * places, error)
    }
}

impl Pick {
    /// Of numbers that do not change in time. A choice that rounding decides is as it is in generated code.
    fn of(self, x: Bounded, y: Bounded) -> Bounded {
        let truth = |is: bool| Bounded::exact(f64::from(u8::from(is)));
        let (a, b) = (x.value, y.value);
        match self {
            Pick::Least => match a <= b {
                true => x,
                false => y,
            },
            Pick::Greatest => match a >= b {
                true => x,
                false => y,
            },
            Pick::Less => truth(a < b),
            Pick::NotMore => truth(a <= b),
            Pick::Equal => truth(a == b),
            Pick::Unequal => truth(a != b),
            Pick::Not => truth(a == 0.0),
            Pick::And => truth(a != 0.0 && b != 0.0),
            Pick::Or => truth(a != 0.0 || b != 0.0),
            Pick::Where => match a != 0.0 {
                true => y,
                false => Bounded::default(),
            },
            Pick::Modulus => match a < 0.0 {
                true => -x,
                false => x,
            },
            Pick::Sign => Bounded::exact(match a {
                a if a > 0.0 => 1.0,
                a if a < 0.0 => -1.0,
                a => a,
            }),
            Pick::Floor => Bounded::exact(a.floor()),
            Pick::Ceiling => Bounded::exact(a.ceil()),
        }
    }
}
