//! Records of every format, what is wrong with them, and what is made of them.

mod band_limited;
mod malformed;
mod readers;
mod spectra;
mod treatment;

use super::{Channel, Fault, Given, Motion, Samples, decode, read};

/// A file of tests/data/records.
macro_rules! record_file {
    ($name:literal) => {
        include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/data/records/",
            $name
        ))
        .as_slice()
    };
}
use record_file;

const AT2: &[u8] = record_file!("0111a_part.AT2");
const SMC: &[u8] = record_file!("0111a.smc");
const COSMOS: &[u8] = record_file!("test.v1");
const KNET: &[u8] = record_file!("0111a.EW");
const KIKNET: &[u8] = record_file!("0111a.EW2");
const ESM: &[u8] = record_file!("0111a.ASC");
const RAMP: &[u8] = record_file!("synthetic_ramp.csv");

/// Reads a file; a fault comes with its line, from 1.
fn open(bytes: &[u8], given: &Given) -> Result<Motion, (usize, Fault)> {
    let line = |text: &str, fault: Fault| {
        (
            text[..fault.range.start.min(text.len())]
                .matches('\n')
                .count()
                + 1,
            fault,
        )
    };
    let text = decode(bytes).map_err(|fault| line(&String::from_utf8_lossy(bytes), fault))?;
    let motion = read(&text, given).map_err(|fault| {
        assert!(
            text.get(fault.range.clone()).is_some(),
            "{fault:?} is not in the text"
        );
        line(&text, fault)
    })?;
    for note in &motion.notes {
        assert!(
            text.get(note.range.clone()).is_some(),
            "{note:?} is not in the text"
        );
    }
    Ok(motion)
}

/// The only channel of a file.
fn channel(bytes: &[u8]) -> Channel {
    let motion = open(bytes, &Given::default()).expect("a record");
    let [channel] = &motion.channels[..] else {
        panic!("{} channels", motion.channels.len())
    };
    channel.clone()
}

fn samples(bytes: &[u8]) -> Samples {
    channel(bytes).samples
}

/// A record of three channels in the layout of CESMD V2, the second shorter, from the values of
/// 0111a.smc.
fn cesmd() -> String {
    let values: Vec<f64> = samples(SMC).values.iter().map(|a| a * 100.0).collect();
    let mut text = String::new();
    for (number, name, count) in [(1, "360 Deg", 400), (2, "Up", 397), (3, "90 Deg", 400)] {
        let values = &values[1900..1900 + count];
        let at = (0..count).fold(0, |m, i| {
            if values[i].abs() > values[m].abs() {
                i
            } else {
                m
            }
        });
        let mut line = |line: &str| text.push_str(&format!("{line:<80}\n"));
        line(&format!(
            "Corrected accelerogram   00000-T0000-00000.00       Chan {number:2}: {name:>7}     from"
        ));
        for i in 1..25 {
            match i {
                7 => line(&format!("Chan {number:2}: {name:>7}")),
                16 => line("At equally-spaced intervals of    .005  sec."),
                _ => line("a line of text with 3 numbers 1.5 and 2"),
            }
        }
        (0..7).for_each(|row| line(&"    0".repeat(if row < 6 { 16 } else { 4 })));
        let mut reals = [0.0; 100];
        reals[59] = count as f64 * 0.005;
        reals[60] = 0.005;
        reals[64] = at as f64 * 0.005;
        reals[65] = values[at];
        for row in reals.chunks(8) {
            line(&row.iter().map(|x| format!("{x:10.5}")).collect::<String>());
        }
        for (what, unit) in [
            ("accel", "cm/sec2."),
            ("veloc", "cm/sec. "),
            ("displ", "cm.     "),
        ] {
            line(&format!(
                "{count:6} points of {what} data equally spaced at  .005 sec, in {unit} (8f10.4)"
            ));
            for row in values.chunks(8) {
                line(&row.iter().map(|x| format!("{x:10.4}")).collect::<String>());
            }
        }
        line(&format!(
            "/&  ----------  End of data for channel  {number}  ----------"
        ));
    }
    text
}
