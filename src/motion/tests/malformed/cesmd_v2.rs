//! Of the format CESMD V2.

use super::*;

#[test]
fn files_that_are_wrong() {
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
