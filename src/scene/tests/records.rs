//! Ground-motion records as inputs.

use super::errors::expect;
use super::*;
use crate::input::{Function, Interpolation, Outside, Table};

const AT2: &[u8] = include_bytes!("../../../tests/data/records/0111a_part.AT2");
const ESM: &[u8] = include_bytes!("../../../tests/data/records/0111a.ASC");
const TWO: &[u8] = b"t_s,ns_m_s2,ud_m_s2\n0.0,0,1\n0.5,2,-4\n1.0,0,1\n";

fn with(options: &str, file: &[u8]) -> Result<Scene, SceneErrors> {
    let scene = format!(
        r#"{{ "model": "walking_tank", "end": 1,
  "inputs": {{ "ground_acceleration": {{ "record": "r"{options} }} }} }}"#
    );
    parse_with(scene.as_bytes(), &[], &[("r", file)])
}

/// The function of the input.
fn function(options: &str, file: &[u8]) -> Function {
    let scene = with(options, file).unwrap_or_else(|errors| panic!("{options}: {errors}"));
    let inputs = &scene.problem.signals;
    inputs.functions().next().expect("an input").clone()
}

fn table(times: &[f64], values: &[f64]) -> Function {
    Table::new(times, values, Interpolation::Linear, Outside::Zero)
        .expect("a table")
        .into()
}

