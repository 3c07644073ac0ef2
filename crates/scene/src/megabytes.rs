//! Sizes of results in words.

/// A size as people read it: `0.3 MB`, `1.4 GB`.
#[must_use]
pub fn megabytes(bytes: f64) -> String {
    if bytes < 1e9 {
        format!("{:.1} MB", 1e-6 * bytes)
    } else {
        format!("{:.1} GB", 1e-9 * bytes)
    }
}
