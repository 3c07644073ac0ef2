//! `gearmesh compare`: a result against a reference record, both through the rig pipeline.

use crate::arguments::CompareArguments;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::compare::{CompareRequest, compare};
use gearmesh_report::comparison_table;

/// Runs the command.
pub fn run(a: &CompareArguments) -> Result<(), Failure> {
    let found = compare(&CompareRequest {
        result: a.result.clone(),
        reference: a.reference.clone(),
        column: a.column.iter().cloned().collect(),
        from_s: a.from_s,
        start_angle_deg: a.start_angle_deg,
    })?;
    if a.json {
        console::json(&found.figures());
        return Ok(());
    }
    let record = &found.record;
    console::data(format!(
        "{} against `{}` ({})",
        found.title, record.title, record.kind
    ));
    console::data(format!(
        "angles and orders of the shaft of {}, {} revolution(s)",
        record.shaft, record.revolutions
    ));
    console::data(comparison_table(&found.comparisons));
    Ok(())
}
