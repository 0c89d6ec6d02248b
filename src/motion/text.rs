//! The text of a record, line by line.

use std::ops::Range;

use super::Fault;

/// The text of a file: UTF-8 with or without byte-order mark, else Latin-1. Lines that end with a
/// carriage return alone get a line feed instead, which leaves every place where it is.
///
/// The place of a fault counts in the text that [`String::from_utf8_lossy`] makes of the file.
pub fn decode(bytes: &[u8]) -> Result<String, Fault> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(Fault::new(
            "the text is UTF-16",
            0..0,
            "save the file as UTF-8",
        ));
    }
    let whole = bytes;
    let bytes = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
    // Old systems end a text with Ctrl-Z.
    let end = bytes.iter().rposition(|&b| b != 0x1A).map_or(0, |i| i + 1);
    let text = &bytes[..end];
    let strange = |b: &u8| *b < 0x20 && !b"\t\n\r\x0C".contains(b);
    if let Some(at) = text.iter().position(strange) {
        let mark = whole.len() - bytes.len();
        let before = mark + String::from_utf8_lossy(&bytes[..at]).len();
        let message = format!("the byte {:#04x} does not occur in texts", bytes[at]);
        let help = "a record is a text file; unpack it if it is compressed";
        return Err(Fault::new(message, before..before + 1, help));
    }
    let text = match std::str::from_utf8(text) {
        Ok(text) => text.to_owned(),
        // Latin-1 is the first 256 characters of Unicode.
        Err(_) => text.iter().map(|&b| char::from(b)).collect(),
    };
    Ok(if text.contains('\n') {
        text
    } else {
        text.replace('\r', "\n")
    })
}

/// A line without its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line<'a> {
    /// Where it starts, in bytes of the text.
    pub start: usize,
    pub text: &'a str,
}

impl<'a> Line<'a> {
    /// Where its text is, without blanks around it.
    pub fn range(&self) -> Range<usize> {
        self.place(self.text.trim())
    }

    /// Where a part of its text is.
    pub fn place(&self, part: &str) -> Range<usize> {
        let offset = part.as_ptr() as usize - self.text.as_ptr() as usize;
        let start = self.start + offset;
        start..start + part.len()
    }

    pub fn is_blank(&self) -> bool {
        self.text.trim().is_empty()
    }

    /// The rest of the text after a word, whatever its case.
    pub fn after(&self, word: &str) -> Option<&'a str> {
        let at = self.find(word)?;
        Some(&self.text[at + word.len()..])
    }

    /// Where a word is in the text, whatever its case. The word is ASCII.
    pub fn find(&self, word: &str) -> Option<usize> {
        self.text
            .to_ascii_lowercase()
            .find(&word.to_ascii_lowercase())
    }

    pub fn has(&self, word: &str) -> bool {
        self.find(word).is_some()
    }
}

/// All lines of a text.
#[derive(Debug)]
pub(super) struct Page<'a> {
    pub lines: Vec<Line<'a>>,
    /// Length of the text in bytes.
    pub length: usize,
}

impl<'a> Page<'a> {
    pub fn new(text: &'a str) -> Self {
        let mut start = 0;
        let lines = text.split_inclusive('\n').map(|whole| {
            let line = Line {
                start,
                text: whole.trim_end_matches(['\n', '\r']),
            };
            start += whole.len();
            line
        });
        Page {
            lines: lines.collect(),
            length: text.len(),
        }
    }

    /// A line, from 0; an empty one behind the last.
    pub fn line(&self, i: usize) -> Line<'a> {
        let end = Line {
            start: self.length,
            text: "",
        };
        self.lines.get(i).copied().unwrap_or(end)
    }

    /// The first of some lines that has a word, and its number.
    pub fn find(&self, among: Range<usize>, word: &str) -> Option<(usize, Line<'a>)> {
        let end = among.end.min(self.lines.len());
        let mut lines = among.start..end;
        lines.find_map(|i| self.lines[i].has(word).then(|| (i, self.lines[i])))
    }

    /// The place of the last text.
    pub fn end(&self) -> Range<usize> {
        let last = self.lines.iter().rev().find(|line| !line.is_blank());
        last.map_or(0..0, Line::range)
    }
}
