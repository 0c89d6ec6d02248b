//! Overrides for one of the shipped scenes, which the first byte chooses: lines `path=value`, in which bytes that
//! are not ASCII stand for whole words. So one changed byte is another key or another value.
#![no_main]

use dalembert_fuzz::{TABLE, read_and_run};
use libfuzzer_sys::fuzz_target;

const SCENES: [&[u8]; 6] = [
    include_bytes!("../../scenes/bouncing_ball.json"),
    include_bytes!("../../scenes/rocking_block.json"),
    include_bytes!("../../scenes/sliding_oscillator.json"),
    include_bytes!("../../scenes/coulomb_oscillator.json"),
    include_bytes!("../../scenes/tank_full_plate.json"),
    include_bytes!("../../scenes/tank_rocks_and_slides.json"),
];

/// Beginnings of lines with values that suit them: all pairs are numbered in turn, and byte 128 + i is the line
/// of pair i.
const LINES: [(&str, &[&str]); 16] = [
    (
        "end=",
        &[
            "0.05",
            "1",
            "3",
            "0",
            "1e-300",
            r#"{ "time": 1, "after": { "slip": 3 } }"#,
        ],
    ),
    ("method=", &["auto", "taylor", "radau"]),
    ("accuracy.relative=", &["1e-3", "1e-6", "1e-12", "0.1"]),
    ("accuracy.absolute=", &["1e-3", "1e-300", "1e300", "{}"]),
    ("record.every=", &["0.01", "1e-6", "1", "null"]),
    ("rules=", &["paper", "reactions"]),
    (
        "freeze=",
        &[
            "[]",
            r#"["theta"]"#,
            r#"["x"]"#,
            r#"["u"]"#,
            r#"["theta", "x"]"#,
        ],
    ),
    (
        "initial.mode=",
        &["sticks", "slips", "rocks", "flies", "stands"],
    ),
    ("initial.theta=", &["0.1", "0", "-0.1", "1e-20", "1.6"]),
    ("initial.theta.rate=", &["0.5", "-0.5", "1e3"]),
    ("initial.x.rate=", &["1", "-1", "1e-12"]),
    ("parameters.mu_s=", &["0.3", "0", "1e3", "2"]),
    ("parameters.mu_k=", &["0.3", "0", "0.19"]),
    ("parameters.e=", &["0", "1", "0.5", "1e-9"]),
    (
        "inputs.ground_acceleration.sine.amplitude=",
        &["0", "1", "-30", "1e4"],
    ),
    (
        "inputs.ground_acceleration.sine.frequency=",
        &["0.1", "7", "1e3"],
    ),
];

fuzz_target!(|bytes: &[u8]| {
    let Some((first, rest)) = bytes.split_first() else {
        return;
    };
    let mut lines = String::new();
    for &byte in rest {
        match byte.checked_sub(128) {
            None => lines.push(byte.into()),
            Some(pair) => {
                let of = |&(beginning, values): &(&'static str, &'static [&'static str])| {
                    values
                        .iter()
                        .map(move |value| format!("\n{beginning}{value}\n"))
                };
                lines.extend(LINES.iter().flat_map(of).cycle().nth(pair.into()));
            }
        }
    }
    let lines = lines.lines().filter(|line| !line.is_empty());
    let overrides: Vec<_> = lines.map(str::to_owned).collect();
    let scene = SCENES[usize::from(*first) % SCENES.len()];
    read_and_run(scene, &overrides, TABLE);
});
