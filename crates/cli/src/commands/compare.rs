//! `gearmesh compare`: a result against a reference record, both through the rig pipeline.

use crate::arguments::Printed;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::compare::{CompareRequest, compare};
use gearmesh_report::comparison_table;

/// Runs the command.
pub fn run(a: &Printed<CompareRequest>) -> Result<(), Failure> {
    let found = compare(&a.request)?;
    let record = &found.record;
    let lines = || {
        vec![
            format!(
                "{} against `{}` ({})",
                found.title, record.title, record.kind
            ),
            format!(
                "angles and orders of the shaft of {}, {} revolution(s)",
                record.shaft, record.revolutions
            ),
            comparison_table(&found.comparisons),
        ]
    };
    console::found(a.json, || found.figures(), lines);
    Ok(())
}
