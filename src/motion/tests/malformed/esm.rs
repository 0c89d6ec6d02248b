//! Of the format ESM.

use super::*;

#[test]
fn files_that_are_wrong() {
    let base = text(ESM);
    let header = 64;
    let long = format!("USER1: {}", "x".repeat(366));
    let zero = with_line(&base, header + 1, "-0.000000");
    assert_outcomes(
        ESM,
        vec![
            ("a long line of header", with(&base, "USER1: ", &long), Same),
            ("negative zero", zero, Values(&[-0.0])),
            (
                "NDATA too large",
                with(&base, "NDATA: 2000", "NDATA: 2001"),
                Refused(0, "NDATA = 2001, 2000 values"),
            ),
            (
                "NDATA too small",
                with(&base, "NDATA: 2000", "NDATA: 1999"),
                Refused(64 + 2000, "1999 values, 2000"),
            ),
            (
                "no step",
                with(
                    &base,
                    "SAMPLING_INTERVAL_S: 0.005000",
                    "SAMPLING_INTERVAL_S: ",
                ),
                Refused(29, "SAMPLING_INTERVAL_S"),
            ),
            (
                "another step",
                with(
                    &base,
                    "SAMPLING_INTERVAL_S: 0.005000",
                    "SAMPLING_INTERVAL_S: 0.010000",
                ),
                Doubt("9.27 s"),
            ),
            (
                "another unit",
                with(&base, "UNITS: cm/s^2", "UNITS: cm/s"),
                Refused(33, "unit of acceleration"),
            ),
            (
                "velocities",
                with(&base, "DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY"),
                Refused(50, "VELOCITY"),
            ),
            (
                "another peak",
                with(&base, "PGA_CM/S^2: 62.320000", "PGA_CM/S^2: 72.320000"),
                Doubt("peak 72.32"),
            ),
            (
                "two values in a line",
                with_line(&base, 70, "1.0 2.0"),
                Refused(70, "1.0 2.0"),
            ),
            ("NaN", with_line(&base, 70, "nan"), Refused(70, "nan")),
            (
                "an older header",
                with(&base, "HEADER_FORMAT: DYNA 1.2", "HEADER_FORMAT: DYNA 1.1"),
                Doubt("DYNA 1.1"),
            ),
        ],
    );
}