#[test]
fn a_record_is_a_table() {
    let text = std::str::from_utf8(AT2).expect("ASCII");
    let numbers = text.lines().skip(4).flat_map(str::split_whitespace);
    let g: Vec<f64> = numbers.map(|n| n.parse().expect("a number")).collect();
    let times: Vec<f64> = (0..g.len()).map(|i| i as f64 / 200.0).collect();
    let values: Vec<f64> = g.iter().map(|a| a * 9.80665).collect();
    assert_eq!(function("", AT2), table(&times, &values));
    let half: Vec<f64> = values.iter().map(|a| 0.5 * a).collect();
    assert_eq!(function(r#", "scale": 0.5"#, AT2), table(&times, &half));
}

/// Channels for several inputs, and what is done to a record.
#[test]
fn channels_and_treatment() {
    let ns = [0.0, 2.0, 0.0];
    let ud = [1.0, -4.0, 1.0];
    let t = [0.0, 0.5, 1.0];
    for (options, times, values) in [
        (r#", "channel": "ns""#, t, ns),
        (r#", "channel": 2"#, t, ud),
        (
            r#", "channel": "ud", "pga": "0.1 m/s^2""#,
            t,
            [0.025, -0.1, 0.025],
        ),
        (
            r#", "channel": "ud", "pga": 8, "delay": "250 ms""#,
            [0.25, 0.75, 1.25],
            [2.0, -8.0, 2.0],
        ),
        (
            r#", "channel": 1, "from": 0.25, "to": 0.75"#,
            [0.0, 0.25, 0.5],
            [1.0, 2.0, 1.0],
        ),
        (r#", "channel": 1, "taper": [0.5, 0]"#, t, ns),
        (r#", "channel": 2, "taper": 0.5"#, t, [0.0, -4.0, 0.0]),
        (
            r#", "channel": 2, "remove_mean": true"#,
            t,
            [1.0 + 2.0 / 3.0, -4.0 + 2.0 / 3.0, 1.0 + 2.0 / 3.0],
        ),
    ] {
        assert_eq!(function(options, TWO), table(&times, &values), "{options}");
    }
    for options in [
        r#", "Sa": { "T": "500 ms", "damping": 0.02, "value": "0.3 g_n" }"#,
        r#", "baseline": { "polynomial": 2 }"#,
        r#", "baseline": { "high_pass": { "frequency": "0.1 Hz" } }"#,
        r#", "interpolation": "cubic""#,
        r#", "scale": -1"#,
    ] {
        assert!(with(options, AT2).is_ok(), "{options}");
    }
}

/// Scaled to a spectral ordinate, corrected, smooth between samples: what a scene says is what is done.
#[test]
fn sizes_and_corrections_are_those_that_are_asked_for() {
    use crate::motion::{Baseline, Given, Size, Treatment, ordinate, read};
    let text = std::str::from_utf8(AT2).expect("ASCII");
    let samples = &read(text, &Given::default()).expect("a record").channels[0].samples;
    let treated = |treatment: Treatment| treatment.apply(samples).expect("it can be done");
    let table = |treatment| {
        let samples = treated(treatment);
        table(&samples.all_times(), &samples.values)
    };
    let sized = Treatment {
        size: Size::Sa {
            period: 0.5,
            damping: 0.02,
            value: 0.3 * 9.80665,
        },
        ..Treatment::default()
    };
    let reached = ordinate(&treated(sized), 0.5, 0.02).peak;
    assert!((reached / (0.3 * 9.80665) - 1.0).abs() < 1e-12, "{reached}");
    let options = r#", "Sa": { "T": "500 ms", "damping": 0.02, "value": "0.3 g_n" }"#;
    assert_eq!(function(options, AT2), table(sized));
    let corrected = |polynomial, high_pass| Treatment {
        baseline: Baseline {
            polynomial,
            high_pass,
        },
        ..Treatment::default()
    };
    let options = r#", "baseline": { "polynomial": 2 }"#;
    assert_eq!(function(options, AT2), table(corrected(Some(2), None)));
    let options = r#", "baseline": { "high_pass": { "frequency": "0.1 Hz" } }"#;
    let filtered = table(corrected(None, Some((0.1, 4))));
    assert_eq!(function(options, AT2), filtered);
    let options = r#", "interpolation": "cubic""#;
    let (times, values) = (samples.all_times(), &samples.values);
    let spline = Table::new(&times, values, Interpolation::Cubic, Outside::Zero);
    assert_eq!(function(options, AT2), spline.expect("a table").into());
    let options = r#", "interpolation": "band_limited""#;
    let finer = samples.band_limited().expect("equal steps");
    let spline = Table::new(
        &finer.all_times(),
        &finer.values,
        Interpolation::Cubic,
        Outside::Zero,
    );
    assert_eq!(function(options, AT2), spline.expect("a table").into());
}

/// A line has nothing left when a line is subtracted.
#[test]
fn a_drift_is_taken_away_and_nothing_else() {
    let drift = b"t_s,a_m_s2\n0,1\n0.5,2\n1,3\n1.5,4\n";
    let options = r#", "baseline": { "polynomial": 1 }"#;
    let left = function(options, drift);
    for i in 0..=15 {
        let jet = left.at(0.1 * f64::from(i), crate::input::Side::Right);
        assert!(jet.value.abs() < 1e-14, "{jet:?}");
    }
}

#[test]
fn records_add_up_with_other_functions() {
    let scene = r#"{ "model": "walking_tank", "end": 1, "inputs": { "ground_acceleration": { "sum": [
        { "record": "r", "channel": 1 }, { "sine": { "amplitude": 1, "frequency": 2 } } ] } } }"#;
    assert!(parse_with(scene.as_bytes(), &[], &[("r", TWO)]).is_ok());
}

#[test]
fn wrong_uses_point_at_their_key() {
    let error = |options: &str, file: &[u8]| only_error(with(options, file));
    let two = error("", TWO);
    expect(&two, "the record has 2 channels", "2:50", "`ns` or `ud`");
    let none = error(r#", "channel": "ew""#, TWO);
    expect(
        &none,
        "the record has no channel `ew`",
        "2:66",
        "`ns` or `ud`",
    );
    let unit = error(r#", "unit": "furlong""#, b"1\n2\n");
    expect(&unit, "unknown unit of a record `furlong`", "2:63", "m/s^2");
    let both = error(r#", "pga": 1, "scale": 2"#, AT2);
    expect(
        &both,
        "`pga` and `scale` exclude each other",
        "2:65",
        "keep one",
    );
    let outside = error(r#", "from": 7"#, AT2);
    let message = "7 s is outside the record, which lasts from 0 to 4.995 s";
    expect(&outside, message, "2:63", "motion");
    let still = error(r#", "pga": 1"#, b"t_s,a_g\n0,0\n1,0\n");
    expect(
        &still,
        "a record with 0 m/s² cannot be scaled to 1 m/s²",
        "2:62",
        "motion",
    );
}

#[test]
fn wrong_files_point_into_the_file() {
    let silent = only_error(with("", b"0.1\n0.2\n"));
    expect(&silent, "the file does not state its step", "1:1", "`dt`");
    assert_eq!(silent.position().unwrap().file, "scenes/r");
    assert!(with(r#", "dt": "5 ms", "unit": "g""#, b"0.1\n0.2\n").is_ok());
    let text =
        std::str::from_utf8(AT2)
            .expect("ASCII")
            .replacen("-.2190452E-01", "-.2190452X-01", 1);
    let letter = only_error(with("", text.as_bytes()));
    expect(
        &letter,
        "`-.2190452X-01` is not a finite number",
        "5:18",
        "touch",
    );
    let binary = only_error(with("", b"\0\x01"));
    expect(
        &binary,
        "the byte 0x00 does not occur in texts",
        "1:1",
        "unpack",
    );
}

/// What `dalembert motion` warns of, a scene has to ask for.
#[test]
fn a_file_that_contradicts_itself_is_refused() {
    let text = std::str::from_utf8(ESM)
        .expect("ASCII")
        .replace("PGA_CM/S^2: 62.320000", "PGA_CM/S^2: 99.320000");
    let doubted = only_error(with("", text.as_bytes()));
    let message = "the header has the peak 99.32, the values have 62.32";
    expect(&doubted, message, "40:1", "despite_doubts");
    assert!(with(r#", "despite_doubts": true"#, text.as_bytes()).is_ok());
}

#[test]
fn a_force_is_no_acceleration() {
    let scene =
        r#"{ "model": "belt_oscillator", "end": 1, "inputs": { "force": { "record": "r" } } }"#;
    let error = only_error(parse_with(scene.as_bytes(), &[], &[("r", AT2)]));
    expect(
        &error,
        "unit `m/s^2` does not fit, expected `N`",
        "1:74",
        "accelerations",
    );
}
