//! Texts from files for a terminal.

use std::borrow::Cow;

/// The text without characters that steer a terminal or turn the reading direction: names in files may hold them. In
/// their place stand escapes as JSON has them (`\u001b`), so that a JSON document stays one.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        if steers(character) {
            shown.push_str(&format!("\\u{:04x}", u32::from(character)));
        } else {
            shown.push(character);
        }
    }
    Cow::Owned(shown)
}

/// Control characters but line break and tab, and those that turn or hide text (Unicode bidirectional algorithm).
fn steers(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        '\u{61c}'
        | '\u{200b}'..='\u{200f}'
        | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}'
        | '\u{feff}' => true,
        _ => character.is_control(),
    }
}

#[cfg(test)]
mod tests {
    use super::{printable, steers};

    #[test]
    fn a_terminal_is_not_steered() {
        assert_eq!(
            printable("body `\u{1b}[2J`\r\u{9b}x"),
            "body `\\u001b[2J`\\u000d\\u009bx"
        );
        assert_eq!(printable("a\u{202e}b"), "a\\u202eb");
        let plain = "Größe\tµm\nK_Hβ";
        assert_eq!(printable(plain), plain);
    }

    #[test]
    fn json_stays_json() {
        let name = "a\u{202e}\u{7f}\u{85}";
        let text = serde_json::json!({ "name": name }).to_string();
        let shown = printable(&text);
        assert!(!shown.contains(steers));
        let read: serde_json::Value = serde_json::from_str(&shown).unwrap_or_default();
        assert_eq!(read["name"], name);
    }
}
