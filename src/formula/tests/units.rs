//! Numbers with units.

use std::f64::consts::TAU;

use proptest::prelude::*;

use crate::formula::unit::{QuantityError, Unit, convert};
use crate::model::models;

#[test]
fn converts_to_the_nearest_double() {
    for (text, unit, value) in [
        ("20 m/s^2", "m/s^2", 20.0),
        ("400 mm", "m", 0.4),
        ("7 mm", "m", 0.007),
        ("2.4e2mm", "m", 0.24),
        ("26 Hz", "Hz", 26.0),
        ("14 deg", "rad", 14.0 * TAU / 360.0),
        ("5 %", "1", 0.05),
        ("0.2", "1", 0.2),
        ("3 kg·m²", "kg m^2", 3.0),
        ("3 N*m/rad", "N m/rad", 3.0),
        ("-1.5 kN/(m s)", "N/m s", -1500.0),
        ("3 m/s/s", "m/s^2", 3.0),
        ("1 g_n", "m/s^2", 9.80665),
        ("2 cm s⁻²", "m/s^2", 0.02),
        ("1 J", "N m", 1.0),
        ("36 m/min", "m/s", 0.6),
        ("1 rad/s", "Hz", 1.0 / TAU),
        ("7 Hz", "rad/s", 7.0 * TAU),
        ("7 1/s", "1/s", 7.0),
    ] {
        assert_eq!(convert(text, unit), Ok(value), "{text} in {unit}");
    }
}

#[test]
fn names_what_is_wrong() {
    use QuantityError::{NotFinite, Unreadable, WrongUnit};
    for (text, unit, error) in [
        ("20 m", "m/s^2", WrongUnit("m".into())),
        ("20", "m/s^2", WrongUnit("1".into())),
        ("7 rad/s", "1/s", WrongUnit("rad/s".into())),
        ("1e999 m", "m", NotFinite),
        ("1e99999999999999999999 m", "m", NotFinite),
        (
            "much",
            "m",
            Unreadable("it does not begin with a number".into()),
        ),
        (
            "nan m",
            "m",
            Unreadable("it does not begin with a number".into()),
        ),
        ("3 parsec", "m", Unreadable("unknown unit `parsec`".into())),
        (
            "3 kgs",
            "kg",
            Unreadable("unknown unit `kgs`; did you mean `kg`?".into()),
        ),
        (
            "3 m/",
            "m",
            Unreadable("a unit is missing at the end".into()),
        ),
        (
            "3 (m",
            "m",
            Unreadable("a closing parenthesis is missing".into()),
        ),
        ("3 m^x", "m", Unreadable("`` is not a whole power".into())),
        ("3 m)", "m", Unreadable("`)` is left over".into())),
    ] {
        assert_eq!(convert(text, unit), Err(error), "{text} in {unit}");
    }
}

#[test]
fn underflow_is_zero_and_not_an_error() {
    assert_eq!(convert("1e-999 m", "m"), Ok(0.0));
}

#[test]
fn gram_and_gravity_are_told_apart() {
    assert_eq!(convert("2 g", "kg"), Ok(0.002));
    assert_eq!(
        convert("2 g", "m/s^2"),
        Err(QuantityError::WrongUnit("g".into()))
    );
}

proptest! {
    #[test]
    fn any_text_is_a_quantity_or_an_error(text in "\\PC*", number in "[-+0-9.eE]{0,6} ?[a-zµ°%^*/() ²⁻0-9]{0,12}") {
        let _ = convert(&text, "m/s^2");
        let _ = convert(&number, "m/s^2");
        let _ = Unit::parse(&text);
    }

    #[test]
    fn numbers_survive_a_unit(value in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
        prop_assert_eq!(convert(&format!("{value:e} m"), "m"), Ok(value));
    }
}
#[test]
fn units_of_every_model_can_be_written_in_scenes() {
    for model in models().iter() {
        let units = model.parameters.iter().map(|p| p.unit);
        let units = units.chain(model.coordinates.iter().map(|c| c.unit));
        for unit in units.chain(model.inputs.iter().map(|i| i.unit)) {
            assert!(Unit::parse(unit).is_ok(), "{unit} in {}", model.name);
            assert!(Unit::parse(&format!("{unit}/s")).is_ok());
        }
    }
}
