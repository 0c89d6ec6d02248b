//! Ordinates against tests/data/22_response_spectra.json, computed in multi-precision arithmetic.

use super::super::{Measures, ordinate};
use super::*;

const REFERENCE: &str = include_str!("../../../tests/data/22_response_spectra.json");

/// Twelve digits, where 20 are known.
const DIGITS: f64 = 1e-12;

#[test]
fn ordinates_at_samples_between_them_and_after_the_end() {
    let reference: serde_json::Value = serde_json::from_str(REFERENCE).expect("JSON");
    for (name, bytes) in [("synthetic_ramp", RAMP), ("0111a", SMC)] {
        let samples = samples(bytes);
        let record = &reference[name];
        let periods = record["periods"].as_array().expect("periods");
        assert_eq!(periods.len(), 30);
        for row in periods {
            let number = |key: &str| {
                row[key]
                    .as_str()
                    .and_then(|t| t.parse::<f64>().ok())
                    .expect("a number")
            };
            let period = row["T"].as_f64().expect("a period");
            let found = ordinate(
                &samples,
                period,
                record["damping"].as_f64().expect("damping"),
            );
            for (value, key) in [
                (found.samples, "psa_samples"),
                (found.peak, "psa_true_with_free_vibration"),
            ] {
                let expected = number(key);
                let error = (value / expected - 1.0).abs();
                assert!(
                    error < DIGITS,
                    "{name}, T = {period} s, {key}: {value} is not {expected}, {error:e}"
                );
            }
        }
    }
}

/// Far beyond the record the oscillator follows the impulse alone: its largest swing comes after the
/// end, at v ω exp(−ζ φ/√(1 − ζ²)) with φ = arccos ζ.
#[test]
fn the_largest_swing_may_come_after_the_record() {
    let pulse = Samples::every(1e-6, vec![0.0, 1.0, 0.0]);
    let (velocity, period, damping) = (1e-6, 1.0, 0.05_f64);
    let omega = std::f64::consts::TAU / period;
    let swing = (-damping / (1.0 - damping * damping).sqrt() * damping.acos()).exp();
    let found = ordinate(&pulse, period, damping);
    assert!((found.peak / (velocity * omega * swing) - 1.0).abs() < 1e-5);
    assert!(found.samples < 1e-3 * found.peak);
}

/// A stiff oscillator follows the ground, a soft one stands still.
#[test]
fn limits_of_the_spectrum() {
    let samples = samples(SMC);
    let pga = Measures::of(&samples).pga.value.abs();
    let stiff = ordinate(&samples, 1e-4, 0.05).peak;
    assert!((stiff / pga - 1.0).abs() < 1e-2, "{stiff} {pga}");
    let omega = std::f64::consts::TAU / 1e4;
    let soft = ordinate(&samples, 1e4, 0.05).peak / (omega * omega);
    let pgd = Measures::of(&samples).pgd.value.abs();
    assert!(soft >= pgd && soft.is_finite(), "{soft} {pgd}");
}
