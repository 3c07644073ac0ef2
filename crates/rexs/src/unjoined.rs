//! Components that no relation joins to what they belong to: without the relation nothing of them acts, and nothing
//! else would tell.

use crate::ledger::About;
use crate::source::Source;
use std::collections::BTreeSet;

/// Lists stages without gears and sections without a shaft.
pub fn list(source: &Source<'_>) {
    let joined: BTreeSet<i64> = source.structure.stages().iter().map(|s| s.id).collect();
    let stages = ["cylindrical_stage", "bevel_stage", "worm_stage"];
    for stage in source.of_kind(&stages) {
        if !joined.contains(&stage.id) {
            let what = "no relation names both of its gears (roles stage, gear_1, gear_2): it passes no torque on";
            stage.leave_out(About::Lost, what);
        }
    }
    for section in source.of_kind(&["shaft_section"]) {
        if section.partners(&["shaft"]).is_empty() {
            let what = "no relation joins it to a shaft: the shaft is without it";
            section.leave_out(About::Stiffness, what);
        }
    }
}
