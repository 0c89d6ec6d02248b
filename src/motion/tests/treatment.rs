//! What is done to records.

use super::super::{Baseline, Measures, Size, Times, Treatment, ordinate};
use super::*;

fn treated(samples: &Samples, treatment: Treatment) -> Samples {
    treatment.apply(samples).expect("it can be done")
}

#[test]
fn nothing_asked_is_nothing_done() {
    let samples = samples(SMC);
    assert_eq!(treated(&samples, Treatment::default()), samples);
}

#[test]
fn sizes() {
    let samples = samples(SMC);
    let doubled = treated(
        &samples,
        Treatment {
            size: Size::Factor(2.0),
            ..Treatment::default()
        },
    );
    assert_eq!(doubled.values[7], 2.0 * samples.values[7]);
    let pga = treated(
        &samples,
        Treatment {
            size: Size::Pga(3.5),
            ..Treatment::default()
        },
    );
    assert!((Measures::of(&pga).pga.value.abs() - 3.5).abs() < 1e-14);
    let size = Size::Sa {
        period: 0.5,
        damping: 0.05,
        value: 2.0,
    };
    let sa = treated(
        &samples,
        Treatment {
            size,
            ..Treatment::default()
        },
    );
    assert!((ordinate(&sa, 0.5, 0.05).peak - 2.0).abs() < 1e-13);
    let still = Samples::every(0.1, vec![0.0; 3]);
    let refusal = Treatment {
        size: Size::Pga(3.5),
        ..Treatment::default()
    }
    .apply(&still);
    assert_eq!(refusal.expect_err("zero").step, "pga");
}

#[test]
fn cuts() {
    let ramp = samples(RAMP);
    let part = treated(
        &ramp,
        Treatment {
            from: Some(0.15),
            to: Some(1.0),
            ..Treatment::default()
        },
    );
    assert_eq!(
        part,
        Samples::every(0.05, ramp.values[3..=20].to_vec()),
        "at samples"
    );
    let part = treated(
        &ramp,
        Treatment {
            from: Some(0.075),
            to: Some(0.125),
            delay: 2.0,
            ..Treatment::default()
        },
    );
    let Times::At(times) = &part.times else {
        panic!("between samples")
    };
    assert_eq!(times.len(), 3);
    assert_eq!(times[0], 2.0);
    assert!((times[2] - 2.05).abs() < 1e-15);
    // 0.4 at 0.05 s, 0.8 at 0.1 s, 1.2 at 0.15 s.
    for (value, expected) in part.values.iter().zip([0.6, 0.8, 1.0]) {
        assert!((value - expected).abs() < 1e-15, "{:?}", part.values);
    }
    for (from, to, step) in [
        (5.0, 6.0, "from"),
        (0.0, 6.0, "to"),
        (1.0, 0.5, "to"),
        (-0.1, 1.0, "from"),
    ] {
        let refusal = Treatment {
            from: Some(from),
            to: Some(to),
            ..Treatment::default()
        }
        .apply(&ramp);
        assert_eq!(refusal.expect_err("outside").step, step);
    }
}

#[test]
fn a_taper_begins_and_ends_at_zero() {
    let samples = Samples::every(0.5, vec![1.0; 9]);
    let tapered = treated(
        &samples,
        Treatment {
            taper: [1.0, 2.0],
            ..Treatment::default()
        },
    );
    let expected = [
        0.0,
        0.5,
        1.0,
        1.0,
        1.0,
        0.5 + 0.5_f64.sqrt() / 2.0,
        0.5,
        0.5 - 0.5_f64.sqrt() / 2.0,
        0.0,
    ];
    for (value, expected) in tapered.values.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-15, "{:?}", tapered.values);
    }
    let refusal = Treatment {
        taper: [3.0, 2.0],
        ..Treatment::default()
    }
    .apply(&samples);
    assert_eq!(refusal.expect_err("too long").step, "taper");
}

/// A record that is such a polynomial is left without anything.
#[test]
fn polynomials_are_found() {
    for degree in 0..=1 {
        let values = (0..200).map(|i| 0.3 - 0.02 * (i * degree) as f64).collect();
        let baseline = Baseline {
            polynomial: Some(degree),
            ..Baseline::default()
        };
        let rest = treated(
            &Samples::every(0.01, values),
            Treatment {
                baseline,
                ..Treatment::default()
            },
        );
        assert!(
            rest.values.iter().all(|a| a.abs() < 1e-12),
            "degree {degree}"
        );
    }
}

/// The uncorrected record drifts by metres.
#[test]
fn baseline_corrections_stop_the_drift() {
    let raw = samples(record_file!("0165a_u.smc"));
    let drift = Measures::of(&raw).pgd.value.abs();
    assert!(drift > 10.0, "{drift}");
    let polynomial = Baseline {
        polynomial: Some(2),
        ..Baseline::default()
    };
    let corrected = treated(
        &raw,
        Treatment {
            baseline: polynomial,
            ..Treatment::default()
        },
    );
    assert!(Measures::of(&corrected).pgd.value.abs() < 0.02 * drift);
    let filter = Baseline {
        high_pass: Some((0.2, 4)),
        ..Baseline::default()
    };
    let filtered = treated(
        &raw,
        Treatment {
            baseline: filter,
            remove_mean: true,
            ..Treatment::default()
        },
    );
    let m = Measures::of(&filtered);
    assert!(m.pgd.value.abs() < 0.1, "{m:?}");
    // At rest at the end, and the strong motion is still there.
    assert!(m.end[0].abs() < 1e-4 && m.end[1].abs() < 1e-3, "{m:?}");
    assert!(
        (m.pga.value / -2.66).abs() > 0.97 && (m.pga.value / -2.66).abs() < 1.03,
        "{m:?}"
    );
}

/// Twice through the filter: the square of the Butterworth amplitude, and no shift of phase.
#[test]
fn the_high_pass_filter_is_butterworths() {
    let (dt, corner) = (0.005, 1.0);
    for order in [2, 4] {
        for ratio in [0.5_f64, 1.0, 2.0] {
            let omega = std::f64::consts::TAU * corner * ratio;
            // Many periods, of which the middle is looked at.
            let values: Vec<f64> = (0..16_001)
                .map(|i| (omega * (i as f64 - 8000.0) * dt).cos())
                .collect();
            let filter = Baseline {
                high_pass: Some((corner, order)),
                ..Baseline::default()
            };
            let filtered = treated(
                &Samples::every(dt, values),
                Treatment {
                    baseline: filter,
                    ..Treatment::default()
                },
            );
            let middle = filtered.values.len() / 2;
            let expected = 1.0 / (1.0 + ratio.powi(-2 * order as i32));
            let found = filtered.values[middle];
            assert!(
                (found - expected).abs() < 2e-3,
                "order {order}, ratio {ratio}: {found} is not {expected}"
            );
            assert!((filtered.values[middle - 1] - filtered.values[middle + 1]).abs() < 1e-6);
        }
    }
}

/// A constant grows evenly; of a line, the integral of its square.
#[test]
fn the_arias_intensity_grows_from_zero_to_its_whole() {
    let samples = |values: &[f64]| Samples {
        times: Times::Every {
            start: 0.0,
            dt: 0.25,
        },
        values: values.to_vec(),
    };
    assert_eq!(samples(&[2.0; 5]).husid(), [0.0, 0.25, 0.5, 0.75, 1.0]);
    let line = samples(&[0.0, 3.0, 6.0]).husid();
    assert_eq!(line, [0.0, 0.125, 1.0]);
    assert_eq!(samples(&[0.0; 3]).husid(), [0.0; 3]);
}
