//! Of the format K-NET.

use super::*;

#[test]
fn files_that_are_wrong() {
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
