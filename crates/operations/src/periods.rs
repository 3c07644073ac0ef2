//! What a run of a pair has seen of each period, as marks, lines and JSON.

use gearmesh_model::Named;
use gearmesh_scene::SceneResult;
use gearmesh_scene::periods::Coverage;
use serde_json::{Value, json};

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

/// Each quantity with its period; `extent` is "whole", "passage" (one passage of the gauged tooth: peak and range) or
/// "part".
pub fn json(result: &SceneResult) -> Value {
    let quantities = result.coverages().into_iter().map(|(name, c)| {
        json!({"quantity": name, "period_pitches": c.period_pitches, "run_pitches": c.run_pitches, "extent": c.extent.name_in_files()})
    });
    let proposal = (!result.proposal.is_empty()).then_some(&result.proposal);
    json!({"quantities": quantities.collect::<Value>(), "proposal": proposal})
}
