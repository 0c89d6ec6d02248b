//! Which values a number may have.

/// Bounds of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest admissible value; exclusive where `minimum_exclusive`. May be −∞.
    pub minimum: f64,
    /// Whether `minimum` itself is inadmissible.
    pub minimum_exclusive: bool,
    /// Largest admissible value; may be +∞.
    pub maximum: f64,
}

impl Bounds {
    /// Every finite number.
    pub const NONE: Bounds = Bounds::at_least(f64::NEG_INFINITY);

    /// Every finite number above zero.
    pub const POSITIVE: Bounds = Bounds {
        minimum: 0.0,
        minimum_exclusive: true,
        maximum: f64::INFINITY,
    };

    /// Every finite number from `minimum` on.
    pub const fn at_least(minimum: f64) -> Self {
        Bounds {
            minimum,
            minimum_exclusive: false,
            maximum: f64::INFINITY,
        }
    }

    /// Whether a number is finite and within the bounds.
    pub fn admit(&self, value: f64) -> bool {
        let above = match self.minimum_exclusive {
            true => value > self.minimum,
            false => value >= self.minimum,
        };
        value.is_finite() && above && value <= self.maximum
    }

    /// The bounds in words, such as `> 0 kg` or `>= 0 and <= 1`.
    pub fn describe(&self, unit: &str) -> String {
        let unit = match unit {
            "" | "1" => String::new(),
            _ => format!(" {unit}"),
        };
        let sign = if self.minimum_exclusive { ">" } else { ">=" };
        let above = format!("{sign} {}{unit}", shown(self.minimum));
        let below = format!("<= {}{unit}", shown(self.maximum));
        match (self.minimum.is_finite(), self.maximum.is_finite()) {
            (true, true) => format!("{above} and {below}"),
            (true, false) => above,
            (false, true) => below,
            (false, false) => "finite".into(),
        }
    }
}

/// A number in its shortest form, with an exponent where it is very small or very large.
pub(crate) fn shown(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}
