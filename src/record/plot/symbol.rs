//! Names and units as a textbook prints them.

use super::marked::{DOTS, END_SUB, SUB};
use crate::record::Units;

const GREEK: [(&str, char); 24] = [
    ("alpha", 'α'),
    ("beta", 'β'),
    ("gamma", 'γ'),
    ("delta", 'δ'),
    ("epsilon", 'ε'),
    ("zeta", 'ζ'),
    ("eta", 'η'),
    ("theta", 'θ'),
    ("iota", 'ι'),
    ("kappa", 'κ'),
    ("lambda", 'λ'),
    ("mu", 'μ'),
    ("nu", 'ν'),
    ("xi", 'ξ'),
    ("omicron", 'ο'),
    ("pi", 'π'),
    ("rho", 'ρ'),
    ("sigma", 'σ'),
    ("tau", 'τ'),
    ("upsilon", 'υ'),
    ("phi", 'φ'),
    ("chi", 'χ'),
    ("psi", 'ψ'),
    ("omega", 'ω'),
];

/// The symbol of a column: `theta.rate` is θ with a dot, `ground_velocity.rate` is "rate of ground velocity", `reaction.x` is R with the subscript x,
/// `energy.stored` is "stored", and a name of more than one word stays in words.
pub(crate) fn symbol(name: &str) -> String {
    if let Some(of) = name.strip_prefix("reaction.") {
        format!("R{SUB}{}{END_SUB}", greek(of))
    } else if let Some(what) = name.strip_prefix("energy.") {
        what.replace('_', " ")
    } else if let Some(of) = name.strip_suffix(".rate") {
        let quantity = quantity(of);
        // A dot stands above a letter; of a name in words the words say it.
        match is_letter(&quantity) {
            true => format!("{}{quantity}", DOTS[0]),
            false => format!("rate of {quantity}"),
        }
    } else if let Some((of, what)) = name.split_once('.') {
        format!("{} of {}", what.replace('_', " "), quantity(of))
    } else {
        quantity(name)
    }
}

/// Whether a quantity is a single letter, which may have a subscript.
fn is_letter(quantity: &str) -> bool {
    let mut chars = quantity.chars();
    chars.next().is_some() && matches!(chars.next(), None | Some(SUB))
}

/// `x_I` with a subscript, `theta1` as θ with the subscript 1, `ground_acceleration` in words.
fn quantity(name: &str) -> String {
    let split = name
        .find(|c: char| c == '_' || c.is_ascii_digit())
        .unwrap_or(name.len());
    let (base, index) = name.split_at(split);
    let index = index.trim_start_matches('_');
    let base = greek(base);
    if index.is_empty() {
        base
    } else if base.chars().count() == 1 {
        format!("{base}{SUB}{}{END_SUB}", greek(index))
    } else {
        name.replace('_', " ")
    }
}

/// A Greek letter for its name.
fn greek(name: &str) -> String {
    match GREEK.iter().find(|(spelled, _)| *spelled == name) {
        Some((_, letter)) => letter.to_string(),
        None => name.to_owned(),
    }
}

/// SI prefixes from 10⁻¹⁵ to 10¹², by thousands.
const PREFIXES: [(i32, &str); 10] = [
    (-15, "f"),
    (-12, "p"),
    (-9, "n"),
    (-6, "µ"),
    (-3, "m"),
    (0, ""),
    (3, "k"),
    (6, "M"),
    (9, "G"),
    (12, "T"),
];

/// Units that take a prefix (kg has one already).
const PREFIXABLE: [&str; 8] = ["m", "rad", "s", "N", "J", "W", "Pa", "Hz"];

/// A unit for display, and by what a value in the model's unit is to be multiplied.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Display {
    /// Such as `mm/s`; a power of ten where no prefix fits; empty for plain numbers.
    pub unit: String,
    /// Factor on the values.
    pub factor: f64,
}

/// The display of `unit`: the reader's choice, or what gives values up to `largest` one to three digits before the
/// point. Values of at least 0.1 are left as they are.
pub(super) fn display(unit: &str, largest: f64, units: &Units) -> Display {
    if let Some((shown, factor)) = units.convert(unit) {
        return Display {
            unit: printed(&shown),
            factor,
        };
    }
    let plain = Display {
        unit: printed(unit),
        factor: 1.0,
    };
    if largest == 0.0 || !largest.is_finite() || (0.1..1000.0).contains(&largest) {
        return plain;
    }
    let exponent = (largest.log10() / 3.0).floor() as i32 * 3;
    let first = unit.split(['/', ' ', '^']).next().unwrap_or_default();
    // A prefix belongs to its unit before the power: mm² is not 10⁻³ m².
    let takes_prefix = PREFIXABLE.contains(&first) && !unit[first.len()..].starts_with('^');
    let prefix = PREFIXES.iter().find(|(e, _)| *e == exponent);
    let unit = match prefix {
        Some((_, prefix)) if takes_prefix => format!("{prefix}{}", printed(unit)),
        _ => format!("10{} {}", superscript(exponent), printed(unit))
            .trim_end()
            .to_owned(),
    };
    Display {
        unit,
        factor: 10f64.powi(-exponent),
    }
}

/// `m/s^2` with a raised 2, `N m` with a dot, nothing for `1`.
pub(super) fn printed(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut parts = unit.split('^');
    let mut out = parts.next().unwrap_or_default().replace(' ', "·");
    for part in parts {
        let end = part
            .find(|c: char| c != '-' && !c.is_ascii_digit())
            .unwrap_or(part.len());
        out.push_str(&raised(&part[..end]));
        out.push_str(&part[end..].replace(' ', "·"));
    }
    out
}

/// A whole number as an exponent.
pub(super) fn superscript(number: i32) -> String {
    raised(&number.to_string())
}

fn raised(digits: &str) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    };
    digits.chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_symbols() {
        let shown = |name| {
            symbol(name)
                .replace(SUB, "[")
                .replace(END_SUB, "]")
                .replace(DOTS[0], "˙")
        };
        for (name, symbol) in [
            ("theta", "θ"),
            ("theta1", "θ[1]"),
            ("x_I", "x[I]"),
            ("x_I.rate", "˙x[I]"),
            ("theta.rate", "˙θ"),
            ("gap.rate", "rate of gap"),
            ("reaction.theta", "R[θ]"),
            ("reaction.z_h", "R[z_h]"),
            ("energy.input_work", "input work"),
            ("ground_acceleration", "ground acceleration"),
            (
                "ground_acceleration.velocity",
                "velocity of ground acceleration",
            ),
        ] {
            assert_eq!(shown(name), symbol);
        }
    }

    #[test]
    fn units_are_scaled_by_thousands() {
        for (unit, largest, shown, factor) in [
            ("rad", 0.02, "mrad", 1e3),
            ("m", 3.4e-6, "µm", 1e6),
            ("m", 0.2, "m", 1.0),
            ("m/s^2", 20.0, "m/s²", 1.0),
            ("m/s^2", 2e4, "km/s²", 1e-3),
            ("N m", 1500.0, "kN·m", 1e-3),
            ("m^2", 1e-4, "10⁻⁶ m²", 1e6),
            ("kg", 1e-4, "10⁻⁶ kg", 1e6),
            ("1", 5.0, "", 1.0),
            ("1", 5e-3, "10⁻³", 1e3),
            ("J", 0.0, "J", 1.0),
        ] {
            let display = display(unit, largest, &Units::default());
            assert_eq!(display.unit, shown);
            assert!(
                (display.factor / factor - 1.0).abs() < 1e-12,
                "{unit} {largest}"
            );
        }
    }
}
