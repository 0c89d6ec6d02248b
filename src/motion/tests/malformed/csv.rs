//! Of the format CSV.

use super::*;

#[test]
fn files_that_are_wrong() {
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
