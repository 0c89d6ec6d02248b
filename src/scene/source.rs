//! Texts that errors point into.

use std::ops::Range;
use std::sync::Arc;

/// A text with a name: a scene file, a table, or one `--set`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Source {
    /// What errors call it: the path as it was given, or `--set`.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// A stretch of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Span {
    pub source: Arc<Source>,
    /// Byte offsets, on character boundaries.
    pub range: Range<usize>,
}

/// Where an error is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Position {
    /// The file as it was named, or `--set` for a value from the command line.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Byte offsets into the text.
    pub bytes: Range<usize>,
}

impl Span {
    /// The stretch `range` of a text. Offsets inside a character are moved to its start, and those
    /// behind the last line to the end of that line.
    pub fn new(source: &Arc<Source>, range: Range<usize>) -> Self {
        let boundary = |at: usize| {
            let at = match at < source.text.len() {
                true => at,
                false => source.text.trim_end_matches(['\r', '\n']).len(),
            };
            (0..=at)
                .rev()
                .find(|&i| source.text.is_char_boundary(i))
                .unwrap_or(0)
        };
        let start = boundary(range.start);
        let end = boundary(range.end).max(start);
        Span {
            source: Arc::clone(source),
            range: start..end,
        }
    }

    /// The text itself.
    pub fn text(&self) -> &str {
        &self.source.text[self.range.clone()]
    }

    /// A part of the span, by offsets from its start.
    pub fn part(&self, range: Range<usize>) -> Self {
        Span::new(
            &self.source,
            self.range.start + range.start..self.range.start + range.end,
        )
    }

    /// Its first character; what errors about a long stretch point at.
    pub fn start(&self) -> Self {
        let length = self.text().chars().next().map_or(0, char::len_utf8);
        self.part(0..length)
    }

    /// File, line and column of its start.
    pub fn position(&self) -> Position {
        let before = &self.source.text[..self.range.start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Position {
            file: self.source.name.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            bytes: self.range.clone(),
        }
    }
}
