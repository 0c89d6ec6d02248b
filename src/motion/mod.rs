//! Ground motions: the files in which they are exchanged, and what is made of them.
//!
//! [`read`] recognises a format by the content of the file, reads it strictly, and holds it against
//! its own header: count, step, peak. Values come out in m/s². Units are never guessed. Everything
//! here works on texts and numbers; files and scenes are others' business.

mod at2;
mod band_limited;
mod cesmd;
mod channel;
mod cosmos;
mod delimited;
mod esm;
mod fault;
mod knet;
mod measures;
mod number;
mod oscillator;
mod smc;
mod spectrum;
mod text;
mod treat;
mod unit;

pub use channel::{Channel, Given, Motion, Samples, Times};
pub use fault::{Fault, Note};
pub use measures::{Measures, Peak};
pub use spectrum::{Ordinate, ordinate};
pub use text::decode;
pub use treat::{Baseline, Refusal, Size, Treatment};
pub use unit::{GRAVITY, Unit};

use text::Page;

/// A format of record files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PEER NGA.
    At2,
    /// NIED K-NET.
    KNet,
    /// NIED KiK-net.
    KikNet,
    /// ESM, DYNA 1.2.
    Esm,
    /// COSMOS V1.20.
    Cosmos,
    /// USGS SMC.
    Smc,
    /// CESMD V2.
    CesmdV2,
    /// Separated columns.
    Csv,
}

impl Format {
    /// How the format is called.
    pub fn name(self) -> &'static str {
        match self {
            Format::At2 => "PEER AT2",
            Format::KNet => "K-NET",
            Format::KikNet => "KiK-net",
            Format::Esm => "ESM",
            Format::Cosmos => "COSMOS",
            Format::Smc => "SMC",
            Format::CesmdV2 => "CESMD V2",
            Format::Csv => "CSV",
        }
    }
}

/// Whether a text is of a reader's format.
type Detect = fn(&Page) -> bool;
type Read = fn(&Page, &Given) -> Result<Motion, Fault>;

/// The readers, by what their files are called. At most one of them knows a file.
const READERS: [(&str, Detect, Read); 7] = [
    ("at2", at2::detect, at2::read),
    ("knet", knet::detect, knet::read),
    ("esm", esm::detect, esm::read),
    ("cosmos", cosmos::detect, cosmos::read),
    ("smc", smc::detect, smc::read),
    ("cesmd", cesmd::detect, cesmd::read),
    ("csv", delimited::detect, delimited::read),
];

/// Reads a record from the text of its file, which [`decode`] gives.
pub fn read(text: &str, given: &Given) -> Result<Motion, Fault> {
    let page = Page::new(text);
    if page.lines.iter().all(|line| line.is_blank()) {
        let help = "a record has a header and values";
        return Err(Fault::new("the file is empty", 0..0, help));
    }
    // What none of them knows, the last one explains.
    let (.., last) = READERS[READERS.len() - 1];
    let reader = READERS.iter().find(|(_, detect, _)| detect(&page));
    reader.map_or(last, |(.., read)| *read)(&page, given)
}

#[cfg(test)]
mod tests;
