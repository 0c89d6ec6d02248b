//! Units as texts, and numbers with units: `"400 mm"`, `"0.25 rad"`, `"20 m/s^2"`.
//!
//! An angle is a dimension of its own here. SI counts it as a number, but then `7 rad/s` would pass
//! for 7 Hz, which is 2π × 7 rad/s.

use std::f64::consts::TAU;

/// A unit: `factor × 10^exponent` times metres, kilograms, seconds and radians to some powers.
///
/// The power of ten is kept apart, so that `"400 mm"` reads as the double next to 0.4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    /// Powers of m, kg, s and rad.
    dimensions: [i32; 4],
    exponent: i32,
    factor: f64,
}

/// A named unit: symbol, meaning, powers of m, kg, s, rad, power of ten, factor, whether it takes
/// prefixes.
type Named = (&'static str, &'static str, [i32; 4], i32, f64, bool);

const NAMED: [Named; 21] = [
    ("m", "metre", [1, 0, 0, 0], 0, 1.0, true),
    ("g", "gram", [0, 1, 0, 0], -3, 1.0, true),
    ("s", "second", [0, 0, 1, 0], 0, 1.0, true),
    ("rad", "radian", [0, 0, 0, 1], 0, 1.0, true),
    ("N", "newton", [1, 1, -2, 0], 0, 1.0, true),
    ("J", "joule", [2, 1, -2, 0], 0, 1.0, true),
    ("W", "watt", [2, 1, -3, 0], 0, 1.0, true),
    ("Pa", "pascal", [-1, 1, -2, 0], 0, 1.0, true),
    (
        "Hz",
        "hertz, cycles per second",
        [0, 0, -1, 1],
        0,
        TAU,
        true,
    ),
    ("min", "minute", [0, 0, 1, 0], 0, 60.0, false),
    ("h", "hour", [0, 0, 1, 0], 0, 3600.0, false),
    ("t", "tonne", [0, 1, 0, 0], 3, 1.0, false),
    ("deg", "degree", [0, 0, 0, 1], 0, TAU / 360.0, false),
    ("°", "degree", [0, 0, 0, 1], 0, TAU / 360.0, false),
    ("rev", "revolution", [0, 0, 0, 1], 0, TAU, false),
    (
        "rpm",
        "revolutions per minute",
        [0, 0, -1, 1],
        0,
        TAU / 60.0,
        false,
    ),
    // The standard acceleration of gravity, by definition (3rd CGPM, 1901).
    ("g_n", "standard gravity", [1, 0, -2, 0], 0, 9.806_65, false),
    ("gal", "gal, cm/s²", [1, 0, -2, 0], -2, 1.0, false),
    ("%", "per cent", [0; 4], -2, 1.0, false),
    ("1", "no unit", [0; 4], 0, 1.0, false),
    ("-", "no unit", [0; 4], 0, 1.0, false),
];

const PREFIXES: [(&str, i32); 10] = [
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("u", -6),
    ("µ", -6), // micro sign
    ("μ", -6), // Greek letter
    ("n", -9),
];

impl Unit {
    const ONE: Unit = Unit {
        dimensions: [0; 4],
        exponent: 0,
        factor: 1.0,
    };

    /// Reads a unit such as `kg m^2`, `N m/rad`, `m/s²` or `1`. Factors are separated by a space,
    /// `*` or `·`; what comes after a `/` divides, as in the units of models: `N/m s` is `N/(m s)`.
    pub fn parse(text: &str) -> Result<Unit, String> {
        let mut rest = Rest(text.trim());
        if rest.0.is_empty() {
            return Ok(Unit::ONE);
        }
        let unit = rest.product(true)?;
        if rest.0.is_empty() {
            Ok(unit)
        } else {
            Err(format!("`{}` is left over", rest.0))
        }
    }

    /// Powers of m, kg and s; angles are numbers.
    pub fn powers(&self) -> [i32; 3] {
        let [m, kg, s, _] = self.dimensions;
        [m, kg, s]
    }

    /// What a number in coherent units is multiplied with, and then divided by, to be in this one. Powers of ten are
    /// whole, so that 0.4 m are 400 mm.
    pub fn of_coherent(&self) -> [f64; 2] {
        let power = 10f64.powi(self.exponent.abs());
        match self.exponent < 0 {
            true => [power, self.factor],
            false => [1.0, power * self.factor],
        }
    }

    fn times(self, other: Unit, power: i32) -> Option<Unit> {
        let mut dimensions = self.dimensions;
        for (sum, d) in dimensions.iter_mut().zip(other.dimensions) {
            *sum = sum.checked_add(d.checked_mul(power)?)?;
        }
        let exponent = self
            .exponent
            .checked_add(other.exponent.checked_mul(power)?)?;
        let factor = self.factor * other.factor.powi(power);
        Some(Unit {
            dimensions,
            exponent,
            factor,
        })
        .filter(|u| u.factor.is_normal())
    }

    fn named(symbol: &str) -> Option<Unit> {
        let unit = |&(_, _, dimensions, exponent, factor, _): &Named| Unit {
            dimensions,
            exponent,
            factor,
        };
        let exact = NAMED.iter().find(|named| named.0 == symbol).map(unit);
        exact.or_else(|| {
            PREFIXES.iter().find_map(|(prefix, power)| {
                let base = symbol.strip_prefix(prefix)?;
                let named = NAMED.iter().find(|named| named.5 && named.0 == base)?;
                let unit = unit(named);
                Some(Unit {
                    exponent: unit.exponent + power,
                    ..unit
                })
            })
        })
    }
}

/// What is left of a unit's text.
struct Rest<'a>(&'a str);

