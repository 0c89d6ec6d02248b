//! Formulas: what they give, and what is said of those that are none.

mod units;

use super::{Formula, Given, Names};
use crate::model::{Model, models};
use std::sync::Arc;

fn tank() -> Arc<Model> {
    models().find("walking_tank").unwrap()
}

fn names(model: &Model) -> Names {
    Names::new(model, &model.variants[0], [("lean", "rad")])
}

/// The value of a formula of numbers.
fn value(text: &str) -> f64 {
    let formula = Formula::new(text, "1", &names(&tank()));
    formula
        .unwrap_or_else(|e| panic!("{text}: {e}"))
        .value(&Given::default())
}

#[test]
fn arithmetic() {
    for (text, exact) in [
        ("1 + 2 * 3", 7.0),
        ("2 * 3 - 4 / 8", 5.5),
        ("7 - 2 - 1", 4.0),
        ("8 / 4 / 2", 1.0),
        ("-2^2", -4.0),
        ("2^-2", 0.25),
        ("2**3", 8.0),
        ("2^3^2", 512.0),
        ("2 * -3", -6.0),
        ("--2", 2.0),
        ("(1 + 2) * 3", 9.0),
        (" 1.5e1+.5 ", 15.5),
        ("2.", 2.0),
        ("sqrt(16) + log(exp(2))", 6.0),
        ("2^0.5 * 2^0.5", 2.0_f64.powf(0.5).powi(2)),
        ("cos(pi)", -1.0),
        ("atan2(1, 1) * 4", std::f64::consts::PI),
        ("sin(0) + tan(0)", 0.0),
    ] {
        assert_eq!(value(text), exact, "{text}");
    }
}

#[test]
fn names_stand_for_numbers_of_the_model() {
    let tank = tank();
    let n = tank.own_coordinates().len();
    let parameters: Vec<f64> = tank.parameters.iter().map(|p| p.default).collect();
    // Those of the multipliers, which nobody sees, stand between those of the coordinates and of the ground.
    let of_multipliers = vec![0.0; tank.coordinates.len() - n];
    let reactions = [
        &[13.0, 14.0, 15.0, 16.0][..],
        &of_multipliers,
        &[17.0, 18.0],
    ]
    .concat();
    let given = Given {
        q: &[1.0, 2.0, 3.0, 4.0],
        v: &[5.0, 6.0, 7.0, 8.0],
        a: &[9.0, 10.0, 11.0, 12.0],
        reactions: &reactions,
        discrete: &[-1.0, 1.0],
        signals: &[19.0, 20.0, 21.0, 22.0, 23.0, 24.0],
        parameters: &parameters,
        outputs: &[25.0, 26.0, 27.0, 28.0, 29.0, 30.0, 31.0],
    };
    assert_eq!((n, tank.variants[0].outputs.len()), (4, 6));
    for (text, unit, exact) in [
        ("theta", "rad", 1.0),
        ("x_I", "mm", 2000.0),
        ("x.rate", "m/s", 7.0),
        ("y.acceleration", "m/s^2", 12.0),
        ("reaction.theta", "N m", 13.0),
        ("reaction.z_v", "kN", 0.018),
        ("side * theta", "1", -1.0),
        ("ground_acceleration", "m/s^2", 19.0),
        ("vertical_acceleration.velocity", "m/s", 23.0),
        ("ground_acceleration.displacement", "m", 21.0),
        ("M_I * x_I.rate^2 / 2", "J", 0.782 * 50.3 * 18.0),
        ("sqrt(g * R_0)", "m/s", (9.81_f64 * 0.283).sqrt()),
        ("frequency", "1/s", 26.0),
        ("lean", "rad", 31.0),
        ("shear_ratio", "%", 3000.0),
        ("0 + x", "m", 3.0),
        ("theta", "deg", 1.0 / (std::f64::consts::TAU / 360.0)),
    ] {
        let formula = Formula::new(text, unit, &names(&tank));
        let formula = formula.unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(formula.value(&given), exact, "{text}");
        assert_eq!(formula.reads_reactions(), text.contains("reaction"));
    }
}

/// What is wrong, at which place, and what would be right.
#[test]
fn what_is_no_formula_is_told_with_its_place() {
    let deep = "(".repeat(100);
    let long = "1 +".repeat(1000);
    for (text, unit, place, message) in [
        ("x + ", "m", "", "the expression ends here"),
        ("", "m", "", "the expression ends here"),
        ("x + * y", "m", "*", "`*` is not expected here"),
        ("(x + y", "m", "(", "this parenthesis is not closed"),
        ("sin(theta", "1", "(", "this parenthesis is not closed"),
        ("x y", "m", "y", "`y` is not expected here"),
        ("x)", "m", ")", "`)` is not expected here"),
        ("xx", "m", "xx", "unknown name `xx`"),
        ("x + thta", "m", "thta", "did you mean `theta`?"),
        ("x.speed", "m/s", "x.speed", "unknown name"),
        (
            "x + x.rate",
            "m",
            "x.rate",
            "a term of dimension m/s is added to one of m",
        ),
        ("x - 1", "m", "1", "use a parameter"),
        ("x + (theta + y)", "m", "y", "added to one of 1"),
        (
            "sin(x)",
            "1",
            "x",
            "the argument of sin has the dimension m",
        ),
        ("2^x", "1", "x", "an exponent has the dimension m"),
        ("x^theta", "1", "theta", "a number as its exponent"),
        (
            "x",
            "m/s",
            "x",
            "has the dimension m, and its unit `m/s` has m/s",
        ),
        ("abs(x)", "m", "abs", "`abs` is not smooth"),
        ("sine(theta)", "1", "sine", "unknown function `sine`"),
        ("sin(theta, 1)", "1", "sin", "takes 1 argument(s), not 2"),
        ("atan2(x, theta)", "1", "atan2", "different dimensions"),
        ("1e999", "1", "1e999", "is not a finite number"),
        ("x µ y", "m", "µ", "is not expected here"),
        (&deep, "1", "", "are nested here"),
        (&long, "1", &long, "more than 2000 characters"),
    ] {
        let error = Formula::new(text, unit, &names(&tank())).expect_err(text);
        assert!(error.to_string().contains(message), "{text}: {error}");
        let range = error.range.unwrap();
        let found = &text[range];
        assert!(found == place || place.is_empty(), "{text}: `{found}`");
    }
    for unit in ["mmm", "Hz"] {
        let error = Formula::new("x", unit, &names(&tank())).unwrap_err();
        assert!(
            error.range.is_none() && error.message.contains(unit),
            "{error}"
        );
    }
}

#[test]
fn no_text_makes_it_panic() {
    use proptest::prelude::*;
    let (tank, pieces) = (tank(), "[-+*/^()., 0-9eExyµ_tha]{0,40}");
    proptest!(|(text in pieces)| {
        if let Err(error) = Formula::new(&text, "m", &names(&tank)) {
            let range = error.range.expect("the unit is right");
            prop_assert!(text.get(range).is_some());
        }
    });
}
