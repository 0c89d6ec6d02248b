//! Dimensions of terms.

use super::unit::Unit;
use std::fmt::{self, Display, Formatter};

/// Powers of m, kg and s; angles are numbers. They may be halves, of roots.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Dimension([f64; 3]);

impl Dimension {
    pub const NONE: Dimension = Dimension([0.0; 3]);

    /// Of a unit.
    pub fn of(unit: &Unit) -> Dimension {
        Dimension(unit.powers().map(f64::from))
    }

    /// Of a product.
    pub fn times(self, other: Dimension) -> Dimension {
        Dimension([0, 1, 2].map(|i| self.0[i] + other.0[i]))
    }

    /// Of a power.
    pub fn power(self, exponent: f64) -> Dimension {
        Dimension(self.0.map(|power| power * exponent))
    }
}

impl Display for Dimension {
    /// `kg m^2/s^2`; `1` where there is none.
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let [m, kg, s] = self.0;
        let part = |sign: f64| {
            let powers = [("kg", kg), ("m", m), ("s", s)];
            let powers = powers.into_iter().filter(|(_, power)| power * sign > 0.0);
            let texts = powers.map(|(name, power)| match power.abs() {
                1.0 => name.to_owned(),
                power => format!("{name}^{power}"),
            });
            texts.collect::<Vec<_>>().join(" ")
        };
        let (above, below) = (part(1.0), part(-1.0));
        f.write_str(if above.is_empty() { "1" } else { &above })?;
        match below.contains(' ') {
            _ if below.is_empty() => Ok(()),
            true => write!(f, "/({below})"),
            false => write!(f, "/{below}"),
        }
    }
}
