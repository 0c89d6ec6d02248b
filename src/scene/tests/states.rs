//! Parameters and states that do not fit together.

use super::errors::{expect, tank};
use super::{only_error, parse};

#[test]
fn one_parameter_limits_another() {
    let error = tank("\"M_S\": 7.5", "\"mu_k\": 0.4");
    expect(
        &error,
        "mu_k = 0.4 exceeds mu_s = 0.3",
        "3:40",
        "lower `mu_k` or raise `mu_s`",
    );
    // The default of mu_k is 0.19: what the scene says is at fault.
    expect(
        &tank("0.3", "0.1"),
        "mu_k = 0.19 exceeds mu_s = 0.1",
        "3:27",
        "raise `mu_s`",
    );
}

#[test]
fn states_that_the_modes_do_not_admit() {
    let theta = "\"theta\": 0.02, \"side\": 1";
    let error = tank(theta, "\"theta\": 0.02, \"mode\": \"stands_sticks\"");
    expect(
        &error,
        "mode `stands_sticks` holds `theta` at 0 rad",
        "5:25",
        "another mode",
    );
    let error = tank(theta, "\"mode\": \"stands_sticks\", \"theta.rate\": 1");
    expect(
        &error,
        "mode `stands_sticks` holds `theta` still",
        "5:55",
        "another mode",
    );
    let error = tank(theta, "\"mode\": \"rocks_slides\"");
    expect(
        &error,
        "mode `rocks_slides` leaves `x` free, but the scene freezes it",
        "5:24",
        "",
    );
    let error = tank(theta, "\"y\": 0.1");
    let message =
        "mode `stands_sticks` holds `y` at 0 m, and so does every other mode it could start in";
    expect(&error, message, "5:21", "change it");
    // Frozen by the scene, and moving.
    let error = tank(theta, "\"x.rate\": 0.1");
    let message =
        "mode `stands_sticks` holds `x` still, and so does every other mode it could start in";
    expect(&error, message, "5:26", "change it");
    // Each alone is possible, but no mode both stands still in x and is uplifted … with theta frozen.
    let error = tank("[\"x\"]", "[\"x\", \"theta\"]");
    let message = "mode `stands_sticks` holds `theta` at 0 rad";
    expect(&error, message, "5:25", "change it");
}

#[test]
fn coordinates_that_cannot_be_frozen() {
    let error = tank("[\"x\"]", "[\"x_I\"]");
    let message = "`x_I` moves in every mode, so it cannot be frozen";
    expect(
        &error,
        message,
        "6:14",
        "modes hold `theta`, `x` or `y` still",
    );
    expect(
        &tank("[\"x\"]", "[\"x\", \"x\"]"),
        "`x` is already there",
        "6:19",
        "",
    );
    // Where it sticks the belt carries it along.
    let text = r#"{ "model": "belt_oscillator", "freeze": ["x"], "end": 1 }"#;
    let message = "`x` moves in every mode, so it cannot be frozen";
    let help = "leave `freeze` out: no mode holds a coordinate still";
    expect(&only_error(parse(text)), message, "1:42", help);
}
