//! Numbers that know what they are off by.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Unit roundoff of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// The least positive double: what a product that underflows is off by.
const LEAST: f64 = 5e-324;

/// A number and a bound of its error, to first order in the unit roundoff (Higham 2002, §3.3: running errors). An
/// error that is not a number, or infinite, says that nothing is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bounded {
    /// The number.
    pub value: f64,
    /// The true one is not farther away than this.
    pub error: f64,
}

impl Bounded {
    /// A number that is what it is.
    pub fn exact(value: f64) -> Self {
        Bounded { value, error: 0.0 }
    }

    /// A number that was rounded in this many operations, with the error that these were given.
    pub fn rounded(value: f64, operations: f64, error: f64) -> Self {
        let error = error + operations * ROUNDOFF * value.abs();
        Bounded { value, error }
    }

    /// The value at the end of a step of a polynomial with so many coefficients whose terms add up to `size`, or to the
    /// value where that is more: Horner's rule (Higham 2002, §5.1).
    pub fn of_polynomial(value: f64, coefficients: usize, size: f64) -> Self {
        let error = 2.0 * coefficients as f64 * ROUNDOFF * value.abs().max(size);
        Bounded { value, error }
    }

    /// Its sign, where rounding does not hide it: positive (true) or negative.
    pub fn sign(self) -> Option<bool> {
        (self.value.abs() > self.error).then_some(self.value > 0.0)
    }

    /// Exactly zero.
    pub fn is_nothing(self) -> bool {
        self.value == 0.0 && self.error == 0.0
    }
}

impl Add for Bounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Bounded::rounded(self.value + other.value, 1.0, self.error + other.error)
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        let Bounded { value, error } = self;
        Bounded {
            value: -value,
            error,
        }
    }
}

impl Sub for Bounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Bounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self.is_nothing() || other.is_nothing() {
            return Bounded::default();
        }
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + self.error * (other.value.abs() + other.error);
        let lost = match value.abs() < f64::MIN_POSITIVE {
            true => LEAST,
            false => 0.0,
        };
        Bounded::rounded(value, 1.0, error + lost)
    }
}

impl Div for Bounded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let least = other.value.abs() - other.error;
        let error = match least > 0.0 {
            true => (self.error + value.abs() * other.error) / least,
            false => f64::INFINITY,
        };
        let lost = match value.abs() < f64::MIN_POSITIVE && !self.is_nothing() {
            true => LEAST,
            false => 0.0,
        };
        Bounded::rounded(value, 1.0, error + lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_that_rounding_made_has_no_sign_and_an_exact_one_has() {
        let third = Bounded::exact(1.0) / Bounded::exact(3.0);
        let one = third + third + third;
        assert_eq!((one - Bounded::exact(1.0)).sign(), None);
        let off = Bounded::exact(1.0 + 4.0 * f64::EPSILON);
        assert_eq!((off - one).sign(), Some(true));
        let tiny = Bounded::exact(1e-300);
        assert_eq!((tiny - Bounded::exact(0.0)).sign(), Some(true));
        assert!((tiny - tiny).is_nothing());
        assert_eq!((tiny * tiny).sign(), None);
        assert_eq!((one / Bounded::exact(0.0)).sign(), None);
    }
}
