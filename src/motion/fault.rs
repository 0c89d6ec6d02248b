//! What is wrong with a record, and what is only doubtful.

use std::fmt;
use std::ops::Range;

/// Why a text is not a record: what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// What is wrong.
    pub message: String,
    /// Where, in bytes of the text.
    pub range: Range<usize>,
    /// What would be right.
    pub help: String,
}

impl Fault {
    /// A fault at a stretch of the text.
    pub fn new(message: impl Into<String>, range: Range<usize>, help: impl Into<String>) -> Self {
        Fault {
            message: message.into(),
            range,
            help: help.into(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.message, self.help)
    }
}

impl std::error::Error for Fault {}

/// Something about a record that its reader has to tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// What it is.
    pub message: String,
    /// Where, in bytes of the text.
    pub range: Range<usize>,
    /// Whether file and header contradict each other, so that the record may be wrong.
    pub doubt: bool,
}

impl Note {
    /// Something to know.
    pub fn remark(message: impl Into<String>, range: Range<usize>) -> Self {
        Note {
            message: message.into(),
            range,
            doubt: false,
        }
    }

    /// A contradiction within the file.
    pub fn doubt(message: impl Into<String>, range: Range<usize>) -> Self {
        Note {
            doubt: true,
            ..Note::remark(message, range)
        }
    }
}
