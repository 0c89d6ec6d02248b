//! What a correct reader does with files that are wrong, and with such as only look so.

mod at2;
mod cesmd_v2;
mod cosmos;
mod csv;
mod esm;
mod knet;
mod smc;

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
