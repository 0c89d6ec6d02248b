//! Marks in texts of plots: what pictures and pages show each in their way. All are code points for private use.

/// Opens a subscript.
pub(crate) const SUB: char = '\u{e000}';
/// Closes a subscript.
pub(crate) const END_SUB: char = '\u{e001}';
/// One dot, or two, above the letter that follows: the first and the second rate.
pub(crate) const DOTS: [char; 2] = ['\u{e002}', '\u{e003}'];

/// Whether files of every format hold a character: XML has none for controls, and for two that are none.
pub(crate) fn is_printable(c: char) -> bool {
    !c.is_control() && u32::from(c) & 0xfffe != 0xfffe
}

/// A text as pictures hold it: what cannot be printed, and marks of subscripts that have no partner, are replaced by `\u{fffd}`.
pub(crate) fn printable(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        match (c, rest.split_once(END_SUB)) {
            (SUB, Some((within, after))) if !within.contains(SUB) => {
                out.push(SUB);
                out.push_str(&printable(within));
                out.push(END_SUB);
                rest = after;
            }
            (SUB | END_SUB, _) => out.push('\u{fffd}'),
            _ => out.push(if is_printable(c) { c } else { '\u{fffd}' }),
        }
    }
    out
}

/// Whether a letter reaches as high as a capital, so that dots stand higher.
pub(crate) fn is_tall(letter: char) -> bool {
    letter.is_uppercase() || "bdfhijklt0123456789βδζθλξφψ".contains(letter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_picture_holds_is_replaced() {
        let pair = format!("a{SUB}b{END_SUB}");
        assert_eq!(printable(&pair), pair);
        assert_eq!(
            printable(&format!("{END_SUB}{SUB}{SUB}\u{7}{END_SUB}c\u{ffff}\n")),
            format!("\u{fffd}\u{fffd}{SUB}\u{fffd}{END_SUB}c\u{fffd}\u{fffd}")
        );
    }
}
