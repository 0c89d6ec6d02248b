//! Units of the reader's choice, for plots and tables that people look at. Files of numbers keep the model's units.

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use std::f64::consts::PI;

/// A unit that stands for another: its name, and how many of it are one of the other.
type Choice = (&'static str, f64);

/// What may be chosen for each unit of models. A unit as a whole comes before those that it is made of.
const KNOWN: [(&str, &[Choice]); 9] = [
    // The standard acceleration of gravity, by definition (3rd CGPM, 1901).
    ("m/s^2", &[("g_n", 1.0 / 9.806_65)]),
    (
        "m",
        &[
            ("m", 1.0),
            ("mm", 1e3),
            ("cm", 1e2),
            ("µm", 1e6),
            ("km", 1e-3),
        ],
    ),
    ("kg", &[("kg", 1.0), ("g", 1e3), ("t", 1e-3)]),
    (
        "s",
        &[
            ("s", 1.0),
            ("ms", 1e3),
            ("µs", 1e6),
            ("min", 1.0 / 60.0),
            ("h", 1.0 / 3600.0),
        ],
    ),
    (
        "rad",
        &[
            ("rad", 1.0),
            ("mrad", 1e3),
            ("deg", 180.0 / PI),
            ("rev", 0.5 / PI),
        ],
    ),
    ("N", &[("N", 1.0), ("mN", 1e3), ("kN", 1e-3), ("MN", 1e-6)]),
    ("J", &[("J", 1.0), ("mJ", 1e3), ("kJ", 1e-3), ("MJ", 1e-6)]),
    ("W", &[("W", 1.0), ("mW", 1e3), ("kW", 1e-3), ("MW", 1e-6)]),
    (
        "Pa",
        &[("Pa", 1.0), ("kPa", 1e-3), ("MPa", 1e-6), ("GPa", 1e-9)],
    ),
];

/// The reader's units; by default the model's.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Units {
    /// The unit of models and what stands for it.
    chosen: Vec<(&'static str, Choice)>,
}

impl Units {
    /// Units by name, such as `mm`, `kN`, `deg`, `ms`, at most one for each kind of quantity.
    ///
    /// # Errors
    /// Says which name is not known, or which two are of the same kind.
    pub fn new<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Units, String> {
        let mut units = Units::default();
        for name in names {
            // A u is what keyboards have for the micro sign.
            let spelled = match name.strip_prefix('u') {
                Some(rest) => format!("µ{rest}"),
                None => name.to_owned(),
            };
            let mut known = KNOWN.iter().flat_map(|(of, choices)| {
                let choices = choices.iter();
                choices.map(move |choice| (*of, *choice))
            });
            let Some((of, choice)) = known.find(|(_, choice)| choice.0 == spelled) else {
                let names: Vec<_> = KNOWN.iter().flat_map(|k| k.1).map(|c| c.0).collect();
                return Err(format!(
                    "there is no unit `{name}`; write some of {}",
                    names.join(", ")
                ));
            };
            if let Some((_, (other, _))) = units.chosen.iter().find(|(known, _)| *known == of) {
                return Err(format!(
                    "`{other}` and `{name}` measure the same; choose one"
                ));
            }
            units.chosen.push((of, choice));
        }
        Ok(units)
    }

    /// The unit in which values in `unit` are shown, and by what they are multiplied for that; `None` where the
    /// choice says nothing of it. Both units are texts as models write them: `kg m^2/s^2`.
    pub fn convert(&self, unit: &str) -> Option<(String, f64)> {
        let chosen = |name: &str| {
            let found = self.chosen.iter().find(|(of, _)| *of == name);
            found.map(|(_, choice)| *choice)
        };
        if let Some((name, factor)) = chosen(unit) {
            return Some((name.to_owned(), factor));
        }
        let (mut shown, mut factor, mut known) = (String::new(), 1.0, false);
        for (place, part) in unit.split('/').enumerate() {
            if place > 0 {
                shown.push('/');
            }
            for (i, token) in part.split([' ', '*']).enumerate() {
                if i > 0 {
                    shown.push(' ');
                }
                let (name, power) = match token.split_once('^') {
                    Some((name, power)) => (name, power.parse().ok()?),
                    None => (token, 1),
                };
                let sign = if place == 0 { 1 } else { -1 };
                match chosen(name) {
                    None => shown.push_str(token),
                    Some((other, of_one)) => {
                        known = true;
                        factor *= f64::powi(of_one, sign * power);
                        shown.push_str(other);
                        shown.push_str(&token[name.len()..]);
                    }
                }
            }
        }
        known.then_some((shown, factor))
    }

    /// A value in its unit as it is shown.
    pub fn show(&self, value: f64, unit: &str) -> (f64, String) {
        match self.convert(unit) {
            Some((shown, factor)) => (value * factor, shown),
            None => (value, unit.to_owned()),
        }
    }
}

/// What may be chosen, and what is, for the scripts of pages.
impl Serialize for Units {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(2))?;
        map.serialize_entry("known", &KNOWN)?;
        let chosen: Vec<_> = self
            .chosen
            .iter()
            .map(|(of, (name, _))| (of, name))
            .collect();
        map.serialize_entry("chosen", &chosen)?;
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn composed_units_are_converted_factor_by_factor() {
        let units = Units::new(["mm", "kN", "deg", "ms"]).unwrap();
        for (unit, shown, factor) in [
            ("m", "mm", 1e3),
            ("m/s", "mm/ms", 1.0),
            ("m/s^2", "mm/ms^2", 1e-3),
            ("N m", "kN mm", 1.0),
            ("N/m s", "kN/mm ms", 1e-9),
            ("rad/s", "deg/ms", 0.18 / PI),
            ("kg m^2", "kg mm^2", 1e6),
            ("1/s", "1/ms", 1e-3),
        ] {
            let (name, found) = units.convert(unit).unwrap();
            assert_eq!(name, shown);
            assert!((found / factor - 1.0).abs() < 1e-15, "{unit} {found}");
        }
        assert_eq!(units.convert("J"), None);
        assert_eq!(units.convert("1"), None);
    }

    #[test]
    fn a_unit_as_a_whole_comes_first() {
        let units = Units::new(["g_n", "um"]).unwrap();
        assert_eq!(units.show(9.806_65, "m/s^2"), (1.0, "g_n".to_owned()));
        assert_eq!(units.show(2.0, "m"), (2e6, "µm".to_owned()));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let error = Units::new(["mm", "furlong"]).unwrap_err();
        assert!(
            error.contains("`furlong`") && error.contains("kN"),
            "{error}"
        );
        let error = Units::new(["mm", "km"]).unwrap_err();
        assert!(error.contains("`mm` and `km`"), "{error}");
    }
}
