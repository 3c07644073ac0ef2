//! Numbers, texts and names as written in TOML files.

use std::collections::HashSet;

/// A number with twelve digits: what is lost by changes of unit is less, what a file states is shown as it is.
pub fn number(value: f64) -> String {
    // Adding 0 makes 0 of -0.
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value) + 0.0;
    let text = if rounded != 0.0 && !(1e-5..1e15).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    };
    if text.contains(['.', 'e']) {
        text
    } else {
        format!("{text}.0")
    }
}

/// A list of numbers.
pub fn numbers(values: &[f64]) -> String {
    let all: Vec<String> = values.iter().map(|&v| number(v)).collect();
    format!("[{}]", all.join(", "))
}

/// A text in quotes.
pub fn quoted(text: &str) -> String {
    let plain: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    format!("\"{}\"", plain.replace('\\', "\\\\").replace('"', "\\\""))
}

/// A text that stands behind `#`.
pub fn comment(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// A file name of letters, digits and `_`.
pub fn file_stem(text: &str) -> String {
    let mut stem = String::new();
    for c in text.chars() {
        match c {
            'ä' => stem.push_str("ae"),
            'ö' => stem.push_str("oe"),
            'ü' => stem.push_str("ue"),
            'ß' => stem.push_str("ss"),
            c if c.is_ascii_alphanumeric() => stem.push(c.to_ascii_lowercase()),
            _ if stem.ends_with('_') || stem.is_empty() => {}
            _ => stem.push('_'),
        }
    }
    let stem: String = stem.trim_end_matches('_').chars().take(48).collect();
    if stem.is_empty() {
        "unnamed".to_owned()
    } else {
        stem
    }
}

/// Gives names that stand once each; what scenes use to separate names from numbers is replaced.
#[derive(Debug, Default)]
pub struct Names(HashSet<String>);

impl Names {
    /// A name that nothing else has.
    pub fn unique(&mut self, wanted: &str, id: i64) -> String {
        let plain: String = wanted
            .chars()
            .map(|c| if c.is_control() || c == '/' { '-' } else { c })
            .take(80)
            .collect();
        let plain = plain.trim().to_owned();
        let taken = |name: &String| self.0.contains(name);
        let mut name = plain.clone();
        if name.is_empty() || taken(&name) || name == "ground" {
            name = format!("{plain} [{id}]").trim().to_owned();
        }
        while taken(&name) {
            name.push('_');
        }
        self.0.insert(name.clone());
        name
    }
}
