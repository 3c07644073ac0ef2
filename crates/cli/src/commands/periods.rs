//! What a run of a pair has seen of each period, as marks and lines.

use gearmesh_scene::SceneResult;
use gearmesh_scene::periods::Coverage;

/// What stands behind a line whose figures a longer run may change.
pub const MARK: &str = "  incomplete";

/// Mark of a line of means and extremes.
pub fn mark(coverage: &Coverage) -> &'static str {
    if coverage.is_whole() { "" } else { MARK }
}

/// Mark of a line of peaks and ranges.
pub fn mark_of_extremes(coverage: &Coverage) -> &'static str {
    if coverage.has_extremes() { "" } else { MARK }
}

/// What is incomplete, and a run that would not be; for people.
pub fn lines(result: &SceneResult) -> Vec<String> {
    let mut lines = result.incomplete();
    if !result.proposal.is_empty() {
        lines.push(format!("to cover it: {}", result.proposal));
    }
    lines
}
