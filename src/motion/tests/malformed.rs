//! What a correct reader does with files that are wrong, and with such as only look so.

use super::*;

enum Outcome {
    /// The record of the file it was made from.
    Same,
    /// A record with these first values, in m/s².
    Values(&'static [f64]),
    /// Refused, with a line (0: any) and words of the message.
    Refused(usize, &'static str),
    /// Read, with a doubt that has these words.
    Doubt(&'static str),
}
use Outcome::{Doubt, Refused, Same, Values};

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("ASCII")
}

/// A text with one part, which is there once, replaced.
fn with(text: &str, old: &str, new: &str) -> Vec<u8> {
    assert_eq!(text.matches(old).count(), 1, "{old:?}");
    text.replace(old, new).into_bytes()
}

/// A text with a line, from 1, replaced.
fn with_line(text: &str, number: usize, new: &str) -> Vec<u8> {
    let mut lines: Vec<&str> = text.lines().collect();
    lines[number - 1] = new;
    (lines.join("\n") + "\n").into_bytes()
}

fn assert_outcomes(base: &[u8], rows: Vec<(&str, Vec<u8>, Outcome)>) {
    let expected = samples(base);
    for (name, bytes, outcome) in rows {
        let result = open(&bytes, &Given::default());
        match (outcome, result) {
            (Same, Ok(motion)) => assert_eq!(motion.channels[0].samples, expected, "{name}"),
            (Values(first), Ok(motion)) => {
                let values = &motion.channels[0].samples.values[..first.len()];
                for (value, expected) in values.iter().zip(first) {
                    let near = (value - expected).abs() <= 1e-14 * expected.abs();
                    assert!(near, "{name}: {values:?}");
                }
            }
            (Refused(line, words), Err((at, fault))) => {
                assert!(line == 0 || at == line, "{name}: line {at}: {fault}");
                assert!(fault.message.contains(words), "{name}: {fault}");
                assert!(!fault.help.is_empty(), "{name}");
            }
            (Doubt(words), Ok(motion)) => {
                let told = motion
                    .notes
                    .iter()
                    .any(|n| n.doubt && n.message.contains(words));
                assert!(told, "{name}: {:?}", motion.notes);
            }
            (_, result) => panic!("{name}: {result:?}"),
        }
    }
}

#[test]
fn at2() {
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

#[test]
fn smc() {
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

#[test]
fn cosmos() {
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

#[test]
fn knet() {
    let base = text(KNET);
    assert_outcomes(
        KNET,
        vec![
            (
                "no scale factor",
                with(&base, "3920(gal)/6182761", ""),
                Refused(14, "scale factor"),
            ),
            (
                "scale factor without unit",
                with(&base, "3920(gal)/6182761", "3920/6182761"),
                Refused(14, "scale factor"),
            ),
            (
                "another scale factor",
                with(&base, "3920(gal)", "2000(gal)"),
                Doubt("peak 62.869"),
            ),
            (
                "no frequency",
                with(&base, "200Hz", "Hz"),
                Refused(11, "sampling frequency"),
            ),
            (
                "frequency zero",
                with(&base, "200Hz", "0Hz"),
                Refused(11, "sampling frequency"),
            ),
            (
                "frequency of another record",
                with(&base, "200Hz", "100Hz"),
                Doubt("duration of 10 s"),
            ),
            (
                "half of the counts",
                base.as_bytes()[..base.len() / 2].to_vec(),
                Doubt("duration of 10 s"),
            ),
            (
                "a letter",
                with(&base, "    7498     1618", "    74x8     1618"),
                Refused(18, "74x8"),
            ),
            (
                "a fraction",
                with(&base, "    7498     1618", "    74.8     1618"),
                Refused(18, "whole"),
            ),
            (
                "header only",
                base.lines()
                    .take(17)
                    .collect::<Vec<_>>()
                    .join("\n")
                    .into_bytes(),
                Refused(0, "no values"),
            ),
            (
                "no line of the frequency",
                with(&base, "Sampling Freq(Hz)", "Sampling"),
                Refused(0, "Sampling Freq(Hz)"),
            ),
        ],
    );
}

#[test]
fn esm() {
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

#[test]
fn cesmd_v2() {
    let base = cesmd();
    let base = base.as_str();
    let first = "   400 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.4)";
    let at = base.find(first).expect("the first block");
    let edited = |old: &str, new: &str| {
        (base[..at].to_owned() + &base[at..].replacen(old, new, 1)).into_bytes()
    };
    let lines = || base.lines().map(|l| format!("{l}\n"));
    let without = |number: usize| {
        lines()
            .enumerate()
            .filter(|(i, _)| i + 1 != number)
            .map(|l| l.1)
            .collect::<String>()
            .into_bytes()
    };
    let data = base[..at].lines().count() + 1;
    let dt: Vec<u8> = base.replacen("   0.00500", "   0.01000", 1).into_bytes();
    for (name, bytes, line, words) in [
        (
            "a line less",
            without(data + 10),
            data + 50,
            "400 accel, 392",
        ),
        (
            "fewer announced",
            edited("   400 points", "   392 points"),
            data + 50,
            "states",
        ),
        (
            "more announced",
            edited("   400 points", "   408 points"),
            0,
            "408 accel, 400",
        ),
        (
            "no unit",
            edited("in cm/sec2.", "           "),
            data,
            "unit",
        ),
        (
            "cut",
            base.as_bytes()[..base.len() - 3000].to_vec(),
            0,
            "are there",
        ),
        ("steps that differ", dt, data, "the step 0.01 s"),
        (
            "uncorrected data",
            base.replacen("Corrected accelerogram", "Uncorrected Accelerogram Data", 1)
                .into_bytes(),
            1,
            "uncorrected",
        ),
    ] {
        let (at, fault) = open(&bytes, &Given::default()).expect_err(name);
        let known = fault.message.contains(words);
        assert!(
            (line == 0 || at == line) && known,
            "{name}: line {at}: {fault}"
        );
    }
}

#[test]
fn csv() {
    let sine = record_file!("sine.csv");
    let base = text(sine);
    let line = |number: usize, new: &str| with_line(&base, number, new);
    let quoted: String = base
        .lines()
        .map(|l| format!("\"{}\"\n", l.replace(',', "\",\"")))
        .collect();
    let without: String = base
        .lines()
        .enumerate()
        .filter(|(i, _)| !(41..46).contains(i))
        .map(|(_, l)| format!("{l}\n"))
        .collect();
    assert_outcomes(
        sine,
        vec![
            (
                "byte-order mark and Windows line ends",
                format!("\u{FEFF}{}", base.replace('\n', "\r\n")).into_bytes(),
                Same,
            ),
            ("quotes", quoted.into_bytes(), Same),
            (
                "a comma at every line end",
                base.replace('\n', ",\n").into_bytes(),
                Same,
            ),
            (
                "blank lines and comments",
                base.replace("\n0.5", "\n\n# half\n0.5").into_bytes(),
                Same,
            ),
            ("an empty field", line(52, "0.50,"), Refused(52, "empty")),
            ("nan", line(52, "0.50,nan"), Refused(52, "nan")),
            (
                "nan in the first row",
                line(2, "0.00,nan"),
                Refused(2, "nan"),
            ),
            ("overflow", line(52, "0.50,1e999"), Refused(52, "1e999")),
            (
                "time backwards",
                line(42, "0.38,1"),
                Refused(42, "does not come after"),
            ),
            (
                "a time twice",
                line(42, "0.39,1"),
                Refused(42, "does not come after"),
            ),
            (
                "a row of three",
                line(52, "0.50,7,-0.958924"),
                Refused(52, "3 fields"),
            ),
            (
                "no rows",
                b"time_s,acc_m_s2\n".to_vec(),
                Refused(0, "no values"),
            ),
            (
                "one row",
                b"time_s,acc_m_s2\n0.0,1.0\n".to_vec(),
                Refused(0, "only one value"),
            ),
            (
                "an unknown unit",
                base.replace("acc_m_s2", "acc [furlong]").into_bytes(),
                Refused(1, "furlong"),
            ),
            (
                "a velocity",
                base.replace("acc_m_s2", "vel_m_s").into_bytes(),
                Refused(1, "no column"),
            ),
            (
                "a thousands separator",
                b"# dt = 0.1 s, acceleration in g\na;b_g\n1.000,5;2\n1.001,5;3\n".to_vec(),
                Refused(3, "1.000,5"),
            ),
            (
                "comma or columns",
                b"# dt = 0.1 s, acceleration in g\n0,5\n0,6\n".to_vec(),
                Refused(2, "comma"),
            ),
            (
                "two steps stated",
                b"# dt = 0.1 s, acceleration in g\n# dt = 0.2 s\n1\n2\n".to_vec(),
                Refused(2, "different steps"),
            ),
            (
                "prose",
                b"This is\nno record\nat all, 1\nbut a letter\n".to_vec(),
                Refused(1, "not a record"),
            ),
        ],
    );
    // A gap is no equal step: the times are kept.
    let gap = open(without.as_bytes(), &Given::default()).expect("a record");
    assert_eq!(gap.channels[0].samples.dt(), None);
    assert_eq!(gap.channels[0].samples.time(94), 0.99);
    assert!(gap.notes[0].message.contains("0.06 s"), "{:?}", gap.notes);
}

/// No piece of any file makes a reader panic, and no cut one passes for the whole.
#[test]
fn cut_anywhere() {
    let built = cesmd();
    for bytes in [AT2, SMC, COSMOS, KNET, ESM, built.as_bytes()] {
        let whole = open(bytes, &Given::default()).expect("a record").channels;
        for part in 0..97 {
            let cut = &bytes[..bytes.len() * part / 97];
            if let Ok(motion) = open(cut, &Given::default()) {
                let doubted = motion.notes.iter().any(|n| n.doubt);
                let channels = motion.channels.len() < whole.len();
                assert!(
                    doubted || channels,
                    "{} of {} bytes",
                    cut.len(),
                    bytes.len()
                );
            }
        }
    }
}
