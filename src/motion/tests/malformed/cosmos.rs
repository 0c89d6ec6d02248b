//! Of the format COSMOS.

use super::*;

#[test]
fn files_that_are_wrong() {
    let base = text(COSMOS);
    let units = "units=cm/sec2(04),Format";
    let end = base.lines().last().expect("a line").to_owned();
    assert_outcomes(
        COSMOS,
        vec![
            (
                "unknown step",
                with(
                    &base,
                    "  -999.000000    10.000000    70.000000",
                    "  -999.000000  -999.000000    70.000000",
                ),
                Refused(36, "step"),
            ),
            (
                "another step",
                with(
                    &base,
                    "  -999.000000    10.000000    70.000000",
                    "  -999.000000     5.000000    70.000000",
                ),
                Doubt("13.925"),
            ),
            (
                "cut",
                base.as_bytes()[..40_000].to_vec(),
                Refused(0, "7000 values, 3608"),
            ),
            (
                "no end of the data",
                with(&base, &format!("{end}\n"), ""),
                Same,
            ),
            (
                "counts",
                with(&base, units, "units=counts (50),Format"),
                Refused(46, "counts"),
            ),
            (
                "name and code of the unit differ",
                with(&base, units, "units=cm/sec2(02),Format"),
                Refused(46, "disagree"),
            ),
            (
                "g",
                with(&base, units, "units=g (02),Format"),
                Values(&[-0.00001 * 9.80665, 0.00013 * 9.80665]),
            ),
            (
                "velocities by code",
                with(
                    &base,
                    "       2       1       4     120",
                    "       2       2       4     120",
                ),
                Refused(46, "not accelerations"),
            ),
            (
                "two values more than announced",
                with(&base, "   7000  acceleration", "   6998  acceleration"),
                Refused(921, "column too many"),
            ),
            (
                "a line more than announced",
                with(&base, "   7000  acceleration", "   6992  acceleration"),
                Refused(921, "end of the data"),
            ),
            (
                "an empty column",
                with(
                    &base,
                    "   -.00001    .00013    .00000    .00014    .00000    .00013",
                    "   -.00001              .00000    .00014    .00000    .00013",
                ),
                Refused(47, "not a finite number"),
            ),
            (
                "another version",
                with(&base, "(Format v01.20", "(Format v01.10"),
                Doubt("01.10"),
            ),
        ],
    );
}
