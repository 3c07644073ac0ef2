//! Reading TOML for people: every complaint names file, line, key, what was found and what is allowed.

mod beside;
mod bounded;
mod csv_rows;
mod derived_tables;
mod file_schema;
mod former_keys;
mod given;
mod kinds;
mod near_names;
mod number_ranges;
mod number_table;
mod readable_file;
mod reader;
mod reading;
mod table_keys;
mod threads;
mod unit_slips;
mod values;
mod wording;

pub use beside::Beside;
pub use bounded::{Bounded, Count, End, NotNegative, Positive, Range, UpTo, Within};
pub use csv_rows::{CsvRows, separator_hint, shown_field};
pub use derived_tables::DerivedTable;
use derived_tables::{Derived, DerivedTables};
pub use file_schema::file_schema;
use former_keys::Renewed;
pub use former_keys::{FormerTable, Move};
pub use kinds::{Kinds, read_kind, write_kind};
pub use near_names::nearest;
pub use number_ranges::NumberRange;
pub use number_table::NumberTable;
pub use readable_file::{
    MOST_MESH_BYTES, MOST_TEXT_BYTES, UnreadableFile, demand_readable, read_bytes,
};
pub use table_keys::TableKeys;
pub use threads::demand_threads;
use values::Held;

use std::fmt::Display;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A complaint about an input file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{problem}", [self.place(), key.clone()].iter().filter(|part| !part.is_empty()).map(|part| format!("{part}: ")).collect::<String>())]
pub struct InputError {
    /// The file as the user named it; empty for what was never a file.
    pub file: String,
    /// Line of the offending key, counted from one, where it is known.
    pub line: Option<usize>,
    /// Dotted path of the key, for example `blank.web_thickness_mm`, array items by number: `gauge.0.tooth`. Empty for
    /// the file as a whole. Of a key that is not known it is the path of the table; `problem` names the key.
    pub key: String,
    /// What was found and what is allowed.
    pub problem: String,
}

impl InputError {
    /// About a file as a whole.
    pub fn of_file(file: impl Display, problem: impl Display) -> Self {
        Self {
            file: file.to_string(),
            line: None,
            key: String::new(),
            problem: problem.to_string(),
        }
    }

    /// File and line, as far as there are any.
    fn place(&self) -> String {
        let line = self.line.map(|line| format!(":{line}"));
        self.file.clone() + &line.unwrap_or_default()
    }
}

/// The text of an input file together with its name, so that complaints can point into it; or values that never were a
/// text.
#[derive(Debug, Clone)]
pub struct InputDocument {
    /// The file as the user named it; empty where there is none.
    pub file: String,
    /// Its content, kept verbatim for provenance.
    pub text: String,
    /// Tables that had another form in earlier files.
    former: &'static [FormerTable],
    /// Items of lists that follow from other tables.
    derived: Option<DerivedTables>,
    /// What is read instead of the text.
    values: Option<Vec<(String, Held)>>,
    /// Folder that its file names are relative to, where it is not that of the file.
    folder: Option<PathBuf>,
}

