//! Marks in texts of plots: what pictures and pages show each in their way. All are code points for private use.

/// Opens a subscript.
pub(crate) const SUB: char = '\u{e000}';
/// Closes a subscript.
pub(crate) const END_SUB: char = '\u{e001}';
/// One dot, or two, above the letter that follows: the first and the second rate.
pub(crate) const DOTS: [char; 2] = ['\u{e002}', '\u{e003}'];

/// Whether a letter reaches as high as a capital, so that dots stand higher.
pub(crate) fn is_tall(letter: char) -> bool {
    letter.is_uppercase() || "bdfhijklt0123456789βδζθλξφψ".contains(letter)
}
