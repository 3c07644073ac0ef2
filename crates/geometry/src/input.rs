//! Reading TOML for people: every complaint names file, line, key, what was found and what is allowed.

use serde::de::DeserializeOwned;
use std::fmt::Display;
use std::path::Path;

/// A complaint about an input file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}: {}{problem}", line.map(|l| format!(":{l}")).unwrap_or_default(), if key.is_empty() { String::new() } else { format!("{key}: ") })]
pub struct InputError {
    /// The file as the user named it.
    pub file: String,
    /// Line of the offending key, counted from one, where it is known.
    pub line: Option<usize>,
    /// Dotted path of the key, for example `blank.web_thickness_mm`; empty for the file as a whole.
    pub key: String,
    /// What was found and what is allowed.
    pub problem: String,
}

/// The text of an input file together with its name, so that complaints can point into it.
#[derive(Debug, Clone)]
pub struct InputDocument {
    /// The file as the user named it.
    pub file: String,
    /// Its content, kept verbatim for provenance.
    pub text: String,
}

impl InputDocument {
    /// Reads a file.
    ///
    /// # Errors
    /// [`InputError`] when the file cannot be read or is not UTF-8.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let file = path.display().to_string();
        std::fs::read_to_string(path)
            .map(|text| Self {
                file: file.clone(),
                text,
            })
            .map_err(|cause| InputError {
                file,
                line: None,
                key: String::new(),
                problem: format!("cannot read the file: {cause}"),
            })
    }

    /// Wraps text that is already in memory.
    pub fn new(file: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            text: text.into(),
        }
    }

    /// Parses the document into a structure whose keys are all checked by serde.
    ///
    /// # Errors
    /// [`InputError`] with the line of a syntax error, an unknown key, a missing key or a wrong type. An unknown
    /// key that differs from a known one by its unit only is answered with the right key.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, InputError> {
        toml::from_str(&self.text).map_err(|error| {
            let message = error.message().trim().to_string();
            InputError {
                file: self.file.clone(),
                line: error.span().map(|span| self.line_of(span.start)),
                key: String::new(),
                problem: match unit_hint(&message) {
                    Some(hint) => format!("{message}; {hint}"),
                    None => message,
                },
            }
        })
    }

    /// A complaint about the value of `key` (dotted path; array items by number: `gauge.0.tooth`).
    pub fn error(&self, key: &str, problem: impl Display) -> InputError {
        InputError {
            file: self.file.clone(),
            line: self.locate(key),
            key: key.to_string(),
            problem: problem.to_string(),
        }
    }

    /// Line of a dotted key, or of the deepest parent of it that is in the file.
    fn locate(&self, key: &str) -> Option<usize> {
        let table = toml::de::DeTable::parse(&self.text).ok()?;
        let mut found = None;
        let mut value: Option<&toml::Spanned<toml::de::DeValue<'_>>> = None;
        for part in key.split('.') {
            let next = match value.map(|v| v.get_ref()) {
                None => table
                    .get_ref()
                    .get_key_value(part)
                    .map(|(k, v)| (k.span(), v)),
                Some(toml::de::DeValue::Table(t)) => {
                    t.get_key_value(part).map(|(k, v)| (k.span(), v))
                }
                Some(toml::de::DeValue::Array(a)) => part
                    .parse::<usize>()
                    .ok()
                    .and_then(|i| a.get(i))
                    .map(|v| (v.span(), v)),
                Some(_) => None,
            };
            let Some((span, next)) = next else { break };
            found = Some(self.line_of(span.start));
            value = Some(next);
        }
        found
    }

    fn line_of(&self, offset: usize) -> usize {
        self.text.as_bytes()[..offset.min(self.text.len())]
            .iter()
            .filter(|b| **b == b'\n')
            .count()
            + 1
    }
}

/// For serde's "unknown field `a_m`, expected one of `a_mm`, ...": the expected key with the same stem.
fn unit_hint(message: &str) -> Option<String> {
    let rest = message.strip_prefix("unknown field `")?;
    let (found, expected) = rest.split_once('`')?;
    let stem = found.rsplit_once('_').map_or(found, |(stem, _)| stem);
    expected
        .split('`')
        .skip(1)
        .step_by(2)
        .find(|name| name.rsplit_once('_').map_or(*name, |(s, _)| s) == stem || *name == stem)
        .map(|name| format!("did you mean `{name}`? The unit is part of the key"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Probe {
        #[allow(dead_code)]
        web_thickness_mm: f64,
    }

    #[test]
    fn a_wrong_unit_is_answered_with_the_right_key() {
        let document = InputDocument::new("g.toml", "# head\nweb_thickness_m = 0.005\n");
        let text = document.parse::<Probe>().unwrap_err().to_string();
        assert!(text.starts_with("g.toml:2: "), "{text}");
        assert!(text.contains("`web_thickness_mm`? The unit"), "{text}");
    }

    #[test]
    fn a_value_is_located_by_its_dotted_key() {
        let document = InputDocument::new(
            "g.toml",
            "[blank]\nkind = 'solid'\n\n[[gauge]]\n[[gauge]]\ntooth = 4\n",
        );
        assert_eq!(document.error("gauge.1.tooth", "no").line, Some(6));
        assert_eq!(
            document.error("blank.bore_diameter_mm", "missing").line,
            Some(1)
        );
        assert_eq!(document.error("nothing", "missing").line, None);
    }
}
