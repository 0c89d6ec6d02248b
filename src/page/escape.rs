//! Text and data in a page, such that nothing in them is markup.

use serde::Serialize;

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
            // No control character but the end of a line and a tab is text.
            c if c.is_control() && c != '\n' && c != '\t' => out.push('\u{fffd}'),
            c => out.push(c),
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
