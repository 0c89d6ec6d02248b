//! Text and data in a page, such that nothing in them is markup.

use crate::record::plot::marked::{DOTS, END_SUB, SUB, is_printable, is_tall};
use serde::Serialize;

/// A text with marks of subscripts and dots ([`crate::record::plot::marked`]) as HTML.
pub(super) fn symbols(marked: &str) -> String {
    let mut out = String::new();
    let mut chars = marked.chars();
    while let Some(c) = chars.next() {
        match (c, DOTS.iter().position(|&dots| dots == c)) {
            (SUB, _) => out.push_str("<sub>"),
            (END_SUB, _) => out.push_str("</sub>"),
            (_, Some(i)) => {
                let letter = chars.next().unwrap_or_default();
                let (dots, tall) = (i + 1, if is_tall(letter) { " tall" } else { "" });
                let letter = text(&letter.to_string());
                out.push_str(&format!("<span class=\"dots{dots}{tall}\">{letter}</span>"));
            }
            _ => out.push_str(&text(&c.to_string())),
        }
    }
    out
}

/// The same without any markup: `x_I`, `rate of θ`.
pub(super) fn plain(marked: &str) -> String {
    let mut out = String::new();
    for c in marked.chars() {
        match (c, DOTS.iter().position(|&dots| dots == c)) {
            (SUB, _) => out.push('_'),
            (END_SUB, _) => {}
            (_, Some(0)) => out.push_str("rate of "),
            (_, Some(_)) => out.push_str("acceleration of "),
            _ => out.push(c),
        }
    }
    out
}

/// A text for a place between tags or in a quoted attribute.
pub(super) fn text(raw: &str) -> String {
    let mut out = String::with_capacity(raw.len());
    for c in raw.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            c => out.push(if is_printable(c) { c } else { '\u{fffd}' }),
        }
    }
    out
}

/// Data as JSON for a script element, which ends at the first `</script` in it, whatever that is part of. Numbers that
/// are not finite become `null`.
pub(super) fn script_data(data: &impl Serialize) -> String {
    let json = serde_json::to_string(data).expect("data has text as keys");
    // In JSON these stand inside of strings alone.
    json.replace('<', "\\u003c")
        .replace('>', "\\u003e")
        .replace('&', "\\u0026")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_a_text_is_markup() {
        assert_eq!(
            text("<b a=\"x\" c='y'>&\u{7}\n"),
            "&lt;b a=&quot;x&quot; c=&#39;y&#39;&gt;&amp;\u{fffd}\n"
        );
    }

    #[test]
    fn marks_become_markup_and_nothing_else_does() {
        let marked = format!("{}<{SUB}&{END_SUB}", DOTS[1]);
        assert_eq!(
            symbols(&marked),
            "<span class=\"dots2\">&lt;</span><sub>&amp;</sub>"
        );
        assert_eq!(plain(&marked), "acceleration of <_&");
    }

    #[test]
    fn script_data_cannot_end_its_element() {
        let json = script_data(&"</script><!--<script>&");
        assert!(!json.contains(['<', '>', '&']), "{json}");
        let back: String = serde_json::from_str(&json).unwrap();
        assert_eq!(back, "</script><!--<script>&");
    }

    #[test]
    fn what_is_not_finite_is_null() {
        assert_eq!(
            script_data(&[f64::NAN, f64::INFINITY, 0.1]),
            "[null,null,0.1]"
        );
    }
}
