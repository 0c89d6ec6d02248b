//! Records between their samples.

use std::f64::consts::PI;

use super::super::{Samples, Times};
use crate::input::{Interpolation, Outside, Side, Table};

const DT: f64 = 0.01;
const COUNT: usize = 400;

/// A sine whose frequency is so large a part of the highest.
fn sine(part: f64, t: f64) -> f64 {
    (PI * part * t / DT + 0.7).sin()
}

/// The largest differences from a sine, away from the ends of its samples: of the new samples, and of a function through
/// samples between them.
fn differences(part: f64, interpolation: Interpolation, band_limited: bool) -> [f64; 2] {
    let samples = Samples::every(DT, (0..COUNT).map(|i| sine(part, DT * i as f64)).collect());
    let samples = match band_limited {
        true => samples.band_limited().expect("the steps are equal"),
        false => samples,
    };
    let times = samples.all_times();
    let table = Table::new(&times, &samples.values, interpolation, Outside::Zero).expect("a table");
    // What is left out beyond the ends is seen in the first and the last 32 samples.
    let inside = |t: f64| (32.0 * DT..(COUNT - 33) as f64 * DT).contains(&t);
    let largest = |t: &mut dyn Iterator<Item = (f64, f64)>| {
        t.filter(|(t, _)| inside(*t))
            .fold(0.0_f64, |m, (t, value)| {
                m.max((value - sine(part, t)).abs())
            })
    };
    let of_samples = largest(&mut times.iter().copied().zip(samples.values.iter().copied()));
    let between = (0..20_000).map(|i| 2e-4 * f64::from(i) + 3e-5);
    let of_function = largest(&mut between.map(|t| (t, table.at(t, Side::Right).value)));
    [of_samples, of_function]
}

#[test]
fn sines_up_to_eight_tenths_of_the_highest_frequency_go_on_between_their_samples() {
    // Kaiser's window; and the spline, whose error grows with the fourth power of the frequency.
    for (part, of_spline) in [(0.05, 1e-9), (0.14, 4e-8), (0.4, 2.5e-6), (0.8, 4e-5)] {
        let [samples, spline] = differences(part, Interpolation::Cubic, true);
        assert!(samples < 2e-9, "{part}: {samples:e}");
        assert!(spline < of_spline, "{part}: {spline:e}");
    }
    // Which lines, and a spline through the samples alone, do not.
    let [_, lines] = differences(0.4, Interpolation::Linear, false);
    let [_, spline] = differences(0.8, Interpolation::Cubic, false);
    assert!(lines > 0.1 && spline > 0.1, "{lines:e} {spline:e}");
}

#[test]
fn the_samples_are_among_the_new_ones_and_nothing_comes_before_or_after_them() {
    let values = vec![0.0, 1.0, -3.0, 2.0, 0.5];
    let finer = Samples::every(0.02, values.clone())
        .band_limited()
        .expect("equal steps");
    assert_eq!(finer.dt(), Some(0.02 / 8.0));
    assert_eq!(finer.values.len(), 4 * 8 + 1);
    let old: Vec<f64> = finer.values.iter().step_by(8).copied().collect();
    assert_eq!(old, values);
    let own_times = Samples {
        times: Times::At(vec![0.0, 0.1, 0.3]),
        values: vec![0.0, 1.0, 0.0],
    };
    let refusal = own_times.band_limited().expect_err("the steps differ");
    assert_eq!(refusal.step, "interpolation");
}
