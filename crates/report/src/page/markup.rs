//! Escaping of texts for HTML and of JSON for a script element.

use super::typography::html;

/// Text that is safe in an element and in a quoted attribute.
pub(super) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // Control characters have no place in HTML text.
            c if c.is_control() && c != '\n' && c != '\t' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// The line below a drawing: a patch of colour and a name for each kind of curve, which are not torn apart, and what
/// is said behind them.
pub(super) fn legend<'a>(entries: impl Iterator<Item = (usize, &'a str)>, told: &str) -> String {
    let entry = |(colour, name): (usize, &str)| {
        format!(
            "<span class=\"entry\"><span class=\"key\" style=\"background: var(--c{})\"></span> {}</span> ",
            colour % COLOURS,
            html(name)
        )
    };
    let entries: String = entries.map(entry).collect();
    format!("<p class=\"legend\">{entries}{}</p>\n", html(told))
}

/// About how wide a text of a drawing is in the drawing's own units, at the size that it has on a small screen (14
/// units, page.css), as shares of it in the widest of the style's fonts: digits and small letters 0.64, the minus 0.84.
pub(super) fn text_width(text: &str) -> f64 {
    let share = |letter| if letter == '−' { 0.84 } else { 0.64 };
    14.0 * text.chars().map(share).sum::<f64>()
}

/// Colours of the page's style, from `--c0` on.
pub(super) const COLOURS: usize = 8;

/// JSON that cannot end its script element or open a comment: `<`, `>` and `&` occur in strings only and are written as
/// \u escapes.
pub(super) fn json_for_script(value: &serde_json::Value) -> serde_json::Result<String> {
    let json = serde_json::to_string(value)?;
    Ok(json
        .replace('<', "\\u003c")
        .replace('>', "\\u003e")
        .replace('&', "\\u0026")
        .replace('\'', "\\u0027")
        .replace('\u{2028}', "\\u2028")
        .replace('\u{2029}', "\\u2029"))
}
