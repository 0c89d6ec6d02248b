//! Marks in texts of plots: what pictures and pages show each in their way. All are code points for private use.

/// Opens a subscript.
pub(crate) const SUB: char = '\u{e000}';
/// Closes a subscript.
pub(crate) const END_SUB: char = '\u{e001}';
/// One dot, or two, above the letter that follows: the first and the second rate.
pub(crate) const DOTS: [char; 2] = ['\u{e002}', '\u{e003}'];
