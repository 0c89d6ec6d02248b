//! Of the format SMC.

use super::*;

#[test]
fn files_that_are_wrong() {
    let base = text(SMC);
    let unix = base.replace("\r\n", "\n");
    let stripped: String = unix
        .lines()
        .map(|l| format!("{}\r\n", l.trim_end()))
        .collect();
    let half = base.len() / 2;
    assert_outcomes(
        SMC,
        vec![
            ("Unix line ends", unix.clone().into_bytes(), Same),
            ("no blanks at line ends", stripped.into_bytes(), Same),
            (
                "wrong count of comments",
                with(&unix, "       101         8\n", "       101         7\n"),
                Refused(13, "7 lines of comment, 8"),
            ),
            (
                "too many values announced",
                with(&unix, "      6001    -32768", "      6100    -32768"),
                Refused(0, "6100 values, 6000"),
            ),
            (
                "too few values announced",
                with(&unix, "      6001    -32768", "      6000    -32768"),
                Refused(0, "6000 values, more"),
            ),
            (
                "unknown sampling rate",
                with(
                    &unix,
                    "  0.1700000E+39  0.2000000E+03",
                    "  0.1700000E+39  0.1700000E+39",
                ),
                Refused(18, "sampling rate"),
            ),
            (
                "sampling rate zero",
                with(
                    &unix,
                    "  0.1700000E+39  0.2000000E+03",
                    "  0.1700000E+39  0.0000000E+00",
                ),
                Refused(18, "sampling rate"),
            ),
            (
                "sampling rate of another record",
                with(
                    &unix,
                    "  0.1700000E+39  0.2000000E+03",
                    "  0.1700000E+39  0.1000000E+03",
                ),
                Doubt("peak at 10.17 s"),
            ),
            (
                "peak of another record",
                with(
                    &unix,
                    "  0.1017000E+02  0.1044078E+03",
                    "  0.1017000E+02  0.1144078E+03",
                ),
                Doubt("peak 114.4"),
            ),
            (
                "cut",
                unix.as_bytes()[..half].to_vec(),
                Refused(0, "6001 values"),
            ),
            (
                "velocities",
                with(&unix, "2 CORRECTED ACCELEROGRAM", "3 VELOCITY             "),
                Refused(1, "VELOCITY"),
            ),
            (
                "a column moved",
                with(&unix, " 2.6283E+0 3.4237E+0", "  2.6283E+0 3.4237E+"),
                Refused(0, ""),
            ),
            (
                "stars",
                with(&unix, " 2.6283E+0 3.4237E+0", "********** 3.4237E+0"),
                Refused(39, "***"),
            ),
        ],
    );
}