impl InputDocument {
    /// Reads a file.
    ///
    /// # Errors
    /// [`InputError`] when the file cannot be read, is no regular file, has more than [`MOST_TEXT_BYTES`] or is not
    /// UTF-8.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let file = path.display().to_string();
        let complaint = |line, problem| InputError {
            file: file.clone(),
            line,
            key: String::new(),
            problem,
        };
        let bytes = read_bytes(path, MOST_TEXT_BYTES)
            .map_err(|cause| complaint(None, cause.to_string()))?;
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self::new(file, text)),
            Err(error) => {
                let sound = &error.as_bytes()[..error.utf8_error().valid_up_to()];
                let line = 1 + sound.iter().filter(|b| **b == b'\n').count();
                let problem = "bytes that are no UTF-8 text; save the file as UTF-8";
                Err(complaint(Some(line), problem.to_owned()))
            }
        }
    }

    /// Wraps text that is already in memory.
    pub fn new(file: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            text: text.into(),
            former: &[],
            derived: None,
            values: None,
            folder: None,
        }
    }

    /// The document, whose file names are relative to `folder`.
    #[must_use]
    pub fn in_folder(self, folder: &Path) -> Self {
        Self {
            folder: Some(folder.to_owned()),
            ..self
        }
    }

    /// Folder that its file names are relative to: that of the file where nothing else was said.
    #[must_use]
    pub fn folder(&self) -> &Path {
        let of_file = || Path::new(&self.file).parent().unwrap_or(Path::new(""));
        self.folder.as_deref().unwrap_or_else(of_file)
    }

    /// The document, whose tables may have a former form. All keys of complaints are those of the present form, lines
    /// those of the text.
    #[must_use]
    pub fn with_former(self, former: &'static [FormerTable]) -> Self {
        Self { former, ..self }
    }

    /// What of the text has a former form: a complaint for each, with what is written now.
    ///
    /// # Errors
    /// [`InputError`] for a text that is no TOML.
    pub fn former_notes(&self) -> Result<Vec<InputError>, InputError> {
        let mut tree = self.own_tree().map_err(|e| self.no_toml(&e))?;
        let text = self.values.as_ref().map_or(&*self.text, |_| "");
        let renewed = self.former.iter();
        let renewed = renewed.flat_map(|former| former.renew(tree.get_mut(), text));
        let note = |renewed: Renewed| {
            let ends = renewed
                .places
                .iter()
                .filter_map(|place| Some((self.line_of(place.start)?, self.line_of(place.end)?)));
            let mut lines: Vec<usize> = ends.flat_map(|(first, last)| first..=last).collect();
            lines.sort_unstable();
            lines.dedup();
            let found = match lines.is_empty() {
                true => "is".to_owned(),
                false => wording::lines(&lines),
            };
            let problem = format!(
                "{found} in a form of earlier versions, which is still read; now it is written\n    {}",
                renewed.present
            );
            InputError {
                file: self.file.clone(),
                line: lines.first().copied(),
                key: renewed.key,
                problem,
            }
        };
        Ok(renewed.map(note).collect())
    }

    /// The present form of a dotted path that may be a former one.
    #[must_use]
    pub fn present_path(&self, path: &str) -> String {
        let present = self
            .former
            .iter()
            .find_map(|former| former.present_path(path));
        present.unwrap_or_else(|| path.to_owned())
    }

    /// The values as they stand, with their places in the text.
    fn own_tree(&self) -> Result<Spanned<DeTable<'_>>, toml::de::Error> {
        match &self.values {
            None => DeTable::parse(&self.text),
            Some(values) => Ok(Spanned::new(0..0, values::table(values)?)),
        }
    }

    /// The values in the present form, with their places in the text.
    fn tree(&self) -> Result<Spanned<DeTable<'_>>, toml::de::Error> {
        let mut tree = self.own_tree()?;
        for former in self.former {
            former.renew(tree.get_mut(), &self.text);
        }
        if let Some(derived) = &self.derived {
            derived.append_to(tree.get_mut())?;
        }
        Ok(tree)
    }

    /// A complaint about the value of `key` (dotted path; array items by number: `gauge.0.tooth`).
    pub fn error(&self, key: &str, problem: impl Display) -> InputError {
        let (key, problem) = match self.derived_place(key) {
            None => (key, problem.to_string()),
            Some(Derived { from, place }) => (
                from,
                format!("in {place}, which follows from it: {problem}"),
            ),
        };
        InputError {
            file: self.file.clone(),
            line: self.locate(key),
            key: key.to_string(),
            problem,
        }
    }

    /// Where a dotted path leads, if that is not in the text.
    fn derived_place(&self, path: &str) -> Option<Derived<'_>> {
        self.derived.as_ref()?.place(path)
    }

    /// Whether a dotted key is in the file.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.walk(key)
            .is_some_and(|(_, parts)| parts == key.split('.').count())
    }

    /// Line of a dotted key, or of the deepest parent of it that is in the file.
    fn locate(&self, key: &str) -> Option<usize> {
        self.walk(key)?.0
    }

    /// Line of the deepest part of a dotted key that is in the file, and how many parts that are.
    fn walk(&self, key: &str) -> Option<(Option<usize>, usize)> {
        let table = self.tree().ok()?;
        let mut found = None;
        let mut value: Option<&Spanned<DeValue<'_>>> = None;
        for (above, part) in key.split('.').enumerate() {
            let next = match value.map(|v| v.get_ref()) {
                None => table
                    .get_ref()
                    .get_key_value(part)
                    .map(|(k, v)| (k.span(), v)),
                Some(DeValue::Table(t)) => t.get_key_value(part).map(|(k, v)| (k.span(), v)),
                Some(DeValue::Array(a)) => part
                    .parse::<usize>()
                    .ok()
                    .and_then(|i| a.get(i))
                    .map(|v| (v.span(), v)),
                Some(_) => None,
            };
            let Some((span, next)) = next else { break };
            found = Some((self.line_of(span.start), above + 1));
            value = Some(next);
        }
        found
    }

    /// Line of a place in the text; none of values without one.
    fn line_of(&self, offset: usize) -> Option<usize> {
        let before = &self.text.as_bytes()[..offset.min(self.text.len())];
        let line = 1 + before.iter().filter(|b| **b == b'\n').count();
        self.values.is_none().then_some(line)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Probe {
        blank: Blank,
        #[serde(default)]
        gauge: Vec<Gauge>,
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Blank {
        kind: Kind,
        web_thickness_mm: f64,
        labels: Option<Vec<String>>,
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(rename_all = "kebab-case")]
    enum Kind {
        Solid,
        ThinRim,
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Gauge {
        tooth: usize,
        deep: bool,
    }

    fn complaint(text: &str) -> InputError {
        InputDocument::new("g.toml", text)
            .parse::<Probe>()
            .unwrap_err()
    }

    /// Every way in which serde can refuse a value, with the whole line that a person reads.
    #[test]
    fn a_wrong_value_is_named_by_file_line_and_key() {
        let blank = "[blank]\nkind = 'solid'\nweb_thickness_mm = 5\n";
        for (text, expected) in [
            (
                "[blank]\nkind = 'solid'\nweb_thickness_mm = '5'\n".into(),
                "g.toml:3: blank.web_thickness_mm: found the text \"5\", allowed is a number",
            ),
            (
                format!("{blank}labels = 'a'\n"),
                "g.toml:4: blank.labels: found the text \"a\", allowed is a list",
            ),
            (
                format!("{blank}labels = [\n  'a',\n  2.5,\n]\n"),
                "g.toml:6: blank.labels.1: found 2.5, allowed is text in quotes",
            ),
            (
                format!("{blank}[[gauge]]\ntooth = -1\n"),
                "g.toml:5: gauge.0.tooth: found -1, allowed is a whole number of 0 or more",
            ),
            (
                format!("{blank}[[gauge]]\ntooth = [1]\n"),
                "g.toml:5: gauge.0.tooth: found a list, allowed is a whole number of 0 or more",
            ),
            (
                format!("{blank}[[gauge]]\ntooth = 1\ndeep = {{}}\n"),
                "g.toml:6: gauge.0.deep: found a table, allowed is true or false",
            ),
            (
                format!("{blank}[gauge]\ntooth = 1\n"),
                "g.toml:4: gauge: found a table, allowed is a list",
            ),
            (
                "blank = true\n".into(),
                "g.toml:1: blank: found true, allowed is a table",
            ),
            (
                "[blank]\nkind = 'slid'\n".into(),
                "g.toml:2: blank.kind: unknown variant `slid`, expected `solid` or `thin-rim`",
            ),
            (
                "[blank]\nkind = 3\n".into(),
                "g.toml:2: blank.kind: allowed is a name in quotes",
            ),
        ] {
            assert_eq!(complaint(&text).to_string(), expected);
        }
    }

    #[test]
    fn a_missing_key_is_named_at_the_line_of_its_table() {
        let error = complaint("# head\n\n[blank]\n# nothing\nkind = 'solid'\n");
        assert_eq!(
            (error.line, &*error.key),
            (Some(3), "blank.web_thickness_mm")
        );
        assert_eq!(
            error.to_string(),
            "g.toml:3: blank.web_thickness_mm: missing; it has no default"
        );
        let blank = "[blank]\nkind = 'solid'\nweb_thickness_mm = 5\n";
        let error = complaint(&format!(
            "{blank}[[gauge]]\ntooth = 1\ndeep = true\n[[gauge]]\ndeep = true\n"
        ));
        assert_eq!((error.line, &*error.key), (Some(7), "gauge.1.tooth"));
        // `[blank]` is there by way of its sub-table only.
        let error = complaint("# head\n[blank.labels]\n");
        assert_eq!((error.line, &*error.key), (Some(2), "blank.labels"));
        assert_eq!(complaint("").key, "blank");
    }

    #[test]
    fn an_unknown_key_is_answered_with_the_known_ones() {
        let text = complaint("[blank]\nkind = 'solid'\ncolour = 1\n").to_string();
        assert_eq!(
            text,
            "g.toml:3: blank: unknown field `colour`, expected one of `kind`, `web_thickness_mm`, `labels`"
        );
        let text = complaint("# head\ncolour = 1\n").to_string();
        assert_eq!(
            text,
            "g.toml:2: unknown field `colour`, expected `blank` or `gauge`"
        );
    }

    #[test]
    fn a_key_written_otherwise_is_answered_with_the_nearest() {
        let text = complaint("[blank]\nkind = 'solid'\nwebthickness_mm = 5.0\n").to_string();
        assert!(
            text.ends_with("; did you mean `web_thickness_mm`?"),
            "{text}"
        );
    }

    #[test]
    fn a_wrong_unit_is_answered_with_the_right_key() {
        let text = complaint("# head\nblank.web_thickness_m = 0.005\n").to_string();
        assert!(
            text.starts_with("g.toml:2: blank: unknown field `web_thickness_m`"),
            "{text}"
        );
        assert!(text.contains("`web_thickness_mm`? The unit"), "{text}");
    }

    #[test]
    fn a_syntax_error_is_named_by_its_line() {
        let error = complaint("[blank]\nkind = solid\n");
        assert_eq!((error.line, &*error.key), (Some(2), ""));
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
