//! `gearmesh compare`: a result against a reference record, both through the rig pipeline.

use crate::arguments::CompareArguments;
use crate::console;
use crate::failure::Failure;
use gearmesh_report::{ReferenceRecord, comparison_table, scene_comparison::compare_scene};
use gearmesh_scene::SceneResult;
use serde_json::json;

/// Runs the command.
pub fn run(arguments: &CompareArguments) -> Result<(), Failure> {
    let result = SceneResult::read(&arguments.result).map_err(Failure::input)?;
    let record = ReferenceRecord::read(&arguments.reference).map_err(Failure::input)?;
    let comparisons = compare_scene(&result, &record).map_err(Failure::input)?;
    if arguments.json {
        let list = serde_json::to_value(&comparisons).map_err(Failure::work)?;
        console::json(
            &json!({"record": record.title, "kind": record.kind.to_string(), "comparisons": list}),
        );
    } else {
        console::data(format!(
            "{} against `{}` ({})",
            result.title, record.title, record.kind
        ));
        console::data(comparison_table(&comparisons));
    }
    Ok(())
}
