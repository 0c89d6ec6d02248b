//! Of the format AT2.

use super::*;

#[test]
fn files_that_are_wrong() {
    let base = text(AT2);
    let counts = "NPTS=   1000, DT=   .0050 SEC";
    let head = |line: &str| with(&base, counts, line);
    // The third number of line 51.
    let value = |new: &str| with(&base, "   .1025325E+00", new);
    let header: String = base.lines().take(3).map(|l| format!("{l}\n")).collect();
    let short = |line: &str, values: &str| format!("{header}{line}\n{values}\n").into_bytes();
    let numbers: Vec<f64> = samples(AT2).values.iter().map(|a| a / 9.80665).collect();
    let touching: String = numbers
        .chunks(8)
        .map(|row| {
            row.iter()
                .map(|x| format!("{:7.4}", 10.0 * x))
                .collect::<String>()
                + "\n"
        })
        .collect();
    let utf16: Vec<u8> = [0xFEFF]
        .into_iter()
        .chain(base.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    let latin1: Vec<u8> = with(&base, "San Francisco", "S#o Jos#")
        .into_iter()
        .map(|b| if b == b'#' { 0xE9 } else { b })
        .collect();
    let truncated = base[..base.len() * 6 / 10].to_owned();
    assert!(!truncated.ends_with(['\n', ' ']), "cut within a number");
    assert_outcomes(
        AT2,
        vec![
            (
                "Windows line ends",
                base.replace('\n', "\r\n").into_bytes(),
                Same,
            ),
            (
                "old Macintosh line ends",
                base.replace('\n', "\r").into_bytes(),
                Same,
            ),
            ("Latin-1", latin1, Same),
            ("UTF-8", with(&base, "San Francisco", "São José"), Same),
            ("byte-order mark", [&[0xEF, 0xBB, 0xBF], AT2].concat(), Same),
            ("UTF-16", utf16, Refused(1, "UTF-16")),
            ("Ctrl-Z at the end", [AT2, &[0x1A]].concat(), Same),
            (
                "blank lines at the end",
                format!("{base}\n   \n\n").into_bytes(),
                Same,
            ),
            (
                "no final line end",
                base.trim_end().as_bytes().to_vec(),
                Same,
            ),
            (
                "values that touch",
                base.replace("  -.", "-.")
                    .replace("   .", " .")
                    .replace("DT= .", "DT=   .")
                    .into_bytes(),
                Same,
            ),
            (
                "fixed columns that touch",
                short(counts, touching.trim_end()),
                Values(&[-0.2095 * 9.80665, -0.219 * 9.80665]),
            ),
            (
                "two points in a token",
                short(
                    "NPTS= 8, DT= .005",
                    "1.234-5.6781.2345-6.789 0.1 0.2 0.3 0.4",
                ),
                Refused(5, "1.234-5.6781.2345-6.789"),
            ),
            (
                "exponents without a letter",
                short(
                    "NPTS= 5, DT= .005",
                    "1.234-103 -2.5-101 3.0+002 1.0E-02 2.0D-02",
                ),
                Values(&[
                    1.234e-103 * 9.80665,
                    -2.5e-101 * 9.80665,
                    300.0 * 9.80665,
                    0.01 * 9.80665,
                    0.02 * 9.80665,
                ]),
            ),
            (
                "exponents with D",
                base.replace("E-0", "D-0")
                    .replace("E+0", "D+0")
                    .into_bytes(),
                Same,
            ),
            (
                "NPTS too large",
                head("NPTS=   1200, DT=   .0050 SEC"),
                Refused(0, "NPTS = 1200, 1000 values"),
            ),
            (
                "NPTS too small",
                head("NPTS=    900, DT=   .0050 SEC"),
                Refused(185, "NPTS = 900, 1000 values"),
            ),
            (
                "cut within a number",
                truncated.clone().into_bytes(),
                Refused(0, "NPTS = 1000, 594 values"),
            ),
            (
                "cut after a letter E",
                truncated.as_bytes()[..truncated.rfind('E').expect("one") + 1].to_vec(),
                Refused(0, "NPTS = 1000, 59"),
            ),
            ("NaN", value("            NaN"), Refused(51, "NaN")),
            (
                "infinity",
                value("       Infinity"),
                Refused(51, "Infinity"),
            ),
            (
                "overflow stars",
                value("***************"),
                Refused(51, "***"),
            ),
            ("1e400", value("  .1000000E+400"), Refused(51, "E+400")),
            (
                "a letter O",
                value("   .1O00000E-02"),
                Refused(51, ".1O00000E-02"),
            ),
            (
                "decimal commas",
                base.replace("   .", "   ,").into_bytes(),
                Refused(4, "DT"),
            ),
            (
                "decimal commas in the values",
                value("   ,1025325E+00"),
                Refused(51, ",1025325E+00"),
            ),
            ("no DT", head("NPTS=   1000"), Refused(4, "step")),
            (
                "DT zero",
                head("NPTS=   1000, DT=   .0000 SEC"),
                Refused(4, "the step is 0 s"),
            ),
            (
                "DT negative",
                head("NPTS=   1000, DT=  -.0050 SEC"),
                Refused(4, "-0.005"),
            ),
            (
                "DT NaN",
                head("NPTS=   1000, DT=  NaN SEC"),
                Refused(4, "NaN"),
            ),
            (
                "NPTS huge",
                head("NPTS=   99999999999999, DT=   .0050 SEC"),
                Refused(0, "99999999999999"),
            ),
            (
                "NPTS beyond a word",
                head("NPTS=   99999999999999999999999, DT=   .0050 SEC"),
                Refused(4, "not a count"),
            ),
            (
                "NPTS negative",
                head("NPTS=   -1000, DT=   .0050 SEC"),
                Refused(4, "-1000"),
            ),
            ("empty", Vec::new(), Refused(0, "empty")),
            ("blank", b"\n  \n".to_vec(), Refused(0, "empty")),
            (
                "header only",
                format!("{header}{counts}\n").into_bytes(),
                Refused(0, "0 values"),
            ),
            (
                "no header line with NPTS",
                header.clone().into_bytes(),
                Refused(0, "NPTS"),
            ),
            (
                "velocity",
                with(
                    &base,
                    "ACCELERATION TIME SERIES IN UNITS OF G",
                    "VELOCITY TIME SERIES IN UNITS OF CM/S",
                ),
                Refused(3, "not accelerations"),
            ),
            (
                "another unit",
                with(&base, "IN UNITS OF G", "IN UNITS OF CM/S/S"),
                Values(&[-0.2095313E-03]),
            ),
            (
                "an unknown unit",
                with(&base, "IN UNITS OF G", "IN UNITS OF FURLONG"),
                Refused(3, "not accelerations"),
            ),
            (
                "binary",
                (0..=255).cycle().take(2048).collect(),
                Refused(0, "0x00"),
            ),
        ],
    );
}