impl Rest<'_> {
    fn take(&mut self, text: &str) -> bool {
        match self.0.strip_prefix(text) {
            Some(rest) => {
                self.0 = rest;
                true
            }
            None => false,
        }
    }

    fn product(&mut self, parentheses: bool) -> Result<Unit, String> {
        let mut unit = self.factor(parentheses)?;
        let mut power = 1;
        loop {
            self.0 = self.0.trim_start();
            if self.0.is_empty() || self.0.starts_with(')') {
                return Ok(unit);
            }
            if self.take("/") {
                power = -1;
            } else if !self.take("*") {
                // A space alone multiplies too.
                self.take("·");
            }
            self.0 = self.0.trim_start();
            let factor = self.factor(parentheses)?;
            unit = unit
                .times(factor, power)
                .ok_or("its powers are too large")?;
        }
    }

    fn factor(&mut self, parentheses: bool) -> Result<Unit, String> {
        let base = if parentheses && self.take("(") {
            // Units need no parentheses within parentheses.
            let inner = self.product(false)?;
            if !self.take(")") {
                return Err("a closing parenthesis is missing".into());
            }
            inner
        } else {
            let ends = |c: char| c.is_whitespace() || "*·/^()⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(c);
            let letters = self
                .0
                .find(|c: char| ends(c) || c.is_ascii_digit())
                .unwrap_or(self.0.len());
            let length = if self.0.starts_with('1') { 1 } else { letters };
            let (symbol, rest) = self.0.split_at(length);
            if symbol.is_empty() {
                return Err(if self.0.is_empty() {
                    "a unit is missing at the end".into()
                } else {
                    format!("`{}` is not a unit", self.0)
                });
            }
            let unit = Unit::named(symbol).ok_or_else(|| unknown(symbol))?;
            self.0 = rest;
            unit
        };
        let power = self.power()?;
        Unit::ONE
            .times(base, power)
            .ok_or_else(|| "its powers are too large".into())
    }

    fn power(&mut self) -> Result<i32, String> {
        let plain = self.take("^") || self.take("**");
        let is_power = |c: char| {
            if plain {
                c.is_ascii_digit() || c == '-'
            } else {
                superscript(c).is_some()
            }
        };
        let end = self.0.find(|c| !is_power(c)).unwrap_or(self.0.len());
        let (power, rest) = self.0.split_at(end);
        if power.is_empty() && !plain {
            return Ok(1);
        }
        let digits: String = power.chars().map(|c| superscript(c).unwrap_or(c)).collect();
        self.0 = rest;
        digits
            .parse()
            .map_err(|_| format!("`{digits}` is not a whole power"))
    }
}

fn superscript(c: char) -> Option<char> {
    let index = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻".chars().position(|s| s == c)?;
    "0123456789-".chars().nth(index)
}

fn unknown(symbol: &str) -> String {
    let known = NAMED
        .iter()
        .map(|named| named.0)
        .chain(["mm", "kg", "kN", "ms"]);
    match super::nearest(symbol, known) {
        Some(near) => format!("unknown unit `{symbol}`; did you mean `{near}`?"),
        None => format!("unknown unit `{symbol}`"),
    }
}

/// Why a text is not a number in the wanted unit.
#[derive(Debug, PartialEq)]
pub(crate) enum QuantityError {
    /// It is not a number and a unit; the reason.
    Unreadable(String),
    /// Its unit, as written, has another dimension.
    WrongUnit(String),
    /// It is beyond the range of double precision.
    NotFinite,
}

/// Reads a number with a unit and converts it to the unit `target`.
pub(crate) fn convert(text: &str, target: &str) -> Result<f64, QuantityError> {
    let text = text.trim();
    let (mantissa, exponent, unit_text) = split_number(text)
        .ok_or_else(|| QuantityError::Unreadable("it does not begin with a number".into()))?;
    let given = Unit::parse(unit_text).map_err(QuantityError::Unreadable)?;
    let wanted = Unit::parse(target).map_err(|reason| {
        QuantityError::Unreadable(format!(
            "the model's unit `{target}` cannot be converted to ({reason})"
        ))
    })?;
    if given.dimensions != wanted.dimensions {
        let name = if unit_text.is_empty() { "1" } else { unit_text };
        return Err(QuantityError::WrongUnit(name.to_owned()));
    }
    // The power of ten goes into the literal, so that it is rounded once.
    let shift = i64::from(given.exponent) - i64::from(wanted.exponent);
    let literal = format!("{mantissa}e{}", exponent.saturating_add(shift));
    let number: f64 = literal.parse().map_err(|_| QuantityError::NotFinite)?;
    let value = number * (given.factor / wanted.factor);
    if value.is_finite() {
        Ok(value)
    } else {
        Err(QuantityError::NotFinite)
    }
}

/// Splits `-1.5e3 mm` into mantissa, power of ten and unit.
fn split_number(text: &str) -> Option<(&str, i64, &str)> {
    let sign = usize::from(text.starts_with(['-', '+']));
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let whole = digits(sign);
    let mut end = sign + whole;
    if whole == 0 {
        return None;
    }
    if text[end..].starts_with('.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    let mantissa = &text[..end];
    let mut exponent = 0;
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['-', '+']));
        let length = digits(end + 1 + sign);
        if length > 0 {
            let stop = end + 1 + sign + length;
            // Only the digits can fail to parse, by being too many.
            let huge = if text[end + 1..].starts_with('-') {
                i64::MIN
            } else {
                i64::MAX
            };
            exponent = text[end + 1..stop].parse().unwrap_or(huge);
            end = stop;
        }
    }
    Some((mantissa, exponent, text[end..].trim_start()))
}
