//! The name that was perhaps meant where one is not known.

/// Similarity (Jaro-Winkler, 0 to 1) from which a known name is offered as the one that was meant.
const SIMILAR: f64 = 0.8;

/// The known name that is written most like the one that was found; none where no one is like it.
#[must_use]
pub fn nearest<'a, S: AsRef<str>>(found: &str, known: &'a [S]) -> Option<&'a str> {
    known
        .iter()
        .map(|name| (strsim::jaro_winkler(found, name.as_ref()), name.as_ref()))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}
