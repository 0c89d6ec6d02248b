//! What a formula computes.

use super::{Given, Read};
use crate::kernel::sin_cos;

/// A formula as a tree.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Expression {
    Number(f64),
    Read(Read),
    Negative(Box<Expression>),
    Sum(Box<[Expression; 2]>),
    Difference(Box<[Expression; 2]>),
    Product(Box<[Expression; 2]>),
    Quotient(Box<[Expression; 2]>),
    /// A whole power.
    Power(Box<Expression>, i32),
    /// Any other power, of what is positive.
    General(Box<[Expression; 2]>),
    Function(Function, Box<Expression>),
    Angle(Box<[Expression; 2]>),
}

/// A smooth function of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Sine,
    Cosine,
    Tangent,
    Exponential,
    Logarithm,
    SquareRoot,
}

impl Function {
    /// The functions by their names.
    pub const NAMED: [(&'static str, Function); 6] = [
        ("sin", Function::Sine),
        ("cos", Function::Cosine),
        ("tan", Function::Tangent),
        ("exp", Function::Exponential),
        ("log", Function::Logarithm),
        ("sqrt", Function::SquareRoot),
    ];

    /// Its value: the same bits on every machine.
    fn of(self, x: f64) -> f64 {
        match self {
            Function::Sine => sin_cos(x).0,
            Function::Cosine => sin_cos(x).1,
            Function::Tangent => libm::tan(x),
            Function::Exponential => libm::exp(x),
            Function::Logarithm => libm::log(x),
            Function::SquareRoot => x.sqrt(),
        }
    }
}

impl Expression {
    /// Its value, in the units of the model.
    pub fn value(&self, given: &Given) -> f64 {
        let two = |of: &[Expression; 2]| [of[0].value(given), of[1].value(given)];
        match self {
            Expression::Number(x) => *x,
            Expression::Read(read) => read.value(given),
            Expression::Negative(x) => -x.value(given),
            Expression::Sum(of) => two(of).iter().sum(),
            Expression::Difference(of) => {
                let [x, y] = two(of);
                x - y
            }
            Expression::Product(of) => {
                let [x, y] = two(of);
                x * y
            }
            Expression::Quotient(of) => {
                let [x, y] = two(of);
                x / y
            }
            Expression::Power(x, exponent) => whole_power(x.value(given), *exponent),
            Expression::General(of) => {
                let [x, y] = two(of);
                libm::pow(x, y)
            }
            Expression::Function(function, x) => function.of(x.value(given)),
            Expression::Angle(of) => {
                let [y, x] = two(of);
                libm::atan2(y, x)
            }
        }
    }

    /// Whether it reads something.
    pub fn reads(&self, what: &impl Fn(Read) -> bool) -> bool {
        match self {
            Expression::Number(_) => false,
            Expression::Read(read) => what(*read),
            Expression::Negative(x) | Expression::Power(x, _) | Expression::Function(_, x) => {
                x.reads(what)
            }
            Expression::Sum(of)
            | Expression::Difference(of)
            | Expression::Product(of)
            | Expression::Quotient(of)
            | Expression::General(of)
            | Expression::Angle(of) => of.iter().any(|x| x.reads(what)),
        }
    }
}

impl Read {
    fn value(self, given: &Given) -> f64 {
        match self {
            Read::Coordinate(i) => given.q[i],
            Read::Rate(i) => given.v[i],
            Read::Acceleration(i) => given.a[i],
            Read::Reaction(i) => given.reactions[i],
            Read::Discrete(i) => given.discrete[i],
            Read::Signal(i) => given.signals[i],
            Read::Parameter(i) => given.parameters[i],
            Read::Output(i) => given.outputs[i],
        }
    }
}

/// x to a whole power, by products in one order: `powi` leaves that to the platform.
fn whole_power(x: f64, exponent: i32) -> f64 {
    let power = (0..exponent.unsigned_abs()).fold(1.0, |power, _| power * x);
    match exponent < 0 {
        true => 1.0 / power,
        false => power,
    }
}
